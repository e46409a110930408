//! What a shape turned out to be, and whether its mesh is sound.

use std::panic::{AssertUnwindSafe, catch_unwind};

use glam::DVec3;
use planecut_check::{CheckOptions, check_mesh};
use planecut_csg::{Evaluation, Material, Model, Operation, Tree, TreeNode, contract_short_edges, evaluate};

use planecut_testkit::random::Rng;

/// The figures of a mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Figures {
    pub(crate) volume: f64,
    pub(crate) area: f64,
    pub(crate) faces: usize,
    pub(crate) corners: usize,
    pub(crate) genus: i64,
    pub(crate) components: usize,
}

pub(crate) fn evaluated(tree: &Tree) -> Evaluation {
    let materials = vec![Material::named("m")];
    evaluate(&Model { materials, tree: tree.clone() }).expect("a closed boundary")
}

/// Evaluates a shape and checks that its mesh is closed, manifold and free of crossings, and has the volume of the solid.
/// Faces and corners are counted without edges shorter than `1e-8` of the largest coordinate.
pub(crate) fn figures(tree: &Tree) -> Figures {
    let evaluation = evaluated(tree);
    let mesh = &evaluation.mesh;
    let report = check_mesh(&mesh.positions, &mesh.triangles, &CheckOptions::default());
    assert!(report.is_sound(), "{report}");
    let Figures { volume, area, .. } =
        of_triangles(mesh.triangles.iter().map(|t| t.map(|v| mesh.positions[v as usize])));
    assert_near(volume, evaluation.solid.volume, 1e-11, "the volume of the mesh");
    assert_near(area, evaluation.solid.area, 1e-11, "the area of the mesh");
    // faces that are nearly parallel meet far from where rounding takes them to meet: such edges do not count
    let mut counted = mesh.clone();
    let size = mesh.positions.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    contract_short_edges(&mut counted, 1e-8 * size);
    Figures {
        volume: evaluation.solid.volume,
        area: evaluation.solid.area,
        faces: counted.faces.len(),
        corners: counted.positions.len(),
        genus: report.topology.genus.expect("a manifold has a genus"),
        components: report.topology.components,
    }
}

/// Volume and area of triangles, counter-clockwise seen from outside.
pub(crate) fn of_triangles(triangles: impl Iterator<Item = [DVec3; 3]>) -> Figures {
    let (mut volume, mut area, mut origin) = (0.0, 0.0, None);
    for [a, b, c] in triangles {
        let origin = *origin.get_or_insert(a);
        volume += (a - origin).cross(b - origin).dot(c - origin) / 6.0;
        area += 0.5 * (b - a).cross(c - a).length();
    }
    Figures { volume, area, faces: 0, corners: 0, genus: 0, components: 0 }
}

#[track_caller]
pub(crate) fn assert_near(found: f64, expected: f64, relative: f64, what: &str) {
    let error = (found - expected).abs();
    assert!(error <= relative * expected.abs(), "{what}: found {found}, expected {expected}, off by {error:e}");
}

/// Whether a point lies in a tree, straight from its half-spaces; `None` nearer than `margin` to a plane.
pub(crate) fn contains(tree: &Tree, point: DVec3, margin: f64) -> Option<bool> {
    let faces = || tree.brushes().iter().flat_map(|brush| &brush.faces);
    if faces().any(|face| face.half_space.signed_distance(point).abs() < margin) {
        return None;
    }
    let mut leaves = tree.brushes().iter();
    let mut stack: Vec<bool> = Vec::new();
    for node in tree.nodes() {
        let value = match node {
            TreeNode::Leaf => leaves.next()?.faces.iter().all(|face| face.half_space.signed_distance(point) < 0.0),
            TreeNode::Operation { operation, operands } => {
                let values = stack.split_off(stack.len() - *operands as usize);
                match operation {
                    Operation::Union => values.contains(&true),
                    Operation::Intersection => !values.contains(&false),
                    Operation::Difference => values[0] && !values[1..].contains(&true),
                    Operation::Xor => values.iter().filter(|v| **v).count() % 2 == 1,
                    Operation::Complement => !values.contains(&true),
                }
            }
        };
        stack.push(value);
    }
    stack.pop()
}

/// Whether triangles wind around a point, by their solid angles (van Oosterom and Strackee 1983).
pub(crate) fn winds_around(triangles: &[[DVec3; 3]], point: DVec3) -> bool {
    let angle = |triangle: &[DVec3; 3]| {
        let [a, b, c] = triangle.map(|p| (p - point).normalize());
        2.0 * a.dot(b.cross(c)).atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a))
    };
    triangles.iter().map(angle).sum::<f64>() > std::f64::consts::TAU
}

/// Runs a random case many times; a failure names its seed.
pub(crate) fn sweep(count: u64, judge: impl Fn(&mut Rng)) {
    let factor: u64 = std::env::var("PLANECUT_SCENES").ok().and_then(|v| v.parse().ok()).unwrap_or(1);
    for seed in 0..count * factor {
        let run = || judge(&mut Rng::spread(seed));
        if catch_unwind(AssertUnwindSafe(run)).is_err() {
            panic!("seed {seed} (the message is above)");
        }
    }
}
