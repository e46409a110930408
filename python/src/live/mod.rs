//! The live model: edits that cost what they touch.
//!
//! - [`edit`] has the calls of an edit, and [`preview`] the same ones as questions about what they would change; [`calls`] makes the edits of both.
//! - [`tree`] shows the operations of a model, and names them.
//! - [`face`] is what users see of the boundary, [`buffers`] what renderers take of it.

mod buffers;
mod calls;
mod edit;
mod face;
mod preview;
mod tree;

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

use glam::DVec3;
use numpy::{PyArray1, PyArray2};
use planecut::csg::{
    BrushId, Change as CoreChange, Edited, FaceId, LiveModel, Snap, SnapOptions, SnapTarget, SolidMeasures,
};
use planecut::expression;
use planecut::kernel::PlaneIdx;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};

use crate::arrays::{small, small_rows, vector};
use crate::errors::{Failure, Outcome, refuse};
use crate::job::{Job, on_threads_of_process};
use crate::mesh::Mesh;
use crate::solid::Solid;
pub(crate) use buffers::Buffers;
use buffers::center_of;
use calls::Call;
pub(crate) use edit::Edit;
use face::face_number;
pub(crate) use face::{Change, Face};
pub(crate) use preview::{Preview, Previewer};
pub(crate) use tree::Node;

/// A model that is edited: each edit costs what it touches, and says which faces it changed.
///
/// Its brushes are the convex bodies (and closed meshes) of a solid, numbered from 0 in their order; faces have numbers, too, which may be used again once a face is gone.
///
/// Args:
///     solid: A Solid to begin with. What combines its bodies one after another gives them roles; bodies within nested operations stay operands of these (see `tree`).
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
    /// What the edit that is open has changed.
    open: Option<CoreChange>,
}

/// What a plane snaps to: a half-space of shape (4,), what is there, and how far away it is.
type Snapped<'py> = (Bound<'py, PyArray1<f64>>, &'static str, f64);

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

impl Live {
    fn measures(&self, py: Python<'_>) -> PyResult<SolidMeasures> {
        self.with(py, |state| Ok(state.model.measures()))
    }
}

impl State {
    fn refuse_while_open(&self, name: &str) -> Outcome<()> {
        match self.open {
            Some(_) => Err(Failure::of(format!("{name}: found an edit that is not complete, expected none"))),
            None => Ok(()),
        }
    }

    /// Does a call of the edit that is open, which collects what has changed.
    fn apply(&mut self, call: Call) -> Outcome<Edited> {
        let Some(change) = &mut self.open else {
            return Err(Failure::of("found an edit that is over, expected calls within `with live.edit() as e`"));
        };
        let (edit, materials) = call.edit_of(self.model.materials())?;
        let mut edited = self.model.apply_with(edit, materials)?;
        *change = std::mem::take(change).then(std::mem::take(&mut edited.change));
        Ok(edited)
    }

    /// The sums of values of materials, as these are listed, by their names: those that are more than 0.
    fn by_material(&self, values: Vec<f64>) -> BTreeMap<String, f64> {
        let mut sums = BTreeMap::new();
        for (material, value) in self.model.materials().iter().zip(values).filter(|(_, value)| *value > 0.0) {
            *sums.entry(material.name.clone()).or_default() += value;
        }
        sums
    }
}

#[pymethods]
impl Live {
    #[new]
    #[pyo3(signature = (solid, *, threads=None, progress=None))]
    fn new(
        py: Python<'_>,
        solid: &Bound<'_, Solid>,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Self> {
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
        self.with(py, |state| Ok(state.model.brush(BrushId(brush))?.1.name()))
    }

    /// The planes of a brush.
    ///
    /// Returns:
    ///     A dict from the number of each plane, by which edits name it, to its four numbers (nx, ny, nz, d).
    fn planes<'py>(&self, py: Python<'py>, brush: u64) -> PyResult<Bound<'py, PyDict>> {
        let planes = self.with(py, |state| {
            let (body, handles) = (state.model.brush(BrushId(brush))?.0, state.model.planes(BrushId(brush))?);
            Ok(handles
                .iter()
                .map(|plane| plane.0)
                .zip(body.faces.iter().map(|face| face.half_space.to_array()))
                .collect::<Vec<_>>())
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
            let (vertices, triangles) = face.indexed();
            let source = state.model.source_of_face(number);
            let material = state.model.materials()[face.material().0 as usize].name.clone();
            let normal = face.normal().to_array();
            Ok(Face {
                brush: source.map(|(brush, _)| brush.0),
                plane: source.map(|(_, plane)| plane.0),
                material,
                normal,
                vertices,
                triangles,
            })
        })
    }

    /// The first face that a ray meets, and the distance; None where it meets none.
    ///
    /// Args:
    ///     origin: Shape (3,).
    ///     direction: Shape (3,), of any length but 0.
    fn pick(
        &self,
        py: Python<'_>,
        origin: &Bound<'_, PyAny>,
        direction: &Bound<'_, PyAny>,
    ) -> PyResult<Option<(i64, f64)>> {
        let (origin, direction) = (vector(origin, "origin")?, vector(direction, "direction")?);
        if direction == DVec3::ZERO {
            return Err(refuse("direction: found the zero vector, expected another"));
        }
        let direction = direction / direction.abs().max_element();
        self.with(py, |state| Ok(state.model.pick(origin, direction).map(|(id, distance)| (face_number(id), distance))))
    }

    /// What a plane of a brush that is about to move snaps to: the half-space for Edit.turn_plane, what is there ("plane", "vertex" or
    /// "grid") and how far away it is; None where nothing is near enough.
    ///
    /// Args:
    ///     brush: The brush.
    ///     plane: The plane, by its number in the brush.
    ///     to: Where it is about to go, shape (4,): outward normal and offset.
    ///     grid: The step of a grid. It has an effect where nothing else is near.
    ///     planes: Maximum distance from parallel planes of faces of other brushes.
    ///     vertices: Maximum distance from corners of the solid.
    #[pyo3(signature = (brush, plane, to, *, grid=None, planes=None, vertices=None))]
    #[expect(clippy::too_many_arguments, reason = "named arguments in Python")]
    fn snap<'py>(
        &self,
        py: Python<'py>,
        brush: u64,
        plane: usize,
        to: &Bound<'_, PyAny>,
        grid: Option<f64>,
        planes: Option<f64>,
        vertices: Option<f64>,
    ) -> PyResult<Option<Snapped<'py>>> {
        let to = calls::half_space_of(to, "to")?;
        let options = SnapOptions { grid, planes, vertices };
        let snap =
            self.with(py, |state| Ok(state.model.snap_plane(BrushId(brush), PlaneIdx(plane), &to, &options)?))?;
        Ok(snap.map(|Snap { half_space, to, distance }| {
            let target = match to {
                SnapTarget::Plane { .. } => "plane",
                SnapTarget::Vertex(_) => "vertex",
                SnapTarget::Grid => "grid",
            };
            (small(py, &half_space.to_array()), target, distance)
        }))
    }

    /// The mesh of the solid, the same as that of a new model.
    fn mesh(&self, py: Python<'_>) -> PyResult<Mesh> {
        Ok(Mesh::of_core(self.with(py, |state| Ok(state.model.mesh()?))?))
    }

    /// Faces as a renderer takes them, in one call: after an edit, those of `live.change.added`.
    ///
    /// Args:
    ///     faces: Their numbers.
    ///     center: What positions are relative to, shape (3,); by default the origin. Near the model, single precision loses least.
    #[pyo3(signature = (faces, center=None))]
    fn buffers(&self, py: Python<'_>, faces: Vec<i64>, center: Option<&Bound<'_, PyAny>>) -> PyResult<Buffers> {
        let center = center_of(center)?;
        self.with(py, |state| {
            let known = |id: &i64| {
                let number = u32::try_from(*id).ok().map(FaceId::from).filter(|id| state.model.face(*id).is_some());
                number
                    .ok_or_else(|| Failure::of(format!("faces: found {id}, expected numbers of faces that are there")))
            };
            let faces = faces.iter().map(known).collect::<Outcome<Vec<FaceId>>>()?;
            let materials = state.model.materials();
            Ok(Buffers::of(state.model.buffers(&faces, center), |material| materials[material].name.clone()))
        })
    }

    /// The volume. Like all measures it is kept up with each edit: only faces that changed since the last question are looked at, and the number is, bit for bit, that of a new model.
    #[getter]
    fn volume(&self, py: Python<'_>) -> PyResult<f64> {
        Ok(self.measures(py)?.volume)
    }

    /// The area of the boundary.
    #[getter]
    fn area(&self, py: Python<'_>) -> PyResult<f64> {
        Ok(self.measures(py)?.area)
    }

    /// The center of mass of a solid of the same density everywhere, shape (3,); NaN where the solid is empty.
    #[getter]
    fn centroid<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let SolidMeasures { area, centroid, .. } = self.measures(py)?;
        Ok(small(py, &if area > 0.0 { centroid } else { DVec3::NAN }.to_array()))
    }

    /// The least and the greatest coordinates, shape (2, 3); NaN where the solid is empty.
    #[getter]
    fn bounds<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let SolidMeasures { area, min, max, .. } = self.measures(py)?;
        let bounds = if area > 0.0 { [min, max] } else { [DVec3::NAN; 2] };
        small_rows(py, &bounds.map(|corner| corner.to_array()))
    }

    /// The area of the boundary by material: a dict from names to areas, of the materials that the boundary has.
    #[getter]
    fn areas<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let areas = self.with(py, |state| {
            let areas = state.model.areas_of_materials();
            Ok(state.by_material(areas))
        })?;
        areas.into_py_dict(py)
    }

    /// The volume of what is made of each material: a dict from names to volumes, of the materials of which there is something; times its density a mass.
    ///
    /// A brush is made of the material of most of its faces. Where brushes overlap, what was added last is there; what others are taken from, or intersected with, stays what it is made of. Together they
    /// are the volume of the solid. Where brushes are of several materials, this takes an evaluation for each.
    #[getter]
    fn volumes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let volumes = self.with(py, |state| {
            let volumes = state.model.volumes_of_materials()?;
            Ok(state.by_material(volumes))
        })?;
        volumes.into_py_dict(py)
    }

    /// The model as it is now, as a Solid.
    fn to_solid(&self, py: Python<'_>) -> PyResult<Solid> {
        Ok(Solid::of(expression::Node::of_model(self.with(py, |state| Ok(state.model.to_model()))?)))
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
