//! Which of several coplanar faces owns the boundary: each unit face of a grid, and of which material it is, told from voxels and
//! from the rule of `docs/weld.md`, "Coplanar faces: who owns the boundary", which are written here a second time.

use std::collections::BTreeMap;

use glam::DVec3;
use planecut_csg::Operation::{self, Complement, Difference, Intersection, Union, Xor};
use planecut_csg::{Brush, Evaluation, Material, MaterialId, Mesh, Model, Tree, UnboundedBrushes, evaluate};

use super::random::Shape;
use planecut_testkit::random::Rng;
use planecut_testkit::scene::{Scene, cuboid, ensure, ensure_eq, sweep};
use planecut_testkit::soundness::evaluate_soundly_with;

/// Boxes lie in `0..SIZE` along each axis.
const SIZE: i32 = 5;

const MATERIALS: u32 = 4;

/// A leaf takes where it stands below an odd number of complements and right operands of differences.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Polarity {
    Takes,
    Both,
    Adds,
}

impl Polarity {
    fn flipped(self) -> Self {
        match self {
            Self::Takes => Self::Adds,
            Self::Both => Self::Both,
            Self::Adds => Self::Takes,
        }
    }
}

/// The polarity of each leaf, from left to right.
fn polarities(shape: &Shape, polarity: Polarity, out: &mut Vec<Polarity>) {
    let Shape::Node(operation, operands) = shape else { return out.push(polarity) };
    for (k, operand) in operands.iter().enumerate() {
        let below = match operation {
            Xor => Polarity::Both,
            Complement => polarity.flipped(),
            Difference if k > 0 => polarity.flipped(),
            Union | Intersection | Difference => polarity,
        };
        polarities(operand, below, out);
    }
}

/// Boxes of a grid under a tree, with a material for each face.
struct Grid(Shape);

impl Grid {
    /// Whether each leaf holds the unit cube with this lowest corner.
    fn leaves_at(&self, cube: DVec3) -> Vec<bool> {
        let center = cube + 0.5;
        let holds = |brush: &&Brush| brush.faces.iter().all(|face| face.half_space.signed_distance(center) < 0.0);
        self.0.leaves().iter().map(holds).collect()
    }

    fn value(&self, leaves: &[bool]) -> bool {
        self.0.value(&mut leaves.iter().copied())
    }

    /// The polarity of each leaf, equal ones taken together.
    fn polarities(&self) -> Vec<Polarity> {
        let mut each = Vec::new();
        polarities(&self.0, Polarity::Adds, &mut each);
        let leaves = self.0.leaves();
        let of_equals = |leaf: &&Brush| {
            let equal: Vec<Polarity> =
                (0..each.len()).filter(|k| is_equal(leaves[*k], leaf)).map(|k| each[k]).collect();
            if equal.iter().all(|polarity| *polarity == equal[0]) { equal[0] } else { Polarity::Both }
        };
        leaves.iter().map(of_equals).collect()
    }

    /// The material that the rule gives to the unit face around `center` on the plane between two cubes, of which the first is empty.
    fn owner(&self, [empty, solid]: [&[bool]; 2], center: DVec3, names: &[Material]) -> MaterialId {
        let polarity = self.polarities();
        let material = |leaf: usize| {
            let on_plane = |face: &&planecut_csg::BrushFace| face.half_space.signed_distance(center) == 0.0;
            let found = self.0.leaves()[leaf].faces.iter().find(on_plane).map(|face| face.material);
            found.expect("a leaf changes at one of its faces")
        };
        let mut rounds: BTreeMap<(Polarity, &str), Vec<usize>> = BTreeMap::new();
        for leaf in (0..empty.len()).filter(|leaf| empty[*leaf] != solid[*leaf]) {
            let name = &names[material(leaf).0 as usize].name;
            rounds.entry((polarity[leaf], name)).or_default().push(leaf);
        }
        let mut now = empty.to_vec();
        for round in rounds.values() {
            round.iter().for_each(|leaf| now[*leaf] = solid[*leaf]);
            if self.value(&now) {
                return material(round[0]);
            }
        }
        unreachable!("after all turns the leaves are as on the solid side")
    }

    /// Compares the mesh with every unit face of the grid.
    fn judge(&self) -> Result<(), String> {
        let model = self.model();
        let Evaluation { mesh, .. } = evaluate_soundly_with(&model, UnboundedBrushes::Keep)?;
        let mut unit_faces = vec![0.0; model.materials.len()];
        for axis in 0..3 {
            for cube in cubes() {
                let beside = cube - DVec3::AXES[axis];
                let (low, high) = (self.leaves_at(beside), self.leaves_at(cube));
                let is_solid = [self.value(&low), self.value(&high)];
                let center = cube + 0.5 - 0.5 * DVec3::AXES[axis];
                let found = materials_at(&mesh, axis, cube);
                let expected = match is_solid {
                    [true, false] => vec![(self.owner([&high, &low], center, &model.materials), true)],
                    [false, true] => vec![(self.owner([&low, &high], center, &model.materials), false)],
                    _ => vec![],
                };
                ensure_eq!(found, expected, format!("material and side at {center} across axis {axis}"));
                expected.iter().for_each(|(material, _)| unit_faces[material.0 as usize] += 1.0);
            }
        }
        // the samples saw all there is
        for (k, expected) in unit_faces.iter().enumerate() {
            let triangles = mesh.triangles.iter().zip(&mesh.triangle_faces);
            let of_material = triangles.filter(|(_, face)| mesh.faces[**face as usize].material.0 as usize == k);
            let area: f64 = of_material.map(|(triangle, _)| area(&mesh, triangle)).sum();
            ensure!((area - expected).abs() < 1e-9, "area of material {k}: {area}, {expected} unit faces");
        }
        Ok(())
    }
}

impl Scene for Grid {
    fn model(&self) -> Model {
        let model = self.0.model();
        // names run against the numbers, so that the two orders differ
        let materials = (0..MATERIALS).map(|k| Material::named(format!("material {}", 9 - k))).collect();
        Model { materials, ..model }
    }

    fn smaller(&self) -> Vec<Self> {
        self.0.smaller().into_iter().map(Self).collect()
    }

    fn as_rust(&self) -> String {
        self.0.as_rust()
    }
}

/// The lowest corners of all unit cubes of which a face can be boundary, those around the grid among them.
fn cubes() -> impl Iterator<Item = DVec3> {
    let range = -1..SIZE + 2;
    let all = range.clone().flat_map(move |x| range.clone().map(move |y| (x, y)));
    all.flat_map(|(x, y)| (-1..SIZE + 2).map(move |z| DVec3::new(x.into(), y.into(), z.into())))
}

fn area(mesh: &Mesh, triangle: &[u32; 3]) -> f64 {
    let [a, b, c] = triangle.map(|k| mesh.positions[k as usize]);
    0.5 * (b - a).cross(c - a).length()
}

/// The material of each triangle that covers a place of the unit face below a cube across an axis, and whether it faces along the axis. The
/// place lies on no line through corners of the grid.
fn materials_at(mesh: &Mesh, axis: usize, cube: DVec3) -> Vec<(MaterialId, bool)> {
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let place = [cube[u] + 0.313_707_1, cube[v] + 0.709_110_3];
    let mut found = Vec::new();
    for (triangle, face) in mesh.triangles.iter().zip(&mesh.triangle_faces) {
        let corners = triangle.map(|k| mesh.positions[k as usize]);
        if corners.iter().any(|corner| corner[axis] != cube[axis]) {
            continue;
        }
        let turn = |k: usize| {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            (b[u] - a[u]) * (place[1] - a[v]) - (b[v] - a[v]) * (place[0] - a[u]) > 0.0
        };
        let turns = [turn(0), turn(1), turn(2)];
        if turns == [true; 3] || turns == [false; 3] {
            found.push((mesh.faces[*face as usize].material, turns[0]));
        }
    }
    found
}

fn random_box(rng: &mut Rng) -> Brush {
    let [a, b] = [0; 2].map(|_| [0; 3].map(|_| rng.integer(0, i64::from(SIZE) - 1) as i32));
    let low: [i32; 3] = std::array::from_fn(|k| a[k].min(b[k]));
    let high: [i32; 3] = std::array::from_fn(|k| a[k].max(b[k]) + 1);
    let mut brush = cuboid(DVec3::from_array(low.map(f64::from)), DVec3::from_array(high.map(f64::from)));
    for face in &mut brush.faces {
        face.material = MaterialId(rng.below(MATERIALS as usize) as u32);
    }
    brush
}

/// One of sixteen boxes; which materials its faces are of depends on which of them it is.
fn box_of_few(rng: &mut Rng) -> Brush {
    let which: [usize; 3] = std::array::from_fn(|_| rng.below(2));
    let low = which.map(|k| [0.0, 1.0][k]);
    let high = which.map(|k| [2.0, 3.0][k]);
    let mut brush = cuboid(DVec3::from_array(low), DVec3::from_array(high));
    let first = which.iter().sum::<usize>() + rng.below(2);
    for (k, face) in brush.faces.iter_mut().enumerate() {
        face.material = MaterialId((first + k) as u32 % MATERIALS);
    }
    brush
}

fn random_tree(rng: &mut Rng, depth: u32, random_box: fn(&mut Rng) -> Brush) -> Shape {
    if depth == 0 || rng.chance(0.25) {
        return Shape::Leaf(random_box(rng));
    }
    let operation = rng.pick(&[Union, Union, Intersection, Difference, Difference, Xor, Complement]);
    let count = if operation == Complement { 1 } else { rng.integer(2, 3) };
    Shape::Node(operation, (0..count).map(|_| random_tree(rng, depth - 1, random_box)).collect())
}

/// Whether two boxes are the same with the same materials.
fn is_equal(one: &Brush, other: &Brush) -> bool {
    one.faces == other.faces
}

/// A random tree over boxes, cut by a larger box, so that it is bounded.
fn bounded_tree(rng: &mut Rng, random_box: fn(&mut Rng) -> Brush) -> Grid {
    let depth = rng.integer(1, 4) as u32;
    let tree = random_tree(rng, depth, random_box);
    let low = DVec3::splat(-1.0);
    Grid(Shape::Node(Intersection, vec![tree, Shape::Leaf(cuboid(low, -low + f64::from(SIZE)))]))
}

#[test]
fn each_unit_face_of_a_random_tree_is_of_the_material_of_its_owner() {
    sweep(400, |rng| bounded_tree(rng, random_box), Grid::judge);
}

#[test]
fn each_unit_face_of_a_tree_of_many_equal_boxes_is_of_the_material_of_its_owner() {
    sweep(400, |rng| bounded_tree(rng, box_of_few), Grid::judge);
}

/// Who emits, as the truth table says it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Expected {
    Nobody,
    A,
    B,
    FirstByName,
    LastByName,
}

/// The rows of the truth table in the documentation: the tree, and who emits where both faces face the same way, and opposite ways.
fn truth_table() -> Vec<(String, [Expected; 2])> {
    let page = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/weld.md")).expect("the page");
    let table = page.split("### Truth table").nth(1).and_then(|rest| rest.split("### Proof").next()).expect("a table");
    let expected = |cell: &str| match cell {
        "–" => Expected::Nobody,
        "A" => Expected::A,
        "B" => Expected::B,
        "first" => Expected::FirstByName,
        "last" => Expected::LastByName,
        other => panic!("found {other}, expected a known outcome"),
    };
    let rows = table.lines().filter(|line| line.starts_with("| `"));
    rows.map(|row| {
        let cells: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).collect();
        (cells[0].trim_matches('`').to_owned(), [expected(cells[1]), expected(cells[2])])
    })
    .collect()
}

/// The tree of a row.
fn tree_of(text: &str, [a, b, d]: [Tree; 3]) -> Tree {
    let of = |operation: Operation, operands: [Tree; 2]| Tree::combine(operation, operands);
    match text {
        "A ∪ B" => of(Union, [a, b]),
        "A ∩ B" => of(Intersection, [a, b]),
        "A − B" => of(Difference, [a, b]),
        "B − A" => of(Difference, [b, a]),
        "A ⊕ B" => of(Xor, [a, b]),
        "D − A" => of(Difference, [d, a]),
        "D ∪ A" => of(Union, [d, a]),
        "D ∩ A" => of(Intersection, [d, a]),
        "D ⊕ A" => of(Xor, [d, a]),
        "(D − A) − B" => of(Difference, [of(Difference, [d, a]), b]),
        "D − (A ∩ B)" => of(Difference, [d, of(Intersection, [a, b])]),
        "(D − A) ∪ B" => of(Union, [of(Difference, [d, a]), b]),
        "D ⊕ A ⊕ B" => of(Xor, [of(Xor, [d, a]), b]),
        "(A ∪ B) − D" => of(Difference, [of(Union, [a, b]), d]),
        other => panic!("found {other}, expected a tree that this test knows"),
    }
}

#[test]
fn the_truth_table_of_the_documentation() {
    let table = truth_table();
    assert_eq!(table.len(), 14, "rows of the table");
    let colored = |low: [f64; 3], high: [f64; 3], material: u32| {
        Tree::from(Brush::cuboid(DVec3::from_array(low), DVec3::from_array(high), MaterialId(material)))
    };
    for (text, by_contact) in &table {
        for (contact, expected) in by_contact.iter().enumerate() {
            for names in [["a", "b", "c"], ["b", "a", "c"]] {
                // faces at x = 2, which overlap in the unit face at (2, 0, 0)
                let a = colored([0.0, 0.0, 0.0], [2.0, 2.0, 2.0], 0);
                let (low, high) = if contact == 0 { (1.0, 2.0) } else { (2.0, 3.0) };
                let b = colored([low, -1.0, -1.0], [high, 1.0, 1.0], 1);
                let d = colored([-3.0, -3.0, -3.0], [5.0, 5.0, 5.0], 2);
                let materials = names.map(Material::named).to_vec();
                let model = Model { materials, tree: tree_of(text, [a, b, d]) };
                let mesh = evaluate(&model).expect("a mesh").mesh;
                let found: Vec<u32> =
                    materials_at(&mesh, 0, DVec3::new(2.0, 0.0, 0.0)).iter().map(|(material, _)| material.0).collect();
                let first = u32::from(names[0] == "b");
                let owner = match expected {
                    Expected::Nobody => vec![],
                    Expected::A => vec![0],
                    Expected::B => vec![1],
                    Expected::FirstByName => vec![first],
                    Expected::LastByName => vec![1 - first],
                };
                assert_eq!(found, owner, "{text}, contact {contact}, names {names:?}");
            }
        }
    }
}
