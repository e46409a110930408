//! Previews, and where a plane snaps to: right, and nothing is changed by them.

use planecut_csg::{
    Brush, BrushId, Edit, EditError, FaceId, LiveModel, Material, MaterialId, Model, Operation, PlaneRemoval, Role,
    SnapOptions, SnapTarget, Transform, Tree, evaluate,
};
use planecut_kernel::{DVec3, HalfSpace, PlaneIdx};
use planecut_testkit::random::Rng;

use super::edits::{Viewer, triangles_of};

fn cuboid(min: [f64; 3], max: [f64; 3]) -> Brush {
    Brush::cuboid(DVec3::from_array(min), DVec3::from_array(max), MaterialId(0))
}

fn model() -> LiveModel {
    LiveModel::new(vec![Material::named("stone"), Material::named("brass")])
}

/// A face as it is seen: its number, its material, and its corners by number and place.
type Seen = (FaceId, MaterialId, Vec<[(u32, [u64; 3]); 3]>);

/// All that can be seen of a model.
#[derive(PartialEq)]
struct All {
    faces: Vec<Seen>,
    model: Model,
    history: (usize, usize),
    is_step_open: bool,
    planes: Vec<Vec<PlaneIdx>>,
}

fn seen(live: &LiveModel) -> All {
    let face = |id: FaceId, face: planecut_csg::LiveFace<'_>| {
        let triangles =
            face.triangles().map(|corners| corners.map(|(vertex, at)| (vertex, at.to_array().map(f64::to_bits))));
        (id, face.material(), triangles.collect())
    };
    let planes = live.brushes().map(|brush| live.planes(brush).unwrap().to_vec()).collect();
    let faces = live.faces().map(|(id, of)| face(id, of)).collect();
    let (model, history, is_step_open) = (live.to_model(), live.history_len(), live.is_step_open());
    All { faces, model, history, is_step_open, planes }
}

fn random_edit(rng: &mut Rng, live: &LiveModel) -> Edit {
    let brushes: Vec<BrushId> = live.brushes().collect();
    let low = [0; 3].map(|_| rng.whole(0, 4));
    let brush = cuboid(low, low.map(|low| low + rng.whole(1, 3)));
    let role = rng.pick(&[Role::Add, Role::Subtract]);
    if brushes.len() < 2 {
        return Edit::AddBrush { brush, role };
    }
    let at = rng.pick(&brushes);
    match rng.below(9) {
        0 => Edit::AddBrush { brush, role },
        1 => Edit::RemoveBrush { brush: at },
        2 => Edit::ReplaceBrush { brush: at, by: brush },
        3 => Edit::SetRole { operand: at.into(), role },
        4 => Edit::MovePlane { brush: at, plane: PlaneIdx(rng.below(6)), offset: rng.whole(-2, 6) },
        5 => Edit::RemovePlane { brush: at, plane: PlaneIdx(rng.below(6)) },
        6 => {
            Edit::CopyBrushes { brushes: vec![at], transform: Transform::translation(DVec3::from_array(low)).unwrap() }
        }
        7 => Edit::Wrap { operands: vec![at.into(), brushes[0].into()], operation: Operation::Xor },
        _ => Edit::Undo,
    }
}

#[test]
fn a_preview_tells_what_the_edit_does_and_leaves_the_model_as_it_was() {
    let mut previews = 0;
    for seed in 0..40 {
        let rng = &mut Rng::spread(seed);
        let (mut live, mut twin, mut viewer) = (model(), model(), Viewer::default());
        for step in 0..25 {
            let case = format!("seed {seed}, edit {step}");
            let edit = random_edit(rng, &live);
            let before = seen(&live);
            let volume = evaluate(&live.to_model()).unwrap().solid.volume;
            let preview = live.preview(edit.clone());
            assert!(seen(&live) == before, "{case}: it stays as it is");
            let (done, of_twin) = (live.apply(edit.clone()), twin.apply(edit));
            assert_eq!(done, of_twin, "{case}: numbers to come are those of a model without a preview");
            assert!(seen(&live) == seen(&twin), "{case}");
            let (preview, edited) = match (preview, done) {
                (Ok(preview), Ok(edited)) => (preview, edited),
                (preview, done) => {
                    assert_eq!(preview.map(drop), done.map(drop), "{case}");
                    continue;
                }
            };
            viewer.follow(&live, &edited.change).unwrap();
            assert_eq!(
                (&preview.removed, &preview.brushes),
                (&edited.change.removed, &edited.change.brushes),
                "{case}"
            );
            let added = edited.change.added.iter().map(|face| live.face(*face).unwrap());
            assert!(
                added.clone().map(|face| (face.material(), face.indexed())).eq(preview
                    .added
                    .iter()
                    .map(|face| (face.material, (face.positions.clone(), face.triangles.clone())))),
                "{case}: the faces to come"
            );
            let grown = evaluate(&live.to_model()).unwrap().solid.volume - volume;
            assert!((preview.volume_change - grown).abs() < 1e-9, "{case}: {} for {grown}", preview.volume_change);
            previews += 1;
        }
        let (drawn, mesh) = (viewer.triangles(), triangles_of(&live.mesh().unwrap()));
        assert!(drawn.len() != mesh.len() || drawn == mesh, "seed {seed}");
    }
    assert!(previews > 700, "{previews}");
}

#[test]
fn a_preview_within_a_step_leaves_the_step_open() {
    let mut live = model();
    let (block, _) = live.add_brush(cuboid([0.0; 3], [2.0; 3]), Role::Add).unwrap();
    live.begin_step().unwrap();
    live.move_plane(block, PlaneIdx(0), HalfSpace::new(DVec3::X, 3.0).unwrap()).unwrap();
    let preview = live.preview(Edit::CancelStep).unwrap();
    assert_eq!((preview.volume_change, preview.added.len(), live.is_step_open()), (-4.0, 5, true));
    let glass = Edit::SetMaterial { brush: block, plane: None, material: MaterialId(2) };
    assert_eq!(live.preview_with(glass.clone(), vec![Material::named("glass")]).unwrap().added.len(), 6);
    assert!(live.preview(glass).is_err() && live.materials().len() == 2);
    live.cancel_step().unwrap();
}

#[test]
fn the_gain_of_a_removed_plane_is_what_the_removal_adds() {
    let (mut gains, mut unbounded, mut nothing) = (0, 0, 0);
    for seed in 0..60 {
        let rng = &mut Rng::spread(seed);
        let mut live = model();
        let (brush, _) = live.add_brush(cuboid([0.0; 3], [4.0; 3]), Role::Add).unwrap();
        for _ in 0..rng.below(12) {
            let normal = DVec3::from_array([0; 3].map(|_| rng.whole(-3, 3)));
            if let Ok(half_space) = HalfSpace::new(normal, normal.dot(DVec3::splat(2.0)) + rng.whole(0, 6)) {
                live.add_plane(brush, half_space, MaterialId(1)).unwrap();
            }
        }
        let body = |live: &LiveModel| evaluate(&live.to_model()).unwrap();
        let before = body(&live).solid.volume;
        for plane in live.planes(brush).unwrap().to_vec() {
            let state = seen(&live);
            let removal = live.preview_remove_plane(brush, plane).unwrap();
            assert!(seen(&live) == state);
            let removed = live.remove_plane(brush, plane);
            match removal {
                PlaneRemoval::Nothing => {
                    nothing += 1;
                    assert_eq!(body(&live).solid.volume, before, "seed {seed}, {plane:?}");
                }
                PlaneRemoval::Unbounded => {
                    unbounded += 1;
                    removed.unwrap_err();
                    continue;
                }
                PlaneRemoval::Gains(piece) => {
                    gains += 1;
                    let after = body(&live).solid.volume;
                    let tolerance = 1e-12 * after;
                    assert!((after - before - piece.volume).abs() < tolerance, "seed {seed}, {plane:?}");
                    let tree = Tree::from(Brush::from_half_spaces(piece.half_spaces, MaterialId(0)));
                    let alone = evaluate(&Model { materials: vec![Material::named("a")], tree }).unwrap();
                    assert!((alone.solid.volume - piece.volume).abs() < tolerance, "seed {seed}, {plane:?}");
                    let corner = |at: u32| piece.positions[at as usize];
                    let cone = |triangle: &[u32; 3]| {
                        let [a, b, c] = triangle.map(corner);
                        a.dot(b.cross(c)) / 6.0
                    };
                    let volume: f64 = piece.triangles.iter().map(cone).sum();
                    assert!((volume - piece.volume).abs() < tolerance, "seed {seed}, {plane:?}");
                }
            }
            live.undo().unwrap();
        }
    }
    assert!(gains > 150 && unbounded > 40 && nothing > 60, "{gains} {unbounded} {nothing}");
    let mut live = model();
    let (brush, _) = live.add_brush(cuboid([0.0; 3], [4.0; 3]), Role::Add).unwrap();
    let plane = PlaneIdx(6);
    assert_eq!(live.preview_remove_plane(brush, plane), Err(EditError::UnknownPlane { brush, plane }));
    assert_eq!(live.preview_remove_plane(BrushId(1), plane), Err(EditError::UnknownBrush(BrushId(1))));
}

#[test]
fn planes_snap_to_planes_corners_and_a_grid() {
    let mut live = model();
    let (block, _) = live.add_brush(cuboid([0.0; 3], [1.0; 3]), Role::Add).unwrap();
    // turned by 30 degrees: its plane is no short number
    let turn = Transform::rotation(DVec3::Z, 30.0).unwrap();
    let (turned, _) = live.add_brush(cuboid([3.0; 3], [4.0; 3]).transformed(&turn).unwrap(), Role::Add).unwrap();
    let (other, _) = live.add_brush(cuboid([0.0; 3], [1.3; 3]).transformed(&turn).unwrap(), Role::Add).unwrap();
    let before = seen(&live);
    let face = |live: &LiveModel, brush: BrushId, plane: usize| live.brush(brush).unwrap().0.faces[plane].half_space;
    let near = |half_space: HalfSpace, by: f64| HalfSpace::new(half_space.normal(), half_space.offset() + by).unwrap();
    let only_planes = SnapOptions { planes: Some(0.1), ..SnapOptions::default() };
    // to a plane that looks the same way, and to one that looks the other way
    for (plane, sign) in [(0, 1.0), (1, -1.0)] {
        let goal = face(&live, turned, plane);
        let goal_from_here = if sign > 0.0 { goal } else { goal.flipped() };
        let to = near(goal_from_here, 0.07);
        let snap = live.snap_plane(other, PlaneIdx(0), &to, &only_planes).unwrap().unwrap();
        assert_eq!(snap.half_space, goal_from_here, "the same numbers");
        assert_eq!(snap.to, SnapTarget::Plane { brush: turned, plane: PlaneIdx(plane) });
        assert!((snap.distance - 0.07).abs() < 1e-12);
        assert_eq!(live.snap_plane(other, PlaneIdx(0), &near(goal_from_here, 0.11), &only_planes), Ok(None));
    }
    // corners, but for those where the plane is now
    let corners = SnapOptions { vertices: Some(0.2), ..SnapOptions::default() };
    let x = |offset: f64| HalfSpace::new(DVec3::X, offset).unwrap();
    assert_eq!(
        live.snap_plane(block, PlaneIdx(0), &x(1.001), &SnapOptions { vertices: Some(0.01), ..corners }),
        Ok(None)
    );
    let [c, s] = [0.75_f64.sqrt(), 0.5];
    let corner = 4.0 * c - 3.0 * s;
    let snap = live.snap_plane(block, PlaneIdx(0), &x(corner + 0.1), &corners).unwrap().unwrap();
    let SnapTarget::Vertex(at) = snap.to else { panic!("{snap:?}") };
    assert!((at.x - corner).abs() < 1e-14 && snap.half_space.offset() == at.x, "{snap:?}");
    // the nearer one of both, and the grid where there is none
    let all = SnapOptions { grid: Some(0.25), planes: Some(0.2), vertices: Some(0.2) };
    let far = live.snap_plane(block, PlaneIdx(4), &HalfSpace::new(DVec3::Z, 9.1).unwrap(), &all).unwrap().unwrap();
    assert_eq!((far.half_space.offset(), far.to), (9.0, SnapTarget::Grid));
    let long = HalfSpace::new(3.0 * DVec3::Z, 3.0 * 9.4).unwrap();
    assert_eq!(live.snap_plane(block, PlaneIdx(4), &long, &all).unwrap().unwrap().half_space.offset(), 3.0 * 9.5);
    let z = live.snap_plane(block, PlaneIdx(4), &HalfSpace::new(DVec3::Z, 1.25).unwrap(), &all).unwrap().unwrap();
    let expected = SnapTarget::Plane { brush: other, plane: PlaneIdx(4) };
    assert_eq!((z.half_space, z.to), (face(&live, other, 4), expected));
    for grid in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let options = SnapOptions { grid: Some(grid), ..SnapOptions::default() };
        assert_eq!(live.snap_plane(block, PlaneIdx(0), &x(3.1), &options), Ok(None), "{grid}");
    }
    let unknown = EditError::UnknownPlane { brush: block, plane: PlaneIdx(9) };
    assert_eq!(live.snap_plane(block, PlaneIdx(9), &x(1.0), &all), Err(unknown));
    assert!(seen(&live) == before);
    // coplanar exactly: one face where both end
    live.move_plane(block, PlaneIdx(4), z.half_space).unwrap();
    let is_top =
        |face: planecut_csg::LiveFace<'_>| face.normal().z > 0.99 && (face.indexed().0[0].z - 1.3).abs() < 1e-9;
    assert_eq!(live.faces().filter(|(_, face)| is_top(*face)).count(), 1);
}
