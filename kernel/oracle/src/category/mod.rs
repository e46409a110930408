//! The kinds of scripts; each leans toward one way to go wrong.

mod robustness;

use crate::exact::Coefficients;
use crate::generators::{
    Ring, container, copy_of, cube, dot, fibonacci, flipped, generic, grid, mixed_exponents, near_parallel, plane,
    prism_side, solids::range_end, thin, through,
};
use crate::random::Rng;
use crate::script::{Op, Writer, map_planes};

/// A kind of script.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Category {
    /// No symmetry, no coincidence.
    Generic,
    /// Tangent to a sphere at the points of a spiral.
    Sphere,
    /// Small integers.
    Grid,
    /// All normals in one plane, sometimes with caps.
    Prism,
    /// Most planes through one point.
    Concurrent,
    /// Slabs without thickness, touching sets.
    Thin,
    /// Copies, scaled copies and opposites of a few planes.
    Duplicates,
    /// Planes that cut everything away come and go.
    EmptyAndBack,
    /// Normals in one half-space.
    Unbounded,
    /// A container first, layers inside it, then one plane after the other is taken away.
    Peel,
    /// Normals that differ by 1e-2 to 1e-15.
    NearParallel,
    /// Large faces, pyramid bases and roofs, removed and put back; up to 300 sides.
    Wedge,
    /// Another kind, 1e2 to 1e12 away from the origin.
    FarShifted,
    /// Each coefficient with an exponent of its own.
    MixedExponents,
    /// Another kind, each plane times a power of two of its own.
    Rescaled,
    /// Tangent to the unit sphere in random points.
    Tangent,
    /// Tangent planes, and planes that lie outside, repeat or only just miss them.
    TangentWithRedundant,
    /// Fifty random additions and removals.
    Random,
    /// Fifty random additions and removals inside a box.
    RandomInBox,
    /// A box first, planes inside it, which are then taken away.
    BoxFirst,
    /// Planes, then a box around them, then the inner planes are taken away.
    BoxLast,
    /// Platonic solids with their duals.
    Platonic,
    /// Prisms, pyramids and frusta of 3 to 300 sides.
    Sides,
    /// Unbounded, then bounded, then unbounded again.
    BoundedAndBack,
    /// Sizes from 1e-6 to 1e6, one for all planes or each its own.
    Scales,
    /// Coefficients at the ends of the accepted range.
    RangeEnds,
}

/// One `#[test]` per category, each calling `run(category)`.
#[macro_export]
macro_rules! test_each_category {
    ($run:path) => {
        $crate::test_each_category! { $run;
            generic Generic, sphere Sphere, grid Grid, prism Prism, concurrent Concurrent, thin Thin,
            duplicates Duplicates, empty_and_back EmptyAndBack, unbounded Unbounded, peel Peel,
            near_parallel NearParallel, wedge Wedge, far_shifted FarShifted, mixed_exponents MixedExponents,
            rescaled Rescaled, tangent Tangent, tangent_with_redundant TangentWithRedundant, random Random, random_in_box RandomInBox, box_first BoxFirst, box_last BoxLast, platonic Platonic, sides Sides, bounded_and_back BoundedAndBack, scales Scales, range_ends RangeEnds
        }
    };
    ($run:path; $($name:ident $category:ident),*) => {
        $(#[test] fn $name() { $run($crate::category::Category::$category); })*
    };
}

impl Category {
    /// All of them.
    pub const ALL: [Self; 26] = [
        Self::Generic,
        Self::Sphere,
        Self::Grid,
        Self::Prism,
        Self::Concurrent,
        Self::Thin,
        Self::Duplicates,
        Self::EmptyAndBack,
        Self::Unbounded,
        Self::Peel,
        Self::NearParallel,
        Self::Wedge,
        Self::FarShifted,
        Self::MixedExponents,
        Self::Rescaled,
        Self::Tangent,
        Self::TangentWithRedundant,
        Self::Random,
        Self::RandomInBox,
        Self::BoxFirst,
        Self::BoxLast,
        Self::Platonic,
        Self::Sides,
        Self::BoundedAndBack,
        Self::Scales,
        Self::RangeEnds,
    ];

    /// The situations in which dynamic convex polyhedra are known to go wrong, each with the kind that covers it.
    pub const ROBUSTNESS: [(&'static str, Self); 18] = [
        ("tangent planes", Self::Tangent),
        ("tangent with redundant planes", Self::TangentWithRedundant),
        ("random, 50 operations", Self::Random),
        ("random, 50 operations in a box", Self::RandomInBox),
        ("outer box first, then peeled", Self::BoxFirst),
        ("outer box last, then peeled", Self::BoxLast),
        ("grid planes", Self::Grid),
        ("Platonic solids and duals", Self::Platonic),
        ("prisms and pyramids of 3 to 300 sides", Self::Sides),
        ("unbounded", Self::Unbounded),
        ("unbounded, bounded and back", Self::BoundedAndBack),
        ("duplicates and scaled duplicates", Self::Duplicates),
        ("empty and back", Self::EmptyAndBack),
        ("near-parallel, 1e-2 to 1e-15", Self::NearParallel),
        ("scales 1e-6 to 1e6 and mixed", Self::Scales),
        ("shifted up to 1e8", Self::FarShifted),
        ("ends of the accepted range", Self::RangeEnds),
        ("each plane rescaled by a power of two", Self::Rescaled),
    ];

    /// Whether scripts of this kind have planes without a face: tangent planes in general position never do.
    #[must_use]
    pub fn hides_planes(self) -> bool {
        self != Self::Tangent
    }

    /// A script with at most `capacity` planes at one time.
    #[must_use]
    pub fn script(self, rng: &mut Rng, capacity: usize) -> Vec<Op> {
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
                let width = 10f64.powi(-writer.rng.integer(2, 15) as i32);
                free(&mut writer, steps, 0.7, |rng| near_parallel(rng, width));
            }
            Self::Wedge => wedge(&mut writer, steps),
            Self::FarShifted => far_shifted(&mut writer, steps),
            Self::MixedExponents => free(&mut writer, steps, 0.8, mixed_exponents),
            Self::Tangent => free(&mut writer, steps, 0.0, robustness::tangent),
            Self::TangentWithRedundant => robustness::tangent_with_redundant(&mut writer, steps),
            Self::Random => robustness::random(&mut writer, false),
            Self::RandomInBox => robustness::random(&mut writer, true),
            Self::BoxFirst => robustness::box_peel(&mut writer, true),
            Self::BoxLast => robustness::box_peel(&mut writer, false),
            Self::Platonic => robustness::platonic(&mut writer, steps),
            Self::Sides => robustness::sides(&mut writer),
            Self::BoundedAndBack => robustness::bounded_and_back(&mut writer),
            Self::Scales => robustness::scales(&mut writer, steps),
            Self::RangeEnds => free(&mut writer, steps, 0.3, range_end),
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
    let distance = writer.rng.pick(&[1e2, 1e4, 1e6, 1e8, 1e12]);
    let centre = writer.rng.direction().map(|v| (v * distance).round());
    free(writer, steps, 0.6, |rng| if whole { grid(rng, 2) } else { generic(rng) });
    writer.map_planes(|c| plane([c[0], c[1], c[2]], c[3] + dot([c[0], c[1], c[2]], centre)));
}

/// Another kind, each plane times a power of two of its own: nothing may change.
fn rescaled(rng: &mut Rng, capacity: usize) -> Vec<Op> {
    let kind = rng.pick(&[Category::Grid, Category::Concurrent, Category::Duplicates, Category::Wedge]);
    let mut ops = kind.script(rng, capacity);
    map_planes(&mut ops, |plane| {
        let factor = 2f64.powi(rng.integer(-300, 300) as i32);
        plane.map(|v| v * factor)
    });
    ops
}
