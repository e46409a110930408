//! No time counts before the results agree: vertex counts against Euler's formula, and of one library against the other.

use crate::inputs::Plane;
use crate::library::Library;

/// How many planes are taken out one by one to compare; of larger inputs, evenly spread ones.
const REMOVALS: usize = 200;

/// Checks a polytope all of whose planes have a face and whose vertices all have three: after the build, without each of
/// many planes, and after each was added again in place.
///
/// # Errors
/// What was counted and what Euler's formula gives.
pub(crate) fn simple_polytope<L: Library>(name: &str, planes: &[Plane], removals: usize) -> Result<(), String> {
    let half_spaces: Vec<_> = planes.iter().map(L::half_space).collect();
    let euler = |planes: usize| 2 * planes - 4;
    let expect = |found: usize, planes: usize, after: &str| match found == euler(planes) {
        true => Ok(()),
        false => Err(format!("{name}, {planes} planes {after}: {found} vertices, expected {}", euler(planes))),
    };
    let count = planes.len();
    let mut polytope = L::build(&half_spaces);
    expect(polytope.vertex_count(), count, "after the build")?;
    let removals = removals.min(REMOVALS).min(count);
    for index in (0..removals).map(|k| k * count / removals) {
        let mut clone = polytope.clone();
        clone.remove(index);
        expect(clone.vertex_count(), count - 1, &format!("without plane {index}"))?;
        polytope.remove(index);
        polytope.add_again(index, &half_spaces[index]);
        expect(polytope.vertex_count(), count, &format!("with plane {index} added again"))?;
    }
    Ok(())
}

/// The vertex counts of a polytope before and after its plane 0 is removed.
pub(crate) fn counts_around_removal<L: Library>(planes: &[Plane]) -> [usize; 2] {
    let half_spaces: Vec<_> = planes.iter().map(L::half_space).collect();
    let mut polytope = L::build(&half_spaces);
    let before = polytope.vertex_count();
    polytope.remove(0);
    [before, polytope.vertex_count()]
}
