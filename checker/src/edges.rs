//! The half-edges of a triangle mesh, matched by their vertex indices.
//!
//! Half-edge `3 t + k` runs from corner `k` of triangle `t` to the next corner. The pipeline has half-edges of its own: this crate
//! shares no code with what it checks.

use std::ops::Range;

use crate::components::Components;

/// The twin of a half-edge that has none, or not exactly one.
pub(crate) const NO_TWIN: u32 = u32::MAX;

/// A directed edge by its vertex indices.
pub(crate) type DirectedEdge = (u32, u32);

/// The vertex at which a half-edge starts.
pub(crate) fn origin(triangles: &[[u32; 3]], half_edge: u32) -> u32 {
    triangles[(half_edge / 3) as usize][(half_edge % 3) as usize]
}

/// The next half-edge around the same triangle.
pub(crate) fn next(half_edge: u32) -> u32 {
    if half_edge % 3 == 2 { half_edge - 2 } else { half_edge + 1 }
}

/// The previous half-edge around the same triangle.
pub(crate) fn previous(half_edge: u32) -> u32 {
    if half_edge.is_multiple_of(3) { half_edge + 2 } else { half_edge - 1 }
}

/// How the half-edges of a mesh match.
pub(crate) struct EdgeMatching {
    /// Per half-edge its twin where its edge is used once in each direction, otherwise [`NO_TWIN`].
    pub(crate) twins: Vec<u32>,
    /// Number of different undirected edges.
    pub(crate) edges: usize,
    /// Number of edges whose two directions are used unequally often.
    pub(crate) open: usize,
    /// The first of them by vertex index, in the direction that is used more often.
    pub(crate) first_open: Option<DirectedEdge>,
    /// Number of edges used equally often in both directions, but more than once.
    pub(crate) multiple: usize,
    /// The first of them by vertex index, and how often each direction is used.
    pub(crate) first_multiple: Option<(DirectedEdge, usize)>,
    /// Number of sets of triangles that are connected through edges.
    pub(crate) components: usize,
}

/// One use of an undirected edge, kept with the edge's smaller vertex.
#[derive(Clone, Copy, Default)]
struct EdgeUse {
    larger: u32,
    half_edge: u32,
}

/// Uses are gathered for this many vertices at a time, so that memory is bounded.
const VERTICES_AT_A_TIME: usize = 1 << 21;

impl EdgeMatching {
    /// Matches the half-edges of triangles whose indices are below `vertices`; triangles with a repeated index take no part.
    ///
    /// Uses are gathered at the edge's smaller vertex by a counting sort, so the time is linear for vertices of bounded degree.
    pub(crate) fn new(vertices: usize, triangles: &[[u32; 3]]) -> Self {
        let mut matching = Self {
            twins: vec![NO_TWIN; 3 * triangles.len()],
            edges: 0,
            open: 0,
            first_open: None,
            multiple: 0,
            first_multiple: None,
            components: 0,
        };
        let mut components = Components::new(triangles.len());
        let mut bucket: Vec<(EdgeUse, bool)> = Vec::new();
        for first in (0..vertices).step_by(VERTICES_AT_A_TIME) {
            let (starts, uses) = gather(first..vertices.min(first + VERTICES_AT_A_TIME), triangles);
            for (smaller, ends) in (first..).zip(starts.windows(2)) {
                let is_backward = |u: &EdgeUse| origin(triangles, u.half_edge) == u.larger;
                bucket.clear();
                bucket.extend(uses[ends[0] as usize..ends[1] as usize].iter().map(|u| (*u, is_backward(u))));
                bucket.sort_unstable_by_key(|(u, is_backward)| (u.larger, *is_backward, u.half_edge));
                for uses in bucket.chunk_by(|a, b| a.0.larger == b.0.larger) {
                    matching.record(smaller as u32, uses);
                    for pair in uses.windows(2) {
                        components.join(pair[0].0.half_edge / 3, pair[1].0.half_edge / 3);
                    }
                }
            }
        }
        // Triangles with a repeated index were joined with nothing, so they are sets of their own.
        matching.components = components.count((0..triangles.len()).filter(|&t| !has_repeated_index(triangles[t])));
        matching
    }

    /// Takes in all uses of one edge, each with whether it runs from the larger vertex to the smaller, those that do last.
    fn record(&mut self, smaller: u32, uses: &[(EdgeUse, bool)]) {
        self.edges += 1;
        let larger = uses[0].0.larger;
        let forward = uses.partition_point(|(_, is_backward)| !is_backward);
        let backward = uses.len() - forward;
        if forward == 1 && backward == 1 {
            let (a, b) = (uses[0].0.half_edge, uses[1].0.half_edge);
            self.twins[a as usize] = b;
            self.twins[b as usize] = a;
        } else if forward == backward {
            self.multiple += 1;
            self.first_multiple.get_or_insert(((smaller, larger), forward));
        } else {
            self.open += 1;
            self.first_open.get_or_insert(if forward > backward { (smaller, larger) } else { (larger, smaller) });
        }
    }
}

/// A number for each triangle, the same where triangles are connected through edges that two of them share.
pub(crate) fn surfaces(twins: &[u32]) -> Vec<u32> {
    let mut components = Components::new(twins.len() / 3);
    for (half_edge, &twin) in twins.iter().enumerate().filter(|(_, twin)| **twin != NO_TWIN) {
        components.join(half_edge as u32 / 3, twin / 3);
    }
    components.labels()
}

/// Whether a triangle names one vertex twice.
pub(crate) fn has_repeated_index([a, b, c]: [u32; 3]) -> bool {
    a == b || b == c || c == a
}

/// The edge uses by smaller vertex, where that is among some, and where the uses of each of these start (one entry more than there are).
fn gather(smaller: Range<usize>, triangles: &[[u32; 3]]) -> (Vec<u32>, Vec<EdgeUse>) {
    let place = |v: u32| (v as usize).wrapping_sub(smaller.start);
    let count = smaller.len();
    let sides = |t: usize| {
        let [a, b, c] = triangles[t];
        let present = !has_repeated_index(triangles[t]);
        let all = [(a, b), (b, c), (c, a)].into_iter().enumerate().filter(move |_| present);
        all.map(|(k, (a, b))| (k, place(a.min(b)), a.max(b))).filter(move |(_, place, _)| *place < count)
    };
    let mut starts = vec![0u32; count + 1];
    for t in 0..triangles.len() {
        for (_, place, _) in sides(t) {
            starts[place + 1] += 1;
        }
    }
    for place in 0..count {
        starts[place + 1] += starts[place];
    }
    let mut uses = vec![EdgeUse::default(); starts[count] as usize];
    let mut free = starts.clone();
    for t in 0..triangles.len() {
        for (k, place, larger) in sides(t) {
            let slot = &mut free[place];
            uses[*slot as usize] = EdgeUse { larger, half_edge: (3 * t + k) as u32 };
            *slot += 1;
        }
    }
    (starts, uses)
}
