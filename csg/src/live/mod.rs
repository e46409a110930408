//! A model that takes edits, each for what it touches.
//!
//! Kept are the body of each brush, for each of its faces the boundary edges on it, and all that the weld makes of them. An
//! edit of a brush changes the boundary only within the old and the new extent of the brush: the faces that reach into these
//! are worked out again among the bodies near them, and of their edges those that are new or gone are handed to the weld.

mod operand;
mod skin;

use planecut_kernel::IncrementalPolytope;
use thiserror::Error;

use crate::body::{Body, BodyFace, BrushBody, built_or_build, mark_of};
use crate::brush::{Brush, Material};
use crate::evaluate::{EvaluateError, check_materials, material_ranks};
use crate::mesh::Mesh;
use crate::plane_table::{PlaneId, PlaneTable};
use crate::skin::{BoundaryEdge, misses};
pub use crate::weld::{FaceId, LiveFace};
use crate::weld::{LiveWeld, weld};
pub use operand::Role;
use operand::{Operand, Places};

/// A brush of a [`LiveModel`]; never that of another brush, before or after.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct BrushId {
    order: u64,
    number: u32,
}

/// What an edit has changed: faces are planar, connected regions of one material.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Change {
    /// The faces that are no more.
    pub removed: Vec<FaceId>,
    /// Those that are new; their numbers may be those of faces that were removed.
    pub added: Vec<FaceId>,
}

/// Why an edit was refused; the model is as it was, but after [`EvaluateError::Weld`], a bug in this
/// crate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum EditError {
    /// There is no such brush, or no longer.
    #[error("found a brush that is not part of the model")]
    UnknownBrush,
    /// The planes of a brush do not bound a body.
    #[error("found a brush that reaches infinity, expected one that is bounded")]
    Unbounded,
    /// As for a model that is evaluated: a face names an unknown material, or the boundary does not close.
    #[error(transparent)]
    Evaluate(#[from] EvaluateError),
}

/// How far the change of a brush reaches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Reach {
    /// To what it or its old body touches.
    Near,
    /// To the boundary near it: it is the last one, and new.
    Appended,
    /// To everything, as what lies outside of an intersecting brush is taken away.
    Everywhere,
}

impl Reach {
    fn of_appended(is_intersecting: bool) -> Self {
        if is_intersecting { Self::Everywhere } else { Self::Appended }
    }

    fn of_change(is_intersecting: bool) -> Self {
        if is_intersecting { Self::Everywhere } else { Self::Near }
    }
}

/// Brushes in order, each with a [`Role`], and the boundary of the solid that they make.
///
/// The solid is what is left when one brush after another is added to it, taken from it or intersected with it.
///
/// ```
/// use planecut_csg::{Brush, LiveModel, Material, MaterialId, Role};
/// use planecut_kernel::DVec3;
///
/// # fn main() -> Result<(), planecut_csg::EditError> {
/// let cube = |min: f64, max: f64| Brush::cuboid(DVec3::splat(min), DVec3::splat(max), MaterialId(0));
/// let mut model = LiveModel::new(vec![Material::named("stone")]);
/// let (block, _) = model.add_brush(cube(0.0, 3.0), Role::Add)?;
/// let (hole, change) = model.add_brush(cube(1.0, 2.0), Role::Subtract)?;
/// assert_eq!((change.removed.len(), change.added.len()), (0, 6));
/// model.remove_brush(hole)?;
/// assert_eq!(model.triangle_count(), 12);
/// # Ok(())
/// # }
/// ```
#[derive(Default)]
pub struct LiveModel {
    materials: Vec<Material>,
    /// Orders materials by name.
    rank: Vec<u32>,
    table: PlaneTable,
    operands: Vec<Option<Operand>>,
    free: Vec<u32>,
    next_order: u64,
    places: Places,
    /// How many bodies have a face on each plane; 255 stands for more as well, and for ever.
    bodies_on_plane: Vec<u8>,
    /// The brushes that intersect, in order.
    intersecting: Vec<(u64, u32)>,
    welded: LiveWeld,
    buffers: Buffers,
}

#[derive(Default)]
struct Buffers {
    polytope: IncrementalPolytope,
    /// The faces to be worked out again: the number of the brush and of the face of its body.
    faces: Vec<(u32, u32)>,
    /// The place of each brush among those near.
    place: Vec<u32>,
}

impl LiveModel {
    /// A model without brushes, of faces of some materials.
    #[must_use]
    pub fn new(materials: Vec<Material>) -> Self {
        let rank = material_ranks(&materials);
        Self { materials, rank, ..Self::default() }
    }

    /// Adds a brush after all others.
    ///
    /// # Errors
    /// [`EditError::Unbounded`], [`EvaluateError::UnknownMaterial`].
    pub fn add_brush(&mut self, brush: Brush, role: Role) -> Result<(BrushId, Change), EditError> {
        let body = self.build(&brush)?;
        let (id, number) = self.append(brush, role);
        let change = self.change_bodies(vec![(number, body)], Reach::of_appended(role == Role::Intersect))?;
        Ok((id, change))
    }

    /// Adds brushes after all others, in their order, as one edit.
    ///
    /// # Errors
    /// [`EditError::Unbounded`], [`EvaluateError::UnknownMaterial`]; then none is added.
    pub fn add_brushes(&mut self, brushes: Vec<(Brush, Role)>) -> Result<(Vec<BrushId>, Change), EditError> {
        let bodies = brushes.iter().map(|(brush, _)| self.build(brush)).collect::<Result<Vec<_>, _>>()?;
        let is_intersecting = brushes.iter().any(|(_, role)| *role == Role::Intersect);
        let (ids, numbers): (Vec<BrushId>, Vec<u32>) =
            brushes.into_iter().map(|(brush, role)| self.append(brush, role)).unzip();
        let change =
            self.change_bodies(numbers.into_iter().zip(bodies).collect(), Reach::of_appended(is_intersecting))?;
        Ok((ids, change))
    }

    /// Takes a brush out.
    ///
    /// # Errors
    /// [`EditError::UnknownBrush`].
    pub fn remove_brush(&mut self, id: BrushId) -> Result<Change, EditError> {
        let role = self.operand(id)?.role;
        self.intersecting.retain(|entry| entry.0 != id.order);
        let change = self.change_bodies(vec![(id.number, None)], Reach::of_change(role == Role::Intersect))?;
        self.operands[id.number as usize] = None;
        self.free.push(id.number);
        Ok(change)
    }

    /// Puts another brush in the place of one.
    ///
    /// # Errors
    /// [`EditError::UnknownBrush`], [`EditError::Unbounded`], [`EvaluateError::UnknownMaterial`].
    pub fn replace_brush(&mut self, id: BrushId, brush: Brush) -> Result<Change, EditError> {
        let role = self.operand(id)?.role;
        let body = self.build(&brush)?;
        let change = self.change_bodies(vec![(id.number, body)], Reach::of_change(role == Role::Intersect))?;
        if let Some(operand) = &mut self.operands[id.number as usize] {
            operand.brush = brush;
        }
        Ok(change)
    }

    /// Gives a brush another role.
    ///
    /// # Errors
    /// [`EditError::UnknownBrush`].
    pub fn set_role(&mut self, id: BrushId, role: Role) -> Result<Change, EditError> {
        let operand = self.operand_mut(id)?;
        let (body, was) = (operand.body.clone(), std::mem::replace(&mut operand.role, role));
        self.intersecting.retain(|entry| entry.0 != id.order);
        if role == Role::Intersect {
            self.intersecting.push((id.order, id.number));
            self.intersecting.sort_unstable();
        }
        let is_intersecting = role == Role::Intersect || was == Role::Intersect;
        self.change_bodies(vec![(id.number, body)], Reach::of_change(is_intersecting))
    }

    /// A brush.
    ///
    /// # Errors
    /// [`EditError::UnknownBrush`].
    pub fn brush(&self, id: BrushId) -> Result<(&Brush, Role), EditError> {
        self.operand(id).map(|operand| (&operand.brush, operand.role))
    }

    /// How many triangles the faces have.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        self.welded.triangle_count()
    }

    /// A face, where there is one of this number.
    #[must_use]
    pub fn face(&self, id: FaceId) -> Option<LiveFace<'_>> {
        self.welded.face(id)
    }

    /// All faces.
    pub fn faces(&self) -> impl Iterator<Item = (FaceId, LiveFace<'_>)> {
        self.welded.faces()
    }

    /// Whether the faces are those of the mesh. They are not where solids alternate around a line or a point, so that
    /// faces cross there.
    #[must_use]
    pub fn has_faces(&self) -> bool {
        !self.welded.has_crossings()
    }

    /// The mesh of the solid, equal to that of the same model built anew.
    ///
    /// # Errors
    /// [`EvaluateError::Weld`]: a bug in this crate.
    pub fn mesh(&self) -> Result<Mesh, EvaluateError> {
        let operands = self.operands.iter().flatten();
        let edges: Vec<BoundaryEdge> =
            operands.flat_map(|operand| &operand.edges).flatten().map(|edge| edge.0).collect();
        Ok(weld(&self.table, &edges, &self.rank, &self.materials)?.mesh)
    }

    fn operand(&self, id: BrushId) -> Result<&Operand, EditError> {
        let operand = self.operands.get(id.number as usize).and_then(Option::as_ref);
        operand.filter(|operand| operand.order == id.order).ok_or(EditError::UnknownBrush)
    }

    fn operand_mut(&mut self, id: BrushId) -> Result<&mut Operand, EditError> {
        let operand = self.operands.get_mut(id.number as usize).and_then(Option::as_mut);
        operand.filter(|operand| operand.order == id.order).ok_or(EditError::UnknownBrush)
    }

    fn build(&mut self, brush: &Brush) -> Result<Option<Body>, EditError> {
        check_materials(brush.faces.iter().map(|face| face.material), self.materials.len())?;
        let planes: Vec<PlaneId> = brush.faces.iter().map(|face| self.table.insert(&face.half_space)).collect();
        match built_or_build(&self.table, brush, &planes, &mut self.buffers.polytope) {
            BrushBody::Bounded(body, _) => Ok(Some(body)),
            BrushBody::Empty => Ok(None),
            BrushBody::Unbounded => Err(EditError::Unbounded),
        }
    }

    /// Makes a brush the last one, as yet without a body.
    fn append(&mut self, brush: Brush, role: Role) -> (BrushId, u32) {
        let order = self.next_order;
        self.next_order += 1;
        let operand = Some(Operand { brush, role, order, body: None, mark: 0, edges: Vec::new() });
        let number = self.free.pop().unwrap_or(self.operands.len() as u32);
        match self.operands.get_mut(number as usize) {
            Some(place) => *place = operand,
            None => self.operands.push(operand),
        }
        if role == Role::Intersect {
            self.intersecting.push((order, number));
        }
        (BrushId { order, number }, number)
    }

    /// Gives brushes other bodies, or none, and works out what that changes.
    fn change_bodies(&mut self, new: Vec<(u32, Option<Body>)>, reach: Reach) -> Result<Change, EditError> {
        self.buffers.faces.clear();
        for (number, _) in &new {
            let operand = self.operands[*number as usize].as_mut().expect("the brush is there");
            for (_, edge) in operand.edges.drain(..).flatten() {
                self.welded.remove(edge);
            }
            let Some(old) = operand.body.take() else { continue };
            self.places.remove(&old.bounds, *number);
            for face in &old.faces {
                let count = &mut self.bodies_on_plane[face.plane.index() as usize];
                *count -= u8::from(*count < u8::MAX);
            }
            self.touch(&old, false);
        }
        new.iter().filter_map(|(_, body)| body.as_ref()).for_each(|body| self.touch(body, reach == Reach::Appended));
        self.bodies_on_plane.resize(self.table.len(), 0);
        for (number, body) in new {
            let Some(body) = body else { continue };
            self.places.insert(&body.bounds, number);
            for face in &body.faces {
                let count = &mut self.bodies_on_plane[face.plane.index() as usize];
                *count = count.saturating_add(1);
            }
            self.buffers.faces.extend((0..body.faces.len() as u32).map(|face| (number, face)));
            let operand = self.operands[number as usize].as_mut().expect("the brush is there");
            operand.edges.resize_with(body.faces.len(), Vec::new);
            operand.mark = mark_of(&body.faces);
            operand.body = Some(body);
        }
        if reach == Reach::Everywhere {
            self.touch_all();
        }
        let mut faces = std::mem::take(&mut self.buffers.faces);
        faces.sort_unstable();
        faces.dedup();
        self.skin(&faces);
        self.buffers.faces = faces;
        self.welded.update(&self.table).map_err(EvaluateError::from)?;
        let (removed, added) = self.welded.changes();
        Ok(Change { removed: removed.to_vec(), added: added.to_vec() })
    }

    /// Notes the faces of other bodies that may reach into a body. A body that comes last and does not intersect can only take away
    /// from the boundary on them, but where it has a face on their plane.
    fn touch(&mut self, by: &Body, is_last: bool) {
        let bounds = &by.bounds;
        for other in self.places.near(bounds) {
            let Some(Operand { body: Some(body), edges, .. }) = &self.operands[other as usize] else { continue };
            let reaches = |(number, face): &(u32, &BodyFace)| {
                let half_space = self.table.half_space(face.plane);
                let may_matter = || !is_last || !edges[*number as usize].is_empty() || by.face_on(face.plane).is_some();
                face.bounds.may_share_area(bounds)
                    && may_matter()
                    && !misses(bounds, half_space.normal(), half_space.offset())
                    && !by.is_surely_apart_from(&self.table, body.corners(face))
            };
            self.buffers.faces.extend((0..).zip(&body.faces).filter(reaches).map(|(face, _)| (other, face)));
        }
    }

    /// Notes all faces.
    fn touch_all(&mut self) {
        for number in 0..self.operands.len() as u32 {
            let faces = body_of(&self.operands, number).map_or(0, |body| body.faces.len()) as u32;
            self.buffers.faces.extend((0..faces).map(|face| (number, face)));
        }
    }
}

fn body_of(operands: &[Option<Operand>], number: u32) -> Option<&Body> {
    operands[number as usize].as_ref()?.body.as_ref()
}
