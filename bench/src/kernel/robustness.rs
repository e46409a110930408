//! Wrong answers: the scripts of the kernel's oracle, run on both libraries, every answer compared with the exact truth.
//!
//! What counts against a library is really wrong, not a matter of its tolerance: see [`clear_tolerance`].

use crate::contestant::{Answer, Contestant, Ours, Theirs};
use planecut_bench::inputs::{Plane, dot};
use planecut_oracle::category::Category;
use planecut_oracle::outline::Outline;
use planecut_oracle::random::Rng;
use planecut_oracle::script::{Op, as_adds_and_removes};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Planes at one time: few, because the truth looks at all triples of them, and `poly_surge` takes seconds for some
/// removals among hundreds.
const CAPACITY: usize = 11;
/// Where a container comes first or last and inner planes hide it: it takes more planes to hide all of it.
const PEEL_CAPACITY: usize = 24;
/// A hundred times the tolerance of `poly_surge`; absolute, as its own is.
const TOLERANCE: f64 = 1e-5;
/// For coordinates far from the origin, where `f64` itself is coarser than that.
const RELATIVE_TOLERANCE: f64 = 1e-12;
/// What must hold clearly holds by this many tolerances.
const MARGIN: f64 = 10.0;
/// Three unit normals with a smaller determinant do not fix a vertex well.
const LEAST_DETERMINANT: f64 = 1e-3;
/// Normals at a smaller angle that are not parallel may be taken for parallel.
const LEAST_ANGLE: f64 = 1e-4;

/// In what a library was wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Fault {
    Panic,
    Emptiness,
    Boundedness,
    Vertices,
}

impl Fault {
    pub(crate) const ALL: [Self; 4] = [Self::Panic, Self::Emptiness, Self::Boundedness, Self::Vertices];
}

/// The result of one script.
struct Outcome {
    /// The first faults of planecut and `poly_surge`.
    faults: [Option<Fault>; 2],
    compared: usize,
    too_close: usize,
}

/// The results of one category.
#[derive(Debug, Clone)]
pub(crate) struct Tally {
    pub(crate) category: String,
    pub(crate) cases: usize,
    /// Cases that went wrong, by [`Fault::ALL`], of planecut and `poly_surge`.
    pub(crate) faults: [[usize; 4]; 2],
    /// States that were compared.
    pub(crate) compared: usize,
    /// States that were not, because something in them is about as small as the tolerance.
    pub(crate) too_close: usize,
    /// The first seed that went wrong for planecut.
    pub(crate) our_first: Option<u64>,
}

impl Tally {
    /// How many cases went wrong for planecut and for `poly_surge`.
    pub(crate) fn failures(&self) -> [usize; 2] {
        self.faults.map(|faults| faults.iter().sum())
    }
}

/// Runs `cases` scripts of every category on all processors.
pub(crate) fn run(cases: usize) -> Vec<Tally> {
    // Panics are counted, not printed.
    let hook = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| {}));
    let tallies = Category::ALL.iter().enumerate().map(|(k, category)| tally(*category, k as u64, cases)).collect();
    std::panic::set_hook(hook);
    tallies
}

fn tally(category: Category, number: u64, cases: usize) -> Tally {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let seeds = |thread: usize| (thread..cases).step_by(threads).map(move |k| (number << 32) + k as u64);
    let outcomes: Vec<(u64, Outcome)> = std::thread::scope(|scope| {
        let worker = |thread| scope.spawn(move || seeds(thread).map(|s| (s, outcome(category, s))).collect::<Vec<_>>());
        let workers: Vec<_> = (0..threads).map(worker).collect();
        workers.into_iter().flat_map(|worker| worker.join().expect("faults are caught inside")).collect()
    });
    let count = |library: usize, fault: Fault| {
        outcomes.iter().filter(|(_, outcome)| outcome.faults[library] == Some(fault)).count()
    };
    Tally {
        category: format!("{category:?}"),
        cases,
        faults: [0, 1].map(|library| Fault::ALL.map(|fault| count(library, fault))),
        compared: outcomes.iter().map(|(_, outcome)| outcome.compared).sum(),
        too_close: outcomes.iter().map(|(_, outcome)| outcome.too_close).sum(),
        our_first: outcomes.iter().filter(|(_, o)| o.faults[0].is_some()).map(|(seed, _)| *seed).min(),
    }
}

/// Runs one script; a library that was wrong does not go on.
fn outcome(category: Category, seed: u64) -> Outcome {
    let capacity = match category {
        Category::Peel | Category::BoxFirst | Category::BoxLast => PEEL_CAPACITY,
        _ => CAPACITY,
    };
    let ops = as_adds_and_removes(&category.script(&mut Rng::new(seed), capacity));
    let (mut ours, mut theirs) = (Runner::<Ours>::start(), Runner::<Theirs>::start());
    let mut live: Vec<(usize, [f64; 4])> = Vec::new();
    let (mut compared, mut too_close) = (0, 0);
    for op in &ops {
        match op {
            Op::Add { name, plane } => live.push((*name, *plane)),
            Op::Remove { name } => live.retain(|(other, _)| other != name),
            _ => unreachable!("the script has single additions and removals only"),
        }
        ours.apply(op);
        theirs.apply(op);
        if ours.fault.is_some() && theirs.fault.is_some() {
            break;
        }
        let planes: Vec<[f64; 4]> = live.iter().map(|(_, plane)| *plane).collect();
        let truth = Outline::of(&planes);
        let Some(tolerance) = clear_tolerance(&planes, &truth) else {
            too_close += 1;
            continue;
        };
        compared += 1;
        ours.compare(&truth, tolerance);
        theirs.compare(&truth, tolerance);
    }
    Outcome { faults: [ours.fault, theirs.fault], compared, too_close }
}

/// A library in a script, until its first fault.
struct Runner<C> {
    contestant: C,
    fault: Option<Fault>,
}

impl<C: Contestant> Runner<C> {
    fn start() -> Self {
        Self { contestant: C::start(), fault: None }
    }

    fn apply(&mut self, op: &Op) {
        self.guarded(|contestant| {
            match op {
                Op::Add { name, plane: [x, y, z, offset] } => {
                    contestant.add(*name, &Plane { normal: [*x, *y, *z], offset: *offset });
                }
                Op::Remove { name } => contestant.remove(*name),
                _ => {}
            }
            None
        });
    }

    fn compare(&mut self, truth: &Outline, tolerance: f64) {
        self.guarded(|contestant| difference(&contestant.answer(), truth, tolerance));
    }

    fn guarded(&mut self, step: impl FnOnce(&mut C) -> Option<Fault>) {
        if self.fault.is_none() {
            let contestant = &mut self.contestant;
            self.fault = catch_unwind(AssertUnwindSafe(|| step(contestant))).unwrap_or(Some(Fault::Panic));
        }
    }
}

/// In what an answer differs from the truth: vertices may be there several times, and are compared within the tolerance.
fn difference(answer: &Answer, truth: &Outline, tolerance: f64) -> Option<Fault> {
    if truth.empty {
        let wrong = answer.empty == Some(false) || !answer.vertices.is_empty();
        return wrong.then_some(Fault::Emptiness);
    }
    if answer.empty == Some(true) {
        return Some(Fault::Emptiness);
    }
    let near = |a: &[f64; 3], b: &[f64; 3]| distance(a, b) <= tolerance;
    let is_missing = truth.vertices.iter().any(|v| !answer.vertices.iter().any(|w| near(&v.position, w)));
    let is_spurious = answer.vertices.iter().any(|w| !truth.vertices.iter().any(|v| near(&v.position, w)));
    if is_missing || is_spurious {
        return Some(Fault::Vertices);
    }
    (answer.bounded != truth.bounded).then_some(Fault::Boundedness)
}

/// The tolerance within which vertices are compared; `None` where a library with a tolerance may rightly see another set.
///
/// A set is clear if it is empty even with every plane moved outward by [`MARGIN`] tolerances; or if no plane comes that
/// near to a vertex without going through it, no two vertices are that near to each other, the planes through each vertex
/// fix it well, and no two normals are nearly but not exactly parallel.
fn clear_tolerance(planes: &[[f64; 4]], truth: &Outline) -> Option<f64> {
    let unit: Vec<Plane> = planes.iter().map(unit).collect();
    let coordinates = truth.vertices.iter().flat_map(|v| v.position).chain(unit.iter().map(|p| p.offset));
    let scale = coordinates.fold(0.0, |m: f64, v| m.max(v.abs()));
    let tolerance = TOLERANCE + RELATIVE_TOLERANCE * scale;
    let margin = MARGIN * tolerance;
    let clear = if truth.empty {
        let moved = unit.iter().map(|p| [p.normal[0], p.normal[1], p.normal[2], p.offset + margin]);
        Outline::of(&moved.collect::<Vec<_>>()).empty
    } else {
        !has_nearly_parallel(&unit) && vertices_are_clear(&unit, truth, margin)
    };
    clear.then_some(tolerance)
}

fn vertices_are_clear(unit: &[Plane], truth: &Outline, margin: f64) -> bool {
    truth.vertices.iter().enumerate().all(|(k, vertex)| {
        let is_free = |(i, plane): (usize, &Plane)| {
            vertex.planes.contains(&i) || plane.offset - dot(plane.normal, vertex.position) > margin
        };
        let is_alone = truth.vertices[..k].iter().all(|other| distance(&other.position, &vertex.position) > margin);
        unit.iter().enumerate().all(is_free) && is_alone && is_well_fixed(unit, &vertex.planes)
    })
}

fn is_well_fixed(unit: &[Plane], planes: &[usize]) -> bool {
    let normal = |k: usize| unit[planes[k]].normal;
    let n = planes.len();
    (0..n).any(|i| {
        (i + 1..n).any(|j| (j + 1..n).any(|k| dot(cross(normal(i), normal(j)), normal(k)).abs() > LEAST_DETERMINANT))
    })
}

fn has_nearly_parallel(unit: &[Plane]) -> bool {
    unit.iter().enumerate().any(|(k, a)| {
        unit[..k].iter().any(|b| {
            let across = cross(a.normal, b.normal);
            let sine = dot(across, across).sqrt();
            // Below, it is the rounding of normals that are exactly parallel.
            sine > 4.0 * f64::EPSILON && sine < LEAST_ANGLE
        })
    })
}

fn unit([x, y, z, offset]: &[f64; 4]) -> Plane {
    // First by the largest, so that squares neither over- nor underflow.
    let largest = x.abs().max(y.abs()).max(z.abs());
    let normal = [x / largest, y / largest, z / largest];
    let length = dot(normal, normal).sqrt();
    Plane { normal: normal.map(|v| v / length), offset: offset / largest / length }
}

fn distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    let apart: [f64; 3] = std::array::from_fn(|k| a[k] - b[k]);
    dot(apart, apart).sqrt()
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
