//! Flat faces of many triangles, which are cut as polygons: of cubes on a grid, and of prisms whose caps are fans around inner vertices.

use std::collections::HashMap;
use std::f64::consts::TAU;

use glam::{DVec2, DVec3};
use planecut_csg::{CombinedMeshes, combine_meshes};
use planecut_testkit::random::Rng;
use planecut_testkit::scene::scaled;

use super::random::assert_combined;
use super::soup::Soup;

/// The boundary of unit cubes on a grid of `size`: each square of it is cut along either diagonal.
pub(super) fn cubes(rng: &mut Rng, size: i32) -> Soup {
    let share = rng.float(0.2, 0.9);
    let cells = (0..size).flat_map(|x| (0..size).flat_map(move |y| (0..size).map(move |z| [x, y, z])));
    let filled: Vec<[i32; 3]> = cells.filter(|_| rng.chance(share)).collect();
    let mut soup = Soup::default();
    let mut number: HashMap<[i32; 3], u32> = HashMap::new();
    for cell in &filled {
        for (axis, is_high) in (0..3).flat_map(|axis| [(axis, false), (axis, true)]) {
            let mut neighbour = *cell;
            neighbour[axis] += if is_high { 1 } else { -1 };
            if filled.contains(&neighbour) {
                continue;
            }
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let square = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[s, t]| {
                let mut corner = *cell;
                corner[axis] += i32::from(is_high);
                corner[u] += s;
                corner[v] += t;
                *number.entry(corner).or_insert_with(|| {
                    soup.positions.push(DVec3::from_array(corner.map(f64::from)));
                    u32::try_from(soup.positions.len()).expect("few corners") - 1
                })
            });
            let turn = rng.below(2);
            let [a, b, c, d] = [0, 1, 2, 3].map(|k| square[(k + turn) % 4]);
            let triangles = [[a, b, c], [a, c, d]];
            soup.triangles.extend(triangles.map(|[a, b, c]| if is_high { [a, b, c] } else { [a, c, b] }));
        }
    }
    soup
}

/// A prism over a polygon that is seen as a whole from the origin, its caps fans around the axis; upright or lying.
pub(super) fn fan_prism(outline: &[DVec2], heights: [f64; 2], axis: usize) -> Soup {
    let count = u32::try_from(outline.len()).expect("few corners");
    let mut positions: Vec<DVec3> = heights.iter().flat_map(|z| outline.iter().map(|p| p.extend(*z))).collect();
    positions.extend(heights.map(|z| DVec3::new(0.0, 0.0, z)));
    let next = |k: u32| (k + 1) % count;
    let sides = (0..count).flat_map(|k| [[k, next(k), count + next(k)], [k, count + next(k), count + k]]);
    let caps = (0..count).flat_map(|k| [[2 * count, next(k), k], [2 * count + 1, count + k, count + next(k)]]);
    let triangles = sides.chain(caps).collect();
    positions.iter_mut().for_each(|p| (0..axis).for_each(|_| *p = DVec3::new(p.y, p.z, p.x)));
    Soup { positions, triangles }
}

/// Whole points around the origin, in order, with none of the gaps as wide as half a turn.
pub(super) fn star(rng: &mut Rng, size: usize) -> Vec<DVec2> {
    let directions = [[1, 0], [2, 1], [1, 1], [1, 2], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1]];
    let mut kept: Vec<[i32; 2]> = directions.into_iter().filter(|_| rng.chance(0.7)).collect();
    if kept.len() < 6 {
        kept = directions.to_vec();
    }
    kept.into_iter().map(|[x, y]| (1 + rng.below(size)) as f64 * DVec2::new(f64::from(x), f64::from(y))).collect()
}

fn table(rng: &mut Rng) -> u32 {
    u32::try_from(rng.bits() >> 40).expect("24 bits") & !1
}

fn soup(positions: &[[f64; 3]], triangles: &[[u32; 3]]) -> Soup {
    Soup { positions: positions.iter().copied().map(DVec3::from_array).collect(), triangles: triangles.to_vec() }
}

const TETRAHEDRON: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

fn assert_all_combined(soups: &[Soup]) {
    for table in (0..1 << (1 << soups.len())).step_by(2) {
        assert_combined(u64::from(table), soups, table);
    }
}

/// An edge of a tetrahedron is the diagonal of a box's face that another box lies upon.
#[test]
fn a_diagonal_that_is_an_edge_of_another_mesh() {
    let block = |max: DVec3| {
        let corner = |k: u32| DVec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2));
        let min = DVec3::new(2.0, 1.0, 1.0);
        let positions = (0..8).map(|k| min + corner(k) * (max - min)).collect();
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [3, 7, 5, 1]];
        let triangles = faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        Soup { positions, triangles }
    };
    let edge = soup(
        &[[0.0, 2.0, 3.0], [3.0, 2.0, 1.0], [3.0, 1.0, 3.0], [0.0, 3.0, 3.0]],
        &[[2, 0, 1], [0, 3, 1], [1, 3, 2], [2, 3, 0]],
    );
    assert_all_combined(&[block(DVec3::new(3.0, 2.0, 3.0)), block(DVec3::new(3.0, 3.0, 2.0)), edge]);
}

/// A flat tetrahedron, one of whose corners lies within its largest triangle, twice; and another one that passes through that corner.
#[test]
fn a_corner_within_two_copies_of_a_face() {
    let flat = soup(&[[0.0, 0.0, 3.0], [2.0, 1.0, 2.0], [2.0, 3.0, 0.0], [3.0, 0.0, 3.0]], &TETRAHEDRON);
    let mut both = soup(&[[3.0, 0.0, 3.0], [1.0, 2.0, 1.0], [0.0, 1.0, 0.0], [2.0, 3.0, 2.0]], &TETRAHEDRON);
    both.push(&flat);
    assert_all_combined(&[flat, both]);
}

/// Triangles without an area have the diagonal of a flat tetrahedron for an edge.
#[test]
fn a_diagonal_that_is_an_edge_of_triangles_without_area() {
    let flat = soup(&[[0.0; 3], [0.0, 0.0, 1.0], [1.0, 1.0, 0.0], [1.0; 3]], &TETRAHEDRON);
    let mut other = soup(&[[1.0; 3], [0.0; 3], [0.0; 3], [0.0; 3]], &TETRAHEDRON);
    other.push(&soup(&[[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 0.0], [0.0, 1.0, 1.0]], &TETRAHEDRON));
    assert_all_combined(&[flat, other]);
}

#[test]
fn cubes_on_a_grid() {
    let mut asked = 0;
    for seed in 0..scaled(200) {
        let mut rng = Rng::spread(seed);
        let mut soups: Vec<Soup> = (0..2).map(|_| cubes(&mut rng, 3)).collect();
        let shift = DVec3::from_array([0; 3].map(|_| rng.below(3) as f64 - 1.0));
        soups[1].positions.iter_mut().for_each(|p| *p += shift);
        if rng.chance(0.6) {
            soups.push(Soup::random(&mut rng, 4));
        }
        let table = table(&mut rng);
        asked += assert_combined(seed, &soups, table);
    }
    assert!(asked > 2_000, "only {asked} triangles were large enough");
}

#[test]
fn prisms_with_fans() {
    let mut asked = 0;
    for seed in 0..scaled(200) {
        let mut rng = Rng::spread(seed);
        let soups: Vec<Soup> = (0..3)
            .map(|_| {
                let low = rng.below(3) as f64;
                let heights = [low, low + 1.0 + rng.below(2) as f64];
                let outline = star(&mut rng, 3);
                let mut soup = fan_prism(&outline, heights, rng.below(3));
                let shift = DVec3::from_array([0; 3].map(|_| rng.below(3) as f64));
                soup.positions.iter_mut().for_each(|p| *p += shift);
                if rng.chance(0.2) { Soup::random(&mut rng, 5) } else { soup }
            })
            .collect();
        let table = table(&mut rng);
        asked += assert_combined(seed, &soups, table);
    }
    assert!(asked > 2_000, "only {asked} triangles were large enough");
}

/// Two discs, each a fan, that lie upon each other in part: what is left has triangles in proportion to those given, and the right volume.
#[test]
fn discs_in_one_plane() {
    for count in [16, 64, 256] {
        let angles = (0..count).map(|k| TAU * f64::from(k) / f64::from(count));
        let outline: Vec<DVec2> = angles.map(|angle| 10.0 * DVec2::from_angle(angle)).collect();
        let first = fan_prism(&outline, [0.0, 1.0], 0);
        let mut second = first.clone();
        second.positions.iter_mut().for_each(|p| *p += DVec3::new(7.0, 1.0, 0.0));
        let meshes = [first.mesh(), second.mesh()];
        let of = |is_solid: fn(bool, bool) -> bool| -> CombinedMeshes {
            combine_meshes(&meshes, Vec::new(), |inside| is_solid(inside.of(0), inside.of(1)))
                .unwrap_or_else(|error| panic!("{count}: {error}"))
        };
        let [one, both, either, less] =
            [of(|a, _| a), of(|a, b| a && b), of(|a, b| a || b), of(|a, b| a && !b)].map(|found| {
                let triangles = found.mesh.triangles.len();
                assert!(triangles <= 2 * first.triangles.len(), "{count}: {triangles} triangles");
                found.solid.volume
            });
        let area = 0.5 * 100.0 * f64::from(count) * (TAU / f64::from(count)).sin();
        assert!((one - area).abs() < 1e-9 * area, "{count}: {one}, expected {area}");
        assert!((either + both - 2.0 * one).abs() < 1e-9 * area, "{count}: {either} + {both}");
        assert!((less + both - one).abs() < 1e-9 * area, "{count}: {less} + {both}");
    }
}
