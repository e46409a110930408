//! A row is an exact positive multiple of its plane, in the form that it promises.

use dashu_int::{IBig, ops::BitTest, ops::Gcd};
use planecut_oracle::exact::{self as truth, integer_row};
use planecut_oracle::random::Rng;

use super::super::{Row, Sign};
use super::{DRAWS, exact, plane, row};
use crate::arithmetic::{exact_product, exponent};
use crate::half_space::{HalfSpace, MAX_NORMAL, MIN_NORMAL};

/// Planes of all kinds: decimal numbers, integers with common divisors, of all lengths up to beyond the limit, scaled.
fn coefficients(rng: &mut Rng) -> [f64; 4] {
    let bits = rng.integer(1, 50);
    let kind = rng.below(4);
    let factor = rng.pick(&[1.0, 2.0, 0.25, 3.0, 12.0, 1024.0]);
    let n = match kind {
        0 => rng.direction(),
        1 => rng.lattice(6),
        2 => rng.lattice(1 << bits),
        _ => rng.lattice(1 << bits).map(|v| if rng.chance(0.5) { 0.0 } else { v }),
    };
    let n = if n == [0.0; 3] { [0.0, 1.0, 0.0] } else { n };
    let d = match rng.below(4) {
        0 => 0.0,
        1 => rng.whole(-9, 9),
        2 => rng.whole(-1 << bits, 1 << bits),
        _ => rng.float(-9.0, 9.0),
    };
    [n[0], n[1], n[2], d].map(|v| v * factor)
}

fn is_multiple(found: &[IBig; 4], of: &[IBig; 4]) -> bool {
    (0..4).all(|i| {
        truth::sign(&found[i]) == truth::sign(&of[i]) && (0..i).all(|j| &found[i] * &of[j] == &found[j] * &of[i])
    })
}

#[test]
fn a_row_is_a_positive_multiple_of_its_plane_in_its_form() {
    let mut rng = Rng::new(1);
    let mut integer_rows = 0;
    for _ in 0..DRAWS {
        let given = coefficients(&mut rng);
        let row = row(given);
        let (stored, expected) = (row.coefficients(), integer_row(given));
        assert!(is_multiple(&integer_row(*stored), &expected), "{given:?}: {row:?}");
        assert!(stored.iter().all(|v| v.to_bits() != (-0.0f64).to_bits()), "{given:?}: {row:?}");
        let largest = stored[..3].iter().fold(0.0, |largest: f64, v| largest.max(v.abs()));
        let fits = expected.iter().all(|v| v.bit_len() <= 48);
        assert_eq!(row.integer_bits().is_some(), fits, "{given:?}: {row:?}");
        if fits {
            let integers = stored.map(|v| v as i64);
            assert_eq!(integers.map(|v| v as f64), *stored, "{given:?}");
            let divisor = integers.into_iter().fold(0u64, |g, v| match (g, v.unsigned_abs()) {
                (0, v) | (v, 0) => v,
                (g, v) => g.gcd(v),
            });
            assert_eq!(divisor, 1, "{given:?}: {row:?}");
            assert_eq!(row.integer_bits(), Some(IBig::from(largest as i64).bit_len() as u32), "{given:?}: {row:?}");
            assert_eq!(row.bits()[1], IBig::from(integers[3]).bit_len() as u32, "{given:?}: {row:?}");
            integer_rows += 1;
        } else {
            assert!((1.0..2.0).contains(&largest), "{given:?}: {row:?}");
        }
        let magnitude = row.magnitude();
        assert!(magnitude >= largest && magnitude <= largest * (1.0 + 2f64.powi(-22)), "{given:?}: {row:?}");
    }
    assert!(integer_rows > DRAWS / 4 && integer_rows < DRAWS * 3 / 4, "{integer_rows} of {DRAWS}");
}

#[test]
fn the_ends_of_the_accepted_range_become_rows() {
    for scale in [MIN_NORMAL, MAX_NORMAL] {
        let row = row([scale, -scale, 0.0, scale]);
        assert_eq!(row.coefficients(), &[1.0, -1.0, 0.0, 1.0]);
        assert_eq!(row.integer_bits(), Some(1));
    }
}

#[test]
fn a_flipped_row_is_that_of_the_opposite_half_space() {
    let mut rng = Rng::new(2);
    for _ in 0..DRAWS {
        let given = coefficients(&mut rng);
        let half_space = plane(given);
        assert_eq!(Row::new(&half_space).flipped(), Row::new(&half_space.flipped()), "{given:?}");
        assert!(Row::new(&half_space).flipped().coefficients().iter().all(|v| v.to_bits() != (-0.0f64).to_bits()));
    }
}

/// A plane and one like it: scaled by any number, opposite, or moved by a few units in the last place.
fn pair(rng: &mut Rng) -> [HalfSpace; 2] {
    let given = coefficients(rng);
    let factor = rng.pick(&[1.0, -1.0, 4.0, 3.0, -5.0, 0.1]);
    let mut other = given.map(|v| v * factor);
    if rng.chance(0.4) {
        let k = rng.below(4);
        other[k] = rng.nudge(other[k], 1);
    }
    [plane(given), plane(other)]
}

#[test]
fn equal_planes_are_told_exactly_and_share_their_ratios() {
    let mut rng = Rng::new(3);
    let mut equal = 0;
    for _ in 0..DRAWS {
        let planes = pair(&mut rng);
        let [p, q] = planes.map(|plane| Row::new(&plane));
        let [a, b] = planes.map(|plane| {
            let [x, y, z] = plane.normal().to_array();
            integer_row([x, y, z, plane.offset()])
        });
        let same = (0..4).all(|i| (0..i).all(|j| &a[i] * &b[j] == &a[j] * &b[i]));
        assert_eq!(p.is_same_plane(&q), same, "{planes:?}");
        assert_eq!(q.is_same_plane(&p), same, "{planes:?}");
        if same {
            let [r, s] = [&p, &q].map(|row| row.ratios().1.map(f64::to_bits));
            assert_eq!((p.ratios().0, r), (q.ratios().0, s), "{planes:?}");
            equal += 1;
        }
    }
    assert!(equal > DRAWS / 4 && equal < DRAWS, "{equal} of {DRAWS}");
}

#[test]
fn ratios_leave_out_the_first_coefficient_that_is_not_zero() {
    assert_eq!(row([2.0, 6.0, -4.0, 1.0]).ratios(), (0, [3.0, -2.0, 0.5]));
    assert_eq!(row([0.0, -2.0, 6.0, 1.0]).ratios(), (1, [0.0, -3.0, -0.5]));
    assert_eq!(row([0.0, 0.0, 4.0, 1.0]).ratios(), (2, [0.0, 0.0, 0.25]));
}

#[test]
fn a_product_is_exact_as_a_sum() {
    let mut rng = Rng::new(4);
    for _ in 0..DRAWS {
        let [a, b] = [(); 2].map(|()| rng.float(-9.0, 9.0) * 2f64.powi(rng.integer(-50, 50) as i32));
        let (high, low) = exact_product(a, b);
        assert_eq!(high, a * b);
        assert_eq!(exact(high) + exact(low), exact(a) * exact(b), "{a:e} · {b:e}");
    }
}

#[test]
fn the_exponent_of_a_number() {
    for power in [-1000, -1, 0, 1, 52, 1000] {
        let unit = 2f64.powi(power);
        assert_eq!([unit, -unit, unit * 1.75].map(exponent), [power; 3]);
    }
}

#[test]
fn signs_of_numbers_and_products() {
    assert_eq!([-2.0, 0.0, 3.0, f64::NAN].map(Sign::of), [Sign::Negative, Sign::Zero, Sign::Positive, Sign::Zero]);
    for (p, q) in [(-1, -1), (-1, 0), (-1, 1), (0, -1), (0, 0), (0, 1), (1, -1), (1, 0), (1, 1)] {
        assert_eq!(Sign::of(p).times(Sign::of(q)), Sign::of(p * q));
        assert_eq!(Sign::of(p).flip(), Sign::of(-p));
    }
}
