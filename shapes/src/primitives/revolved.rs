//! Outlines revolved about the z axis.
//!
//! Between two half-planes through the axis a convex outline becomes a convex cell: with `u` the direction in the middle and `α`
//! the angle between the half-planes, the points at the distance `x` along each of them have `u·p = x cos(α/2)`, so the side
//! on the line `a x + b z = d` of the outline lies on the plane `(a / cos(α/2)) u·p + b z = d`.
//!
//! Planes of neighbouring steps differ by `u` alone, so where all are scaled to `a = ±1`, the difference of two of them is that of
//! two vectors `u / cos(α/2)`. It is the half-plane between them: with these vectors rounded to a grid it has no error, and all
//! edges of the one step on it are those of the other to the last bit.
//!
//! In a whole turn the planes of a line with `a > 0` bound one convex body, for a line with `a < 0` what they bound is to be
//! left out. So a convex outline is one brush, less one for each side that faces the axis, and there are no half-planes. They
//! all meet on the axis: where a body touches it, that is a corner of any number of planes, whose signs are all true zeros.
//! Only where many sides face the axis is it less work to cut the outline into steps.

use planecut_csg::{Brush, MaterialId, Tree, sine_and_cosine};
use planecut_kernel::{DVec2, DVec3, HalfSpace};

use super::cells::PlaneSide;
use super::extruded::brush_of;
use super::region::Region;
use super::simple::plane;
use super::walls::Walls;
use crate::outline::Outline;
use crate::parameter::{
    MAX_SEGMENTS, ShapeError, apothem, direction, middle, pieces, positive, refuse, segments as accepted_segments,
};

/// A line of the outline `a x + b z = d`, the outline below it.
type Line = (f64, f64, f64);

/// Vectors of at most 2 are multiples of this: their differences have no error.
const GRID: f64 = 1.0 / (1u64 << 51) as f64;
/// Lines flatter than this by their slope are not scaled.
const STEEPEST: f64 = (1u64 << 20) as f64;

/// Up to this many sides that face the axis are left out one by one, where the outline touches the axis and where it does not;
/// more of them overlap too much.
const MAX_INNER: [usize; 2] = [4, 1];

/// A torus about z: a circle of `tube_segments` about `(radius, 0)`, revolved in `segments` steps.
///
/// # Errors
/// [`ShapeError::Parameter`] where the tube's radius is not above 0 and below the torus', or segments are not 3 to 10,000, and
/// [`ShapeError::TooLarge`].
pub fn torus(
    radius: f64,
    tube: f64,
    segments: u32,
    tube_segments: u32,
    material: MaterialId,
) -> Result<Tree, ShapeError> {
    let (radius, tube) = (positive("radius", radius)?, positive("tube", tube)?);
    if tube >= radius {
        return Err(refuse("tube", &tube, &format!("a number below the radius {radius}")));
    }
    let segments = accepted_segments("segments", segments)?;
    let tube_segments = accepted_segments("tube_segments", tube_segments)?;
    let turn = Turn { angle: 360.0, steps: segments };
    let line = |k| {
        let outward = middle(k, tube_segments);
        let scale = outward.abs().max_element();
        let offset = radius * (outward.x / scale) + tube * (apothem(tube_segments) / scale);
        scaled((outward.x / scale, outward.y / scale, offset))
    };
    let lines: Vec<Line> = (0..tube_segments).map(line).collect();
    Ok(Tree::union_of(turn.steps_of(&lines, material)?))
}

/// An outline revolved about z by `angle` degrees, counter-clockwise seen from above and beginning in the x–z plane: its x
/// becomes the distance from the axis, its y becomes z. `segments` is for a whole turn, of which `⌈segments · angle / 360⌉` are
/// used.
///
/// # Errors
/// [`ShapeError::Parameter`] where the outline has a corner at a negative x, the angle is not above 0 and at most 360, or the
/// segments are not 3 to 10,000, and [`ShapeError::TooLarge`].
pub fn revolve(outline: &Outline, angle: f64, segments: u32, material: MaterialId) -> Result<Tree, ShapeError> {
    let segments = accepted_segments("segments", segments)?;
    let steps = (f64::from(segments) * accepted_angle(angle)? / 360.0).ceil().max(1.0) as u32;
    turned(outline, Turn { angle, steps }, material)
}

/// An outline revolved as by [`revolve`], in a number of equal steps.
///
/// # Errors
/// [`ShapeError::Parameter`] where the outline has a corner at a negative x, the angle is not above 0 and at most 360, or a
/// step is not below half a turn, and [`ShapeError::TooLarge`].
pub fn revolve_in_steps(outline: &Outline, angle: f64, steps: u32, material: MaterialId) -> Result<Tree, ShapeError> {
    let least = (accepted_angle(angle)? / 180.0).floor() as u32 + 1;
    if !(least..=MAX_SEGMENTS).contains(&steps) {
        return Err(refuse("steps", &steps, &format!("a whole number from {least} to {MAX_SEGMENTS}")));
    }
    turned(outline, Turn { angle, steps }, material)
}

fn accepted_angle(angle: f64) -> Result<f64, ShapeError> {
    let is_accepted = angle > 0.0 && angle <= 360.0;
    if is_accepted { Ok(angle) } else { Err(refuse("angle", &angle, &"a number above 0 and at most 360")) }
}

fn turned(outline: &Outline, turn: Turn, material: MaterialId) -> Result<Tree, ShapeError> {
    if let Some(corner) = outline.loops().flatten().find(|corner| corner.x < 0.0) {
        return Err(refuse("outline", &format!("a corner at x = {}", corner.x), &"no x below 0"));
    }
    let mut region = Region::default();
    for shape in outline.shapes() {
        let bodies = shape.iter().map(|corners| turn.body(corners, material));
        region.add(bodies.collect::<Result<Vec<_>, ShapeError>>()?)?;
    }
    Ok(region.into_tree())
}

/// The line of a side; one that ends on the axis passes through that point exactly.
fn line(side: &HalfSpace, [p, q]: [DVec2; 2]) -> Line {
    let (normal, offset) = (side.normal(), side.offset());
    let tip = [p, q].into_iter().find(|end| end.x == 0.0).filter(|_| normal.y != 0.0);
    match tip {
        Some(tip) => (normal.x / normal.y.abs(), normal.y.signum(), tip.y * normal.y.signum()),
        None => scaled((normal.x, normal.y, offset)),
    }
}

/// The same line with `a = ±1`, where it is not too flat.
fn scaled((a, b, d): Line) -> Line {
    let size = a.abs();
    if b.abs() < STEEPEST * size { (a.signum(), b / size, d / size) } else { (a, b, d) }
}

fn flipped((a, b, d): Line) -> Line {
    (-a, -b, -d)
}

/// Steps about the axis.
#[derive(Debug, Clone, Copy)]
struct Turn {
    angle: f64,
    steps: u32,
}

impl Turn {
    fn is_full(&self) -> bool {
        self.angle == 360.0
    }

    /// The direction after `half_steps / 2` steps.
    fn direction(&self, half_steps: u32) -> DVec2 {
        if self.is_full() {
            return direction(u64::from(half_steps), 2 * u64::from(self.steps));
        }
        let (sine, cosine) = sine_and_cosine(self.angle * f64::from(half_steps) / f64::from(2 * self.steps));
        DVec2::new(cosine, sine)
    }

    /// `u / cos(α/2)` in the middle of a step.
    fn outward(&self, step: u32) -> DVec2 {
        (self.direction(2 * step + 1) / self.direction(1).x / GRID).round() * GRID
    }

    /// The parts over a loop.
    fn body(&self, corners: &[DVec2], material: MaterialId) -> Result<Vec<Tree>, ShapeError> {
        let walls = Walls::over(corners)?;
        let lines: Vec<Line> =
            walls.half_spaces.iter().zip(walls.ends()).map(|(side, ends)| line(side, ends)).collect();
        // a side on the axis has nothing to bound
        let on_axis: Vec<bool> = walls.ends().map(|[p, q]| p.x == 0.0 && q.x == 0.0).collect();
        let oriented = |side: &PlaneSide| {
            let line = lines[side.facet as usize];
            if side.is_outer { flipped(line) } else { line }
        };
        let cells = walls.cells()?;
        let cells: Vec<Vec<Line>> = cells
            .iter()
            .map(|cell| cell.iter().filter(|side| !on_axis[side.facet as usize]).map(oriented).collect())
            .collect();
        // All cells in the same way: where they touch on the surface its edges are the same to the last bit.
        let inner = |cell: &Vec<Line>| cell.iter().filter(|(a, ..)| *a < 0.0).count();
        let is_apart = corners.iter().all(|corner| corner.x > 0.0);
        let is_whole = self.is_full() && cells.iter().all(|cell| inner(cell) <= MAX_INNER[usize::from(is_apart)]);
        let slab = Slab::around(corners)?;
        let mut parts = Vec::new();
        for cell in &cells {
            if is_whole {
                parts.extend(self.whole(cell, &slab, material)?);
            } else {
                parts.extend(self.steps_of(cell, material)?.into_iter().map(Tree::from));
            }
            pieces(parts.len() as u64)?;
        }
        Ok(parts)
    }

    /// A convex outline in a whole turn: what is within the sides that face outward, less what is within those that face the
    /// axis.
    fn whole(&self, lines: &[Line], slab: &Slab, material: MaterialId) -> Result<Option<Tree>, ShapeError> {
        let (inner, outer): (Vec<Line>, Vec<Line>) = lines.iter().partition(|(a, ..)| *a < 0.0);
        let Some(body) = self.convex(&outer, slab, material)? else { return Ok(None) };
        let mut operands = vec![Tree::from(body)];
        for line in inner {
            operands.extend(self.convex(&[flipped(line)], slab, material)?.map(Tree::from));
        }
        Ok(Some(if operands.len() == 1 { operands.remove(0) } else { Tree::difference(operands) }))
    }

    /// The convex body within lines that do not face the axis.
    fn convex(&self, lines: &[Line], slab: &Slab, material: MaterialId) -> Result<Option<Brush>, ShapeError> {
        let mut planes = Vec::with_capacity(lines.len() * self.steps as usize);
        for (a, b, d) in lines {
            if *a == 0.0 {
                planes.push(plane(DVec3::Z * *b, *d)?);
                continue;
            }
            for step in 0..self.steps {
                planes.push(self.plane(&(*a, *b, *d), step)?);
            }
        }
        let sides: Vec<PlaneSide> =
            (0..planes.len() as u32).map(|facet| PlaneSide { facet, is_outer: false }).collect();
        Ok(brush_of(&sides, &planes, &slab.0, material))
    }

    /// A convex outline, step by step.
    fn steps_of(&self, lines: &[Line], material: MaterialId) -> Result<Vec<Brush>, ShapeError> {
        pieces(u64::from(self.steps) * lines.len() as u64)?;
        let cell: Vec<PlaneSide> = (0..lines.len() as u32).map(|facet| PlaneSide { facet, is_outer: false }).collect();
        let mut brushes = Vec::new();
        for step in 0..self.steps {
            let planes = lines.iter().map(|line| self.plane(line, step)).collect::<Result<Vec<_>, _>>()?;
            let walls = [self.wall(step)?.flipped(), self.wall(step + 1)?];
            brushes.extend(brush_of(&cell, &planes, &walls, material));
        }
        Ok(brushes)
    }

    /// The plane of a line in one step.
    fn plane(&self, (a, b, d): &Line, step: u32) -> Result<HalfSpace, ShapeError> {
        plane((self.outward(step) * *a).extend(*b), *d)
    }

    /// The half-space before the half-plane where a step begins.
    fn wall(&self, step: u32) -> Result<HalfSpace, ShapeError> {
        if !self.is_full() && (step == 0 || step == self.steps) {
            let along = self.direction(2 * step);
            let along = along / along.abs().max_element();
            return plane(DVec3::new(0.0 - along.y, along.x, 0.0), 0.0);
        }
        let (before, after) = ((step + self.steps - 1) % self.steps, step % self.steps);
        plane((self.outward(after) - self.outward(before)).extend(0.0), 0.0)
    }
}

/// A box that is larger than the body over a loop, so that cones have an end.
struct Slab([HalfSpace; 6]);

impl Slab {
    fn around(corners: &[DVec2]) -> Result<Self, ShapeError> {
        let (min, max) = corners.iter().fold((corners[0], corners[0]), |(min, max), p| (min.min(*p), max.max(*p)));
        let height = max.y - min.y;
        let (bottom, top, side) = (min.y - height, max.y + height, 4.0 * max.x);
        Ok(Self([
            plane(-DVec3::Z, -bottom)?,
            plane(DVec3::Z, top)?,
            plane(-DVec3::X, side)?,
            plane(DVec3::X, side)?,
            plane(-DVec3::Y, side)?,
            plane(DVec3::Y, side)?,
        ]))
    }
}
