//! Batch removal from polytopes of up to a hundred faces: caps, rings, pieces that touch in one vertex or lie far apart. After
//! each operation the structure is compared with a fresh build.

use std::collections::{BTreeMap, BTreeSet};

use planecut_kernel::{IncrementalPolytope, PlaneIdx};
use planecut_oracle::campaign::Campaign;
use planecut_oracle::check::compare_with_fresh_build;
use planecut_oracle::exact::Coefficients;
use planecut_oracle::generators::{cube, fibonacci, grid, plane, prism_side, simplex};
use planecut_oracle::kernel_calls::half_space;
use planecut_oracle::random::Rng;
use planecut_oracle::script::Op;
use planecut_oracle::settings::{first_seed, operations};

/// Operations per kind of body unless `PLANECUT_OPS` says otherwise.
const OPERATIONS: usize = 3_000;

type Kind = fn(&mut Rng) -> Vec<Coefficients>;

/// The planes of a ball, in random order.
fn ball(rng: &mut Rng) -> Vec<Coefficients> {
    let n = rng.integer(12, 100) as usize;
    let mut planes: Vec<Coefficients> = (0..n).map(|k| fibonacci(k, n)).collect();
    rng.shuffle(&mut planes);
    planes
}

/// Layers of which the inner ones hide the outer ones here and there.
fn layers(rng: &mut Rng) -> Vec<Coefficients> {
    let n = rng.integer(20, 80);
    let depth = rng.pick(&[0.05, 0.3, 2.0]);
    (0..n).map(|_| plane(rng.direction(), 1.0 + rng.float(0.0, depth))).collect()
}

/// Small integers, with many planes through one vertex.
fn lattice(rng: &mut Rng) -> Vec<Coefficients> {
    let n = rng.integer(15, 60);
    let reach = rng.integer(2, 3);
    (0..n).map(|_| grid(rng, reach)).collect()
}

/// All normals in one half-space: there is no end on one side.
fn bowl(rng: &mut Rng) -> Vec<Coefficients> {
    let n = rng.pick(&[8, 15, 50]);
    let depth = rng.pick(&[0.0, 0.5, 3.0]);
    (0..n)
        .map(|_| {
            let [x, y, z] = rng.direction();
            plane([x, y, -z.abs()], 1.0 + rng.float(0.0, depth))
        })
        .collect()
}

/// Outer planes, a bowl inside them, and a few planes that close it and hide the outer ones: without this lid and without
/// what it hides the bowl has no end.
fn lid(rng: &mut Rng) -> Vec<Coefficients> {
    let mut planes = if rng.chance(0.5) { cube(rng, 4.0) } else { simplex(rng, 4.0) };
    planes.truncate(rng.integer(1, 6) as usize);
    for _ in 0..rng.integer(4, 20) {
        let [x, y, z] = rng.direction();
        planes.push(plane([x, y, rng.float(0.0, 0.3) - z.abs()], 1.0));
    }
    for _ in 0..rng.integer(1, 5) {
        let [x, y, z] = rng.direction();
        planes.push(plane([x, y, 0.2 + z.abs()], rng.float(0.8, 2.0)));
    }
    planes
}

/// Many sides around one axis, sometimes with ends; each side touches only two others.
fn column(rng: &mut Rng) -> Vec<Coefficients> {
    let n = rng.integer(8, 40);
    let mut planes: Vec<Coefficients> = (0..n).map(|_| prism_side(rng, None)).collect();
    if rng.chance(0.7) {
        let mut ends = cube(rng, 3.0);
        ends.truncate(rng.below(7));
        planes.extend(ends);
    }
    rng.shuffle(&mut planes);
    planes
}

/// A cone or a double cone cut off in small pieces: faces with long rings beside small ones.
fn spindle(rng: &mut Rng) -> Vec<Coefficients> {
    let sides = rng.integer(8, 30);
    let mut planes = Vec::new();
    for k in 0..sides {
        let (sin, cos) = (k as f64 * std::f64::consts::TAU / sides as f64).sin_cos();
        planes.push(plane([cos, sin, 0.5], 1.0));
        if rng.chance(0.9) {
            planes.push(plane([cos, sin, -0.7], 1.0));
        }
    }
    planes.extend((0..rng.integer(1, 12)).map(|_| plane(rng.direction(), rng.float(0.8, 1.2))));
    rng.shuffle(&mut planes);
    planes
}

/// A script in the making, with the polytope as it is at its end.
struct Body {
    polytope: IncrementalPolytope,
    planes: BTreeMap<usize, (PlaneIdx, Coefficients)>,
    ops: Vec<Op>,
    names: usize,
}

impl Body {
    fn new(planes: &[Coefficients]) -> Self {
        let mut body =
            Self { polytope: IncrementalPolytope::new(), planes: BTreeMap::new(), ops: Vec::new(), names: 0 };
        planes.iter().for_each(|plane| body.add(*plane));
        body
    }

    fn add(&mut self, plane: Coefficients) {
        let index = self.polytope.add_plane(half_space(plane)).plane();
        self.planes.insert(self.names, (index, plane));
        self.ops.push(Op::Add { name: self.names, plane });
        self.names += 1;
    }

    /// Removes a batch and gives what it was.
    fn remove(&mut self, names: &BTreeSet<usize>) -> Vec<Coefficients> {
        let (indices, gone): (Vec<PlaneIdx>, Vec<Coefficients>) =
            names.iter().filter_map(|name| self.planes.remove(name)).unzip();
        let _ = self.polytope.remove_planes(&indices);
        self.ops.push(Op::RemoveMany { names: names.iter().copied().collect() });
        gone
    }

    /// Faces that share a vertex, by name.
    fn neighbours(&self) -> BTreeMap<usize, BTreeSet<usize>> {
        let names: BTreeMap<PlaneIdx, usize> = self.planes.iter().map(|(name, (index, _))| (*index, *name)).collect();
        let mut neighbours: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
        for vertex in self.polytope.simple_vertices() {
            let around: Vec<usize> = vertex.into_iter().flatten().map(|plane| names[&plane]).collect();
            for &p in &around {
                neighbours.entry(p).or_default().extend(around.iter().filter(|q| **q != p));
            }
        }
        neighbours
    }

    /// Connected faces, grown by chance from one; or all within some steps of it, without those within fewer.
    fn patch(&self, rng: &mut Rng, size: usize) -> BTreeSet<usize> {
        let neighbours = self.neighbours();
        let faces: Vec<usize> = neighbours.keys().copied().collect();
        if faces.is_empty() {
            return BTreeSet::new();
        }
        let start = rng.pick(&faces);
        let mut patch = BTreeSet::from([start]);
        if rng.chance(0.3) {
            let grow = |patch: &BTreeSet<usize>| patch.iter().flat_map(|p| neighbours[p].iter().copied()).collect();
            let inner: BTreeSet<usize> = if rng.chance(0.5) { grow(&patch) } else { patch.clone() };
            let outer: BTreeSet<usize> = grow(&inner);
            return outer.difference(&inner).copied().chain(rng.chance(0.2).then_some(start)).take(size).collect();
        }
        while patch.len() < size {
            let next: Vec<usize> =
                patch.iter().flat_map(|p| &neighbours[p]).copied().filter(|p| !patch.contains(p)).collect();
            if next.is_empty() {
                break;
            }
            patch.insert(rng.pick(&next));
        }
        patch
    }

    /// A batch: one patch or several, sometimes with planes that have no face.
    fn batch(&self, rng: &mut Rng) -> BTreeSet<usize> {
        let most = 2 + self.planes.len() / 2;
        let size = 2 + rng.below(most);
        let pieces = rng.pick(&[1, 1, 1, 2, 5]);
        let mut batch = BTreeSet::new();
        for _ in 0..pieces {
            batch.append(&mut self.patch(rng, size.div_ceil(pieces)));
        }
        for (&name, (index, _)) in &self.planes {
            if self.polytope.is_redundant(*index) && rng.chance(0.2) {
                batch.insert(name);
            }
        }
        batch
    }
}

/// Removes batches and puts back half of what was removed, in ever smaller bodies.
fn script(rng: &mut Rng, kind: Kind) -> Vec<Op> {
    let mut body = Body::new(&kind(rng));
    for _ in 0..6 {
        let batch = body.batch(rng);
        let gone = body.remove(&batch);
        for plane in gone {
            if rng.chance(0.6) {
                body.add(plane);
            }
        }
    }
    body.ops
}

fn equals_a_fresh_build(kind: Kind) {
    let campaign = Campaign {
        operations: 1,
        cases: 1,
        capacity: usize::MAX,
        start: IncrementalPolytope::new,
        check: compare_with_fresh_build,
    };
    let (mut done, mut batches, mut seed) = (0, 0, first_seed());
    while done < operations(OPERATIONS) {
        seed += 1;
        let ops = script(&mut Rng::new(seed), kind);
        if let Err(error) = campaign.attempt(&ops) {
            panic!("PLANECUT_SEED={}: {}", seed - 1, campaign.report(ops, &error));
        }
        done += ops.len();
        batches += ops.iter().filter(|op| matches!(op, Op::RemoveMany { names } if names.len() > 1)).count();
    }
    assert!(batches > 0, "no batch in {done} operations");
}

#[test]
fn of_a_ball() {
    equals_a_fresh_build(ball);
}

#[test]
fn of_layers() {
    equals_a_fresh_build(layers);
}

#[test]
fn of_a_lattice() {
    equals_a_fresh_build(lattice);
}

#[test]
fn of_a_bowl() {
    equals_a_fresh_build(bowl);
}

#[test]
fn of_a_bowl_with_a_lid() {
    equals_a_fresh_build(lid);
}

#[test]
fn of_a_column() {
    equals_a_fresh_build(column);
}

#[test]
fn of_a_spindle() {
    equals_a_fresh_build(spindle);
}

/// Handles that are not there, or there twice, do not count.
#[test]
fn handles_count_once() {
    let mut polytope = IncrementalPolytope::new();
    let planes: Vec<PlaneIdx> = (0..30).map(|k| polytope.add_plane(half_space(fibonacci(k, 30))).plane()).collect();
    let unknown = [PlaneIdx(30), PlaneIdx(usize::MAX)];
    assert_eq!(polytope.remove_planes(&unknown).count, 0);
    let twice = [planes[3], planes[4], planes[3], unknown[0], planes[4]];
    assert_eq!(polytope.remove_planes(&twice).count, 2);
    assert_eq!(polytope.remove_planes(&twice).count, 0);
    assert_eq!(polytope.planes().count(), 28);
}
