//! What other bodies cover of a face, and what they leave of it.

use planecut_kernel::sign::Sign;

use super::{FaceWorker, MANY_SECTIONS, Reaching, cutter};
use crate::base::Bounds;
use crate::body::{BodyFace, PlaneFilter};
use crate::boundary::Scene;
use crate::boundary::section::{Clip, Polygon};
use crate::boundary::signs::Signs;
use crate::ids::holds;
use crate::plane_table::{PlaneId, PlaneTable};

/// A part of the face that another body covers.
#[derive(Debug, Clone)]
pub(in crate::boundary) struct Section {
    pub(in crate::boundary) polygon: Polygon,
    pub(in crate::boundary) bounds: Bounds,
    pub(in crate::boundary) of: Reaching,
}

impl Section {
    /// Whether another surely lies within this one, and strictly but for edges of the region, which both lie in.
    fn surely_holds(&self, table: &PlaneTable, region: &Polygon, other: &Self) -> bool {
        self.bounds.holds(&other.bounds)
            && self.polygon.edges.iter().all(|edge| {
                holds(&region.edges, *edge) || {
                    let filter = PlaneFilter::new(table.half_space(*edge));
                    other.polygon.corners.iter().all(|corner| filter.side(corner) == Sign::Negative)
                }
            })
    }
}

impl FaceWorker {
    /// Finds what covering bodies leave of the region; false where that is nothing.
    pub(super) fn cover_region(&mut self, scene: &Scene<'_>, face: &BodyFace) -> bool {
        self.live = 0;
        for k in 0..self.covering.len() {
            let cutter = cutter(scene, &self.signs, face, &self.covering[k]);
            if self.clipper.surely_holds(cutter, &self.region) {
                return false;
            }
        }
        for k in 0..self.covering.len() {
            match self.cover(scene, face, self.covering[k]) {
                Clip::Whole => return false,
                Clip::Part if self.take_section(scene, face) => {}
                Clip::Part => return false,
                Clip::Nothing => {}
            }
        }
        self.drop_held_sections(scene.table);
        true
    }

    /// Takes the section that was cut last; false where covering bodies leave nothing of the region.
    ///
    /// Where a section has one edge within the region, what it leaves is convex, and the region becomes that.
    fn take_section(&mut self, scene: &Scene<'_>, face: &BodyFace) -> bool {
        let mut k = self.live;
        self.live += 1;
        while k < self.live {
            let mut within = self.edges_within_region(k);
            match (within.next(), within.next()) {
                (None, _) => return false,
                (Some(edge), None) => {
                    drop(within);
                    self.leave_out_section(k);
                    self.cut_region(scene, face, edge.flipped());
                    // of others there may be one edge left now
                    k = 0;
                }
                (Some(_), Some(_)) => k += 1,
            }
        }
        true
    }

    /// The edges of a section that are none of the region.
    fn edges_within_region(&self, section: usize) -> impl Iterator<Item = PlaneId> {
        let edges = self.sections[section].polygon.edges.iter().copied();
        edges.filter(|edge| !holds(&self.region.edges, *edge))
    }

    /// Cuts the region, and the sections with it.
    fn cut_region(&mut self, scene: &Scene<'_>, face: &BodyFace, cut: PlaneId) {
        self.region.clip(Signs::new(scene.table, &self.signs), face.plane, cut, &mut self.part);
        self.clipper.look_at(&self.region);
        for k in (0..self.live).rev() {
            let (section, signs) = (&mut self.sections[k], Signs::new(scene.table, &self.signs));
            match section.polygon.clip(signs, face.plane, cut, &mut self.part) {
                Clip::Whole => section.polygon.name_edge_by(signs, face.plane, cut),
                Clip::Part => section.bounds = section.polygon.bounds(),
                Clip::Nothing => self.leave_out_section(k),
            }
        }
    }

    /// Leaves out a section; the others stay in order.
    fn leave_out_section(&mut self, section: usize) {
        self.sections[section..self.live].rotate_left(1);
        self.live -= 1;
    }

    /// Leaves out what covering bodies cover within what another covers: none of its edges is one of the boundary.
    fn drop_held_sections(&mut self, table: &PlaneTable) {
        if self.live > MANY_SECTIONS {
            return;
        }
        let mut k = 0;
        while k < self.live {
            let (section, others) = (&self.sections[k], (0..self.live).filter(|other| *other != k));
            if others.map(|other| &self.sections[other]).any(|other| other.surely_holds(table, &self.region, section)) {
                self.leave_out_section(k);
            } else {
                k += 1;
            }
        }
    }

    /// Clips the region by a body into the next free section.
    pub(super) fn cover(&mut self, scene: &Scene<'_>, face: &BodyFace, of: Reaching) -> Clip {
        if self.sections.len() == self.live {
            self.sections.push(Section { polygon: Polygon::default(), bounds: Bounds::EMPTY, of });
        }
        let cutter = cutter(scene, &self.signs, face, &of);
        let section = &mut self.sections[self.live];
        section.of = of;
        let clip = self.clipper.clip(cutter, &self.region, &mut section.polygon);
        if clip == Clip::Part {
            section.bounds = section.polygon.bounds();
        }
        clip
    }
}
