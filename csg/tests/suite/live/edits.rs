//! Sequences of edits, as plain numbers, and what must hold after each.

use std::collections::BTreeMap;
use std::fmt::{Display, Formatter};
use std::panic::catch_unwind;

use planecut_csg::{
    Brush, BrushFace, BrushId, Change, EditError, EvaluateError, FaceId, LiveFace, LiveModel, Material, MaterialId,
    Mesh, Model, Operation, Role, Transform, Tree, evaluate,
};
use planecut_kernel::{DMat3, DVec3, HalfSpace, PlaneIdx};

/// A plane: normal and offset.
pub(crate) type Plane = ([f64; 3], f64);
/// The planes of a brush.
pub(crate) type Planes = Vec<Plane>;

/// An edit; brushes are meant by their place among those that are there, planes by theirs in the brush, counted around.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Edit {
    Add(Planes, u32, Role),
    Remove(usize),
    Replace(usize, Planes),
    SetRole(usize, Role),
    AddPlane(usize, Plane, u32),
    RemovePlane(usize, usize),
    MovePlane(usize, usize, f64),
    /// By how far a plane is moved on.
    Nudge(usize, usize, f64),
    /// Axis and degrees of a rotation, and a translation.
    Move(usize, [f64; 3], f64, [f64; 3]),
    Undo,
    Redo,
}

impl Display for Edit {
    fn fmt(&self, out: &mut Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Add(planes, material, role) => write!(out, "Edit::Add(vec!{planes:?}, {material}, Role::{role:?})"),
            Self::Replace(at, planes) => write!(out, "Edit::Replace({at}, vec!{planes:?})"),
            Self::SetRole(at, role) => write!(out, "Edit::SetRole({at}, Role::{role:?})"),
            other => write!(out, "Edit::{other:?}"),
        }
    }
}

/// How many materials there are.
const MATERIALS: u32 = 2;

fn materials() -> Vec<Material> {
    // named backwards, so that their order is not that of the ids
    (0..MATERIALS).map(|k| Material::named(format!("material {}", 9 - k))).collect()
}

fn half_space((normal, offset): &Plane) -> HalfSpace {
    HalfSpace::new(DVec3::from_array(*normal), *offset).expect("a valid plane")
}

/// A brush as the test keeps it, each plane with its number.
#[derive(Debug, Clone)]
struct Held {
    id: BrushId,
    faces: Vec<(PlaneIdx, BrushFace)>,
    next: usize,
    role: Role,
}

impl Held {
    fn new(id: BrushId, planes: &Planes, material: u32, role: Role, first: usize) -> Self {
        let face = |plane| BrushFace { half_space: half_space(plane), material: MaterialId(material) };
        let faces: Vec<(PlaneIdx, BrushFace)> = (first..).map(PlaneIdx).zip(planes.iter().map(face)).collect();
        Self { id, next: first + faces.len(), faces, role }
    }

    fn brush(&self) -> Brush {
        Brush { faces: self.faces.iter().map(|face| face.1).collect(), ..Brush::default() }
    }

    fn material(&self) -> u32 {
        self.faces.first().map_or(0, |face| face.1.material.0)
    }
}

fn built_fresh(held: &[Held]) -> Result<Mesh, EvaluateError> {
    let tree = held.iter().fold(Tree::empty(), |tree, held| {
        let operation = match held.role {
            Role::Add => Operation::Union,
            Role::Subtract => Operation::Difference,
            Role::Intersect => Operation::Intersection,
        };
        Tree::combine(operation, [tree, held.brush().into()])
    });
    Ok(evaluate(&Model { materials: materials(), tree })?.mesh)
}

/// The brushes now, and as they were before each edit that can be undone or redone.
#[derive(Default)]
struct Brushes {
    now: Vec<Held>,
    done: Vec<Vec<Held>>,
    undone: Vec<Vec<Held>>,
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
    /// Edits that were refused, as the solid would have been unbounded.
    pub(crate) refused: usize,
}

impl std::iter::Sum for Tally {
    fn sum<I: Iterator<Item = Self>>(tallies: I) -> Self {
        tallies.fold(Self::default(), |sum, tally| Self {
            compared: sum.compared + tally.compared,
            equal: sum.equal + tally.equal,
            triangles: sum.triangles + tally.triangles,
            refused: sum.refused + tally.refused,
        })
    }
}

impl Brushes {
    /// What an edit makes of the brushes, and does to a model; nothing where there is no brush to edit.
    fn edited(&mut self, model: &mut LiveModel, edit: &Edit) -> Option<(Vec<Held>, Result<Change, EditError>)> {
        let mut new = self.now.clone();
        let count = new.len();
        if count == 0 && !matches!(edit, Edit::Add(..) | Edit::Undo | Edit::Redo) {
            return None;
        }
        let change = match edit {
            Edit::Add(planes, material, role) => {
                let body = Held::new(BrushId(0), planes, *material, *role, 0);
                let added = model.add_brush(body.brush(), *role);
                // what is refused is there for the freshly built model
                let id = added.as_ref().map_or(BrushId(u64::MAX), |added| added.0);
                new.push(Held { id, ..body });
                added.map(|added| added.1)
            }
            Edit::Remove(at) => model.remove_brush(new.remove(at % count).id),
            Edit::Replace(at, planes) => {
                let held = &mut new[at % count];
                *held = Held::new(held.id, planes, held.material(), held.role, held.next);
                model.replace_brush(held.id, held.brush())
            }
            Edit::SetRole(at, role) => {
                new[at % count].role = *role;
                model.set_role(new[at % count].id, *role)
            }
            Edit::AddPlane(at, plane, material) => {
                let held = &mut new[at % count];
                let (half_space, material) = (half_space(plane), MaterialId(*material));
                held.faces.push((PlaneIdx(held.next), BrushFace { half_space, material }));
                held.next += 1;
                model.add_plane(held.id, half_space, material).map(|(number, change)| {
                    assert_eq!(number.0 + 1, held.next, "planes are numbered one by one");
                    change
                })
            }
            Edit::RemovePlane(at, plane) => {
                let held = &mut new[at % count];
                let (number, _) = held.faces.remove(plane % held.faces.len().max(1));
                model.remove_plane(held.id, number)
            }
            Edit::MovePlane(at, plane, _) | Edit::Nudge(at, plane, _) => {
                let held = &mut new[at % count];
                let place = plane % held.faces.len().max(1);
                let (number, face) = &mut held.faces[place];
                let normal = face.half_space.normal();
                let offset = match edit {
                    Edit::MovePlane(_, _, offset) => *offset,
                    Edit::Nudge(_, _, by) => face.half_space.offset() + by * normal.length(),
                    _ => unreachable!("one of both"),
                };
                face.half_space = HalfSpace::new(normal, offset).expect("a valid plane");
                model.move_plane(held.id, *number, face.half_space)
            }
            Edit::Move(at, axis, degrees, by) => {
                let held = &mut new[at % count];
                let linear = DMat3::from_axis_angle(DVec3::from_array(*axis).normalize(), degrees.to_radians());
                let transform = Transform::new(linear, DVec3::from_array(*by)).expect("a rotation");
                for (_, face) in &mut held.faces {
                    face.half_space = transform.half_space(&face.half_space).expect("a plane not too far away");
                }
                model.transform_brush(held.id, &transform)
            }
            Edit::Undo | Edit::Redo => {
                let (from, change) = match edit {
                    Edit::Undo => (self.done.last(), model.undo()),
                    _ => (self.undone.last(), model.redo()),
                };
                match from {
                    Some(before) => {
                        let next = |id| self.now.iter().find(|held| held.id == id).map_or(0, |held| held.next);
                        new = before
                            .iter()
                            .map(|held| Held { next: held.next.max(next(held.id)), ..held.clone() })
                            .collect();
                    }
                    None => {
                        assert!(matches!(change, Err(EditError::NothingToUndo | EditError::NothingToRedo)));
                        return None;
                    }
                }
                change
            }
        };
        Some((new, change))
    }

    /// Takes what an edit has made of the brushes.
    fn take(&mut self, edit: &Edit, new: Vec<Held>) {
        let old = std::mem::replace(&mut self.now, new);
        match edit {
            Edit::Undo => {
                self.done.pop();
                self.undone.push(old);
            }
            Edit::Redo => {
                self.undone.pop();
                self.done.push(old);
            }
            _ => {
                self.undone.clear();
                self.done.push(old);
            }
        }
    }
}

/// What the triangles of the faces are beside those of the mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Faces {
    /// The same, where there are as many.
    Same,
    /// Others, as the mesh is freed of what noise there is.
    Noisy,
}

/// Applies edits one by one and compares after each; tells what is wrong.
pub(crate) fn run(edits: &[Edit], faces: Faces) -> Result<Tally, String> {
    let mut model = LiveModel::new(materials());
    let mut held = Brushes::default();
    let mut viewer = Viewer::default();
    let mut tally = Tally::default();
    for (step, edit) in edits.iter().enumerate() {
        let fault = |text: &str| format!("edit {step}: {text}");
        let Some((new, change)) = held.edited(&mut model, edit) else { continue };
        let fresh = built_fresh(&new);
        let fresh = match (change, fresh) {
            (Ok(change), Ok(fresh)) => {
                viewer.follow(&model, &change).map_err(|text| fault(&text))?;
                held.take(edit, new);
                fresh
            }
            (Err(EditError::Evaluate(found)), Err(expected)) if found == expected => {
                tally.refused += 1;
                built_fresh(&held.now).map_err(|error| fault(&error.to_string()))?
            }
            (Ok(_), Err(error)) => return Err(fault(&format!("it was done, but not in a fresh build: {error}"))),
            (Err(error), _) => return Err(fault(&error.to_string())),
        };
        let mesh = model.mesh().map_err(|error| fault(&error.to_string()))?;
        if mesh != fresh {
            return Err(fault("the mesh is not that of a freshly built model"));
        }
        if step % 8 == 0 && evaluate(&model.to_model()).map(|evaluation| evaluation.mesh) != Ok(fresh.clone()) {
            return Err(fault("as a tree the model has another mesh"));
        }
        if step % 8 == 4 {
            let mut other = LiveModel::from_model(model.to_model()).map_err(|error| fault(&error.to_string()))?;
            if model.measures() != other.measures() || model.areas_of_materials() != other.areas_of_materials() {
                return Err(fault("the measures are not those of a new model"));
            }
        }
        if !model.has_faces() {
            continue;
        }
        if !viewer.is_closed(&model) {
            return Err(fault("the faces are not closed"));
        }
        let (seen, expected) = (viewer.triangles(), triangles_of(&fresh));
        let is_freed = |triangle: &Corners| is_flat(triangle) && expected.binary_search(triangle).is_err();
        if seen.len() != model.triangle_count() {
            return Err(fault("triangles are miscounted"));
        }
        if faces == Faces::Same && seen.len() == expected.len() && seen != expected && !seen.iter().any(is_freed) {
            return Err(fault("the faces have other triangles than the mesh"));
        }
        tally.compared += 1;
        tally.equal += usize::from(seen == expected);
        tally.triangles += seen.len();
    }
    Ok(tally)
}

/// Runs edits; where something is wrong, fails with as few of them as show it, as Rust.
pub(crate) fn check(seed: u64, edits: &[Edit], faces: Faces) -> Tally {
    let first = match guarded(edits, faces) {
        Ok(tally) => return tally,
        Err(first) => first,
    };
    let mut few = edits.to_vec();
    let mut at = 0;
    while at < few.len() {
        let mut fewer = few.clone();
        fewer.remove(at);
        if guarded(&fewer, faces).is_err() {
            few = fewer;
        } else {
            at += 1;
        }
    }
    let lines: Vec<String> = few.iter().map(|edit| format!("    {edit},")).collect();
    let least = guarded(&few, faces).expect_err("it still fails");
    panic!("seed {seed}: {first}; with fewer edits: {least}\nrun(&[\n{}\n], Faces::{faces:?})", lines.join("\n"));
}

/// The same where it panics.
fn guarded(edits: &[Edit], faces: Faces) -> Result<Tally, String> {
    catch_unwind(|| run(edits, faces)).unwrap_or_else(|_| Err("panicked".to_owned()))
}

/// A triangle by its corners, the least first.
pub(crate) type Corners = [[u64; 3]; 3];

/// Whether a triangle is that of rounded corners of a line: the mesh is freed of such.
fn is_flat(triangle: &Corners) -> bool {
    let [a, b, c] = triangle.map(|corner| DVec3::from_array(corner.map(f64::from_bits)));
    let (u, v) = (b - a, c - a);
    u.cross(v).length() < 1e-12 * u.length_squared().max(v.length_squared())
}

fn corners(triangle: [DVec3; 3]) -> Corners {
    let mut corners = triangle.map(|corner| (corner + 0.0).to_array().map(f64::to_bits));
    let least = (0..3).min_by_key(|k| corners[*k]).unwrap_or_default();
    corners.rotate_left(least);
    corners
}

pub(crate) fn triangles_of(mesh: &Mesh) -> Vec<Corners> {
    let at = |vertex: u32| mesh.positions[vertex as usize];
    let mut all: Vec<Corners> = mesh.triangles.iter().map(|triangle| corners(triangle.map(at))).collect();
    all.sort_unstable();
    all
}

/// A copy of the faces, kept up to date by what each edit says alone.
#[derive(Default)]
pub(crate) struct Viewer(BTreeMap<FaceId, Vec<Corners>>);

impl Viewer {
    /// Takes a face that is there at the beginning.
    pub(crate) fn add(&mut self, id: FaceId, face: LiveFace<'_>) {
        self.0.insert(id, face.triangles().map(|triangle| corners(triangle.map(|corner| corner.1))).collect());
    }

    pub(crate) fn follow(&mut self, model: &LiveModel, change: &Change) -> Result<(), String> {
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

    pub(crate) fn triangles(&self) -> Vec<Corners> {
        let mut all: Vec<Corners> = self.0.values().flatten().copied().collect();
        all.sort_unstable();
        all
    }

    /// Whether each edge between vertices is met as often in either direction.
    pub(crate) fn is_closed(&self, model: &LiveModel) -> bool {
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
