//! The edges in which the meshes of neighbouring blocks meet.

use glam::DVec3;
use rustc_hash::FxHashMap;

use crate::base::{Bounds, sortable};
use crate::mesh::Mesh;
use crate::model::MaterialId;

/// An edge from one point to another.
pub type SeamEdge = [DVec3; 2];

/// The edges in which the mesh of a block ends on its walls.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SeamEdges {
    /// By side (as [`BlockSides`](super::BlockSides) counts them). They are sorted, and directed as in the block of larger coordinates, so that two
    /// neighbours fit together exactly where their lists are equal.
    pub sides: [Vec<SeamEdge>; 6],
    /// Those on a line in which two walls cross, where a face goes through it: it goes on in any of the blocks around the line. They are sorted, and directed
    /// as in the mesh of the block: what is there of all blocks must cancel.
    pub crossings: Vec<SeamEdge>,
}

impl SeamEdges {
    /// The side of a block across an axis: that of larger coordinates, or of smaller ones.
    #[must_use]
    pub fn side(&self, axis: usize, is_larger: bool) -> &[SeamEdge] {
        &self.sides[2 * axis + usize::from(is_larger)]
    }

    /// Drops the faces on walls from the mesh of a block and gives the edges in which what is left ends there.
    pub(super) fn part(mesh: &mut Mesh, wall: MaterialId, block: &Bounds) -> Self {
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
                let (ends, way) = undirected(&[from, to]);
                let (first, last) = if way > 0 { (from, to) } else { (to, from) };
                edges.entry(ends).or_insert(Ends { first, last, sides: [0; 6] }).sides[side] += way;
            }
        }
        for Ends { first, last, sides } in edges.into_values() {
            let count: i32 = sides.iter().sum();
            if count == 0 {
                continue;
            }
            let is_on_wall = |axis: &usize| {
                first[*axis] == last[*axis] && [block.min, block.max].iter().any(|end| end[*axis] == first[*axis])
            };
            if (0..3).filter(is_on_wall).count() > 1 {
                let edge = if count < 0 { [first, last] } else { [last, first] };
                seams.crossings.extend(std::iter::repeat_n(edge, count.unsigned_abs() as usize));
                continue;
            }
            for (side, count) in sides.into_iter().enumerate().filter(|(_, count)| *count != 0) {
                // as a triangle that is kept goes along it, and turned over on one of each two sides that meet
                let is_forward = (count < 0) == (side % 2 == 0);
                let edge = if is_forward { [first, last] } else { [last, first] };
                seams.sides[side].extend(std::iter::repeat_n(edge, count.unsigned_abs() as usize));
            }
        }
        let lists = seams.sides.iter_mut().chain([&mut seams.crossings]);
        lists.for_each(|edges| edges.sort_unstable_by_key(|edge| edge.map(key)));
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

/// The ends of an edge, the lesser one first, and whether it goes from that (1) or to it (-1).
fn undirected([from, to]: &SeamEdge) -> ([[u64; 3]; 2], i32) {
    let (from, to) = (key(*from), key(*to));
    if from <= to { ([from, to], 1) } else { ([to, from], -1) }
}

/// How many of some edges are left where those of opposite directions cancel.
#[must_use]
pub fn uncancelled_edges<'a>(edges: impl IntoIterator<Item = &'a SeamEdge>) -> usize {
    let mut counts: FxHashMap<[[u64; 3]; 2], i32> = FxHashMap::default();
    for edge in edges {
        let (ends, way) = undirected(edge);
        *counts.entry(ends).or_default() += way;
    }
    counts.into_values().map(|count| count.unsigned_abs() as usize).sum()
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
