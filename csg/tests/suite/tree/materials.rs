//! Which material each place of a solid is made of, and the volumes of materials.

use planecut_csg::{Brush, LiveModel, Material, MaterialId, Model, Operation, Tree};
use planecut_kernel::DVec3;
use planecut_testkit::random::Rng;
use planecut_testkit::scene::scaled;

/// Boxes lie on a grid of unit cells in a cube of this side.
const SIDE: u32 = 6;

const MATERIALS: usize = 3;

/// A tree of boxes, each of one material.
#[derive(Debug, Clone)]
enum Shape {
    Leaf { min: [f64; 3], max: [f64; 3], material: u32 },
    Node(Operation, Vec<Self>),
}

impl Shape {
    fn tree(&self) -> Tree {
        match self {
            Self::Leaf { min, max, material } => {
                Brush::cuboid(DVec3::from_array(*min), DVec3::from_array(*max), MaterialId(*material)).into()
            }
            Self::Node(operation, operands) => Tree::combine(*operation, operands.iter().map(Self::tree)),
        }
    }

    fn first(&self) -> Option<u32> {
        match self {
            Self::Leaf { material, .. } => Some(*material),
            Self::Node(_, operands) => operands.iter().find_map(Self::first),
        }
    }

    /// What is at a place, from the definition.
    fn at(&self, place: DVec3) -> Option<u32> {
        let (operation, operands) = match self {
            Self::Leaf { min, max, material } => {
                let is_there = (0..3).all(|axis| (min[axis]..max[axis]).contains(&place[axis]));
                return is_there.then_some(*material);
            }
            Self::Node(operation, operands) => (operation, operands),
        };
        let found: Vec<Option<u32>> = operands.iter().map(|operand| operand.at(place)).collect();
        let count = found.iter().flatten().count();
        let last = found.iter().rev().flatten().next().copied();
        match operation {
            Operation::Union => last,
            Operation::Xor => last.filter(|_| count % 2 == 1),
            Operation::Difference => found[0].filter(|_| count == 1),
            Operation::Complement => self.first().filter(|_| count == 0),
            Operation::Intersection => {
                let is_finite = |shape: &Self| shape.at(DVec3::splat(1e3)).is_none();
                let counts = operands.iter().position(is_finite).unwrap_or(0);
                found[counts].filter(|_| count == found.len())
            }
        }
    }
}

fn random_box(rng: &mut Rng) -> Shape {
    let low = [0; 3].map(|_| rng.whole(0, i64::from(SIDE) - 2));
    let max = low.map(|low| low + rng.whole(1, 3));
    Shape::Leaf { min: low, max, material: rng.below(MATERIALS) as u32 }
}

fn random_shape(rng: &mut Rng, depth: u32) -> Shape {
    if depth == 0 || rng.chance(0.2) {
        return random_box(rng);
    }
    let operation = rng.pick(&[
        Operation::Union,
        Operation::Union,
        Operation::Difference,
        Operation::Intersection,
        Operation::Xor,
        Operation::Complement,
    ]);
    let count = if operation == Operation::Complement { 1 + rng.below(2) } else { 2 + rng.below(3) };
    Shape::Node(operation, (0..count).map(|_| random_shape(rng, depth - 1)).collect())
}

#[test]
fn each_place_is_of_one_material_and_volumes_are_those_of_cells() {
    let mut of_several = 0;
    for seed in 0..scaled(300) {
        let rng = &mut Rng::spread(seed);
        let all = Shape::Leaf { min: [0.0; 3], max: [f64::from(SIDE); 3], material: 0 };
        let shape = Shape::Node(Operation::Intersection, vec![random_shape(rng, 3), all]);
        let mut expected = [0.0; MATERIALS];
        for cell in 0..SIDE.pow(3) {
            let place = [cell % SIDE, cell / SIDE % SIDE, cell / SIDE / SIDE];
            if let Some(material) = shape.at(DVec3::from_array(place.map(f64::from)) + 0.5) {
                expected[material as usize] += 1.0;
            }
        }
        let materials = (0..MATERIALS).map(|k| Material::named(format!("material {k}"))).collect();
        let mut live = LiveModel::from_model(Model { materials, tree: shape.tree() }).expect("bounded");
        let volumes = live.volumes_of_materials().expect("volumes");
        assert_eq!(volumes, expected, "seed {seed}: {shape:?}");
        assert_eq!(volumes.iter().sum::<f64>(), live.measures().volume, "seed {seed}: {shape:?}");
        of_several += usize::from(expected.iter().filter(|volume| **volume > 0.0).count() > 1);
    }
    assert!(of_several > 50, "{of_several}");
}
