//! Half-planes around a line: their exact cyclic order, and which of them bound one wedge of solid.

use std::cmp::Ordering;

use planecut_kernel::sign::Sign;

use super::WeldError;
use super::cancel::{HalfEdge, Run};
use super::lines::Line;
use crate::ids::{HalfEdgeId, Id, RegionId};
use crate::plane_table::{PlaneId, PlaneTable};

/// A line and the planes of all regions.
pub(super) struct AroundLine<'a> {
    pub(super) table: &'a PlaneTable,
    pub(super) line: &'a Line,
    pub(super) planes: &'a [PlaneId],
}

/// The half-plane in which a region lies beside the line.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sheet {
    pub(super) region: RegionId,
    /// Whether its boundary edge points along the line. Solid lies counter-clockwise of it where it does not.
    pub(super) forward: bool,
}

impl From<&Run> for Sheet {
    fn from(run: &Run) -> Self {
        Self { region: run.region, forward: run.is_forward() }
    }
}

impl AroundLine<'_> {
    /// Sorts what lies in half-planes counter-clockwise around the line.
    ///
    /// The direction into a half-plane is `±n × D`, so the normals so signed are sorted; both are perpendicular to the line, so the sign
    /// of one component of their cross product tells their order.
    pub(super) fn sort<T: Copy>(&self, items: &mut [T], sheet: impl Fn(T) -> Sheet) {
        let signed = |item: T| {
            let Sheet { region, forward } = sheet(item);
            let plane = self.planes[region.index()];
            if forward { plane } else { plane.flipped() }
        };
        // whatever the order in which they come
        items.sort_by_key(|item| self.table.order(signed(*item)));
        let Some(first) = items.first().map(|item| signed(*item)) else { return };
        let half = |plane: PlaneId| {
            if plane.index() == first.index() {
                return if plane == first { 0 } else { 2 };
            }
            match self.table.cross_component(first, plane, self.line.axis()) {
                Sign::Positive => 1,
                Sign::Zero => 2,
                Sign::Negative => 3,
            }
        };
        items.sort_by(|i, j| {
            let (p, q) = (signed(*i), signed(*j));
            half(p).cmp(&half(q)).then_with(|| match self.table.cross_component(p, q, self.line.axis()) {
                Sign::Positive => Ordering::Less,
                Sign::Zero => Ordering::Equal,
                Sign::Negative => Ordering::Greater,
            })
        });
    }

    /// Pairs the half-edges of one elementary interval.
    ///
    /// Seen along the line, solid lies counter-clockwise of a face whose edge points back, up to one that points along. Where two that
    /// follow each other point the same way, a face between them lies on both sides of the line, uncut; what is on its one side stays
    /// apart from what is on the other.
    pub(super) fn pair(&self, around: &mut [HalfEdgeId], out: &mut [HalfEdge]) -> Result<(), WeldError> {
        check_sum(around, out)?;
        let sheet = |k: HalfEdgeId| {
            let piece = &out[k.index()];
            Sheet { region: piece.region, forward: piece.is_forward() }
        };
        if around.len() > 2 {
            self.sort(around, sheet);
        }
        let points_along = |k: usize| sheet(around[k % around.len()]).forward;
        let gap = (1..=around.len()).find(|k| points_along(k - 1) == points_along(*k));
        let start =
            gap.or_else(|| (0..around.len()).find(|k| !points_along(*k))).expect("as many pieces point back as along");
        around.rotate_left(start % around.len());
        for pair in around.chunks(2) {
            let &[a, b] = pair else { continue };
            if out[a.index()].is_forward() == out[b.index()].is_forward() {
                return Err(WeldError::wedge(&out[a.index()]));
            }
            out[a.index()].twin = b;
            out[b.index()].twin = a;
        }
        Ok(())
    }
}

/// Pairs the half-edges of one elementary interval with no regard to what they bound.
pub(super) fn pair_anyhow(around: &mut [HalfEdgeId], out: &mut [HalfEdge]) -> Result<(), WeldError> {
    check_sum(around, out)?;
    around.sort_by_key(|k| out[k.index()].is_forward());
    let (back, along) = around.split_at(around.len() / 2);
    for (a, b) in back.iter().zip(along) {
        out[a.index()].twin = *b;
        out[b.index()].twin = *a;
    }
    Ok(())
}

/// As many half-edges of an interval must point along the line as back.
fn check_sum(around: &[HalfEdgeId], out: &[HalfEdge]) -> Result<(), WeldError> {
    let forward = around.iter().filter(|k| out[k.index()].is_forward()).count();
    if 2 * forward == around.len() { Ok(()) } else { Err(WeldError::open(&out[around[0].index()])) }
}
