//! Vertices from positions, for formats without meaningful indices.

use glam::DVec3;
use rustc_hash::FxHashMap;

/// Gives equal positions one index. Equal means bit for bit, except that `-0` equals `0`.
#[derive(Default)]
pub(crate) struct PositionMerger {
    indices: FxHashMap<[u64; 3], u32>,
    positions: Vec<DVec3>,
}

impl PositionMerger {
    /// The index of a position; new ones are numbered as they come. `None` after the last 32-bit index.
    pub(crate) fn index(&mut self, position: DVec3) -> Option<u32> {
        // Adding zero turns -0 into 0.
        let position = position + DVec3::ZERO;
        let next = u32::try_from(self.positions.len()).ok()?;
        let index = *self.indices.entry(position.to_array().map(f64::to_bits)).or_insert(next);
        if index == next {
            self.positions.push(position);
        }
        Some(index)
    }

    /// The positions by index.
    pub(crate) fn into_positions(self) -> Vec<DVec3> {
        self.positions
    }
}
