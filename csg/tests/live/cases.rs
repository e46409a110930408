//! Edits that easily go wrong.

use planecut_csg::{Brush, EditError, EvaluateError, LiveModel, Material, MaterialId, Role};
use planecut_kernel::{DVec3, HalfSpace};

fn cuboid(min: [f64; 3], max: [f64; 3]) -> Brush {
    Brush::cuboid(DVec3::from_array(min), DVec3::from_array(max), MaterialId(0))
}

fn model() -> LiveModel {
    LiveModel::new(vec![Material::named("stone")])
}

#[test]
fn refused_edits_leave_the_model_as_it_was() {
    let mut live = model();
    let (block, _) = live.add_brush(cuboid([0.0; 3], [2.0; 3]), Role::Add).unwrap();
    let (hole, _) = live.add_brush(cuboid([1.0; 3], [3.0; 3]), Role::Subtract).unwrap();
    let before = live.mesh().unwrap();
    let open = Brush::from_half_spaces([HalfSpace::new(DVec3::X, 1.0).unwrap()], MaterialId(0));
    let unknown = Brush::cuboid(DVec3::ZERO, DVec3::ONE, MaterialId(1));
    assert_eq!(live.add_brush(open.clone(), Role::Add), Err(EditError::Unbounded));
    assert_eq!(live.replace_brush(block, open.clone()), Err(EditError::Unbounded));
    assert_eq!(
        live.add_brushes(vec![(cuboid([5.0; 3], [6.0; 3]), Role::Add), (open, Role::Add)]),
        Err(EditError::Unbounded)
    );
    let refused = EditError::Evaluate(EvaluateError::UnknownMaterial { material: MaterialId(1), count: 1 });
    assert_eq!(live.replace_brush(hole, unknown), Err(refused));
    assert_eq!(live.mesh().unwrap(), before);
    live.remove_brush(hole).unwrap();
    assert_eq!(live.remove_brush(hole), Err(EditError::UnknownBrush));
    let (other, _) = live.add_brush(cuboid([0.0; 3], [1.0; 3]), Role::Add).unwrap();
    assert_eq!(live.set_role(hole, Role::Add), Err(EditError::UnknownBrush));
    live.remove_brush(other).unwrap();
    assert_eq!(live.triangle_count(), 12);
}

#[test]
fn an_emptied_brush_comes_back() {
    let mut live = model();
    let (block, _) = live.add_brush(cuboid([0.0; 3], [2.0; 3]), Role::Add).unwrap();
    let (hole, _) = live.add_brush(cuboid([0.5; 3], [1.5; 3]), Role::Subtract).unwrap();
    let before = live.mesh().unwrap();
    live.replace_brush(block, cuboid([1.0; 3], [1.0; 3])).unwrap();
    assert_eq!(live.triangle_count(), 0);
    live.replace_brush(block, cuboid([0.0; 3], [2.0; 3])).unwrap();
    assert_eq!(live.mesh().unwrap(), before);
    live.replace_brush(hole, cuboid([0.0; 3], [0.0; 3])).unwrap();
    assert_eq!(live.triangle_count(), 12);
}

#[test]
fn an_intersection_that_goes_brings_back_what_is_far_from_it() {
    let mut live = model();
    live.add_brush(cuboid([10.0; 3], [12.0; 3]), Role::Add).unwrap();
    let (window, change) = live.add_brush(cuboid([0.0; 3], [1.0; 3]), Role::Intersect).unwrap();
    assert_eq!((change.removed.len(), live.triangle_count()), (6, 0));
    live.add_brush(cuboid([11.0; 3], [13.0; 3]), Role::Add).unwrap();
    assert_eq!(live.triangle_count(), 12);
    live.remove_brush(window).unwrap();
    let both = live.mesh().unwrap();
    let mut anew = model();
    anew.add_brushes(vec![(cuboid([10.0; 3], [12.0; 3]), Role::Add), (cuboid([11.0; 3], [13.0; 3]), Role::Add)])
        .unwrap();
    assert_eq!(anew.mesh().unwrap(), both);
}

#[test]
fn a_change_names_only_what_changed() {
    let mut live = model();
    let row =
        (0..20).map(|k| (cuboid([4.0 * f64::from(k), 0.0, 0.0], [4.0 * f64::from(k) + 1.0, 1.0, 1.0]), Role::Add));
    let (ids, change) = live.add_brushes(row.collect()).unwrap();
    assert_eq!((change.removed.len(), change.added.len()), (0, 120));
    let change = live.replace_brush(ids[7], cuboid([28.0, 0.0, 0.0], [29.0, 1.0, 2.0])).unwrap();
    // all but the bottom, which stays
    assert_eq!((change.removed.len(), change.added.len()), (5, 5));
    let change = live.replace_brush(ids[7], cuboid([28.0, 0.0, 0.0], [29.0, 1.0, 2.0])).unwrap();
    assert_eq!((change.removed.len(), change.added.len()), (0, 0));
}
