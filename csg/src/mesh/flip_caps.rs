//! Caps: triangles without height, a corner on the side across from it.
//!
//! A face that is noise, but as long as its neighbours, can come down to three corners on a line when its short edges are
//! contracted. Programs that take such a triangle away one by one may tear the surface. Its long side is flipped instead:
//! the neighbour across it takes the corner in between, and no point moves.

use crate::ids::number32;
use glam::DVec3;
use planecut_parallel::prelude::*;

use super::Mesh;
use super::noise::noise_height;
use crate::closed_mesh::connectivity::{HalfEdges, NO_TWIN, next, previous};
use crate::model::MaterialId;

/// Flips away triangles whose height is rounding noise, where that makes no edge that is there already. Faces that lose all their
/// triangles are dropped. Nothing of a mesh that is not closed. Triangles on walls stay.
pub(super) fn flip_caps(mesh: &mut Mesh, walls: Option<MaterialId>) -> Option<()> {
    let mut caps = flat_triangles(mesh);
    if caps.is_empty() {
        return Some(());
    }
    let mut twins = HalfEdges::new(mesh.positions.len(), &mesh.triangles).twins();
    if twins.contains(&NO_TWIN) {
        return None;
    }
    // a flip can make a cap of the neighbour only where that was one; so few rounds do
    for _ in 0..8 {
        let before = caps.len();
        caps.retain(|cap| {
            long_side(mesh, *cap).is_some_and(|side| {
                let side = 3 * *cap + side;
                let is_on_wall =
                    |h: u32| Some(mesh.faces[mesh.triangle_faces[(h / 3) as usize] as usize].material) == walls;
                walls.is_some() && (is_on_wall(side) || is_on_wall(twins[side as usize]))
                    || !flip(mesh, &mut twins, side)
            })
        });
        if caps.len() == before || caps.is_empty() {
            break;
        }
    }
    let mut order: Vec<usize> = (0..mesh.triangles.len()).collect();
    order.sort_by_key(|t| mesh.triangle_faces[*t]);
    mesh.triangles = order.iter().map(|t| mesh.triangles[*t]).collect();
    mesh.triangle_faces.sort_unstable();
    mesh.drop_empty_faces();
    Some(())
}

/// The triangles whose height is noise.
pub(super) fn flat_triangles(mesh: &Mesh) -> Vec<u32> {
    let all = (0..number32(mesh.triangles.len())).into_par_iter().with_min_len(2048);
    all.filter(|t| is_flat(corners(mesh, *t))).collect()
}

fn corners(mesh: &Mesh, triangle: u32) -> [DVec3; 3] {
    mesh.triangles[triangle as usize].map(|v| mesh.positions[v as usize])
}

/// Whether the height of a triangle is noise.
pub(super) fn is_flat(corners: [DVec3; 3]) -> bool {
    let (height, [a, b, c]) = (noise_height(corners), corners);
    let (p, q) = (b - a, c - a);
    let longest = p.length_squared().max(q.length_squared()).max((c - b).length_squared());
    p.cross(q).length_squared() <= height * height * longest
}

/// The side that holds the third corner between its ends, where a triangle is a cap.
fn long_side(mesh: &Mesh, triangle: u32) -> Option<u32> {
    let at = corners(mesh, triangle);
    let length = |k: usize| at[k].distance(at[(k + 1) % 3]);
    let side = (0..3).max_by(|a, b| length(*a).total_cmp(&length(*b)))?;
    is_flat(at).then_some(number32(side))
}

/// Flips a side of a cap, whose two new triangles belong to the face of its neighbour. Gives whether it could.
fn flip(mesh: &mut Mesh, twins: &mut [u32], side: u32) -> bool {
    let back = twins[side as usize];
    let (cap, other) = (side / 3, back / 3);
    let [a, b, c] = [side, next(side), previous(side)].map(|h| start(mesh, h));
    let d = start(mesh, previous(back));
    if c == d || is_edge(mesh, twins, previous(side), d) {
        return false;
    }
    // a d b c: the side a b gives way to c d
    let [ad, db, bc, ca] = [next(back), previous(back), next(side), previous(side)].map(|h| twins[h as usize]);
    mesh.triangles[cap as usize] = [a, d, c];
    mesh.triangles[other as usize] = [d, b, c];
    mesh.triangle_faces[cap as usize] = mesh.triangle_faces[other as usize];
    let (cap, other) = (3 * cap, 3 * other);
    for (one, twin) in [(cap, ad), (cap + 1, other + 2), (cap + 2, ca), (other, db), (other + 1, bc)] {
        twins[one as usize] = twin;
        twins[twin as usize] = one;
    }
    true
}

fn start(mesh: &Mesh, half_edge: u32) -> u32 {
    mesh.triangles[(half_edge / 3) as usize][(half_edge % 3) as usize]
}

/// Whether an edge joins the start of a half-edge with another vertex: one of the half-edges around the start ends there.
fn is_edge(mesh: &Mesh, twins: &[u32], half_edge: u32, other: u32) -> bool {
    let around = |h: &u32| Some(twins[previous(*h) as usize]).filter(|h| *h != half_edge);
    std::iter::successors(Some(half_edge), around).any(|h| start(mesh, next(h)) == other)
}
