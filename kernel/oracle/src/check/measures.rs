//! Volume, area and centroid against sums of exact rational tetrahedra.

use std::array::from_fn;
use std::collections::BTreeMap;

use dashu_ratio::RBig;
use planecut_kernel::IncrementalPolytope;

use crate::solid::Solid;

/// Relative error of a sum of positive parts.
const SUM: f64 = 1e-12;
/// Relative error of a coordinate, with room for a few operations on it.
const COORDINATE: f64 = 1e-14;

type Point = [RBig; 3];

/// Compares `measures()`; `loops` are the faces' vertices in counter-clockwise order.
///
/// # Errors
/// The measure that is off by more than the rounding of the corners explains.
pub(super) fn compare_measures(
    polytope: &IncrementalPolytope,
    solid: &Solid,
    loops: &BTreeMap<usize, Vec<usize>>,
) -> Result<(), String> {
    let got = polytope.measures().ok_or("no measures of a bounded polytope")?;
    let (volume, centroid) = volume_and_centroid(solid, loops);
    let exact_volume = float(&volume);
    let area: f64 = loops.values().map(|l| face_area(solid, l)).sum();
    let coordinates = || solid.vertices.iter().flat_map(|v| v.position.iter().map(float));
    let extent = coordinates().fold(0.0, |m: f64, c| m.max(c.abs()));
    // the products of four lengths in these sums must stay in the range of floats
    let representable = |value: f64, power: i32| (10f64.powi(-power)..=10f64.powi(power)).contains(&value);
    if !(representable(extent, 70) && representable(area, 140) && representable(exact_volume, 210)) {
        return Ok(());
    }
    let diameter = (0..3).map(|i| spread(solid, i)).fold(0.0, f64::max) * 2.0;
    let moved = COORDINATE * extent;

    within("volume", got.volume, exact_volume, SUM * exact_volume + moved * area)?;
    within("area", got.area, area, SUM * area + moved * diameter * solid.edges.len() as f64)?;
    let uncertain = moved * area / exact_volume;
    let room = diameter * (SUM + 10.0 * uncertain) + moved;
    // Where rounding moves the corners by as much as the body is thick, any point may come out.
    if uncertain < 1e-3 {
        for (got, exact) in got.centroid.to_array().into_iter().zip(&centroid) {
            within("centroid", got, float(exact), room)?;
        }
    }
    Ok(())
}

fn within(what: &str, got: f64, exact: f64, room: f64) -> Result<(), String> {
    if (got - exact).abs() <= room {
        Ok(())
    } else {
        Err(format!("{what}: kernel {got:e}, exactly {exact:e} ± {room:e}"))
    }
}

fn float(value: &RBig) -> f64 {
    value.to_f64().value()
}

fn spread(solid: &Solid, axis: usize) -> f64 {
    let coordinates = || solid.vertices.iter().map(|v| &v.position[axis]);
    coordinates().max().zip(coordinates().min()).map_or(0.0, |(high, low)| float(&(high - low)))
}

fn minus(a: &Point, b: &Point) -> Point {
    from_fn(|i| &a[i] - &b[i])
}

fn cross(a: &Point, b: &Point) -> Point {
    from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        &a[j] * &b[k] - &a[k] * &b[j]
    })
}

/// Corners of the fan triangles of a polygon.
fn fan(polygon: &[usize]) -> impl Iterator<Item = [usize; 3]> {
    (2..polygon.len()).map(|k| [polygon[0], polygon[k - 1], polygon[k]])
}

/// Sums over the tetrahedra from the first vertex to all triangles of all faces.
fn volume_and_centroid(solid: &Solid, loops: &BTreeMap<usize, Vec<usize>>) -> (RBig, Point) {
    let at = |v: usize| &solid.vertices[v].position;
    let apex = at(0);
    let mut six_volumes = RBig::ZERO;
    let mut moment: Point = from_fn(|_| RBig::ZERO);
    for triangle in loops.values().flat_map(|l| fan(l)) {
        let [a, b, c] = triangle.map(|v| minus(at(v), apex));
        let normal = cross(&b, &c);
        let part = (0..3).fold(RBig::ZERO, |sum, i| sum + &a[i] * &normal[i]);
        moment = from_fn(|i| &moment[i] + &part * (&a[i] + &b[i] + &c[i]));
        six_volumes += part;
    }
    let centroid = from_fn(|i| &apex[i] + &moment[i] / (&six_volumes * RBig::from(4)));
    (six_volumes / RBig::from(6), centroid)
}

/// Half the length of the sum of the cross products of a fan, exact up to the root.
fn face_area(solid: &Solid, polygon: &[usize]) -> f64 {
    let at = |v: usize| &solid.vertices[v].position;
    let sum: Point = fan(polygon).fold(from_fn(|_| RBig::ZERO), |sum: Point, [a, b, c]| {
        let normal = cross(&minus(at(b), at(a)), &minus(at(c), at(a)));
        from_fn(|i| &sum[i] + &normal[i])
    });
    let square = (0..3).fold(RBig::ZERO, |s, i| s + &sum[i] * &sum[i]);
    float(&square).sqrt() / 2.0
}
