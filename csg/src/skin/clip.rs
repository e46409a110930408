//! What a body covers of a polygon on a face of another.

use super::Scene;
use super::facets::{Facets, Place};
use super::section::{Clip, Polygon};
use crate::body::BodyFace;
use crate::plane_table::PlaneId;

/// Clips polygons by bodies, reusing its buffers.
#[derive(Debug, Default)]
pub(super) struct Clipper {
    near: Vec<PlaneId>,
    whole: Polygon,
    spare: Polygon,
}

impl Clipper {
    /// Keeps what a body covers of a polygon within a face.
    pub(super) fn clip(&mut self, scene: &Scene<'_>, face: &BodyFace, body: usize, polygon: &mut Polygon) -> Clip {
        match &scene.facets[body] {
            Some(facets) => self.clip_by_near(scene, face, body, facets, polygon),
            None => self.clip_by_all(scene, face, body, polygon),
        }
    }

    /// By the planes of all faces.
    fn clip_by_all(&mut self, scene: &Scene<'_>, face: &BodyFace, body: usize, polygon: &mut Polygon) -> Clip {
        let mut whole = true;
        let cuts = scene.bodies[body].faces.iter().map(|face| face.plane);
        for cut in cuts.filter(|cut| cut.index() != face.plane.index()) {
            let half_space = scene.table.half_space(cut);
            let (_, high) = face.bounds.extent_along(half_space.normal(), half_space.offset());
            if high < 0.0 {
                continue;
            }
            match polygon.clip(scene.table, face.plane, cut, &mut self.spare) {
                Clip::Nothing => return Clip::Nothing,
                Clip::Part => whole = false,
                Clip::Whole => {}
            }
        }
        if whole { Clip::Whole } else { Clip::Part }
    }

    /// By the planes of the faces that meet the polygon.
    fn clip_by_near(
        &mut self,
        scene: &Scene<'_>,
        face: &BodyFace,
        body: usize,
        facets: &Facets,
        polygon: &mut Polygon,
    ) -> Clip {
        let (table, other) = (scene.table, &scene.bodies[body]);
        facets.near(table, other, face, &polygon.bounds(), &mut self.near);
        self.whole.copy_from(&polygon.edges, &polygon.corners);
        let mut whole = true;
        for cut in &self.near {
            match polygon.clip(table, face.plane, *cut, &mut self.spare) {
                Clip::Nothing => return Clip::Nothing,
                Clip::Part => whole = false,
                Clip::Whole => {}
            }
        }
        match facets.place(table, other, face, &self.near, polygon) {
            Place::Inside if whole => Clip::Whole,
            Place::Inside => Clip::Part,
            Place::Outside => Clip::Nothing,
            Place::Unknown => {
                std::mem::swap(polygon, &mut self.whole);
                self.clip_by_all(scene, face, body, polygon)
            }
        }
    }
}
