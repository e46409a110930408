//! Whether the triangles of a mesh form a closed, oriented 2-manifold: by their indices alone, positions decide nothing.

use glam::DVec3;
use thiserror::Error;

use crate::edges::{EdgeMatching, NO_TWIN, has_repeated_index, origin, previous};
use crate::measure::{Measures, measure};

/// One way in which a mesh fails to be a closed, oriented 2-manifold. Indices count from 0.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum TopologyDefect {
    /// More triangles or vertices than half-edges can be numbered for.
    #[error("too large: {triangles} triangles and {vertices} vertices, expected at most 1431655764 of each")]
    TooLarge {
        /// Number of triangles.
        triangles: usize,
        /// Number of vertices.
        vertices: usize,
    },
    /// A triangle names a vertex that does not exist.
    #[error("triangle {triangle} names vertex {index}, expected an index below {vertices}")]
    IndexOutOfRange {
        /// The triangle.
        triangle: usize,
        /// The index that it names.
        index: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} has a coordinate that is not finite")]
    NotFinite {
        /// The vertex.
        vertex: usize,
    },
    /// A triangle names one vertex twice.
    #[error("triangle {triangle} names one vertex twice")]
    DegenerateTriangle {
        /// The triangle.
        triangle: usize,
    },
    /// An edge is used more often in the direction from `a` to `b` than in the opposite one.
    #[error("open edge from vertex {a} to vertex {b}")]
    OpenEdge {
        /// Where the surplus direction starts.
        a: u32,
        /// Where it ends.
        b: u32,
    },
    /// An edge is used several times in each direction.
    #[error("edge between vertices {a} and {b} is used {uses} times in each direction, expected once")]
    DuplicateEdge {
        /// The smaller vertex.
        a: u32,
        /// The larger vertex.
        b: u32,
        /// Uses in each direction.
        uses: usize,
    },
    /// The triangles around a vertex form more than one fan.
    #[error("vertex {vertex} is pinched: its triangles form {fans} fans, expected one")]
    PinchedVertex {
        /// The vertex.
        vertex: u32,
        /// Number of fans.
        fans: u32,
    },
}

/// What the indices of a mesh say about its surface.
#[derive(Debug, Clone, PartialEq)]
pub struct TopologyReport {
    /// Number of vertices that triangles use.
    pub vertices: usize,
    /// Number of positions that no triangle uses; they are no defect.
    pub unused_vertices: usize,
    /// Number of different undirected edges.
    pub edges: usize,
    /// Number of triangles.
    pub triangles: usize,
    /// Number of surfaces: sets of triangles connected through edges.
    pub components: usize,
    /// Vertices − edges + triangles, without the degenerate triangles.
    pub euler_characteristic: i64,
    /// Number of handles, summed over components: `(2 - χ) / 2` each. Only manifold meshes have one.
    pub genus: Option<i64>,
    /// Every edge is used equally often in both directions. A mesh without triangles is so: the whole boundary of the empty solid.
    pub watertight: bool,
    /// Watertight, and in addition every edge is used once in each direction, and the triangles around each vertex form one fan.
    pub manifold: bool,
    /// Number of triangles that name one vertex twice.
    pub degenerate_triangles: usize,
    /// Number of edges whose directions are used unequally often.
    pub open_edges: usize,
    /// Number of edges used several times in each direction.
    pub duplicate_edges: usize,
    /// Number of vertices whose triangles form several fans. Fans that end at open or duplicate edges are not counted.
    pub pinched_vertices: usize,
    /// The worst defect, and of that kind the one with the least index.
    pub first_defect: Option<TopologyDefect>,
    /// Volume, area and extent.
    pub measures: Measures,
}

/// Largest number of triangles or vertices: half-edges are numbered in 32 bits, with one number to spare.
const MAX_COUNT: usize = (u32::MAX as usize - 1) / 3;

/// The report, and the half-edge twins; without twins where the data could not be used at all.
pub(crate) fn analyse(positions: &[DVec3], triangles: &[[u32; 3]]) -> (TopologyReport, Vec<u32>) {
    if let Some(defect) = unusable(positions, triangles) {
        return (unusable_report(triangles.len(), defect), Vec::new());
    }
    let edges = EdgeMatching::new(positions.len(), triangles);
    let degenerate = |t: &usize| has_repeated_index(triangles[*t]);
    let first_degenerate = (0..triangles.len()).find(degenerate);
    let (used, pinched, first_pinched) = count_fans(positions.len(), triangles, &edges.twins);
    let defects = [
        edges.first_open.map(|(a, b)| TopologyDefect::OpenEdge { a, b }),
        first_degenerate.map(|triangle| TopologyDefect::DegenerateTriangle { triangle }),
        edges.first_multiple.map(|((a, b), uses)| TopologyDefect::DuplicateEdge { a, b, uses }),
        first_pinched.map(|(vertex, fans)| TopologyDefect::PinchedVertex { vertex, fans }),
    ];
    let first_defect = defects.into_iter().flatten().next();
    let degenerate_triangles = (0..triangles.len()).filter(degenerate).count();
    let proper = triangles.len() - degenerate_triangles;
    let euler_characteristic = used as i64 - edges.edges as i64 + proper as i64;
    let manifold = first_defect.is_none();
    let report = TopologyReport {
        vertices: used,
        unused_vertices: positions.len() - used,
        edges: edges.edges,
        triangles: triangles.len(),
        components: edges.components,
        euler_characteristic,
        genus: manifold.then_some((2 * edges.components as i64 - euler_characteristic) / 2),
        watertight: edges.open == 0,
        manifold,
        degenerate_triangles,
        open_edges: edges.open,
        duplicate_edges: edges.multiple,
        pinched_vertices: pinched,
        first_defect,
        measures: measure(positions, triangles),
    };
    (report, edges.twins)
}

/// The first reason for which the data cannot be taken as a mesh.
fn unusable(positions: &[DVec3], triangles: &[[u32; 3]]) -> Option<TopologyDefect> {
    let vertices = positions.len();
    if triangles.len() > MAX_COUNT || vertices > MAX_COUNT {
        return Some(TopologyDefect::TooLarge { triangles: triangles.len(), vertices });
    }
    let flat = triangles.as_flattened();
    if let Some(place) = flat.iter().position(|&i| i as usize >= vertices) {
        return Some(TopologyDefect::IndexOutOfRange { triangle: place / 3, index: flat[place], vertices });
    }
    positions.iter().position(|p| !p.is_finite()).map(|vertex| TopologyDefect::NotFinite { vertex })
}

fn unusable_report(triangles: usize, defect: TopologyDefect) -> TopologyReport {
    TopologyReport {
        vertices: 0,
        unused_vertices: 0,
        edges: 0,
        triangles,
        components: 0,
        euler_characteristic: 0,
        genus: None,
        watertight: false,
        manifold: false,
        degenerate_triangles: 0,
        open_edges: 0,
        duplicate_edges: 0,
        pinched_vertices: 0,
        first_defect: Some(defect),
        measures: measure::<DVec3>(&[], &[]),
    }
}

/// Number of used vertices, number of pinched ones, and the first pinched one with its number of fans.
///
/// Only closed fans are counted: where a fan ends, an edge is open or duplicate and has been reported as such.
fn count_fans(vertices: usize, triangles: &[[u32; 3]], twins: &[u32]) -> (usize, usize, Option<(u32, u32)>) {
    let mut used = vec![false; vertices];
    let mut fans = vec![0u32; vertices];
    let mut visited = vec![false; twins.len()];
    for start in 0..twins.len() as u32 {
        let vertex = origin(triangles, start) as usize;
        used[vertex] = true;
        if visited[start as usize] {
            continue;
        }
        let mut half_edge = start;
        loop {
            visited[half_edge as usize] = true;
            half_edge = twins[previous(half_edge) as usize];
            if half_edge == start {
                fans[vertex] += 1;
                break;
            }
            if half_edge == NO_TWIN || visited[half_edge as usize] {
                break;
            }
        }
    }
    let mut pinched = (0..vertices as u32).filter(|&v| fans[v as usize] > 1);
    let first = pinched.next();
    let count = usize::from(first.is_some()) + pinched.count();
    (used.iter().filter(|&&u| u).count(), count, first.map(|v| (v, fans[v as usize])))
}
