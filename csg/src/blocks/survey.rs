//! What must be known of all brushes of a model before it is cut into blocks, in memory that does not grow with their number.

use glam::DVec3;

use super::BlockOptions;
use super::grid::BlockGrid;
use super::snapping::PlaneSurvey;
use crate::base::{Bounds, CompensatedSum};
use crate::body::{BrushExtent, BrushExtents, BuiltBodies, brush_extents};
use crate::model::Brush;
use crate::plane_table::{size_of, smallest_size};

/// Number of middles of brushes that are kept, at most, to find where walls go.
const SAMPLE: usize = 1 << 18;

/// Where a brush is.
#[derive(Debug, Clone, PartialEq)]
pub struct BrushPlace {
    /// The box around it, with room for rounding; [`Bounds::EMPTY`] for a brush without interior.
    pub bounds: Bounds,
    /// Numbers of its planes that have no face.
    pub redundant: Vec<u32>,
    /// Whether it is not bounded, or a closed mesh: then it is in no block, and nothing else is known of it.
    pub is_unbounded: bool,
}

/// A survey of the brushes of a model, which are given one after another and not kept.
#[derive(Debug, Clone)]
pub struct BlockSurvey {
    /// Number of brushes that were given.
    pub brushes: u64,
    /// Number of those without interior.
    pub empty: u64,
    /// Planes of all brushes.
    pub planes: u64,
    /// Planes of brushes that have no face.
    pub redundant_planes: u64,
    volume: CompensatedSum,
    bounds: Bounds,
    size: Option<f64>,
    of_planes: PlaneSurvey,
    sample: Sample,
}

impl Default for BlockSurvey {
    fn default() -> Self {
        Self {
            brushes: 0,
            empty: 0,
            planes: 0,
            redundant_planes: 0,
            volume: CompensatedSum::default(),
            bounds: Bounds::EMPTY,
            size: None,
            of_planes: PlaneSurvey::default(),
            sample: Sample { middles: Vec::new(), shift: 0 },
        }
    }
}

impl BlockSurvey {
    /// Adds brushes that follow those that were given; gives where each is. Brushes are built in parallel: some thousands at once are best.
    pub fn add(&mut self, brushes: &[Brush]) -> Vec<BrushPlace> {
        let size = smallest_size(brushes.iter().map(Brush::half_spaces));
        let BrushExtents { extents, .. } = brush_extents(brushes, &BuiltBodies::default(), size);
        let mut places = Vec::with_capacity(brushes.len());
        for (number, (extent, brush)) in (self.brushes..).zip(extents.into_iter().zip(brushes)) {
            places.push(match extent {
                BrushExtent::Bounded { bounds, redundant, volume } => {
                    self.volume.add(volume);
                    self.redundant_planes += redundant.len() as u64;
                    self.sample.add(number, bounds.center());
                    BrushPlace { bounds: bounds.with_room(), redundant, is_unbounded: false }
                }
                BrushExtent::Empty => {
                    self.empty += 1;
                    BrushPlace { bounds: Bounds::EMPTY, redundant: Vec::new(), is_unbounded: false }
                }
                BrushExtent::Unbounded => {
                    places.push(BrushPlace { bounds: Bounds::EMPTY, redundant: Vec::new(), is_unbounded: true });
                    continue;
                }
            });
            let own = size_of(brush.half_spaces());
            self.size = [self.size, own].into_iter().flatten().reduce(f64::min);
            self.planes += brush.faces.len() as u64;
            brush.half_spaces().for_each(|half_space| self.of_planes.note(half_space));
        }
        self.bounds = places.iter().fold(self.bounds, |all, place| all.union(&place.bounds));
        self.brushes += brushes.len() as u64;
        places
    }

    /// The sum of the volumes of the brushes.
    #[must_use]
    pub fn volume_sum(&self) -> f64 {
        self.volume.value()
    }

    /// The size of the smallest brush, below which planes are nearly the same: 0 where there is none.
    #[must_use]
    pub fn size(&self) -> f64 {
        self.size.unwrap_or(0.0)
    }

    /// The box around all brushes.
    #[must_use]
    pub fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    /// Where walls go.
    #[must_use]
    pub fn grid(&self, options: BlockOptions) -> BlockGrid {
        // the number of middles that the sample has of as many brushes
        let of_sample = options.brushes.max(1) as u64 >> self.sample.shift;
        BlockGrid::new(&self.bounds, &self.sample.middles, usize::try_from(of_sample.max(1)).unwrap_or(usize::MAX))
    }

    /// What is known of the planes.
    #[must_use]
    pub fn planes(&self) -> PlaneSurvey {
        self.of_planes.with_size(self.size())
    }
}

/// The middles of some brushes, drawn by their numbers: the same for the same brushes, and no pattern of a model is in it.
#[derive(Debug, Clone)]
struct Sample {
    middles: Vec<DVec3>,
    /// One of two to this power brushes is drawn.
    shift: u32,
}

impl Sample {
    fn add(&mut self, number: u64, middle: DVec3) {
        if !is_drawn(number, self.shift) {
            return;
        }
        self.middles.push(middle);
        if self.middles.len() > SAMPLE {
            // which of those that are there are drawn again depends on their places alone
            self.shift += 1;
            let mut place = 0;
            self.middles.retain(|_| {
                place += 1;
                is_drawn(place, 1)
            });
        }
    }
}

/// Whether a number is drawn: one of two to the power of `shift` is (the finaliser of splitmix64, Steele, Lea, Flood 2014).
fn is_drawn(number: u64, shift: u32) -> bool {
    let mixed = (number ^ number >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
    (mixed ^ mixed >> 31).trailing_zeros() >= shift
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sample_of_a_regular_model_is_spread_over_it_and_bounded() {
        let mut sample = Sample { middles: Vec::new(), shift: 0 };
        // rows of a power of two, along which a sample of each n-th brush would see one column alone
        let (rows, row) = (3000_u64, 1024_u64);
        for number in 0..rows * row {
            sample.add(number, DVec3::new((number % row) as f64, (number / row) as f64, 0.0));
        }
        let count = sample.middles.len();
        assert!(count <= SAMPLE && count > SAMPLE / 3, "{count}");
        for axis in 0..2 {
            let length = if axis == 0 { row } else { rows } as f64;
            for tenth in 0..10 {
                let range = tenth as f64 * length / 10.0..(tenth + 1) as f64 * length / 10.0;
                let within = sample.middles.iter().filter(|middle| range.contains(&middle[axis])).count();
                let share = within as f64 / count as f64;
                assert!((share - 0.1).abs() < 0.01, "axis {axis}, tenth {tenth}: {share}");
            }
        }
    }
}
