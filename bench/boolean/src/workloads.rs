//! The scenes that are timed, each made of plain numbers and a seed, so that every run has the same.

use std::f64::consts::PI;
use std::path::Path;

use planecut_csg::{Brush, MaterialId, Transform};
use planecut_import::map::{MapOptions, read_map};
use planecut_kernel::{DMat3, DVec3, HalfSpace};
use planecut_shapes::primitives::capsule;
use rand::rngs::StdRng;
use rand::{Rng, SeedableRng};

use crate::scene::{Action, Body, Entry, Plan, Scene};

const ONE: MaterialId = MaterialId(0);

/// A scene and what must come of it.
pub(crate) struct Task {
    pub(crate) scene: Scene,
    /// The volume that every result must have, where it is known beforehand.
    pub(crate) volume: Option<f64>,
}

impl Task {
    pub(crate) fn new(scene: Scene) -> Self {
        Self { scene, volume: None }
    }

    pub(crate) fn of_volume(scene: Scene, volume: f64) -> Self {
        Self { scene, volume: Some(volume) }
    }
}

/// The union of boxes with sides of 0.5 to 1.5, as many in a cube as give each about seven neighbours.
pub(crate) fn box_union(count: usize, is_rotated: bool) -> Task {
    Task::new(Scene::batch(boxes(count, is_rotated), Entry::Union))
}

/// One box moved three times, to where others are, among boxes as those of [`box_union`].
pub(crate) fn moved_box(count: usize) -> Task {
    let mut bodies = boxes(count, true);
    for k in 1..=3 {
        // on to the box that is a quarter of the way further
        let [from, to] = [0, k * count / 4].map(|body| middle(&bodies[body]));
        let shift = Transform::new(DMat3::IDENTITY, to - from).expect("a shift");
        bodies.push(convex(&transformed(bodies[0].brush(), &shift)));
    }
    Task::new(Scene { bodies, plan: Plan::Moves(count as u32) })
}

fn middle(body: &Body) -> DVec3 {
    body.positions.iter().map(|at| DVec3::from_array(*at)).sum::<DVec3>() / body.positions.len() as f64
}

/// Boxes of random sizes at constant density; rotated, or on a grid of 1/1024.
pub(crate) fn boxes(count: usize, is_rotated: bool) -> Vec<Body> {
    let mut rng = StdRng::seed_from_u64(count as u64 + u64::from(is_rotated));
    let side = 1.5 * (count as f64).cbrt();
    let make = |_| {
        let grid = |v: f64| (v * 1024.0).round() / 1024.0;
        let half = DVec3::from_array([0; 3].map(|_| grid(rng.random_range(0.25..0.75))));
        let middle = DVec3::from_array([0; 3].map(|_| grid(rng.random_range(0.0..side))));
        if !is_rotated {
            return convex(&Brush::cuboid(middle - half, middle + half, ONE));
        }
        let turn = rotation(&mut rng);
        let planes = (0..3).flat_map(|axis| {
            let normal = turn.col(axis);
            let at = normal.dot(middle);
            [half_space(normal, at + half[axis]), half_space(-normal, half[axis] - at)]
        });
        convex(&Brush::from_half_spaces(planes, ONE))
    };
    (0..count).map(make).collect()
}

/// The unit block, and capsules in it: two spheres of radius 0.02 to 0.06 at 0.1 to 0.3 from each other, and what lies
/// between.
fn capsules_in_block(count: usize, make: impl Fn(f64, f64, DMat3, DVec3) -> Brush) -> Vec<Body> {
    let mut rng = StdRng::seed_from_u64(count as u64);
    let mut bodies = vec![convex(&Brush::cuboid(DVec3::ZERO, DVec3::ONE, ONE))];
    for _ in 0..count {
        let (height, radius) = (rng.random_range(0.1..0.3), rng.random_range(0.02..0.06));
        let at = DVec3::from_array([0; 3].map(|_| rng.random_range(0.0..1.0)));
        bodies.push(convex(&make(height, radius, rotation(&mut rng), at)));
    }
    bodies
}

/// One of 100 tangent planes, spread over all directions.
fn tangent_capsule(height: f64, radius: f64, turn: DMat3, at: DVec3) -> Brush {
    let ends = [at, at + height * turn.col(2)];
    let tangent = |normal: DVec3| {
        let reach = ends.map(|end| normal.dot(end));
        half_space(normal, radius + reach[0].max(reach[1]))
    };
    Brush::from_half_spaces(directions(100).map(tangent), ONE)
}

/// planecut's own of 14 segments, 100 planes as well. Turned, the four planes at each of its corners no longer meet in a
/// point, but for rounding.
fn turned_capsule(height: f64, radius: f64, turn: DMat3, at: DVec3) -> Brush {
    let brush = capsule(height, radius, 14, ONE).expect("sizes within the limits");
    transformed(brush, &Transform::new(turn, at).expect("a rotation"))
}

/// The unit block minus capsules.
pub(crate) fn carve(count: usize) -> Task {
    Task::new(Scene::batch(capsules_in_block(count, tangent_capsule), Entry::Difference))
}

/// The unit block minus capsules with more than three planes at a corner.
pub(crate) fn carve_turned(count: usize) -> Task {
    Task::new(Scene::batch(capsules_in_block(count, turned_capsule), Entry::Difference))
}

/// The same, one by one.
pub(crate) fn carve_one_by_one(count: usize) -> Task {
    Task::new(Scene::one_by_one(capsules_in_block(count, tangent_capsule), Action::Subtract))
}

/// A block minus a chain of capsules along a spiral from the top of a dome to its rim.
pub(crate) fn dome_carve(count: usize) -> Task {
    let block = convex(&Brush::cuboid(DVec3::new(-2.0, -2.0, 0.0), DVec3::splat(2.0), ONE));
    let bodies = std::iter::once(block).chain(tools_over_dome(count)).collect();
    Task::new(Scene::batch(bodies, Entry::Difference))
}

/// A dome, half a ball of 200 tangent planes, minus the same capsules, one by one.
pub(crate) fn dome_carve_one_by_one(count: usize) -> Task {
    let tangents = directions(400).filter(|normal| normal.z > 0.0).map(|normal| half_space(normal, 1.0));
    let dome = Brush::from_half_spaces(tangents.chain([half_space(-DVec3::Z, 0.0)]), ONE);
    let bodies = std::iter::once(convex(&dome)).chain(tools_over_dome(count)).collect();
    Task::new(Scene::one_by_one(bodies, Action::Subtract))
}

/// Capsules along a spiral from the top of the unit hemisphere to its rim, as a ball-nosed tool would go: each overlaps those
/// before and after it and those of the next turns, however many there are.
fn tools_over_dome(count: usize) -> impl Iterator<Item = Body> {
    // the turns are as far apart as the capsules are long, and all of them cover the unit hemisphere of area 2π
    let spacing = (2.0 * PI / count as f64).sqrt();
    let point = move |k: usize| {
        let z = 1.0 - k as f64 / count as f64;
        let (sin, cos) = (2.0 * PI * z.acos() / spacing).sin_cos();
        let radius = (1.0 - z * z).sqrt();
        DVec3::new(radius * cos, radius * sin, z)
    };
    let side = |from: DVec3, to: DVec3| (to - from).cross(from + to);
    (0..count).map(move |k| tool(point(k), point(k + 1), side(point(k), point(k + 1)), 0.7 * spacing))
}

/// A capsule of 100 planes between two points, turned so that a plane of symmetry is across `side`.
fn tool(from: DVec3, to: DVec3, side: DVec3, radius: f64) -> Body {
    let (along, side) = ((to - from).normalize(), side.normalize());
    let turn = DMat3::from_cols(side, along.cross(side), along);
    let brush = capsule((to - from).length(), radius, 14, ONE).expect("sizes within the limits");
    convex(&transformed(brush, &Transform::new(turn, from).expect("a rotation")))
}

/// A terrain, and a tool that goes over it along a winding path: each cut takes a capsule from what is left, one by one.
///
/// The terrain is a field of heights on a grid of `side` squares a side, two wedges each: their sides touch, and their tops meet in edges.
pub(crate) fn terrain(side: u32, cuts: usize) -> Task {
    let size = f64::from(side);
    let mut bodies: Vec<Body> = (0..side * side).flat_map(|k| square(k % side, k / side)).map(|b| convex(&b)).collect();
    let count = bodies.len() as u32;
    let point = |k: usize| {
        // three ways across, and back
        let t = k as f64 / cuts as f64;
        let (x, y) = (0.5 - 0.45 * (3.0 * PI * t).cos(), 0.1 + 0.8 * t + 0.05 * (20.0 * PI * t).sin());
        DVec3::new(size * x, size * y, height(size * x, size * y) + 0.1)
    };
    let step = |k: usize| (point(k), point(k + 1));
    let tools = (0..cuts).map(step).map(|(from, to)| tool(from, to, (to - from).cross(DVec3::Z), 0.8));
    bodies.extend(tools);
    Task::new(Scene { bodies, plan: Plan::Cuts(count) })
}

/// The height of a terrain, on a grid of 1/1024 so that the planes of wedges are exact.
fn height(x: f64, y: f64) -> f64 {
    let waves =
        (0.31 * x + 0.17 * y).sin() + 0.6 * (0.47 * y - 0.29 * x + 1.0).sin() + 0.3 * (1.3 * x).sin() * (1.1 * y).cos();
    ((4.0 + waves) * 1024.0).round() / 1024.0
}

/// The two wedges of a square of a terrain, from the ground to a triangle each.
fn square(x: u32, y: u32) -> [Brush; 2] {
    let (low, high) = ([f64::from(x), f64::from(y)], [f64::from(x) + 1.0, f64::from(y) + 1.0]);
    let corner = |x: f64, y: f64| DVec3::new(x, y, height(x, y));
    let [a, b, c, d] =
        [corner(low[0], low[1]), corner(high[0], low[1]), corner(high[0], high[1]), corner(low[0], high[1])];
    [[a, b, c], [a, c, d]].map(|[p, q, r]| {
        let across = |p: DVec3, q: DVec3| {
            let normal = DVec3::new(q.y - p.y, p.x - q.x, 0.0);
            half_space(normal, normal.dot(p))
        };
        let top = (q - p).cross(r - p);
        let sides = [across(p, q), across(q, r), across(r, p)];
        let ends = [half_space(top, top.dot(p)), half_space(-DVec3::Z, 0.0)];
        Brush::from_half_spaces(sides.into_iter().chain(ends), ONE)
    })
}

/// A grid of touching unit cubes, united one by one and then subtracted one by one; nothing must be left.
pub(crate) fn grid_iterated(side: u32) -> Task {
    let bodies = cubes(side, |_| true);
    let count = bodies.len() as u32;
    let steps = [Action::Add, Action::Subtract].into_iter().flat_map(|action| (0..count).map(move |k| (action, k)));
    let plan = Plan::Steps(steps.collect());
    Task::of_volume(Scene { bodies, plan }, 0.0)
}

/// What the cubes of [`touching_cubes`] have in common with their neighbours.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Contact {
    Face,
    Edge,
    Vertex,
}

/// The union of unit cubes in a grid: of all, of every other as on a chessboard, or of those in the middle of others.
pub(crate) fn touching_cubes(side: u32, contact: Contact) -> Task {
    let bodies = cubes(side, |[x, y, z]| match contact {
        Contact::Face => true,
        Contact::Edge => (x + y + z) % 2 == 0,
        Contact::Vertex => x % 2 == y % 2 && y % 2 == z % 2,
    });
    let volume = bodies.len() as f64;
    Task::of_volume(Scene::batch(bodies, Entry::Union), volume)
}

/// Unit cubes of a grid.
fn cubes(side: u32, is_there: impl Fn([u32; 3]) -> bool) -> Vec<Body> {
    let places = (0..side * side * side).map(|k| [k % side, k / side % side, k / side / side]);
    let corners = places.filter(|place| is_there(*place)).map(|place| DVec3::from_array(place.map(f64::from)));
    corners.map(|corner| convex(&Brush::cuboid(corner, corner + DVec3::ONE, ONE))).collect()
}

/// How the bars of a Menger sponge are taken away.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Menger {
    Batch,
    OneByOne,
    Combs,
}

/// The unit cube minus the bars of a Menger sponge, in each direction `1 + 8 + 64 + …`.
pub(crate) fn menger(depth: u32, form: Menger) -> Task {
    let mut bodies = vec![convex(&Brush::cuboid(DVec3::ZERO, DVec3::ONE, ONE))];
    let mut bars = 0;
    for axis in 0..3 {
        let holes = sponge_holes(depth);
        bars = holes.len() as u32;
        for [u, v, size] in holes {
            let (mut min, mut max) = (DVec3::splat(-1.0), DVec3::splat(2.0));
            (min[(axis + 1) % 3], max[(axis + 1) % 3]) = (u, u + size);
            (min[(axis + 2) % 3], max[(axis + 2) % 3]) = (v, v + size);
            bodies.push(convex(&Brush::cuboid(min, max, ONE)));
        }
    }
    let scene = match form {
        Menger::Batch => Scene::batch(bodies, Entry::Difference),
        Menger::OneByOne => Scene::one_by_one(bodies, Action::Subtract),
        Menger::Combs => {
            let mut entries = vec![Entry::Leaf];
            for _ in 0..3 {
                entries.extend((0..bars).map(|_| Entry::Leaf));
                entries.push(Entry::Union(bars));
            }
            entries.push(Entry::Difference(4));
            Scene { bodies, plan: Plan::Tree(entries) }
        }
    };
    Task::of_volume(scene, (20.0_f64 / 27.0).powi(depth as i32))
}

/// The holes of a Sierpiński carpet, as corner and size.
fn sponge_holes(depth: u32) -> Vec<[f64; 3]> {
    let mut holes = Vec::new();
    let mut squares = vec![[0.0, 0.0]];
    for level in 1..=depth {
        let size = 3.0_f64.powi(-(level as i32));
        let mut next = Vec::new();
        for [u, v] in squares {
            for k in 0..9 {
                let (i, j) = (k % 3, k / 3);
                let at = [u + f64::from(i) * size, v + f64::from(j) * size];
                if (i, j) == (1, 1) {
                    holes.push([at[0], at[1], size]);
                } else {
                    next.push(at);
                }
            }
        }
        squares = next;
    }
    holes
}

/// Two equal spheres of tangent planes, each with the given number of triangles, that overlap by more than a radius.
pub(crate) fn dense_spheres(triangles: usize) -> Task {
    // each vertex has three planes, so f planes make 4f − 12 triangles
    let planes = (triangles + 12) / 4;
    let sphere = |middle: DVec3| {
        let tangents = directions(planes).map(|normal| half_space(normal, 1.0 + normal.dot(middle)));
        convex(&Brush::from_half_spaces(tangents, ONE))
    };
    let bodies = vec![sphere(DVec3::ZERO), sphere(DVec3::new(0.7, 0.2, 0.1))];
    Task::new(Scene::batch(bodies, Entry::Union))
}

/// Unit vectors spread over all directions by the golden angle.
fn directions(count: usize) -> impl Iterator<Item = DVec3> {
    let golden_angle = PI * (3.0 - 5f64.sqrt());
    (0..count).map(move |i| {
        let z = 1.0 - (2.0 * i as f64 + 1.0) / count as f64;
        let radius = (1.0 - z * z).sqrt();
        let (sin, cos) = (golden_angle * i as f64).sin_cos();
        DVec3::new(radius * cos, radius * sin, z)
    })
}

/// The brushes of a Quake map, whose union has a known volume.
pub(crate) fn map(file: &Path, volume: f64) -> Result<Task, String> {
    Ok(Task::of_volume(Scene::batch(map_bodies(file)?, Entry::Union), volume))
}

/// The same, one by one.
pub(crate) fn map_one_by_one(file: &Path, volume: f64) -> Result<Task, String> {
    Ok(Task::of_volume(Scene::one_by_one(map_bodies(file)?, Action::Add), volume))
}

fn map_bodies(file: &Path) -> Result<Vec<Body>, String> {
    let text = std::fs::read(file).map_err(|error| error.to_string())?;
    let import = read_map(&text, &file.to_string_lossy(), &MapOptions::default()).map_err(|error| error.to_string())?;
    Ok(import.model.tree.brushes().iter().filter_map(Body::of).collect())
}

fn convex(brush: &Brush) -> Body {
    Body::of(brush).expect("a bounded body")
}

fn half_space(normal: DVec3, offset: f64) -> HalfSpace {
    HalfSpace::new(normal, offset).expect("a plane within the limits")
}

fn transformed(mut brush: Brush, transform: &Transform) -> Brush {
    for face in &mut brush.faces {
        face.half_space = transform.half_space(&face.half_space).expect("a plane within the limits");
    }
    brush
}

/// A random rotation, by a quaternion of normal deviates (near enough).
pub(crate) fn rotation(rng: &mut StdRng) -> DMat3 {
    let mut deviate = || (0..12).map(|_| rng.random_range(0.0..1.0)).sum::<f64>() - 6.0;
    let [w, x, y, z] = [(); 4].map(|()| deviate());
    let s = 2.0 / (w * w + x * x + y * y + z * z);
    DMat3::from_cols(
        DVec3::new(1.0 - s * (y * y + z * z), s * (x * y + z * w), s * (x * z - y * w)),
        DVec3::new(s * (x * y - z * w), 1.0 - s * (x * x + z * z), s * (y * z + x * w)),
        DVec3::new(s * (x * z + y * w), s * (y * z - x * w), 1.0 - s * (x * x + y * y)),
    )
}
