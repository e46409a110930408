//! Triangulations held against what defines them, and against others of the same sites and constraints.

use std::collections::BTreeMap;

use planecut_testkit::random::Rng;

use super::predicates::{is_in_circle, orient};
use super::*;

/// Loops of points, by name; boundary edges are named by the points at which they begin.
type Loops = Vec<Vec<[i32; 2]>>;

fn at([x, y]: [i32; 2]) -> DVec2 {
    DVec2::new(f64::from(x), f64::from(y))
}

fn name([x, y]: [i32; 2]) -> HalfEdgeId {
    HalfEdgeId::from_index(((x + 500) * 1000 + y + 500) as usize)
}

fn point(name: HalfEdgeId) -> [i32; 2] {
    let number = name.index() as i32;
    [number / 1000 - 500, number % 1000 - 500]
}

/// A triangulation and the sites by their points.
struct Kept {
    delaunay: Delaunay,
    sites: BTreeMap<[i32; 2], SiteId>,
}

impl Kept {
    fn new() -> Self {
        let delaunay = Delaunay::new(DVec2::splat(-40.0), DVec2::splat(40.0));
        Self { delaunay, sites: BTreeMap::new() }
    }

    fn add(&mut self, points: &[[i32; 2]], order: impl Fn(&mut Vec<[i32; 2]>)) {
        let mut all = points.to_vec();
        order(&mut all);
        for point in all {
            let site = self.delaunay.insert(at(point)).expect("no point is there twice");
            self.sites.insert(point, site);
        }
        for (from, to) in edges(points) {
            self.delaunay.constrain(self.sites[&from], self.sites[&to], name(from)).expect("loops do not cross");
        }
    }

    fn take(&mut self, points: &[[i32; 2]]) {
        for (from, to) in edges(points) {
            self.delaunay.release(self.sites[&from], self.sites[&to]).expect("the edge is there");
        }
        for point in points {
            self.delaunay.remove(self.sites.remove(point).expect("the point is there")).expect("it can go");
        }
    }

    /// The triangles of the face by the points at which their corners' boundary edges begin, sorted.
    fn triangles(&mut self) -> Vec<[[i32; 2]; 3]> {
        self.delaunay.find_zones();
        let triangle = |place| {
            let mut corners = self.delaunay.triangle(place).map(|side| point(side.0));
            let least = (0..3).min_by_key(|k| corners[*k]).expect("three corners");
            corners.rotate_left(least);
            corners
        };
        let mut all: Vec<_> = (0..self.delaunay.triangle_count()).map(triangle).collect();
        all.sort_unstable();
        all
    }

    /// That all is linked, turns left, and is Delaunay where no constraint is.
    fn check(&self) {
        let delaunay = &self.delaunay;
        for half_edge in 0..number32(delaunay.from.len()) {
            if delaunay.is_free(half_edge / 3) {
                continue;
            }
            let twin = delaunay.twin(half_edge);
            let [a, b, c] = [delaunay.from(half_edge), delaunay.to(half_edge), delaunay.apex(half_edge)];
            assert!(delaunay.turn(a, b, c) > 0.0, "a triangle turns left");
            if twin == NONE {
                continue;
            }
            assert_eq!((delaunay.twin(twin), delaunay.from(twin), delaunay.to(twin)), (half_edge, b, a));
            assert_eq!(delaunay.side(half_edge) == Side::Free, delaunay.side(twin) == Side::Free);
            if delaunay.side(half_edge) == Side::Free {
                let d = delaunay.apex(twin);
                let [a, b, c, d] = [a, b, c, d].map(|site| delaunay.at(site));
                assert!(!is_in_circle(a, b, c, d), "{a} {b} {c} {d}");
            }
        }
    }
}

fn edges(points: &[[i32; 2]]) -> impl Iterator<Item = ([i32; 2], [i32; 2])> + '_ {
    points.iter().copied().zip(points.iter().copied().cycle().skip(1))
}

/// Twice the area within loops, holes counting as less.
fn area(loops: &Loops) -> f64 {
    loops.iter().flat_map(|points| edges(points)).map(|(p, q)| at(p).perp_dot(at(q))).sum()
}

/// A polygon around a place, of corners on a grid: on a circle, or any star.
fn polygon(random: &mut Rng, [x, y]: [i32; 2], radius: i32) -> Vec<[i32; 2]> {
    if random.chance(0.3) {
        // a square with points on its sides: collinear, and on circles
        let half = 1 + random.below(radius as usize) as i32;
        let corners = [[-half, -half], [0, -half], [half, -half], [half, half], [-half, half], [-half, 0]];
        return corners.map(|[u, v]| [x + u, y + v]).to_vec();
    }
    let mut points: Vec<[i32; 2]> = Vec::new();
    let count = 3 + random.below(9);
    for k in 0..count {
        let angle = std::f64::consts::TAU * k as f64 / count as f64;
        let length = f64::from(radius) * if random.chance(0.5) { 1.0 } else { random.float(0.4, 1.0) };
        let place = [x + (length * angle.cos()).round() as i32, y + (length * angle.sin()).round() as i32];
        if !points.contains(&place) {
            points.push(place);
        }
    }
    let turns_left = edges(&points).all(|(p, q)| orient(at([x, y]), at(p), at(q)) > 0.0);
    if points.len() > 2 && turns_left { points } else { vec![[x - 1, y - 1], [x + 1, y - 1], [x, y + 1]] }
}

fn hole(random: &mut Rng, place: usize) -> Vec<[i32; 2]> {
    let center = [-24 + 12 * (place % 5) as i32, -24 + 12 * (place / 5) as i32];
    let mut points = polygon(random, center, 5);
    points.reverse();
    points
}

#[test]
fn a_perturbed_circle_is_broken_the_same_way_from_both_triangles() {
    let mut random = Rng::spread(1);
    let on_circle =
        [[5, 0], [4, 3], [3, 4], [0, 5], [-3, 4], [-4, 3], [-5, 0], [-4, -3], [-3, -4], [0, -5], [3, -4], [4, -3]];
    for _ in 0..2000 {
        let mut four: Vec<usize> = Vec::new();
        while four.len() < 4 {
            let k = random.below(12);
            if !four.contains(&k) {
                four.push(k);
            }
        }
        four.sort_unstable();
        let [a, d, b, c] = [0, 1, 2, 3].map(|k| at(on_circle[four[k]]));
        // the quadrilateral a d b c with either diagonal
        assert_ne!(is_in_circle(a, b, c, d), is_in_circle(c, d, b, a), "{a} {d} {b} {c}");
        assert_eq!(is_in_circle(a, b, c, d), is_in_circle(b, c, a, d));
        assert_eq!(is_in_circle(a, b, c, d), is_in_circle(b, a, d, c));
    }
}

#[test]
fn whatever_comes_and_goes_it_is_the_triangulation_of_what_is_there() {
    for seed in 0..60 {
        let mut random = Rng::spread(seed);
        let mut kept = Kept::new();
        let mut outer = polygon(&mut random, [0, 0], 38);
        if outer.len() < 6 {
            outer = vec![[-38, -38], [38, -38], [38, 38], [0, 38], [-38, 38]];
        }
        let outer = if seed % 2 == 0 { vec![[-38, -38], [38, -38], [38, 38], [-38, 38]] } else { outer };
        let mut loops: BTreeMap<usize, Vec<[i32; 2]>> = BTreeMap::new();
        let is_around = |points: &[[i32; 2]]| {
            edges(&outer).all(|(p, q)| points.iter().all(|point| orient(at(p), at(q), at(*point)) > 0.0))
        };
        kept.add(&outer, |_| {});
        for step in 0..80 {
            let place = random.below(25);
            match loops.remove(&place) {
                Some(points) => kept.take(&points),
                None => {
                    let points = hole(&mut random, place);
                    if !is_around(&points) {
                        continue;
                    }
                    kept.add(&points, |_| {});
                    loops.insert(place, points);
                }
            }
            kept.check();
            let all: Loops = std::iter::once(outer.clone()).chain(loops.values().cloned()).collect();
            let triangles = kept.triangles();
            let sum: f64 = triangles.iter().map(|corners| orient(at(corners[0]), at(corners[1]), at(corners[2]))).sum();
            assert_eq!(sum, area(&all), "seed {seed}, step {step}");
            // all at once, in another order
            let mut fresh = Kept::new();
            for points in all.iter().rev() {
                fresh.add(points, |all| all.reverse());
            }
            assert_eq!(triangles, fresh.triangles(), "seed {seed}, step {step}");
        }
    }
}

#[test]
fn loops_that_cross_or_share_a_place_are_conflicts() {
    let square = |low: i32, high: i32| vec![[low, low], [high, low], [high, high], [low, high]];
    let mut kept = Kept::new();
    kept.add(&square(-10, 10), |_| {});
    assert_eq!(kept.delaunay.insert(at([10, 10])), Err(Conflict));
    assert_eq!(kept.delaunay.insert(at([10, 0])), Err(Conflict));
    let [inner, outer] = [[0, 0], [20, 1]].map(|place| kept.delaunay.insert(at(place)).expect("free"));
    assert_eq!(kept.delaunay.constrain(inner, outer, name([0, 0])), Err(Conflict));
    let beyond = kept.delaunay.insert(at([-5, 0])).expect("free");
    let [one, other] = [[-3, 0], [5, 0]].map(|place| kept.delaunay.insert(at(place)).expect("free"));
    assert_eq!(kept.delaunay.constrain(beyond, other, name([-5, 0])), Err(Conflict));
    assert_eq!(kept.delaunay.constrain(beyond, one, name([-5, 0])), Ok(()));
    assert_eq!(kept.delaunay.insert(DVec2::new(1e70, 0.0)), Err(Conflict));
    kept.check();
}

#[test]
fn corners_at_one_site_are_told_apart() {
    // two triangles of a face that touch in a point
    let bow = [[0, 0], [10, -10], [10, 10]];
    let mut kept = Kept::new();
    kept.add(&bow, |_| {});
    let [left, low] = [[-10, 10], [-10, -10]].map(|place| kept.delaunay.insert(at(place)).expect("free"));
    let middle = kept.sites[&[0, 0]];
    let names = [[-1, 0], [-10, 10], [-10, -10]].map(name);
    for ((from, to), piece) in [(middle, left), (left, low), (low, middle)].into_iter().zip(names) {
        kept.delaunay.constrain(from, to, piece).expect("free");
    }
    assert_eq!(kept.triangles(), [[[-10, -10], [-1, 0], [-10, 10]], [[0, 0], [10, -10], [10, 10]]]);
}

#[test]
fn a_face_with_holes_in_rows_is_delaunay() {
    // a side of a Menger sponge
    let mut loops: Loops = vec![vec![[0, 0], [27, 0], [27, 27], [0, 27]]];
    for width in [9, 3, 1] {
        for (i, j) in
            (0..27 / width).flat_map(|i| (0..27 / width).map(move |j| (i, j))).filter(|(i, j)| i % 3 == 1 && j % 3 == 1)
        {
            let [x, y] = [i * width, j * width];
            let is_within = |hole: &Vec<[i32; 2]>| {
                let (low, high) = (hole[0], hole[2]);
                (low[0]..high[0]).contains(&x) && (low[1]..high[1]).contains(&y)
            };
            if !loops[1..].iter().any(is_within) {
                loops.push(vec![[x, y], [x, y + width], [x + width, y + width], [x + width, y]]);
            }
        }
    }
    let mut kept = Kept::new();
    for points in &loops {
        for point in points {
            let site = kept.delaunay.insert(at(*point)).expect("no point is there twice");
            kept.sites.insert(*point, site);
        }
    }
    kept.check();
    for points in &loops {
        for (from, to) in edges(points) {
            kept.delaunay.constrain(kept.sites[&from], kept.sites[&to], name(from)).expect("loops do not cross");
            kept.check();
        }
    }
    let triangles = kept.triangles();
    assert_eq!(triangles.len(), loops.iter().map(Vec::len).sum::<usize>() - 2 + 2 * (loops.len() - 1));
    let mut backward = Kept::new();
    for points in loops.iter().rev() {
        backward.add(points, |_| {});
        backward.check();
    }
    assert_eq!(triangles, backward.triangles());
}

#[test]
fn a_long_edge_crosses_many_that_end_at_the_outer_triangle() {
    for seed in 0..200 {
        let mut random = Rng::spread(seed);
        let mut kept = Kept::new();
        let mut points: Vec<[i32; 2]> = vec![[-30, -30], [-30, 30]];
        while points.len() < 30 {
            let place = [-29 + random.below(60) as i32, -30 + random.below(60) as i32];
            if !points.contains(&place) {
                points.push(place);
            }
        }
        for point in points.iter().skip(1).chain(&points[..1]) {
            let site = kept.delaunay.insert(at(*point)).expect("no point is there twice");
            kept.sites.insert(*point, site);
        }
        let [low, high] = [[-30, -30], [-30, 30]];
        kept.delaunay.constrain(kept.sites[&high], kept.sites[&low], name(high)).expect("nothing is in the way");
        kept.check();
    }
}
