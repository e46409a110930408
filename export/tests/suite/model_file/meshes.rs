//! Closed meshes are written with all their vertices, where they are, and what each triangle is made of.

use planecut_csg::{Brush, ClosedMesh, MaterialId, MeshBody, Model, Transform, Tree, WindingRule, evaluate};
use planecut_kernel::DVec3;
use planecut_testkit::random::Rng;

use super::support::{NAMES, assert_same_tree, back, holds, materials, read, written};

const CORNERS: [[u32; 3]; 12] = [
    [0, 2, 1],
    [1, 2, 3],
    [4, 5, 6],
    [5, 7, 6],
    [0, 1, 4],
    [1, 5, 4],
    [2, 6, 3],
    [3, 6, 7],
    [0, 4, 2],
    [2, 4, 6],
    [1, 3, 5],
    [3, 7, 5],
];

/// The unit cube, its corners moved a little, a vertex more that nothing uses, and any materials.
fn mesh(random: &mut Rng) -> MeshBody {
    let corner = |k: u32| DVec3::from([0, 1, 2].map(|axis| f64::from(k >> axis & 1)));
    let mut positions: Vec<DVec3> =
        (0..8).map(|k| corner(k) + DVec3::from([(); 3].map(|()| random.float(-0.2, 0.2)))).collect();
    positions.push(DVec3::new(-0.0, -1.2e28, 1e-300));
    let surfaces = 1 + random.below(4) as u32;
    let of: Vec<u32> = CORNERS.iter().map(|_| random.below(surfaces as usize) as u32).collect();
    let closed = ClosedMesh::new(&positions, &CORNERS, |triangle| of[triangle]).expect("closed");
    // surfaces that are made of one material are another case
    let materials = (0..surfaces).map(|_| MaterialId(random.below(NAMES.len()) as u32)).collect();
    let rules = [WindingRule::Positive, WindingRule::NonZero, WindingRule::Odd];
    MeshBody::new(closed, materials).with_rule(random.pick(&rules))
}

fn transform(random: &mut Rng) -> Transform {
    loop {
        let column = |random: &mut Rng| [(); 3].map(|()| random.float(-3.0, 3.0));
        let columns = [(); 4].map(|()| column(random));
        if let Ok(transform) = Transform::from_columns(columns) {
            return transform;
        }
    }
}

#[track_caller]
fn assert_same_mesh(found: &Brush, expected: &Brush, context: &str) {
    assert_eq!((&found.name, &found.faces), (&expected.name, &expected.faces), "{context}");
    let (found, expected) = (found.mesh.as_ref().expect("a mesh"), expected.mesh.as_ref().expect("a mesh"));
    let bits = |mesh: &MeshBody| -> Vec<[u64; 3]> {
        mesh.mesh().positions().iter().map(|position| position.to_array().map(f64::to_bits)).collect()
    };
    assert_eq!(bits(found), bits(expected), "{context}");
    assert_eq!(found.mesh().triangles(), expected.mesh().triangles(), "{context}");
    assert_eq!((found.transform(), found.rule()), (expected.transform(), expected.rule()), "{context}");
    for triangle in 0..expected.mesh().triangles().len() {
        assert_eq!(found.material(triangle), expected.material(triangle), "{context}, triangle {triangle}");
    }
}

#[test]
fn meshes_come_back_bit_for_bit_wherever_they_are() {
    for seed in 0..400 {
        let mut random = Rng::new(seed);
        let materials = materials(&mut random);
        let leaf = |random: &mut Rng| {
            let mut body = mesh(random);
            for _ in 0..random.below(3) {
                body = body.transformed(&transform(random)).expect("in range");
            }
            let name = random.chance(0.4).then(|| random.pick(&NAMES).to_owned());
            Tree::from(Brush { name, ..Brush::of_mesh(body) })
        };
        let cube = Tree::from(Brush::cuboid(DVec3::ZERO, DVec3::ONE, MaterialId(1)));
        let tree = (cube - leaf(&mut random)) | (leaf(&mut random) & leaf(&mut random));
        let model = Model { materials, tree };
        let after = back(&model);
        let context = format!("seed {seed}");
        assert_eq!(after.materials, model.materials, "{context}");
        assert_eq!(after.tree.brushes()[0], model.tree.brushes()[0], "{context}");
        for (found, expected) in after.tree.brushes().iter().zip(model.tree.brushes()).skip(1) {
            assert_same_mesh(found, expected, &context);
        }
        assert_same_tree(&after.tree, &model.tree, &mut random, &context);
        assert!(holds(&after.tree, &[true, false, false, false]), "{context}");
    }
}

#[test]
fn scaled_meshes_have_the_scaled_volume() {
    for seed in 0..40 {
        let mut random = Rng::new(seed);
        let materials = materials(&mut random);
        let moved = mesh(&mut random).transformed(&transform(&mut random)).expect("in range");
        let model = Model { materials, tree: moved.into() };
        let volume = |model: &Model| evaluate(model).expect("bounded").solid.volume;
        let (expected, scale) = (volume(&model), [0.25, 3.0, 39.37][seed as usize % 3]);
        let found = volume(&read(&written(&model, scale))) / f64::powi(scale, 3);
        assert!((found - expected).abs() <= 1e-9 * expected.abs(), "seed {seed}: {found}, expected {expected}");
    }
}

/// The mesh has no room for texture coordinates.
#[test]
fn what_is_written_does_not_depend_on_textures() {
    let mut random = Rng::new(1);
    let plain = mesh(&mut random);
    let textured = plain.clone().with_textures(vec![None; plain.materials().len()]);
    let model = |body: MeshBody| Model { materials: materials(&mut Rng::new(2)), tree: body.into() };
    assert_eq!(written(&model(plain), 1.0), written(&model(textured), 1.0));
}
