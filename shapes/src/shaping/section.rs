//! Outlines from solids: slices and shadows.

use planecut_csg::Tree;
use planecut_csg::{MaterialId, Mesh};
use planecut_kernel::{DVec2, DVec3};
use rustc_hash::FxHashMap;

use super::convex::evaluated;
use crate::outline::{FillRule, Outline};
use crate::parameter::{ShapeError, coordinate};
use crate::primitives::body_of_half_spaces;

/// Where a solid meets the plane `z = height`: what there is just below it. Move the tree first for any other plane.
///
/// The corners are those of the solid, rounded once. The solid itself may be unbounded, where no leaf of it is a closed mesh.
///
/// # Errors
/// [`ShapeError::Parameter`] where the height is not accepted, [`ShapeError::Unbounded`] where the slice is unbounded.
pub fn slice(tree: &Tree, height: f64) -> Result<Outline, ShapeError> {
    let height = coordinate("z", height)?;
    // a slab so thick that its planes differ, and no thicker, so that what is unbounded along z does not matter
    let thickness = (height.abs() + 1.0).log2().ceil().exp2();
    let mut sides = vec![(DVec3::Z, height), (-DVec3::Z, thickness - height)];
    if tree.has_meshes() {
        // what closed meshes are combined with must be bounded
        let Some([min, max]) = bounds(&evaluated(tree)?.mesh) else { return Ok(Outline::empty()) };
        let margin = (max - min).max_element();
        sides.extend([DVec3::X, DVec3::Y].map(|axis| (axis, axis.dot(max) + margin)));
        sides.extend([DVec3::X, DVec3::Y].map(|axis| (-axis, margin - axis.dot(min))));
    }
    let slab = body_of_half_spaces(&sides, MaterialId(0))?;
    let mesh = evaluated(&Tree::intersection([tree.clone(), slab.into()]))?.mesh;
    let on_plane = |vertex: &u32| mesh.positions[*vertex as usize].z == height;
    let lid = triangles_by_face(&mesh).into_iter().filter(|(face, triangles)| {
        mesh.faces[*face as usize].normal == DVec3::Z && triangles.iter().flatten().all(on_plane)
    });
    let loops: Vec<Vec<DVec2>> = lid.flat_map(|(_, triangles)| boundary(&mesh, &triangles)).collect();
    Ok(Outline::filled(&loops, FillRule::EvenOdd))
}

/// The shadow of a solid on the x–y plane.
///
/// # Errors
/// [`ShapeError::Unbounded`] where the solid is not bounded.
pub fn project(tree: &Tree) -> Result<Outline, ShapeError> {
    let mesh = evaluated(tree)?.mesh;
    let faces = triangles_by_face(&mesh).into_iter().filter(|(face, _)| mesh.faces[*face as usize].normal.z > 0.0);
    let loops: Vec<Vec<DVec2>> = faces.flat_map(|(_, triangles)| boundary(&mesh, &triangles)).collect();
    Ok(Outline::filled(&loops, FillRule::NonZero))
}

/// The box around a mesh.
fn bounds(mesh: &Mesh) -> Option<[DVec3; 2]> {
    mesh.positions.iter().map(|point| [*point; 2]).reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
}

fn triangles_by_face(mesh: &Mesh) -> Vec<(u32, Vec<[u32; 3]>)> {
    let faces = mesh.triangle_faces.chunk_by(|a, b| a == b);
    let mut start = 0;
    faces
        .map(|same| {
            start += same.len();
            (same[0], mesh.triangles[start - same.len()..start].to_vec())
        })
        .collect()
}

/// The loops around the triangles of one face, seen from above.
fn boundary(mesh: &Mesh, triangles: &[[u32; 3]]) -> Vec<Vec<DVec2>> {
    let edges = || triangles.iter().flat_map(|[a, b, c]| [(*a, *b), (*b, *c), (*c, *a)]);
    let all: std::collections::BTreeSet<(u32, u32)> = edges().collect();
    let mut next: FxHashMap<u32, Vec<u32>> = FxHashMap::default();
    let open: Vec<(u32, u32)> = all.iter().filter(|(a, b)| !all.contains(&(*b, *a))).copied().collect();
    for (a, b) in &open {
        next.entry(*a).or_default().push(*b);
    }
    let mut loops = Vec::new();
    for (start, _) in &open {
        let mut corners = Vec::new();
        let mut at = *start;
        // wherever several loops pass through one vertex, each way in has a way out
        while let Some(to) = next.get_mut(&at).and_then(Vec::pop) {
            corners.push(mesh.positions[at as usize].truncate());
            at = to;
        }
        if !corners.is_empty() {
            loops.push(corners);
        }
    }
    loops
}
