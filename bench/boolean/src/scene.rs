//! What is timed: convex bodies or closed meshes, and what is done with them. One file holds both, so that every contestant, whatever
//! its language, has the same bodies.
//!
//! The file is one line of JSON (a [`Header`]), then the planes of all bodies as `[nx, ny, nz, d]` and the positions
//! of all bodies (`f64`), then all triangles (`u32`), little-endian.

use std::fs::File;
use std::io::{BufRead, BufReader, BufWriter, Read, Write};
use std::path::Path;

use planecut_csg::{Brush, MaterialId, Operation, Tree};
use planecut_kernel::{DVec3, HalfSpace, IncrementalPolytope};
use serde::{Deserialize, Serialize};

/// An affine map, by rows.
pub(crate) type Matrix = [[f64; 4]; 3];

/// A convex body, as half-spaces and as a closed triangle mesh; or any closed mesh, which has no half-spaces.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Body {
    pub(crate) planes: Vec<[f64; 4]>,
    pub(crate) positions: Vec<[f64; 3]>,
    pub(crate) triangles: Vec<[u32; 3]>,
    /// How a mesh is moved, by the kernels themselves.
    pub(crate) matrix: Option<Matrix>,
}

/// What a step does with a body.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Action {
    Add,
    Subtract,
}

/// One entry of a tree in postfix order: the next body, or an operation on a number of results before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Entry {
    Leaf,
    Union(u32),
    Difference(u32),
    Intersection(u32),
}

/// What is done with the bodies.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Plan {
    /// One tree, evaluated at once.
    Tree(Vec<Entry>),
    /// One body after another, by number; the result of each step is materialised.
    Steps(Vec<(Action, u32)>),
    /// The union of a number of first bodies is there already; each further body then takes the place of the first, one after
    /// another, and each result is materialised.
    Moves(u32),
    /// The union of a number of first bodies is there already; each further body is taken from it, one after another, and each
    /// result is materialised.
    Cuts(u32),
}

/// Bodies and what is done with them.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Scene {
    pub(crate) bodies: Vec<Body>,
    pub(crate) plan: Plan,
}

#[derive(Serialize, Deserialize)]
struct Header {
    /// Planes, positions and triangles of each body.
    bodies: Vec<[usize; 3]>,
    matrices: Vec<Option<Matrix>>,
    plan: Plan,
}

impl Body {
    /// A bounded brush with its mesh; nothing for one that is empty or unbounded.
    pub(crate) fn of(brush: &Brush) -> Option<Self> {
        // its tolerance merges corners that are one but for the rounding of plane coefficients
        let mut polytope = IncrementalPolytope::new();
        for face in &brush.faces {
            polytope.add_plane(face.half_space);
        }
        if polytope.is_empty() || !polytope.is_bounded() {
            return None;
        }
        let (positions, polygons) = polytope.to_mesh();
        let fan = |polygon: &Vec<usize>| {
            let corners: Vec<u32> = polygon.iter().map(|corner| *corner as u32).collect();
            (2..corners.len()).map(|k| [corners[0], corners[k - 1], corners[k]]).collect::<Vec<[u32; 3]>>()
        };
        Some(Self {
            planes: brush.faces.iter().map(|face| coefficients(&face.half_space)).collect(),
            positions: positions.iter().map(DVec3::to_array).collect(),
            triangles: polygons.iter().flat_map(fan).collect(),
            matrix: None,
        })
    }

    /// Whether it is a mesh, without half-spaces.
    pub(crate) fn is_mesh(&self) -> bool {
        self.planes.is_empty()
    }

    /// The half-spaces as a brush.
    pub(crate) fn brush(&self) -> Brush {
        let half_space =
            |[x, y, z, d]: &[f64; 4]| HalfSpace::new(DVec3::new(*x, *y, *z), *d).expect("it came from one");
        Brush::from_half_spaces(self.planes.iter().map(half_space), MaterialId(0))
    }
}

fn coefficients(half_space: &HalfSpace) -> [f64; 4] {
    half_space.normal().extend(half_space.offset()).to_array()
}

impl Scene {
    /// An operation on all bodies at once.
    pub(crate) fn batch(bodies: Vec<Body>, operation: fn(u32) -> Entry) -> Self {
        let mut entries = vec![Entry::Leaf; bodies.len()];
        entries.push(operation(bodies.len() as u32));
        Self { bodies, plan: Plan::Tree(entries) }
    }

    /// The first body, then one action with each of the others.
    pub(crate) fn one_by_one(bodies: Vec<Body>, action: Action) -> Self {
        let others = (1..bodies.len() as u32).map(|k| (action, k));
        let steps = std::iter::once((Action::Add, 0)).chain(others).collect();
        Self { bodies, plan: Plan::Steps(steps) }
    }

    /// All that the plan says as one tree over brushes.
    pub(crate) fn at_once(&self) -> Tree {
        match &self.plan {
            Plan::Tree(entries) => self.tree(entries),
            Plan::Steps(steps) => steps.chunk_by(|a, b| a.0 == b.0).fold(Tree::empty(), |solid, alike| {
                let bodies = alike.iter().map(|(_, body)| Tree::from(self.bodies[*body as usize].brush()));
                let operands = std::iter::once(solid).chain(bodies);
                match alike[0].0 {
                    Action::Add => Tree::union(operands),
                    Action::Subtract => Tree::difference(operands),
                }
            }),
            Plan::Moves(count) => {
                let last = Self::moves(&self.bodies, *count).last();
                Tree::union_of(last.into_iter().flatten().map(Body::brush).collect())
            }
            Plan::Cuts(count) => {
                let (model, tools) = self.bodies.split_at(*count as usize);
                let model = Tree::union_of(model.iter().map(Body::brush).collect());
                Tree::difference(std::iter::once(model).chain(tools.iter().map(|tool| tool.brush().into())))
            }
        }
    }

    /// For a plan of moves the bodies whose union is the result of each move.
    pub(crate) fn moves<T>(bodies: &[T], count: u32) -> impl Iterator<Item = impl Iterator<Item = &T>> {
        let (model, forms) = bodies.split_at(count as usize);
        forms.iter().map(|form| std::iter::once(form).chain(model.iter().skip(1)))
    }

    /// A tree over brushes.
    pub(crate) fn tree(&self, entries: &[Entry]) -> Tree {
        let brushes = self.bodies.iter().map(Body::brush);
        // without a tree for each brush, as whoever has a list of them
        if let [leaves @ .., Entry::Union(_)] = entries
            && leaves.iter().all(|entry| matches!(entry, Entry::Leaf))
        {
            return Tree::union_of(brushes.collect());
        }
        Self::tree_of(entries, brushes)
    }

    /// A tree over leaves.
    pub(crate) fn tree_of(entries: &[Entry], mut leaves: impl Iterator<Item = Brush>) -> Tree {
        let mut stack: Vec<Tree> = Vec::new();
        for entry in entries {
            let (operation, count) = match entry {
                Entry::Leaf => {
                    stack.extend(leaves.next().map(Tree::from));
                    continue;
                }
                Entry::Union(count) => (Operation::Union, count),
                Entry::Difference(count) => (Operation::Difference, count),
                Entry::Intersection(count) => (Operation::Intersection, count),
            };
            let operands = stack.split_off(stack.len() - *count as usize);
            stack.push(Tree::combine(operation, operands));
        }
        stack.pop().unwrap_or_default()
    }

    /// Whether its bodies are meshes, which are made of arrays on the clock.
    pub(crate) fn is_of_meshes(&self) -> bool {
        self.bodies.first().is_some_and(Body::is_mesh)
    }

    /// Triangles of all bodies.
    pub(crate) fn triangles(&self) -> usize {
        self.bodies.iter().map(|body| body.triangles.len()).sum()
    }

    /// Writes the file.
    pub(crate) fn write(&self, path: &Path) -> std::io::Result<()> {
        let mut out = BufWriter::new(File::create(path)?);
        let sizes = self.bodies.iter().map(|body| [body.planes.len(), body.positions.len(), body.triangles.len()]);
        let matrices = self.bodies.iter().map(|body| body.matrix).collect();
        serde_json::to_writer(&mut out, &Header { bodies: sizes.collect(), matrices, plan: self.plan.clone() })?;
        out.write_all(b"\n")?;
        let planes = self.bodies.iter().flat_map(|body| body.planes.iter().flatten());
        let positions = self.bodies.iter().flat_map(|body| body.positions.iter().flatten());
        for number in planes.chain(positions) {
            out.write_all(&number.to_le_bytes())?;
        }
        for corner in self.bodies.iter().flat_map(|body| body.triangles.iter().flatten()) {
            out.write_all(&corner.to_le_bytes())?;
        }
        out.flush()
    }

    /// Reads the file again.
    pub(crate) fn read(path: &Path) -> std::io::Result<Self> {
        Self::read_with(path, |_| true)
    }

    /// Reads the file without the meshes of bodies that have half-spaces: what is read and dropped would leave holes among
    /// what stays, and count as memory of a kernel that has no use for it.
    pub(crate) fn read_half_spaces(path: &Path) -> std::io::Result<Self> {
        Self::read_with(path, Body::is_mesh)
    }

    fn read_with(path: &Path, needs_mesh: impl Fn(&Body) -> bool) -> std::io::Result<Self> {
        let mut file = BufReader::new(File::open(path)?);
        let mut line = String::new();
        file.read_line(&mut line)?;
        let Header { bodies: sizes, matrices, plan } = serde_json::from_str(&line)?;
        let mut bodies: Vec<Body> = matrices.into_iter().map(|matrix| Body { matrix, ..Body::default() }).collect();
        for (body, [count, _, _]) in bodies.iter_mut().zip(&sizes) {
            body.planes = (0..*count).map(|_| read_numbers(&mut file)).collect::<Result<_, _>>()?;
        }
        for (body, [_, count, _]) in bodies.iter_mut().zip(&sizes) {
            body.positions = read_or_skip(&mut file, *count, needs_mesh(body), read_numbers)?;
        }
        for (body, [_, _, count]) in bodies.iter_mut().zip(&sizes) {
            body.triangles = read_or_skip(&mut file, *count, needs_mesh(body), read_corners)?;
        }
        Ok(Self { bodies, plan })
    }
}

/// Some elements, or none where they are not needed.
fn read_or_skip<T>(
    file: &mut BufReader<File>,
    count: usize,
    is_needed: bool,
    read: fn(&mut BufReader<File>) -> std::io::Result<T>,
) -> std::io::Result<Vec<T>> {
    if is_needed {
        return (0..count).map(|_| read(file)).collect();
    }
    file.seek_relative((count * size_of::<T>()) as i64)?;
    Ok(Vec::new())
}

fn read_numbers<const N: usize>(file: &mut impl Read) -> std::io::Result<[f64; N]> {
    let mut numbers = [0.0; N];
    for number in &mut numbers {
        let mut bytes = [0; 8];
        file.read_exact(&mut bytes)?;
        *number = f64::from_le_bytes(bytes);
    }
    Ok(numbers)
}

fn read_corners(file: &mut impl Read) -> std::io::Result<[u32; 3]> {
    let mut corners = [0; 3];
    for corner in &mut corners {
        let mut bytes = [0; 4];
        file.read_exact(&mut bytes)?;
        *corner = u32::from_le_bytes(bytes);
    }
    Ok(corners)
}

#[cfg(test)]
mod tests {
    use super::{Action, Body, Entry, Plan, Scene};
    use crate::workloads::{Menger, boxes, menger};
    use planecut_csg::Tree;

    #[test]
    fn a_file_holds_all_of_a_scene() {
        let mut scene = menger(1, Menger::Combs).scene;
        let file = std::env::temp_dir().join(format!("planecut-bench-test-{}.scene", std::process::id()));
        for plan in [
            scene.plan.clone(),
            Plan::Steps(vec![(Action::Add, 1), (Action::Subtract, 0)]),
            Plan::Moves(3),
            Plan::Cuts(2),
        ] {
            scene.plan = plan;
            scene.write(&file).unwrap();
            assert_eq!(Scene::read(&file).unwrap(), scene);
        }
        let half_spaces = Scene::read_half_spaces(&file).unwrap();
        let planes = |scene: &Scene| scene.bodies.iter().map(|body| body.planes.clone()).collect::<Vec<_>>();
        assert_eq!(planes(&half_spaces), planes(&scene));
        assert!(half_spaces.bodies.iter().all(|body| body.positions.is_empty() && body.triangles.is_empty()));
        let matrix = Some([[1.0, 0.1, 0.0, 5.0], [0.0, 1.0, 0.0, 1.0 / 3.0], [0.0, 0.0, 2.0, 0.0]]);
        scene.bodies[0] = Body { planes: Vec::new(), matrix, ..scene.bodies[0].clone() };
        scene.write(&file).unwrap();
        assert_eq!(Scene::read(&file).unwrap(), scene);
        assert_eq!(Scene::read_half_spaces(&file).unwrap().bodies[0], scene.bodies[0]);
        std::fs::remove_file(file).unwrap();
    }

    #[test]
    fn a_body_is_the_same_as_brush_and_as_mesh() {
        for body in boxes(5, true) {
            assert_eq!([body.planes.len(), body.positions.len(), body.triangles.len()], [6, 8, 12]);
            assert_eq!(Body::of(&body.brush()), Some(body));
        }
    }

    #[test]
    fn steps_become_a_tree() {
        let bodies = boxes(3, false);
        let steps = [(Action::Add, 0), (Action::Add, 1), (Action::Subtract, 2), (Action::Add, 2)];
        let scene = Scene { bodies, plan: Plan::Steps(steps.to_vec()) };
        assert_eq!(scene.at_once().brushes().len(), 4);
        let batch = Scene::batch(scene.bodies.clone(), Entry::Union);
        assert_eq!(batch.at_once().brushes().len(), 3);
        let moves = Scene { bodies: scene.bodies.clone(), plan: Plan::Moves(1) };
        assert_eq!(moves.at_once().brushes(), [moves.bodies[2].brush()]);
        let cuts = Scene { bodies: scene.bodies, plan: Plan::Cuts(2) };
        let brush = |k: usize| Tree::from(cuts.bodies[k].brush());
        assert_eq!(cuts.at_once(), Tree::difference([Tree::union([brush(0), brush(1)]), brush(2)]));
    }
}
