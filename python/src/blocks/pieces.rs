//! Pieces of a mesh that fit together.

use std::fs::File;
use std::io;
use std::path::PathBuf;
use std::sync::Arc;

use glam::DVec3;
use numpy::{PyArray1, PyArray2};
use planecut::blocks::{BlockPlan, Pieces as CorePieces};
use planecut::csg::Mesh as CoreMesh;
use planecut::export::{AtomicFile, ExportError, ExportOptions, Format, MeshPieces, write_pieces};
use planecut::tiles::{TileLeaf, TileOptions, TileSource, TilesError, write_tiles};
use planecut_parallel::job::check;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{small, small_rows};
use crate::errors::{Failure, refuse};
use crate::files::{at, said, settings, text_of};
use crate::job::Job;
use crate::mesh::Mesh;

/// The boundary of a model, a mesh for each block, which stay in their files: it is proven that together they are one closed surface. `Plan.evaluate` makes them.
///
/// `len(pieces)` is how many there are, and iteration gives their meshes, one after another.
#[pyclass(frozen, module = "planecut.blocks")]
pub(crate) struct Pieces {
    plan: Arc<BlockPlan>,
    pieces: Arc<CorePieces>,
}

impl Pieces {
    pub(super) fn of(plan: Arc<BlockPlan>, pieces: CorePieces) -> Self {
        Self { plan, pieces: Arc::new(pieces) }
    }

    /// Those of a plan that are all there.
    pub(super) fn open(py: Python<'_>, plan: Arc<BlockPlan>) -> PyResult<Self> {
        let own = Arc::clone(&plan);
        let pieces = Job::default().run(py, move || Ok(CorePieces::open(&own)?))?;
        Ok(Self::of(plan, pieces))
    }

    fn is_empty(&self) -> bool {
        self.pieces.mesh_counts()[1] == 0
    }
}

#[pymethods]
impl Pieces {
    /// The volume of the whole solid, in cubes of the unit of length.
    #[getter]
    fn volume(&self) -> f64 {
        self.pieces.solid().volume
    }

    /// The area of the boundary; walls between blocks are no part of it.
    #[getter]
    fn area(&self) -> f64 {
        self.pieces.solid().area
    }

    /// The center of mass of a solid of the same density everywhere, shape (3,); NaN where it is empty.
    #[getter]
    fn centroid<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let centroid = if self.is_empty() { DVec3::NAN } else { self.pieces.solid().centroid };
        small(py, &centroid.to_array())
    }

    /// The least and the greatest coordinates, shape (2, 3); NaN where the solid is empty.
    #[getter]
    fn bounds<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let solid = self.pieces.solid();
        let bounds = if self.is_empty() { [DVec3::NAN; 2] } else { [solid.min, solid.max] };
        small_rows(py, &bounds.map(|corner| corner.to_array()))
    }

    /// How many vertices all pieces have; those on walls between blocks count in each of their pieces.
    #[getter]
    fn vertices(&self) -> u64 {
        self.pieces.mesh_counts()[0]
    }

    /// How many triangles all pieces have.
    #[getter]
    fn triangles(&self) -> u64 {
        self.pieces.mesh_counts()[1]
    }

    /// How many planar faces all pieces have; a face that a wall divides counts on both sides.
    #[getter]
    fn faces(&self) -> u64 {
        self.pieces.mesh_counts()[2]
    }

    /// How many edges lie on walls between blocks: each is in the pieces of both sides.
    #[getter]
    fn seam_edges(&self) -> u64 {
        self.pieces.seam_edges()
    }

    /// The names of the materials of the model.
    #[getter]
    fn materials(&self) -> Vec<&str> {
        self.pieces.materials().iter().map(|material| material.name.as_str()).collect()
    }

    /// The mesh of a piece, which is open on walls between blocks.
    ///
    /// Args:
    ///     piece: Its number, from 0: that of its block in `Plan.blocks`.
    ///
    /// Returns:
    ///     A Mesh with those of the materials that it needs; it may be empty.
    fn mesh(&self, py: Python<'_>, piece: usize) -> PyResult<Mesh> {
        let count = self.pieces.count();
        if piece >= count {
            return Err(refuse(format!("piece: found {piece}, expected a number below {count}")));
        }
        let mesh = py.detach(|| self.pieces.read(piece)).map_err(Failure::from)?.0;
        Ok(Mesh::of_core(mesh))
    }

    /// Writes all pieces to one file, where neighbours share their vertices as far as the format can say so. Few pieces are in memory at a time, and the file appears when it is complete.
    ///
    /// Args:
    ///     path: Its ending says the format: .glb, .gltf, .obj, .stl or .ply.
    ///     options: Settings of the format by name, as for `Solid.save`.
    #[pyo3(signature = (path, **options))]
    fn save(&self, py: Python<'_>, path: PathBuf, options: Option<&Bound<'_, PyDict>>) -> PyResult<()> {
        let options = text_of(py, options)?;
        let pieces = Checked(Arc::clone(&self.pieces));
        Job::default().run(py, move || {
            let format = Format::from_path(&path).map_err(|error| at(&path, error))?;
            let options: ExportOptions = settings(&options)?;
            let failed = |error: ExportError| match error {
                ExportError::Write { .. } => said(&path, error),
                error => at(&path, error),
            };
            let mut file = AtomicFile::create(&path).map_err(failed)?;
            write_pieces(&pieces, format, &options, &mut file).map_err(failed)?;
            file.commit().map_err(failed)
        })
    }

    /// Writes all pieces as a tile set (3D Tiles 1.1): `tileset.json` in a folder, which viewers load in more detail the nearer they come. A tile set of planecut that is there is replaced,
    /// and anything else is an error.
    ///
    /// Args:
    ///     folder: The folder, which is made.
    ///     triangles: Most triangles of a tile that stands for others, as far as that can be.
    ///     options: Settings of GLB by name, as for `Solid.save`; `scale` and `unit` must give metres.
    #[pyo3(signature = (folder, *, triangles=50_000, **options))]
    fn tiles(
        &self,
        py: Python<'_>,
        folder: PathBuf,
        triangles: usize,
        options: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<()> {
        let options = text_of(py, options)?;
        let pieces = Checked(Arc::clone(&self.pieces));
        Job::default().run(py, move || {
            let options = TileOptions { triangles, export: settings(&options)?, ..TileOptions::default() };
            write_tiles(&pieces, &folder, &options).map_err(|error| match &error {
                TilesError::Occupied { path } | TilesError::Write { path, .. } => said(path, &error),
                TilesError::Export(ExportError::Write { path, .. }) => said(path, &error),
                _ => at(&folder, &error),
            })?;
            Ok(())
        })
    }

    fn __len__(&self) -> usize {
        self.pieces.count()
    }

    fn __iter__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let builtins = slf.py().import("builtins")?;
        let numbers = builtins.getattr("range")?.call1((slf.get().pieces.count(),))?;
        builtins.getattr("map")?.call1((slf.getattr("mesh")?, numbers))
    }

    fn __repr__(&self) -> String {
        format!("<planecut.blocks.Pieces: {} of {} triangles>", self.pieces.count(), self.triangles())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (PathBuf,))> {
        Ok((slf.get_type().getattr("_open")?, (slf.get().plan.folder().to_owned(),)))
    }

    /// Pieces that were pickled.
    #[staticmethod]
    fn _open(py: Python<'_>, folder: PathBuf) -> PyResult<Self> {
        let plan = py.detach(|| BlockPlan::open(&folder)).map_err(Failure::from)?;
        Self::open(py, Arc::new(plan))
    }
}

/// Pieces that are read until the work is to end.
struct Checked(Arc<CorePieces>);

impl MeshPieces for Checked {
    fn count(&self) -> usize {
        self.0.count()
    }

    fn piece(&self, number: usize) -> io::Result<CoreMesh> {
        check();
        self.0.piece(number)
    }

    fn name(&self, number: usize) -> String {
        self.0.name(number)
    }

    fn temporary_file(&self) -> io::Result<File> {
        self.0.temporary_file()
    }
}

impl TileSource for Checked {
    fn leaves(&self) -> &[TileLeaf] {
        self.0.leaves()
    }

    fn mesh(&self, leaf: usize) -> io::Result<CoreMesh> {
        check();
        TileSource::mesh(&*self.0, leaf)
    }
}
