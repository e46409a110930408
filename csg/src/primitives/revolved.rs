//! Outlines revolved about the z axis.
//!
//! Between two half-planes through the axis a convex outline becomes a convex cell: with `u` the direction in the middle and `α`
//! the angle between the half-planes, the points at the distance `x` along each of them have `u·p = x cos(α/2)`, so the side
//! on the line `a x + b z = d` of the outline lies on the plane `(a / cos(α/2)) u·p + b z = d`.

use planecut_kernel::{DVec2, DVec3, HalfSpace};

use super::ShapeError;
use super::cells::Side;
use super::circle::{apothem, direction, middle};
use super::extruded::brush_of;
use super::flat::plane;
use super::parameter::{pieces, positive, refuse, segments as accepted_segments};
use super::region::Region;
use super::walls::Walls;
use crate::brush::{Brush, MaterialId};
use crate::outline::Outline;
use crate::transform::sine_and_cosine;
use crate::tree::Tree;

/// A line of the outline `a x + b z = d`, the outline below it.
type Line = (f64, f64, f64);

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
    let line = |k| {
        let outward = middle(k, tube_segments);
        let scale = outward.abs().max_element();
        (outward.x / scale, outward.y / scale, radius * (outward.x / scale) + tube * (apothem(tube_segments) / scale))
    };
    let lines: Vec<Line> = (0..tube_segments).map(line).collect();
    let cell: Vec<Side> = (0..tube_segments).map(|facet| Side { facet, is_outer: false }).collect();
    let mut brushes = Vec::new();
    Turn::full(segments).revolve(&lines, &[cell], material, &mut brushes)?;
    Ok(Tree::union_of(brushes))
}

/// An outline revolved about z by `angle` degrees, counter-clockwise seen from above and beginning in the x–z plane: its x
/// becomes the distance from the axis, its y becomes z. `segments` is for a whole turn, of which `⌈segments · angle / 360⌉` are
/// used.
///
/// # Errors
/// [`ShapeError::Parameter`] where the outline has a corner at a negative x, the angle is not above 0 and at most 360, or the
/// segments are not 3 to 10,000, and [`ShapeError::TooLarge`].
pub fn revolve(outline: &Outline, angle: f64, segments: u32, material: MaterialId) -> Result<Tree, ShapeError> {
    if !(angle > 0.0 && angle <= 360.0) {
        return Err(refuse("angle", &angle, &"a number above 0 and at most 360"));
    }
    let turn = Turn::new(angle, accepted_segments("segments", segments)?);
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
        None => (normal.x, normal.y, offset),
    }
}

/// Steps about the axis.
struct Turn {
    angle: f64,
    steps: u32,
}

impl Turn {
    fn full(steps: u32) -> Self {
        Self { angle: 360.0, steps }
    }

    fn new(angle: f64, segments: u32) -> Self {
        Self { angle, steps: (f64::from(segments) * angle / 360.0).ceil().max(1.0) as u32 }
    }

    /// The direction after `half_steps / 2` steps.
    fn direction(&self, half_steps: u32) -> DVec2 {
        if self.angle == 360.0 {
            return direction(u64::from(half_steps), 2 * u64::from(self.steps));
        }
        let (sine, cosine) = sine_and_cosine(self.angle * f64::from(half_steps) / f64::from(2 * self.steps));
        DVec2::new(cosine, sine)
    }

    /// The cells over a loop.
    fn body(&self, corners: &[DVec2], material: MaterialId) -> Result<Vec<Brush>, ShapeError> {
        let walls = Walls::over(corners)?;
        let lines: Vec<Line> =
            walls.half_spaces.iter().zip(walls.ends()).map(|(side, ends)| line(side, ends)).collect();
        // a side on the axis has nothing to bound
        let on_axis: Vec<bool> = walls.ends().map(|[p, q]| p.x == 0.0 && q.x == 0.0).collect();
        let mut cells = walls.cells()?;
        for cell in &mut cells {
            cell.retain(|side| !on_axis[side.facet as usize]);
        }
        let mut brushes = Vec::new();
        self.revolve(&lines, &cells, material, &mut brushes)?;
        Ok(brushes)
    }

    /// Adds a cell for each step and each cell of the outline.
    fn revolve(
        &self,
        lines: &[Line],
        cells: &[Vec<Side>],
        material: MaterialId,
        brushes: &mut Vec<Brush>,
    ) -> Result<(), ShapeError> {
        pieces(brushes.len() as u64 + u64::from(self.steps) * cells.len() as u64)?;
        for step in 0..self.steps {
            let planes = self.planes(lines, step)?;
            let walls = [self.wall(step)?.flipped(), self.wall(step + 1)?];
            brushes.extend(cells.iter().filter_map(|cell| brush_of(cell, &planes, &walls, material)));
        }
        Ok(())
    }

    /// The planes of the lines in one step.
    fn planes(&self, lines: &[Line], step: u32) -> Result<Vec<HalfSpace>, ShapeError> {
        let outward = self.direction(2 * step + 1) / self.direction(1).x;
        lines.iter().map(|(a, b, d)| plane((outward * *a).extend(*b), *d)).collect()
    }

    /// The half-space before the half-plane where a step begins.
    fn wall(&self, step: u32) -> Result<HalfSpace, ShapeError> {
        let along = self.direction(2 * (step % self.whole()));
        let along = along / along.abs().max_element();
        plane(DVec3::new(0.0 - along.y, along.x, 0.0), 0.0)
    }

    /// After how many steps the first half-plane is met again.
    fn whole(&self) -> u32 {
        if self.angle == 360.0 { self.steps } else { u32::MAX }
    }
}
