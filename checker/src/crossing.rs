//! Whether the surface of a mesh passes through itself.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::contact::Contact;
use crate::forest::Forest;
use crate::hubs::Groups;
use crate::pair::PairTest;
use crate::parallel;
use glam::DVec3;

/// The triangles that are in each other's way.
#[derive(Debug, Clone, PartialEq)]
pub struct CrossingReport {
    /// Number of triangles that cross or overlap another one.
    pub triangles: usize,
    /// The pair with the least indices.
    pub first: Option<Contact>,
    /// Contacts up to this depth, in the units of the positions, did not count.
    pub limit: f64,
}

/// Finds the triangles that cross or overlap another one.
///
/// Positions must be finite and indices in range; `twins` are the half-edge twins of the mesh. The `tolerance` is relative to
/// the diagonal of the bounding box or the largest coordinate, whichever is greater: rounding moves a vertex by a fraction of
/// its coordinates. See [`crate::CheckOptions::tolerance`] for what counts.
pub(crate) fn find_crossings(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    twins: &[u32],
    tolerance: f64,
) -> CrossingReport {
    find_and_count(positions, triangles, twins, tolerance).0
}

/// What [`find_crossings`] finds, and how many pairs of triangles and boxes it looked at.
fn find_and_count(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    twins: &[u32],
    tolerance: f64,
) -> (CrossingReport, usize) {
    let pairs = PairTest::new(positions, triangles, twins, tolerance);
    let count = triangles.len();
    let boxes = parallel::map(count, |t| pairs.bounds(t));
    let copies = copies(positions, triangles);
    let involved: Vec<AtomicBool> = (0..count).map(|_| AtomicBool::new(false)).collect();
    let is_involved = |t: u32| involved[t as usize].load(Ordering::Relaxed);
    let involve = |t: u32| involved[t as usize].store(true, Ordering::Relaxed);
    let test = |t: u32, u: u32| {
        // Pairs that would add nothing are skipped. The set of involved triangles is the same in whatever order they come.
        if !(is_involved(t) && is_involved(u)) && pairs.contact(t, u).is_some() {
            involve(t);
            involve(u);
        }
    };
    // Of triangles with the same corners two tell all about each other, and one tells about the rest.
    copies.iter().filter(|copies| copies.len() > 1).for_each(|copies| test(copies[0], copies[1]));
    let chosen: Vec<u32> = copies.iter().map(|copies| copies[0]).collect();
    let corners = |t: u32| pairs.scaled_corners(t as usize);
    let groups = Groups::new(pairs.scaled(), triangles, &chosen);
    let looks = Forest::new(groups, &corners, &boxes, pairs.margin()).visit_pairs(test);
    copies.iter().filter(|copies| is_involved(copies[0])).flatten().for_each(|&t| involve(t));
    let first = (0..count as u32).find(|&t| is_involved(t)).and_then(|t| {
        let is_near = |u: &u32| boxes[*u as usize].meets(&boxes[t as usize]);
        (0..count as u32).filter(is_near).find_map(|u| pairs.contact(t, u))
    });
    let triangles = (0..count as u32).filter(|&t| is_involved(t)).count();
    (CrossingReport { triangles, first, limit: pairs.limit() }, looks)
}

/// The triangles in sets of those with the same corners in the same order around; the sets by their least triangle.
fn copies(positions: &[DVec3], triangles: &[[u32; 3]]) -> Vec<Vec<u32>> {
    let key = |t: u32| {
        let [a, b, c] =
            triangles[t as usize].map(|vertex| (positions[vertex as usize] + DVec3::ZERO).to_array().map(f64::to_bits));
        [[a, b, c], [b, c, a], [c, a, b]].into_iter().min().unwrap_or([a, b, c])
    };
    let mut order: Vec<([[u64; 3]; 3], u32)> = (0..triangles.len() as u32).map(|t| (key(t), t)).collect();
    order.sort_unstable();
    let mut sets: Vec<Vec<u32>> =
        order.chunk_by(|a, b| a.0 == b.0).map(|set| set.iter().map(|(_, t)| *t).collect()).collect();
    sets.sort_unstable_by_key(|set| set[0]);
    sets
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use planecut_testkit::random::Rng;

    use super::*;
    use crate::topology::analyse;

    type Surface = (Vec<DVec3>, Vec<[u32; 3]>);

    /// A ring of corners between two points.
    fn bipyramid(corners: u32, height: f64) -> Surface {
        let angle = |k: u32| f64::from(k) / f64::from(corners) * TAU;
        let mut positions: Vec<DVec3> = (0..corners).map(|k| DVec3::new(angle(k).cos(), angle(k).sin(), 0.0)).collect();
        positions.extend([DVec3::Z * height, DVec3::NEG_Z]);
        let sides = |k: u32| [[k, (k + 1) % corners, corners], [(k + 1) % corners, k, corners + 1]];
        (positions, (0..corners).flat_map(sides).collect())
    }

    /// A prism, the caps of which are cut into triangles from one corner or, if `zigzag`, from side to side.
    fn prism(corners: u32, zigzag: bool) -> Surface {
        let angle = |k: u32| f64::from(k) / f64::from(corners) * TAU;
        let ring = |z: f64| (0..corners).map(move |k| DVec3::new(angle(k).cos(), angle(k).sin(), z));
        let positions = ring(0.0).chain(ring(1.0)).collect();
        let mut triangles: Vec<[u32; 3]> = (0..corners)
            .flat_map(|k| {
                let l = (k + 1) % corners;
                [[k, l, corners + l], [k, corners + l, corners + k]]
            })
            .collect();
        let mut cap = |t: [u32; 3]| {
            triangles.push(t.map(|v| corners + v));
            triangles.push([t[0], t[2], t[1]]);
        };
        let (mut low, mut high) = (0, corners - 1);
        while low + 1 < high {
            cap([low, low + 1, high]);
            low += 1;
            if zigzag && low + 1 < high {
                cap([low, high - 1, high]);
                high -= 1;
            }
        }
        (positions, triangles)
    }

    fn turned((positions, triangles): Surface) -> Surface {
        let turn = Rng::new(7).rotation();
        (positions.into_iter().map(|p| turn * p).collect(), triangles)
    }

    /// The surface `copies` times, as bodies of their own.
    fn repeated((positions, triangles): &Surface, copies: u32) -> Surface {
        let shifted = |k: u32| triangles.iter().map(move |t| t.map(|v| v + k * positions.len() as u32));
        ((0..copies).flat_map(|_| positions.clone()).collect(), (0..copies).flat_map(shifted).collect())
    }

    fn search((positions, triangles): &Surface) -> (CrossingReport, usize) {
        let (topology, twins) = analyse(positions, triangles);
        assert!(topology.manifold, "{:?}", topology.first_defect);
        find_and_count(positions, triangles, &twins, 1e-9)
    }

    /// Pairs looked at, of `n` triangles, as a multiple of `n` times the logarithm of `n` to base two.
    fn effort(surface: &Surface, is_sound: bool) -> f64 {
        let (report, looks) = search(surface);
        assert_eq!(report.first.is_none(), is_sound, "{report:?}");
        let n = surface.1.len() as f64;
        looks as f64 / (n * n.log2())
    }

    #[test]
    fn the_work_grows_no_faster_than_the_size_times_its_logarithm() {
        type Case = (&'static str, fn(u32) -> Surface, bool);
        let cases: [Case; 6] = [
            ("vertices of high degree", |n| turned(bipyramid(n, 1.0)), true),
            ("flat vertices of high degree", |n| turned(bipyramid(n, 0.0)), true),
            ("faces cut from a corner", |n| turned(prism(n, false)), true),
            ("faces cut from side to side", |n| turned(prism(n, true)), true),
            ("prisms along the axes", |n| prism(n, true), true),
            ("bodies on bodies", |n| repeated(&turned(prism(6, true)), n / 10), false),
        ];
        for (what, surface, is_sound) in cases {
            let efforts = [500, 4000].map(|n| effort(&surface(n), is_sound));
            println!("{what}: {efforts:?}");
            assert!(efforts.into_iter().all(|effort| effort < 8.0), "{what}: {efforts:?}");
        }
    }

    /// Thin triangles, most of which share corners with very many others.
    fn bundle(random: &mut Rng) -> Surface {
        let hubs = [random.point(-1.0, 1.0), random.point(-1.0, 1.0), DVec3::ZERO];
        let mut positions = Vec::new();
        for _ in 0..random.integer(100, 400) {
            let from = if random.chance(0.8) { hubs[random.below(3)] } else { random.point(-1.0, 1.0) };
            let to = from + random.unit() * random.float(0.1, 1.0);
            let width = 10.0_f64.powf(random.float(-5.0, -0.5));
            let corners = [from, to, to + random.unit() * width];
            // Some lie in one plane.
            positions.extend(if random.chance(0.5) { corners.map(|p| p * DVec3::new(1.0, 1.0, 0.0)) } else { corners });
        }
        let triangles = (0..positions.len() as u32 / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        (positions, triangles)
    }

    #[test]
    fn what_all_pairs_tell_is_found_among_those_that_are_looked_at() {
        let seed = 0x5eed_0006;
        let mut random = Rng::new(seed);
        for case in 0..40 {
            let (positions, triangles) = bundle(&mut random);
            let tolerance = [0.0, 1e-9, 1e-4][case % 3];
            let (_, twins) = analyse(&positions, &triangles);
            let (report, looks) = find_and_count(&positions, &triangles, &twins, tolerance);
            let pairs = PairTest::new(&positions, &triangles, &twins, tolerance);
            let count = triangles.len() as u32;
            let touches = |t: u32| (0..count).find_map(|u| pairs.contact(t, u));
            let contacts: Vec<Contact> = (0..count).filter_map(touches).collect();
            assert_eq!(report.triangles, contacts.len(), "seed {seed:#x} case {case}");
            assert_eq!(report.first, contacts.first().copied(), "seed {seed:#x} case {case}");
            assert!(looks > 0 && report.triangles > 4, "seed {seed:#x} case {case}: {report:?}");
        }
    }
}
