//! Oracles for trees: the volume as a sum over intersections of leaves, membership of points from half-spaces alone.

use glam::DVec3;
use planecut_csg::{Brush, Evaluation, Mesh};
use planecut_kernel::IncrementalPolytope;

use super::random::Shape;
use planecut_testkit::random::Rng;
use planecut_testkit::scene::{Scene, ensure};
use planecut_testkit::soundness::contraction;

/// A truth table as a polynomial: the value of the tree is `Σ c_S Π_{k ∈ S} x_k` over sets S of leaves.
fn coefficients(shape: &Shape, leaves: usize) -> Vec<i64> {
    let table = (0..1_usize << leaves).map(|set| i64::from(shape.value(&mut (0..leaves).map(|k| set >> k & 1 == 1))));
    let mut table: Vec<i64> = table.collect();
    for k in 0..leaves {
        for set in (0..table.len()).filter(|set| set >> k & 1 == 1) {
            table[set] -= table[set ^ (1 << k)];
        }
    }
    table
}

/// Volume and what bounds its rounding: the sums of the terms, their areas, and the cubes of their sizes.
#[derive(Debug, Default)]
struct TreeVolume {
    volume: f64,
    terms: f64,
    areas: f64,
    cubes: f64,
}

/// `Σ c_S vol(∩ S)`, intersections by the kernel, all within a box that holds the solid.
fn volume_of(shape: &Shape) -> TreeVolume {
    let leaves = shape.leaves();
    let coefficients = coefficients(shape, leaves.len());
    let mut polytope = IncrementalPolytope::with_epsilon(0.0);
    let outer = Brush::cuboid(DVec3::splat(-64.0), DVec3::splat(64.0), planecut_csg::MaterialId(0));
    let mut out = TreeVolume::default();
    for (set, coefficient) in coefficients.into_iter().enumerate().filter(|(_, coefficient)| *coefficient != 0) {
        polytope.clear();
        let chosen = leaves.iter().enumerate().filter(|(k, _)| set >> k & 1 == 1).map(|(_, brush)| *brush);
        for face in chosen.chain([&outer]).flat_map(|brush| &brush.faces) {
            polytope.add_plane(face.half_space);
        }
        let Some(measures) = polytope.measures().filter(|_| !polytope.is_empty()) else { continue };
        let weight = coefficient as f64;
        out.volume += weight * measures.volume;
        out.terms += weight.abs() * measures.volume;
        out.areas += weight.abs() * measures.area;
        let corners = polytope.to_mesh().0;
        let (min, max) = corners.iter().fold((corners[0], corners[0]), |(min, max), p| (min.min(*p), max.max(*p)));
        out.cubes += weight.abs() * (max - min).length().powi(3);
    }
    out
}

/// Compares the volume with the sum over intersections.
pub(crate) fn check_volume(shape: &Shape, evaluation: &Evaluation) -> Result<(), String> {
    let expected = volume_of(shape);
    let snapped = if evaluation.model.snapped_planes == 0 { 0.0 } else { 64.0 * 8.0 * planecut_csg::SNAP_TOLERANCE };
    let displacement = 64.0 * 64.0 * f64::EPSILON + snapped;
    let tolerance = 1e-13 * expected.terms
        + displacement * evaluation.solid.area.max(1.0)
        + 1e-15 * expected.areas
        + f64::EPSILON * expected.cubes;
    let found = evaluation.solid.volume;
    ensure!(
        (found - expected.volume).abs() <= tolerance,
        "volume {found}, expected {} ± {tolerance:e}",
        expected.volume
    );
    Ok(())
}

/// Whether a point lies in the tree; `None` within `margin` of any plane.
fn is_member(shape: &Shape, point: DVec3, margin: f64) -> Option<bool> {
    let mut values = Vec::new();
    for brush in shape.leaves() {
        let mut inside = true;
        for face in &brush.faces {
            let distance = face.half_space.signed_distance(point);
            if distance.abs() <= margin {
                return None;
            }
            inside &= distance < 0.0;
        }
        values.push(inside);
    }
    Some(shape.value(&mut values.into_iter()))
}

/// The winding number of a mesh around a point: the sum of the solid angles of its triangles, by van Oosterom and
/// Strackee 1983.
fn winding_number(mesh: &Mesh, point: DVec3) -> f64 {
    let angle = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|v| mesh.positions[v as usize] - point);
        let (la, lb, lc) = (a.length(), b.length(), c.length());
        let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        2.0 * a.dot(b.cross(c)).atan2(below)
    };
    mesh.triangles.iter().map(angle).sum::<f64>() / (4.0 * std::f64::consts::PI)
}

/// Compares winding numbers with membership: close to the faces on either side, and anywhere around.
pub(crate) fn check_membership(shape: &Shape, evaluation: &Evaluation, points: usize) -> Result<(), String> {
    let (mesh, solid) = (&evaluation.mesh, &evaluation.solid);
    let mut rng = Rng::spread(mesh.triangles.len() as u64);
    let margin = 1e-7 + contraction(solid);
    let (mut decided, mut brushes) = (0, shape.leaves());
    brushes.retain(|brush| !brush.faces.is_empty());
    for k in 0..points {
        let point = if k % 2 == 0 && !mesh.triangles.is_empty() {
            let t = rng.below(mesh.triangles.len());
            let [a, b, c] = mesh.triangles[t].map(|v| mesh.positions[v as usize]);
            let weights = rng.point(0.1, 1.0);
            let on = (weights.x * a + weights.y * b + weights.z * c) / weights.element_sum();
            let side = if rng.chance(0.5) { 4.0 } else { -4.0 };
            on + side * margin * mesh.faces[mesh.triangle_faces[t] as usize].normal
        } else {
            rng.point(-5.0, 5.0)
        };
        let Some(inside) = is_member(shape, point, margin) else { continue };
        let winding = winding_number(mesh, point);
        decided += 1;
        ensure!(
            (winding - f64::from(u8::from(inside))).abs() < 1e-3,
            "winding number {winding} at {point:?}, expected {}",
            u8::from(inside)
        );
    }
    ensure!(decided > points / 8, "only {decided} of {points} points could be judged");
    Ok(())
}

#[test]
fn the_polynomial_of_a_tree_is_that_of_inclusion_and_exclusion() {
    use planecut_csg::Operation::Union;
    let mut rng = Rng::spread(1);
    let leaf = |rng: &mut Rng| Shape::Leaf(super::random::random_leaf(rng, super::random::Kind::Lattice));
    let shape = Shape::Node(Union, (0..3).map(|_| leaf(&mut rng)).collect());
    assert_eq!(coefficients(&shape, 3), [0, 1, 1, -1, 1, -1, -1, 1]);
    assert_eq!(shape.model().tree.brushes().len(), 3);
}
