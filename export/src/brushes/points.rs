//! Three points that say the plane of a face.

use glam::DVec3;

use super::body::{Body, BodyFace};
use super::lattice::IntegerPlane;

/// Most digits after the point in coordinates that say a plane exactly: readers take longer ones for rounded numbers.
const MAX_PLACES: u32 = 6;
/// A triangle of corners is taken if its height is at least this share of the body's size: its plane then is off by no more than
/// that many roundings where the body is widest.
const LEAST_HEIGHT: f64 = 1.0 / 1024.0;
/// And at least this share of the largest coordinate, so that rounding leaves a triangle. Free points are much farther apart.
const LEAST_RELATIVE: [f64; 2] = [1.0 / (1u64 << 30) as f64, 1.0 / (1u64 << 16) as f64];

/// Three points of a face's plane, counter-clockwise seen from outside and not on one line.
///
/// Points of a grid of few places are preferred, corners among them. Where these do not say the plane exactly, three corners do
/// as well as rounding allows, unless the face is so narrow that its plane would tilt: then points farther apart are sought.
pub(super) fn three_points(body: &Body, face: &BodyFace) -> [DVec3; 3] {
    let rounded = || along_axis(body, face).or_else(|| corners(body, face)).unwrap_or_else(|| apart(body, face));
    exact(body, face).unwrap_or_else(rounded)
}

/// Points on a decimal grid, where the plane holds three that are not far away.
fn exact(body: &Body, face: &BodyFace) -> Option<[DVec3; 3]> {
    let plane = IntegerPlane::new(face.normal, face.offset)?;
    let farthest = 4.0 * (body.reach + body.size);
    let (middle, _) = around(body, face);
    (0..=MAX_PLACES).find_map(|places| {
        let lattice = plane.lattice(places)?;
        let corners: Vec<DVec3> = face.corners.iter().filter_map(|corner| lattice.at(*corner)).collect();
        let of_corners = largest_triangle(&corners).filter(|points| height(points) > LEAST_HEIGHT * body.size);
        of_corners.or_else(|| {
            let wide = face.corners.iter().map(|corner| corner.distance(middle)).fold(0.0, f64::max);
            if lattice.step() <= farthest { lattice.points(middle, wide) } else { None }
        })
    })
}

/// Of a plane that is parallel to one axis, as the walls of an extrusion are: two points side by side along the axis, so that
/// it stays parallel.
fn along_axis(body: &Body, face: &BodyFace) -> Option<[DVec3; 3]> {
    let axis = (0..3).find(|axis| face.normal[*axis] == 0.0)?;
    let across = DVec3::AXES[axis].cross(face.normal.normalize());
    let by_place = |a: &&DVec3, b: &&DVec3| a.dot(across).total_cmp(&b.dot(across));
    let [mut first, mut last] = [*face.corners.iter().min_by(by_place)?, *face.corners.iter().max_by(by_place)?];
    if (last - first).dot(across) < least_height(body) {
        let (middle, radius) = around(body, face);
        [first, last] = [middle - radius * across, middle + radius * across].map(|point| onto_plane(point, face));
    }
    let mut beside = first;
    beside[axis] += (last - first).length();
    // seen from outside, the axis is a quarter turn counter-clockwise from the way across
    Some([first, last, beside])
}

/// Corners, where these are far enough apart.
fn corners(body: &Body, face: &BodyFace) -> Option<[DVec3; 3]> {
    largest_triangle(&face.corners).filter(|points| height(points) >= least_height(body))
}

/// The least height of a triangle that leaves a plane in its place.
fn least_height(body: &Body) -> f64 {
    (LEAST_HEIGHT * body.size).max(LEAST_RELATIVE[0] * body.reach)
}

/// The middle of a face, and how far around it points may well be.
fn around(body: &Body, face: &BodyFace) -> (DVec3, f64) {
    let middle = face.corners.iter().sum::<DVec3>() / face.corners.len() as f64;
    (middle, (0.5 * body.size).max(LEAST_RELATIVE[1] * body.reach))
}

/// Points around the face that are as far apart as the body is wide.
fn apart(body: &Body, face: &BodyFace) -> [DVec3; 3] {
    let normal = face.normal.normalize();
    let (middle, radius) = around(body, face);
    let (u, v) = normal.any_orthonormal_pair();
    [0.0, 1.0, 2.0].map(|turn: f64| {
        let (sine, cosine) = (turn * std::f64::consts::TAU / 3.0).sin_cos();
        onto_plane(middle + radius * (cosine * u + sine * v), face)
    })
}

/// The point on the plane along the axis that the normal is nearest to, that coordinate rounded about once.
fn onto_plane(mut point: DVec3, face: &BodyFace) -> DVec3 {
    let axis = face.normal.abs().max_position();
    for _ in 0..2 {
        // how far it is off, with the roundings of all products and sums made good
        let (mut sum, mut lost) = (face.offset, 0.0);
        for k in 0..3 {
            let product = -face.normal[k] * point[k];
            lost += (-face.normal[k]).mul_add(point[k], -product);
            let next = sum + product;
            let part = next - sum;
            lost += (sum - (next - part)) + (product - part);
            sum = next;
        }
        point[axis] += (sum + lost) / face.normal[axis];
    }
    point
}

/// Three points of a convex polygon, in its order, of which none can be replaced by another so that they span more.
fn largest_triangle(points: &[DVec3]) -> Option<[DVec3; 3]> {
    let n = points.len();
    if n < 3 {
        return None;
    }
    let area = |[a, b, c]: [usize; 3]| (points[b] - points[a]).cross(points[c] - points[a]).length_squared();
    let farthest = |from: usize| {
        let distance = |k: &usize| points[*k].distance_squared(points[from]);
        (0..n).max_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0)
    };
    let mut best = [0, farthest(0), 0];
    let mut most = 0.0;
    loop {
        let before = most;
        for place in 0..3 {
            for k in 0..n {
                let mut other = best;
                other[place] = k;
                let spans = area(other);
                if spans > most {
                    (best, most) = (other, spans);
                }
            }
        }
        // areas grow at every turn, and there are finitely many
        if most <= before {
            break;
        }
    }
    best.sort_unstable();
    (most > 0.0).then(|| best.map(|k| points[k]))
}

/// The smallest height of a triangle; 0 where it has no area.
fn height([a, b, c]: &[DVec3; 3]) -> f64 {
    let longest = [a.distance(*b), b.distance(*c), c.distance(*a)].into_iter().fold(0.0, f64::max);
    if longest == 0.0 { 0.0 } else { (b - a).cross(c - a).length() / longest }
}
