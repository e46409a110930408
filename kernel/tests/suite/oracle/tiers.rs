//! Which tier answers a sign: floating point what is not nearly zero, small integers what fits them, big integers the rest.

use dashu_int::IBig;
use planecut_kernel::sign::{Counts, Homogeneous, Row, Sign, cross_component, orient3, orient4};
use planecut_oracle::exact::{Coefficients, cross, det3, det4, dot, integer_row, normal};
use planecut_oracle::kernel_calls::half_space;
use planecut_oracle::random::Rng;
use planecut_oracle::settings::first_seed;

/// A value above `2^-CLEAR` of the sum of the magnitudes of its terms is clear: the bounds are at most 12 half units in the
/// last place.
const CLEAR: usize = 48;
const DRAWS: usize = 2_000;

/// Which tier answered, and what.
fn ask(sign: impl FnOnce() -> Sign) -> (Counts, Sign) {
    let start = Counts::now();
    let answer = sign();
    let counts = Counts::since(start);
    assert!(counts.total == 1 && counts.small_int + counts.big <= 1, "{counts:?}");
    (counts, answer)
}

/// The three signs of four rows.
fn ask_all([a, b, c, d]: &[Row; 4]) -> [(Counts, Sign); 3] {
    [ask(|| orient3(a, b, c)), ask(|| orient4(a, b, c, d)), ask(|| cross_component(a, b, 2))]
}

fn magnitude(v: IBig) -> IBig {
    if v < IBig::ZERO { -v } else { v }
}

/// Which of the signs are clear: the value of each and the sum of the magnitudes of its terms. That of a determinant is
/// its permanent: the signs of the products left out.
fn clear(planes: &[Coefficients; 4]) -> [bool; 3] {
    let rows = planes.map(integer_row);
    let sizes = rows.clone().map(|row| row.map(magnitude));
    let (n, m) = (rows.clone().map(|row| normal(&row)), sizes.clone().map(|row| normal(&row)));
    let permanent_cross =
        |a: &[IBig; 3], b: &[IBig; 3]| [(1, 2), (2, 0), (0, 1)].map(|(u, v)| &a[u] * &b[v] + &a[v] * &b[u]);
    let permanent3 = |a, b, c| dot(a, &permanent_cross(b, c));
    let permanent4 = &sizes[0][3] * permanent3(&m[1], &m[2], &m[3])
        + &sizes[1][3] * permanent3(&m[0], &m[2], &m[3])
        + &sizes[2][3] * permanent3(&m[0], &m[1], &m[3])
        + &sizes[3][3] * permanent3(&m[0], &m[1], &m[2]);
    let values =
        [det3(&n[0], &n[1], &n[2]), det4([&rows[0], &rows[1], &rows[2], &rows[3]]), cross(&n[0], &n[1])[2].clone()];
    let permanents = [permanent3(&m[0], &m[1], &m[2]), permanent4, permanent_cross(&m[0], &m[1])[2].clone()];
    let mut sides = values.into_iter().zip(permanents);
    std::array::from_fn(|_| sides.next().is_some_and(|(value, permanent)| (magnitude(value) << CLEAR) > permanent))
}

/// Rows whose components differ much in size, so that bounds from the largest alone are too large; the last two are nearly
/// combinations of the first.
fn uneven(rng: &mut Rng) -> [Coefficients; 4] {
    let reach = rng.pick(&[0, 10, 60]);
    let width = rng.pick(&[1.0, 1e-6, 1e-12, 1e-14]);
    let mut row = || -> Coefficients {
        std::array::from_fn(|_| rng.float(0.5, 1.0) * rng.pick(&[1.0, -1.0]) * 2f64.powi(-rng.integer(0, reach) as i32))
    };
    let [a, b, c, d] = [row(), row(), row(), row()];
    let near = |other: Coefficients| std::array::from_fn(|k| a[k] - b[k] + width * other[k]);
    [a, b, near(c), near(d)]
}

#[test]
fn clear_signs_are_filtered() {
    let mut rng = Rng::new(first_seed());
    let (mut seen, mut exact) = ([0; 3], [0; 3]);
    for _ in 0..DRAWS {
        let planes = uneven(&mut rng);
        let rows = planes.map(|plane| Row::new(&half_space(plane)));
        for (k, ((counts, sign), is_clear)) in ask_all(&rows).into_iter().zip(clear(&planes)).enumerate() {
            seen[k] += usize::from(is_clear);
            exact[k] += usize::from(counts.filtered() == 0);
            assert!(!is_clear || (counts.filtered() == 1 && sign != Sign::Zero), "sign {k}: {counts:?}\n{planes:?}");
        }
    }
    assert!(seen.iter().all(|n| *n > DRAWS / 2), "{seen:?} of {DRAWS} are clear");
    assert!(exact[..2].iter().all(|n| *n > 0), "{exact:?} of {DRAWS} are not");
}

/// Four rows through one line, whose signs are all zero but that of the component.
fn dependent(a: [f64; 4], b: [f64; 4]) -> [Row; 4] {
    let combination = |s: f64, t: f64| std::array::from_fn(|k| s * a[k] + t * b[k]);
    [a, b, combination(1.0, 1.0), combination(1.0, -1.0)].map(|plane| Row::new(&half_space(plane)))
}

#[test]
fn zeros_of_small_integers_need_no_big_ones() {
    let mut rng = Rng::new(first_seed());
    let (mut asked, mut answered) = (0, 0);
    for bits in [2, 8, 16, 24, 27, 28] {
        for _ in 0..50 {
            let mut row = || {
                let n = rng.lattice(1 << bits);
                [n[0], n[1], n[2], rng.whole(-1 << bits, 1 << bits)]
            };
            let (a, b) = (row(), row());
            if a[0] * b[1] == a[1] * b[0] || a[1] * b[2] == a[2] * b[1] {
                continue;
            }
            let rows = dependent(a, b);
            for (k, (counts, sign)) in ask_all(&rows)[..2].iter().enumerate() {
                assert_eq!(*sign, Sign::Zero, "sign {k}: {rows:?}");
                assert_eq!(counts.big, 0, "sign {k}: {counts:?} {rows:?}");
                asked += 1;
                answered += counts.small_int;
            }
        }
    }
    assert!(answered > asked / 2, "small integers answered {answered} of {asked}");
}

/// What is zero term by term is so in floating point.
#[test]
fn sums_of_zeros_are_filtered() {
    let axes = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.1, 0.0, 0.0, 0.0], [0.7, 0.0, 0.0, 0.3]];
    let [x, y, z, other] = axes.map(|plane| Row::new(&half_space(plane)));
    let zeros = [ask(|| orient3(&x, &z, &other)), ask(|| orient4(&x, &y, &z, &x)), ask(|| cross_component(&x, &y, 0))];
    for (k, (counts, sign)) in zeros.into_iter().enumerate() {
        assert_eq!((counts.filtered(), sign), (1, Sign::Zero), "sign {k}: {counts:?}");
    }
}

/// Decimal numbers whose signs are exactly zero: no tier but the last can say so.
#[test]
fn zeros_of_decimal_numbers_need_big_integers() {
    let (a, b) = ([0.1, 0.7, 0.3, 0.9], [0.2, 0.3, 0.9, 0.5]);
    let quadrupled = [a[0] * 4.0, a[1] * 4.0, a[2] * 4.0, a[3]];
    let [a, b, quadrupled, c] = [a, b, quadrupled, [0.9, 0.4, 0.1, 0.2]].map(|plane| Row::new(&half_space(plane)));
    let zeros = [
        ask(|| orient3(&a, &b, &quadrupled)),
        ask(|| orient4(&a, &b, &c, &a)),
        ask(|| cross_component(&a, &quadrupled, 0)),
    ];
    for (k, (counts, sign)) in zeros.into_iter().enumerate() {
        assert_eq!((counts.big, sign), (1, Sign::Zero), "sign {k}: {counts:?}");
    }
    assert_eq!(Homogeneous::meet(&a, &b, &c).side_of([&a, &b, &c], &b), Sign::Zero);
}

#[test]
fn counts_add_up() {
    let [x, y, z] =
        [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0]].map(|p| Row::new(&half_space(p)));
    let start = Counts::now();
    let sum = [orient3(&x, &y, &z), orient3(&x, &z, &y), orient3(&x, &y, &y)];
    assert_eq!(sum, [Sign::Positive, Sign::Negative, Sign::Zero]);
    let first = Counts::since(start);
    assert_eq!(first.total, 3);
    let mut total = Counts { total: 10, small_int: 4, big: 1 };
    total += Counts { total: 100, small_int: 20, big: 30 };
    assert_eq!(total, Counts { total: 110, small_int: 24, big: 31 });
    assert_eq!(total.filtered(), 110 - 24 - 31);
}
