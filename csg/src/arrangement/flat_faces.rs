//! The flat faces of operands: triangles of one plane and one material that are neighbours.
//!
//! Edges between triangles of one face are *diagonals*: how a face was cut into triangles does not matter to what others cut out of it.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicU8, Ordering};

use planecut_parallel::prelude::*;
use rustc_hash::FxHashMap;

use super::Cutting;
use super::flat::are_coplanar;
use super::input::Input;
use super::predicates::{best_axis, normal_component};
use crate::base::DisjointSets;
use crate::closed_mesh::connectivity::NO_TWIN;
use crate::ids::{InputTriangleId, number32};

/// Half-edges that one thread looks at in a row.
const CHUNK: usize = 1 << 12;

/// What may be known of a half-edge: whether it lies within a face.
const UNKNOWN: u8 = 0;
const WITHIN: u8 = 1;
const BETWEEN: u8 = 2;

/// The flat faces of all operands, each found when it is first asked for.
#[derive(Debug)]
pub(super) struct FlatFaces<'a> {
    input: &'a Input<'a>,
    /// For each operand those of its own triangles that have more in common than vertices and edges.
    touching: Vec<Vec<[u32; 2]>>,
    of_operand: Vec<OnceLock<Vec<u32>>>,
    /// For each operand what is known of its half-edges, of two along an edge of the smaller one.
    of_half_edge: Vec<OnceLock<Vec<AtomicU8>>>,
}

impl<'a> FlatFaces<'a> {
    /// `touching` are triangles of one operand each that have more in common than vertices and edges: these are of no face together. Where
    /// triangles are cut one by one each is a face.
    pub(super) fn new(input: &'a Input<'a>, touching: &[[InputTriangleId; 2]], cutting: Cutting) -> Self {
        let mut of_operand: Vec<Vec<[u32; 2]>> = vec![Vec::new(); input.operands.len()];
        for pair in touching {
            let [(operand, one), (_, other)] = pair.map(|triangle| input.of_triangle(triangle));
            of_operand[operand].push([one, other]);
        }
        let of_none: Vec<OnceLock<Vec<u32>>> = of_operand.iter().map(|_| OnceLock::new()).collect();
        if cutting == Cutting::Triangles {
            for (of_operand, own) in of_none.iter().zip(&input.operands) {
                of_operand.get_or_init(|| (0..number32(own.triangles().len())).collect());
            }
        }
        let of_half_edge = of_operand.iter().map(|_| OnceLock::new()).collect();
        Self { input, touching: of_operand, of_operand: of_none, of_half_edge }
    }

    /// For each triangle of an operand the first one of its face.
    #[inline]
    pub(super) fn of(&self, operand: usize) -> &[u32] {
        self.of_operand[operand].get_or_init(|| faces(self.input, operand, &self.touching[operand]))
    }

    /// Whether a half-edge of an operand lies within a face.
    #[inline]
    pub(super) fn is_diagonal(&self, operand: usize, half_edge: u32) -> bool {
        let twin = self.input.operands[operand].twins()[half_edge as usize];
        if twin == NO_TWIN {
            return false;
        }
        let known = self.of_operand[operand].get();
        // where no faces touch themselves, those at an edge tell whether they are one: threads need not wait for all faces to be found
        if known.is_none() && self.touching[operand].is_empty() {
            return self.is_within(operand, half_edge.min(twin));
        }
        let first = known.map_or_else(|| self.of(operand), Vec::as_slice);
        first[half_edge as usize / 3] == first[twin as usize / 3]
    }

    /// Whether a half-edge, the smaller one of two along an edge, has triangles of one face on both sides.
    fn is_within(&self, operand: usize, half_edge: u32) -> bool {
        let unknown =
            || (0..3 * self.input.operands[operand].triangles().len()).map(|_| AtomicU8::new(UNKNOWN)).collect();
        let known = &self.of_half_edge[operand].get_or_init(unknown)[half_edge as usize];
        match known.load(Ordering::Relaxed) {
            UNKNOWN => {
                let is_within = is_within_face_of_plane(self.input, operand, half_edge);
                known.store(if is_within { WITHIN } else { BETWEEN }, Ordering::Relaxed);
                is_within
            }
            known => known == WITHIN,
        }
    }

    /// The triangles of faces that lie upon those of other operands, other than triangle by triangle: given pairs of triangles that do, and
    /// those of them that have the same corners.
    pub(super) fn overlapping(
        &self,
        overlapping: &[[InputTriangleId; 2]],
        identical: &[[InputTriangleId; 2]],
    ) -> Vec<InputTriangleId> {
        let place = |triangle: InputTriangleId| {
            let (operand, own) = self.input.of_triangle(triangle);
            (operand, self.of(operand)[own as usize])
        };
        let of_pair = |pair: &[InputTriangleId; 2]| pair.map(place);
        let mut pairs: Vec<[(usize, u32); 2]> = overlapping.iter().map(of_pair).collect();
        pairs.dedup();
        pairs.sort_unstable();
        pairs.dedup();
        let mut like: FxHashMap<[(usize, u32); 2], u32> = FxHashMap::default();
        for pair in identical {
            *like.entry(of_pair(pair)).or_insert(0) += 1;
        }
        // for each operand that is named the number of triangles of each face, and whether they are wanted
        let mut faces: Vec<Vec<(u32, bool)>> = vec![Vec::new(); self.input.operands.len()];
        for (operand, _) in pairs.as_flattened() {
            if faces[*operand].is_empty() {
                let first = self.of(*operand);
                faces[*operand] = vec![(0, false); first.len()];
                first.iter().for_each(|first| faces[*operand][*first as usize].0 += 1);
            }
        }
        for pair in &pairs {
            let like = like.get(pair);
            if pair.iter().any(|(operand, first)| like != Some(&faces[*operand][*first as usize].0)) {
                pair.iter().for_each(|(operand, first)| faces[*operand][*first as usize].1 = true);
            }
        }
        let mut all = Vec::new();
        for (operand, faces) in faces.iter().enumerate().filter(|(_, faces)| !faces.is_empty()) {
            let members = (0..).zip(self.of(operand)).filter(|(_, first)| faces[**first as usize].1);
            all.extend(members.map(|(triangle, _)| self.input.number(operand, triangle)));
        }
        all
    }
}

/// For each triangle of an operand the first one of its face.
fn faces(input: &Input<'_>, operand: usize, touching: &[[u32; 2]]) -> Vec<u32> {
    let own = &input.operands[operand];
    let count = own.triangles().len();
    let half_edges = (0..number32(3 * count)).into_par_iter().with_min_len(CHUNK);
    let is_within = |half_edge: &u32| is_within_face_of_plane(input, operand, *half_edge);
    let within: Vec<u32> = half_edges.filter(is_within).collect();
    let mut sets = DisjointSets::new(count);
    for half_edge in within {
        sets.join(half_edge / 3, own.twins()[half_edge as usize] / 3);
    }
    let mut first: Vec<u32> = (0..number32(count)).map(|triangle| sets.root(triangle)).collect();
    // where a face touches itself each triangle is one
    let mut is_alone = vec![false; count];
    for [one, other] in touching {
        if first[*one as usize] == first[*other as usize] {
            is_alone[first[*one as usize] as usize] = true;
        }
    }
    for (triangle, first) in (0..).zip(&mut first) {
        if is_alone[*first as usize] {
            *first = triangle;
        }
    }
    first
}

/// Whether a half-edge, the smaller one of two along an edge, has triangles of one plane on both sides.
pub(super) fn is_within_plane(input: &Input<'_>, operand: usize, half_edge: u32) -> bool {
    let own = &input.operands[operand];
    let twin = own.twins()[half_edge as usize];
    if twin == NO_TWIN || twin < half_edge {
        return false;
    }
    let (one, other) = (half_edge / 3, twin / 3);
    if own.is_body() {
        return own.plane(one) == own.plane(other);
    }
    let is_flat = |triangle: u32| own.flat().binary_search(&triangle).is_ok();
    let [a, b, c] = own.triangles()[one as usize].map(|vertex| own.positions()[vertex as usize]);
    let apex = own.positions()[own.triangles()[other as usize][(twin as usize + 2) % 3] as usize];
    are_coplanar([a, b, c, apex]) && (own.flat().is_empty() || !is_flat(one) && !is_flat(other))
}

/// Whether a half-edge, the smaller one of two along an edge, has triangles of one plane on both sides that are of one face.
fn is_within_face_of_plane(input: &Input<'_>, operand: usize, half_edge: u32) -> bool {
    is_within_plane(input, operand, half_edge) && is_within_face(input, operand, half_edge)
}

/// Whether the triangles of one plane at a half-edge are of one material, and continue one another.
pub(super) fn is_within_face(input: &Input<'_>, operand: usize, half_edge: u32) -> bool {
    let own = &input.operands[operand];
    let [one, other] = [half_edge, own.twins()[half_edge as usize]].map(|side| side / 3);
    if own.material(one) != own.material(other) {
        return false;
    }
    let [p, q] = [one, other].map(|triangle| input.triangle(operand, triangle));
    own.is_body() || best_axis(input, &p).is_some_and(|(axis, sign)| normal_component(input, &q, axis) == sign)
}
