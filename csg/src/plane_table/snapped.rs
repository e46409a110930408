//! What snapping makes of planes, without the table of them.

use planecut_kernel::HalfSpace;
use planecut_kernel::sign::Row;
use rustc_hash::FxHashMap;

use super::PlaneTable;

/// The planes that a table would replace by one that is nearly the same.
#[derive(Debug, Default)]
pub(crate) struct Snapped {
    replaced: FxHashMap<[u64; 4], HalfSpace>,
}

impl Snapped {
    /// Those among some planes of bodies, of which the smallest has this size.
    pub(crate) fn of(half_spaces: &[HalfSpace], size: f64) -> Self {
        let (table, ids) = PlaneTable::intern(half_spaces, size);
        let pairs = half_spaces.iter().zip(ids);
        let replaced = pairs.filter(|(half_space, id)| !table.row(*id).is_same_plane(&Row::new(half_space)));
        Self { replaced: replaced.map(|(half_space, id)| (bits(half_space), *table.half_space(id))).collect() }
    }

    /// What stands for a half-space.
    pub(crate) fn of_plane(&self, half_space: &HalfSpace) -> HalfSpace {
        if self.replaced.is_empty() {
            return *half_space;
        }
        self.replaced.get(&bits(half_space)).copied().unwrap_or(*half_space)
    }

    /// How many others stand for.
    pub(crate) fn count(&self) -> usize {
        self.replaced.len()
    }
}

fn bits(half_space: &HalfSpace) -> [u64; 4] {
    half_space.normal().extend(half_space.offset()).to_array().map(f64::to_bits)
}
