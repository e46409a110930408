//! Rigid bodies as Rapier has them: their colliders enclose what is seen of them, and on the ground they come to rest.
//!
//! A package of its own: Rapier takes longer to build than most of planecut.

mod body;

use std::fs;
use std::path::Path;

use planecut_cells::coarsen::{
    Bounded, CoarsenOptions, Coarsened, Coarsener, Surface, Writing, coarsen, written_meshes,
};
use planecut_csg::{Brush, Material, MaterialId, Mesh, Model, Tree, evaluate};
use planecut_export::{Collider, MassProperties, PhysicsFormat, RigidBody, physics_files};
use planecut_kernel::DVec3;
use planecut_shapes::primitives;
use planecut_testkit::generate::turned_box;
use planecut_testkit::random::Rng;
use planecut_testkit::scene::cuboid;

use body::Body;

fn steel() -> Vec<Material> {
    vec![Material::named("steel")]
}

fn mesh_of(tree: Tree) -> Mesh {
    evaluate(&Model { materials: steel(), tree }).expect("a solid").mesh
}

fn options(cells: usize) -> CoarsenOptions {
    CoarsenOptions { max_cells: Some(cells), ..CoarsenOptions::default() }
}

/// Writes a body as MJCF with meshes beside it, has Rapier read it, and lets it fall.
fn expect_sound(folder: &Path, name: &str, (visual, is_closed): (&Mesh, bool), cells: &Coarsened) {
    let single = |positions: &[DVec3]| positions.iter().map(|position| position.as_vec3().as_dvec3()).collect();
    let writing = Writing { scale: 1.0, max_vertices: usize::MAX, encloses: true, is_separated: true, stored: &single };
    let meshes = written_meshes(&cells.cells, &steel(), &writing).expect("meshes");
    let colliders: Vec<Collider<'_>> = meshes.iter().map(|mesh| Collider::new("cell", mesh)).collect();
    let union = mesh_of(Tree::union_of(cells.cells.clone()));
    let heavy = if is_closed { visual } else { &union };
    let mass = MassProperties::of_triangles(&heavy.positions, &heavy.triangles, 1000.0).expect("a mass");
    let body = RigidBody { name, visual, colliders: &colliders, mass };
    for file in physics_files(&body, PhysicsFormat::Mjcf, name).expect("files") {
        let path = if file.path().is_empty() { format!("{name}.xml") } else { file.path().to_owned() };
        let path = folder.join(path);
        fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        file.write(&mut fs::File::create(path).expect("a file")).expect("written");
    }
    let body = Body::read(folder, name);
    assert_eq!(body.colliders(), cells.cells.len(), "{name}");
    body.expect_enclosed();
    body.expect_rest();
}

#[test]
fn boxes_and_hulls_settle() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut rng = Rng::new(3);
    let parts: Vec<Brush> = vec![
        cuboid(DVec3::ZERO, DVec3::new(4.0, 2.0, 1.0)),
        turned_box(&mut rng, DVec3::new(2.0, 1.0, 1.5), DVec3::new(1.0, 0.5, 0.75)),
        cuboid(DVec3::new(6.0, 0.0, 0.0), DVec3::new(8.0, 2.0, 1.0)),
    ];
    let tree = Tree::union_of(parts);
    let cells = coarsen(&tree, &[], &CoarsenOptions::default()).expect("cells");
    expect_sound(folder.path(), "parts", (&mesh_of(tree), true), &cells);
}

#[test]
fn a_bracket_with_holes_settles() {
    let folder = tempfile::tempdir().expect("a folder");
    let low = DVec3::new(-3.0, -2.0, 0.5);
    let plates = [DVec3::new(3.0, 2.0, 1.0), DVec3::new(-2.5, 2.0, 4.5)].map(|high| Tree::from(cuboid(low, high)));
    let hole = primitives::cylinder(2.0, 0.75, 0.75, 24, MaterialId(0)).expect("a cylinder");
    let tree = Tree::union(plates) - hole.into();
    let cells = coarsen(&tree, &[], &options(8)).expect("cells");
    expect_sound(folder.path(), "bracket", (&mesh_of(tree), true), &cells);
}

#[test]
fn an_open_tray_settles() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut tray = mesh_of(cuboid(DVec3::ZERO, DVec3::new(2.0, 2.0, 1.0)).into());
    let is_top = |triangle: &[u32; 3]| triangle.iter().all(|corner| tray.positions[*corner as usize].z > 0.5);
    let (triangles, faces) = tray
        .triangles
        .iter()
        .zip(&tray.triangle_faces)
        .filter(|(triangle, _)| !is_top(triangle))
        .map(|(triangle, face)| (*triangle, *face))
        .unzip();
    (tray.triangles, tray.triangle_faces) = (triangles, faces);
    let bounded = Bounded::Shell { thickness: Bounded::default_thickness(&tray.positions, &tray.triangles) };
    let surface = Surface { positions: &tray.positions, triangles: &tray.triangles, materials: &[], bounded };
    let coarsener = Coarsener::of_surface(&surface, None, &options(5)).expect("a surface");
    expect_sound(folder.path(), "tray", (&tray, false), &coarsener.coarsened().expect("cells"));
}
