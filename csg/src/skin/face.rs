//! One face of one body: what other bodies swallow of it, and where the rest ends.

use planecut_kernel::DVec3;

use super::BoundaryEdge;
use super::section::{Clip, Cover, Line, Piece, Polygon};
use crate::body::{Body, BodyFace};
use crate::bounds::Bounds;
use crate::plane_table::{PlaneId, PlaneTable};

/// A part of the face that another body swallows.
#[derive(Debug, Clone, Default)]
struct Swallowed {
    polygon: Polygon,
    bounds: Option<Bounds>,
}

/// How another body stands to the plane of a face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Contact {
    /// It has a face on the same plane, facing the same way, with this place in the order of owners.
    SameWay((u32, usize)),
    /// It has a face on the same plane, facing the other way, or none at all.
    Other,
}

/// Emits the boundary edges of faces, reusing its buffers.
pub(super) struct FaceWorker<'a> {
    table: &'a PlaneTable,
    bodies: &'a [Body],
    rank: &'a [u32],
    swallowed: Vec<Swallowed>,
    live: usize,
    spare: Polygon,
    pieces: Vec<Piece>,
}

impl<'a> FaceWorker<'a> {
    pub(super) fn new(table: &'a PlaneTable, bodies: &'a [Body], rank: &'a [u32]) -> Self {
        Self { table, bodies, rank, swallowed: Vec::new(), live: 0, spare: Polygon::default(), pieces: Vec::new() }
    }

    /// Emits the boundary of what is left of face `face` of body `body`; `near` are the bodies whose boxes touch it.
    pub(super) fn emit(&mut self, body: usize, face: usize, near: &[u32], out: &mut Vec<BoundaryEdge>) {
        let this = &self.bodies[body].faces[face];
        if self.collect_swallowed(body, this, near) {
            return;
        }
        self.emit_own_edges(this, out);
        self.emit_section_edges(this, out);
    }

    /// Collects what the bodies near swallow; true where that is the whole face.
    fn collect_swallowed(&mut self, body: usize, face: &BodyFace, near: &[u32]) -> bool {
        self.live = 0;
        let half_space = self.table.half_space(face.plane);
        let (normal, offset) = (half_space.normal(), half_space.offset());
        let own = (self.rank[face.material.0 as usize], body);
        for &other in near {
            let other = other as usize;
            let candidate = &self.bodies[other];
            if !candidate.bounds.touches(&face.bounds) || misses(&candidate.bounds, normal, offset) {
                continue;
            }
            if let Contact::SameWay(owner) = self.contact(face.plane, other)
                && owner > own
            {
                continue;
            }
            match self.section(face, candidate) {
                Clip::Whole => return true,
                Clip::Part => self.live += 1,
                Clip::Nothing => {}
            }
        }
        false
    }

    fn contact(&self, plane: PlaneId, other: usize) -> Contact {
        let same = self.bodies[other].faces.iter().find(|face| face.plane == plane);
        same.map_or(Contact::Other, |face| Contact::SameWay((self.rank[face.material.0 as usize], other)))
    }

    /// Clips the face by a body into the next free buffer.
    fn section(&mut self, face: &BodyFace, body: &Body) -> Clip {
        if self.swallowed.len() == self.live {
            self.swallowed.push(Swallowed::default());
        }
        let section = &mut self.swallowed[self.live];
        section.polygon.copy_from(&face.edges, &face.corners);
        section.bounds = None;
        let mut whole = true;
        for cut in body.faces.iter().map(|face| face.plane).filter(|cut| cut.index() != face.plane.index()) {
            match section.polygon.clip(self.table, face.plane, cut, &mut self.spare) {
                Clip::Nothing => return Clip::Nothing,
                Clip::Part => whole = false,
                Clip::Whole => {}
            }
        }
        if whole { Clip::Whole } else { Clip::Part }
    }

    /// The pieces of the face's own edges along which nothing is swallowed.
    fn emit_own_edges(&mut self, face: &BodyFace, out: &mut Vec<BoundaryEdge>) {
        for (i, &edge) in face.edges.iter().enumerate() {
            let line = Line { plane: face.plane, edge };
            self.pieces.clear();
            self.pieces.push(Piece::of_edge(&face.edges, &face.corners, i));
            for section in &self.swallowed[..self.live] {
                if let Some(k) = section.polygon.edges.iter().position(|other| *other == edge) {
                    line.subtract(
                        self.table,
                        &mut self.pieces,
                        &Piece::of_edge(&section.polygon.edges, &section.polygon.corners, k),
                    );
                }
            }
            out.extend(self.pieces.iter().map(|piece| BoundaryEdge {
                face: face.plane,
                edge,
                start: piece.start,
                end: piece.end,
                material: face.material,
            }));
        }
    }

    /// The pieces of section edges outside of which nothing is swallowed: there the kept region ends, too.
    fn emit_section_edges(&mut self, face: &BodyFace, out: &mut Vec<BoundaryEdge>) {
        if self.live > 1 {
            for section in &mut self.swallowed[..self.live] {
                section.bounds = Some(section.polygon.bounds());
            }
        }
        for k in 0..self.live {
            let section = &self.swallowed[k];
            for (i, &edge) in section.polygon.edges.iter().enumerate() {
                if face.edges.contains(&edge) {
                    continue;
                }
                let line = Line { plane: face.plane, edge };
                self.pieces.clear();
                self.pieces.push(Piece::of_edge(&section.polygon.edges, &section.polygon.corners, i));
                subtract_others(self.table, line, &self.swallowed[..self.live], k, &mut self.pieces);
                out.extend(self.pieces.iter().map(|piece| BoundaryEdge {
                    face: face.plane,
                    edge: edge.flipped(),
                    start: piece.end,
                    end: piece.start,
                    material: face.material,
                }));
            }
        }
    }
}

/// Takes out of `pieces`, which lie on an edge of section `own`, what other sections cover on the outer side.
///
/// Along a shared edge line a section on the outer side covers; of two on the same side the first keeps the edge.
fn subtract_others(table: &PlaneTable, line: Line, sections: &[Swallowed], own: usize, pieces: &mut Vec<Piece>) {
    let Some(whole) = pieces.first().copied() else { return };
    let bounds = whole.bounds();
    for (k, other) in sections.iter().enumerate() {
        if k == own || pieces.is_empty() || other.bounds.is_some_and(|b| !b.touches(&bounds)) {
            continue;
        }
        match line.cover(table, &whole, &other.polygon) {
            Cover::Apart => {}
            Cover::Across(part) => line.subtract(table, pieces, &part),
            Cover::Along(part, edge) => {
                if !same_side(table, line, edge) || k < own {
                    line.subtract(table, pieces, &part);
                }
            }
        }
    }
}

/// Whether two polygons on `line.plane` lie on the same side of the line that `line.edge` and `edge` both bound.
///
/// Both normals are perpendicular to the line, so the directions agree where the lines `n_plane × n_edge` do.
fn same_side(table: &PlaneTable, line: Line, edge: PlaneId) -> bool {
    if edge.index() == line.edge.index() {
        return edge == line.edge;
    }
    let along = |axis: usize| {
        (table.cross_component(line.plane, line.edge, axis), table.cross_component(line.plane, edge, axis))
    };
    (0..3).map(along).find(|(a, _)| *a != planecut_kernel::sign::Sign::Zero).is_none_or(|(a, b)| a == b)
}

/// Whether a box surely has no point on the plane's outer side and none on the plane, or none on its inner side.
fn misses(bounds: &Bounds, normal: DVec3, offset: f64) -> bool {
    let (low, high) = bounds.extent_along(normal, offset);
    high < 0.0 || low > 0.0
}
