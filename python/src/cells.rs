//! Convex cells.

use glam::DVec3;
use numpy::PyArray2;
use planecut::cells::Solid as CellSolid;
use planecut::csg::polyhedron::convex_tree;
use planecut::csg::{Brush, ConvexPiece, Material, MaterialId, Model, Tree};
use planecut::kernel::{HalfSpace, IncrementalPolytope};
use planecut_parallel::job::check;
use pyo3::prelude::*;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::arrays::{view_points, view_rows};
use crate::errors::{Failure, Outcome, refuse};
use crate::expression::Node;
use crate::pickles::{Reduced, reduced, unpickled};
use crate::solid::Solid;

/// A bounded convex body: planes, and the corners and triangles of its boundary.
#[pyclass(frozen, module = "planecut")]
#[derive(Clone, Serialize, Deserialize)]
pub(crate) struct Cell {
    planes: Vec<[f64; 4]>,
    vertices: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    volume: f64,
    material: String,
}

impl Cell {
    /// The body of half-spaces.
    pub(crate) fn of_planes(planes: impl Iterator<Item = HalfSpace>, material: &Material) -> Outcome<Self> {
        let mut body = IncrementalPolytope::with_epsilon(0.0);
        planes.for_each(|plane| _ = body.add_plane(plane));
        if !body.is_bounded() {
            return Err(Failure::of("found a cell that reaches infinity, expected a solid that is bounded"));
        }
        let (vertices, polygons) = body.to_mesh();
        let fan = |polygon: &Vec<usize>| {
            let corner = |k: usize| polygon[k] as u32;
            (2..polygon.len()).map(|k| [corner(0), corner(k - 1), corner(k)]).collect::<Vec<_>>()
        };
        let planes =
            body.facets().iter().filter_map(|(plane, _)| body.plane(*plane)).map(HalfSpace::to_array).collect();
        let volume = body.measures().map_or(0.0, |measures| measures.volume);
        let triangles = polygons.iter().flat_map(fan).collect();
        Ok(Self { planes, vertices, triangles, volume, material: material.name.clone() })
    }

    /// A convex body whose boundary is known.
    pub(crate) fn of_piece(piece: ConvexPiece, material: String) -> Self {
        let ConvexPiece { half_spaces, positions: vertices, triangles, volume } = piece;
        Self { planes: half_spaces.iter().map(HalfSpace::to_array).collect(), vertices, triangles, volume, material }
    }

    /// The same body with corners and triangles as they are written for others.
    pub(crate) fn written_as(self, mesh: &planecut::csg::Mesh) -> Self {
        Self { vertices: mesh.positions.clone(), triangles: mesh.triangles.clone(), ..self }
    }

    pub(crate) fn volume(&self) -> f64 {
        self.volume
    }

    pub(crate) fn parts(&self) -> (&[DVec3], &[[u32; 3]]) {
        (&self.vertices, &self.triangles)
    }
}

#[pymethods]
impl Cell {
    /// The planes that carry a face, shape (k, 4): outward normals, which need not have unit length, and offsets `d` of `n · x <= d`.
    #[getter]
    fn planes<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray2<f64>> {
        view_rows(slf.as_any(), &slf.get().planes)
    }

    /// The corners, shape (n, 3), rounded to doubles.
    #[getter]
    fn vertices<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray2<f64>> {
        view_points(slf.as_any(), &slf.get().vertices)
    }

    /// Numbers of corners, shape (m, 3), counter-clockwise seen from outside.
    #[getter]
    fn triangles<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray2<u32>> {
        view_rows(slf.as_any(), &slf.get().triangles)
    }

    /// The volume.
    #[getter(volume)]
    fn volume_of(&self) -> f64 {
        self.volume
    }

    /// The name of what it is made of.
    #[getter]
    fn material(&self) -> &str {
        &self.material
    }

    /// The body as a Solid: of its planes, exactly.
    fn to_solid(&self) -> PyResult<Solid> {
        let half_spaces: Vec<HalfSpace> = self
            .planes
            .iter()
            .map(|plane| HalfSpace::from_array(*plane))
            .collect::<Result<_, _>>()
            .map_err(Failure::of)?;
        let brush = Brush::from_half_spaces(half_spaces, MaterialId(0));
        Ok(Solid::of(Node::of_tree(brush, Material::named(&self.material))))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduced(slf, rmp_serde::to_vec(slf.get()))
    }

    /// A cell that was pickled.
    #[staticmethod]
    fn _unpickle(data: &[u8]) -> PyResult<Self> {
        let cell: Self = unpickled(data, "is no pickled cell")?;
        let count = cell.vertices.len() as u32;
        let is_sound = cell.triangles.iter().flatten().all(|corner| *corner < count);
        if is_sound { Ok(cell) } else { Err(refuse("found what is no pickled cell: a number of no corner")) }
    }

    fn __repr__(&self) -> String {
        format!("<planecut.Cell of {} planes, volume {}>", self.planes.len(), self.volume)
    }
}

/// The disjoint convex cells of a model.
pub(crate) fn cells_of(model: Model) -> Outcome<Vec<Cell>> {
    let tree = convex_tree(&model.tree).map_err(Failure::of)?;
    let solid = CellSolid::from_tree(&tree);
    if !solid.is_bounded() {
        return Err(Failure::of("found a solid that reaches infinity, expected one that is bounded"));
    }
    let cells: Vec<_> = solid.cells().collect();
    let cell = |cell: &&planecut::cells::Cell| {
        check();
        let brush = solid.brush_of(cell);
        let material = brush.faces.first().and_then(|face| model.materials.get(face.material.0 as usize));
        let default = Material::named(crate::shapes::DEFAULT_MATERIAL);
        Cell::of_planes(brush.half_spaces().copied(), material.unwrap_or(&default))
    };
    cells.par_iter().map(cell).collect()
}

/// The connected parts of a model, each the union of disjoint cells.
pub(crate) fn components_of(model: Model) -> Outcome<Vec<Model>> {
    let tree = convex_tree(&model.tree).map_err(Failure::of)?;
    let solid = CellSolid::from_tree(&tree);
    let part = |part: CellSolid| {
        let brushes = part.cells().map(|cell| part.brush_of(cell)).collect();
        Model { materials: model.materials.clone(), tree: Tree::union_of(brushes) }
    };
    Ok(solid.connected_components().into_iter().map(part).collect())
}
