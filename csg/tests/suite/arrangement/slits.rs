//! Facets that end in an edge through which others pass: these lie on both sides of it and are not divided by it.

use glam::DVec3;
use planecut_csg::{Inside, combine_meshes};
use planecut_testkit::meshes::box_mesh;
use planecut_testkit::random::Rng;
use planecut_testkit::scene::scaled;

use super::random::assert_combined;
use super::soup::Soup;

fn boxed(min: [f64; 3], max: [f64; 3]) -> Soup {
    let mesh = box_mesh(DVec3::from_array(min), DVec3::from_array(max), "stone");
    Soup { positions: mesh.positions, triangles: mesh.triangles }
}

/// A tetrahedron with its faces turned outwards.
fn tetrahedron(corners: [[f64; 3]; 4]) -> Soup {
    let positions = corners.map(DVec3::from_array).to_vec();
    let [a, b, c, d] = positions[..] else { unreachable!("there are four") };
    let is_inside_out = (b - a).dot((c - a).cross(d - a)) < 0.0;
    let mut triangles = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    if is_inside_out {
        triangles.iter_mut().for_each(|triangle| triangle.swap(0, 1));
    }
    Soup { positions, triangles }
}

/// Two boxes that share an edge, and a tetrahedron one plane of which passes through that edge, which ends within its face: where one or the other
/// is, the face lies on both sides of the edge, and four faces of the boxes end there.
#[test]
fn a_face_passes_through_an_edge_that_boxes_share() {
    let soups = [
        boxed([2.0, 1.0, 0.0], [4.0, 3.0, 2.0]),
        boxed([0.0, 1.0, 2.0], [2.0, 3.0, 4.0]),
        tetrahedron([[3.0, 5.0, 3.0], [0.0, 5.0, 3.0], [3.0, 2.0, 3.0], [0.0, 3.0, 0.0]]),
    ];
    let meshes = soups.each_ref().map(Soup::mesh);
    let volume = |is_solid: &dyn Fn(&Inside<'_>) -> bool| {
        combine_meshes(&meshes, Vec::new(), is_solid).expect("closed meshes").solid.volume
    };
    let boxes = |inside: &Inside<'_>| inside.of(0) || inside.of(1);
    let both = volume(&|inside| boxes(inside) && inside.of(2));
    let one = volume(&|inside| boxes(inside) != inside.of(2));
    // two boxes of 8, a third of a triangle of 4.5 by 3
    assert!((one - (16.0 + 4.5 - 2.0 * both)).abs() < 1e-12, "{one}, {both}");
    assert!(both > 0.0);
    for table in (0..=u8::MAX).step_by(2) {
        assert_combined(0, &soups, table.into());
    }
}

/// Directions from the axis to what lies around it.
const AROUND: [[f64; 2]; 8] =
    [[1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [-1.0, 1.0], [-1.0, 0.0], [-1.0, -1.0], [0.0, -1.0], [1.0, -1.0]];

/// A tetrahedron with an edge on an axis, or one of whose faces is passed through by a part of the axis.
fn at_axis(rng: &mut Rng) -> Soup {
    loop {
        let on_axis = |rng: &mut Rng| [3.0, 3.0, rng.below(6) as f64];
        let beside = |rng: &mut Rng, k: usize| {
            let ([x, y], far) = (AROUND[k % 8], 1.0 + rng.below(3) as f64);
            [3.0 + far * x, 3.0 + far * y, rng.below(6) as f64]
        };
        let k = rng.below(8);
        let corners = if rng.chance(0.4) {
            let other = k + 1 + rng.below(7);
            [on_axis(rng), on_axis(rng), beside(rng, k), beside(rng, other)]
        } else {
            let third = if rng.chance(0.5) { on_axis(rng) } else { beside(rng, k) };
            let off = k + 1 + rng.below(3);
            [beside(rng, k), beside(rng, k + 4), third, beside(rng, off)]
        };
        let [a, b, c, d] = corners.map(DVec3::from_array);
        if (b - a).dot((c - a).cross(d - a)) != 0.0 {
            return tetrahedron(corners);
        }
    }
}

/// Many faces around one axis, some that end there, some that pass through, so that they cross in it, too.
#[test]
fn faces_around_an_axis() {
    let mut asked = 0;
    for seed in 0..scaled(500) {
        let mut rng = Rng::spread(seed);
        let soups: Vec<Soup> = (0..4)
            .map(|_| {
                let mut soup = at_axis(&mut rng);
                (0..rng.below(3)).for_each(|_| soup.push(&at_axis(&mut rng)));
                soup
            })
            .collect();
        let parity = (0..16_u32).filter(|set| set.count_ones() % 2 == 1).map(|set| 1 << set).sum();
        let table = if rng.chance(0.5) { parity } else { u32::try_from(rng.bits() >> 48).expect("16 bits") & !1 };
        asked += assert_combined(seed, &soups, table);
    }
    assert!(asked > 5_000, "only {asked} triangles were large enough");
}
