//! How often the sides of loops cross, counted before they are combined: each crossing becomes a corner.

use planecut_kernel::DVec2;

use crate::parameter::ShapeError;

/// Most crossings of the sides of loops that are combined: 1,048,576.
pub const MAX_CROSSINGS: u64 = 1 << 20;

/// Most pairs of sides that are looked at. Long sides side by side have more and need not cross: they are combined uncounted.
const MAX_PAIRS: u64 = 1 << 28;

/// Refuses loops whose sides cross too often.
///
/// # Errors
/// [`ShapeError::Crossings`].
pub(super) fn refuse_many<'a>(loops: impl Iterator<Item = &'a Vec<DVec2>> + Clone) -> Result<(), ShapeError> {
    let sides = loops.clone().map(|corners| corners.len() as u64).sum::<u64>();
    if sides * sides.saturating_sub(1) / 2 <= MAX_CROSSINGS {
        return Ok(());
    }
    let found = crossings(loops);
    if found <= MAX_CROSSINGS { Ok(()) } else { Err(ShapeError::Crossings { found, limit: MAX_CROSSINGS }) }
}

/// A side, its ends by their x.
struct Side {
    ends: [DVec2; 2],
    low: f64,
    high: f64,
}

impl Side {
    fn new(a: DVec2, b: DVec2) -> Self {
        let ends = if a.x <= b.x { [a, b] } else { [b, a] };
        Self { ends, low: a.y.min(b.y), high: a.y.max(b.y) }
    }

    /// Whether they cross, each strictly within the other but for rounding.
    fn crosses(&self, other: &Self) -> bool {
        let parts = |side: &Self, other: &Self| {
            let along = side.ends[1] - side.ends[0];
            let [a, b] = other.ends.map(|end| along.perp_dot(end - side.ends[0]));
            a * b < 0.0
        };
        self.low < other.high && other.low < self.high && parts(self, other) && parts(other, self)
    }
}

/// How many pairs of sides cross, or of the first [`MAX_PAIRS`] that share an x.
fn crossings<'a>(loops: impl Iterator<Item = &'a Vec<DVec2>>) -> u64 {
    let sides_of = |corners: &'a Vec<DVec2>| {
        let next = corners.iter().cycle().skip(1);
        corners.iter().zip(next).map(|(a, b)| Side::new(*a, *b))
    };
    let mut sides: Vec<Side> = loops.flat_map(sides_of).collect();
    sides.sort_unstable_by(|a, b| a.ends[0].x.total_cmp(&b.ends[0].x));
    let (mut count, mut pairs) = (0, 0);
    for (k, side) in sides.iter().enumerate() {
        let beside = sides[k + 1..].iter().take_while(|other| other.ends[0].x < side.ends[1].x);
        for other in beside {
            pairs += 1;
            count += u64::from(side.crosses(other));
        }
        if pairs > MAX_PAIRS {
            break;
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use planecut_testkit::random::Rng;

    use super::*;

    #[test]
    fn crossings_are_counted_as_by_every_pair() {
        for seed in 0..100 {
            let mut rng = Rng::new(seed);
            let corners: Vec<DVec2> =
                (0..3 + rng.below(60)).map(|_| DVec2::new(rng.float(-1.0, 1.0), rng.float(-1.0, 1.0))).collect();
            let n = corners.len();
            let side = |k: usize| (corners[k], corners[(k + 1) % n]);
            // by the places along both sides where their lines meet
            let crosses = |i: usize, j: usize| {
                let ((a, b), (c, d)) = (side(i), side(j));
                let (u, v) = (b - a, d - c);
                let (s, t) = ((c - a).perp_dot(v) / u.perp_dot(v), (c - a).perp_dot(u) / u.perp_dot(v));
                let neighbours = j == i + 1 || (i == 0 && j == n - 1);
                !neighbours && (0.0..1.0).contains(&s) && (0.0..1.0).contains(&t)
            };
            let expected =
                (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j))).filter(|(i, j)| crosses(*i, *j)).count();
            assert_eq!(crossings([corners].iter()), expected as u64, "seed {seed}");
        }
    }

    #[test]
    fn a_grid_of_needles_is_refused_with_count_and_limit() {
        let needle = |at: DVec2, along: DVec2, across: DVec2| vec![at, at + along, at + along + across, at + across];
        let (long, thin) = (3000.0, 0.5);
        let grid = |count: u32| -> Vec<Vec<DVec2>> {
            let rows = (0..count).map(|k| needle(DVec2::new(-1.0, f64::from(k)), DVec2::X * long, DVec2::Y * thin));
            let columns = (0..count).map(|k| needle(DVec2::new(f64::from(k), -1.0), DVec2::Y * long, DVec2::X * thin));
            rows.chain(columns).collect()
        };
        // each row crosses each column in four points
        assert_eq!(refuse_many(grid(512).iter()), Ok(()));
        let error = ShapeError::Crossings { found: 4 * 520 * 520, limit: MAX_CROSSINGS };
        assert_eq!(refuse_many(grid(520).iter()), Err(error));
    }
}
