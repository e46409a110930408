//! Flips diagonals towards the Delaunay criterion (Lawson 1977): fewer slivers, nicer meshes, the same boundary.

use super::{Node, orient};
use planecut_kernel::DVec2;
use rustc_hash::FxHashMap;

/// A quadrilateral is flipped only where its new triangles are clearly not flat: of an area above this share of the square
/// of its longest side.
const FLAT: f64 = 1e-9;

/// Improves triangles of nodes, counter-clockwise, in place. Boundary edges and bridges between copies of one node stay.
pub(super) fn improve(nodes: &[Node], triangles: &mut [[u32; 3]]) {
    if triangles.len() < 2 {
        return;
    }
    let mut across: FxHashMap<(u32, u32), u32> = FxHashMap::default();
    for (t, triangle) in triangles.iter().enumerate() {
        for k in 0..3 {
            across.insert((triangle[k], triangle[(k + 1) % 3]), t as u32);
        }
    }
    let mut queue: Vec<(u32, u32)> =
        across.keys().filter(|(a, b)| a < b && across.contains_key(&(*b, *a))).copied().collect();
    queue.sort_unstable();
    // Lawson's flips end; the cap guards against a cycle that rounding could make.
    let mut budget = 20 * triangles.len();
    while let Some((a, b)) = queue.pop() {
        let (Some(&left), Some(&right)) = (across.get(&(a, b)), across.get(&(b, a))) else { continue };
        let (Some(c), Some(d)) = (apex(&triangles[left as usize], a, b), apex(&triangles[right as usize], b, a)) else {
            continue;
        };
        let at = |node: u32| nodes[node as usize].corner.at;
        if budget == 0 || across.contains_key(&(c, d)) || across.contains_key(&(d, c)) || c == d {
            continue;
        }
        if !should_flip(at(a), at(b), at(c), at(d)) {
            continue;
        }
        budget -= 1;
        triangles[left as usize] = [a, d, c];
        triangles[right as usize] = [d, b, c];
        across.remove(&(a, b));
        across.remove(&(b, a));
        for (edge, t) in
            [((a, d), left), ((d, c), left), ((c, a), left), ((d, b), right), ((b, c), right), ((c, d), right)]
        {
            across.insert(edge, t);
        }
        for (p, q) in [(a, d), (d, b), (b, c), (c, a)] {
            if across.contains_key(&(q, p)) {
                queue.push((p.min(q), p.max(q)));
            }
        }
    }
}

fn apex(triangle: &[u32; 3], a: u32, b: u32) -> Option<u32> {
    (0..3).find(|k| triangle[*k] == a && triangle[(k + 1) % 3] == b).map(|k| triangle[(k + 2) % 3])
}

/// Whether the diagonal `a b` of the quadrilateral `a d b c` should become `c d`.
fn should_flip(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> bool {
    let longest =
        a.distance_squared(b).max(c.distance_squared(d)).max(a.distance_squared(c)).max(b.distance_squared(d));
    if orient(a, d, c) <= FLAT * longest || orient(d, b, c) <= FLAT * longest {
        return false;
    }
    // in-circle of a, b, c at d, by the sum of the opposite angles: flip where it exceeds half a turn
    let (u, v) = (a - c, b - c);
    let (s, t) = (b - d, a - d);
    let (cos_c, sin_c) = (u.dot(v), u.perp_dot(v));
    let (cos_d, sin_d) = (s.dot(t), s.perp_dot(t));
    let value = sin_c * cos_d + cos_c * sin_d;
    value < -1e-12 * longest * longest
}
