//! Which triangles of an index mesh meet at its edges.
//!
//! Half-edge `3 t + k` runs from corner `k` of triangle `t` to the next corner. Only indices are looked at, never positions.

use std::ops::Range;

use planecut_parallel::prelude::*;
use smallvec::SmallVec;

use crate::base::{by_group, with_room};
use crate::ids::number32;

/// The twin of a half-edge that has none.
pub const NO_TWIN: u32 = u32::MAX;

/// Up to this number of ends are compared with one another; more are sorted.
const FEW: usize = 16;

/// Vertices that one thread looks at in a row.
const VERTICES_OF_CHUNK: u32 = 1 << 10;

/// Maximum number of parts in which it is asked whether half-edges are paired, and the number of triangles for each.
const MOST_PARTS: usize = 16;
const LEAST_OF_PART: usize = 1 << 11;

/// The half-edge that follows in its triangle.
#[inline]
#[must_use]
pub fn next(half_edge: u32) -> u32 {
    if half_edge % 3 == 2 { half_edge - 2 } else { half_edge + 1 }
}

/// The half-edge before it in its triangle.
#[inline]
#[must_use]
pub fn previous(half_edge: u32) -> u32 {
    if half_edge.is_multiple_of(3) { half_edge + 2 } else { half_edge - 1 }
}

/// Whether every half-edge of triangles whose indices are below `vertices` has a twin: every directed edge occurs once, and so does its opposite. True
/// without triangles. Linear.
#[must_use]
pub fn are_all_paired(vertices: usize, triangles: &[[u32; 3]]) -> bool {
    // each part looks at all triangles
    let parts = planecut_parallel::current_num_threads().clamp(1, MOST_PARTS).min(1 + triangles.len() / LEAST_OF_PART);
    let of_part = |part: usize| {
        let some = vertices * part / parts..vertices * (part + 1) / parts;
        // mostly a number and a bit fit into half of a word
        if vertices < 1 << 31 { are_paired_at::<u32>(some, triangles) } else { are_paired_at::<u64>(some, triangles) }
    };
    let are_paired: Vec<bool> = (0..parts).into_par_iter().with_max_len(1).map(of_part).collect();
    are_paired.into_iter().all(|are| are)
}

/// Whether every half-edge with its lower end at one of some vertices has a twin; `E` holds twice the number of any vertex, and one more.
fn are_paired_at<E>(vertices: Range<usize>, triangles: &[[u32; 3]]) -> bool
where
    E: Copy + Default + Ord + Into<u64> + TryFrom<u64>,
{
    let count = vertices.len();
    // a vertex below the first wraps to beyond the last
    let place = |from: u32, to: u32| (from.min(to) as usize).wrapping_sub(vertices.start);
    let mut starts = vec![0_u32; count + 1];
    for &[a, b, c] in triangles {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            if let Some(start) = starts[1..].get_mut(place(from, to)) {
                *start += 1;
            }
        }
    }
    for k in 0..count {
        starts[k + 1] += starts[k];
    }
    // the higher end of each half-edge, and in the last bit whether it comes down from there
    let end = |from: u32, to: u32| E::try_from(u64::from(from.max(to)) << 1 | u64::from(from > to)).ok();
    let mut ends = with_room(starts[count] as usize, 3 * triangles.len());
    ends.resize(starts[count] as usize, E::default());
    for &[a, b, c] in triangles {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            if let Some(next) = starts[..count].get_mut(place(from, to)) {
                ends[*next as usize] = end(from, to).expect("there is room for the number of a vertex, and a bit");
                *next += 1;
            }
        }
    }
    // now those of each vertex end where they began before
    let mut first = 0;
    starts[..count].iter().all(|last| {
        let ends = &mut ends[std::mem::replace(&mut first, *last as usize)..*last as usize];
        if ends.len() <= FEW {
            // without a branch: each is there once, and so is the one in the opposite direction
            let is_paired = |end: &E| {
                let count = |count: u32, other: &E| {
                    let (end, other): (u64, u64) = ((*end).into(), (*other).into());
                    count + u32::from(other == end) + (u32::from(other == end ^ 1) << 16)
                };
                ends.iter().fold(0, count) == 1 << 16 | 1
            };
            return ends.iter().all(is_paired);
        }
        ends.sort_unstable();
        // of each other end one goes up, right before the one that comes down; an edge from a vertex to itself goes up alone
        let (pairs, rest) = ends.as_chunks();
        let is_pair = |[up, down]: &[E; 2]| {
            let (up, down): (u64, u64) = ((*up).into(), (*down).into());
            up & 1 == 0 && down == up + 1
        };
        rest.is_empty() && pairs.iter().all(is_pair)
    })
}

/// The vertices in ranges, each for one thread.
fn chunks_of(vertices: u32) -> Vec<Range<u32>> {
    let end = |first: u32| vertices.min(first.saturating_add(VERTICES_OF_CHUNK));
    (0..vertices).step_by(VERTICES_OF_CHUNK as usize).map(|first| first..end(first)).collect()
}

/// The other ends of the half-edges at a vertex: of those that leave it, and of those that come to it.
#[derive(Default)]
struct Ends {
    leaving: Vec<u32>,
    coming: Vec<u32>,
}

impl Ends {
    /// Those at a vertex, in the order of the half-edges that leave it.
    fn look_at(&mut self, half_edges: &HalfEdges<'_>, vertex: u32) {
        self.leaving.clear();
        self.coming.clear();
        for half_edge in half_edges.leaving(vertex) {
            let [_, to, from] = half_edges.turned(*half_edge);
            self.leaving.push(to);
            self.coming.push(from);
        }
    }

    /// Whether one half-edge leaves for an end, and one comes from there.
    fn are_one_each(&self, end: u32) -> bool {
        let count = |ends: &[u32]| ends.iter().map(|other| u32::from(*other == end)).sum::<u32>();
        count(&self.leaving) == 1 && count(&self.coming) == 1
    }

    /// Adds the twin of each half-edge that leaves a vertex, in order.
    fn find_twins(&mut self, half_edges: &HalfEdges<'_>, vertex: u32, found: &mut Vec<u32>) {
        self.look_at(half_edges, vertex);
        let half_edges = half_edges.leaving(vertex);
        if half_edges.len() <= FEW {
            found.extend(self.leaving.iter().map(|end| {
                let place = self.coming.iter().position(|other| other == end).filter(|_| self.are_one_each(*end));
                place.map_or(NO_TWIN, |place| previous(half_edges[place]))
            }));
            return;
        }
        let in_order = |ends: &[u32]| {
            let mut places: Vec<(u32, u32)> = ends.iter().copied().zip(half_edges.iter().copied()).collect();
            places.sort_unstable();
            places
        };
        let (leaving, coming) = (in_order(&self.leaving), in_order(&self.coming));
        let only = |places: &[(u32, u32)], end: u32| {
            let first = places.partition_point(|other| other.0 < end);
            let is_again = places.get(first + 1).is_some_and(|other| other.0 == end);
            places.get(first).filter(|other| other.0 == end && !is_again).map(|other| other.1)
        };
        found.extend(self.leaving.iter().map(|end| {
            let twin = only(&leaving, *end).and_then(|_| only(&coming, *end));
            twin.map_or(NO_TWIN, previous)
        }));
    }
}

/// The half-edges of triangles, listed by the vertex that they start at.
#[derive(Debug)]
pub struct HalfEdges<'a> {
    triangles: &'a [[u32; 3]],
    /// Where the half-edges of each vertex begin in `leaving`, and their end.
    starts: Vec<u32>,
    leaving: Vec<u32>,
}

impl<'a> HalfEdges<'a> {
    /// The half-edges of triangles whose indices are below `vertices`. Linear.
    #[must_use]
    pub fn new(vertices: usize, triangles: &'a [[u32; 3]]) -> Self {
        let corners = triangles.as_flattened();
        let (starts, leaving) = by_group(vertices, corners.len(), |corner| corners[corner] as usize, number32);
        Self { triangles, starts, leaving }
    }

    /// The vertex at which a half-edge starts.
    #[inline]
    #[must_use]
    pub fn from(&self, half_edge: u32) -> u32 {
        self.triangles[(half_edge / 3) as usize][(half_edge % 3) as usize]
    }

    /// The vertex at which a half-edge ends.
    #[inline]
    #[must_use]
    pub fn to(&self, half_edge: u32) -> u32 {
        self.from(next(half_edge))
    }

    /// The corners of a half-edge's triangle, from its start on.
    #[inline]
    fn turned(&self, half_edge: u32) -> [u32; 3] {
        let [a, b, c] = self.triangles[(half_edge / 3) as usize];
        match half_edge % 3 {
            0 => [a, b, c],
            1 => [b, c, a],
            _ => [c, a, b],
        }
    }

    /// The half-edges that start at a vertex, in ascending order.
    #[inline]
    #[must_use]
    pub fn leaving(&self, vertex: u32) -> &[u32] {
        let vertex = vertex as usize;
        &self.leaving[self.starts[vertex] as usize..self.starts[vertex + 1] as usize]
    }

    /// The half-edges from `a` to `b`, in ascending order.
    pub fn between(&self, a: u32, b: u32) -> impl Iterator<Item = u32> {
        self.leaving(a).iter().copied().filter(move |half_edge| self.to(*half_edge) == b)
    }

    /// The twin of each half-edge: the one in the opposite direction, where no other joins the same two vertices; otherwise [`NO_TWIN`].
    #[must_use]
    pub fn twins(&self) -> Vec<u32> {
        let of_chunk = |vertices: Range<u32>| {
            let range = self.starts[vertices.start as usize] as usize..self.starts[vertices.end as usize] as usize;
            let (mut ends, mut found) = (Ends::default(), Vec::with_capacity(range.len()));
            vertices.for_each(|vertex| ends.find_twins(self, vertex, &mut found));
            found
        };
        let found: Vec<Vec<u32>> = chunks_of(self.vertices()).into_par_iter().map(of_chunk).collect();
        let mut twins = vec![NO_TWIN; self.leaving.len()];
        for (half_edge, twin) in self.leaving.iter().zip(found.iter().flatten()) {
            twins[*half_edge as usize] = *twin;
        }
        twins
    }

    /// How many half-edges start at a vertex.
    #[inline]
    pub(crate) fn degree(&self, vertex: u32) -> u32 {
        self.starts[vertex as usize + 1] - self.starts[vertex as usize]
    }

    /// The edges `a < b` along which more than one half-edge runs from `a` to `b`, in ascending order.
    pub(crate) fn repeated(&self) -> Vec<(u32, u32)> {
        let repeated_at = |a: u32| {
            let mut ends: SmallVec<[u32; FEW]> = self.leaving(a).iter().map(|half_edge| self.to(*half_edge)).collect();
            // without a branch for each
            let is_repeated =
                |is_any: bool, k: usize| ends[..k].iter().fold(is_any, |any, end| any | (*end == ends[k]));
            if ends.len() > FEW || (1..ends.len()).fold(false, is_repeated) {
                ends.sort_unstable();
            } else {
                ends.clear();
            }
            let same = ends.chunk_by(|p, q| p == q).filter(|same| same.len() > 1 && a < same[0]);
            same.map(|same| (a, same[0])).collect::<Vec<(u32, u32)>>()
        };
        (0..self.vertices())
            .into_par_iter()
            .with_min_len(VERTICES_OF_CHUNK as usize)
            .flat_map_iter(repeated_at)
            .collect()
    }

    fn vertices(&self) -> u32 {
        number32(self.starts.len()) - 1
    }
}

#[cfg(test)]
mod tests {
    use planecut_testkit::random::Rng;

    use super::*;

    const TETRAHEDRON: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

    #[test]
    fn twins_run_back() {
        let half_edges = HalfEdges::new(4, &TETRAHEDRON);
        for (half_edge, twin) in (0..).zip(half_edges.twins()) {
            assert_eq!(half_edges.from(half_edge), half_edges.to(twin));
            assert_eq!(half_edges.to(half_edge), half_edges.from(twin));
            assert_eq!(previous(next(half_edge)), half_edge);
        }
        assert_eq!(half_edges.between(1, 3).collect::<Vec<u32>>(), [4]);
    }

    /// Around vertices of few and of many edges, with edges that are there several times, or once, or begin and end in one vertex: as looking at all pairs of half-edges tells.
    #[test]
    fn twins_are_those_that_all_pairs_of_half_edges_tell() {
        let mut rng = Rng::new(3);
        let mut told = [0; 2];
        for sides in [3, 5, FEW as u32 - 1, FEW as u32, FEW as u32 + 1, 50] {
            for _ in 0..60 {
                let next = |k: u32| (k + 1) % sides;
                let up = (0..sides).map(|k| [k, next(k), sides]);
                let mut triangles: Vec<[u32; 3]> = up.chain((0..sides).map(|k| [next(k), k, sides + 1])).collect();
                for _ in 0..rng.below(6) {
                    let place = rng.below(triangles.len());
                    triangles[place][rng.below(3)] = rng.below(sides as usize + 2) as u32;
                }
                let half_edges = HalfEdges::new(sides as usize + 2, &triangles);
                let all = || 0..3 * number32(triangles.len());
                let joins = |half_edge: u32| [half_edges.from(half_edge), half_edges.to(half_edge)];
                for (half_edge, twin) in all().zip(half_edges.twins()) {
                    let [a, b] = joins(half_edge);
                    let there: Vec<u32> = all().filter(|other| joins(*other) == [a, b]).collect();
                    let back: Vec<u32> = all().filter(|other| joins(*other) == [b, a]).collect();
                    let expected = if there.len() == 1 && back.len() == 1 { back[0] } else { NO_TWIN };
                    assert_eq!(twin, expected, "half-edge {half_edge} of {triangles:?}");
                    told[usize::from(twin == NO_TWIN)] += 1;
                }
            }
        }
        assert!(told.iter().all(|count| *count > 1_000), "twins, none: {told:?}");
    }

    #[test]
    fn a_tetrahedron_is_paired_and_its_damaged_forms_are_not() {
        let is_paired = |triangles: &[[u32; 3]]| are_all_paired(4, triangles);
        assert!(is_paired(&TETRAHEDRON) && is_paired(&[]));
        assert!(!is_paired(&TETRAHEDRON[1..]), "an open edge");
        let mut flipped = TETRAHEDRON;
        flipped[2].swap(0, 1);
        assert!(!is_paired(&flipped), "a flipped triangle");
        let doubled = [TETRAHEDRON, TETRAHEDRON].concat();
        assert!(!is_paired(&doubled), "every edge twice");
        let all = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];
        assert_eq!(HalfEdges::new(4, &doubled).repeated(), all);
        assert_eq!(HalfEdges::new(4, &TETRAHEDRON).repeated(), []);
    }

    /// Counts each directed edge of triangles in a map.
    fn is_each_edge_there_once_each_way(triangles: &[[u32; 3]]) -> bool {
        let mut count = std::collections::BTreeMap::new();
        for [a, b, c] in triangles {
            for edge in [(a, b), (b, c), (c, a)] {
                *count.entry(edge).or_insert(0) += 1;
            }
        }
        count.iter().all(|((a, b), uses)| *uses == 1 && a != b && count.get(&(*b, *a)) == Some(&1))
    }

    #[test]
    fn fans_of_any_size_are_paired_unless_a_corner_is_another() {
        let mut damaged = 0;
        for sides in [3, 4, 10, FEW as u32, FEW as u32 + 1, 40] {
            // two fans, from two tips around one ring
            let next = |k: u32| (k + 1) % sides;
            let up = (0..sides).map(|k| [k, next(k), sides]);
            let triangles: Vec<[u32; 3]> = up.chain((0..sides).map(|k| [next(k), k, sides + 1])).collect();
            let vertices = sides as usize + 2;
            let is_paired = |triangles: &[[u32; 3]]| {
                let all = are_all_paired(vertices, triangles);
                let third = |part: usize| vertices * part / 3..vertices * (part + 1) / 3;
                let in_parts = (0..3).all(|part| are_paired_at::<u32>(third(part), triangles));
                let with_long_numbers = (0..3).all(|part| are_paired_at::<u64>(third(part), triangles));
                assert_eq!((in_parts, with_long_numbers), (all, all), "{triangles:?} in parts");
                all
            };
            assert!(is_paired(&triangles) && is_each_edge_there_once_each_way(&triangles));
            for (place, corner) in (0..triangles.len()).flat_map(|place| [0, 1, 2].map(|corner| (place, corner))) {
                for other in 0..sides + 2 {
                    let mut changed = triangles.clone();
                    changed[place][corner] = other;
                    let expected = is_each_edge_there_once_each_way(&changed);
                    assert_eq!(is_paired(&changed), expected, "{changed:?}");
                    damaged += usize::from(!expected);
                }
            }
        }
        assert!(damaged > 1000);
    }
}
