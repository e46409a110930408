//! Where the vertices of a small polytope are, for many climbs one after the other.
//!
//! With a few vertices it takes less to look at all of them, several at once and without a branch, than to go from one to the
//! next: each step waits for the one before, and its direction cannot be foreseen. What is found is nearly always where a climb
//! ends, but it is rounded; a climb from there decides.

use super::NONE;
use super::vertex::VertexRecord;

/// The most vertices that are looked at.
const MOST: usize = 64;
/// The bits of a number that tell one of so many vertices.
const NUMBER_BITS: u32 = MOST as u32 - 1;
const LANES: usize = 4;

/// The coordinates of some vertices, one axis after the other; NaN where there is none.
#[derive(Debug, Clone, Copy)]
struct Block([[f32; LANES]; 3]);

/// The places of all finite vertices, where they are few.
#[derive(Debug, Default)]
pub(super) struct Places {
    blocks: Vec<Block>,
    /// The slots of the vertices; none where nothing is known.
    slots: Vec<u32>,
}

impl Places {
    /// Forgets all, because vertices came, went or moved.
    #[inline(always)]
    pub(super) fn forget(&mut self) {
        self.slots.clear();
    }

    /// Whether the places are known.
    #[inline(always)]
    pub(super) fn are_known(&self) -> bool {
        !self.slots.is_empty()
    }

    /// Finds the places of all vertices; of none where there are too many, or none is finite.
    #[inline(never)]
    pub(super) fn find(&mut self, records: &[VertexRecord]) {
        self.blocks.clear();
        self.slots.clear();
        if records.len() > MOST {
            return;
        }
        let mut origin = None;
        for (slot, record) in (0u32..).zip(records) {
            if record.planes[0] == NONE || record.point.is_ideal() {
                continue;
            }
            let place = record.point.place();
            // what is small beside its distance from the origin of the coordinates has room in single precision, too
            let origin = *origin.get_or_insert(place);
            let lane = self.slots.len() % LANES;
            if lane == 0 {
                self.blocks.push(Block([[f32::NAN; LANES]; 3]));
            }
            let block = self.blocks.last_mut().expect("there is one for each four slots");
            for axis in 0..3 {
                block.0[axis][lane] = (place[axis] - origin[axis]) as f32;
            }
            self.slots.push(slot);
        }
    }

    /// The slot of the vertex that seems to be farthest in a direction; `None` where the places are not known.
    #[inline(always)]
    pub(super) fn farthest(&self, direction: &[f64; 4]) -> Option<u32> {
        let [x, y, z, _] = direction.map(|v| v as f32);
        let mut best = [f32::NEG_INFINITY; LANES];
        let mut numbers: [u32; LANES] = std::array::from_fn(|k| k as u32);
        for Block([xs, ys, zs]) in &self.blocks {
            for k in 0..LANES {
                let height = x * xs[k] + y * ys[k] + z * zs[k];
                // the number of the vertex travels in place of the last bits; NaN is never larger
                let height = f32::from_bits(height.to_bits() & !NUMBER_BITS | numbers[k]);
                best[k] = if height > best[k] { height } else { best[k] };
                numbers[k] += LANES as u32;
            }
        }
        let larger = |a: f32, b: f32| if a > b { a } else { b };
        let best = larger(larger(best[0], best[1]), larger(best[2], best[3]));
        self.slots.get((best.to_bits() & NUMBER_BITS) as usize).copied()
    }
}
