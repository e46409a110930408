//! What any closed mesh must fulfil, whatever made it.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use planecut_kernel::DVec3;

/// Positions and polygons.
pub(crate) type Mesh = (Vec<DVec3>, Vec<Vec<usize>>);

/// Directed edges of the polygons cancel in pairs.
///
/// # Errors
/// An edge that does not, or a polygon that repeats a vertex.
pub(crate) fn check_closed((positions, polygons): &Mesh) -> Result<(), String> {
    let mut balance: BTreeMap<[usize; 2], i32> = BTreeMap::new();
    for polygon in polygons {
        let mut distinct = polygon.clone();
        distinct.sort_unstable();
        distinct.dedup();
        if distinct.len() != polygon.len() || polygon.len() < 3 || distinct.last() >= Some(&positions.len()) {
            return Err(format!("{polygon:?} is no polygon on {} vertices", positions.len()));
        }
        for (k, &a) in polygon.iter().enumerate() {
            let b = polygon[(k + 1) % polygon.len()];
            *balance.entry([a.min(b), a.max(b)]).or_default() += if a < b { 1 } else { -1 };
        }
    }
    match balance.iter().find(|(_, sum)| **sum != 0) {
        Some((edge, sum)) => Err(format!("edge {edge:?} is open: {sum}")),
        None => Ok(()),
    }
}

/// How often the mesh winds around `point`: the solid angles of its triangles over 4π.
/// 1 inside and 0 outside of a closed mesh whose polygons are counter-clockwise seen from outside.
pub(crate) fn winding_number((positions, polygons): &Mesh, point: DVec3) -> f64 {
    let fan = |polygon: &Vec<usize>| -> f64 {
        let corner = |k: usize| positions[polygon[k]] - point;
        (2..polygon.len()).map(|k| solid_angle(corner(0), corner(k - 1), corner(k))).sum()
    };
    polygons.iter().map(fan).sum::<f64>() / (2.0 * TAU)
}

/// Signed solid angle of a triangle seen from the origin (Van Oosterom and Strackee 1983).
fn solid_angle(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let (la, lb, lc) = (a.length(), b.length(), c.length());
    let denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    2.0 * a.dot(b.cross(c)).atan2(denominator)
}
