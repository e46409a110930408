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

#[cfg(test)]
mod tests {
    use planecut_csg::{Brush, MaterialId, Model, evaluate};
    use planecut_kernel::{DVec3, HalfSpace};

    use super::*;

    const RED: [f32; 3] = [0.8, 0.1, 0.1];

    /// Three cubes along x: of a material with a colour, of one without, and of both; cut in half along z.
    fn cut_cubes() -> (Mesh, Vec<CutMaterial>) {
        let cube = |x: f64, material: u32| {
            let low = DVec3::new(x, 0.0, 0.0);
            Brush::cuboid(low, low + DVec3::ONE, MaterialId(material))
        };
        let mut mixed = cube(4.0, 0);
        mixed.faces[0].material = MaterialId(1);
        let red = Material { color: Some(RED), ..Material::named("red") };
        let tree = planecut_csg::Tree::union_of(vec![cube(0.0, 0), cube(2.0, 1), mixed]);
        let model = Model { materials: vec![red, Material::named("oak")], tree };
        let cut = model.cut_open(&HalfSpace::new(DVec3::Z, 0.5).expect("a plane"));
        (evaluate(&cut.model).expect("closed").mesh, cut.cuts)
    }

    #[test]
    fn cuts_look_like_what_was_cut() {
        let (mesh, cuts) = cut_cubes();
        let oak = Tint::Derived(material_color(&Material::named("oak")));
        let subject = Subject::of_mesh(&mesh).hatching(&cuts);
        let tints: Vec<Tint> = subject.paints().iter().map(|paint| paint.tint).collect();
        assert_eq!(tints, [Tint::Stated(RED), oak, Tint::Stated(RED), oak, Tint::Clay]);
        let hatchings: Vec<Option<u32>> = subject.paints().iter().map(|paint| paint.hatching).collect();
        assert_eq!(hatchings, [None, None, Some(0), Some(1), Some(2)]);
        let paints: Vec<u32> = subject.faces().iter().map(|face| face.paint).collect();
        assert_eq!(paints, mesh.faces.iter().map(|face| face.material.0).collect::<Vec<_>>());
    }

    #[test]
    fn hatching_a_material_that_is_not_there_changes_nothing() {
        let (mesh, _) = cut_cubes();
        let unknown = CutMaterial { id: MaterialId(70), of: None };
        let [plain, hatched] = [Vec::new(), vec![unknown]].map(|cuts| Subject::of_mesh(&mesh).hatching(&cuts));
        assert_eq!(plain.paints(), hatched.paints());
    }

    #[test]
    fn cells_have_two_paints_each() {
        let (mesh, cuts) = cut_cubes();
        let empty = Mesh { triangles: Vec::new(), triangle_faces: Vec::new(), ..mesh.clone() };
        let subject = Subject::of_cells(&[mesh.clone(), empty, mesh.clone()], 0.5, &cuts);
        let paint =
            |number: usize, hatching: Option<u32>| Paint { tint: Tint::Stated(distinct_color(number)), hatching };
        assert_eq!(subject.paints(), [paint(0, None), paint(0, Some(0)), paint(1, None), paint(1, Some(1))]);
        let is_cut = mesh.faces.iter().map(|face| u32::from(face.material.0 > 1));
        let expected: Vec<u32> = is_cut.clone().chain(is_cut.map(|paint| paint + 2)).collect();
        assert_eq!(subject.faces().iter().map(|face| face.paint).collect::<Vec<_>>(), expected);
    }
}
