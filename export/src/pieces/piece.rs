//! A piece as writers take it.

use planecut_csg::Mesh;
use planecut_csg::stages::{HalfEdges, NO_TWIN, previous};
use rustc_hash::FxHashSet;

use crate::Part;
use crate::surface::has_three_corners;

/// Marks a vertex that no triangle uses.
const NONE: u32 = u32::MAX;

/// A piece of a surface: every vertex is used, no triangle names one twice, and the triangles at a vertex of an open edge follow one another from one open edge
/// to the other. What touches there has vertices of its own, so that the edges alone say what goes on where.
#[derive(Debug)]
pub(crate) struct Piece {
    pub(crate) name: String,
    pub(crate) mesh: Mesh,
    /// The half-edges that have no twin, rising.
    pub(crate) open: Vec<u32>,
    /// The vertices at these, rising.
    pub(crate) open_vertices: Vec<u32>,
}

impl Piece {
    /// Brings a checked mesh into this form; the same mesh always comes out the same.
    pub(crate) fn new(name: String, mut mesh: Mesh) -> Self {
        drop_flat(&mut mesh);
        let twins = HalfEdges::new(mesh.positions.len(), &mesh.triangles).twins();
        let open: Vec<u32> = (0..).zip(&twins).filter(|(_, twin)| **twin == NO_TWIN).map(|(open, _)| open).collect();
        part_fans(&mut mesh, &open, &twins);
        drop_unused(&mut mesh);
        let mut open_vertices: Vec<u32> = open.iter().flat_map(|open| ends(&mesh, *open)).collect();
        open_vertices.sort_unstable();
        open_vertices.dedup();
        Self { name, mesh, open, open_vertices }
    }

    pub(crate) fn part(&self) -> Part<'_> {
        Part::new(&self.name, &self.mesh)
    }

    /// The vertices from and to which a half-edge runs.
    pub(crate) fn ends(&self, half_edge: u32) -> [u32; 2] {
        ends(&self.mesh, half_edge)
    }
}

fn ends(mesh: &Mesh, half_edge: u32) -> [u32; 2] {
    let (triangle, k) = (half_edge / 3, half_edge as usize % 3);
    let corners = mesh.triangles[triangle as usize];
    [corners[k], corners[(k + 1) % 3]]
}

/// Drops triangles that name a vertex twice: they have no area, and without them the same edges are paired.
fn drop_flat(mesh: &mut Mesh) {
    if mesh.triangles.iter().all(has_three_corners) {
        return;
    }
    let kept: Vec<bool> = mesh.triangles.iter().map(has_three_corners).collect();
    let mut is_kept = kept.iter();
    mesh.triangle_faces.retain(|_| is_kept.next().is_some_and(|is_kept| *is_kept));
    mesh.triangles.retain(has_three_corners);
}

/// Gives each fan of triangles between two open edges at a vertex a vertex of its own; the first keeps the one that there is.
fn part_fans(mesh: &mut Mesh, open: &[u32], twins: &[u32]) {
    let mut taken: FxHashSet<u32> = FxHashSet::default();
    for &first in open {
        let [vertex, _] = ends(mesh, first);
        if taken.insert(vertex) {
            continue;
        }
        let copy = mesh.positions.len() as u32;
        mesh.positions.push(mesh.positions[vertex as usize]);
        taken.insert(copy);
        let mut leaving = first;
        // it ends: no two half-edges have the same twin, and the first has none
        while leaving != NO_TWIN {
            mesh.triangles[leaving as usize / 3][leaving as usize % 3] = copy;
            leaving = twins[previous(leaving) as usize];
        }
    }
}

/// Drops vertices that no triangle uses; the others stay in their order.
fn drop_unused(mesh: &mut Mesh) {
    let mut new = vec![NONE; mesh.positions.len()];
    mesh.triangles.as_flattened().iter().for_each(|corner| new[*corner as usize] = 0);
    if !new.contains(&NONE) {
        return;
    }
    let mut used = 0;
    for (old, new) in new.iter_mut().enumerate().filter(|(_, new)| **new != NONE) {
        mesh.positions[used as usize] = mesh.positions[old];
        *new = used;
        used += 1;
    }
    mesh.positions.truncate(used as usize);
    mesh.triangles.as_flattened_mut().iter_mut().for_each(|corner| *corner = new[*corner as usize]);
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use planecut_csg::{Material, MaterialId, MeshFace};

    use super::*;

    /// Two triangles that touch at vertex 1, one without area and two vertices without triangles.
    #[test]
    fn fans_are_parted_and_what_is_of_no_use_goes() {
        let positions: Vec<DVec3> = (0..7).map(|k| DVec3::new(f64::from(k), f64::from(k * k), 0.0)).collect();
        let mesh = Mesh {
            positions: positions.clone(),
            triangles: vec![[1, 2, 4], [5, 5, 1], [6, 1, 5]],
            triangle_faces: vec![0, 1, 2],
            faces: vec![MeshFace { normal: DVec3::Z, material: MaterialId(0) }; 3],
            materials: vec![Material::named("m")],
        };
        let piece = Piece::new("p".to_owned(), mesh);
        assert_eq!(piece.mesh.triangle_faces, [0, 2]);
        let places = |triangle: [u32; 3]| triangle.map(|corner| piece.mesh.positions[corner as usize]);
        assert_eq!(places(piece.mesh.triangles[0]), [1, 2, 4].map(|k: usize| positions[k]));
        assert_eq!(places(piece.mesh.triangles[1]), [6, 1, 5].map(|k: usize| positions[k]));
        assert_eq!((piece.mesh.positions.len(), piece.open.len(), piece.open_vertices.len()), (6, 6, 6));
        assert_ne!(piece.mesh.triangles[0][0], piece.mesh.triangles[1][1]);
    }
}
