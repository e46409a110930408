//! Sequences of edits, as plain numbers, and what must hold after each.

use std::collections::BTreeMap;
use std::fmt::{Display, Formatter};

use planecut_csg::{
    Brush, BrushId, Change, FaceId, LiveModel, Material, MaterialId, Mesh, Model, Operation, Role, Tree, evaluate,
};
use planecut_kernel::{DVec3, HalfSpace};

/// The planes of a brush, each normal and offset.
pub(crate) type Planes = Vec<([f64; 3], f64)>;

/// An edit; brushes are meant by their place among those that are there, counted around.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Edit {
    Add(Planes, u32, Role),
    Remove(usize),
    Replace(usize, Planes),
    SetRole(usize, Role),
}

impl Display for Edit {
    fn fmt(&self, out: &mut Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Add(planes, material, role) => write!(out, "Edit::Add(vec!{planes:?}, {material}, Role::{role:?})"),
            Self::Remove(at) => write!(out, "Edit::Remove({at})"),
            Self::Replace(at, planes) => write!(out, "Edit::Replace({at}, vec!{planes:?})"),
            Self::SetRole(at, role) => write!(out, "Edit::SetRole({at}, Role::{role:?})"),
        }
    }
}

/// How many materials there are.
const MATERIALS: u32 = 2;

fn materials() -> Vec<Material> {
    // named backwards, so that their order is not that of the ids
    (0..MATERIALS).map(|k| Material::named(format!("material {}", 9 - k))).collect()
}

fn brush(planes: &Planes, material: u32) -> Brush {
    let half_space = |(normal, offset): &([f64; 3], f64)| {
        HalfSpace::new(DVec3::from_array(*normal), *offset).expect("a valid plane")
    };
    Brush::from_half_spaces(planes.iter().map(half_space), MaterialId(material))
}

struct Held {
    id: BrushId,
    planes: Planes,
    material: u32,
    role: Role,
}

fn built_anew(held: &[Held]) -> Mesh {
    let tree = held.iter().fold(Tree::empty(), |tree, held| {
        let operation = match held.role {
            Role::Add => Operation::Union,
            Role::Subtract => Operation::Difference,
            Role::Intersect => Operation::Intersection,
        };
        Tree::combine(operation, [tree, brush(&held.planes, held.material).into()])
    });
    evaluate(&Model { materials: materials(), tree }).expect("bounded brushes of known materials").mesh
}

/// What a sequence of edits came to.
#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct Tally {
    /// Edits after which the faces were compared.
    pub(crate) compared: usize,
    /// Of these, those after which the mesh has just the triangles of the faces: in the others edges were split because two
    /// of them join the same two vertices, or noise was contracted.
    pub(crate) equal: usize,
    /// Triangles, all in all.
    pub(crate) triangles: usize,
}

/// Applies edits one by one and compares after each; tells what is wrong.
pub(crate) fn run(edits: &[Edit]) -> Result<Tally, String> {
    let mut model = LiveModel::new(materials());
    let mut held: Vec<Held> = Vec::new();
    let mut viewer = Viewer::default();
    let mut tally = Tally::default();
    for (step, edit) in edits.iter().enumerate() {
        let fault = |text: &str| format!("edit {step}: {text}");
        let count = held.len();
        if count == 0 && !matches!(edit, Edit::Add(..)) {
            continue;
        }
        let change = match edit {
            Edit::Add(planes, material, role) => {
                model.add_brush(brush(planes, *material), *role).map(|(id, change)| {
                    held.push(Held { id, planes: planes.clone(), material: *material, role: *role });
                    change
                })
            }
            Edit::Remove(at) => model.remove_brush(held.remove(at % count).id),
            Edit::Replace(at, planes) => {
                let held = &mut held[at % count];
                held.planes.clone_from(planes);
                model.replace_brush(held.id, brush(planes, held.material))
            }
            Edit::SetRole(at, role) => {
                let held = &mut held[at % count];
                held.role = *role;
                model.set_role(held.id, *role)
            }
        };
        let change = change.map_err(|error| fault(&error.to_string()))?;
        viewer.follow(&model, &change).map_err(|text| fault(&text))?;
        let fresh = built_anew(&held);
        let mesh = model.mesh().map_err(|error| fault(&error.to_string()))?;
        if mesh != fresh {
            return Err(fault("the mesh is not that of a model built anew"));
        }
        if !model.has_faces() {
            continue;
        }
        if !viewer.is_closed(&model) {
            return Err(fault("the faces are not closed"));
        }
        let (seen, expected) = (viewer.triangles(), triangles_of(&fresh));
        if seen.len() != model.triangle_count() {
            return Err(fault("triangles are miscounted"));
        }
        if seen.len() == expected.len() && seen != expected {
            return Err(fault("the faces have other triangles than the mesh"));
        }
        tally.compared += 1;
        tally.equal += usize::from(seen == expected);
        tally.triangles += seen.len();
    }
    Ok(tally)
}

/// Runs edits; where something is wrong, fails with as few of them as show it, as Rust.
pub(crate) fn check(seed: u64, edits: &[Edit]) -> Tally {
    let Err(first) = run(edits) else { return run(edits).expect("it went well a moment ago") };
    let mut few = edits.to_vec();
    let mut at = 0;
    while at < few.len() {
        let mut fewer = few.clone();
        fewer.remove(at);
        if run(&fewer).is_err() {
            few = fewer;
        } else {
            at += 1;
        }
    }
    let lines: Vec<String> = few.iter().map(|edit| format!("    {edit},")).collect();
    let least = run(&few).expect_err("it still fails");
    panic!("seed {seed}: {first}; with fewer edits: {least}\nrun(&[\n{}\n])", lines.join("\n"));
}

/// A triangle by its corners, the least first.
type Corners = [[u64; 3]; 3];

fn corners(triangle: [DVec3; 3]) -> Corners {
    let mut corners = triangle.map(|corner| (corner + 0.0).to_array().map(f64::to_bits));
    let least = (0..3).min_by_key(|k| corners[*k]).unwrap_or_default();
    corners.rotate_left(least);
    corners
}

fn triangles_of(mesh: &Mesh) -> Vec<Corners> {
    let at = |vertex: u32| mesh.positions[vertex as usize];
    let mut all: Vec<Corners> = mesh.triangles.iter().map(|triangle| corners(triangle.map(at))).collect();
    all.sort_unstable();
    all
}

/// A copy of the faces, kept up to date by what each edit says alone.
#[derive(Default)]
struct Viewer(BTreeMap<FaceId, Vec<Corners>>);

impl Viewer {
    fn follow(&mut self, model: &LiveModel, change: &Change) -> Result<(), String> {
        for face in &change.removed {
            self.0.remove(face).ok_or_else(|| format!("{face:?} is removed, but was not there"))?;
        }
        for face in &change.added {
            let triangles =
                model.face(*face).ok_or_else(|| format!("{face:?} is added, but is not there"))?.triangles();
            let triangles = triangles.map(|triangle| corners(triangle.map(|corner| corner.1))).collect();
            if self.0.insert(*face, triangles).is_some() {
                return Err(format!("{face:?} is added, but was there already"));
            }
        }
        Ok(())
    }

    fn triangles(&self) -> Vec<Corners> {
        let mut all: Vec<Corners> = self.0.values().flatten().copied().collect();
        all.sort_unstable();
        all
    }

    /// Whether each edge between vertices is met as often in either direction.
    fn is_closed(&self, model: &LiveModel) -> bool {
        let mut edges: Vec<(u32, u32)> = Vec::new();
        for face in self.0.keys().filter_map(|face| model.face(*face)) {
            for triangle in face.triangles() {
                let [a, b, c] = triangle.map(|corner| corner.0);
                edges.extend([(a, b), (b, c), (c, a)]);
            }
        }
        let mut back: Vec<(u32, u32)> = edges.iter().map(|(a, b)| (*b, *a)).collect();
        edges.sort_unstable();
        back.sort_unstable();
        edges == back
    }
}
