//! Trees some of whose leaves are closed meshes: cut open, split by source, with other leaves, and what does not take them.

use glam::{DVec2, DVec3};
use planecut_csg::{
    BlockOptions, Brush, ClosedMesh, Material, MaterialId, MeshBody, Model, TextureAxes, Transform, Tree,
    UnboundedBrush, evaluate, evaluate_in_blocks,
};
use planecut_kernel::HalfSpace;

/// An L of 2 × 2 less 1 × 1, one unit high; its lid and floor are of the second of these materials, its walls of the first.
fn l_shape(materials: [u32; 2]) -> MeshBody {
    let outline = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)];
    let points: Vec<DVec3> = [0.0, 1.0].iter().flat_map(|z| outline.map(|(x, y)| DVec3::new(x, y, *z))).collect();
    let lid = [[0u32, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]];
    let mut triangles: Vec<[u32; 3]> = lid.iter().map(|[a, b, c]| [*c, *b, *a]).collect();
    triangles.extend(lid.map(|triangle| triangle.map(|corner| corner + 6)));
    for k in 0..6 {
        let next = (k + 1) % 6;
        triangles.extend([[k, next, next + 6], [k, next + 6, k + 6]]);
    }
    let mesh = ClosedMesh::new(&points, &triangles, |triangle| u32::from(triangle < 8)).expect("closed");
    MeshBody::new(mesh, materials.map(MaterialId).to_vec())
}

fn materials() -> Vec<Material> {
    ["wall", "lid", "tool"].map(Material::named).to_vec()
}

fn area_of(model: &Model, material: u32) -> f64 {
    let mesh = evaluate(model).unwrap_or_else(|error| panic!("{error}")).mesh;
    let of_triangle = |(corners, face): (&[u32; 3], &u32)| {
        let [a, b, c] = corners.map(|corner| mesh.positions[corner as usize]);
        let is_of = mesh.faces[*face as usize].material == MaterialId(material);
        if is_of { 0.5 * (b - a).cross(c - a).length() } else { 0.0 }
    };
    mesh.triangles.iter().zip(&mesh.triangle_faces).map(of_triangle).sum()
}

#[test]
fn a_model_with_a_mesh_is_cut_open() {
    let tool = Brush::cuboid([-1.0, -1.0, 0.5], [0.5, 5.0, 9.0], MaterialId(2));
    let tree = Tree::from(l_shape([0, 1])) - tool.into();
    let half_space = HalfSpace::new(DVec3::X, 0.75).expect("a half-space");
    let cut = Model { materials: materials(), tree }.cut_open(&half_space);
    // 0.75 × 2 × 1 without 0.5 × 2 × 0.5
    assert_eq!(evaluate(&cut.model).expect("a solid").solid.volume, 1.0);
    let [only] = cut.cuts[..] else { panic!("one material for the cut") };
    assert_eq!(only.of, None, "leaves are of several");
    assert_eq!(area_of(&cut.model, only.id.0), 2.0);
    let alone = Model { materials: materials(), tree: l_shape([0, 0]).into() };
    let cut = alone.cut_open(&half_space);
    assert_eq!(cut.cuts[0].of, Some(MaterialId(0)));
    assert_eq!(evaluate(&cut.model).expect("a solid").solid.volume, 1.5);
}

#[test]
fn surfaces_of_meshes_are_sources_as_faces_of_brushes_are() {
    let block = Brush::cuboid([5.0, 0.0, 0.0], [6.0, 1.0, 1.0], MaterialId(2));
    let tree = Tree::union([block.into(), l_shape([0, 1]).into()]);
    let model = Model { materials: materials(), tree };
    for (by_face, count) in [(true, 8), (false, 3)] {
        let (split, sources) = model.split_by_source(&[], by_face);
        assert_eq!((split.materials.len(), sources.len()), (count, count));
        let of_mesh: Vec<(u32, u32)> = sources[count - 2..].iter().map(|source| (source.brush, source.plane)).collect();
        assert_eq!(of_mesh, [(1, 0), (1, 1)]);
        let (walls, lids) = (count as u32 - 2, count as u32 - 1);
        assert_eq!((area_of(&split, walls), area_of(&split, lids)), (8.0, 6.0));
    }
}

#[test]
fn textures_of_meshes_are_those_where_the_mesh_ends_up() {
    let lying = TextureAxes::of_triangle([DVec3::ZERO, DVec3::X, DVec3::Y], [DVec2::ZERO, DVec2::X, DVec2::Y]);
    let leaf = l_shape([0, 1]).with_textures([None, lying]);
    let turn =
        Transform::from_columns([[0.0, 2.0, 0.0], [1.0, 0.5, 0.0], [0.0, 0.0, -3.0], [7.0, 0.0, 1.0]]).expect("a map");
    let tree = Tree::from(leaf).transformed(&turn).expect("moved");
    let (split, sources) = Model { materials: materials(), tree }.split_by_source(&[], false);
    assert_eq!(sources.len(), 2);
    let mesh = evaluate(&split).expect("a solid").mesh;
    for (triangle, face) in mesh.triangles.iter().zip(&mesh.triangle_faces) {
        let source = sources[mesh.faces[*face as usize].material.0 as usize];
        for corner in triangle.map(|corner| mesh.positions[corner as usize]) {
            // the inverse, by hand
            let x = (corner.y - 0.5 * (corner.x - 7.0)) / 2.0;
            let expected = DVec2::new(x, corner.x - 7.0);
            let is_lid = source.plane == 1;
            assert_eq!(source.texture.is_some(), is_lid);
            assert!(source.texture.is_none_or(|axes| axes.at(corner).abs_diff_eq(expected, 1e-14)), "{corner}");
        }
    }
}

#[test]
fn leaves_are_replaced_in_place() {
    let moved = Transform::translation(DVec3::new(0.0, 0.0, 3.0)).expect("a map");
    let block = |x: f64| Brush::cuboid([x, 0.0, 0.0], [x + 1.0, 1.0, 1.0], MaterialId(0));
    let tree = (Tree::from(l_shape([0, 1])).with_name("L") - block(0.0).into()) | block(7.0).into();
    let tree = tree.transformed(&moved).expect("in range").with_source_line(std::num::NonZeroU32::new(3));
    let both = tree.clone().try_replace_leaves(|leaf| match leaf.mesh {
        Some(_) => Ok::<_, ()>(vec![block(0.0), block(1.0), block(2.0)]),
        None => Ok(vec![
            leaf.transformed(&Transform::translation(DVec3::new(0.0, 0.0, -3.0)).expect("a map")).expect("in range"),
        ]),
    });
    let both = both.expect("no error");
    assert!(!both.has_meshes() && both.brushes().len() == 5);
    assert!(both.source_lines().all(|line| line == std::num::NonZeroU32::new(3)));
    assert_eq!(both.brushes()[1].name.as_deref(), Some("L"));
    assert_eq!(evaluate(&Model { materials: materials(), tree: both }).expect("a solid").solid.volume, 3.0);
    let nothing = tree.clone().try_replace_leaves(|_| Ok::<_, ()>(Vec::new())).expect("no error");
    assert_eq!(evaluate(&Model { materials: materials(), tree: nothing }).expect("nothing").solid.volume, 0.0);
    assert_eq!(tree.try_replace_leaves(|_| Err("none")), Err("none"));
}

#[test]
fn blocks_are_of_convex_bodies_alone() {
    let model = Model { materials: materials(), tree: l_shape([0, 1]).into() };
    let refused = evaluate_in_blocks(&model, BlockOptions::default(), |_| Ok::<(), ()>(()));
    assert_eq!(refused, Err(UnboundedBrush { brush: 0, is_mesh: true }.into()));
}
