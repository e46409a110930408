//! Outlines extruded along z.

use planecut_csg::{Brush, MaterialId, Tree, sine_and_cosine};
use planecut_kernel::{DVec2, DVec3, HalfSpace, IncrementalPolytope};

use super::cells::PlaneSide;
use super::layers;
use super::pockets::{HullAndPockets, hull_and_pockets};
use super::region::Region;
use super::simple::plane;
use super::walls::Walls;
use crate::outline::Outline;
use crate::parameter::{MAX_SEGMENTS, ShapeError, angle, not_negative, positive, refuse};

/// By whose rules layers are turned, stretched and bounded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum LayerRules {
    /// Those of `docs/model-file.md`: corners are stretched, then turned. A side that is not planar is cut along its shorter
    /// diagonal; of two that are equal up to `1e-9`, along the one that begins where the side does.
    #[default]
    ModelFile,
    /// Those of OpenSCAD 2021.01: corners are turned, then stretched. A side that is not planar is cut along its shorter
    /// diagonal; of two that are equal up to `1e-5`, along the one that leans as the twist does. Below a top of no width the
    /// longer one is taken.
    OpenScad,
}

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
    /// How layers are made.
    pub rules: LayerRules,
}

impl Extrusion {
    /// Straight up from z = 0.
    #[must_use]
    pub fn straight(height: f64) -> Self {
        let rules = LayerRules::ModelFile;
        Self { height, twist: 0.0, scale: DVec2::ONE, slices: None, center: false, rules }
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

    pub(super) fn layers(&self) -> u32 {
        self.slices.unwrap_or(1)
    }

    /// The height of a layer's bottom.
    pub(super) fn level(&self, layer: u32) -> f64 {
        let height = self.height * f64::from(layer) / f64::from(self.layers());
        if self.center { height - 0.5 * self.height } else { height }
    }

    /// Where a corner of the outline is at the bottom of a layer.
    pub(super) fn corner(&self, corner: DVec2, layer: u32) -> DVec3 {
        let (j, k) = (f64::from(layer), f64::from(self.layers()));
        let scale = if layer == self.layers() { self.scale } else { DVec2::ONE + (self.scale - DVec2::ONE) * j / k };
        let (sine, cosine) = sine_and_cosine(-self.twist * j / k);
        let turned = |p: DVec2| DVec2::new(cosine * p.x - sine * p.y, sine * p.x + cosine * p.y);
        let p = match self.rules {
            LayerRules::ModelFile => turned(corner * scale),
            // a zero of either sign is one
            LayerRules::OpenScad => turned(corner) * scale + DVec2::ZERO,
        };
        p.extend(self.level(layer))
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

/// An outline extruded along z, as `docs/model-file.md` states it, or as OpenSCAD does: unions of convex cells whose common
/// walls are the same plane seen from both sides, without what is over holes.
///
/// # Errors
/// [`ShapeError::Parameter`] where a parameter is not accepted, [`ShapeError::CrossingSides`] where the sides of one slice
/// pass through each other, and [`ShapeError::TooLarge`].
pub fn extrude(outline: &Outline, extrusion: &Extrusion, material: MaterialId) -> Result<Tree, ShapeError> {
    let extrusion = extrusion.accepted()?;
    let mut region = Region::default();
    for shape in outline.shapes() {
        if extrusion.is_straight() {
            let loops = shape.iter().map(|corners| straight(corners, &extrusion, material));
            region.add(loops.collect::<Result<Vec<_>, ShapeError>>()?)?;
        } else {
            region.add(layers::layered(shape, &extrusion, material, region.count())?)?;
        }
    }
    Ok(region.into_tree())
}

/// Sides that are planar, whatever the slices.
fn straight(corners: &[DVec2], extrusion: &Extrusion, material: MaterialId) -> Result<Vec<Tree>, ShapeError> {
    let ends = ends(extrusion, 0, extrusion.layers())?;
    if let Some(HullAndPockets { hull, pockets }) = hull_and_pockets(corners)? {
        let body = |walls: &Vec<HalfSpace>| {
            let sides = walls.iter().map(|side| tilted(side, extrusion)).collect::<Result<Vec<_>, _>>()?;
            Ok(Tree::from(Brush::from_half_spaces(ends.iter().copied().chain(sides), material)))
        };
        let bodies = std::iter::once(&hull).chain(&pockets).map(body).collect::<Result<Vec<_>, ShapeError>>()?;
        return Ok(vec![Tree::difference(bodies)]);
    }
    let walls = Walls::over(corners)?;
    let sides = walls.half_spaces.iter().map(|side| tilted(side, extrusion)).collect::<Result<Vec<_>, _>>()?;
    let brush = |cell: &Vec<PlaneSide>| {
        let half_spaces = ends.iter().copied().chain(half_spaces(cell, &sides));
        Tree::from(Brush::from_half_spaces(half_spaces, material))
    };
    Ok(walls.cells()?.iter().map(brush).collect())
}

/// The planes on top of and below layers.
pub(super) fn ends(extrusion: &Extrusion, from: u32, to: u32) -> Result<[HalfSpace; 2], ShapeError> {
    Ok([plane(DVec3::Z, extrusion.level(to))?, plane(-DVec3::Z, 0.0 - extrusion.level(from))?])
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

/// The half-spaces of a cell.
pub(super) fn half_spaces<'a>(cell: &'a [PlaneSide], planes: &'a [HalfSpace]) -> impl Iterator<Item = HalfSpace> + 'a {
    cell.iter().map(|side| {
        let half_space = planes[side.facet as usize];
        if side.is_outer { half_space.flipped() } else { half_space }
    })
}

/// The convex body on these sides of planes and within others; `None` where there is none, and without the planes that have
/// no face.
pub(super) fn brush_of(
    cell: &[PlaneSide],
    planes: &[HalfSpace],
    others: &[HalfSpace],
    material: MaterialId,
) -> Option<Brush> {
    let mut polytope = IncrementalPolytope::with_epsilon(0.0);
    for half_space in others.iter().copied().chain(half_spaces(cell, planes)) {
        polytope.add_plane(half_space);
    }
    let faces: Vec<HalfSpace> =
        polytope.facets().into_iter().filter_map(|(plane, _)| polytope.plane(plane).copied()).collect();
    (!faces.is_empty()).then(|| Brush::from_half_spaces(faces, material))
}
