//! What several of the paper's checks use.

use std::collections::BTreeSet;

use planecut_kernel::{IncrementalPolytope, PlaneIdx};
use planecut_oracle::campaign::Campaign;
use planecut_oracle::check::check_in_layers;
use planecut_oracle::exact::Coefficients;
use planecut_oracle::kernel_calls::half_space;
use planecut_oracle::outline::Outline;
use planecut_oracle::script::Op;

/// The cube `[-1, 1]³`.
pub(crate) const CUBE: [Coefficients; 6] = [
    [1.0, 0.0, 0.0, 1.0],
    [-1.0, 0.0, 0.0, 1.0],
    [0.0, 1.0, 0.0, 1.0],
    [0.0, -1.0, 0.0, 1.0],
    [0.0, 0.0, 1.0, 1.0],
    [0.0, 0.0, -1.0, 1.0],
];

/// A polytope from planes in this order, with its handles.
pub(crate) fn build(planes: &[Coefficients], epsilon: f64) -> (IncrementalPolytope, Vec<PlaneIdx>) {
    let mut polytope = IncrementalPolytope::with_epsilon(epsilon);
    let handles = planes.iter().map(|&plane| polytope.add_plane(half_space(plane)).plane()).collect();
    (polytope, handles)
}

/// `V − E + F` of the boundary mesh, its edges counted from the cycles of the faces (paper §3.7).
pub(crate) fn euler_characteristic(polytope: &IncrementalPolytope) -> i64 {
    let (vertices, faces) = polytope.to_mesh();
    let mut edges = BTreeSet::new();
    for face in &faces {
        for (k, &a) in face.iter().enumerate() {
            let b = face[(k + 1) % face.len()];
            edges.insert([a.min(b), a.max(b)]);
        }
    }
    vertices.len() as i64 - edges.len() as i64 + faces.len() as i64
}

/// Numbers of vertices, edges and faces as the kernel sees them.
pub(crate) fn counts(polytope: &IncrementalPolytope) -> [usize; 3] {
    [polytope.vertex_count(), polytope.edge_count(), polytope.to_mesh().1.len()]
}

/// The same from the exact outline of a bounded set.
pub(crate) fn true_counts(planes: &[Coefficients]) -> [usize; 3] {
    let outline = Outline::of(planes);
    assert!(outline.bounded, "the oracle counts no ideal vertices: {planes:?}");
    [outline.vertices.len(), outline.edges, outline.faces]
}

/// The list without one plane.
pub(crate) fn without(planes: &[Coefficients], k: usize) -> Vec<Coefficients> {
    planes.iter().enumerate().filter(|(i, _)| *i != k).map(|(_, plane)| *plane).collect()
}

/// Adds the planes in this order, then removes each one and adds it again; all of it checked in layers.
pub(crate) fn check_history(planes: &[Coefficients]) {
    let mut ops: Vec<Op> = planes.iter().enumerate().map(|(name, &plane)| Op::Add { name, plane }).collect();
    for (name, &plane) in planes.iter().enumerate() {
        ops.push(Op::Remove { name });
        ops.push(Op::Add { name: planes.len() + name, plane });
    }
    let start = || IncrementalPolytope::with_epsilon(0.0);
    let campaign = Campaign { operations: 1, cases: 1, capacity: usize::MAX, start, check: check_in_layers };
    if let Err(error) = campaign.attempt(&ops) {
        panic!("{}", campaign.report(ops, &error));
    }
}
