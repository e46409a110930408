//! What a preview shows: a mesh, or convex cells apart from each other, whole or cut open.

use std::borrow::Cow;

use glam::DVec3;
use planecut_csg::{Material, MaterialId, Mesh, MeshFace};

use crate::material::distinct_color;

/// What is drawn: a mesh, and which of its faces are cuts.
#[derive(Debug, Clone)]
pub struct Subject<'a> {
    mesh: Cow<'a, Mesh>,
    /// Materials whose faces are hatched, in ascending order.
    cuts: Vec<MaterialId>,
}

impl<'a> Subject<'a> {
    /// A mesh as it is.
    #[must_use]
    pub fn of_mesh(mesh: &'a Mesh) -> Self {
        Self { mesh: Cow::Borrowed(mesh), cuts: Vec::new() }
    }

    /// The same with the faces of these materials hatched, as cuts through the material are in drawings. Each material is hatched in a
    /// direction of its own, as far as there are enough.
    #[must_use]
    pub fn hatching(mut self, mut cuts: Vec<MaterialId>) -> Self {
        cuts.sort_unstable();
        cuts.dedup();
        self.cuts = cuts;
        self
    }

    /// Closed meshes, the faces of each in a colour of its own, which depends on its number alone. `spread` says how far they are
    /// moved from the middle of all: 0 leaves them where they are, with 1 they are twice as far from it. Faces of the materials
    /// `cuts` are hatched.
    #[must_use]
    pub fn of_cells(cells: &[Mesh], spread: f64, cuts: &[MaterialId]) -> Subject<'static> {
        let solid = cells.iter().filter(|cell| !cell.triangles.is_empty());
        let boxes: Vec<[DVec3; 2]> =
            solid.clone().filter_map(|cell| box_around(cell.positions.iter().copied())).collect();
        let center = box_around(boxes.iter().flatten().copied()).map_or(DVec3::ZERO, middle);
        let mut mesh = Mesh::default();
        let mut hatched = Vec::new();
        for (number, (cell, own)) in solid.zip(boxes).enumerate() {
            let shift = (middle(own) - center) * spread;
            let (first_vertex, first_face) = (mesh.positions.len() as u32, mesh.faces.len() as u32);
            let first_material = mesh.materials.len() as u32;
            mesh.positions.extend(cell.positions.iter().map(|&point| point + shift));
            mesh.triangles.extend(cell.triangles.iter().map(|corners| corners.map(|corner| corner + first_vertex)));
            mesh.triangle_faces.extend(cell.triangle_faces.iter().map(|face| face + first_face));
            mesh.faces.extend(cell.faces.iter().map(|face| {
                let is_cut = cuts.contains(&face.material);
                MeshFace { material: MaterialId(first_material + u32::from(is_cut)), ..*face }
            }));
            let color = Some(distinct_color(number));
            let name = format!("cell {number}");
            mesh.materials.push(Material { color, ..Material::named(name.as_str()) });
            mesh.materials.push(Material { color, ..Material::named(name + ", cut") });
            hatched.push(MaterialId(first_material + 1));
        }
        let cuts = if cuts.is_empty() { Vec::new() } else { hatched };
        Subject { mesh: Cow::Owned(mesh), cuts }
    }

    /// What is drawn, as one mesh.
    #[must_use]
    pub fn as_mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// The box around the vertices that triangles use.
    pub(super) fn bounds(&self) -> Option<[DVec3; 2]> {
        box_around(self.mesh.triangles.iter().flatten().map(|&corner| self.mesh.positions[corner as usize]))
    }

    /// For each material the number of its hatching.
    pub(super) fn hatches(&self) -> Vec<Option<u32>> {
        let place = |number: u32| self.cuts.binary_search(&MaterialId(number)).ok().map(|place| place as u32);
        (0..self.mesh.materials.len() as u32).map(place).collect()
    }
}

impl<'a> From<&'a Mesh> for Subject<'a> {
    fn from(mesh: &'a Mesh) -> Self {
        Self::of_mesh(mesh)
    }
}

impl From<Mesh> for Subject<'static> {
    fn from(mesh: Mesh) -> Self {
        Self { mesh: Cow::Owned(mesh), cuts: Vec::new() }
    }
}

/// The smallest and the largest coordinates of points; `None` where there are none.
pub(super) fn box_around(points: impl Iterator<Item = DVec3>) -> Option<[DVec3; 2]> {
    points.map(|point| [point, point]).reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
}

/// The middle of a box. Halved before adding, so that no finite box overflows.
pub(super) fn middle([min, max]: [DVec3; 2]) -> DVec3 {
    min * 0.5 + max * 0.5
}
