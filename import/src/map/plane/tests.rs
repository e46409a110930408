//! Planes against rational arithmetic.

use dashu_int::ops::{Gcd, UnsignedAbs};
use dashu_int::{IBig, UBig};
use dashu_ratio::RBig;
use planecut_kernel::HalfSpace;
use planecut_testkit::random::Rng;

use super::{Decimal, PlaneError, Point, half_space};

/// A generator whose seed the test prints.
fn seeded_by_clock() -> Rng {
    let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).map_or(0, |d| d.as_nanos() as u64);
    println!("seed {now}");
    Rng::new(now)
}

/// A number as an editor might write it; `style` picks whole numbers, decimals (the first three styles), a double in
/// full, or very different sizes.
fn number(random: &mut Rng, style: u64) -> String {
    match style % 5 {
        0 => random.integer(-4096, 4096).to_string(),
        1 => format!("{:.6}", random.whole(-4_096_000_000, 4_096_000_000) / 1e6),
        2 => format!("{:.2}", random.whole(-400, 400) / 100.0),
        3 => (random.whole(-(1 << 53), 1 << 53) * 2_f64.powi(random.integer(-60, -40) as i32)).to_string(),
        _ => {
            let power = if random.chance(0.5) { random.integer(-12, -8) } else { random.integer(16, 20) };
            (random.whole(-99, 99) * 10_f64.powi(power as i32)).to_string()
        }
    }
}

fn point(texts: [&str; 3]) -> Point {
    texts.map(|text| Decimal::parse(text.as_bytes()).expect("a number"))
}

fn plane(points: [[&str; 3]; 3]) -> Result<HalfSpace, PlaneError> {
    half_space(&points.map(point))
}

fn bits(plane: &HalfSpace) -> [u64; 4] {
    let n = plane.normal();
    [n.x, n.y, n.z, plane.offset()].map(f64::to_bits)
}

fn rational(value: f64) -> RBig {
    RBig::try_from(value).expect("a finite number")
}

/// The number that a text means: a decimal where the points hold few digits, its `f64` otherwise.
fn meaning(text: &str, few_digits: bool) -> RBig {
    if !few_digits {
        return rational(text.parse().expect("a number"));
    }
    let (whole, fraction) = text.split_once('.').unwrap_or((text, ""));
    let digits: IBig = format!("{whole}{fraction}").parse().expect("digits");
    RBig::from(digits) / RBig::from(IBig::from(10).pow(fraction.len()))
}

/// `[nx, ny, nz, d]` by the definition.
fn oracle(points: &[[String; 3]; 3], few_digits: bool) -> [RBig; 4] {
    let [p0, p1, p2] = points.each_ref().map(|p| p.each_ref().map(|text| meaning(text, few_digits)));
    let difference = |p: &[RBig; 3]| [0, 1, 2].map(|k| &p[k] - &p1[k]);
    let (a, b) = (difference(&p0), difference(&p2));
    let normal = [(1, 2), (2, 0), (0, 1)].map(|(u, v)| &a[u] * &b[v] - &a[v] * &b[u]);
    let offset = &normal[0] * &p1[0] + &normal[1] * &p1[1] + &normal[2] * &p1[2];
    let [x, y, z] = normal;
    [x, y, z, offset]
}

/// Whether `plane` is `exact` up to a positive factor.
fn same_plane(plane: [f64; 4], exact: &[RBig; 4]) -> bool {
    let plane = plane.map(rational);
    let proportional = (0..4).all(|i| (0..i).all(|j| &plane[i] * &exact[j] == &plane[j] * &exact[i]));
    let k = (0..3).find(|&k| !exact[k].is_zero()).expect("a normal");
    proportional && &plane[k] * &exact[k] > RBig::ZERO
}

/// Whether no `f64` is nearer to `exact` than `value`.
fn is_nearest(value: f64, exact: &RBig) -> bool {
    let distance = |v: f64| {
        let difference = rational(v) - exact;
        if difference < RBig::ZERO { -difference } else { difference }
    };
    distance(value) <= distance(value.next_up()) && distance(value) <= distance(value.next_down())
}

/// The integers without a common factor that are `exact` up to a positive factor.
fn primitive(exact: &[RBig; 4]) -> [RBig; 4] {
    let denominator = exact.iter().fold(UBig::ONE, |all, v| &all * v.denominator() / (&all).gcd(v.denominator()));
    let integers = exact.each_ref().map(|v| v * RBig::from(denominator.clone()));
    let divisor = integers.iter().filter(|v| !v.is_zero()).fold(UBig::ZERO, |all, v| {
        let magnitude = v.numerator().unsigned_abs();
        if all.is_zero() { magnitude } else { all.gcd(magnitude) }
    });
    integers.map(|v| v / RBig::from(divisor.clone()))
}

/// Whether coefficients lie further apart than [`HalfSpace`] accepts.
fn is_out_of_range(exact: &[RBig; 4]) -> bool {
    let sizes = exact.each_ref().map(|v| if *v < RBig::ZERO { -v } else { v.clone() });
    let largest = sizes[..3].iter().max().expect("three");
    let ratio = rational(planecut_kernel::MAX_NORMAL_RATIO);
    sizes.iter().any(|v| !v.is_zero() && &(v * &ratio) < largest) || sizes[3] > largest * &ratio
}

/// Whether `plane` is the primitive integers rounded at a power-of-two scale, the largest normal component in `[1, 2)`.
fn is_rounded(plane: [f64; 4], exact: &[RBig; 4]) -> bool {
    let exact = primitive(exact);
    let largest = (0..3).max_by(|&i, &j| plane[i].abs().total_cmp(&plane[j].abs())).expect("three");
    // The quotient is a power of two up to half a unit in the last place.
    let quotient = rational(plane[largest]) / &exact[largest];
    let guess = quotient.to_f64().value();
    let scale = rational(2_f64.powi(guess.log2().round() as i32));
    (1.0..2.0).contains(&plane[largest].abs()) && (0..4).all(|k| is_nearest(plane[k], &(&exact[k] * &scale)))
}

#[test]
fn axis_planes_are_small_integers() {
    let plane = plane([["64", "0", "0"], ["64.000000", "0", "16"], ["64", "16.5", "0"]]).expect("a plane");
    assert_eq!((plane.normal().to_array(), plane.offset()), ([1.0, 0.0, 0.0], 64.0));
}

#[test]
fn orientation_follows_the_definition() {
    let plane = plane([["1", "0", "0"], ["0", "0", "0"], ["0", "1", "0"]]).expect("a plane");
    assert_eq!((plane.normal().to_array(), plane.offset()), ([0.0, 0.0, 1.0], 0.0));
}

#[test]
fn zeros_carry_no_sign() {
    let plane = plane([["-0", "-0", "-16"], ["-0", "-0", "-0"], ["64", "-0", "-16"]]).expect("a plane");
    assert_eq!(bits(&plane), [0.0, -1.0, 0.0, 0.0].map(f64::to_bits));
}

#[test]
fn points_on_a_line_have_no_plane() {
    for points in [
        [["0", "0", "0"]; 3],
        [["0", "0", "0"], ["1", "1", "1"], ["2", "2", "2"]],
        [["0.1", "0.2", "0.3"], ["0.2", "0.4", "0.6"], ["0.4", "0.8", "1.2"]],
        [["1e200", "0", "0"], ["1e250", "0", "0"], ["1e300", "0", "0"]],
        [["0.1234567890123", "5", "0"], ["0.1234567890123", "6", "0"], ["0.1234567890123", "-7", "0"]],
    ] {
        assert_eq!(plane(points), Err(PlaneError::NoArea), "{points:?}");
    }
}

#[test]
fn sizes_outside_the_range_are_refused() {
    for points in [
        [["1e300", "0", "0"], ["1e300", "1", "0"], ["1e300", "0", "1"]],
        [["1e-300", "0", "0"], ["1e-300", "1", "0"], ["1e-300", "0", "1"]],
        [["1e308", "1e308", "0"], ["-1e308", "1e308", "1e-308"], ["1e-308", "-1e308", "1e308"]],
        [["0", "0", "0"], ["1", "0", "1e-320"], ["0", "1", "0"]],
    ] {
        assert!(matches!(plane(points), Err(PlaneError::OutOfRange(_))), "{points:?}");
    }
}

#[test]
fn random_points_against_rationals() {
    let mut random = seeded_by_clock();
    let (mut exact_planes, mut rounded_planes) = (0, 0);
    for round in 0..20_000 {
        let points: [[String; 3]; 3] = std::array::from_fn(|_| std::array::from_fn(|_| number(&mut random, round)));
        let few_digits = round % 5 < 3;
        let exact = oracle(&points, few_digits);
        let found = half_space(&points.each_ref().map(|p| point(p.each_ref().map(String::as_str))));
        match found {
            Ok(plane) => {
                let plane = [plane.normal().x, plane.normal().y, plane.normal().z, plane.offset()];
                let is_exact = same_plane(plane, &exact);
                assert!(is_exact || is_rounded(plane, &exact), "{points:?} gave {plane:?}");
                *(if is_exact { &mut exact_planes } else { &mut rounded_planes }) += 1;
            }
            Err(PlaneError::NoArea) => assert!(exact[..3].iter().all(RBig::is_zero), "{points:?}"),
            Err(PlaneError::OutOfRange(error)) => assert!(is_out_of_range(&exact), "{points:?} gave {error}"),
        }
    }
    println!("{exact_planes} exact, {rounded_planes} rounded");
    assert!(exact_planes > 4000 && rounded_planes > 4000, "both ways were taken");
}

/// Points `o + i·u + j·v` for different `i, j` span one plane.
#[test]
fn coplanar_faces_are_bit_identical() {
    let mut random = seeded_by_clock();
    for round in 0..5_000 {
        let vector = |random: &mut Rng| [0; 3].map(|_: i64| random.integer(-2000, 2000));
        let (o, u, v) = (vector(&mut random), vector(&mut random), vector(&mut random));
        let places = round % 3;
        let mut face = |flip: bool| {
            let mut corner = |i: i64, j: i64| {
                let (i, j) = (i * random.integer(1, 9), j * random.integer(1, 9));
                std::array::from_fn(|k| {
                    let value = o[k] + i * u[k] + j * v[k];
                    Decimal::parse(format!("{value}e-{places}").as_bytes()).expect("a number")
                })
            };
            let (first, last) = (corner(1, 0), corner(0, 1));
            let middle: Point = corner(0, 0);
            if flip { half_space(&[last, middle, first]) } else { half_space(&[first, middle, last]) }
        };
        let (one, two, back) = (face(false), face(false), face(true));
        let (Ok(one), Ok(two), Ok(back)) = (one, two, back) else {
            assert!(one.is_err() && two.is_err() && back.is_err(), "{o:?} {u:?} {v:?}");
            continue;
        };
        assert_eq!(bits(&one), bits(&two), "{o:?} {u:?} {v:?}");
        let n = one.normal();
        let mirrored = [n.x, n.y, n.z, one.offset()].map(|c| if c == 0.0 { 0.0 } else { -c });
        assert_eq!(bits(&back), mirrored.map(f64::to_bits), "{o:?} {u:?} {v:?}");
    }
}
