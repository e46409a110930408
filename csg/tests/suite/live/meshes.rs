//! Models some of whose brushes are closed meshes, edit by edit.

use std::collections::BTreeSet;

use planecut_csg::{
    Brush, BrushId, Change, Edit, EditError, EvaluateError, FaceId, LiveModel, Material, MaterialId, Mesh, MeshBody,
    Model, Operation, Role, Transform, Tree, UnboundedBrushes, evaluate, evaluate_with,
};
use planecut_kernel::{DMat3, DVec3, HalfSpace, PlaneIdx};
use planecut_testkit::random::Rng;

use super::edits::{Viewer, triangles_of};
use crate::arrangement::soup::Soup;

const ROLES: [Role; 3] = [Role::Add, Role::Subtract, Role::Intersect];

fn materials() -> Vec<Material> {
    ["stone", "brass"].map(Material::named).to_vec()
}

fn cuboid(min: f64, max: f64) -> Brush {
    Brush::cuboid(DVec3::splat(min), DVec3::splat(max), MaterialId(0))
}

/// A box as a closed mesh.
fn box_body(min: f64, max: f64) -> Brush {
    let mesh = planecut_testkit::meshes::box_mesh(DVec3::splat(min), DVec3::splat(max), "brass");
    let closed = planecut_csg::ClosedMesh::new(&mesh.positions, &mesh.triangles, |_| 0).expect("a box is closed");
    Brush::of_mesh(MeshBody::new(closed, vec![MaterialId(1)]))
}

/// What a user of the model knows of it: brushes in order, and all of them before each edit.
#[derive(Default)]
struct Known {
    now: Vec<(BrushId, Brush, Role)>,
    done: Vec<Vec<(BrushId, Brush, Role)>>,
    undone: Vec<Vec<(BrushId, Brush, Role)>>,
}

impl Known {
    fn fresh(&self) -> Result<Mesh, EvaluateError> {
        let tree = self.now.iter().fold(Tree::empty(), |tree, (_, brush, role)| {
            let operation = match role {
                Role::Add => Operation::Union,
                Role::Subtract => Operation::Difference,
                Role::Intersect => Operation::Intersection,
            };
            Tree::combine(operation, [tree, brush.clone().into()])
        });
        Ok(evaluate(&Model { materials: materials(), tree })?.mesh)
    }

    /// Does a random edit; nothing where there is nothing to edit.
    fn edit(&mut self, live: &mut LiveModel, rng: &mut Rng) -> Option<Change> {
        let mut new = self.now.clone();
        let role = if rng.chance(0.1) { Role::Intersect } else { ROLES[rng.below(2)] };
        let at = rng.below(new.len().max(1));
        let kind = if new.is_empty() { rng.below(8) } else { rng.below(16) };
        let change = match kind {
            0..4 => {
                let brush = if rng.chance(0.6) { random_mesh(rng) } else { random_box(rng) };
                let (id, change) = live.add_brush(brush.clone(), role).expect("it is bounded");
                new.push((id, brush, role));
                change
            }
            4..7 => {
                let [from, to] =
                    if kind < 6 { [&mut self.done, &mut self.undone] } else { [&mut self.undone, &mut self.done] };
                let Some(before) = from.pop() else {
                    let outcome = if kind < 6 { live.undo() } else { live.redo() };
                    assert!(matches!(outcome, Err(EditError::NothingToUndo | EditError::NothingToRedo)), "{outcome:?}");
                    return None;
                };
                to.push(std::mem::replace(&mut self.now, before));
                return Some(if kind < 6 { live.undo() } else { live.redo() }.expect("it was so before"));
            }
            7..9 if !new.is_empty() => live.remove_brush(new.remove(at).0).expect("it is there"),
            9 => {
                new[at].2 = role;
                live.set_role(new[at].0, role).expect("it is there")
            }
            10 => {
                new[at].1 = if rng.chance(0.5) { random_mesh(rng) } else { random_box(rng) };
                live.replace_brush(new[at].0, new[at].1.clone()).expect("it is bounded")
            }
            11 if !new[at].1.is_mesh() => {
                let half_space = HalfSpace::new(DVec3::ONE, rng.whole(2, 9)).expect("a plane");
                let face = planecut_csg::BrushFace { half_space, material: MaterialId(1) };
                new[at].1.faces.push(face);
                live.add_plane(new[at].0, half_space, MaterialId(1)).expect("it has planes").1
            }
            _ if new.is_empty() => return None,
            _ => {
                let transform = random_transform(rng);
                new[at].1 = new[at].1.clone().transformed(&transform).expect("it is not far away");
                live.transform_brush(new[at].0, &transform).expect("it is not far away")
            }
        };
        self.undone.clear();
        self.done.push(std::mem::replace(&mut self.now, new));
        Some(change)
    }
}

fn random_mesh(rng: &mut Rng) -> Brush {
    Brush::of_mesh(Soup::random(rng, 4).mesh())
}

fn random_box(rng: &mut Rng) -> Brush {
    let low = DVec3::from_array([0; 3].map(|_| rng.whole(0, 3)));
    Brush::cuboid(low, low + DVec3::from_array([0; 3].map(|_| rng.whole(1, 2))), MaterialId(1))
}

/// A quarter turn, perhaps a mirror image, moved by whole numbers; or any turn.
fn random_transform(rng: &mut Rng) -> Transform {
    let quarter = DMat3::from_cols(DVec3::Y, -DVec3::X, DVec3::Z);
    let linear = match rng.below(4) {
        0 => quarter,
        1 => DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0)),
        2 => DMat3::from_rotation_z(rng.float(0.0, 6.0)),
        _ => DMat3::IDENTITY,
    };
    Transform::new(linear, DVec3::from_array([0; 3].map(|_| rng.whole(-1, 1)))).expect("it can be undone")
}

/// Compares a model, and what follows its changes, with a fresh evaluation.
fn compare(live: &LiveModel, viewer: &Viewer, fresh: &Mesh, case: &str) {
    assert_eq!(&live.mesh().expect("it is evaluated"), fresh, "{case}: the mesh");
    let faces = live.faces().flat_map(|(_, face)| face.triangles()).count();
    assert_eq!((faces, viewer.triangles().len()), (live.triangle_count(), live.triangle_count()), "{case}: triangles");
    if live.has_faces() {
        assert!(viewer.is_closed(live), "{case}: the faces are closed");
    }
    if live.brushes().any(|id| live.brush(id).expect("it is there").0.is_mesh()) {
        assert_eq!(viewer.triangles(), triangles_of(fresh), "{case}: the faces");
    }
}

#[test]
fn random_edits_of_brushes_and_meshes() {
    let (mut edits, mut triangles) = (0, 0);
    for seed in 0..60 {
        let rng = &mut Rng::spread(seed);
        let (mut live, mut known, mut viewer) = (LiveModel::new(materials()), Known::default(), Viewer::default());
        for step in 0..30 {
            let case = format!("seed {seed}, edit {step}");
            let Some(change) = known.edit(&mut live, rng) else { continue };
            viewer.follow(&live, &change).unwrap_or_else(|text| panic!("{case}: {text}"));
            let fresh = known.fresh().expect("it is bounded");
            compare(&live, &viewer, &fresh, &case);
            if step % 8 == 0 {
                assert_eq!(evaluate(&live.to_model()).map(|all| all.mesh), Ok(fresh), "{case}: as a tree");
            }
            (edits, triangles) = (edits + 1, triangles + live.triangle_count());
        }
        while let Some(before) = known.done.pop() {
            known.now = before;
            let change = live.undo().expect("it was so before");
            viewer.follow(&live, &change).unwrap_or_else(|text| panic!("seed {seed}, undone: {text}"));
            compare(&live, &viewer, &known.fresh().expect("it is bounded"), &format!("seed {seed}, undone"));
        }
        assert_eq!((live.brushes().len(), live.triangle_count()), (0, 0), "seed {seed}");
    }
    assert!(edits > 1300 && triangles > 15 * edits, "{edits} edits, {triangles} triangles");
}

#[test]
fn nested_operations_of_meshes_are_edited_where_they_are() {
    let tree = |parts: [Brush; 4]| {
        let [a, b, c, d] = parts.map(Tree::from);
        (a - b) | (c ^ d)
    };
    let mut parts = [cuboid(0.0, 3.0), box_body(1.0, 2.0), cuboid(2.0, 5.0), box_body(4.0, 6.0)];
    let fresh =
        |parts: &[Brush; 4]| evaluate(&Model { materials: materials(), tree: tree(parts.clone()) }).map(|all| all.mesh);
    let mut live = LiveModel::from_model(Model { materials: materials(), tree: tree(parts.clone()) }).unwrap();
    assert_eq!(live.mesh(), fresh(&parts));
    let transform = Transform::new(DMat3::IDENTITY, DVec3::new(0.5, 0.25, 2.0)).unwrap();
    live.transform_brush(BrushId(1), &transform).unwrap();
    parts[1] = parts[1].clone().transformed(&transform).unwrap();
    assert_eq!(live.mesh(), fresh(&parts));
    assert_eq!(live.set_role(BrushId(2), Role::Add), Err(EditError::Nested(BrushId(2).into())));
    live.remove_brush(BrushId(3)).unwrap();
    parts[3] = Brush::cuboid(DVec3::ZERO, DVec3::ZERO, MaterialId(0));
    assert_eq!(live.mesh(), fresh(&parts));
    live.remove_brush(BrushId(1)).unwrap();
    parts[1] = parts[3].clone();
    assert_eq!(live.mesh(), fresh(&parts));
    assert_eq!(live.undo().and(live.undo()).map(|_| live.brushes().len()), Ok(4));
}

#[test]
fn a_mesh_has_no_planes_to_edit() {
    let mut live = LiveModel::new(materials());
    let (mesh, _) = live.add_brush(box_body(0.0, 1.0), Role::Add).unwrap();
    let (half_space, plane) = (HalfSpace::new(DVec3::X, 0.5).unwrap(), PlaneIdx(0));
    let refused = EditError::Mesh(mesh);
    assert_eq!(live.add_plane(mesh, half_space, MaterialId(0)), Err(refused));
    assert_eq!(live.move_plane(mesh, plane, half_space), Err(refused));
    assert_eq!(live.remove_plane(mesh, plane), Err(refused));
    assert_eq!(live.apply(Edit::MovePlane { brush: mesh, plane, offset: 0.5 }), Err(refused));
    assert_eq!(live.planes(mesh), Ok(&[][..]));
    assert_eq!(refused.to_string(), "found brush 0, which is a closed mesh, expected one of planes");
    assert_eq!(live.triangle_count(), 12);
}

#[test]
fn only_faces_that_differ_are_named() {
    let mut live = LiveModel::new(materials());
    live.add_brush(cuboid(0.0, 4.0), Role::Add).unwrap();
    let (tool, change) = live.add_brush(box_body(3.0, 5.0), Role::Subtract).unwrap();
    assert_eq!(
        (change.removed.len(), change.added.len()),
        (6, live.faces().count()),
        "all, as the model has a mesh now"
    );
    let normals = |live: &LiveModel, faces: &[FaceId]| {
        let normal = |face: &FaceId| {
            let [a, b, c] = live.face(*face).unwrap().triangles().next().unwrap().map(|corner| corner.1);
            (b - a).cross(c - a).normalize().to_array().map(|v| v as i32)
        };
        faces.iter().map(normal).collect::<BTreeSet<[i32; 3]>>()
    };
    let down = Transform::new(DMat3::IDENTITY, DVec3::new(0.0, 0.0, -0.5)).unwrap();
    let change = live.transform_brush(tool, &down).unwrap();
    // on three sides the block stays as it is
    let expected = BTreeSet::from([[1, 0, 0], [0, 1, 0], [0, 0, 1]]);
    assert_eq!((change.brushes, normals(&live, &change.added)), (vec![tool], expected));
    let change = live.set_role(tool, Role::Subtract).unwrap();
    assert_eq!((change.removed, change.added), (Vec::new(), Vec::new()));
    let change = live.remove_brush(tool).unwrap();
    assert_eq!((change.added.len(), live.triangle_count()), (6, 12));
}

#[test]
fn what_is_refused_leaves_the_model_as_it_was() {
    let mut live = LiveModel::new(materials());
    let (block, _) = live.add_brush(cuboid(0.0, 2.0), Role::Add).unwrap();
    let open = Brush::from_half_spaces([HalfSpace::new(DVec3::X, 1.0).unwrap()], MaterialId(0));
    let unbounded = EditError::Evaluate(EvaluateError::Unbounded);
    let (tool, _) = live.add_brush(box_body(1.0, 3.0), Role::Subtract).unwrap();
    let before = live.mesh().unwrap();
    assert_eq!(live.add_brush(open.clone(), Role::Add), Err(unbounded));
    assert_eq!(live.replace_brush(block, open), Err(unbounded));
    let unknown = live.materials().len() as u32;
    let mesh = Brush {
        mesh: box_body(0.0, 1.0).mesh.map(|mesh| MeshBody::new(mesh.mesh().clone(), vec![MaterialId(unknown)])),
        ..Brush::default()
    };
    assert!(matches!(live.replace_brush(tool, mesh), Err(EditError::Evaluate(EvaluateError::UnknownMaterial { .. }))));
    assert_eq!((live.mesh().unwrap(), live.brushes().len()), (before, 2));
    assert_eq!(live.undo().and(live.undo()).map(|_| live.triangle_count()), Ok(0));
    assert_eq!(live.undo(), Err(EditError::NothingToUndo));
}

#[test]
fn brushes_that_are_left_out_and_new_materials_count_as_in_a_fresh_evaluation() {
    let open = Brush::from_half_spaces([HalfSpace::new(DVec3::X, 1.0).unwrap()], MaterialId(0));
    let tree = (Tree::from(cuboid(0.0, 2.0)) | open.into()) - box_body(1.0, 3.0).into();
    let model = Model { materials: materials(), tree };
    let mut live = LiveModel::from_model_with(model, UnboundedBrushes::LeaveOut).unwrap();
    live.add_material(Material::named("a third"));
    let fresh = evaluate_with(&live.to_model(), UnboundedBrushes::LeaveOut).unwrap();
    assert_eq!((live.mesh().unwrap(), fresh.solid.volume), (fresh.mesh, 7.0));
}
