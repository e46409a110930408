//! The kinds of scripts; each leans toward one way to go wrong.

use crate::exact::Coefficients;
use crate::generators::{
    Ring, container, copy_of, cube, dot, fibonacci, flipped, generic, grid, mixed_exponents, near_parallel, plane,
    prism_side, thin, through,
};
use crate::random::Rng;
use crate::script::{Op, Writer};

/// A kind of script.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Category {
    Generic,
    Sphere,
    Grid,
    Prism,
    Concurrent,
    Thin,
    Duplicates,
    EmptyAndBack,
    Unbounded,
    Peel,
    NearParallel,
    Wedge,
    FarShifted,
    MixedExponents,
    Rescaled,
}

/// One `#[test]` per category, each calling `run(category)`.
macro_rules! test_each_category {
    ($run:path) => {
        $crate::category::test_each_category! { $run;
            generic Generic, sphere Sphere, grid Grid, prism Prism, concurrent Concurrent, thin Thin,
            duplicates Duplicates, empty_and_back EmptyAndBack, unbounded Unbounded, peel Peel,
            near_parallel NearParallel, wedge Wedge, far_shifted FarShifted, mixed_exponents MixedExponents,
            rescaled Rescaled
        }
    };
    ($run:path; $($name:ident $category:ident),*) => {
        $(#[test] fn $name() { $run($crate::category::Category::$category); })*
    };
}
pub(crate) use test_each_category;

impl Category {
    /// A script with at most `capacity` planes at one time.
    pub(crate) fn script(self, rng: &mut Rng, capacity: usize) -> Vec<Op> {
        let steps = rng.integer(10, 60) as usize;
        let mut writer = Writer::new(rng, capacity);
        match self {
            Self::Generic => free(&mut writer, steps, 0.5, generic),
            Self::Grid => {
                let reach = writer.rng.integer(1, 3);
                free(&mut writer, steps, 0.3, |rng| grid(rng, reach));
            }
            Self::Prism => prism(&mut writer, steps),
            Self::Concurrent => concurrent(&mut writer, steps),
            Self::Thin => free(&mut writer, steps, 0.5, thin),
            Self::Duplicates => duplicates(&mut writer, steps),
            Self::EmptyAndBack => empty_and_back(&mut writer, steps),
            Self::Unbounded => unbounded(&mut writer, steps),
            Self::Sphere => sphere(&mut writer, steps),
            Self::Peel => peel(&mut writer),
            Self::NearParallel => {
                let width = writer.rng.pick(&[1e-3, 1e-9, 1e-13, 1e-15]);
                free(&mut writer, steps, 0.7, |rng| near_parallel(rng, width));
            }
            Self::Wedge => wedge(&mut writer, steps),
            Self::FarShifted => far_shifted(&mut writer, steps),
            Self::MixedExponents => free(&mut writer, steps, 0.8, mixed_exponents),
            Self::Rescaled => return rescaled(rng, capacity),
        }
        writer.finish()
    }
}

/// A start inside a container with probability `boxed`, then random operations.
fn free(writer: &mut Writer, steps: usize, boxed: f64, source: impl Fn(&mut Rng) -> Coefficients) {
    if writer.rng.chance(boxed) {
        let half = writer.rng.pick(&[1.0, 2.0, 4.0]);
        let planes = container(writer.rng, writer.capacity, half);
        writer.add_all(&planes);
    }
    let first = writer.rng.below(writer.capacity.max(4));
    for _ in 0..first {
        let plane = source(writer.rng);
        writer.add(plane);
    }
    writer.churn(steps, source);
}

fn prism(writer: &mut Writer, steps: usize) {
    let span = if writer.rng.chance(0.7) { Some([writer.rng.lattice(2), writer.rng.lattice(2)]) } else { None };
    let caps = writer.rng.pick(&[0.0, 0.15]);
    free(writer, steps, 0.2, |rng| if rng.chance(caps) { grid(rng, 2) } else { prism_side(rng, span) });
}

fn concurrent(writer: &mut Writer, steps: usize) {
    let point = writer.rng.lattice(3);
    let axis = writer.rng.lattice(1);
    let others = writer.rng.pick(&[0.0, 0.2]);
    free(writer, steps, 0.5, |rng| if rng.chance(others) { grid(rng, 3) } else { through(rng, point, axis) });
}

fn duplicates(writer: &mut Writer, steps: usize) {
    let whole = writer.rng.chance(0.5);
    let mut pool = cube(writer.rng, 1.0);
    for _ in 0..3 {
        pool.push(if whole { grid(writer.rng, 2) } else { generic(writer.rng) });
    }
    free(writer, steps, 0.5, |rng| copy_of(rng, &pool));
}

/// Planes that cut everything away, or leave a set without interior, come and go.
fn empty_and_back(writer: &mut Writer, steps: usize) {
    let planes = container(writer.rng, writer.capacity, 2.0);
    writer.add_all(&planes);
    writer.churn(steps, |rng| match rng.below(4) {
        0 => plane(rng.direction(), rng.float(-9.0, 0.0)),
        1 => plane(rng.lattice(1), rng.pick(&[-6.0, -4.0, -2.0, 0.0])),
        2 => flipped(rng.pick(&planes)),
        _ => generic(rng),
    });
}

/// Normals in a half-space, or in its closure: never bounded.
fn unbounded(writer: &mut Writer, steps: usize) {
    let up = writer.rng.lattice(1);
    let whole = writer.rng.chance(0.5);
    writer.churn(steps + 10, |rng| {
        let c = if whole { grid(rng, 2) } else { generic(rng) };
        let n = [c[0], c[1], c[2]];
        if dot(n, up) < 0.0 { plane(n.map(|v| -v), c[3]) } else { c }
    });
}

fn sphere(writer: &mut Writer, steps: usize) {
    let n = writer.rng.integer(4, (2 * writer.capacity) as i64) as usize;
    let mut planes: Vec<Coefficients> = (0..n).map(|k| fibonacci(k, n)).collect();
    writer.rng.shuffle(&mut planes);
    writer.add_all(&planes[..n.min(writer.capacity)]);
    for _ in 0..steps / 4 {
        let k = writer.rng.below(writer.live());
        writer.remove_and_re_add(k);
    }
    writer.churn(steps, |rng| fibonacci(rng.below(n), n));
}

/// A container first, layers inside it, then one plane after the other is taken away.
fn peel(writer: &mut Writer) {
    let capacity = writer.capacity;
    let planes = container(writer.rng, capacity, 8.0);
    writer.add_all(&planes);
    let whole = writer.rng.chance(0.3);
    while writer.live() < capacity {
        let radius = writer.rng.pick(&[1.0, 2.0, 4.0]);
        let n = if whole { writer.rng.lattice(1) } else { writer.rng.direction() };
        writer.add(plane(n, radius));
    }
    let container_last = writer.rng.chance(0.7);
    while writer.live() > 0 {
        let inner = writer.live() - planes.len().min(writer.live());
        let k = if container_last && inner > 0 {
            planes.len() + writer.rng.below(inner)
        } else {
            writer.rng.below(writer.live())
        };
        writer.remove(k);
    }
}

/// Large faces, pyramid bases and roofs, removed and put back; what hides behind them shows up.
fn wedge(writer: &mut Writer, steps: usize) {
    let sides = if writer.capacity < 12 {
        writer.rng.integer(3, writer.capacity as i64 - 2)
    } else if writer.rng.chance(0.05) {
        writer.capacity = 310;
        writer.rng.integer(50, 300)
    } else {
        let most = writer.rng.integer(3, 40);
        writer.rng.integer(3, most)
    };
    let ring = Ring {
        sides: sides as usize,
        slope: writer.rng.pick(&[0.0, 0.25, 1.0, -0.5]),
        jitter: writer.rng.pick(&[0.0, 0.0, 0.3]),
        whole: writer.rng.chance(0.3),
    };
    let floor = if writer.rng.chance(0.5) { plane([0.0, 0.0, -1.0], 0.0) } else { plane([0.25, 0.5, -1.0], 1.0) };
    let roof = plane([0.0, 0.0, 1.0], writer.rng.pick(&[0.5, 1.0]));
    let far = plane([0.0, 0.0, -1.0], 7.0);
    let mut planes = ring.planes(writer.rng);
    for extra in [floor, roof, far] {
        if writer.rng.chance(0.7) {
            let at = writer.rng.pick(&[0, planes.len()]);
            planes.insert(at, extra);
        }
    }
    writer.add_all(&planes);
    for _ in 0..writer.rng.integer(1, 4) {
        let ends = [0, writer.live() - 1];
        let any = writer.rng.below(writer.live());
        let k = writer.rng.pick(&[ends[0], ends[1], any]);
        writer.remove_and_re_add(k);
    }
    writer.churn(steps, |rng| match rng.below(4) {
        0 => floor,
        1 => roof,
        2 => far,
        _ => rng.pick(&planes),
    });
}

/// Another kind, moved so far from the origin that the rounding of the offsets shows.
fn far_shifted(writer: &mut Writer, steps: usize) {
    let whole = writer.rng.chance(0.5);
    let distance = writer.rng.pick(&[1e8, 1e12]);
    let centre = writer.rng.direction().map(|v| (v * distance).round());
    free(writer, steps, 0.6, |rng| if whole { grid(rng, 2) } else { generic(rng) });
    writer.map_planes(|c| plane([c[0], c[1], c[2]], c[3] + dot([c[0], c[1], c[2]], centre)));
}

/// Another kind, each plane times a power of two of its own: nothing may change.
fn rescaled(rng: &mut Rng, capacity: usize) -> Vec<Op> {
    let kind = rng.pick(&[Category::Grid, Category::Concurrent, Category::Duplicates, Category::Wedge]);
    let mut ops = kind.script(rng, capacity);
    for op in &mut ops {
        if let Op::Add { plane, .. } = op {
            let factor = 2f64.powi(rng.integer(-300, 300) as i32);
            *plane = plane.map(|v| v * factor);
        }
    }
    ops
}
