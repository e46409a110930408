//! The edges at which what is left of a face ends.

use super::cover::Section;
use super::{FaceWorker, MANY_SECTIONS};
use crate::base::Boxes;
use crate::body::BodyFace;
use crate::boundary::contact::Facing;
use crate::boundary::section::{Cover, Line, Piece};
use crate::boundary::signs::Signs;
use crate::boundary::{BoundaryEdge, Scene};
use crate::ids::{holds, number32, place_of};

impl FaceWorker {
    /// The pieces of the region's own edges along which nothing is covered.
    pub(super) fn emit_own_edges(
        &mut self,
        scene: &Scene<'_>,
        face: &BodyFace,
        facing: Facing,
        out: &mut Vec<BoundaryEdge>,
    ) {
        let signs = Signs::new(scene.table, &self.signs);
        for (i, &edge) in self.region.edges.iter().enumerate() {
            let line = Line { plane: face.plane, edge };
            self.pieces.clear();
            self.pieces.push(Piece::of_edge(&self.region, i));
            for section in &self.sections[..self.live] {
                let polygon = &section.polygon;
                if let Some(k) = place_of(&polygon.edges, edge) {
                    let covered = Piece::of_edge(polygon, k);
                    line.subtract(signs, &mut self.pieces, &covered);
                }
            }
            out.extend(self.pieces.iter().map(|piece| BoundaryEdge::left(face, facing, edge, piece.start, piece.end)));
        }
    }

    /// The pieces of section edges outside of which nothing is covered: there the boundary ends, too.
    pub(super) fn emit_section_edges(
        &mut self,
        scene: &Scene<'_>,
        face: &BodyFace,
        facing: Facing,
        out: &mut Vec<BoundaryEdge>,
    ) {
        let signs = Signs::new(scene.table, &self.signs);
        let sections = &self.sections[..self.live];
        let boxes = || Boxes::new(sections.iter().map(|section| section.bounds).collect());
        let boxes = (sections.len() > MANY_SECTIONS).then(boxes);
        self.beside.clear();
        self.beside.extend(0..number32(sections.len()));
        for (k, section) in sections.iter().enumerate() {
            if let Some(boxes) = &boxes {
                boxes.touching(&section.bounds, &mut self.beside);
            }
            for (i, &edge) in section.polygon.edges.iter().enumerate() {
                if holds(&self.region.edges, edge) {
                    continue;
                }
                let line = Line { plane: face.plane, edge };
                self.pieces.clear();
                self.pieces.push(Piece::of_edge(&section.polygon, i));
                subtract_others(signs, line, sections, &self.beside, [k, i], &mut self.pieces);
                let right = |piece: &Piece| BoundaryEdge::right(face, facing, edge, piece.start, piece.end);
                out.extend(self.pieces.iter().map(right));
            }
        }
    }
}

/// Takes out of `pieces`, which lie on edge `edge` of section `own`, what others cover on the outer side of those `beside`.
///
/// Along a shared edge line a section on the outer side covers; of two on the same side the first keeps the edge.
fn subtract_others(
    signs: Signs<'_>,
    line: Line,
    sections: &[Section],
    beside: &[u32],
    [own, edge]: [usize; 2],
    pieces: &mut Vec<Piece>,
) {
    let Some(whole) = pieces.first().copied() else { return };
    let bounds = sections[own].polygon.edge_bounds(edge);
    for (k, other) in beside.iter().map(|k| (*k as usize, &sections[*k as usize])) {
        if k == own || pieces.is_empty() || !other.bounds.touches(&bounds) {
            continue;
        }
        match line.cover(signs, &whole, &other.polygon) {
            Cover::Apart => {}
            Cover::Across(part) => line.subtract(signs, pieces, &part),
            Cover::Along(part, edge) => {
                if !line.is_same_side(signs.table, edge) || k < own {
                    line.subtract(signs, pieces, &part);
                }
            }
        }
    }
}
