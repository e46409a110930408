//! The live model: edits that cost what they touch.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

use glam::DVec3;
use numpy::{PyArray1, PyArray2};
use planecut::check::measure_triangles;
use planecut::csg::{
    BrushId, Change as CoreChange, Edit as CoreEdit, FaceId, LiveModel, Material, MaterialId, Model, Role, Tree,
};
use planecut::kernel::{HalfSpace, PlaneIdx};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use serde::{Deserialize, Serialize};

use crate::arrays::{row, small, vector, view_points, view_rows};
use crate::errors::{Failure, Outcome, refuse};
use crate::expression::Node;
use crate::job::{Job, on_threads_of_process};
use crate::mesh::Mesh;
use crate::solid::{Solid, transform_of};

/// A model that is edited: each edit costs what it touches, and says which faces it changed.
///
/// Its brushes are the convex bodies (and closed meshes) of a solid, numbered from 0 in their order; faces have numbers, too, which may be used again once a face is gone.
///
/// Args:
///     solid: A Solid to begin with. What combines its bodies one after another gives them roles; bodies within nested operations stay operands of these.
///     threads: Number of threads; by default one for each core.
///     progress: A function that is called with done and total.
///
/// >>> import planecut as pc
/// >>> live = pc.Live(pc.box([0, 0, 0], [3, 3, 3]) - pc.box([1, 1, 1], [2, 2, 4]))
/// >>> with live.edit() as e:
/// ...     e.move_plane(0, 0, 4.0)
/// >>> live.volume
/// 34.0
/// >>> live.undo()
/// >>> live.volume
/// 25.0
#[pyclass(frozen, module = "planecut")]
pub(crate) struct Live {
    state: Mutex<State>,
}

struct State {
    model: LiveModel,
    change: CoreChange,
    /// How many calls the edit that is open has made, and what they changed.
    open: Option<(usize, CoreChange)>,
}

impl Live {
    /// Does something with the model, without the interpreter's lock. After a panic the model cannot be trusted, and nothing is done with it any more.
    fn with<T: Send>(&self, py: Python<'_>, work: impl FnOnce(&mut State) -> Outcome<T> + Send) -> PyResult<T> {
        let locked = || {
            let Ok(mut state) = self.state.lock() else {
                return Err(Failure::bug("found a live model that an earlier bug left half-done: make it again"));
            };
            work(&mut state)
        };
        Ok(py.detach(|| on_threads_of_process(locked))?)
    }
}

impl State {
    fn refuse_while_open(&self, name: &str) -> Outcome<()> {
        match self.open {
            Some(_) => Err(Failure::of(format!("{name}: found an edit that is not complete, expected none"))),
            None => Ok(()),
        }
    }

    /// Does a call of the edit that is open.
    fn apply(&mut self, edit: CoreEdit) -> Outcome<(Option<BrushId>, Option<PlaneIdx>)> {
        let Some((count, change)) = &mut self.open else {
            return Err(Failure::of("found an edit that is over, expected calls within `with live.edit() as e`"));
        };
        let edited = self.model.apply(edit)?;
        *count += 1;
        *change = std::mem::take(change).then(edited.change);
        Ok((edited.brush, edited.plane))
    }

    /// The number of a material, which is added where it is new.
    fn material(&mut self, material: &Material) -> MaterialId {
        let known = self.model.materials().iter().position(|known| known == material);
        known.map_or_else(|| self.model.add_material(material.clone()), |number| MaterialId(number as u32))
    }

    /// A material by its name.
    fn material_named(&mut self, name: String) -> MaterialId {
        let known = self.model.materials().iter().position(|known| known.name == name);
        known.map_or_else(|| self.model.add_material(Material::named(name)), |number| MaterialId(number as u32))
    }

    /// The only body of a solid, of materials of this model.
    fn brush_of(&mut self, node: &Node) -> Outcome<planecut::csg::Brush> {
        let Model { materials, tree } = node.model()?;
        if tree.brushes().len() != 1 || !tree.is_union() {
            let found = tree.brushes().len();
            return Err(Failure::of(format!("solid: found one of {found} bodies, expected one convex body or closed mesh")));
        }
        let numbers: Vec<MaterialId> = materials.iter().map(|material| self.material(material)).collect();
        let mut brush = Tree::into_brushes(tree).remove(0);
        brush.materials_mut().for_each(|own| *own = numbers[own.0 as usize]);
        Ok(brush)
    }
}

#[pymethods]
impl Live {
    #[new]
    #[pyo3(signature = (solid, *, threads=None, progress=None))]
    fn new(py: Python<'_>, solid: &Bound<'_, Solid>, threads: Option<usize>, progress: Option<Py<PyAny>>) -> PyResult<Self> {
        let node = Arc::clone(solid.get().node());
        let model = Job::new(py, threads, progress)?
            .short_if(node.is_small())
            .run(py, move || Ok(LiveModel::from_model(node.model()?)?))?;
        let state = State { model, change: CoreChange::default(), open: None };
        Ok(Self { state: Mutex::new(state) })
    }

    /// Begins an edit, to be used in a `with` statement: all of its calls are one step for `undo`. If an exception leaves the statement, nothing of it is done.
    fn edit(slf: Py<Self>) -> Edit {
        Edit { live: slf }
    }

    /// The faces that the last edit changed, or the last `undo` or `redo`.
    #[getter]
    fn change(&self, py: Python<'_>) -> PyResult<Change> {
        Ok(Change { change: self.with(py, |state| Ok(state.change.clone()))? })
    }

    /// Undoes the last edit that is not yet undone.
    fn undo(&self, py: Python<'_>) -> PyResult<()> {
        self.with(py, |state| {
            state.refuse_while_open("undo")?;
            state.change = state.model.undo()?;
            Ok(())
        })
    }

    /// Does the edit again that was last undone.
    fn redo(&self, py: Python<'_>) -> PyResult<()> {
        self.with(py, |state| {
            state.refuse_while_open("redo")?;
            state.change = state.model.redo()?;
            Ok(())
        })
    }

    /// The numbers of the brushes, shape (n,), int64.
    #[getter]
    fn brushes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<i64>>> {
        let ids = self.with(py, |state| Ok(state.model.brushes().map(|id| id.0 as i64).collect::<Vec<_>>()))?;
        Ok(small(py, &ids))
    }

    /// The role of a brush: "add", "subtract" or "intersect".
    fn role(&self, py: Python<'_>, brush: u64) -> PyResult<&'static str> {
        self.with(py, |state| Ok(role_name(state.model.brush(BrushId(brush))?.1)))
    }

    /// The planes of a brush.
    ///
    /// Returns:
    ///     A dict from the number of each plane, by which edits name it, to its four numbers (nx, ny, nz, d).
    fn planes<'py>(&self, py: Python<'py>, brush: u64) -> PyResult<Bound<'py, PyDict>> {
        let planes = self.with(py, |state| {
            let (body, handles) = (state.model.brush(BrushId(brush))?.0, state.model.planes(BrushId(brush))?);
            Ok(handles.iter().map(|plane| plane.0).zip(body.faces.iter().map(|face| face.half_space.to_array())).collect::<Vec<_>>())
        })?;
        let dict = PyDict::new(py);
        for (plane, numbers) in planes {
            dict.set_item(plane, (numbers[0], numbers[1], numbers[2], numbers[3]))?;
        }
        Ok(dict)
    }

    /// The numbers of the faces, shape (f,), int64.
    #[getter]
    fn faces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<i64>>> {
        let ids = self.with(py, |state| Ok(state.model.faces().map(|(id, _)| face_number(id)).collect::<Vec<_>>()))?;
        Ok(small(py, &ids))
    }

    /// A face by its number.
    fn face(&self, py: Python<'_>, id: i64) -> PyResult<Face> {
        self.with(py, |state| {
            let unknown = || Failure::of(format!("id: found {id}, expected the number of a face that is there"));
            let number = FaceId::from(u32::try_from(id).map_err(|_| unknown())?);
            let face = state.model.face(number).ok_or_else(unknown)?;
            let mut places: BTreeMap<u32, u32> = BTreeMap::new();
            let mut vertices = Vec::new();
            let mut corner = |(number, position): (u32, DVec3)| {
                *places.entry(number).or_insert_with(|| {
                    vertices.push(position);
                    vertices.len() as u32 - 1
                })
            };
            let triangles: Vec<[u32; 3]> = face.triangles().map(|corners| corners.map(&mut corner)).collect();
            let source = state.model.source_of_face(number);
            let material = state.model.materials()[face.material().0 as usize].name.clone();
            let normal = face.normal().to_array();
            Ok(Face { brush: source.map(|(brush, _)| brush.0), plane: source.map(|(_, plane)| plane.0), material, normal, vertices, triangles })
        })
    }

    /// The first face that a ray meets, and the distance; None where it meets none.
    ///
    /// Args:
    ///     origin: Shape (3,).
    ///     direction: Shape (3,), of any length but 0.
    fn pick(&self, py: Python<'_>, origin: &Bound<'_, PyAny>, direction: &Bound<'_, PyAny>) -> PyResult<Option<(i64, f64)>> {
        let (origin, direction) = (vector(origin, "origin")?, vector(direction, "direction")?);
        if direction == DVec3::ZERO {
            return Err(refuse("direction: found the zero vector, expected another"));
        }
        let direction = direction / direction.abs().max_element();
        self.with(py, |state| Ok(state.model.pick(origin, direction).map(|(id, distance)| (face_number(id), distance))))
    }

    /// The mesh of the solid, the same as that of a model made anew.
    fn mesh(&self, py: Python<'_>) -> PyResult<Mesh> {
        Ok(Mesh::of_core(self.with(py, |state| Ok(state.model.mesh()?))?))
    }

    /// The volume.
    #[getter]
    fn volume(&self, py: Python<'_>) -> PyResult<f64> {
        self.with(py, |state| {
            let mesh = state.model.mesh()?;
            Ok(measure_triangles(&mesh.positions, &mesh.triangles).map_or(0.0, |measures| measures.volume))
        })
    }

    /// The model as it is now, as a Solid.
    fn to_solid(&self, py: Python<'_>) -> PyResult<Solid> {
        Ok(Solid::of(Node::of_model(self.with(py, |state| Ok(state.model.to_model()))?)))
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let (brushes, faces) = self.with(py, |state| Ok((state.model.brushes().len(), state.model.faces().count())))?;
        Ok(format!("<planecut.Live of {brushes} brushes and {faces} faces>"))
    }

    /// A model of the same brushes; what was edited before cannot be undone in it, and brushes are numbered from 0.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (Solid,))> {
        let solid = slf.get().to_solid(slf.py())?;
        Ok((slf.get_type().into_any(), (solid,)))
    }
}

fn face_number(id: FaceId) -> i64 {
    i64::from(u32::from(id))
}

fn role_name(role: Role) -> &'static str {
    match role {
        Role::Add => "add",
        Role::Subtract => "subtract",
        Role::Intersect => "intersect",
    }
}

fn role_of(name: &str) -> PyResult<Role> {
    match name {
        "add" => Ok(Role::Add),
        "subtract" => Ok(Role::Subtract),
        "intersect" => Ok(Role::Intersect),
        found => Err(refuse(format!("role: found {found:?}, expected \"add\", \"subtract\" or \"intersect\""))),
    }
}

/// The calls of one edit; see Live.edit.
#[pyclass(frozen, module = "planecut")]
pub(crate) struct Edit {
    live: Py<Live>,
}

impl Edit {
    fn apply(&self, py: Python<'_>, edit: CoreEdit) -> PyResult<(Option<BrushId>, Option<PlaneIdx>)> {
        self.live.get().with(py, |state| state.apply(edit))
    }
}

#[pymethods]
impl Edit {
    fn __enter__<'py>(slf: Bound<'py, Self>, py: Python<'py>) -> PyResult<Bound<'py, Self>> {
        slf.get().live.get().with(py, |state| {
            state.refuse_while_open("edit")?;
            state.open = Some((0, CoreChange::default()));
            Ok(())
        })?;
        Ok(slf)
    }

    fn __exit__(
        &self,
        py: Python<'_>,
        exception: &Bound<'_, PyAny>,
        _value: &Bound<'_, PyAny>,
        _traceback: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        let is_failed = !exception.is_none();
        self.live.get().with(py, |state| {
            let Some((count, change)) = state.open.take() else { return Ok(()) };
            state.model.join_edits(count);
            if !is_failed {
                state.change = change;
            } else if count > 0 {
                state.model.undo()?;
                state.model.forget_undone();
            }
            Ok(())
        })
    }

    /// Moves a plane of a brush along its normal, to an offset for the normal as it was given.
    fn move_plane(&self, py: Python<'_>, brush: u64, plane: usize, offset: f64) -> PyResult<()> {
        let (brush, plane) = (BrushId(brush), PlaneIdx(plane));
        self.apply(py, CoreEdit::MovePlane { brush, plane, offset }).map(|_| ())
    }

    /// Cuts a brush down to a half-space of shape (4,): outward normal and offset. Returns the number of the plane in the brush.
    #[pyo3(signature = (brush, plane, material=None))]
    fn add_plane(&self, py: Python<'_>, brush: u64, plane: &Bound<'_, PyAny>, material: Option<String>) -> PyResult<usize> {
        let half_space = HalfSpace::from_array(row::<4>(plane, "plane")?).map_err(Failure::of)?;
        let brush = BrushId(brush);
        let (_, plane) = self.live.get().with(py, |state| {
            let material = material.map(|name| state.material_named(name));
            state.apply(CoreEdit::AddPlane { brush, half_space, material })
        })?;
        plane.map(|plane| plane.0).ok_or_else(|| Failure::bug("found no number of a plane that was added").into())
    }

    /// Takes a plane out of a brush, which grows to what its other planes leave.
    fn remove_plane(&self, py: Python<'_>, brush: u64, plane: usize) -> PyResult<()> {
        self.apply(py, CoreEdit::RemovePlane { brush: BrushId(brush), plane: PlaneIdx(plane) }).map(|_| ())
    }

    /// Adds a brush after all others. Returns its number.
    ///
    /// Args:
    ///     solid: A Solid of one convex body or closed mesh.
    ///     role: "add", "subtract" or "intersect".
    #[pyo3(signature = (solid, role="add"))]
    fn add_brush(&self, py: Python<'_>, solid: &Bound<'_, Solid>, role: &str) -> PyResult<u64> {
        let (role, node) = (role_of(role)?, Arc::clone(solid.get().node()));
        let (brush, _) = self.live.get().with(py, |state| {
            let brush = state.brush_of(&node)?;
            state.apply(CoreEdit::AddBrush { brush, role })
        })?;
        brush.map(|brush| brush.0).ok_or_else(|| Failure::bug("found no number of a brush that was added").into())
    }

    /// Takes a brush out.
    fn remove_brush(&self, py: Python<'_>, brush: u64) -> PyResult<()> {
        self.apply(py, CoreEdit::RemoveBrush { brush: BrushId(brush) }).map(|_| ())
    }

    /// Puts a Solid of one convex body or closed mesh in the place of a brush; its planes get new numbers.
    fn replace_brush(&self, py: Python<'_>, brush: u64, solid: &Bound<'_, Solid>) -> PyResult<()> {
        let node = Arc::clone(solid.get().node());
        self.live.get().with(py, |state| {
            let by = state.brush_of(&node)?;
            state.apply(CoreEdit::ReplaceBrush { brush: BrushId(brush), by }).map(|_| ())
        })
    }

    /// Moves a brush by an affine map, a matrix of shape (3, 4) or (4, 4); its planes keep their numbers.
    fn transform_brush(&self, py: Python<'_>, brush: u64, matrix: &Bound<'_, PyAny>) -> PyResult<()> {
        let transform = transform_of(matrix)?;
        self.apply(py, CoreEdit::TransformBrush { brush: BrushId(brush), transform }).map(|_| ())
    }

    /// Gives a brush another role: "add", "subtract" or "intersect".
    fn set_role(&self, py: Python<'_>, brush: u64, role: &str) -> PyResult<()> {
        let role = role_of(role)?;
        self.apply(py, CoreEdit::SetRole { brush: BrushId(brush), role }).map(|_| ())
    }
}

/// What an edit has changed.
#[pyclass(frozen, module = "planecut")]
pub(crate) struct Change {
    change: CoreChange,
}

#[pymethods]
impl Change {
    /// The numbers of the faces that are no more.
    #[getter]
    fn removed(&self) -> Vec<i64> {
        self.change.removed.iter().map(|id| face_number(*id)).collect()
    }

    /// The numbers of the faces that are new; they may be those of faces that were removed.
    #[getter]
    fn added(&self) -> Vec<i64> {
        self.change.added.iter().map(|id| face_number(*id)).collect()
    }

    /// The numbers of the brushes that came, went or changed.
    #[getter]
    fn brushes(&self) -> Vec<u64> {
        self.change.brushes.iter().map(|id| id.0).collect()
    }

    #[allow(clippy::type_complexity)]
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (Vec<u64>, Vec<i64>, Vec<i64>))> {
        let change = slf.get();
        Ok((slf.get_type().getattr("_unpickle")?, (change.brushes(), change.removed(), change.added())))
    }

    /// A change that was pickled.
    #[staticmethod]
    fn _unpickle(brushes: Vec<u64>, removed: Vec<u32>, added: Vec<u32>) -> Self {
        let [removed, added] = [removed, added].map(|faces| faces.into_iter().map(FaceId::from).collect());
        Self { change: CoreChange { brushes: brushes.into_iter().map(BrushId).collect(), removed, added } }
    }

    fn __repr__(&self) -> String {
        format!("<planecut.Change: {} faces removed, {} added>", self.change.removed.len(), self.change.added.len())
    }
}

/// A face of a live model as it was when it was asked for: planar, connected and of one material.
#[pyclass(frozen, module = "planecut")]
#[derive(Serialize, Deserialize)]
pub(crate) struct Face {
    brush: Option<u64>,
    plane: Option<usize>,
    material: String,
    normal: [f64; 3],
    vertices: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

#[pymethods]
impl Face {
    /// The number of the brush that it lies on; of several the first that faces the same way. None while a brush of the model is a closed mesh.
    #[getter]
    fn brush(&self) -> Option<u64> {
        self.brush
    }

    /// The number of the plane in the brush, or None.
    #[getter]
    fn plane(&self) -> Option<usize> {
        self.plane
    }

    /// The name of what it is made of.
    #[getter]
    fn material(&self) -> &str {
        &self.material
    }

    /// The unit outward normal, shape (3,).
    #[getter]
    fn normal<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        small(py, &self.normal)
    }

    /// The corners, shape (n, 3).
    #[getter]
    fn vertices<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray2<f64>> {
        view_points(slf.as_any(), &slf.get().vertices)
    }

    /// Numbers of corners, shape (m, 3), counter-clockwise seen from outside.
    #[getter]
    fn triangles<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray2<u32>> {
        view_rows(slf.as_any(), &slf.get().triangles)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyBytes>,))> {
        let bytes = rmp_serde::to_vec(slf.get()).map_err(Failure::of)?;
        Ok((slf.get_type().getattr("_unpickle")?, (PyBytes::new(slf.py(), &bytes),)))
    }

    /// A face that was pickled.
    #[staticmethod]
    fn _unpickle(data: &[u8]) -> PyResult<Self> {
        rmp_serde::from_slice(data).map_err(|error| refuse(format!("found what is no pickled face: {error}")))
    }

    fn __repr__(&self) -> String {
        let of = match (self.brush, self.plane) {
            (Some(brush), Some(plane)) => format!("plane {plane} of brush {brush}"),
            _ => format!("{} triangles", self.triangles.len()),
        };
        format!("<planecut.Face: {of}>")
    }
}
