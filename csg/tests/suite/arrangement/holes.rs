//! Faces with holes that touch in corners: of brushes, of meshes, and of both.

use glam::{DVec2, DVec3};
use planecut_csg::{ClosedMesh, Evaluation, MaterialId, Mesh, MeshBody, Model, Tree, evaluate};
use planecut_testkit::meshes::{assert_closed, volume};
use planecut_testkit::random::Rng;
use planecut_testkit::scene::{brush, half_space, model, scaled};

use super::random::assert_combined;
use super::soup::Soup;

/// A convex body by its corners and triangles, which have planes of whole numbers: as a mesh or as a brush.
fn body(corners: &[DVec3], triangles: &[[u32; 3]], is_mesh: bool) -> Tree {
    if is_mesh {
        let mesh = ClosedMesh::new(corners, triangles, |_| 0).expect("it is closed");
        return MeshBody::new(mesh, vec![MaterialId(0)]).into();
    }
    let plane = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|vertex| corners[vertex as usize]);
        let normal = (b - a).cross(c - a);
        half_space(normal, normal.dot(a))
    };
    brush(triangles.iter().map(plane)).into()
}

/// Corners and triangles of a prism from one height to another over a convex polygon.
fn prism_of(outline: &[DVec2], [low, high]: [f64; 2]) -> Soup {
    let count = u32::try_from(outline.len()).expect("few corners");
    let positions: Vec<DVec3> = [low, high].iter().flat_map(|z| outline.iter().map(|p| p.extend(*z))).collect();
    let next = |k: u32| (k + 1) % count;
    let sides = (0..count).flat_map(|k| [[k, next(k), count + next(k)], [k, count + next(k), count + k]]);
    let caps = (1..count - 1).flat_map(|k| [[0, k + 1, k], [count, count + k, count + k + 1]]);
    Soup { positions, triangles: sides.chain(caps).collect() }
}

fn prism(outline: &[DVec2], heights: [f64; 2], is_mesh: bool) -> Tree {
    let Soup { positions, triangles } = prism_of(outline, heights);
    body(&positions, &triangles, is_mesh)
}

fn rectangle(min: DVec2, max: DVec2) -> [DVec2; 4] {
    [min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)]
}

fn outcome(tree: Tree, what: &str) -> Evaluation {
    let found = evaluate(&Model { materials: model(Vec::new()).materials, tree });
    found.unwrap_or_else(|error| panic!("{what}: {error}"))
}

fn corners(mesh: &Mesh) -> impl Iterator<Item = [DVec3; 3]> + '_ {
    mesh.triangles.iter().map(|triangle| triangle.map(|vertex| mesh.positions[vertex as usize]))
}

/// The area of what lies in a plane across an axis.
fn area_at(mesh: &Mesh, axis: usize, at: f64) -> f64 {
    let lies_there = |triangle: &[DVec3; 3]| triangle.iter().all(|corner| corner[axis] == at);
    corners(mesh).filter(lies_there).map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum()
}

/// A tetrahedron without another one leaves two notches in a wall, which touch in the one corner that is leftmost of both.
#[test]
fn two_notches_that_touch_in_their_leftmost_corner() {
    let a = [[3.0, 4.0, 2.0], [4.0, 4.0, 3.0], [3.0, 2.0, 4.0], [2.0, 4.0, 3.0]].map(DVec3::from_array);
    let b = [[1.0, 2.0, 5.0], [4.0, 4.0, 4.0], [3.0, 4.0, 2.0], [1.0, 4.0, 5.0]].map(DVec3::from_array);
    let (of_a, of_b) = ([[0, 1, 2], [3, 1, 0], [2, 1, 3], [2, 3, 0]], [[2, 1, 0], [3, 0, 1], [1, 2, 3], [2, 0, 3]]);
    let mut volumes = Vec::new();
    for set in 0..8_u32 {
        let [is_room, is_a, is_b] = [0, 1, 2].map(|k| set >> k & 1 == 1);
        let room = prism(&rectangle(DVec2::splat(-4.0), DVec2::new(5.0, 4.0)), [-4.0, 4.0], is_room);
        let tree = room & !(body(&a, &of_a, is_a) - body(&b, &of_b, is_b));
        let what = format!("{set}");
        let found = outcome(tree, &what);
        assert_closed(&found.mesh, &what);
        // the triangle of A in that wall has an area of 1, from which B keeps a triangle with a base of 3.5 − 7/3
        let area = area_at(&found.mesh, 1, 4.0);
        assert!((area - (72.0 - 1.0 + 0.5 * (3.5 - 7.0 / 3.0))).abs() < 1e-12, "{what}: {area}");
        volumes.push(found.solid.volume);
    }
    assert!(volumes.iter().all(|volume| (volume - volumes[0]).abs() < 1e-10), "{volumes:?}");
}

/// The points around a square with sides of six.
fn around(k: usize) -> DVec2 {
    let along = (k % 6) as f64;
    let corner = DVec2::new(3.0, -3.0 + along);
    (0..k / 6 % 4).fold(corner, |p, _| DVec2::new(-p.y, p.x))
}

/// A plate with triangular holes around two points, so that any number of them touch there, in corners between, and along edges.
#[test]
fn a_plate_with_holes_around_points() {
    for seed in 0..scaled(300) {
        let mut rng = Rng::spread(seed);
        let (share, meshes) = (rng.float(0.1, 0.9), rng.float(-0.3, 1.3));
        let plate = prism(&rectangle(DVec2::new(-4.0, -4.0), DVec2::new(10.0, 4.0)), [0.0, 1.0], rng.chance(meshes));
        let (mut holes, mut count) = (Vec::new(), 0);
        for middle in [DVec2::ZERO, DVec2::new(6.0, 0.0)] {
            for k in (0..24).filter(|_| rng.chance(share)).collect::<Vec<usize>>() {
                let outline = [middle, middle + around(k), middle + around(k + 1)];
                // some holes have a bottom
                let is_deep = rng.chance(0.8);
                count += if is_deep { 2 } else { 1 };
                holes.push(prism(&outline, [if is_deep { -1.0 } else { 0.5 }, 2.0], rng.chance(meshes)));
            }
        }
        let what = format!("seed {seed}");
        let found = outcome(plate - Tree::union(holes), &what);
        assert_closed(&found.mesh, &what);
        // each takes 1.5 from the top, and half of that, or all of it, from the volume
        let expected = 112.0 - 0.75 * f64::from(count);
        let volume = volume(corners(&found.mesh));
        assert!((volume - expected).abs() < 1e-9, "{what}: volume {volume}, expected {expected}");
        assert!((found.solid.volume - expected).abs() < 1e-9, "{what}: volume {}, {expected}", found.solid.volume);
    }
}

/// Prisms of few heights over triangles of a small grid: faces with islands, slits and holes that touch each other.
#[test]
fn prisms_over_triangles_of_a_grid() {
    let mut asked = 0;
    for seed in 0..scaled(300) {
        let mut rng = Rng::spread(seed);
        let size = 3 + rng.below(4);
        let soups: Vec<Soup> = (0..3)
            .map(|_| {
                let mut soup = Soup::default();
                for _ in 0..1 + rng.below(5) {
                    let mut outline = [0; 3].map(|_| DVec2::new(rng.below(size) as f64, rng.below(size) as f64));
                    let turn = (outline[1] - outline[0]).perp_dot(outline[2] - outline[0]);
                    if turn < 0.0 {
                        outline.swap(0, 1);
                    }
                    let low = rng.below(3) as f64;
                    if turn != 0.0 {
                        soup.push(&prism_of(&outline, [low, low + 1.0 + rng.below(2) as f64]));
                    }
                }
                // upright, or lying
                let axis = rng.below(3);
                soup.positions.iter_mut().for_each(|p| (0..axis).for_each(|_| *p = DVec3::new(p.y, p.z, p.x)));
                soup
            })
            .collect();
        let parity = 0b1001_0110;
        let table = if rng.chance(0.5) { parity } else { u32::try_from(rng.bits() >> 56).expect("8 bits") & !1 };
        asked += assert_combined(seed, &soups, table);
    }
    assert!(asked > 5_000, "only {asked} triangles were large enough");
}
