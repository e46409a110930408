//! The brushes that a solid was made of: which of them a place on its boundary belongs to.

use std::sync::Arc;

use planecut_csg::{PlaneId, PlaneTable};
use planecut_kernel::DVec3;

use super::cell::CellPlane;
use crate::tolerances::SOURCE_DISTANCE;

/// The faces of the bodies of all brushes, those of one brush after another.
#[derive(Debug, Clone, Default)]
pub(super) struct Sources {
    /// How many numbers of brushes are taken.
    pub(super) brushes: u32,
    faces: Arc<Vec<CellPlane>>,
}

impl Sources {
    pub(super) fn new(brushes: u32, faces: Vec<CellPlane>) -> Self {
        Self { brushes, faces: Arc::new(faces) }
    }

    /// Adds the brushes of another solid behind these, their planes renumbered.
    pub(super) fn append(&mut self, other: &Self, id: impl Fn(PlaneId) -> PlaneId) {
        if !other.faces.is_empty() {
            let moved = other.faces.iter().map(|face| face.moved(&id, self.brushes));
            Arc::make_mut(&mut self.faces).extend(moved);
        }
        self.brushes += other.brushes;
    }

    /// The same brushes, their planes renumbered.
    pub(super) fn renumbered(&self, id: impl Fn(PlaneId) -> PlaneId) -> Self {
        Self::new(self.brushes, self.faces.iter().map(|face| face.moved(&id, 0)).collect())
    }

    /// The face of a brush on which a point of the boundary lies; of several one that faces the same way, the first. Where
    /// there is none, as on a plane with which the user cut the solid, what the cell says.
    pub(super) fn locate(&self, table: &PlaneTable, face: CellPlane, point: DVec3) -> CellPlane {
        let on_plane = self.faces.iter().enumerate().filter(|(_, other)| other.plane.index() == face.plane.index());
        let nearby = on_plane.filter(|(place, other)| self.holds(table, *place, other, point));
        let found = nearby.map(|(_, other)| other).min_by_key(|other| (other.plane != face.plane, other.brush_face));
        match found {
            Some(other) if face.brush_face.is_some() => CellPlane { plane: face.plane, ..*other },
            _ => face,
        }
    }

    /// Whether a point on the plane of the face at `place` lies within the other faces of the brush, up to rounding.
    fn holds(&self, table: &PlaneTable, place: usize, face: &CellPlane, point: DVec3) -> bool {
        let brush = |face: &CellPlane| face.brush_face.map(|(brush, _)| brush);
        let is_kin = |other: &&CellPlane| brush(other) == brush(face);
        let before = self.faces[..place].iter().rev().take_while(is_kin);
        let mut others = before.chain(self.faces[place + 1..].iter().take_while(is_kin));
        let tolerance = SOURCE_DISTANCE * (1.0 + point.abs().max_element());
        others.all(|other| table.half_space(other.plane).signed_distance(point) <= tolerance)
    }
}
