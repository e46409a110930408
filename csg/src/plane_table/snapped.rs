//! What snapping makes of many planes, without a table of them.

use planecut_kernel::HalfSpace;
use planecut_kernel::sign::Row;
use rustc_hash::FxHashMap;

use super::PlaneTable;
use super::near::{may_be_near, unit};
use super::same::{first_side, is_exact};

/// The planes of many half-spaces that a table of all of them would replace by one that is nearly the same, without such a
/// table.
pub(crate) struct Snapped {
    replaced: FxHashMap<[u64; 4], HalfSpace>,
}

impl Snapped {
    /// Those among some half-spaces of bodies, of which the smallest has this size.
    pub(crate) fn of<'a>(half_spaces: impl Iterator<Item = &'a HalfSpace> + Clone, size: f64) -> Self {
        let mut snapped = Self { replaced: FxHashMap::default() };
        let rows = || half_spaces.clone().map(Row::new);
        if rows().all(|row| is_exact(&row)) {
            return snapped;
        }
        let first_sides = rows().map(|row| first_side(&row).0);
        let units: Vec<[f64; 4]> = first_sides.map(|row| unit(&row)).collect();
        let may_be_near = may_be_near(&units, size);
        drop(units);
        let doubtful = half_spaces.zip(may_be_near).filter(|(_, is_near)| *is_near);
        let doubtful: Vec<HalfSpace> = doubtful.map(|(half_space, _)| *half_space).collect();
        let (table, ids) = PlaneTable::intern(&doubtful, size);
        for (half_space, id) in doubtful.iter().zip(ids) {
            if !table.row(id).is_same_plane(&Row::new(half_space)) {
                snapped.replaced.insert(bits(half_space), *table.half_space(id));
            }
        }
        snapped
    }

    /// What stands for a half-space.
    pub(crate) fn of_plane(&self, half_space: &HalfSpace) -> HalfSpace {
        if self.replaced.is_empty() {
            return *half_space;
        }
        self.replaced.get(&bits(half_space)).copied().unwrap_or(*half_space)
    }
}

fn bits(half_space: &HalfSpace) -> [u64; 4] {
    half_space.normal().extend(half_space.offset()).to_array().map(f64::to_bits)
}
