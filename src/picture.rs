//! Pictures: those of [`planecut_picture`], and what makes a picture's input of meshes.
//!
//! ```
//! use planecut::csg::{Brush, Material, MaterialId, Model, evaluate};
//! use planecut::kernel::{DVec3, HalfSpace};
//! use planecut::picture::{PreviewOptions, Subject, render};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let cube = Brush::cuboid(DVec3::ZERO, DVec3::ONE, MaterialId(0));
//! let model = Model { materials: vec![Material::named("oak")], tree: cube.into() };
//! // Cut open in the middle, the cut hatched.
//! let cut = model.cut_open(&HalfSpace::new(DVec3::X, 0.5)?);
//! let mesh = evaluate(&cut.model)?.mesh;
//! let options = PreviewOptions { width: 64, height: 48, azimuth: 20.0, ..PreviewOptions::default() };
//! let picture = render(&Subject::of_mesh(&mesh).hatching(&cut.cuts), &options)?;
//! assert!(picture.to_png()?.starts_with(b"\x89PNG"));
//! # Ok(())
//! # }
//! ```

use std::borrow::Cow;
use std::ops::Deref;

use planecut_csg::{CutMaterial, Material, Mesh, MeshFace};
use planecut_export::{distinct_color, material_color};
pub use planecut_picture::*;

/// What is drawn of a model: a mesh, or convex cells apart from each other, whole or cut open. Materials have the colours that writers of
/// meshes give them. It is a [`PaintedMesh`], which all functions that draw take; its paints are the mesh's materials.
#[derive(Debug, Clone)]
pub struct Subject<'a>(PaintedMesh<'a>);

impl<'a> Subject<'a> {
    /// A mesh as it is.
    #[must_use]
    pub fn of_mesh(mesh: &'a Mesh) -> Self {
        let positions = mesh.positions.iter().map(|position| position.to_array());
        Self::new(positions, &mesh.triangles[..], &mesh.triangle_faces[..], &mesh.faces, &mesh.materials)
    }

    fn new(
        positions: impl IntoIterator<Item = [f64; 3]>,
        triangles: impl Into<Cow<'a, [[u32; 3]]>>,
        triangle_faces: impl Into<Cow<'a, [u32]>>,
        faces: &[MeshFace],
        materials: &[Material],
    ) -> Self {
        let face = |face: &MeshFace| Face { normal: face.normal.to_array(), paint: face.material.0 };
        let paints = materials.iter().map(|material| tint_of(material).into()).collect();
        Self(PaintedMesh::new(positions, triangles, triangle_faces, faces.iter().map(face).collect(), paints))
    }

    /// The same with the faces of these materials hatched, as cuts through the material are in drawings. Each material is hatched in a
    /// direction of its own, as far as there are enough. A cut looks like the material that was cut; materials that the mesh does not have
    /// are left out.
    #[must_use]
    pub fn hatching(mut self, cuts: &[CutMaterial]) -> Self {
        let mut cuts = cuts.to_vec();
        cuts.sort_unstable_by_key(|cut| cut.id);
        cuts.dedup_by_key(|cut| cut.id);
        let whole: Vec<Paint> = self.0.paints().to_vec();
        for (number, cut) in (0..).zip(cuts) {
            if let Some(paint) = self.0.paints_mut().get_mut(cut.id.0 as usize) {
                let tint = cut.of.and_then(|id| whole.get(id.0 as usize)).map_or(Tint::Clay, |paint| paint.tint);
                *paint = Paint { tint, hatching: Some(number) };
            }
        }
        self
    }

    /// Closed meshes, the faces of each in a colour of its own, which depends on its number alone. `spread` says how far they are
    /// moved from the middle of all: 0 leaves them where they are, with 1 they are twice as far from it. Faces of the materials
    /// `cuts` are hatched. Cell `i` of those that have triangles has the paints `2 * i` and, for its cut faces, `2 * i + 1`.
    #[must_use]
    pub fn of_cells(cells: &[Mesh], spread: f64, cuts: &[CutMaterial]) -> Subject<'static> {
        let solid = cells.iter().filter(|cell| !cell.triangles.is_empty());
        let parts: Vec<PaintedMesh<'_>> =
            (0..).zip(solid).map(|(number, cell)| cell_part(cell, number, cuts)).collect();
        Subject(PaintedMesh::exploded(&parts, spread))
    }
}

/// A cell with two paints of one colour: that of its faces, and that of its cuts.
fn cell_part<'a>(cell: &'a Mesh, number: u32, cuts: &[CutMaterial]) -> PaintedMesh<'a> {
    let tint = Tint::Stated(distinct_color(number as usize));
    let paints = vec![Paint { tint, hatching: None }, Paint { tint, hatching: Some(number) }];
    let face = |face: &MeshFace| {
        let is_cut = cuts.iter().any(|cut| cut.id == face.material);
        Face { normal: face.normal.to_array(), paint: u32::from(is_cut) }
    };
    let positions = cell.positions.iter().map(|position| position.to_array());
    let faces = cell.faces.iter().map(face).collect();
    PaintedMesh::new(positions, &cell.triangles[..], &cell.triangle_faces[..], faces, paints)
}

fn tint_of(material: &Material) -> Tint {
    let color = material_color(material);
    if material.color.is_some() { Tint::Stated(color) } else { Tint::Derived(color) }
}

impl<'a> Deref for Subject<'a> {
    type Target = PaintedMesh<'a>;

    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl<'a> From<&'a Mesh> for Subject<'a> {
    fn from(mesh: &'a Mesh) -> Self {
        Self::of_mesh(mesh)
    }
}

impl From<Mesh> for Subject<'static> {
    fn from(mesh: Mesh) -> Self {
        let positions = mesh.positions.iter().map(|position| position.to_array());
        Self::new(positions, mesh.triangles, mesh.triangle_faces, &mesh.faces, &mesh.materials)
    }
}
