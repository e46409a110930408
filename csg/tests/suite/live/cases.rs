//! Edits that easily go wrong.

use planecut_csg::{
    Brush, BrushId, Edit, EditError, EvaluateError, LiveModel, Material, MaterialId, Model, Role, Tree, evaluate,
};
use planecut_kernel::{DVec3, HalfSpace, PlaneIdx};

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
    let unbounded = EditError::Evaluate(EvaluateError::Unbounded);
    let unknown = Brush::cuboid(DVec3::ZERO, DVec3::ONE, MaterialId(1));
    assert_eq!(live.add_brush(open.clone(), Role::Add), Err(unbounded));
    assert_eq!(live.replace_brush(block, open.clone()), Err(unbounded));
    assert_eq!(live.add_brushes(vec![(cuboid([5.0; 3], [6.0; 3]), Role::Add), (open, Role::Add)]), Err(unbounded));
    let refused = EditError::Evaluate(EvaluateError::UnknownMaterial { material: MaterialId(1), count: 1 });
    assert_eq!(live.replace_brush(hole, unknown), Err(refused));
    assert_eq!(live.mesh().unwrap(), before);
    live.remove_brush(hole).unwrap();
    assert_eq!(live.remove_brush(hole), Err(EditError::UnknownBrush(hole)));
    let (other, _) = live.add_brush(cuboid([0.0; 3], [1.0; 3]), Role::Add).unwrap();
    assert_eq!(live.set_role(hole, Role::Add), Err(EditError::UnknownBrush(hole)));
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
    let mut fresh = model();
    fresh
        .add_brushes(vec![(cuboid([10.0; 3], [12.0; 3]), Role::Add), (cuboid([11.0; 3], [13.0; 3]), Role::Add)])
        .unwrap();
    assert_eq!(fresh.mesh().unwrap(), both);
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

#[test]
fn a_brush_whose_removal_is_refused_is_the_same_one_later() {
    let half = Brush::from_half_spaces([HalfSpace::new(DVec3::X, 1.0).unwrap()], MaterialId(0));
    let mut live = model();
    live.add_brushes(vec![(half, Role::Add), (cuboid([0.0; 3], [2.0; 3]), Role::Intersect)]).unwrap();
    let bounding_box = BrushId(1);
    let unbounded = EditError::Evaluate(EvaluateError::Unbounded);
    assert_eq!(live.remove_brush(bounding_box), Err(unbounded));
    assert_eq!(live.set_role(bounding_box, Role::Subtract), Err(unbounded));
    let before = live.mesh().unwrap();
    let change = live.replace_brush(bounding_box, cuboid([0.0; 3], [0.5; 3])).unwrap();
    assert_eq!((change.brushes, change.removed.len(), live.triangle_count()), (vec![bounding_box], 6, 12));
    live.undo().unwrap();
    assert_eq!(live.mesh().unwrap(), before);
}

#[test]
fn brushes_and_planes_are_never_given_a_number_twice() {
    let mut live = model();
    let (first, _) = live.add_brush(cuboid([0.0; 3], [1.0; 3]), Role::Add).unwrap();
    live.undo().unwrap();
    let (second, _) = live.add_brush(cuboid([0.0; 3], [1.0; 3]), Role::Add).unwrap();
    assert_eq!((first, second), (BrushId(0), BrushId(1)));
    let cut = HalfSpace::new(DVec3::ONE, 1.0).unwrap();
    let (sixth, _) = live.add_plane(second, cut, MaterialId(0)).unwrap();
    live.undo().unwrap();
    let (seventh, _) = live.add_plane(second, cut, MaterialId(0)).unwrap();
    assert_eq!(
        (sixth, seventh, live.planes(second).unwrap()),
        (PlaneIdx(6), PlaneIdx(7), &[0, 1, 2, 3, 4, 5, 7].map(PlaneIdx)[..])
    );
    assert_eq!(live.remove_plane(second, sixth), Err(EditError::UnknownPlane { brush: second, plane: sixth }));
    live.remove_plane(second, seventh).unwrap();
    assert_eq!(live.remove_plane(second, seventh), Err(EditError::UnknownPlane { brush: second, plane: seventh }));
    let (third, _) = live.add_brush(cuboid([5.0; 3], [6.0; 3]), Role::Add).unwrap();
    live.add_plane(third, cut, MaterialId(0)).unwrap();
    (0..2).for_each(|_| drop(live.undo().unwrap()));
    live.redo().unwrap();
    assert_eq!(live.add_plane(third, cut, MaterialId(0)).unwrap().0, PlaneIdx(7));
    live.remove_brush(third).unwrap();
    assert_eq!(
        live.apply(Edit::MovePlane { brush: second, plane: PlaneIdx(0), offset: f64::NAN })
            .map_err(|error| error.to_string().starts_with("found a plane")),
        Err(true)
    );
    assert_eq!(live.triangle_count(), 12);
}

#[test]
fn brushes_of_nested_operations_are_edited_where_they_are() {
    let cube = |min: f64, max: f64| Tree::from(cuboid([min; 3], [max; 3]));
    let tree = (cube(0.0, 3.0) - cube(1.0, 2.0)) | (cube(1.0, 2.5) ^ cube(1.25, 1.75));
    let materials = vec![Material::named("stone")];
    let mut live = LiveModel::from_model(Model { materials: materials.clone(), tree: tree.clone() }).unwrap();
    let fresh = |tree: &Tree| evaluate(&Model { materials: materials.clone(), tree: tree.clone() }).unwrap().mesh;
    assert_eq!(live.mesh().unwrap(), fresh(&tree));
    let mut brushes: Vec<Tree> = tree.brushes().iter().cloned().map(Tree::from).collect();
    let nested = |b: &[Tree]| (b[0].clone() - b[1].clone()) | (b[2].clone() ^ b[3].clone());
    let new = cuboid([0.5, 0.5, -1.0], [0.75, 2.75, 4.0]);
    live.replace_brush(BrushId(1), new.clone()).unwrap();
    brushes[1] = new.into();
    assert_eq!(live.mesh().unwrap(), fresh(&nested(&brushes)));
    live.remove_brush(BrushId(0)).unwrap();
    brushes[0] = Tree::empty();
    assert_eq!(live.mesh().unwrap(), fresh(&nested(&brushes)));
    assert_eq!(evaluate(&live.to_model()).unwrap().mesh, fresh(&nested(&brushes)));
    assert_eq!(live.set_role(BrushId(2), Role::Subtract), Err(EditError::Nested(BrushId(2).into())));
    let (last, _) = live.add_brush(cuboid([2.0; 3], [5.0; 3]), Role::Subtract).unwrap();
    assert_eq!((last, live.mesh().unwrap()), (BrushId(4), fresh(&(nested(&brushes) - cube(2.0, 5.0)))));
    (0..3).for_each(|_| drop(live.undo().unwrap()));
    assert_eq!((live.undo(), live.mesh().unwrap()), (Err(EditError::NothingToUndo), fresh(&tree)));
    let unbounded = LiveModel::from_model(Model { materials, tree: !cube(0.0, 1.0) }).err();
    assert_eq!(unbounded, Some(EditError::Evaluate(EvaluateError::Unbounded)));
}
