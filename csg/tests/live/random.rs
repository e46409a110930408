//! Random edits: after each the model equals one built anew, and the faces are those of its mesh.

use std::collections::BTreeMap;

use planecut_csg::{
    Brush, BrushId, Change, FaceId, LiveModel, Material, MaterialId, Mesh, Model, Operation, Role, Tree, evaluate,
};
use planecut_kernel::{DVec3, HalfSpace};

/// A generator of small numbers (Steele, Lea and Flood 2014).
struct Random(u64);

impl Random {
    fn below(&mut self, bound: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ z >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ z >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        (z ^ z >> 31) % bound
    }

    fn share(&mut self) -> f64 {
        self.below(1 << 53) as f64 / (1_u64 << 53) as f64
    }
}

/// A brush as the planes that bound it, each normal and offset.
type Planes = Vec<([f64; 3], f64)>;

fn brush(planes: &Planes, material: MaterialId) -> Brush {
    let half_space = |(normal, offset): &([f64; 3], f64)| HalfSpace::new(DVec3::from(*normal), *offset).unwrap();
    Brush::from_half_spaces(planes.iter().map(half_space), material)
}

/// Boxes and cut boxes on a small grid: everything touches.
fn on_grid(random: &mut Random) -> Planes {
    let mut planes = Vec::new();
    let mut middle = [0.0; 3];
    for axis in 0..3 {
        let low = random.below(5) as f64;
        let high = low + 1.0 + random.below(3) as f64;
        middle[axis] = 0.5 * (low + high);
        for (sign, at) in [(1.0, high), (-1.0, -low)] {
            let mut normal = [0.0; 3];
            normal[axis] = sign;
            planes.push((normal, at));
        }
    }
    if random.below(3) == 0 {
        let normal = [0; 3].map(|_| random.below(3) as f64 - 1.0);
        if normal != [0.0; 3] {
            let through: f64 = normal.iter().zip(middle).map(|(n, m)| n * m).sum();
            planes.push((normal, through + random.below(3) as f64 * 0.5));
        }
    }
    planes
}

/// Turned bodies in general position.
fn turned(random: &mut Random) -> Planes {
    let center = DVec3::new(random.share(), random.share(), random.share()) * 3.0;
    (0..6 + random.below(20))
        .map(|k| {
            let axis = DVec3::AXES[k as usize / 2 % 3] * if k % 2 == 0 { 1.0 } else { -1.0 };
            let noise = DVec3::new(random.share(), random.share(), random.share()) - 0.5;
            let normal = (axis + 0.9 * noise).normalize();
            (normal.to_array(), normal.dot(center) + 0.4 + 0.4 * random.share())
        })
        .collect()
}

/// What a model should hold.
struct Held {
    id: BrushId,
    planes: Planes,
    material: MaterialId,
    role: Role,
}

fn built_anew(held: &[Held], materials: &[Material]) -> Mesh {
    let mut tree = Tree::empty();
    for brush_held in held {
        let operation = match brush_held.role {
            Role::Add => Operation::Union,
            Role::Subtract => Operation::Difference,
            Role::Intersect => Operation::Intersection,
        };
        tree = Tree::combine(operation, [tree, brush(&brush_held.planes, brush_held.material).into()]);
    }
    evaluate(&Model { materials: materials.to_vec(), tree }).unwrap().mesh
}

/// A triangle by its corners, the least first.
type Corners = [[u64; 3]; 3];

fn corners(triangle: [DVec3; 3]) -> Corners {
    let mut corners = triangle.map(|corner| (corner + 0.0).to_array().map(f64::to_bits));
    let least = (0..3).min_by_key(|k| corners[*k]).unwrap();
    corners.rotate_left(least);
    corners
}

fn triangles_of(mesh: &Mesh) -> Vec<Corners> {
    let at = |vertex: u32| mesh.positions[vertex as usize];
    let mut all: Vec<Corners> = mesh.triangles.iter().map(|triangle| corners(triangle.map(at))).collect();
    all.sort_unstable();
    all
}

/// A copy of the faces, kept up to date by what each edit says.
#[derive(Default)]
struct Viewer(BTreeMap<FaceId, Vec<Corners>>);

impl Viewer {
    fn follow(&mut self, model: &LiveModel, change: &Change) {
        for face in &change.removed {
            assert!(self.0.remove(face).is_some(), "a face was removed that is not there");
        }
        for face in &change.added {
            let triangles = model.face(*face).unwrap().triangles();
            let triangles = triangles.map(|corners_of| corners(corners_of.map(|corner| corner.1))).collect();
            assert!(self.0.insert(*face, triangles).is_none(), "a face was added twice");
        }
    }

    fn triangles(&self) -> Vec<Corners> {
        let mut all: Vec<Corners> = self.0.values().flatten().copied().collect();
        all.sort_unstable();
        all
    }

    /// Around every vertex each edge is met once in either direction.
    fn is_closed(&self, model: &LiveModel) -> bool {
        let mut edges: Vec<(u32, u32)> = Vec::new();
        for face in self.0.keys() {
            for triangle in model.face(*face).unwrap().triangles() {
                let [a, b, c] = triangle.map(|corner| corner.0);
                edges.extend([(a, b), (b, c), (c, a)]);
            }
        }
        edges.sort_unstable();
        let mut back: Vec<(u32, u32)> = edges.iter().map(|(a, b)| (*b, *a)).collect();
        back.sort_unstable();
        edges == back
    }
}

fn edit_at_random(seed: u64, steps: u32, shape: fn(&mut Random) -> Planes) -> (u32, u32) {
    let mut random = Random(seed);
    let materials = vec![Material::named("a"), Material::named("b")];
    let mut model = LiveModel::new(materials.clone());
    let mut held: Vec<Held> = Vec::new();
    let mut viewer = Viewer::default();
    let (mut compared, mut finished) = (0, 0);
    for step in 0..steps {
        let role = [Role::Add, Role::Add, Role::Add, Role::Subtract, Role::Subtract, Role::Intersect]
            [random.below(6) as usize];
        let role = if role == Role::Intersect && random.below(3) > 0 { Role::Add } else { role };
        let choice = if held.is_empty() { 0 } else { random.below(5) };
        let at = random.below(held.len().max(1) as u64) as usize;
        let change = match choice {
            0 | 1 => {
                let (planes, material) = (shape(&mut random), MaterialId(random.below(2) as u32));
                let (id, change) = model.add_brush(brush(&planes, material), role).unwrap();
                held.push(Held { id, planes, material, role });
                change
            }
            2 => model.remove_brush(held.remove(at).id).unwrap(),
            3 => {
                held[at].planes = shape(&mut random);
                model.replace_brush(held[at].id, brush(&held[at].planes, held[at].material)).unwrap()
            }
            _ => {
                held[at].role = role;
                model.set_role(held[at].id, role).unwrap()
            }
        };
        viewer.follow(&model, &change);
        let case = || {
            let brushes: Vec<_> = held.iter().map(|brush| (brush.role, brush.material.0, &brush.planes)).collect();
            format!("seed {seed}, step {step}: {brushes:?}")
        };
        let fresh = built_anew(&held, &materials);
        let mesh = model.mesh().unwrap();
        assert!(mesh == fresh, "another mesh than built anew; {}", case());
        if model.has_faces() {
            compared += 1;
            assert!(viewer.is_closed(&model), "not closed; {}", case());
            let (seen, expected) = (viewer.triangles(), triangles_of(&fresh));
            assert_eq!(seen.len(), model.triangle_count());
            // edges that occur twice have been split in the mesh, or noise was contracted
            if seen == expected {
                finished += 1;
            }
        }
    }
    (compared, finished)
}

#[test]
fn random_edits_on_a_grid_equal_a_model_built_anew() {
    for seed in 0..40 {
        println!("{:?}", edit_at_random(seed, 40, on_grid));
    }
}

#[test]
fn random_edits_in_general_position_equal_a_model_built_anew() {
    for seed in 0..20 {
        println!("{:?}", edit_at_random(seed, 40, turned));
    }
}
