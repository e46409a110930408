//! Moved, turned and mirrored solids.

use glam::{DMat3, DQuat, DVec3};
use planecut_cells::Solid;
use planecut_csg::{Model, Transform, evaluate};

use planecut_testkit::random::Rng;
use planecut_testkit::scene::{Scene, ensure, ensure_eq, sweep};
use planecut_testkit::shape::{Kind, Shape, bounded, ensure_close, random_shape};

fn random_motion(rng: &mut Rng) -> Transform {
    let turn = DMat3::from_quat(DQuat::from_axis_angle(rng.unit(), rng.float(0.0, 6.0)));
    let stretch = DMat3::from_diagonal(rng.point(0.5, 2.0) * rng.pick(&[1.0, -1.0]));
    Transform::new(turn * stretch, rng.point(-20.0, 20.0)).expect("an invertible map")
}

fn judge(shape: &Shape) -> Result<(), String> {
    let mut rng = Rng::spread(shape.model().tree.brushes().len() as u64);
    let motion = random_motion(&mut rng);
    let solid = Solid::from_tree(&shape.tree());
    let moved = solid.transformed(&motion).map_err(|error| error.to_string())?;
    let (volume, before) = (moved.volume().ok_or("unbounded")?, solid.volume().ok_or("unbounded")?);
    ensure_close("volume", volume, before * motion.linear().determinant().abs(), 0.1)?;
    for _ in 0..100 {
        let point = rng.point(-6.0, 6.0);
        let Some(expected) = shape.holds(point) else { continue };
        ensure!(moved.contains(motion.point(point)) == expected, "membership of {point}");
    }
    Ok(())
}

#[test]
fn moved_solids_hold_moved_points() {
    for kind in [Kind::Boxes, Kind::Sloped, Kind::Mixed] {
        let generate = |rng: &mut Rng| {
            let leaves = 1 + rng.below(6);
            bounded(random_shape(rng, kind, leaves))
        };
        sweep(60, generate, judge);
    }
}

/// Cells of boxes share walls whose planes are shared, too: turned, they still fit, and no wall shows in the skin.
#[test]
fn turned_boxes_have_the_skin_of_the_turned_tree() {
    let generate = |rng: &mut Rng| {
        let leaves = 1 + rng.below(8);
        bounded(random_shape(rng, Kind::Boxes, leaves))
    };
    sweep(60, generate, |shape| {
        let motion = random_motion(&mut Rng::spread(9));
        let Model { materials, tree } = shape.model();
        let moved = Solid::from_tree(&tree).transformed(&motion).map_err(|error| error.to_string())?;
        let tree = tree.transformed(&motion).map_err(|error| error.to_string())?;
        let skin = evaluate(&Model { materials: materials.clone(), tree }).map_err(|error| error.to_string())?;
        let (mesh, measures) = moved.mesh(&materials).map_err(|error| error.to_string())?;
        ensure_eq!(mesh.faces.len(), skin.mesh.faces.len(), "faces");
        ensure_close("area", measures.area, skin.solid.area, 1.0)
    });
}

#[test]
fn short_numbers_move_without_rounding() {
    let generate = |rng: &mut Rng| {
        let leaves = 1 + rng.below(8);
        bounded(random_shape(rng, Kind::Sloped, leaves))
    };
    sweep(60, generate, |shape| {
        let solid = Solid::from_tree(&shape.tree());
        let turn = Transform::rotation(DVec3::Z, 90.0).map_err(|error| error.to_string())?;
        let shift = Transform::translation(DVec3::new(1.0, -2.0, 3.0)).map_err(|error| error.to_string())?;
        let motion = turn.then(&shift).map_err(|error| error.to_string())?;
        let moved = solid.transformed(&motion).map_err(|error| error.to_string())?;
        let by_tree = Solid::from_tree(&shape.tree().transformed(&motion).map_err(|error| error.to_string())?);
        ensure!((&moved ^ &by_tree).is_empty(), "the moved solid is not that of the moved tree");
        let mirrored = solid.mirrored(DVec3::X).and_then(|image| image.mirrored(DVec3::X));
        ensure!((&mirrored.map_err(|error| error.to_string())? ^ &solid).is_empty(), "mirrored twice");
        Ok(())
    });
}
