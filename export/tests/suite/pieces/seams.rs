//! Surfaces that touch themselves where pieces meet: what belongs together is one vertex, what touches is not.

use glam::DVec3;
use planecut_csg::Mesh;
use planecut_export::Format;

use super::readers::{self, options};
use super::support::{assert_index_closed, assert_one_fan_at_each_vertex, encoded, open_mesh, prism};

/// Both formats with indices.
fn read_all(pieces: &[Mesh], what: &str) -> Vec<readers::Read> {
    let obj = readers::obj(&encoded(pieces, Format::Obj, &options(false, false, 1.0)).0);
    let ply = readers::ply(&encoded(pieces, Format::Ply, &options(false, false, 1.0)).0);
    for read in [&obj, &ply] {
        assert_index_closed(&read.indices, what);
        assert_one_fan_at_each_vertex(&read.indices, what);
    }
    vec![obj, ply]
}

fn joined(meshes: &[Mesh]) -> Mesh {
    let mut all = Mesh { materials: meshes[0].materials.clone(), ..Mesh::default() };
    for mesh in meshes {
        let (vertices, faces) = (all.positions.len() as u32, all.faces.len() as u32);
        all.positions.extend(&mesh.positions);
        all.triangles.extend(mesh.triangles.iter().map(|triangle| triangle.map(|corner| corner + vertices)));
        all.triangle_faces.extend(mesh.triangle_faces.iter().map(|face| face + faces));
        all.faces.extend(&mesh.faces);
    }
    all
}

/// Two bars that touch along an edge across the wall, each in two pieces: at the wall four vertices of two pieces have one position.
#[test]
fn bars_that_touch_stay_apart() {
    let bar = |low: [f64; 2], z: [f64; 2]| {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| [low[0] + x, low[1] + y]);
        let positions: Vec<DVec3> = z.into_iter().flat_map(|z| square.map(|[x, y]| DVec3::new(x, y, z))).collect();
        open_mesh(&positions, &prism(4), |at| at.z == 0.0)
    };
    // -0 is 0
    let below = joined(&[bar([0.0, 0.0], [-1.0, -0.0]), bar([1.0, 1.0], [-1.0, -0.0])]);
    let above = joined(&[bar([1.0, 1.0], [0.0, 2.0]), bar([0.0, 0.0], [0.0, 2.0])]);
    let mut sewn = below.clone();
    // the second bar has the vertex of the first at the wall, as if a face had joined them there
    let at_touch = |mesh: &Mesh| -> Vec<u32> {
        (0..).zip(&mesh.positions).filter(|(_, at)| **at == DVec3::new(1.0, 1.0, 0.0)).map(|(k, _)| k).collect()
    };
    let [one, other] = at_touch(&below)[..] else { panic!("two vertices expected") };
    sewn.triangles.as_flattened_mut().iter_mut().filter(|corner| **corner == other).for_each(|corner| *corner = one);
    for pieces in [[below.clone(), above.clone()], [above.clone(), below], [sewn.clone(), above.clone()], [above, sewn]]
    {
        for read in read_all(&pieces, "bars") {
            assert_eq!(read.positions.len(), 24);
        }
    }
}

/// Two wedges that touch along the line in which two walls cross, each in two pieces: four open edges lie on the line. In whatever order
/// the pieces come, each wedge is put together.
#[test]
fn wedges_around_a_crossing_of_walls_stay_apart() {
    let wedge = |from: f64, to: f64| {
        let around = [from, to].map(|degrees: f64| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let onto_wall = |value: f64| if value.abs() < 1e-9 { 0.0 } else { value };
            [onto_wall(cos), onto_wall(sin)]
        });
        let corners = [[0.0, 0.0], around[0], around[1]];
        let positions: Vec<DVec3> =
            [0.0, 1.0].into_iter().flat_map(|z| corners.map(|[x, y]| DVec3::new(x, y, z))).collect();
        let is_wall = |degrees: f64| degrees % 90.0 == 0.0;
        let mesh = open_mesh(&positions, &prism(3), |_| false);
        let mut triangles = mesh.triangles;
        // the sides to the left and right of the line: corners 0 and 1, and 2 and 0
        let of_side =
            |triangle: &[u32; 3], side: u32| triangle.iter().all(|corner| corner % 3 == 0 || corner % 3 == side);
        triangles.retain(|triangle| !(is_wall(from) && of_side(triangle, 1) || is_wall(to) && of_side(triangle, 2)));
        open_mesh(&positions, &triangles, |_| false)
    };
    let pieces = [wedge(30.0, 90.0), wedge(90.0, 120.0), wedge(210.0, 270.0), wedge(270.0, 300.0)];
    for first in 0..4 {
        for second in (0..4).filter(|k| *k != first) {
            for third in (0..4).filter(|k| ![first, second].contains(k)) {
                let order = [first, second, third, 6 - first - second - third];
                for read in read_all(&order.map(|k| pieces[k].clone()), &format!("order {order:?}")) {
                    // of each wedge three outer corners and one on the line, below and above
                    assert_eq!(read.positions.len(), 16, "order {order:?}");
                }
            }
        }
    }
}
