//! Set operations on outlines, by the crate `i_overlay`.
//!
//! The library works on whole numbers. Coordinates are multiplied by a power of two that leaves the largest 57 bits, so that
//! all within a factor of 16 of it are whole without rounding, and each corner that comes back takes the very coordinates
//! that went in: only corners where edges cross are new, and only they are rounded.

use i_overlay::core::overlay::{IntOverlayOptions, Overlay, ShapeType};
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::core::solver::{Precision, Solver};
use i_overlay::i_float::int::point::IntPoint;
use planecut_csg::Operation;
use planecut_kernel::DVec2;
use rustc_hash::FxHashMap;

use super::{FillRule, Outline, crossings, largest_coordinate, signed_area};
use crate::parameter::{ShapeError, refuse};
use crate::tolerances::SLIVER;

/// Bits that the largest coordinate gets; the library takes 62.
const BITS: i32 = 57;

pub(super) type Loop = Vec<IntPoint<i64>>;

/// Crossings take the place of corners nearer than `2⁸` units of the grid, which is a few roundings of the largest coordinate.
/// Each time that new crossings come of this it is four times as far: with less, many needles that nearly cover each other,
/// as in a shadow, multiply until memory ends.
const PRECISION: Precision = Precision { start: 16, progression: 4 };

impl Outline {
    /// A set operation on outlines, regularised; [`Operation::Difference`] takes the others from the first.
    ///
    /// # Errors
    /// [`ShapeError::Parameter`] for [`Operation::Complement`]: no outline is unbounded. [`ShapeError::Crossings`] where sides cross more than
    /// [`MAX_CROSSINGS`](super::MAX_CROSSINGS) times.
    pub fn combine(operation: Operation, operands: &[Self]) -> Result<Self, ShapeError> {
        crossings::refuse_many(operands.iter().flat_map(Self::loops))?;
        let points = || operands.iter().flat_map(Self::loops).flatten();
        let mut grid = Grid::of(points());
        let loops: Vec<Vec<Loop>> = operands.iter().map(|operand| grid.loops(operand.loops())).collect();
        let Some((first, rest)) = loops.split_first() else { return Ok(Self::empty()) };
        let all = || loops.concat();
        let result = match operation {
            Operation::Union => run(&all(), &[], OverlayRule::Subject, FillRule::NonZero),
            Operation::Xor => run(&all(), &[], OverlayRule::Subject, FillRule::EvenOdd),
            Operation::Difference => run(first, &rest.concat(), OverlayRule::Difference, FillRule::NonZero),
            Operation::Intersection => {
                let whole = run(first, &[], OverlayRule::Subject, FillRule::NonZero);
                let meet = |left: Vec<Vec<Loop>>, right: &Vec<Loop>| {
                    run(&left.concat(), right, OverlayRule::Intersect, FillRule::NonZero)
                };
                rest.iter().fold(whole, meet)
            }
            Operation::Complement => return Err(refuse("complement", &"an outline", &"a node of the solid tree")),
        };
        Ok(grid.outline(&result))
    }

    /// What loops fill by one of the common rules: where they wind an odd number of times (`EvenOdd`), at all (`NonZero`), or more
    /// often counter-clockwise (`Positive`).
    pub(crate) fn filled(loops: &[Vec<DVec2>], rule: FillRule) -> Self {
        let mut grid = Grid::of(loops.iter().flatten());
        let loops = grid.loops(loops.iter());
        grid.outline(&run(&loops, &[], OverlayRule::Subject, rule))
    }

    /// Without loops that are no wider than rounding.
    pub(super) fn without_slivers(mut self) -> Self {
        let size = largest_coordinate(self.loops().flatten());
        let is_wide = |corners: &Vec<DVec2>| {
            let length: f64 = (0..corners.len()).map(|k| corners[k].distance(corners[(k + 1) % corners.len()])).sum();
            signed_area(corners).abs() > SLIVER * size * length
        };
        self.shapes.retain(|shape| is_wide(&shape[0]));
        self.shapes.iter_mut().for_each(|shape| shape.retain(is_wide));
        self
    }
}

fn run(subject: &[Loop], clip: &[Loop], rule: OverlayRule, fill: FillRule) -> Vec<Vec<Loop>> {
    let solver = Solver { precision: PRECISION, ..Solver::AUTO };
    let capacity = subject.iter().chain(clip).map(Vec::len).sum();
    let mut overlay = Overlay::<i64>::new_custom(capacity, IntOverlayOptions::default(), solver);
    overlay.add_source(subject, ShapeType::Subject);
    overlay.add_source(clip, ShapeType::Clip);
    overlay.overlay(rule, fill)
}

/// A parallelogram, turned around where it runs clockwise; nothing where it is flat.
fn counter_clockwise(mut corners: [IntPoint<i64>; 4]) -> Option<Loop> {
    let along = |k: usize| [corners[k].x - corners[0].x, corners[k].y - corners[0].y].map(i128::from);
    let ([ax, ay], [bx, by]) = (along(1), along(3));
    let area = ax * by - ay * bx;
    if area < 0 {
        corners.reverse();
    }
    (area != 0).then(|| corners.to_vec())
}

/// Coordinates as whole numbers, and back.
pub(super) struct Grid {
    scale: f64,
    known: FxHashMap<[i64; 2], DVec2>,
}

impl Grid {
    fn of<'a>(points: impl Iterator<Item = &'a DVec2>) -> Self {
        Self::up_to(largest_coordinate(points))
    }

    /// A grid for coordinates up to a magnitude.
    fn up_to(largest: f64) -> Self {
        let exponent = if largest > 0.0 { (largest.to_bits() >> 52) as i32 - 1023 } else { 0 };
        Self { scale: 2f64.powi(BITS - exponent), known: FxHashMap::default() }
    }

    /// A grid that holds the sums of a corner of each.
    pub(super) fn of_sums(a: &Outline, b: &Outline) -> Self {
        let size = |outline: &Outline| largest_coordinate(outline.loops().flatten());
        Self::up_to(size(a) + size(b))
    }

    /// The sum of two points, which is exact on the grid.
    fn sum(&mut self, a: DVec2, b: DVec2) -> IntPoint<i64> {
        let [[ax, ay], [bx, by]] = [a, b].map(|p| (p * self.scale).round().to_array().map(|v| v as i64));
        let at = [ax + bx, ay + by];
        self.known.entry(at).or_insert(a + b);
        IntPoint::new(at[0], at[1])
    }

    /// A loop moved by a corner of the other operand.
    pub(super) fn moved(&mut self, corners: &[DVec2], by: DVec2) -> Loop {
        corners.iter().map(|corner| self.sum(*corner, by)).collect()
    }

    /// The parallelograms that each two sides of two loops span, counter-clockwise.
    pub(super) fn add_parallelograms(&mut self, a: &[DVec2], b: &[DVec2], loops: &mut Vec<Loop>) {
        let rows: Vec<Loop> = b.iter().map(|by| self.moved(a, *by)).collect();
        for (i, row) in rows.iter().enumerate() {
            let next = &rows[(i + 1) % rows.len()];
            for j in 0..row.len() {
                let k = (j + 1) % row.len();
                let corners = [row[j], row[k], next[k], next[j]];
                loops.extend(counter_clockwise(corners));
            }
        }
    }

    /// The union of loops that run counter-clockwise, and of their holes.
    pub(super) fn union(&self, loops: &[Loop]) -> Outline {
        self.outline(&run(loops, &[], OverlayRule::Subject, FillRule::NonZero))
    }

    fn loops<'a>(&mut self, loops: impl Iterator<Item = &'a Vec<DVec2>>) -> Vec<Loop> {
        loops.map(|corners| corners.iter().map(|p| self.whole(*p)).collect()).collect()
    }

    fn whole(&mut self, point: DVec2) -> IntPoint<i64> {
        let [x, y] = (point * self.scale).round().to_array().map(|v| v as i64);
        self.known.entry([x, y]).or_insert(point);
        IntPoint::new(x, y)
    }

    fn outline(&self, shapes: &[Vec<Loop>]) -> Outline {
        let point = |p: &IntPoint<i64>| {
            let known = self.known.get(&[p.x, p.y]).copied();
            known.unwrap_or_else(|| DVec2::new(p.x as f64, p.y as f64) / self.scale)
        };
        let corners = |corners: &Loop| {
            let mut corners: Vec<DVec2> = corners.iter().map(point).collect();
            corners.dedup();
            while corners.len() > 1 && corners.first() == corners.last() {
                corners.pop();
            }
            corners
        };
        let shapes = shapes.iter().map(|shape| shape.iter().map(corners).filter(|c| c.len() >= 3).collect());
        Outline { shapes: shapes.filter(|shape: &Vec<_>| !shape.is_empty()).collect() }
    }
}
