//! Solids from regions of the plane.

use planecut_csg::outline::Outline;
use planecut_csg::primitives::{self, Extrusion, LayerRules};
use planecut_csg::{ShapeError, Transform, Tree};
use planecut_kernel::{DVec2, DVec3};

use super::arguments::Arguments;
use super::evaluate::{Evaluator, Turn};
use super::fragments::{Fragments, TooMany};
use super::problem::{Geometry, Made, Problem};
use super::solid;

/// `linear_extrude`: an outline drawn up along z, turned and stretched on the way.
pub(super) fn linear(turn: Turn<'_, '_>, outline: &Outline) -> Made {
    let arguments = Arguments::of(turn.node, &["height"]);
    refuse_file(&arguments)?;
    let height = arguments.number_or("height", 100.0);
    if outline.is_empty() || !(height > 0.0 && height.is_finite()) {
        return Ok(Some(Tree::empty().into()));
    }
    let scale = DVec2::from_array(arguments.size::<2>("scale")).max(DVec2::ZERO);
    let twist = arguments.number("twist").filter(|twist| twist.is_finite()).unwrap_or(0.0);
    let extrusion = Extrusion {
        height,
        twist,
        scale,
        slices: Some(slices(&arguments, outline, height, twist, scale)?),
        center: arguments.is_set("center"),
        rules: LayerRules::OpenScad,
    };
    Ok(Some(primitives::extrude(outline, &extrusion, turn.frame.material)?.into()))
}

fn slices(
    arguments: &Arguments<'_, '_>,
    outline: &Outline,
    height: f64,
    twist: f64,
    scale: DVec2,
) -> Result<u32, TooMany> {
    if let Some(slices) = arguments.number("slices") {
        let slices = slices.max(1.0);
        return if slices <= f64::from(primitives::MAX_SEGMENTS) { Ok(slices as u32) } else { Err(TooMany(slices)) };
    }
    let fragments = Fragments::of(arguments);
    let corners = || outline.loops().flatten();
    if arguments.number("twist").is_some() {
        let reach = corners().map(|p| p.length()).fold(0.0, f64::max);
        return fragments.twisted(reach, height, twist, scale);
    }
    if scale.x != scale.y {
        let shift = corners().map(|p| (*p - *p * scale).length()).fold(0.0, f64::max);
        return fragments.stretched(shift, height);
    }
    Ok(1)
}

/// `rotate_extrude`: an outline turned about z; its x is the distance from the axis, its y becomes z.
pub(super) fn rotational(evaluator: &mut Evaluator<'_, '_>, turn: Turn<'_, '_>, outline: Outline) -> Made {
    let arguments = Arguments::of(turn.node, &["angle"]);
    refuse_file(&arguments)?;
    let angle = arguments.number("angle").filter(|angle| angle.abs() <= 360.0).unwrap_or(360.0);
    if angle == 0.0 || outline.is_empty() {
        return Ok(None);
    }
    let (least, most) = outline.loops().flatten().fold((0.0f64, 0.0f64), |(a, b), p| (a.min(p.x), b.max(p.x)));
    if least < 0.0 && most > 0.0 {
        evaluator.warn(turn, format!("an outline on both sides of the axis (x from {least} to {most}) is left out"));
        return Ok(None);
    }
    let fragments = Fragments::of(&arguments);
    let steps = fragments.along_arc(most - least, angle)?;
    let mirror = |factors: DVec2| outline.transformed(glam::DMat2::from_diagonal(factors), DVec2::ZERO);
    let outline = if least < 0.0 { mirror(DVec2::new(-1.0, 1.0))? } else { outline };
    let tree = primitives::revolve(&outline, angle.abs(), steps, turn.frame.material)?;
    // whole turns begin on the other side
    let is_turned = (least < 0.0) != (angle == 360.0);
    let along = if is_turned { -1.0 } else { 1.0 };
    let sense = if angle < 0.0 { -along } else { along };
    let map = Transform::scale(DVec3::new(along, sense, 1.0)).map_err(ShapeError::from)?;
    Ok(Some(Geometry::Solid(solid::moved(tree.into(), &map)?)))
}

/// Old trees name a drawing to extrude.
fn refuse_file(arguments: &Arguments<'_, '_>) -> Result<(), Problem> {
    match arguments.text("file").filter(|file| !file.is_empty()) {
        Some(file) => Err(Problem::new(format!("the drawing `{file}`, which is not supported"), "children to extrude")),
        None => Ok(()),
    }
}
