//! The structure is a function of the planes and their order alone.

use crate::replay::Replay;
use crate::structure::Structure;

/// Checks the kernel's invariants and compares the structure with that of a fresh build of the same planes by age.
///
/// # Errors
/// A broken invariant, or both structures where they differ.
pub fn compare_with_fresh_build(replay: &Replay) -> Result<(), String> {
    let polytope = &replay.polytope;
    polytope.check_invariants().map_err(|e| format!("invariant broken: {e}"))?;
    if replay.tally.removals + replay.tally.moved == 0 {
        return Ok(());
    }
    let order = replay.order();
    let (kept, fresh) = (Structure::of(polytope, &order)?, Structure::of_fresh_build(polytope, &order)?);
    if kept == fresh { Ok(()) } else { Err(format!("kept  {kept:?}\nfresh {fresh:?}")) }
}
