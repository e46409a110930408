//! The integer tiers: exact where they answer, and an answer wherever the numbers fit.

use dashu_int::IBig;
use planecut_oracle::exact::{self as truth, integer_row};
use planecut_oracle::random::Rng;

use super::super::filter::OffsetColumn;
use super::super::{Row, Sign, big, small_int, wide};
use super::{DRAWS, row, rows};
use crate::arithmetic::big_integers;

/// A permanent for which the floating-point value says nothing.
const LARGE: f64 = 1e300;

fn sign(value: &IBig) -> Sign {
    match truth::sign(value) {
        -1 => Sign::Negative,
        0 => Sign::Zero,
        _ => Sign::Positive,
    }
}

/// The longest integers of a number of bits, with random signs and last bits.
fn longest(rng: &mut Rng, bits: u32) -> f64 {
    let largest = (1i64 << bits) - 1;
    rng.pick(&[1.0, -1.0]) * (largest - 2 * rng.integer(0, 1)) as f64
}

/// Four integer rows whose normals have these numbers of bits, one by one, and whose offsets have `offset`.
fn long_rows(rng: &mut Rng, normals: [u32; 4], offset: u32) -> [[f64; 4]; 4] {
    normals.map(|bits| {
        // odd components keep the row from being divided by two
        let mut component = || longest(rng, bits);
        let n = [component(), component(), component()];
        [n[0], n[1], n[2], if offset == 0 { 0.0 } else { longest(rng, offset) }]
    })
}

fn normals(planes: &[[f64; 4]; 4]) -> [[IBig; 3]; 4] {
    planes.map(|plane| truth::normal(&integer_row(plane)))
}

/// Lengths up to those that no longer fit, with the largest of them that must be answered by small integers.
#[test]
fn small_integers_are_exact_up_to_their_capacity() {
    let mut rng = Rng::new(1);
    let mut answers = [0usize; 2];
    for draw in 0..DRAWS as u32 {
        let (most, offset) = (1 + draw % 48, (draw / 48) % 49);
        let lengths = [(); 4].map(|()| most - rng.below(most.min(3) as usize) as u32);
        let planes = long_rows(&mut rng, lengths, offset);
        let rows = planes.map(row);
        let [a, b, c, h] = &rows;
        let exact = normals(&planes);
        let total: u32 = lengths.iter().sum();

        let three = sign(&truth::det3(&exact[0], &exact[1], &exact[2]));
        let found = small_int::det3(a, b, c, 0.0, LARGE);
        assert!(found.is_none_or(|found| found == three), "{planes:?}: {found:?}, exactly {three:?}");
        // six products
        assert!(found.is_some() || total - lengths[3] + 3 > 127, "{planes:?} fit");
        answers[0] += usize::from(found.is_some());

        let all = planes.map(integer_row);
        let four = sign(&truth::det4([&all[0], &all[1], &all[2], &all[3]])).flip();
        let found = small_int::side4([a, b, c], h, OffsetColumn::Finite, 0.0, LARGE);
        assert!(found.is_none_or(|found| found == four), "{planes:?}: {found:?}, exactly {four:?}");
        // 24 products, each of one offset and three normals
        let shortest = lengths.iter().min().map_or(0, |shortest| total - shortest);
        assert!(found.is_some() || shortest + offset.max(1) + 5 > 127, "{planes:?} fit");
        answers[1] += usize::from(found.is_some());

        let [u, v] = rng.pick(&[[0, 1], [1, 2], [2, 0]]);
        let minor = sign(&(&exact[0][u] * &exact[1][v] - &exact[0][v] * &exact[1][u]));
        assert_eq!(small_int::det2(a, b, [u, v]), Some(minor), "{planes:?}");
    }
    assert!(answers.iter().all(|n| (DRAWS / 4..DRAWS).contains(n)), "{answers:?} of {DRAWS}");
}

/// Below `2^52` the floating-point value is an integer and exact: it is believed.
#[test]
fn a_small_permanent_makes_the_value_exact() {
    let [a, b, c, h] =
        [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0], [1.0, 1.0, 1.0, 3.0]].map(row);
    assert_eq!(small_int::det3(&a, &b, &c, 1.0, 1.0), Some(Sign::Positive));
    assert_eq!(small_int::side4([&a, &b, &c], &h, OffsetColumn::Finite, 0.0, 6.0), Some(Sign::Zero));
}

#[test]
fn rows_that_are_not_integers_are_refused() {
    let [a, b, c, h] =
        [[1.0, 2.0, 0.0, 1.0], [0.0, 1.0, 5.0, 1.0], [3.0, 0.0, 1.0, 1.0], [1.0, 1.0, 1.0, 3.0]].map(row);
    let decimal = row([0.1, 0.7, 0.3, 1.1]);
    for place in 0..4 {
        let mut rows = [&a, &b, &c, &h];
        rows[place] = &decimal;
        let [a, b, c, h] = rows;
        if place < 3 {
            assert_eq!(small_int::det3(a, b, c, 1.0, 1.0), None);
        }
        if place < 2 {
            assert_eq!(small_int::det2(a, b, [0, 1]), None);
        }
        assert_eq!(small_int::side4([a, b, c], h, OffsetColumn::Finite, 1.0, 1.0), None);
    }
}

/// Every finite number, those below the normal range too, keeps its ratio to the others.
#[test]
fn big_integers_are_the_numbers_up_to_one_positive_scale() {
    let mut rng = Rng::new(2);
    let tiny = f64::from_bits(1);
    for _ in 0..DRAWS {
        let numbers: [f64; 4] = std::array::from_fn(|_| {
            let any = f64::from_bits(rng.bits());
            let small = tiny * rng.whole(-9, 9);
            let middle = rng.float(-1.0, 1.0);
            let number = rng.pick(&[any, small, middle, 0.0, -0.0, f64::MIN_POSITIVE, f64::MAX]);
            if number.is_finite() { number } else { 1.0 }
        });
        let (found, expected) = (big_integers(numbers), integer_row(numbers));
        for i in 0..4 {
            assert_eq!(truth::sign(&found[i]), truth::sign(&expected[i]), "{numbers:?}");
            for j in 0..i {
                assert_eq!(&found[i] * &expected[j], &found[j] * &expected[i], "{numbers:?}");
            }
        }
    }
}

/// Rows whose coefficients lie `spread` powers of two apart at most, some of them as far as that.
fn spread_rows(rng: &mut Rng, spread: i32) -> [[f64; 4]; 4] {
    std::array::from_fn(|_| {
        let mut row: [f64; 4] = std::array::from_fn(|_| {
            let odd = (2 * rng.integer(1 << 51, (1 << 52) - 1) + 1) as f64;
            rng.pick(&[1.0, -1.0]) * odd * 2f64.powi(rng.integer(0, i64::from(spread - 52)) as i32)
        });
        // the lowest bit of the one is at 0, the highest of the other at `spread`
        let (i, j) = (rng.below(3), rng.below(3));
        row[i] = row[i].signum() * (2f64.powi(53) - 1.0);
        row[(i + 1 + j) % 4] = (2f64.powi(53) - 1.0) * 2f64.powi(spread - 52);
        row
    })
}

/// All determinants of the last tier, by integers of fixed length if `fits`, and by those of any.
fn check_determinants(rows: &[Row; 4], fits: bool) {
    let planes = rows.map(|row| integer_row(*row.coefficients()));
    let [a, b, c, h] = rows;
    let n = [0, 1, 2, 3].map(|k| truth::normal(&planes[k]));
    let crossed = truth::cross(&n[0], &n[1]);
    let three = sign(&truth::det3(&n[0], &n[1], &n[2]));
    let four = sign(&truth::det4([&planes[0], &planes[1], &planes[2], &planes[3]]));
    assert_eq!(big::det3(a, b, c), three, "{rows:?}");
    assert_eq!(big::det3_of_any(a, b, c), three, "{rows:?}");
    assert_eq!(big::det4([a, b, c, h], OffsetColumn::Finite), four, "{rows:?}");
    assert_eq!(big::det4_of_any([a, b, c, h], OffsetColumn::Finite), four, "{rows:?}");
    for (k, value) in crossed.iter().enumerate() {
        let columns = [(k + 1) % 3, (k + 2) % 3];
        assert_eq!(big::det2(a, b, columns), sign(value), "{rows:?}");
        assert_eq!(big::det2_of_any(a, b, columns), sign(value), "{rows:?}");
    }
    assert_eq!(wide::det4([a, b, c, h], OffsetColumn::Finite), fits.then_some(four), "{rows:?}");
}

/// The last tier alone, for rows that the others would have answered.
#[test]
fn big_determinants_are_exact() {
    let mut rng = Rng::new(3);
    for _ in 0..DRAWS {
        check_determinants(&rows(&mut rng), true);
    }
}

/// Up to the largest spread of a row, and just beyond it; exact zeros too.
#[test]
fn integers_of_fixed_length_are_exact_up_to_their_capacity() {
    let mut rng = Rng::new(4);
    for draw in 0..DRAWS {
        let spread = [53, 64, 100, 124, 125, 130][draw % 6];
        let mut planes = spread_rows(&mut rng, spread);
        if rng.chance(0.3) {
            // three planes through one line, or twice the same plane
            planes[3] = rng.pick(&[planes[0], planes[1].map(|v| -v)]);
        }
        check_determinants(&planes.map(row), spread < 125);
    }
}
