//! Single cases: what is refused, winding rules, what passes through.

use glam::DVec3;
use planecut_csg::{Brush, Material, MaterialId, Mesh, Model, Transform, Tree, evaluate};
use planecut_csg::{ClosedMesh, ClosedMeshError, MeshBody, WindingRule, combine_meshes};
use planecut_testkit::meshes::box_mesh;

fn closed(mesh: &Mesh) -> MeshBody {
    of_material(mesh, 0)
}

fn of_material(mesh: &Mesh, material: u32) -> MeshBody {
    let closed = ClosedMesh::new(&mesh.positions, &mesh.triangles, |_| 0).expect("a box is closed");
    MeshBody::new(closed, vec![MaterialId(material)])
}

fn cube(corner: f64) -> Mesh {
    box_mesh(DVec3::splat(corner), DVec3::splat(corner + 1.0), "stone")
}

#[test]
fn open_edges_are_named() {
    let mut mesh = cube(2.0);
    let [a, b, c] = mesh.triangles.remove(5).map(|vertex| mesh.positions[vertex as usize]);
    let error = ClosedMesh::new(&mesh.positions, &mesh.triangles, |_| 0).expect_err("a triangle is missing");
    let ClosedMeshError::Open { from, to, count, .. } = error else { panic!("{error}") };
    assert_eq!(count, 3);
    // what is left runs the other way
    assert!([(b, a), (c, b), (a, c)].contains(&(from, to)), "{from} to {to}");
}

#[test]
fn what_is_no_mesh_is_refused() {
    let mesh = cube(0.0);
    let mut positions = mesh.positions.clone();
    positions[3].y = f64::NAN;
    let error = ClosedMesh::new(&positions, &mesh.triangles, |_| 0).expect_err("not a number");
    assert!(matches!(error, ClosedMeshError::NotFinite { vertex: 3, .. }));
    let error = ClosedMesh::new(&mesh.positions, &[[0, 1, 99]], |_| 0).expect_err("no such vertex");
    assert!(matches!(error, ClosedMeshError::NoVertex { triangle: 0, vertex: 99, .. }));
    // products of such coordinates are no numbers any more
    let tiny: Vec<DVec3> = mesh.positions.iter().map(|position| *position * 1e-320).collect();
    let error = ClosedMesh::new(&tiny, &mesh.triangles, |_| 0).expect_err("too small");
    assert!(matches!(error, ClosedMeshError::TooSmall { size } if size > 0.0 && size < 1e-319), "{error}");
}

/// Two boxes in one mesh, one turned inside out or not, under each rule.
#[test]
fn rules_tell_what_is_inside() {
    let volume = |rule: WindingRule, corner: f64, is_inside_out: bool| {
        let (mut mesh, mut other) = (cube(0.0), cube(corner));
        let first = u32::try_from(mesh.positions.len()).expect("few vertices");
        if is_inside_out {
            other.triangles.iter_mut().for_each(|triangle| triangle.swap(0, 1));
        }
        mesh.positions.extend(other.positions);
        mesh.triangles.extend(other.triangles.iter().map(|triangle| triangle.map(|vertex| vertex + first)));
        combine_meshes(&[closed(&mesh).with_rule(rule)], Vec::new(), |inside| inside.of(0))
            .expect("it is closed")
            .solid
            .volume
    };
    use WindingRule::{NonZero, Odd, Positive};
    for (rule, same, against) in [(Positive, 1.875, 0.875), (NonZero, 1.875, 1.75), (Odd, 1.75, 1.75)] {
        assert!((volume(rule, 0.5, false) - same).abs() < 1e-15, "{rule:?}");
        assert!((volume(rule, 0.5, true) - against).abs() < 1e-15, "{rule:?}");
    }
    assert_eq!([Positive, NonZero, Odd].map(|rule| volume(rule, 0.0, false)), [1.0, 1.0, 0.0]);
    assert_eq!([Positive, NonZero, Odd].map(|rule| volume(rule, 0.0, true)), [0.0, 0.0, 0.0]);
}

/// Boxes that touch in a corner, along an edge, over a face, or not at all.
#[test]
fn boxes_that_touch() {
    for shift in [DVec3::ONE, DVec3::new(1.0, 1.0, 0.0), DVec3::new(1.0, 0.0, 0.0), DVec3::new(3.0, 0.0, 0.0)] {
        let mesh = box_mesh(shift, shift + 1.0, "stone");
        let union =
            combine_meshes(&[closed(&cube(0.0)), closed(&mesh)], Vec::new(), |inside| inside.of(0) || inside.of(1));
        let union = union.expect("both are closed");
        assert_eq!(union.solid.volume, 2.0, "{shift}");
        let faces = if shift == DVec3::X { 10.0 } else { 12.0 };
        assert_eq!(union.solid.area, faces, "{shift}");
    }
}

/// Triangles that nothing touches come out as they went in.
#[test]
fn what_nothing_touches_passes_through() {
    let mut first = cube(0.0);
    let far = cube(10.0);
    let offset = u32::try_from(first.positions.len()).expect("few vertices");
    first.positions.extend(&far.positions);
    first.triangles.extend(far.triangles.iter().map(|triangle| triangle.map(|vertex| vertex + offset)));
    let cutter = cube(0.5);
    let difference =
        combine_meshes(&[closed(&first), closed(&cutter)], Vec::new(), |inside| inside.of(0) && !inside.of(1));
    let mesh = difference.expect("both are closed").mesh;
    let triangles = |mesh: &Mesh| -> Vec<[[u64; 3]; 3]> {
        let place = |vertex: u32| mesh.positions[vertex as usize].to_array().map(f64::to_bits);
        mesh.triangles.iter().map(|triangle| triangle.map(place)).collect()
    };
    let out = triangles(&mesh);
    assert!(triangles(&far).iter().all(|triangle| out.contains(triangle)));
}

/// Faces of the cut have the material of the tool; where faces lie upon each other a tool that just touches gives none.
#[test]
fn materials_are_those_of_the_triangles() {
    let materials = vec![Material::named("stone"), Material::named("steel")];
    let solid = of_material(&box_mesh(DVec3::ZERO, DVec3::splat(2.0), "stone"), 0);
    let tool = of_material(&box_mesh(DVec3::new(1.0, -1.0, -1.0), DVec3::splat(3.0), "steel"), 1);
    let difference = combine_meshes(&[solid, tool], materials, |inside| inside.of(0) && !inside.of(1));
    let mesh = difference.expect("both are closed").mesh;
    for face in &mesh.faces {
        assert_eq!(face.material == MaterialId(1), face.normal == DVec3::X, "{face:?}");
    }
    assert!(mesh.faces.iter().any(|face| face.normal == DVec3::X));
}

/// The triangle of the first open edge is that of the list that was given, also where others before it were left out.
#[test]
fn the_triangle_of_an_open_edge_is_the_one_that_was_given() {
    let mesh = cube(0.0);
    let mut triangles = vec![[0, 0, 1], [2, 2, 2]];
    triangles.extend(&mesh.triangles);
    let missing = triangles.remove(6);
    let error = ClosedMesh::new(&mesh.positions, &triangles, |_| 0).expect_err("a triangle is missing");
    let ClosedMeshError::Open { triangle, from, to, count } = error else { panic!("{error}") };
    assert_eq!(count, 3);
    let given = triangles[triangle].map(|vertex| mesh.positions[vertex as usize]);
    assert!((0..3).any(|k| (given[k], given[(k + 1) % 3]) == (from, to)), "triangle {triangle}, {from} to {to}");
    assert!(missing.iter().filter(|vertex| triangles[triangle].contains(vertex)).count() == 2);
}

/// Trees move, paint and name meshes as they do brushes.
#[test]
fn trees_move_paint_and_name_meshes() {
    let body = closed(&cube(0.0));
    let block = Brush::cuboid(DVec3::splat(0.5), DVec3::splat(1.5), MaterialId(0));
    let tree = (Tree::from(body.clone()) - block.into()).with_name("notched").with_material(MaterialId(1));
    let turn = Transform::from_columns([[0.0, 2.0, 0.0], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0], [5.0, 0.0, 0.0]]);
    let tree = tree.transformed(&turn.expect("a mirror image")).expect("in range") | Tree::from(body).with_name("cube");
    let materials = vec![Material::named("stone"), Material::named("brass")];
    let found = evaluate(&Model { materials: materials.clone(), tree: tree.clone() }).expect("a solid");
    assert_eq!((found.solid.volume, found.solid.area), (8.0, 30.0));
    assert_eq!((found.solid.min, found.solid.max), (DVec3::ZERO, DVec3::new(7.0, 2.0, 2.0)));
    for (triangle, face) in found.mesh.triangles.iter().zip(&found.mesh.triangle_faces) {
        let is_brass = found.mesh.positions[triangle[0] as usize].x > 3.0;
        assert_eq!(found.mesh.faces[*face as usize].material, MaterialId(u32::from(is_brass)));
    }
    let parts = tree.into_named_parts();
    let names: Vec<Option<&str>> = parts.iter().map(|(name, _)| name.as_deref()).collect();
    assert_eq!(names, [Some("notched"), Some("cube")]);
    let volumes: Vec<f64> = parts
        .into_iter()
        .map(|(_, tree)| evaluate(&Model { materials: materials.clone(), tree }).expect("a solid").solid.volume)
        .collect();
    assert_eq!(volumes, [7.0, 1.0]);
}
