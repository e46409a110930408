//! Mesh vertices: corners joined around each fan, so that the result is an oriented 2-manifold.
//!
//! Half-edges were paired so that each pair bounds one wedge of solid; walking the pairs splits pinched points and edges
//! with four faces by itself. Two different edges can still join the same two vertices, and a diagonal can coincide with
//! an edge: the second copy then gets a midpoint.

use std::sync::atomic::{AtomicU32, Ordering};

use planecut_parallel::prelude::*;
use rustc_hash::FxHashSet;

use super::cancel::HalfEdge;
use crate::base::{concat_owned, made_by_place, repeated};
use crate::closed_mesh::connectivity::{HalfEdges, are_all_paired};
use crate::ids::{HalfEdgeId, Id, PointId, VertexId, number32};
use crate::mesh::Mesh;

/// Number of half-edges that a thread looks at in a row.
const CHUNK: usize = 1024;

/// The vertex at the start of each half-edge; and for each vertex the point it lies on. Vertices are numbered by the first of their half-edges.
pub(super) fn vertices(pieces: &[HalfEdge], following: Vec<HalfEdgeId>) -> (Vec<VertexId>, Vec<PointId>) {
    // Around the fan: the twin ends at the corner's point, and its follower starts there. In a list of their own several are on their way from memory at once.
    let turned = |piece: usize| following[pieces[piece].twin.index()];
    let turned: &[HalfEdgeId] = &made_by_place(pieces.len(), CHUNK, turned);
    drop(following);
    let around = |first: HalfEdgeId| {
        let next = move |piece: &HalfEdgeId| Some(turned[piece.index()]).filter(|piece| *piece != first);
        std::iter::successors(Some(first), next)
    };
    let is_first = |piece: &HalfEdgeId| around(*piece).skip(1).all(|other| other > *piece);
    let firsts_of = |(chunk, some): (usize, &[HalfEdge])| -> Vec<HalfEdgeId> {
        HalfEdgeId::all(some.len()).map(|piece| piece.plus(chunk * CHUNK)).filter(is_first).collect()
    };
    let firsts = concat_owned(pieces.par_chunks(CHUNK).enumerate().map(firsts_of).collect());
    let vertex = repeated(pieces.len(), || AtomicU32::new(0));
    firsts.par_iter().enumerate().with_min_len(512).for_each(|(number, first)| {
        let number = VertexId::from_index(number).number();
        around(*first).for_each(|piece| vertex[piece.index()].store(number, Ordering::Relaxed));
    });
    // on one thread it is the same memory
    let number = |vertex: AtomicU32| VertexId::from_index(vertex.into_inner() as usize);
    let vertex = vertex.into_iter().map(number).collect();
    (vertex, made_by_place(firsts.len(), CHUNK, |k| pieces[firsts[k].index()].from))
}

/// The half-edge behind each side of each triangle; [`Id::NONE`] for a diagonal.
pub(crate) type Labels = Vec<[HalfEdgeId; 3]>;

/// A side of a triangle: its number among [`HalfEdges`].
pub(crate) type TriangleSide = u32;

/// Edges that join the same two vertices as others: of each two vertices the sides that run one way, and those that run back.
pub(crate) type RepeatedEdges = Vec<[Vec<TriangleSide>; 2]>;

/// The edges of a mesh that are there more than once; nothing where each is used once each way.
pub(crate) fn repeated_edges(mesh: &Mesh) -> Option<RepeatedEdges> {
    let vertices = mesh.positions.len();
    if are_all_paired(vertices, &mesh.triangles) {
        return None;
    }
    let half_edges = HalfEdges::new(vertices, &mesh.triangles);
    let along = |(a, b)| [(a, b), (b, a)].map(|(a, b)| half_edges.between(a, b).collect());
    Some(half_edges.repeated().into_iter().map(along).collect())
}

/// Splits every edge that joins the same two vertices as another one, in both of its triangles, at a midpoint, until all
/// directed edges are unique; `repeated` are the [`repeated_edges`] to begin with. Gives how many were split.
///
/// `twin` gives the half-edge that bounds the same wedge of solid.
pub(crate) fn split_repeated_edges(
    mesh: &mut Mesh,
    labels: &mut Labels,
    mut repeated: RepeatedEdges,
    twin: impl Fn(HalfEdgeId) -> HalfEdgeId,
) -> usize {
    let mut split = 0;
    loop {
        let mut touched: FxHashSet<u32> = FxHashSet::default();
        let (mut additions, mut are_left) = (Vec::new(), false);
        for sides in &repeated {
            // sides of a triangle that was split have other numbers now
            are_left |= sides.iter().flatten().any(|side| touched.contains(&(side / 3)));
            // All but one pair of opposite sides get a midpoint of their own; a triangle is split once a round.
            for (there, back) in match_sides(sides, &mesh.triangle_faces, labels, &twin).into_iter().skip(1) {
                if touched.contains(&(there / 3)) || touched.contains(&(back / 3)) {
                    are_left = true;
                    continue;
                }
                touched.extend([there / 3, back / 3]);
                split_edge(mesh, labels, [there, back], &mut additions);
                split += 1;
            }
        }
        if !additions.is_empty() {
            insert_triangles(mesh, labels, &additions);
        }
        // what ends at a midpoint is not repeated
        if !are_left {
            return split;
        }
        repeated = repeated_edges(mesh).unwrap_or_default();
    }
}

/// A triangle to be added: its vertices, its labels, its face.
type Addition = ([u32; 3], [HalfEdgeId; 3], u32);

/// Splits both triangles at an edge by its midpoint.
fn split_edge(mesh: &mut Mesh, labels: &mut Labels, sides: [TriangleSide; 2], additions: &mut Vec<Addition>) {
    let middle = number32(mesh.positions.len());
    let (t, k) = ((sides[0] / 3) as usize, (sides[0] % 3) as usize);
    let ends = [mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]].map(|v| mesh.positions[v as usize]);
    mesh.positions.push(0.5 * (ends[0] + ends[1]));
    for side in sides {
        let (t, k) = ((side / 3) as usize, (side % 3) as usize);
        let ([from, to, tip], [cut, next, last]) = (rotated(mesh.triangles[t], k), rotated(labels[t], k));
        mesh.triangles[t] = [from, middle, tip];
        labels[t] = [cut, HalfEdgeId::NONE, last];
        additions.push(([middle, to, tip], [cut, next, HalfEdgeId::NONE], mesh.triangle_faces[t]));
    }
}

/// Three things that follow one another in a cycle, from another one on.
fn rotated<T: Copy>(three: [T; 3], first: usize) -> [T; 3] {
    std::array::from_fn(|k| three[(first + k) % 3])
}

/// Adds triangles, each after the others of its face; the faces of triangles are ascending.
fn insert_triangles(mesh: &mut Mesh, labels: &mut Labels, additions: &[Addition]) {
    let place = |(number, (_, _, face)): (usize, &Addition)| {
        (mesh.triangle_faces.partition_point(|other| other <= face), number)
    };
    let mut places: Vec<(usize, usize)> = additions.iter().enumerate().map(place).collect();
    places.sort_unstable();
    insert(&mut mesh.triangles, &places, |number| additions[number].0);
    insert(labels, &places, |number| additions[number].1);
    insert(&mut mesh.triangle_faces, &places, |number| additions[number].2);
}

/// Inserts elements, given by numbers, before places of a list, which are ascending.
fn insert<T: Copy>(list: &mut Vec<T>, places: &[(usize, usize)], element: impl Fn(usize) -> T) {
    let mut end = list.len();
    list.extend(places.iter().map(|(_, number)| element(*number)));
    for (before, (place, number)) in places.iter().enumerate().rev() {
        list.copy_within(*place..end, *place + before + 1);
        list[*place + before] = element(*number);
        end = *place;
    }
}

/// Pairs the sides of a repeated edge: of the boundary by its half-edges, first; diagonals within their face.
fn match_sides(
    [there, back]: &[Vec<TriangleSide>; 2],
    faces: &[u32],
    labels: &Labels,
    twin: &impl Fn(HalfEdgeId) -> HalfEdgeId,
) -> Vec<(TriangleSide, TriangleSide)> {
    let label = |side: TriangleSide| labels[(side / 3) as usize][(side % 3) as usize];
    let is_pair = |s: TriangleSide, t: TriangleSide| match label(s) {
        HalfEdgeId::NONE => label(t) == HalfEdgeId::NONE && faces[(s / 3) as usize] == faces[(t / 3) as usize],
        piece => label(t) == twin(piece),
    };
    let mut left = back.clone();
    let mut pairs = Vec::with_capacity(there.len());
    let mut in_order = there.clone();
    in_order.sort_by_key(|side| label(*side) == HalfEdgeId::NONE);
    for side in in_order {
        if let Some(k) = left.iter().position(|other| is_pair(side, *other)) {
            pairs.push((side, left.swap_remove(k)));
        }
    }
    pairs
}

#[cfg(test)]
mod tests {
    use planecut_testkit::random::Rng;

    use super::*;

    #[test]
    fn triangles_are_inserted_after_those_of_their_face() {
        for seed in 0..200 {
            let mut rng = Rng::spread(seed);
            let faces = 1 + rng.below(20);
            let mut triangle_faces: Vec<u32> =
                (0..faces).chain((0..rng.below(50)).map(|_| rng.below(faces))).map(number32).collect();
            triangle_faces.sort_unstable();
            let triangle = |number: usize| [number32(number); 3];
            let label = |number: usize| [HalfEdgeId::from_index(number); 3];
            let count = triangle_faces.len();
            let added: Vec<u32> = (0..rng.below(30)).map(|_| number32(rng.below(faces))).collect();
            let additions: Vec<Addition> =
                (count..).zip(&added).map(|(number, face)| (triangle(number), label(number), *face)).collect();
            // a stable sort of all by their faces
            let mut expected: Vec<(u32, usize)> =
                triangle_faces.iter().chain(&added).enumerate().map(|(number, face)| (*face, number)).collect();
            expected.sort_by_key(|(face, _)| *face);
            let mut mesh = Mesh { triangles: (0..count).map(triangle).collect(), triangle_faces, ..Mesh::default() };
            let mut labels: Labels = (0..count).map(label).collect();
            insert_triangles(&mut mesh, &mut labels, &additions);
            let numbers: Vec<usize> = expected.iter().map(|(_, number)| *number).collect();
            assert_eq!(mesh.triangle_faces, expected.iter().map(|(face, _)| *face).collect::<Vec<_>>(), "seed {seed}");
            assert_eq!(
                mesh.triangles,
                numbers.iter().map(|number| triangle(*number)).collect::<Vec<_>>(),
                "seed {seed}"
            );
            assert_eq!(labels, numbers.iter().map(|number| label(*number)).collect::<Vec<_>>(), "seed {seed}");
        }
    }
}
