//! The edges at which pieces meet.
//!
//! Each open edge is matched with one that runs the other way between the same positions; the ends of both are then one vertex. So every edge
//! of the whole is paired, also where vertices of one piece share a position and must stay apart.

use glam::{DVec3, Vec3};
use planecut_csg::stages::DisjointSets;
use rustc_hash::FxHashMap;

use super::piece::Piece;
use crate::ExportError;

/// An open edge of a piece.
#[derive(Debug, Clone, Copy)]
struct OpenEdge {
    /// The positions that it joins, the one that was met first coming first.
    places: [u32; 2],
    /// Its ends at these.
    ends: [u32; 2],
    /// Whether it runs from the first to the second.
    is_forward: bool,
    /// The normal of its triangle.
    normal: Vec3,
}

/// The open edges of the pieces so far.
#[derive(Debug, Default)]
pub(super) struct Seams {
    /// Numbers of positions, by their bits.
    known: FxHashMap<[u64; 3], u32>,
    positions: Vec<DVec3>,
    /// For each vertex at an open edge, piece by piece, the number of its position.
    ends: Vec<u32>,
    edges: Vec<OpenEdge>,
}

/// Which vertices at open edges are one.
#[derive(Debug)]
pub(super) struct Joined {
    /// For each the first of those that are one with it.
    first: Vec<u32>,
    /// Edges that have no like.
    pub(super) open_edges: u64,
}

impl Joined {
    /// The end that one end is the same vertex as; of several the first.
    pub(super) fn stands_for(&self, end: usize) -> usize {
        self.first[end] as usize
    }

    /// How many ends are the same vertex as one before them.
    pub(super) fn repeated(&self) -> u64 {
        (0..).zip(&self.first).filter(|(end, first)| *end != **first).count() as u64
    }
}

impl Seams {
    /// Adds the open edges of the next piece.
    pub(super) fn add(&mut self, piece: &Piece) -> Result<(), ExportError> {
        let before = self.ends.len();
        if u32::try_from(before + piece.open_vertices.len()).is_err() {
            let what = format!("{before} and more vertices where pieces meet");
            return Err(ExportError::TooLarge { what });
        }
        for vertex in &piece.open_vertices {
            // adding zero makes -0 and 0 one
            let position = piece.mesh.positions[*vertex as usize] + DVec3::ZERO;
            let place = *self.known.entry(position.to_array().map(f64::to_bits)).or_insert_with(|| {
                self.positions.push(position);
                self.positions.len() as u32 - 1
            });
            self.ends.push(place);
        }
        let end = |vertex: u32| (before + piece.open_vertices.partition_point(|other| *other < vertex)) as u32;
        for open in &piece.open {
            let [from, to] = piece.ends(*open).map(end);
            let (at_from, at_to) = (self.ends[from as usize], self.ends[to as usize]);
            let is_forward = at_from <= at_to;
            let face = piece.mesh.triangle_faces[*open as usize / 3];
            let normal = piece.mesh.faces[face as usize].normal.as_vec3();
            let (places, ends) =
                if is_forward { ([at_from, at_to], [from, to]) } else { ([at_to, at_from], [to, from]) };
            self.edges.push(OpenEdge { places, ends, is_forward, normal });
        }
        Ok(())
    }

    /// Matches edges and joins their ends.
    pub(super) fn join(mut self) -> Joined {
        self.known = FxHashMap::default();
        let mut sets = DisjointSets::new(self.ends.len());
        self.edges.sort_unstable_by_key(|edge| (edge.places, !edge.is_forward, edge.ends));
        let mut open_edges = 0;
        for group in self.edges.chunk_by_mut(|a, b| a.places == b.places) {
            let [from, to] = group[0].places.map(|place| self.positions[place as usize]);
            let matched = matched(group, to - from);
            open_edges += (group.len() - 2 * matched.len()) as u64;
            for [one, other] in matched {
                one.into_iter().zip(other).for_each(|(a, b)| sets.join(a, b));
            }
        }
        // of each set the first that is met
        let mut first_of_root = vec![u32::MAX; self.ends.len()];
        let first = (0..self.ends.len() as u32).map(|end| {
            let first = &mut first_of_root[sets.root(end) as usize];
            *first = end.min(*first);
            *first
        });
        Joined { first: first.collect(), open_edges }
    }
}

/// Matches edges between the same two positions, those that run forward first, and gives the ends of each two.
///
/// Where there are several each way, the solid between two triangles that follow one another around the edge says which are matched.
fn matched(edges: &mut [OpenEdge], along: DVec3) -> Vec<[[u32; 2]; 2]> {
    let forward = edges.iter().filter(|edge| edge.is_forward).count();
    if let [one, other] = edges
        && forward == 1
    {
        return vec![[one.ends, other.ends]];
    }
    let axis = along.normalize_or(DVec3::Z);
    let (u, v) = axis.any_orthonormal_pair();
    let turn = |edge: &OpenEdge| {
        let normal = edge.normal.as_dvec3();
        // from the edge into its triangle, which lies to its left seen from outside
        let inward = normal.cross(if edge.is_forward { axis } else { -axis });
        turn_of(inward.dot(u), inward.dot(v))
    };
    let (forward, back) = edges.split_at(forward);
    let turned = |edges: &[OpenEdge]| {
        let mut turned: Vec<(f64, [u32; 2])> = edges.iter().map(|edge| (turn(edge), edge.ends)).collect();
        turned.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        turned
    };
    // the solid lies clockwise of what runs forward: turns fall
    let (forward, mut back) = (turned(forward), turned(back));
    let mut matched = Vec::new();
    for (turn, ends) in forward {
        if back.is_empty() {
            break;
        }
        let place = back.iter().position(|(other, _)| *other < turn).unwrap_or(0);
        matched.push([ends, back.remove(place).1]);
    }
    matched
}

/// A number from 0 to 4 that grows with the angle of a direction, counter-clockwise from the first axis.
fn turn_of(x: f64, y: f64) -> f64 {
    let share = y / (x.abs() + y.abs());
    match (x >= 0.0, y >= 0.0) {
        _ if share.is_nan() => 0.0,
        (true, true) => share,
        (false, _) => 2.0 - share,
        (true, false) => 4.0 + share,
    }
}
