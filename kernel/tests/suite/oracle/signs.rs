//! The signs against determinants of big integers.

use planecut_kernel::sign::{Row, Sign, cross_component, orient3, orient4};
use planecut_oracle::exact::{Coefficients, cross, det3, det4, integer_row, normal, sign};
use planecut_oracle::kernel_calls::half_space;
use planecut_oracle::random::Rng;
use planecut_oracle::settings::first_seed;

/// Draws per family of inputs; each draw asks about forty signs.
const DRAWS: usize = 1_000;

type Family = (&'static str, fn(&mut Rng) -> [Coefficients; 4]);

/// Every family, with the names a failure is reported under.
const FAMILIES: [Family; 16] = [
    ("uniform floats", uniform),
    ("small grid", |rng| grid(rng, 3)),
    ("grid of 2^20", |rng| grid(rng, 1 << 20)),
    ("grid of 2^31", |rng| grid(rng, 1 << 31)),
    ("grid of 2^53", |rng| grid(rng, 1 << 53)),
    ("sparse", sparse),
    ("dyadic", dyadic),
    ("near a common point", near_point),
    ("near a common line", near_line),
    ("dependent integers", dependent),
    ("dependent but for one unit", almost_dependent),
    ("dependent integers of 40 bits and more", long_dependent),
    ("scaled copies", scaled_copies),
    ("near-parallel", near_parallel),
    ("far shifted", far_shifted),
    ("mixed exponents", mixed_exponents),
];

#[test]
fn agree_with_big_integers_in_every_order() {
    let (mut asked, mut zeros) = (0, 0);
    for (k, (name, draw)) in FAMILIES.iter().enumerate() {
        let seed = first_seed() + k as u64;
        let mut rng = Rng::new(seed);
        let mut seen = [0usize; 3];
        for _ in 0..DRAWS {
            let planes = draw(&mut rng);
            check_all_orders(&planes, &mut seen).unwrap_or_else(|e| panic!("{name}, seed {seed:#x}: {e}\n{planes:?}"));
        }
        println!("{name}: {seen:?} negative, zero, positive");
        assert!(seen[0] > 0 && seen[2] > 0, "{name} never saw both signs");
        asked += seen.iter().sum::<usize>();
        zeros += seen[1];
    }
    assert!(asked >= 200_000 && zeros >= asked / 20, "only {asked} signs, {zeros} zeros");
}

#[test]
fn a_repeated_row_gives_zero() {
    let mut rng = Rng::new(first_seed());
    for (_, draw) in FAMILIES {
        let [a, b, c, _] = draw(&mut rng).map(|p| Row::new(&half_space(p)));
        for rows in [[&a, &a, &b, &c], [&a, &b, &a, &c], [&b, &c, &a, &a]] {
            assert_eq!(orient4(rows[0], rows[1], rows[2], rows[3]), Sign::Zero);
        }
        assert_eq!(orient3(&a, &b, &a), Sign::Zero);
        assert!((0..3).all(|axis| cross_component(&a, &a, axis) == Sign::Zero));
    }
}

/// Compares all orders of the four planes; `seen` counts the signs by value.
fn check_all_orders(planes: &[Coefficients; 4], seen: &mut [usize; 3]) -> Result<(), String> {
    let rows = planes.map(|p| Row::new(&half_space(p)));
    let exact = planes.map(integer_row);
    let normals = [0, 1, 2, 3].map(|i| normal(&exact[i]));
    let four = sign(&det4([&exact[0], &exact[1], &exact[2], &exact[3]]));
    let mut compare = |what: &str, order: [usize; 4], got: Sign, want: i32| {
        seen[(want + 1) as usize] += 1;
        if value(got) == want { Ok(()) } else { Err(format!("{what}{order:?} is {got:?}, exactly {want}")) }
    };
    for (order, parity) in permutations() {
        let [i, j, k, l] = order;
        compare("orient4", order, orient4(&rows[i], &rows[j], &rows[k], &rows[l]), four * parity)?;
        // The three-row signs do not change with `l`: half of the 24 orders cover all of them.
        if k < l {
            let three = sign(&det3(&normals[i], &normals[j], &normals[k]));
            compare("orient3", order, orient3(&rows[i], &rows[j], &rows[k]), three)?;
            let meet = cross(&normals[k], &normals[l]);
            for (axis, component) in meet.iter().enumerate() {
                let found = cross_component(&rows[k], &rows[l], axis);
                compare("cross_component", [k, l, axis, 0], found, sign(component))?;
            }
        }
    }
    Ok(())
}

fn value(sign: Sign) -> i32 {
    match sign {
        Sign::Negative => -1,
        Sign::Zero => 0,
        Sign::Positive => 1,
    }
}

/// The 24 orders of four things with their parity.
fn permutations() -> impl Iterator<Item = ([usize; 4], i32)> {
    (0..256).filter_map(|code| {
        let order = [code & 3, code >> 2 & 3, code >> 4 & 3, code >> 6];
        let pairs = || (0..4).flat_map(|i| (0..i).map(move |j| (j, i)));
        if pairs().any(|(j, i)| order[j] == order[i]) {
            return None;
        }
        let inversions = pairs().filter(|&(j, i)| order[j] > order[i]).count();
        Some((order, if inversions % 2 == 0 { 1 } else { -1 }))
    })
}

fn four(mut draw: impl FnMut() -> Coefficients) -> [Coefficients; 4] {
    std::array::from_fn(|_| draw())
}

fn with_offset(n: [f64; 3], d: f64) -> Coefficients {
    [n[0], n[1], n[2], d]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn uniform(rng: &mut Rng) -> [Coefficients; 4] {
    four(|| with_offset(rng.direction(), rng.float(-1.0, 1.0)))
}

fn grid(rng: &mut Rng, reach: i64) -> [Coefficients; 4] {
    four(|| with_offset(rng.lattice(reach), rng.whole(-reach, reach)))
}

/// Axis-aligned and diagonal planes: most coefficients are (either) zero.
fn sparse(rng: &mut Rng) -> [Coefficients; 4] {
    four(|| {
        let mut c = [rng.pick(&[0.0, -0.0]); 4];
        c[rng.below(3)] = rng.float(-2.0, 2.0);
        if rng.chance(0.3) {
            c[rng.below(3)] = rng.pick(&[1.0, -1.0, 0.1]);
        }
        if rng.chance(0.8) {
            c[3] = rng.float(-1.0, 1.0);
        }
        c
    })
}

fn dyadic(rng: &mut Rng) -> [Coefficients; 4] {
    four(|| with_offset(rng.lattice(4096), rng.whole(-4096, 4096)).map(|v| v / 1024.0))
}

/// Planes through one point up to a few units in the last place.
fn near_point(rng: &mut Rng) -> [Coefficients; 4] {
    let point = rng.direction().map(|v| v * 10.0);
    let reach = rng.pick(&[0, 1, 3, 1000]);
    four(|| {
        let n = rng.direction();
        with_offset(n, rng.nudge(dot(n, point), reach))
    })
}

/// Planes through one line, hence normals in one plane, up to a few units in the last place.
fn near_line(rng: &mut Rng) -> [Coefficients; 4] {
    let (a, b) = (rng.direction(), rng.direction());
    let (da, db) = (rng.float(-1.0, 1.0), rng.float(-1.0, 1.0));
    let reach = rng.pick(&[0, 1, 10]);
    four(|| {
        let (s, t) = (rng.float(-1.0, 1.0), rng.float(-1.0, 1.0));
        let n: [f64; 3] = std::array::from_fn(|i| s * a[i] + t * b[i]);
        with_offset(n.map(|v| rng.nudge(v, reach)), rng.nudge(s * da + t * db, reach))
    })
}

/// Integer combinations of two or three integer rows: exact zeros far beyond what a float filter can see.
fn dependent(rng: &mut Rng) -> [Coefficients; 4] {
    let reach = rng.pick(&[4i64, 1 << 20, 1 << 45]);
    let mut rows = grid(rng, reach);
    let basis = rng.pick(&[2, 3]);
    for k in basis..4 {
        rows[k] = loop {
            let factor: [f64; 3] = std::array::from_fn(|i| if i < basis { rng.whole(-20, 20) } else { 0.0 });
            let row: Coefficients = std::array::from_fn(|c| (0..3).map(|i| factor[i] * rows[i][c]).sum());
            if row[..3] != [0.0; 3] {
                break row;
            }
        };
    }
    rng.shuffle(&mut rows);
    rows
}

fn almost_dependent(rng: &mut Rng) -> [Coefficients; 4] {
    let mut rows = dependent(rng);
    let (row, column) = (rng.below(4), rng.below(4));
    let moved = rows[row][column] + rng.pick(&[1.0, -1.0]);
    let stays_a_plane = column == 3 || moved != 0.0;
    if stays_a_plane {
        rows[row][column] = moved;
    }
    rows
}

/// Sums of long integer rows, some of them off by one: where the integers of a determinant fit 128 bits only just, or not.
fn long_dependent(rng: &mut Rng) -> [Coefficients; 4] {
    let bits = rng.integer(38, 46);
    let mut rows = grid(rng, 1 << bits);
    for k in 2..4 {
        let factors = [rng.pick(&[1.0, -1.0]), rng.pick(&[1.0, -1.0]), rng.pick(&[0.0, 1.0])];
        let sum: Coefficients = std::array::from_fn(|c| (0..k).map(|i| factors[i] * rows[i][c]).sum());
        let moved = sum.map(|v| v + if rng.chance(0.1) { 1.0 } else { 0.0 });
        if moved[..3] != [0.0; 3] {
            rows[k] = moved;
        }
    }
    rng.shuffle(&mut rows);
    rows
}

fn scaled_copies(rng: &mut Rng) -> [Coefficients; 4] {
    let originals = if rng.chance(0.5) { uniform(rng) } else { grid(rng, 9) };
    four(|| {
        let factor = rng.pick(&[1.0, -1.0, 0.5, 2.0, 1024.0, 3.0, 0.1, -7.0]);
        originals[rng.below(3)].map(|v| v * factor)
    })
}

fn near_parallel(rng: &mut Rng) -> [Coefficients; 4] {
    let n = rng.direction();
    let width = rng.pick(&[1e-6, 1e-10, 1e-14]);
    four(|| {
        let other = rng.direction();
        with_offset(std::array::from_fn(|i| n[i] + width * other[i]), 1.0 + width * rng.float(-1.0, 1.0))
    })
}

/// Planes around a centre far from the origin: the offsets carry all the weight.
fn far_shifted(rng: &mut Rng) -> [Coefficients; 4] {
    let distance = rng.pick(&[1e8, 1e12, 1e16]);
    let centre = rng.direction().map(|v| (v * distance).round());
    let on_grid = rng.chance(0.5);
    four(|| {
        let n = if on_grid { rng.lattice(5) } else { rng.direction() };
        let d = if on_grid { rng.whole(-3, 3) } else { rng.float(-1.0, 1.0) };
        with_offset(n, d + dot(n, centre))
    })
}

/// Coefficients from all over the accepted range, its corners included.
fn mixed_exponents(rng: &mut Rng) -> [Coefficients; 4] {
    let power = |e: i64| 2f64.powi(e as i32);
    four(|| {
        let scale = rng.pick(&[-399, 0, 399]);
        let mut exponent = |low: i64, high: i64| {
            let any = rng.integer(low, high);
            rng.pick(&[low, high, any])
        };
        let down: [i64; 4] = std::array::from_fn(|i| if i < 3 { exponent(-199, 0) } else { exponent(-198, 198) });
        let largest = rng.below(3);
        std::array::from_fn(|i| {
            let shift = if i == largest { 0 } else { down[i] };
            let mantissa = if rng.chance(0.5) { rng.float(1.0, 2.0) } else { 1.0 };
            rng.pick(&[1.0, -1.0]) * mantissa * power(scale + shift)
        })
    })
}
