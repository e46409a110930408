//! Any bytes as two or three closed meshes, perhaps a brush, and what is done with them one after another.

use std::fmt::{Display, Formatter};

use planecut_csg::{Brush, ClosedMesh, MaterialId, MeshBody, Operation, Transform, Tree, WindingRule};
use planecut_kernel::{DMat3, DVec3};

/// The shortest input that is taken.
const SHORTEST: usize = 8;

/// Operands, and how each is combined with what those before it have made.
#[derive(Debug)]
pub(crate) struct Scene {
    pub(crate) operands: Vec<Brush>,
    pub(crate) steps: Vec<Step>,
    /// Whether coordinates are small dyadic numbers, so that nothing is rounded but where planes meet.
    pub(crate) is_on_grid: bool,
}

/// What is done with an operand and the result before it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Step {
    pub(crate) operation: Operation,
    /// Whether the operand comes first.
    pub(crate) is_swapped: bool,
}

impl Scene {
    pub(crate) fn tree(&self) -> Tree {
        let mut operands = self.operands.iter().cloned().map(Tree::from);
        let first = operands.next().unwrap_or_default();
        operands.zip(&self.steps).fold(first, |tree, (operand, step)| {
            Tree::combine(step.operation, if step.is_swapped { [operand, tree] } else { [tree, operand] })
        })
    }
}

impl Display for Scene {
    /// Arrays and steps as Rust, to be pasted into a test.
    fn fmt(&self, out: &mut Formatter<'_>) -> std::fmt::Result {
        for operand in &self.operands {
            match &operand.mesh {
                Some(mesh) => {
                    let positions: Vec<[f64; 3]> = mesh.positions().iter().map(DVec3::to_array).collect();
                    writeln!(out, "mesh({positions:?}, {:?}, WindingRule::{:?})", mesh.triangles(), mesh.rule())?;
                }
                None => writeln!(out, "brush({:?})", operand.half_spaces().collect::<Vec<_>>())?,
            }
        }
        writeln!(out, "{:?}", self.steps)
    }
}

/// A scene; nothing where there are too few bytes for one.
pub(crate) fn scene(bytes: &[u8]) -> Option<Scene> {
    if bytes.len() < SHORTEST {
        return None;
    }
    let mut bytes = Bytes(bytes.iter());
    let kind = bytes.next();
    let size = 2 + kind / 4 % 4;
    let mut operands = Vec::new();
    let mut is_on_grid = true;
    for _ in 0..2 + kind % 2 {
        let mut soup = Soup::default();
        let parts = bytes.next();
        (0..=parts % 3).for_each(|_| soup.push(&mut bytes, size));
        let (transform, is_exact) = transform(parts / 3);
        is_on_grid &= is_exact;
        operands.push(Brush::of_mesh(soup.body(parts / 64).transformed(&transform).ok()?));
    }
    if kind & 2 != 0 {
        let low = bytes.corner(size);
        operands.push(Brush::cuboid(low, low + bytes.extent(), MaterialId(0)));
    }
    let steps = (1..operands.len()).map(|_| step(bytes.next())).collect();
    Some(Scene { operands, steps, is_on_grid })
}

fn step(byte: u8) -> Step {
    let operations = [Operation::Union, Operation::Intersection, Operation::Difference, Operation::Xor];
    Step { operation: operations[usize::from(byte % 4)], is_swapped: byte & 4 != 0 }
}

/// Where a mesh goes, and whether all of it is exact; most stay where they are.
fn transform(byte: u8) -> (Transform, bool) {
    let quarter = DMat3::from_cols(DVec3::Y, -DVec3::X, DVec3::Z);
    let (linear, shift, is_exact) = match byte % 8 {
        0 => (DMat3::IDENTITY, DVec3::new(0.5, 0.0, 0.25), true),
        1 => (quarter, DVec3::new(3.0, 0.0, 0.0), true),
        2 => (DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0)), DVec3::X, true),
        3 => (DMat3::from_rotation_z(0.3), DVec3::ZERO, false),
        4 => (DMat3::IDENTITY, DVec3::splat(0.1), false),
        _ => (DMat3::IDENTITY, DVec3::ZERO, true),
    };
    (Transform::new(linear, shift).expect("it can be undone"), is_exact)
}

/// The input, and zeros after its end.
struct Bytes<'a>(std::slice::Iter<'a, u8>);

impl Bytes<'_> {
    fn next(&mut self) -> u8 {
        self.0.next().copied().unwrap_or(0)
    }

    /// A corner at whole numbers below `size`, of one byte.
    fn corner(&mut self, size: u8) -> DVec3 {
        let byte = self.next();
        DVec3::from_array([byte, byte / size, byte / size / size].map(|v| f64::from(v % size)))
    }

    /// The size of a box, in each direction 1 or 2.
    fn extent(&mut self) -> DVec3 {
        let byte = self.next();
        DVec3::from_array([byte, byte >> 1, byte >> 2].map(|v| f64::from(1 + (v & 1))))
    }
}

/// Triangles of a closed mesh, perhaps one that crosses itself.
#[derive(Default)]
struct Soup {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

impl Soup {
    /// A tetrahedron, a box, or a triangle on both of its sides; where a bit says so, clockwise.
    fn push(&mut self, bytes: &mut Bytes<'_>, size: u8) {
        let kind = bytes.next();
        let (positions, mut triangles) = match kind % 8 {
            0..5 => tetrahedron([(); 4].map(|()| bytes.corner(size))),
            5 | 6 => cuboid(bytes.corner(size), bytes.extent(), bytes.next()),
            _ => ([(); 3].map(|()| bytes.corner(size)).to_vec(), vec![[0, 1, 2], [0, 2, 1]]),
        };
        if kind & 0xe0 == 0xe0 {
            triangles.iter_mut().for_each(|triangle| triangle.swap(0, 1));
        }
        let first = self.positions.len() as u32;
        self.positions.extend(positions);
        self.triangles.extend(triangles.iter().map(|triangle| triangle.map(|vertex| vertex + first)));
    }

    fn body(&self, rule: u8) -> MeshBody {
        let mesh = ClosedMesh::new(&self.positions, &self.triangles, |_| 0).expect("its parts are closed");
        let rules = [WindingRule::Positive, WindingRule::NonZero, WindingRule::Odd];
        MeshBody::new(mesh, vec![MaterialId(0)]).with_rule(rules[usize::from(rule % 3)])
    }
}

fn tetrahedron([a, b, c, d]: [DVec3; 4]) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let mut triangles = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    if (b - a).dot((c - a).cross(d - a)) < 0.0 {
        triangles.iter_mut().for_each(|triangle| triangle.swap(0, 1));
    }
    (vec![a, b, c, d], triangles)
}

/// A box whose faces are cut along either diagonal.
fn cuboid(low: DVec3, extent: DVec3, diagonals: u8) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let corner = |k: u32| low + extent * DVec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2));
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let halves = |(k, face): (usize, [u32; 4])| {
        let turn = usize::from(diagonals >> k & 1);
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| face[(k + turn) % 4]);
        [[a, b, c], [a, c, d]]
    };
    ((0..8).map(corner).collect(), faces.into_iter().enumerate().flat_map(halves).collect())
}
