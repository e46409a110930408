//! A polygon cut into convex cells along the lines of its own sides.
//!
//! From a reflex corner a cut goes on along one of its two sides until it meets the boundary of the cell or an earlier cut; it
//! leaves no reflex corner there and makes none. So there are at most as many cells as reflex corners and one more. Where
//! such a cut leads straight to the side of another reflex corner it does away with both: these cuts come first. Otherwise
//! it is the shorter one of the two.
//!
//! No line is made that no side has, and where a cut ends three lines meet and no more: each cell is an intersection of sides
//! of lines, and two cells that touch have the very same line between them. Sides on one line have one number for it, by
//! which they are known to be in line. All else is decided by exact signs.

mod polygon;
mod sides;

use planecut_kernel::DVec2;

use super::cells::PlaneSide;
use crate::outline::signed_area;
use crate::tolerances::{PARTITION_AREA, PARTITION_CONVEX};
use polygon::Cutter;
use sides::Sides;

/// Convex cells of a loop that runs counter-clockwise and does not cross itself, each as sides of its sides' lines; `lines`
/// has of each side the number of its line. `None` where the loop is not what it should be.
pub(super) fn partition(corners: &[DVec2], lines: &[u32]) -> Option<Vec<Vec<PlaneSide>>> {
    let mut cutter = Cutter::new(Sides::new(corners, lines));
    let cells = cutter.cells()?;
    // A loop that runs through one point several times, or into itself, may be cut wrongly. Cells that overlap or leave gaps
    // do not add up, and others are not convex.
    let area = signed_area(corners);
    let found: f64 = cells.iter().map(|cell| cutter.area(cell).max(0.0)).sum();
    let size = corners.iter().map(|p| (*p - corners[0]).abs().max_element()).fold(0.0, f64::max);
    let is_whole = (found - area).abs() <= PARTITION_AREA * corners.len() as f64 * size * size;
    let is_sound = is_whole && cells.iter().all(|cell| cutter.is_convex(cell, PARTITION_CONVEX * size));
    is_sound.then(|| cells.iter().map(|cell| cell.sides()).collect())
}
