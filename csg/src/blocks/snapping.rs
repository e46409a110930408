//! Planes of a model that are one but for noise, found without having all planes in memory.
//!
//! Which plane stands for another must be decided once for all blocks, or what is one plane in one of them would be two in another.
//! Each plane has a place on a line; those that are nearly the same lie close together there. The places ([`PlaneMark`]) are sorted, wherever
//! there is room for that; where different planes lie close together is a range ([`NearRanges`]), and only the planes in ranges are compared.

use planecut_kernel::HalfSpace;
use planecut_kernel::sign::Row;
use rustc_hash::FxHashSet;

use crate::base::{WEIGHTS, hash_of, sortable};
use crate::plane_table::{Snapped, first_side, is_exact, unit};
use crate::tolerances::SNAP_TOLERANCE;

/// The sum of the weights times the tolerance, and room for rounding.
const APART: f64 = 3.0 * SNAP_TOLERANCE;

/// What is known of all planes of a model.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct PlaneSurvey {
    /// The largest distance of a plane from the origin.
    reach: f64,
    /// The size of the smallest brush.
    size: f64,
    /// Whether a plane may be noise.
    has_noise: bool,
}

/// The place of a plane on a line, and a number that it shares with planes that are exactly the same and stated at the same scale, but for powers of two.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct PlaneMark {
    /// The place, in the order of these numbers.
    pub place: u64,
    /// The plane.
    pub plane: u64,
}

impl PlaneSurvey {
    /// Adds a plane to what is known.
    pub(super) fn note(&mut self, half_space: &HalfSpace) {
        let row = Row::new(half_space);
        self.reach = self.reach.max(unit(&row)[3].abs());
        self.has_noise |= !is_exact(&row);
    }

    /// With the size of the smallest brush.
    pub(super) fn with_size(self, size: f64) -> Self {
        Self { size, ..self }
    }

    /// Whether planes may be nearly the same: where all are made of short integers, each is meant as it is.
    #[must_use]
    pub fn has_noise(&self) -> bool {
        self.has_noise
    }

    /// The marks of a plane: two where noise may have turned it over.
    pub fn marks(&self, half_space: &HalfSpace) -> impl Iterator<Item = PlaneMark> + use<> {
        let row = first_side(&Row::new(half_space)).0;
        let unit = unit(&row);
        // different planes can have equal ratios: noise may be lost in a division
        let largest = row.coefficients()[..3].iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
        let power = f64::from_bits(largest.to_bits() >> 52 << 52);
        let plane = hash_of(&row.coefficients().map(|value| (value / power).to_bits()));
        let number = self.number(unit);
        let other = (unit[0] <= SNAP_TOLERANCE).then(|| self.number(unit.map(|v| -v)));
        [Some(number), other].into_iter().flatten().map(move |number| PlaneMark { place: sortable(number), plane })
    }

    fn number(&self, [x, y, z, d]: [f64; 4]) -> f64 {
        let reach = self.reach.max(self.size).max(f64::MIN_POSITIVE);
        [x, y, z, d / reach].iter().zip(WEIGHTS).map(|(v, w)| v * w).sum::<f64>()
    }
}

/// Where on the line different planes lie so close together that they may be nearly the same.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct NearRanges {
    /// First and last place of each, ascending.
    ranges: Vec<(u64, u64)>,
    last: Option<PlaneMark>,
}

impl NearRanges {
    /// Adds a mark; all marks of a model come in ascending order.
    pub fn push(&mut self, mark: PlaneMark) {
        if let Some(last) = self.last.replace(mark)
            && last.plane != mark.plane
            && number_of(mark.place) - number_of(last.place) <= APART
        {
            match self.ranges.last_mut() {
                Some(range) if range.1 >= last.place => range.1 = mark.place,
                _ => self.ranges.push((last.place, mark.place)),
            }
        }
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.ranges.is_empty()
    }

    fn holds(&self, mark: PlaneMark) -> bool {
        let range = self.ranges.partition_point(|range| range.1 < mark.place);
        self.ranges.get(range).is_some_and(|range| range.0 <= mark.place)
    }
}

/// The number of a place.
fn number_of(place: u64) -> f64 {
    f64::from_bits(if place >> 63 == 1 { place & !(1 << 63) } else { !place })
}

/// Collects the planes that may be nearly the same as another.
#[derive(Debug)]
pub struct NearPlaneFinder {
    survey: PlaneSurvey,
    ranges: NearRanges,
    known: FxHashSet<[u64; 4]>,
    planes: Vec<HalfSpace>,
}

impl NearPlaneFinder {
    /// A finder of planes in some ranges.
    #[must_use]
    pub fn new(survey: PlaneSurvey, ranges: NearRanges) -> Self {
        Self { survey, ranges, known: FxHashSet::default(), planes: Vec::new() }
    }

    /// Adds a plane of the model.
    pub fn note(&mut self, half_space: &HalfSpace) {
        if self.survey.marks(half_space).any(|mark| self.ranges.holds(mark))
            && self.known.insert(half_space.to_array().map(f64::to_bits))
        {
            self.planes.push(*half_space);
        }
    }

    /// What stands for which plane.
    #[must_use]
    pub fn finish(self) -> SnappedPlanes {
        SnappedPlanes { snapped: Snapped::of(&self.planes, self.survey.size) }
    }
}

/// The planes of a model for which another stands that is nearly the same: in memory as far as there are such.
#[derive(Debug, Default)]
pub struct SnappedPlanes {
    snapped: Snapped,
}

impl SnappedPlanes {
    /// What stands for a plane: itself, where nothing else does.
    #[must_use]
    pub fn of_plane(&self, half_space: &HalfSpace) -> HalfSpace {
        self.snapped.of_plane(half_space)
    }

    /// How many planes others stand for.
    #[must_use]
    pub fn count(&self) -> usize {
        self.snapped.count()
    }
}

/// The planes that others stand for, among planes in memory.
pub(super) fn snapped_among<'a>(
    survey: PlaneSurvey,
    half_spaces: impl Iterator<Item = &'a HalfSpace> + Clone,
) -> SnappedPlanes {
    if !survey.has_noise() {
        return SnappedPlanes::default();
    }
    let mut marks: Vec<PlaneMark> = half_spaces.clone().flat_map(|half_space| survey.marks(half_space)).collect();
    marks.sort_unstable();
    let mut ranges = NearRanges::default();
    marks.into_iter().for_each(|mark| ranges.push(mark));
    let mut finder = NearPlaneFinder::new(survey, ranges);
    half_spaces.for_each(|half_space| finder.note(half_space));
    finder.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use planecut_kernel::DVec3;

    fn half_space(normal: [f64; 3], offset: f64) -> HalfSpace {
        HalfSpace::new(DVec3::from_array(normal), offset).expect("a plane")
    }

    /// Whether one plane stands for both, at whatever scale.
    fn are_one(snapped: &SnappedPlanes, planes: &[HalfSpace; 2]) -> bool {
        let [a, b] = planes.map(|plane| Row::new(&snapped.of_plane(&plane)));
        a.is_same_plane(&b)
    }

    fn snapped(planes: &[HalfSpace]) -> SnappedPlanes {
        let mut survey = PlaneSurvey::default();
        planes.iter().for_each(|plane| survey.note(plane));
        snapped_among(survey, planes.iter())
    }

    #[test]
    fn planes_whose_ratios_are_equal_are_told_apart() {
        // seed of a search for planes that differ in one bit and have the same quotients
        let mut found = 0;
        for k in 1..400_u32 {
            let x = 0.7 + 1e-3 * f64::from(k);
            let planes = [x, x.next_up()].map(|x| half_space([x, 0.5 * x + 0.1, 0.3], 2.0));
            let rows = planes.map(|plane| first_side(&Row::new(&plane)).0);
            if rows[0].ratios() == rows[1].ratios() && !rows[0].is_same_plane(&rows[1]) {
                found += 1;
            }
            let snapped = snapped(&planes);
            assert!(are_one(&snapped, &planes), "{planes:?}");
        }
        println!("{found} pairs with equal ratios");
        for k in 1..400_u32 {
            let x = 1.0 + 1e-3 * f64::from(k);
            // only the offset differs, by less than the quotient can hold
            let planes = [1.0, 1.0_f64.next_up()].map(|offset| half_space([x, 0.3, 0.7 * x], offset));
            let rows = planes.map(|plane| first_side(&Row::new(&plane)).0);
            found += usize::from(rows[0].ratios() == rows[1].ratios());
            let snapped = snapped(&planes);
            assert!(are_one(&snapped, &planes), "{planes:?}");
        }
        assert!(found > 0);
    }

    #[test]
    fn a_plane_that_noise_has_turned_over_is_found() {
        let planes = [half_space([1e-17, 0.6, 0.8], 1.0), half_space([-1e-17, 0.6, 0.8], 1.0)];
        let snapped = snapped(&planes);
        assert!(are_one(&snapped, &planes));
        assert_eq!(snapped.count(), 1);
    }

    #[test]
    fn planes_of_short_integers_are_meant_as_they_are() {
        let planes =
            [half_space([3.0, 4.0, 0.0], 1.0), half_space([6.0, 8.0, 0.0], 2.0), half_space([3.0, 4.0, 0.0], 1.5)];
        assert_eq!(snapped(&planes).count(), 0);
    }
}
