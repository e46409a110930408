//! Caps: triangles without height, a corner on the side across from it.
//!
//! A face that is noise, but as long as its neighbours, can come down to three corners on a line when its short edges are
//! contracted. Programs that take such a triangle away one by one may tear the surface. Its long side is flipped instead:
//! the neighbour across it takes the corner in between, and no point moves.

use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::Mesh;

/// Flips away triangles of at most this height, in the mesh's units, where that makes no edge that is there already. Faces
/// that lose all their triangles are dropped.
pub(crate) fn flip_caps(mesh: &mut Mesh, height: f64) {
    let all = (0..mesh.triangles.len() as u32).into_par_iter().with_min_len(2048);
    let mut caps: Vec<u32> = all.filter(|t| is_flat(mesh, *t, height)).collect();
    if caps.is_empty() {
        return;
    }
    let mut across: FxHashMap<(u32, u32), u32> = FxHashMap::default();
    for (t, triangle) in (0u32..).zip(&mesh.triangles) {
        across.extend((0..3).map(|k| ((triangle[k], triangle[(k + 1) % 3]), t)));
    }
    // a flip can make a cap of the neighbour only where that was one; so few rounds do
    for _ in 0..8 {
        let before = caps.len();
        caps.retain(|cap| long_side(mesh, *cap, height).is_some_and(|side| !flip(mesh, &mut across, *cap, side)));
        if caps.len() == before || caps.is_empty() {
            break;
        }
    }
    let mut order: Vec<usize> = (0..mesh.triangles.len()).collect();
    order.sort_by_key(|t| mesh.triangle_faces[*t]);
    mesh.triangles = order.iter().map(|t| mesh.triangles[*t]).collect();
    mesh.triangle_faces.sort_unstable();
    mesh.drop_empty_faces();
}

/// Whether a triangle is at most so high.
fn is_flat(mesh: &Mesh, triangle: u32, height: f64) -> bool {
    let [a, b, c] = mesh.triangles[triangle as usize].map(|v| mesh.positions[v as usize]);
    let (p, q) = (b - a, c - a);
    let longest = p.length_squared().max(q.length_squared()).max((c - b).length_squared());
    p.cross(q).length_squared() <= height * height * longest
}

/// The side that holds the third corner between its ends, where a triangle is a cap.
fn long_side(mesh: &Mesh, triangle: u32, height: f64) -> Option<usize> {
    let at = mesh.triangles[triangle as usize].map(|v| mesh.positions[v as usize]);
    let length = |k: usize| at[k].distance(at[(k + 1) % 3]);
    let side = (0..3).max_by(|a, b| length(*a).total_cmp(&length(*b)))?;
    is_flat(mesh, triangle, height).then_some(side)
}

/// Flips a side of a cap, whose two new triangles belong to the face of its neighbour.
fn flip(mesh: &mut Mesh, across: &mut FxHashMap<(u32, u32), u32>, cap: u32, side: usize) -> bool {
    let [a, b, c] = [0, 1, 2].map(|k| mesh.triangles[cap as usize][(side + k) % 3]);
    let Some(&other) = across.get(&(b, a)) else { return false };
    let neighbour = mesh.triangles[other as usize];
    let Some(d) = neighbour.into_iter().find(|v| *v != a && *v != b) else { return false };
    if c == d || across.contains_key(&(c, d)) || across.contains_key(&(d, c)) {
        return false;
    }
    // a d b c: the side a b gives way to c d
    mesh.triangles[cap as usize] = [a, d, c];
    mesh.triangles[other as usize] = [d, b, c];
    mesh.triangle_faces[cap as usize] = mesh.triangle_faces[other as usize];
    across.remove(&(a, b));
    across.remove(&(b, a));
    for (edge, t) in [((a, d), cap), ((d, c), cap), ((c, a), cap), ((d, b), other), ((b, c), other), ((c, d), other)] {
        across.insert(edge, t);
    }
    true
}
