//! Mesh vertices: corners joined around each fan, so that the result is an oriented 2-manifold.
//!
//! Half-edges were paired so that each pair bounds one wedge of solid; walking the pairs splits pinched points and edges
//! with four faces by itself. Two different edges can still join the same two vertices, and a diagonal can coincide with
//! an edge: the second copy then gets a midpoint.

use rustc_hash::FxHashMap;

use super::cancel::HalfEdge;
use crate::mesh::Mesh;

/// The vertex at the start of each half-edge; and for each vertex the point it lies on.
pub(super) fn vertices(pieces: &[HalfEdge], following: &[u32]) -> (Vec<u32>, Vec<u32>) {
    let mut vertex = vec![u32::MAX; pieces.len()];
    let mut point = Vec::new();
    for start in 0..pieces.len() {
        let mut piece = start;
        if vertex[piece] != u32::MAX {
            continue;
        }
        // Around the fan: the twin ends at the corner's point, and its follower starts there.
        while vertex[piece] == u32::MAX {
            vertex[piece] = point.len() as u32;
            piece = following[pieces[piece].twin as usize] as usize;
        }
        point.push(pieces[start].from);
    }
    (vertex, point)
}

/// Splits every edge that joins the same two vertices as an earlier one, in both of its triangles, at a midpoint.
/// Gives how many were split.
pub(super) fn split_repeated_edges(mesh: &mut Mesh) -> usize {
    let repeated = repeated_edges(&mesh.triangles);
    if repeated.is_empty() {
        return 0;
    }
    let mut split = 0;
    let mut additions: Vec<([u32; 3], u32)> = Vec::new();
    for ([a, b], sides) in repeated {
        // All but one pair of opposite sides get a midpoint of their own.
        for (there, back) in match_sides(&sides, mesh, [a, b]).into_iter().skip(1) {
            let middle = mesh.positions.len() as u32;
            mesh.positions.push(0.5 * (mesh.positions[a as usize] + mesh.positions[b as usize]));
            for triangle in [there, back] {
                let cut = &mut mesh.triangles[triangle as usize];
                let k = (0..3).find(|k| is_edge(cut[*k], cut[(k + 1) % 3], [a, b])).unwrap_or(0);
                let (from, to, tip) = (cut[k], cut[(k + 1) % 3], cut[(k + 2) % 3]);
                *cut = [from, middle, tip];
                additions.push(([middle, to, tip], mesh.triangle_faces[triangle as usize]));
            }
            split += 1;
        }
    }
    insert_triangles(mesh, additions);
    split
}

/// Adds triangles so that those of one face still follow one another.
fn insert_triangles(mesh: &mut Mesh, additions: Vec<([u32; 3], u32)>) {
    mesh.triangles.extend(additions.iter().map(|(triangle, _)| *triangle));
    mesh.triangle_faces.extend(additions.iter().map(|(_, face)| *face));
    let mut order: Vec<u32> = (0..mesh.triangles.len() as u32).collect();
    order.sort_by_key(|k| mesh.triangle_faces[*k as usize]);
    mesh.triangles = order.iter().map(|k| mesh.triangles[*k as usize]).collect();
    mesh.triangle_faces.sort_unstable();
}

fn is_edge(p: u32, q: u32, [a, b]: [u32; 2]) -> bool {
    p == a && q == b || p == b && q == a
}

/// The edges that more than two triangles share, with those triangles.
fn repeated_edges(triangles: &[[u32; 3]]) -> Vec<([u32; 2], Vec<u32>)> {
    let mut directed: Vec<(u64, u32)> = Vec::with_capacity(3 * triangles.len());
    for (k, triangle) in triangles.iter().enumerate() {
        for i in 0..3 {
            let (a, b) = (triangle[i], triangle[(i + 1) % 3]);
            directed.push((u64::from(a) << 32 | u64::from(b), k as u32));
        }
    }
    directed.sort_unstable();
    let mut repeated: FxHashMap<[u32; 2], ()> = FxHashMap::default();
    for pair in directed.windows(2) {
        if pair[0].0 == pair[1].0 {
            let (a, b) = ((pair[0].0 >> 32) as u32, pair[0].0 as u32);
            repeated.insert([a.min(b), a.max(b)], ());
        }
    }
    let mut keys: Vec<[u32; 2]> = repeated.into_keys().collect();
    keys.sort_unstable();
    let sides = |[a, b]: [u32; 2]| {
        let of = |p: u32, q: u32| {
            let key = u64::from(p) << 32 | u64::from(q);
            let start = directed.partition_point(|(k, _)| *k < key);
            directed[start..].iter().take_while(move |(k, _)| *k == key).map(|(_, triangle)| *triangle)
        };
        of(a, b).chain(of(b, a)).collect()
    };
    keys.into_iter().map(|key| (key, sides(key))).collect()
}

/// Pairs the triangles on both sides of a repeated edge. A diagonal belongs to two triangles of one face, so sides of the
/// same face go together first.
fn match_sides(sides: &[u32], mesh: &Mesh, [a, b]: [u32; 2]) -> Vec<(u32, u32)> {
    let forward = |t: u32| {
        let triangle = mesh.triangles[t as usize];
        (0..3).any(|k| triangle[k] == a && triangle[(k + 1) % 3] == b)
    };
    let faces = &mesh.triangle_faces;
    let (mut there, mut back): (Vec<u32>, Vec<u32>) = sides.iter().partition(|t| forward(**t));
    let mut pairs = Vec::new();
    there.retain(|t| {
        let Some(k) = back.iter().position(|s| faces[*s as usize] == faces[*t as usize]) else { return true };
        pairs.insert(0, (*t, back.swap_remove(k)));
        false
    });
    let mut all: Vec<(u32, u32)> = there.into_iter().zip(back).collect();
    all.append(&mut pairs);
    all
}
