//! The polytopes of brushes that are edited, kept from edit to edit.
//!
//! An edit of a few planes of a brush adds, moves or removes these alone. What the body looks like depends on the planes and
//! not on the order in which they came, but for one thing: of planes that are equal the first of the brush has the face, and
//! its material counts. The kernel gives the face to the plane that was added first, which is another one where an undo has
//! put a plane back in its old place; see [`KeptPolytope::places`].

use planecut_kernel::{HalfSpace, IncrementalPolytope, PlaneIdx};
use rustc_hash::FxHashMap;

use super::BrushId;
use crate::plane_table::PlaneId;

/// Brushes of fewer planes are built from all of their planes at each edit: that takes no longer than a few changes of a kept
/// polytope, which would take several kilobytes for each brush that was edited once (docs/edits.md has the figures).
pub(super) const LEAST_PLANES: usize = 16;

/// Where more than one in this number of planes is another, a polytope is built from all of them: it takes about as long to add three
/// planes to an empty polytope as to change one of a complete one.
pub(super) const PLANES_PER_CHANGE: usize = 4;

/// Maximum number of planes in a generation of kept polytopes, unless it is a single polytope: two generations take about
/// 15 MB.
const PLANES_OF_GENERATION: usize = 16_384;

/// Handles of the planes that cut what is not bounded, above those of all planes of brushes.
pub(super) const OUTER_BOX: [PlaneIdx; 6] = {
    const LAST: usize = usize::MAX;
    [PlaneIdx(LAST - 5), PlaneIdx(LAST - 4), PlaneIdx(LAST - 3), PlaneIdx(LAST - 2), PlaneIdx(LAST - 1), PlaneIdx(LAST)]
};

/// The polytope of a brush as it was when it was last built.
pub(super) struct KeptPolytope {
    polytope: IncrementalPolytope,
    /// The handle of each plane in the brush, ascending, and in the polytope, where handles are given again.
    planes: Vec<(PlaneIdx, PlaneIdx)>,
    /// Whether the planes were added in the order in which the brush has them.
    is_in_order: bool,
}

impl Default for KeptPolytope {
    fn default() -> Self {
        Self { polytope: IncrementalPolytope::with_epsilon(0.0), planes: Vec::new(), is_in_order: true }
    }
}

impl KeptPolytope {
    pub(super) fn polytope(&self) -> &IncrementalPolytope {
        &self.polytope
    }

    /// Makes it the polytope of some planes, each with its handle in the brush, ascending.
    pub(super) fn update(&mut self, handles: &[PlaneIdx], half_space: impl Fn(usize) -> HalfSpace) {
        if self.count_changes(handles, &half_space) * PLANES_PER_CHANGE > handles.len() {
            self.rebuild(handles, half_space);
            return;
        }
        let before = std::mem::replace(&mut self.planes, Vec::with_capacity(handles.len()));
        let mut before = before.into_iter().peekable();
        for (k, handle) in handles.iter().enumerate() {
            while let Some((_, gone)) = before.next_if(|(other, _)| other < handle) {
                self.polytope.remove_plane(gone).expect("a kept plane is in the polytope");
            }
            let plane = match before.next_if(|(other, _)| other == handle) {
                Some((_, plane)) => {
                    if self.polytope.plane(plane) != Some(&half_space(k)) {
                        self.polytope.move_plane(plane, half_space(k)).expect("a kept plane is in the polytope");
                    }
                    plane
                }
                None => {
                    self.is_in_order &= before.peek().is_none();
                    self.polytope.add_plane(half_space(k)).plane()
                }
            };
            self.planes.push((*handle, plane));
        }
        for (_, gone) in before {
            self.polytope.remove_plane(gone).expect("a kept plane is in the polytope");
        }
    }

    /// How many planes are to be added, moved or removed.
    fn count_changes(&self, handles: &[PlaneIdx], half_space: impl Fn(usize) -> HalfSpace) -> usize {
        let mut before = self.planes.iter().peekable();
        let mut changes = 0;
        for (k, handle) in handles.iter().enumerate() {
            while before.next_if(|(other, _)| other < handle).is_some() {
                changes += 1;
            }
            let known = before.next_if(|(other, _)| other == handle);
            let is_same = known.is_some_and(|(_, plane)| self.polytope.plane(*plane) == Some(&half_space(k)));
            changes += usize::from(!is_same);
        }
        changes + before.count()
    }

    fn rebuild(&mut self, handles: &[PlaneIdx], half_space: impl Fn(usize) -> HalfSpace) {
        self.polytope.clear();
        self.planes.clear();
        self.is_in_order = true;
        for (k, handle) in handles.iter().enumerate() {
            self.planes.push((*handle, self.polytope.add_plane(half_space(k)).plane()));
        }
    }

    /// By handle the place of each plane among all, whose ids these are. Where planes may not have come in their order, equal
    /// ones all have the place of the first.
    pub(super) fn places(&self, ids: &[PlaneId]) -> Vec<u32> {
        let slots = self.planes.iter().map(|(_, plane)| plane.0 + 1).max().unwrap_or(0);
        let mut places = vec![u32::MAX; slots];
        let mut first: FxHashMap<PlaneId, u32> = FxHashMap::default();
        for (place, (_, plane)) in (0..).zip(&self.planes) {
            let is_in_order = self.is_in_order;
            places[plane.0] = if is_in_order { place } else { *first.entry(ids[place as usize]).or_insert(place) };
        }
        places
    }
}

/// The kept polytopes, by brush: those used last, as many as a limit of their planes allows. They are in two generations; when
/// the younger one is full, it takes the place of the older one.
#[derive(Default)]
pub(super) struct KeptPolytopes {
    younger: Generation,
    older: Generation,
}

#[derive(Default)]
struct Generation {
    by_brush: FxHashMap<BrushId, KeptPolytope>,
    planes: usize,
}

impl KeptPolytopes {
    /// Takes out the polytope of a brush.
    pub(super) fn take(&mut self, brush: BrushId) -> Option<KeptPolytope> {
        self.younger.take(brush).or_else(|| self.older.take(brush))
    }

    pub(super) fn keep(&mut self, brush: BrushId, polytope: KeptPolytope) {
        let planes = polytope.planes.len();
        if !self.younger.by_brush.is_empty() && self.younger.planes + planes > PLANES_OF_GENERATION {
            self.older = std::mem::take(&mut self.younger);
        }
        self.younger.planes += planes;
        self.younger.by_brush.insert(brush, polytope);
    }
}

impl Generation {
    fn take(&mut self, brush: BrushId) -> Option<KeptPolytope> {
        let polytope = self.by_brush.remove(&brush)?;
        self.planes -= polytope.planes.len();
        Some(polytope)
    }
}
