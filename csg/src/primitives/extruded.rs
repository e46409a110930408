//! Outlines extruded along z.

use planecut_kernel::{DVec2, DVec3, HalfSpace, IncrementalPolytope};
use robust::{Coord, Coord3D, orient2d, orient3d};

use super::ShapeError;
use super::cells::{Side, Surface};
use super::flat::plane;
use super::parameter::{MAX_SEGMENTS, angle, not_negative, pieces, positive, refuse};
use crate::brush::{Brush, MaterialId};
use crate::check::{CheckOptions, check_mesh};
use crate::outline::Outline;
use crate::transform::sine_and_cosine;
use crate::tree::Tree;

/// Of each facet the numbers of its corners, counter-clockwise seen from outside.
type Facets = Vec<Vec<u32>>;

/// How an outline is extruded along z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extrusion {
    /// The height, above 0.
    pub height: f64,
    /// Degrees by which the top is turned, clockwise seen from above; 0 by default.
    pub twist: f64,
    /// How much wider the top is along x and y than the bottom; 1 by default.
    pub scale: DVec2,
    /// The number of layers; 1 without twist and `⌈|twist| / 5⌉` with it where it is not given.
    pub slices: Option<u32>,
    /// Whether z runs from `−height / 2` instead of 0.
    pub center: bool,
}

impl Extrusion {
    /// Straight up from z = 0.
    #[must_use]
    pub fn straight(height: f64) -> Self {
        Self { height, twist: 0.0, scale: DVec2::ONE, slices: None, center: false }
    }

    fn accepted(&self) -> Result<Self, ShapeError> {
        let (height, twist) = (positive("height", self.height)?, angle("twist", self.twist)?);
        let scale = DVec2::new(factor(self.scale.x)?, factor(self.scale.y)?);
        let slices = self.slices.map_or_else(|| default_slices(twist), Ok)?;
        if !(1..=MAX_SEGMENTS).contains(&slices) {
            return Err(refuse("slices", &slices, &format!("a whole number from 1 to {MAX_SEGMENTS}")));
        }
        Ok(Self { height, twist, scale, slices: Some(slices), ..*self })
    }

    fn is_straight(&self) -> bool {
        self.twist == 0.0 && self.scale.x == self.scale.y
    }

    fn layers(&self) -> u32 {
        self.slices.unwrap_or(1)
    }

    /// The height of a layer's bottom.
    fn level(&self, layer: u32) -> f64 {
        let height = self.height * f64::from(layer) / f64::from(self.layers());
        if self.center { height - 0.5 * self.height } else { height }
    }

    /// Where a corner of the outline is at the bottom of a layer.
    fn corner(&self, corner: DVec2, layer: u32) -> DVec3 {
        let (j, k) = (f64::from(layer), f64::from(self.layers()));
        let scale = if layer == self.layers() { self.scale } else { DVec2::ONE + (self.scale - DVec2::ONE) * j / k };
        let (sine, cosine) = sine_and_cosine(-self.twist * j / k);
        let p = corner * scale;
        DVec3::new(cosine * p.x - sine * p.y, sine * p.x + cosine * p.y, self.level(layer))
    }
}

fn factor(value: f64) -> Result<f64, ShapeError> {
    not_negative("scale", value)
}

/// Layers that turn by 5° at most.
fn default_slices(twist: f64) -> Result<u32, ShapeError> {
    let slices = (twist.abs() / 5.0).ceil().max(1.0);
    let limit = f64::from(MAX_SEGMENTS);
    let too_many = || refuse("twist", &twist, &format!("at most {} degrees where slices are not given", 5.0 * limit));
    if slices <= limit { Ok(slices as u32) } else { Err(too_many()) }
}

/// An outline extruded along z, as `docs/model-file.md` states it: a union of convex cells whose common walls are the same
/// plane seen from both sides.
///
/// # Errors
/// [`ShapeError::Parameter`] where a parameter is not accepted, [`ShapeError::CrossingSides`] where the sides of one slice
/// pass through each other, and [`ShapeError::TooLarge`].
pub fn extrude(outline: &Outline, extrusion: &Extrusion, material: MaterialId) -> Result<Tree, ShapeError> {
    let extrusion = extrusion.accepted()?;
    let mut brushes = Vec::new();
    for shape in outline.shapes() {
        if extrusion.is_straight() {
            straight(shape, &extrusion, material, &mut brushes)?;
        } else {
            layered(shape, &extrusion, material, &mut brushes)?;
        }
    }
    Ok(Tree::union_of(brushes))
}

/// Sides that are planar, whatever the slices.
fn straight(
    shape: &[Vec<DVec2>],
    extrusion: &Extrusion,
    material: MaterialId,
    brushes: &mut Vec<Brush>,
) -> Result<(), ShapeError> {
    let lines = Lines::of(shape);
    let surface = lines.surface()?;
    let sides = surface.half_spaces()?;
    let sides = sides.iter().map(|side| tilted(side, extrusion)).collect::<Result<Vec<_>, _>>()?;
    let ends = [(DVec3::Z, extrusion.level(extrusion.layers())), (-DVec3::Z, -extrusion.level(0))];
    let ends = ends.map(|(normal, offset)| plane(normal, offset));
    for cell in lines.cells(&surface) {
        brushes.extend(brush_of(&cell, &sides, ends.clone().into_iter().collect::<Result<Vec<_>, _>>()?, material));
    }
    pieces(brushes.len() as u64)
}

/// An upright side, tilted so that its outline shrinks towards the axis as the scale says. Where it ends in a tip, the side
/// passes through it exactly.
fn tilted(side: &HalfSpace, extrusion: &Extrusion) -> Result<HalfSpace, ShapeError> {
    let (normal, offset, scale) = (side.normal(), side.offset(), extrusion.scale.x);
    let (bottom, top) = (extrusion.level(0), extrusion.level(extrusion.layers()));
    if scale == 1.0 {
        return Ok(*side);
    }
    if scale == 0.0 && offset != 0.0 {
        let steep = normal * (extrusion.height / offset.abs());
        return plane(steep.with_z(offset.signum()), top * offset.signum());
    }
    let slope = offset * (1.0 - scale) / extrusion.height;
    plane(normal.with_z(slope), offset + slope * bottom)
}

/// The convex body on these sides of planes and within others; `None` where there is none, and without the planes that have
/// no face.
pub(super) fn brush_of(
    cell: &[Side],
    planes: &[HalfSpace],
    others: Vec<HalfSpace>,
    material: MaterialId,
) -> Option<Brush> {
    let side = |side: &Side| {
        let half_space = planes[side.facet as usize];
        if side.is_outer { half_space.flipped() } else { half_space }
    };
    let mut polytope = IncrementalPolytope::with_epsilon(0.0);
    for half_space in others.into_iter().chain(cell.iter().map(side)) {
        polytope.add_plane(half_space);
    }
    let faces: Vec<HalfSpace> =
        polytope.facets().into_iter().filter_map(|(plane, _)| polytope.plane(plane).copied()).collect();
    (!faces.is_empty()).then(|| Brush::from_half_spaces(faces, material))
}

/// Layer by layer; without change of scale all layers are one, turned.
fn layered(
    shape: &[Vec<DVec2>],
    extrusion: &Extrusion,
    material: MaterialId,
    brushes: &mut Vec<Brush>,
) -> Result<(), ShapeError> {
    let size = shape.iter().flatten().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    let step = if extrusion.layers() == 1 { 0.0 } else { STEP * size };
    let outlines = [widened(shape, -step), widened(shape, step)];
    let mut known: Option<(Facets, Vec<Vec<Side>>)> = None;
    for layer in 0..extrusion.layers() {
        let points = layer_points(&outlines[layer as usize % 2], extrusion, layer);
        let facets = known.take().filter(|_| extrusion.scale == DVec2::ONE);
        let (facets, cells) = match facets {
            Some((facets, cells)) => (facets, Some(cells)),
            None => (layer_facets(shape, &points), None),
        };
        let surface =
            Surface::new(&points, &facets).ok_or_else(|| refuse("polygon", &"a side", &"one of some width"))?;
        let cells = match cells {
            Some(cells) => cells,
            None => {
                check_layer(&points, &facets, extrusion, layer)?;
                surface.cells()
            }
        };
        let sides = surface.half_spaces()?;
        let ends = vec![plane(DVec3::Z, extrusion.level(layer + 1))?, plane(-DVec3::Z, 0.0 - extrusion.level(layer))?];
        pieces(brushes.len() as u64 + cells.len() as u64 * u64::from(extrusion.layers() - layer))?;
        brushes.extend(cells.iter().filter_map(|cell| brush_of(cell, &sides, ends.clone(), material)));
        known = Some((facets, cells));
    }
    Ok(())
}

/// The outlines of odd layers are wider by this part of their size, and those of even ones narrower. Where layers meet, their
/// outlines are the same but for rounding; so one lies within the other, and what is left of the difference are strips that are
/// thin everywhere and contracted in the mesh. Outlines that cross each other by rounding would leave corners where they cross,
/// and tunnels as wide as an ulp. Several roundings of planes that are moved later are still less, the mesh takes seventy times
/// as much for noise, and the volume stays what it was, as half of the layers gain what the others lose.
const STEP: f64 = 1.0 / (1u64 << 47) as f64;

/// An outline whose sides are moved outward by a distance, far less than any of them is long.
fn widened(shape: &[Vec<DVec2>], by: f64) -> Vec<Vec<DVec2>> {
    let outward = |from: DVec2, to: DVec2| (from - to).normalize_or_zero().perp();
    let moved = |corners: &Vec<DVec2>| {
        let n = corners.len();
        let corner = |k: usize| {
            let at = corners[k];
            let (a, b) = (outward(corners[(k + n - 1) % n], at), outward(at, corners[(k + 1) % n]));
            // where the moved sides meet, but not out of proportion at a needle's tip
            at + (a + b) / (1.0 + a.dot(b)).max(1e-3) * by
        };
        (0..n).map(corner).collect()
    };
    shape.iter().map(moved).collect()
}

/// The corners at the bottom of a layer and then those on top.
fn layer_points(shape: &[Vec<DVec2>], extrusion: &Extrusion, layer: u32) -> Vec<DVec3> {
    [layer, layer + 1]
        .into_iter()
        .flat_map(|level| shape.iter().flatten().map(move |p| extrusion.corner(*p, level)))
        .collect()
}

/// The sides of a layer: planar ones as they are, the others cut along the shorter diagonal.
fn layer_facets(shape: &[Vec<DVec2>], points: &[DVec3]) -> Facets {
    let above = points.len() as u32 / 2;
    let mut facets = Vec::new();
    let mut start = 0;
    for corners in shape {
        let n = corners.len() as u32;
        for k in 0..n {
            let (p, q) = (start + k, start + (k + 1) % n);
            facets.extend(side_facets(points, [p, q, q + above, p + above]));
        }
        start += n;
    }
    facets
}

/// One side, given by its corners counter-clockwise, the first two below.
fn side_facets(points: &[DVec3], [p, q, above_q, above_p]: [u32; 4]) -> Facets {
    let at = |k: u32| points[k as usize];
    if at(above_q) == at(above_p) {
        return vec![vec![p, q, above_q]];
    }
    // Exactly so where the outline is only stretched along an axis; where rounding comes between, triangles are exact.
    if is_planar([p, q, above_q, above_p].map(at)) {
        return vec![vec![p, q, above_q, above_p]];
    }
    let (rising, falling) = (at(p).distance(at(above_q)), at(q).distance(at(above_p)));
    if falling < rising * (1.0 - 1e-9) {
        vec![vec![p, q, above_p], vec![q, above_q, above_p]]
    } else {
        vec![vec![p, q, above_q], vec![p, above_q, above_p]]
    }
}

/// Whether four points lie exactly on one plane.
fn is_planar(points: [DVec3; 4]) -> bool {
    let [a, b, c, d] = points.map(|p| Coord3D { x: p.x, y: p.y, z: p.z });
    orient3d(a, b, c, d) == 0.0
}

/// Whether the sides of a layer pass through each other, exactly.
fn check_layer(points: &[DVec3], facets: &[Vec<u32>], extrusion: &Extrusion, layer: u32) -> Result<(), ShapeError> {
    let fan = |facet: &Vec<u32>| (1..facet.len() - 1).map(|k| [facet[0], facet[k], facet[k + 1]]).collect::<Vec<_>>();
    let triangles: Vec<[u32; 3]> = facets.iter().flat_map(fan).collect();
    let options = CheckOptions { tolerance: 1e-12, crossings: true };
    let crossings = check_mesh(points, &triangles, &options).crossings;
    if crossings.is_some_and(|report| report.first.is_some()) {
        return Err(ShapeError::CrossingSides { layer, slices: extrusion.layers() });
    }
    Ok(())
}

/// The sides of an upright prism over an outline.
pub(super) struct Lines {
    points: Vec<DVec3>,
    facets: Facets,
    is_one_loop: bool,
}

impl Lines {
    pub(super) fn of(shape: &[Vec<DVec2>]) -> Self {
        let corners = || shape.iter().flatten();
        // any height does; one like the outline's size keeps the numbers short
        let size = corners().map(|p| p.abs().max_element()).fold(0.0, f64::max);
        let height = f64::from_bits(size.to_bits() & !((1 << 52) - 1));
        let points: Vec<DVec3> = [0.0, height].into_iter().flat_map(|z| corners().map(move |p| p.extend(z))).collect();
        let above = points.len() as u32 / 2;
        let mut facets = Vec::new();
        let mut start = 0;
        for corners in shape {
            let n = corners.len() as u32;
            let side = |k: u32| (start + k, start + (k + 1) % n);
            facets.extend((0..n).map(side).map(|(p, q)| vec![p, q, q + above, p + above]));
            start += n;
        }
        Self { points, facets, is_one_loop: shape.len() == 1 }
    }

    /// The two ends of each side.
    pub(super) fn ends(&self) -> impl Iterator<Item = [DVec2; 2]> + '_ {
        (0..self.facets.len()).map(|side| self.ends_of(side))
    }

    /// Convex cells of the prism. A single convex loop is one, without asking each side about each corner.
    pub(super) fn cells(&self, surface: &Surface<'_>) -> Vec<Vec<Side>> {
        let n = self.facets.len();
        let turns = |k: usize| {
            let [p, q] = self.ends_of(k);
            let [_, r] = self.ends_of((k + 1) % n);
            let at = |p: DVec2| Coord { x: p.x, y: p.y };
            orient2d(at(p), at(q), at(r)) >= 0.0
        };
        if self.is_one_loop && (0..n).all(turns) {
            return vec![(0..n as u32).map(|facet| Side { facet, is_outer: false }).collect()];
        }
        surface.cells()
    }

    fn ends_of(&self, side: usize) -> [DVec2; 2] {
        [0, 1].map(|k| self.points[self.facets[side][k] as usize].truncate())
    }

    pub(super) fn surface(&self) -> Result<Surface<'_>, ShapeError> {
        Surface::new(&self.points, &self.facets)
            .ok_or_else(|| refuse("polygon", &"a side of no length", &"corners apart"))
    }
}
