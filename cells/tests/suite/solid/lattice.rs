//! Boxes with integer coordinates: volume, area, centroid, inertia and parts are counted.

use glam::{DMat3, DVec3};
use planecut_cells::Solid;
use planecut_csg::Operation;
use planecut_kernel::Location;

use planecut_testkit::scene::{ensure, ensure_eq, sweep};
use planecut_testkit::shape::{Kind, Shape, bounded, ensure_close, ensure_sound, random_shape};

const REACH: i32 = 8;

/// Unit cubes that are filled, by their lower corners.
pub(crate) struct Cubes {
    filled: Vec<bool>,
}

pub(crate) fn at(x: i32, y: i32, z: i32) -> DVec3 {
    DVec3::new(x.into(), y.into(), z.into())
}

impl Cubes {
    pub(crate) fn new(shape: &Shape) -> Self {
        let value = |corner: DVec3| shape.holds(corner + 0.5).expect("centers lie on no plane");
        Self { filled: Self::corners().map(|[x, y, z]| value(at(x, y, z))).collect() }
    }

    fn corners() -> impl Iterator<Item = [i32; 3]> {
        let range = -REACH..REACH;
        range.clone().flat_map(move |x| {
            let inner = range.clone();
            range.clone().flat_map(move |y| inner.clone().map(move |z| [x, y, z]))
        })
    }

    pub(crate) fn holds(&self, cube: [i32; 3]) -> bool {
        if cube.iter().any(|v| !(-REACH..REACH).contains(v)) {
            return false;
        }
        let [x, y, z] = cube.map(|v| (v + REACH) as usize);
        let side = 2 * REACH as usize;
        self.filled[(x * side + y) * side + z]
    }

    pub(crate) fn all(&self) -> Vec<[i32; 3]> {
        Self::corners().zip(&self.filled).filter(|(_, filled)| **filled).map(|(cube, _)| cube).collect()
    }

    fn neighbours([x, y, z]: [i32; 3]) -> [[i32; 3]; 6] {
        [[x + 1, y, z], [x - 1, y, z], [x, y + 1, z], [x, y - 1, z], [x, y, z + 1], [x, y, z - 1]]
    }

    pub(crate) fn area(&self) -> usize {
        self.all().into_iter().flat_map(Self::neighbours).filter(|cube| !self.holds(*cube)).count()
    }

    /// The number of cubes of each part connected through faces, ascending.
    pub(crate) fn parts(&self) -> Vec<usize> {
        let mut left: std::collections::BTreeSet<[i32; 3]> = self.all().into_iter().collect();
        let mut parts = Vec::new();
        while let Some(first) = left.pop_first() {
            let (mut waiting, mut count) = (vec![first], 0);
            while let Some(cube) = waiting.pop() {
                count += 1;
                waiting.extend(Self::neighbours(cube).into_iter().filter(|next| left.remove(next)));
            }
            parts.push(count);
        }
        parts.sort_unstable();
        parts
    }

    /// Centroid and inertia about it, from those of unit cubes.
    fn moments(&self) -> (DVec3, DMat3) {
        let centers: Vec<DVec3> = self.all().into_iter().map(|[x, y, z]| at(x, y, z) + 0.5).collect();
        let centroid = centers.iter().sum::<DVec3>() / (centers.len().max(1) as f64);
        let mut inertia = DMat3::ZERO;
        for center in centers {
            let r = center - centroid;
            let outer = DMat3::from_cols(r * r.x, r * r.y, r * r.z);
            inertia += DMat3::from_diagonal(DVec3::splat(r.length_squared() + 1.0 / 6.0)) - outer;
        }
        (centroid, inertia)
    }
}

pub(crate) fn ensure_counted(shape: &Shape, solid: &Solid) -> Result<(), String> {
    let cubes = Cubes::new(shape);
    ensure_sound(solid)?;
    let count = cubes.all().len();
    ensure_eq!(solid.volume(), Some(count as f64), "volume");
    ensure_eq!(solid.is_empty(), count == 0, "emptiness");
    ensure_eq!(solid.area().map_err(|error| error.to_string())?, cubes.area() as f64, "area");
    let (centroid, inertia) = cubes.moments();
    let (found, tensor) = (solid.centroid().ok_or("unbounded")?, solid.inertia().ok_or("unbounded")?);
    for axis in 0..3 {
        ensure_close("centroid", found[axis], centroid[axis], 10.0)?;
        for other in 0..3 {
            ensure_close("inertia", tensor.col(axis)[other], inertia.col(axis)[other], 100.0 * count as f64)?;
        }
    }
    let mut parts: Vec<usize> =
        solid.connected_components().iter().map(|part| part.volume().map_or(0, |volume| volume as usize)).collect();
    parts.sort_unstable();
    ensure_eq!(parts, cubes.parts(), "parts");
    for cube in Cubes::corners() {
        let [x, y, z] = cube;
        let expected = if cubes.holds(cube) { Location::Inside } else { Location::Outside };
        ensure_eq!(solid.classify(at(x, y, z) + 0.5), expected, format!("location in the middle of {cube:?}"));
    }
    Ok(())
}

#[test]
fn trees_of_boxes_come_out_as_counted() {
    let generate = |rng: &mut planecut_testkit::random::Rng| {
        let leaves = 1 + rng.below(10);
        bounded(random_shape(rng, Kind::Boxes, leaves))
    };
    sweep(150, generate, |shape| ensure_counted(shape, &Solid::from_tree(&shape.tree())));
}

#[test]
fn operators_on_solids_of_boxes_come_out_as_counted() {
    let generate = |rng: &mut planecut_testkit::random::Rng| {
        let leaves = 1 + rng.below(8);
        bounded(random_shape(rng, Kind::Boxes, leaves))
    };
    sweep(120, generate, |shape| ensure_counted(shape, &shape.by_operators()));
}

#[test]
fn corners_lie_inside_where_all_cubes_around_are_filled() {
    let generate = |rng: &mut planecut_testkit::random::Rng| {
        let leaves = 2 + rng.below(6);
        bounded(random_shape(rng, Kind::Boxes, leaves))
    };
    sweep(60, generate, |shape| {
        let (cubes, solid) = (Cubes::new(shape), Solid::from_tree(&shape.tree()));
        for [x, y, z] in Cubes::corners() {
            let around = (0..8).map(|k| [x - (k & 1), y - (k >> 1 & 1), z - (k >> 2)]);
            let filled = around.filter(|cube| cubes.holds(*cube)).count();
            let expected = match filled {
                0 => Location::Outside,
                8 => Location::Inside,
                _ => Location::On,
            };
            ensure_eq!(solid.classify(at(x, y, z)), expected, format!("location of ({x}, {y}, {z})"));
            ensure!(solid.contains(at(x, y, z)) == (filled > 0), "membership of ({x}, {y}, {z})");
        }
        Ok(())
    });
}

#[test]
fn cubes_that_touch_along_an_edge_are_two_parts() {
    let cube = |x: i32, y: i32| Shape::Leaf(planecut_testkit::scene::cuboid(at(x, y, 0), at(x + 1, y + 1, 1)));
    let shape = Shape::Node(Operation::Union, vec![cube(0, 0), cube(1, 1)]);
    let solid = Solid::from_tree(&shape.tree());
    assert_eq!(solid.connected_components().len(), 2);
    assert_eq!(Solid::from_tree(&(shape.tree() | cube(0, 1).tree())).connected_components().len(), 1);
}
