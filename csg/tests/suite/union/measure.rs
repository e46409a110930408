//! Oracles for any scene: inclusion and exclusion of volumes, membership of points, winding numbers.

use glam::DVec3;
use planecut_csg::{Brush, Evaluation, Mesh, Model};
use planecut_kernel::{HalfSpace, IncrementalPolytope};

use planecut_testkit::random::Rng;
use planecut_testkit::scene::ensure;
use planecut_testkit::soundness::contraction;

/// The volume of a union, and what bounds its rounding.
#[derive(Debug, Default)]
pub(crate) struct UnionVolume {
    pub(crate) volume: f64,
    /// The largest volume of a brush, and the sum of all.
    pub(crate) largest: f64,
    pub(crate) sum: f64,
    /// Sums over all terms of volumes, of areas, and of cubes of the size.
    terms: f64,
    areas: f64,
    cubes: f64,
}

/// `Σ over non-empty subsets of (−1)^(k+1) vol(intersection)`; intersections by the kernel. Unbounded brushes are left out.
pub(crate) fn inclusion_exclusion(model: &Model) -> UnionVolume {
    let bounded = |brush: &&Brush| intersect(IncrementalPolytope::with_epsilon(0.0), brush).is_bounded();
    let brushes: Vec<&Brush> = model.tree.brushes().iter().filter(bounded).collect();
    let mut out = UnionVolume::default();
    add_terms(&brushes, &IncrementalPolytope::with_epsilon(0.0), 0, &mut out);
    out
}

fn intersect(mut polytope: IncrementalPolytope, brush: &Brush) -> IncrementalPolytope {
    for face in &brush.faces {
        polytope.add_plane(face.half_space);
    }
    polytope
}

/// Adds the terms of all subsets that hold `chosen` brushes, meeting in `inside`, and some of those left.
fn add_terms(left: &[&Brush], inside: &IncrementalPolytope, chosen: usize, out: &mut UnionVolume) {
    for (k, brush) in left.iter().enumerate() {
        let meeting = intersect(inside.clone(), brush);
        if meeting.is_empty() {
            continue;
        }
        let measures = meeting.measures().expect("bounded brushes meet in a bounded set");
        out.volume += if chosen.is_multiple_of(2) { measures.volume } else { -measures.volume };
        out.terms += measures.volume;
        out.areas += measures.area;
        let corners = meeting.to_mesh().0;
        let (min, max) = corners.iter().fold((corners[0], corners[0]), |(min, max), p| (min.min(*p), max.max(*p)));
        out.cubes += (max - min).length().powi(3);
        if chosen == 0 {
            out.largest = out.largest.max(measures.volume);
            out.sum += measures.volume;
        }
        add_terms(&left[k + 1..], &meeting, chosen + 1, out);
    }
}

/// How far a plane may move when near ones are snapped together, for coordinates up to `reach`: the stated tolerance, for
/// normal and offset, with room for a chain of two.
pub(crate) fn snap_distance(evaluation: &Evaluation, reach: f64) -> f64 {
    if evaluation.model.snapped_planes == 0 { 0.0 } else { 8.0 * planecut_csg::SNAP_TOLERANCE * reach }
}

/// Compares the volume with inclusion and exclusion.
pub(crate) fn check_volume(model: &Model, evaluation: &Evaluation) -> Result<(), String> {
    let expected = inclusion_exclusion(model);
    let solid = &evaluation.solid;
    let distance = |plane: &HalfSpace| plane.signed_distance(DVec3::ZERO).abs();
    let planes = model.tree.brushes().iter().flat_map(|brush| &brush.faces).map(|face| distance(&face.half_space));
    let reach = planes.fold(solid.min.abs().max(solid.max.abs()).max_element(), f64::max);
    let displacement = 64.0 * f64::EPSILON * reach + snap_distance(evaluation, reach);
    // Sums over tetrahedra round as the cube of the size of a body, however thin it is.
    let rounding = 4.0 * f64::EPSILON * expected.cubes;
    let tolerance = 1e-12 * expected.terms + displacement * expected.areas + rounding;
    let found = solid.volume;
    ensure!(
        (found - expected.volume).abs() <= tolerance,
        "volume {found}, expected {} ± {tolerance:e}",
        expected.volume
    );
    ensure!(found >= expected.largest - tolerance, "volume {found} below that of a brush, {}", expected.largest);
    ensure!(found <= expected.sum + tolerance, "volume {found} above the sum of the brushes', {}", expected.sum);
    let sum = evaluation.model.brush_volume_sum;
    ensure!((sum - expected.sum).abs() <= tolerance, "sum of the brushes' volumes {sum}, expected {}", expected.sum);
    Ok(())
}

/// The winding number of a mesh around a point: signed crossings of a ray. `None` where some sign is not certain.
fn winding_number(mesh: &Mesh, point: DVec3, ray: DVec3) -> Option<i32> {
    let sign = |u: DVec3, v: DVec3, w: DVec3| {
        let value = u.dot(v.cross(w));
        let certain = value.abs() > 16.0 * f64::EPSILON * u.length() * v.length() * w.length();
        certain.then_some(value > 0.0)
    };
    let mut crossings = 0;
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|v| mesh.positions[v as usize] - point);
        let sides = [sign(ray, a, b), sign(ray, b, c), sign(ray, c, a)];
        if sides.contains(&Some(true)) && sides.contains(&Some(false)) {
            continue;
        }
        // All sides agree or some are uncertain: the line meets the triangle, or nearly.
        if sides.contains(&None) {
            let behind = [a, b, c].iter().all(|p| p.dot(ray) < 0.0);
            if behind {
                continue;
            }
            return None;
        }
        let outward = sides[0]?;
        // The ray meets the plane ahead where the volume of the tetrahedron has the sign of the crossing.
        if sign(a, b, c)? == outward {
            crossings += if outward { 1 } else { -1 };
        }
    }
    Some(crossings)
}

/// Whether a point lies inside some brush; `None` within `margin` of any plane.
fn is_member(model: &Model, bounded: &[bool], point: DVec3, margin: f64) -> Option<bool> {
    let mut inside = false;
    for (brush, _) in model.tree.brushes().iter().zip(bounded).filter(|(_, bounded)| **bounded) {
        let distances = brush.faces.iter().map(|face| face.half_space.signed_distance(point));
        let mut all = true;
        for distance in distances {
            if distance.abs() <= margin {
                return None;
            }
            all &= distance < 0.0;
        }
        inside |= all;
    }
    Some(inside)
}

/// Compares winding numbers with membership: at points near the faces, between corners, and anywhere in the box.
pub(crate) fn check_membership(model: &Model, evaluation: &Evaluation, points: usize) -> Result<(), String> {
    let (mesh, solid) = (&evaluation.mesh, &evaluation.solid);
    if mesh.triangles.is_empty() {
        return Ok(());
    }
    let bounded: Vec<bool> =
        (0..model.tree.brushes().len()).map(|k| !evaluation.model.unbounded.contains(&k)).collect();
    let extent = solid.max - solid.min;
    let reach = solid.min.abs().max(solid.max.abs()).max_element();
    let margin = 1e-9 * extent.length() + contraction(solid) + snap_distance(evaluation, reach);
    let mut rng = Rng::spread(mesh.triangles.len() as u64);
    let mut decided = 0;
    for k in 0..points {
        let corner = |rng: &mut Rng| rng.pick(&mesh.positions);
        let point = match k % 3 {
            0 => {
                let t = rng.below(mesh.triangles.len());
                let corners = mesh.triangles[t].map(|v| mesh.positions[v as usize]);
                let weights = rng.point(0.1, 1.0);
                let on = weights.x * corners[0] + weights.y * corners[1] + weights.z * corners[2];
                let side = if rng.chance(0.5) { 20.0 } else { -20.0 };
                on / weights.element_sum() + side * margin * mesh.faces[mesh.triangle_faces[t] as usize].normal
            }
            1 => corner(&mut rng).lerp(corner(&mut rng), rng.float(-0.1, 1.1)),
            _ => solid.min + rng.point(-0.05, 1.05) * extent,
        };
        let Some(inside) = is_member(model, &bounded, point, margin) else { continue };
        let rays = (0..20).find_map(|_| winding_number(mesh, point, rng.unit()));
        let Some(winding) = rays else { continue };
        decided += 1;
        ensure!(winding == i32::from(inside), "winding number {winding} at {point:?}, expected {}", i32::from(inside));
    }
    // Needles and slabs far away can leave no point that is clearly on one side; elsewhere most points are.
    let is_thick = extent.min_element() > 1e-3 * reach;
    ensure!(decided > points / 4 || !is_thick, "only {decided} of {points} points could be judged");
    Ok(())
}
