//! The facets that have the solid on one side alone.

use rustc_hash::FxHashMap;

use super::Arranged;
use super::winding::Windings;
use crate::ids::{FacetId, Id, PatchId, StateId};
use crate::model::MaterialId;

/// A facet of the boundary, a triangle or a cell of one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Kept {
    pub(super) facet: FacetId,
    /// Whether the solid is above it, so that the triangle it is a part of faces inwards.
    pub(super) is_flipped: bool,
    pub(super) material: MaterialId,
}

/// What is kept.
#[derive(Debug)]
pub(super) struct KeptFacets {
    /// Triangles and cells.
    pub(super) flat: Vec<Kept>,
    /// For each patch whether it is kept, and whether it is turned over.
    pub(super) patches: Vec<Option<bool>>,
    /// For each combination of winding numbers whether it is solid.
    pub(super) values: Vec<bool>,
}

impl Arranged<'_> {
    /// The facets at which the solid ends, by what is said of combinations of winding numbers.
    pub(super) fn kept(&self, is_solid: &impl Fn(&Windings) -> bool) -> KeptFacets {
        let value = |(k, windings): (usize, &Windings)| match self.sheets.decided {
            Some((decided, value)) if decided.index() == k => value,
            _ => is_solid(windings),
        };
        let values: Vec<bool> = self.sheets.states.windings.iter().enumerate().map(value).collect();
        // whether the solid is above, and below
        let sides = |facet: FacetId| {
            let [above, below] = [&self.sheets.above, &self.sheets.below].map(|states| states[facet.index()]);
            (values[above.index()] != values[below.index()]).then(|| (above, below, values[above.index()]))
        };
        let keep = |facet: FacetId| {
            let (above, below, is_flipped) = sides(facet)?;
            // from the empty side to the solid one
            let sides = if is_flipped { [below, above] } else { [above, below] };
            let material = self.material(facet, sides, is_flipped, is_solid);
            Some(Kept { facet, is_flipped, material })
        };
        let flat = self.facets.flat_ones().filter_map(keep).collect();
        let patches = PatchId::all(self.arrangement.patches.all.len());
        let patches =
            patches.map(|patch| sides(self.facets.of_patch(patch)).map(|(_, _, is_flipped)| is_flipped)).collect();
        KeptFacets { flat, patches, values }
    }

    /// The material of a facet. Where several lie upon each other they take turns from the empty side to the solid one, those that lower
    /// a winding number first, then by material and operand; the one at whose turn the solid begins gives its own.
    fn material(
        &self,
        facet: FacetId,
        [empty, solid]: [StateId; 2],
        is_flipped: bool,
        is_solid: &impl Fn(&Windings) -> bool,
    ) -> MaterialId {
        let surface = &self.arrangement.surface;
        let triangle = |facet| self.facets.triangle(&self.arrangement.cells, facet);
        let doubles = self.facets.doubles(facet);
        if doubles.is_empty() {
            return surface.material(triangle(facet));
        }
        let turn_of = |facet: FacetId, is_same: bool| {
            let triangle = triangle(facet);
            (is_same != is_flipped, surface.material(triangle), surface.operands[triangle.index()])
        };
        let mut turns = vec![turn_of(facet, true)];
        turns.extend(doubles.iter().map(|double| turn_of(double.facet, double.is_same)));
        turns.sort_unstable();
        let by = |is_up: bool| if is_up { 1 } else { -1 };
        let of_state = |state: StateId| self.sheets.states.windings[state.index()].iter().copied();
        let mut windings: FxHashMap<u32, i32> = FxHashMap::default();
        if self.sheets.decided.is_some_and(|(decided, _)| decided == empty) {
            // known from the solid side alone
            windings.extend(of_state(solid));
            turns.iter().for_each(|(is_up, _, operand)| *windings.entry(*operand).or_insert(0) -= by(*is_up));
        } else {
            windings.extend(of_state(empty));
        }
        for &(is_up, material, operand) in &turns {
            *windings.entry(operand).or_insert(0) += by(is_up);
            let mut now: Windings =
                windings.iter().map(|(k, v)| (*k, *v)).filter(|(_, winding)| *winding != 0).collect();
            now.sort_unstable();
            if is_solid(&now) {
                return material;
            }
        }
        turns[0].1
    }
}
