//! The winding number of a mesh around a point, in integers: an oracle that shares nothing with the crate.

use glam::DVec3;

use super::soup::Soup;

/// Points lie on a grid of this many steps to a unit. With coordinates below 2⁴ determinants of three stay far below 2¹²⁷.
const STEPS: f64 = (1_u64 << 30) as f64;

type Vector = [i128; 3];

fn grid(point: DVec3) -> Vector {
    point.to_array().map(|v| (v * STEPS).round() as i128)
}

fn minus(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn determinant(a: Vector, b: Vector, c: Vector) -> i128 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0])
}

/// How often a mesh with corners on the grid winds around the grid point next to one, along the first ray that meets no edge; none
/// where the point lies on the mesh.
pub(super) fn winding(soup: &Soup, point: DVec3) -> Option<i32> {
    let point = grid(point);
    [[1009, 757, 331], [-613, 881, 1021], [419, -977, 743]].into_iter().find_map(|ray| along(soup, point, ray))
}

fn along(soup: &Soup, point: Vector, ray: Vector) -> Option<i32> {
    let mut winding = 0;
    for triangle in &soup.triangles {
        let [a, b, c] = triangle.map(|vertex| minus(grid(soup.positions[vertex as usize]), point));
        let sides = [determinant(ray, a, b), determinant(ray, b, c), determinant(ray, c, a)].map(i128::signum);
        if sides.contains(&0) {
            return None;
        }
        if sides[0] != sides[1] || sides[1] != sides[2] {
            continue;
        }
        // the ray's line passes through the triangle; the point is before it where both agree
        let height = determinant(a, b, c).signum();
        if height == 0 {
            return None;
        }
        if height == i128::from(i64::try_from(sides[0]).expect("a sign")) {
            winding += i32::try_from(height).expect("a sign");
        }
    }
    Some(winding)
}

/// The oracle agrees with what a unit box says of itself.
#[test]
fn a_box_winds_once_around_what_is_in_it() {
    let positions: Vec<DVec3> =
        (0..8).map(|k: u32| DVec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2))).collect();
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    let soup = Soup { positions, triangles };
    assert_eq!(winding(&soup, DVec3::new(0.3, 0.45, 0.7)), Some(1));
    assert_eq!(winding(&soup, DVec3::new(0.3, 0.45, 1.7)), Some(0));
    assert_eq!(winding(&soup, DVec3::new(0.3, 0.45, 1.0)), None);
}
