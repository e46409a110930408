//! Several edits as one step: what undo and redo make of it, and what is left where it is cancelled.

use planecut_csg::{Brush, BrushId, EditError, LiveModel, Material, MaterialId, Role};
use planecut_kernel::{DVec3, HalfSpace, PlaneIdx};
use planecut_testkit::random::Rng;

use super::edits::{Viewer, triangles_of};

fn cuboid(min: [f64; 3], max: [f64; 3]) -> Brush {
    Brush::cuboid(DVec3::from_array(min), DVec3::from_array(max), MaterialId(0))
}

fn plane(normal: DVec3, offset: f64) -> HalfSpace {
    HalfSpace::new(normal, offset).expect("a plane")
}

/// A block with a hole, made by two edits.
fn block_with_hole() -> (LiveModel, BrushId, BrushId) {
    let mut live = LiveModel::new(vec![Material::named("stone"), Material::named("brass")]);
    let (block, _) = live.add_brush(cuboid([0.0; 3], [4.0; 3]), Role::Add).unwrap();
    let (hole, _) = live.add_brush(cuboid([1.0, 1.0, -1.0], [2.0, 2.0, 5.0]), Role::Subtract).unwrap();
    (live, block, hole)
}

#[test]
fn a_drag_is_one_step_and_pushes_no_older_ones_out() {
    let (mut live, block, _) = block_with_hole();
    live.set_history_limit(3);
    let before = live.mesh().unwrap();
    live.begin_step().unwrap();
    for k in 0..500 {
        let change = live.move_plane(block, PlaneIdx(0), plane(DVec3::X, 4.0 + f64::from(k) / 64.0)).unwrap();
        assert!(k == 0 || !change.added.is_empty(), "each move is visible at once");
        assert_eq!(live.history_len(), (2, 0));
    }
    assert!(live.is_step_open() && live.commit_step().unwrap() && !live.is_step_open());
    assert_eq!(live.history_len(), (3, 0));
    let after = live.mesh().unwrap();
    live.undo().unwrap();
    assert_eq!(live.mesh().unwrap(), before);
    live.redo().unwrap();
    assert_eq!(live.mesh().unwrap(), after);
    (0..3).for_each(|_| drop(live.undo().unwrap()));
    assert_eq!(live.brushes().len(), 0);
    assert_eq!(live.undo(), Err(EditError::NothingToUndo));
}

#[test]
fn a_step_that_changes_nothing_in_the_end_is_none_and_leaves_what_can_be_redone() {
    let (mut live, block, hole) = block_with_hole();
    live.remove_brush(hole).unwrap();
    live.undo().unwrap();
    let before = live.mesh().unwrap();
    live.begin_step().unwrap();
    assert!(!live.commit_step().unwrap(), "no edits");
    live.begin_step().unwrap();
    live.move_plane(block, PlaneIdx(0), plane(DVec3::X, 9.0)).unwrap();
    let (cut, _) = live.add_plane(block, plane(DVec3::ONE, 5.0), MaterialId(1)).unwrap();
    let (other, _) = live.add_brush(cuboid([7.0; 3], [8.0; 3]), Role::Add).unwrap();
    live.remove_brush(other).unwrap();
    live.remove_plane(block, cut).unwrap();
    live.move_plane(block, PlaneIdx(0), plane(DVec3::X, 4.0)).unwrap();
    assert!(!live.commit_step().unwrap(), "edits that take each other back");
    assert_eq!((live.mesh().unwrap(), live.history_len()), (before, (2, 1)));
    live.redo().unwrap();
    assert_eq!(live.brushes().collect::<Vec<_>>(), [block]);
    let (next, _) = live.add_plane(block, plane(DVec3::ONE, 5.0), MaterialId(1)).unwrap();
    assert_eq!(next.0, cut.0 + 1, "no handle is given twice");
}

#[test]
fn a_step_that_is_cancelled_leaves_the_model_and_both_ways_of_its_history() {
    let (mut live, block, hole) = block_with_hole();
    let mut viewer = Viewer::default();
    let all = planecut_csg::Change { added: live.faces().map(|(id, _)| id).collect(), ..Default::default() };
    viewer.follow(&live, &all).unwrap();
    let change = live.set_role(hole, Role::Add).unwrap();
    viewer.follow(&live, &change).unwrap();
    let change = live.undo().unwrap();
    viewer.follow(&live, &change).unwrap();
    let before = live.mesh().unwrap();
    live.begin_step().unwrap();
    let change = live.remove_brush(hole).unwrap();
    viewer.follow(&live, &change).unwrap();
    let change = live.add_brush(cuboid([3.0; 3], [6.0; 3]), Role::Add).unwrap().1;
    viewer.follow(&live, &change).unwrap();
    let change = live.move_plane(block, PlaneIdx(2), plane(DVec3::Y, 3.0)).unwrap();
    viewer.follow(&live, &change).unwrap();
    let seen: Vec<_> = live.brushes().collect();
    assert_eq!(seen, [block, BrushId(2)]);
    let change = live.cancel_step().unwrap();
    viewer.follow(&live, &change).unwrap();
    assert_eq!(viewer.triangles(), triangles_of(&before));
    assert_eq!((live.mesh().unwrap(), live.history_len()), (before.clone(), (2, 1)));
    live.redo().unwrap();
    assert_eq!(live.brush(hole).unwrap().1, Role::Add);
    live.undo().unwrap();
    assert_eq!(live.mesh().unwrap(), before);
}

#[test]
fn calls_that_do_not_fit_an_open_step_are_refused() {
    let (mut live, block, _) = block_with_hole();
    assert_eq!(live.commit_step(), Err(EditError::NoStep));
    assert_eq!(live.cancel_step(), Err(EditError::NoStep));
    live.begin_step().unwrap();
    live.remove_brush(block).unwrap();
    assert_eq!(live.begin_step(), Err(EditError::StepOpen));
    assert_eq!((live.undo(), live.redo()), (Err(EditError::StepOpen), Err(EditError::StepOpen)));
    let open = Brush::from_half_spaces([plane(DVec3::X, 1.0)], MaterialId(0));
    live.add_brush(open, Role::Add).unwrap_err();
    assert_eq!(live.brushes().len(), 1);
    assert_eq!(live.commit_step(), Ok(true), "a refused edit leaves the step open");
    live.undo().unwrap();
    assert_eq!(live.brushes().len(), 2);
}

#[test]
fn random_steps_are_undone_and_redone_as_one_and_their_changes_can_be_followed() {
    let mut committed = 0;
    for seed in 0..40 {
        let rng = &mut Rng::spread(seed);
        let (mut live, mut viewer) = (LiveModel::new(vec![Material::named("stone")]), Viewer::default());
        let mut meshes = vec![live.mesh().unwrap()];
        for _ in 0..6 {
            live.begin_step().unwrap();
            for _ in 0..1 + rng.below(5) {
                let brushes: Vec<BrushId> = live.brushes().collect();
                let low = [0; 3].map(|_| rng.whole(0, 4));
                let high = low.map(|low| low + rng.whole(1, 3));
                let change = match rng.below(4) {
                    0 if !brushes.is_empty() => live.remove_brush(rng.pick(&brushes)).unwrap(),
                    1 if !brushes.is_empty() => live.replace_brush(rng.pick(&brushes), cuboid(low, high)).unwrap(),
                    2 if !brushes.is_empty() => live.set_role(rng.pick(&brushes), Role::Subtract).unwrap(),
                    _ => live.add_brush(cuboid(low, high), Role::Add).unwrap().1,
                };
                viewer.follow(&live, &change).unwrap();
            }
            if rng.chance(0.3) {
                let change = live.cancel_step().unwrap();
                viewer.follow(&live, &change).unwrap();
                assert_eq!(Some(&live.mesh().unwrap()), meshes.last(), "seed {seed}");
            } else if live.commit_step().unwrap() {
                meshes.push(live.mesh().unwrap());
                committed += 1;
            }
            let drawn = viewer.triangles();
            let mesh = triangles_of(&live.mesh().unwrap());
            assert!(drawn.len() != mesh.len() || drawn == mesh, "seed {seed}: the faces are those of the mesh");
        }
        assert_eq!(live.history_len(), (meshes.len() - 1, 0));
        for mesh in meshes.iter().rev().skip(1) {
            let change = live.undo().unwrap();
            viewer.follow(&live, &change).unwrap();
            assert_eq!(&live.mesh().unwrap(), mesh, "seed {seed}: undone");
        }
        for mesh in &meshes[1..] {
            let change = live.redo().unwrap();
            viewer.follow(&live, &change).unwrap();
            assert_eq!(&live.mesh().unwrap(), mesh, "seed {seed}: redone");
        }
    }
    assert!(committed > 120, "{committed}");
}
