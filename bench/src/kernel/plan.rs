//! Which cases are run, on which inputs, and how much of each makes one sample.

use crate::case::{self, Sampler};
use crate::inputs::{fibonacci_sphere, pyramid};
use crate::library::{Library, Planecut, PolySurge};
use crate::verify;

/// Removing one plane and adding it again, in place.
pub(crate) const IN_PLACE: &str = "remove + re-add in place";
/// Cloning and removing one plane from the clone.
pub(crate) const CLONE_REMOVE: &str = "clone + remove";
/// Building from nothing.
pub(crate) const BUILD: &str = "build";
/// Removing the base of a pyramid.
pub(crate) const PYRAMID_BASE: &str = "remove pyramid base";

/// The sides of the pyramid.
pub(crate) const PYRAMID_SIDES: usize = 200;
/// The largest sphere that `poly_surge` builds in bearable time: its build time grows nearly with the
/// cube of the planes.
const LARGEST_FOR_POLY_SURGE: usize = 200;

/// One line of the report.
pub(crate) struct Case {
    /// What is done, in the same words for every library.
    pub(crate) operation: &'static str,
    /// The number of planes of the sphere, or of sides of the pyramid.
    pub(crate) size: usize,
    /// Who does it.
    pub(crate) library: &'static str,
    /// Gives one sample.
    pub(crate) sampler: Sampler,
}

/// How many operations of each kind make one sample: enough that reading the clock does not count and planes from all over
/// the polytope take part, few enough that the clones of one batch stay in the cache.
struct Batches {
    in_place: usize,
    clone_remove: usize,
    build: usize,
}

/// Checks all results, then prepares all cases. Cases to be compared stand next to each other.
///
/// # Errors
/// The first result that is wrong or differs between the libraries.
pub(crate) fn prepare(quick: bool) -> Result<Vec<Case>, String> {
    let mut cases = Vec::new();
    let sizes: &[usize] = if quick { &[30, 200, 10_000] } else { &[30, 200, 10_000, 100_000] };
    for &size in sizes {
        let batches = match size {
            ..100 => Batches { in_place: 3000, clone_remove: 60, build: 30 },
            100..1000 => Batches { in_place: 3000, clone_remove: 12, build: 5 },
            1000..50_000 => Batches { in_place: 10_000, clone_remove: 1, build: 1 },
            _ => Batches { in_place: 20_000, clone_remove: 1, build: 1 },
        };
        // Counting the vertices of a large polytope takes far longer than the removal.
        let removals = if size <= 200 { size } else { 4 };
        sphere::<Planecut>(size, &batches, removals, &mut cases)?;
        if size <= LARGEST_FOR_POLY_SURGE {
            let batches = match size {
                ..100 => Batches { in_place: 30, clone_remove: 60, build: 3 },
                _ => Batches { in_place: 50, clone_remove: 12, build: 1 },
            };
            sphere::<PolySurge>(size, &batches, removals, &mut cases)?;
        }
    }
    let planes = pyramid(PYRAMID_SIDES);
    verify::same_around_removal::<Planecut, PolySurge>(&planes)?;
    cases.push(case::<Planecut>(PYRAMID_BASE, PYRAMID_SIDES, case::remove_first::<Planecut>(&planes)));
    cases.push(case::<PolySurge>(PYRAMID_BASE, PYRAMID_SIDES, case::remove_first::<PolySurge>(&planes)));
    let rank = |case: &Case| [IN_PLACE, CLONE_REMOVE, BUILD, PYRAMID_BASE].iter().position(|o| *o == case.operation);
    cases.sort_by_key(|case| (rank(case), case.size));
    Ok(cases)
}

fn sphere<L: Library + 'static>(
    size: usize,
    batches: &Batches,
    removals: usize,
    cases: &mut Vec<Case>,
) -> Result<(), String> {
    let planes = fibonacci_sphere(size);
    verify::simple_polytope::<L>(&planes, removals)?;
    cases.push(case::<L>(IN_PLACE, size, case::remove_and_add::<L>(&planes, batches.in_place)));
    cases.push(case::<L>(CLONE_REMOVE, size, case::clone_and_remove::<L>(&planes, batches.clone_remove)));
    cases.push(case::<L>(BUILD, size, case::build::<L>(&planes, batches.build)));
    Ok(())
}

fn case<L: Library>(operation: &'static str, size: usize, sampler: Sampler) -> Case {
    Case { operation, size, library: L::NAME, sampler }
}
