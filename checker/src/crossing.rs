//! Whether the surface of a mesh passes through itself.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::bvh::Bvh;
use crate::contact::Contact;
use crate::pair::PairTest;
use crate::parallel;
use glam::DVec3;

/// The triangles that are in each other's way.
#[derive(Debug, Clone, PartialEq)]
pub struct CrossingReport {
    /// Number of triangles that cross or overlap another one.
    pub triangles: usize,
    /// The pair with the least indices.
    pub first: Option<Contact>,
    /// Contacts up to this depth, in the units of the positions, did not count.
    pub limit: f64,
}

/// Finds the triangles that cross or overlap another one.
///
/// Positions must be finite and indices in range; `twins` are the half-edge twins of the mesh. The `tolerance` is relative to
/// the diagonal of the bounding box or the largest coordinate, whichever is greater: rounding moves a vertex by a fraction of
/// its coordinates. See [`crate::CheckOptions::tolerance`] for what counts.
pub(crate) fn find_crossings(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    twins: &[u32],
    tolerance: f64,
) -> CrossingReport {
    let pairs = PairTest::new(positions, triangles, twins, tolerance);
    let count = triangles.len();
    let tree = Bvh::new(parallel::map(count, |t| pairs.bounds(t)));
    let involved: Vec<AtomicBool> = (0..count).map(|_| AtomicBool::new(false)).collect();
    let is_involved = |t: u32| involved[t as usize].load(Ordering::Relaxed);
    parallel::for_each(count, |place| {
        tree.visit_pairs_of(place, |t, u| {
            // Pairs that would add nothing are skipped. The set of involved triangles is the same in whatever order they come.
            if !(is_involved(t) && is_involved(u)) && pairs.contact(t, u).is_some() {
                involved[t as usize].store(true, Ordering::Relaxed);
                involved[u as usize].store(true, Ordering::Relaxed);
            }
        });
    });
    let first = (0..count as u32).find(|&t| is_involved(t)).and_then(|t| {
        let mut others = Vec::new();
        tree.visit(&pairs.bounds(t as usize), |other| others.push(other));
        others.sort_unstable();
        others.into_iter().find_map(|other| pairs.contact(t, other))
    });
    CrossingReport { triangles: (0..count as u32).filter(|&t| is_involved(t)).count(), first, limit: pairs.limit() }
}
