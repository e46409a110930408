//! The edges in which the meshes of neighbouring blocks meet.

use glam::DVec3;
use rustc_hash::FxHashMap;

use crate::base::sortable;
use crate::mesh::Mesh;
use crate::model::MaterialId;

/// An edge from one point to another.
pub type SeamEdge = [DVec3; 2];

/// The edges in which the mesh of a block ends on its walls, by side (as [`BlockSides`](super::BlockSides) counts them). They are sorted, and directed as in the
/// block of larger coordinates, so that two neighbours fit together exactly where their lists are equal.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SeamEdges(pub [Vec<SeamEdge>; 6]);

impl SeamEdges {
    /// The side of a block across an axis: that of larger coordinates, or of smaller ones.
    #[must_use]
    pub fn side(&self, axis: usize, is_larger: bool) -> &[SeamEdge] {
        &self.0[2 * axis + usize::from(is_larger)]
    }

    /// Drops the faces on walls from a mesh and gives the edges in which what is left ends there.
    pub(super) fn part(mesh: &mut Mesh, wall: MaterialId) -> Self {
        let mut seams = Self::default();
        let is_wall: Vec<bool> = mesh.faces.iter().map(|face| face.material == wall).collect();
        if !is_wall.contains(&true) {
            return seams;
        }
        let (on_wall, kept): (Vec<usize>, Vec<usize>) =
            (0..mesh.triangles.len()).partition(|triangle| is_wall[mesh.triangle_faces[*triangle] as usize]);
        // edges between two triangles on walls are no ends
        let mut edges: FxHashMap<[[u64; 3]; 2], Ends> = FxHashMap::default();
        for triangle in on_wall {
            let normal = mesh.faces[mesh.triangle_faces[triangle] as usize].normal;
            let axis = normal.abs().max_position();
            let side = 2 * axis + usize::from(normal[axis] > 0.0);
            let [a, b, c] = mesh.triangles[triangle].map(|vertex| mesh.positions[vertex as usize]);
            // an edge whose ends are one point once they are rounded goes nowhere
            for (from, to) in [(a, b), (b, c), (c, a)].into_iter().filter(|(from, to)| from != to) {
                let is_forward = key(from) <= key(to);
                let (first, last) = if is_forward { (from, to) } else { (to, from) };
                let ends = edges.entry([key(first), key(last)]).or_insert(Ends { first, last, sides: [0; 6] });
                ends.sides[side] += if is_forward { 1 } else { -1 };
            }
        }
        for Ends { first, last, sides } in edges.into_values() {
            if sides.iter().sum::<i32>() == 0 {
                continue;
            }
            for (side, count) in sides.into_iter().enumerate().filter(|(_, count)| *count != 0) {
                // as a triangle that is kept goes along it, and turned over on one of each two sides that meet
                let is_forward = (count < 0) == (side % 2 == 0);
                let edge = if is_forward { [first, last] } else { [last, first] };
                seams.0[side].extend(std::iter::repeat_n(edge, count.unsigned_abs() as usize));
            }
        }
        seams.0.iter_mut().for_each(|edges| edges.sort_unstable_by_key(|edge| edge.map(key)));
        mesh.triangle_faces = kept.iter().map(|triangle| mesh.triangle_faces[*triangle]).collect();
        mesh.triangles = kept.iter().map(|triangle| mesh.triangles[*triangle]).collect();
        mesh.drop_empty_faces();
        mesh.drop_unused_positions();
        seams
    }
}

/// An edge, and how many more times walls of each side go along it than back.
struct Ends {
    first: DVec3,
    last: DVec3,
    sides: [i32; 6],
}

fn key(at: DVec3) -> [u64; 3] {
    (at + 0.0).to_array().map(sortable)
}

/// Number of edges that are in one of two sorted lists alone.
#[must_use]
pub fn unmatched_edges(a: &[SeamEdge], b: &[SeamEdge]) -> usize {
    let (mut a, mut b) = (a.iter().peekable(), b.iter().peekable());
    let mut unmatched = 0;
    loop {
        let order = match (a.peek(), b.peek()) {
            (None, None) => return unmatched,
            (Some(_), None) => std::cmp::Ordering::Less,
            (None, Some(_)) => std::cmp::Ordering::Greater,
            (Some(p), Some(q)) => p.map(key).cmp(&q.map(key)),
        };
        unmatched += usize::from(order.is_ne());
        if order.is_le() {
            a.next();
        }
        if order.is_ge() {
            b.next();
        }
    }
}
