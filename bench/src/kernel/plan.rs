//! Which cases are run, on which inputs, and how much of each makes one sample.

use crate::case::{self, Order, Sampler};
use crate::{batch, hulls, queries, rings, verify, voronoi};
use planecut_bench::inputs::{fibonacci_sphere, pyramid};
use planecut_bench::library::{Library, Planecut, PolySurge};

/// Removing one plane in place, anywhere.
pub(crate) const REMOVE: &str = "remove in place";
/// Removing one plane in place, near the last one.
pub(crate) const REMOVE_NEAR: &str = "remove in place, near the last";
/// Adding one plane again, near the last one.
pub(crate) const ADD: &str = "add in place, near the last";
/// Adding one plane again, anywhere.
pub(crate) const ADD_FAR: &str = "add in place, far from the last";
/// Removing one plane and adding it again, in place, at once.
pub(crate) const REMOVE_ADD: &str = "remove + re-add in place";
/// Cloning and removing one plane from the clone.
pub(crate) const CLONE_REMOVE: &str = "clone + remove";
/// Building from nothing.
pub(crate) const BUILD: &str = "build";
/// Removing the base of a pyramid.
pub(crate) const PYRAMID_BASE: &str = "remove pyramid base";

/// The operations of the main table, in its order.
pub(crate) const OPERATIONS: [&str; 8] =
    [REMOVE, REMOVE_NEAR, ADD, ADD_FAR, REMOVE_ADD, CLONE_REMOVE, BUILD, PYRAMID_BASE];

/// The numbers of planes of the spheres.
const SIZES: [usize; 4] = [30, 200, 10_000, 100_000];
/// The sides of the pyramid.
pub(crate) const PYRAMID_SIDES: usize = 200;
/// The largest sphere that `poly_surge` builds in bearable time: its build time grows nearly with the
/// cube of the planes.
const LARGEST_FOR_POLY_SURGE: usize = 200;

/// One or more lines of the report.
pub(crate) struct Case {
    /// What is done, in the same words for every library; as many as the sampler gives times.
    pub(crate) operations: Vec<String>,
    /// The number of planes of the sphere, of sides of the pyramid, or of cuts.
    pub(crate) size: usize,
    /// Who does it.
    pub(crate) library: &'static str,
    /// Gives one sample.
    pub(crate) sampler: Sampler,
}

impl Case {
    /// A case of one operation.
    pub(crate) fn new(operation: &str, size: usize, library: &'static str, sampler: Sampler) -> Self {
        Self { operations: vec![operation.to_owned()], size, library, sampler }
    }
}

/// How many operations of each kind make one sample: enough that reading the clock does not count and planes from all over
/// the polytope take part, few enough that the clones of one batch stay in the cache.
struct Batches {
    copies: usize,
    in_place: usize,
    clone_remove: usize,
    build: usize,
}

/// Checks all results, then prepares all cases. Cases to be compared stand next to each other.
///
/// # Errors
/// The first result that is wrong or differs between the libraries.
pub(crate) fn prepare(quick: bool, voronoi: &[voronoi::Set]) -> Result<Vec<Case>, String> {
    let mut cases = Vec::new();
    for size in SIZES {
        let batches = match size {
            ..100 => Batches { copies: 16, in_place: 3000, clone_remove: 60, build: 30 },
            100..1000 => Batches { copies: 4, in_place: 3000, clone_remove: 12, build: 5 },
            1000..50_000 => Batches { copies: 1, in_place: 10_000, clone_remove: 1, build: 1 },
            _ => Batches { copies: 1, in_place: 20_000, clone_remove: 1, build: 1 },
        };
        // Counting the vertices of a large polytope takes far longer than the removal.
        let removals = if size <= 200 { size } else { 4 };
        sphere::<Planecut>(size, &batches, removals, &mut cases)?;
        if size <= LARGEST_FOR_POLY_SURGE {
            let batches = match size {
                ..100 => Batches { copies: 4, in_place: 30, clone_remove: 60, build: 3 },
                _ => Batches { copies: 1, in_place: 50, clone_remove: 12, build: 1 },
            };
            sphere::<PolySurge>(size, &batches, removals, &mut cases)?;
        }
    }
    let planes = pyramid(PYRAMID_SIDES);
    verify::same_around_removal::<Planecut, PolySurge>(&planes)?;
    let ours = case::remove_first::<Planecut>(&planes, 5);
    cases.push(Case::new(PYRAMID_BASE, PYRAMID_SIDES, Planecut::NAME, ours));
    let theirs = case::remove_first::<PolySurge>(&planes, 1);
    cases.push(Case::new(PYRAMID_BASE, PYRAMID_SIDES, PolySurge::NAME, theirs));
    cases.sort_by_key(|case| (OPERATIONS.iter().position(|o| *o == case.operations[0]), case.size));
    cases.extend(voronoi::cases(voronoi)?);
    cases.extend(batch::cases(quick)?);
    cases.extend(rings::cases(quick));
    cases.extend(queries::cases(quick)?);
    cases.extend(hulls::cases(quick)?);
    Ok(cases)
}

fn sphere<L: Library>(size: usize, batches: &Batches, removals: usize, cases: &mut Vec<Case>) -> Result<(), String> {
    let planes = fibonacci_sphere(size);
    verify::simple_polytope::<L>(&planes, removals)?;
    for (operations, order) in [([REMOVE, ADD_FAR], Order::Scattered), ([REMOVE_NEAR, ADD], Order::Path)] {
        let operations = operations.map(str::to_owned).to_vec();
        let sampler = case::remove_then_add::<L>(&planes, batches.copies, order);
        cases.push(Case { operations, size, library: L::NAME, sampler });
    }
    let mut push = |operation, sampler| cases.push(Case::new(operation, size, L::NAME, sampler));
    push(REMOVE_ADD, case::remove_and_add::<L>(&planes, batches.in_place));
    push(CLONE_REMOVE, case::clone_and_remove::<L>(&planes, batches.clone_remove));
    push(BUILD, case::build::<L>(&planes, batches.build));
    Ok(())
}
