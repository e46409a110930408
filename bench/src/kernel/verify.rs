//! No time counts before the results agree: vertex counts against Euler's formula, and of one library against the other.

use planecut_bench::inputs::Plane;
use planecut_bench::library::Library;

/// Checks a polytope all of whose planes have a face and whose vertices all have three: after the build, without each of
/// `removals` evenly spread planes, and after each was added again in place.
///
/// # Errors
/// What was counted and what Euler's formula gives.
pub(crate) fn simple_polytope<L: Library>(planes: &[Plane], removals: usize) -> Result<(), String> {
    let half_spaces: Vec<_> = planes.iter().map(L::half_space).collect();
    let euler = |planes: usize| 2 * planes - 4;
    let expect = |found: usize, planes: usize, after: &str| match found == euler(planes) {
        true => Ok(()),
        false => Err(format!("{}, {planes} planes {after}: {found} vertices, expected {}", L::NAME, euler(planes))),
    };
    let count = planes.len();
    let mut polytope = L::build(&half_spaces);
    expect(polytope.vertex_count(), count, "after the build")?;
    let removals = removals.min(count);
    for index in (0..removals).map(|k| k * count / removals) {
        let mut clone = polytope.clone();
        clone.remove(index);
        expect(clone.vertex_count(), count - 1, &format!("without plane {index}"))?;
        polytope.remove(index);
        polytope.add(&half_spaces[index]);
        expect(polytope.vertex_count(), count, &format!("with plane {index} added again"))?;
    }
    Ok(())
}

/// Checks that two libraries count the same vertices before and after plane 0 is removed.
///
/// # Errors
/// The counts, where they differ.
pub(crate) fn same_around_removal<A: Library, B: Library>(planes: &[Plane]) -> Result<(), String> {
    let (a, b) = (counts_around_removal::<A>(planes), counts_around_removal::<B>(planes));
    match a == b {
        true => Ok(()),
        false => Err(format!("vertices before and after the removal: {} {a:?}, {} {b:?}", A::NAME, B::NAME)),
    }
}

fn counts_around_removal<L: Library>(planes: &[Plane]) -> [usize; 2] {
    let half_spaces: Vec<_> = planes.iter().map(L::half_space).collect();
    let mut polytope = L::build(&half_spaces);
    let before = polytope.vertex_count();
    polytope.remove(0);
    [before, polytope.vertex_count()]
}
