//! Edges worth drawing.

use glam::DVec3;
use planecut_parallel::prelude::*;

use super::dashes::{DashRun, dash_runs};
use crate::input::mesh::PaintedMesh;
use crate::raster::is_front;
use crate::scene::Scene;
use crate::scene::look::{Fill, Hidden};
use crate::view::lens::ScreenPoint;

/// Cosine of the angle (40 degrees) from which on creases are drawn at full strength.
const SHARP_COSINE: f64 = 0.766;

/// Strength of the faintest crease, relative to a sharp one.
const FAINT: f32 = 0.3;

/// A line on the picture.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Line {
    pub(crate) ends: [ScreenPoint; 2],
    /// Faces on both sides; the same twice at the rim of an open mesh.
    pub(crate) faces: [u32; 2],
    /// Opacity where it is seen, 0 to 1.
    pub(crate) opacity: f32,
    /// Opacity where something hides it.
    pub(crate) hidden: f32,
    /// In pixels.
    pub(crate) half_width: f32,
    /// Where its dashes begin, if what is hidden is dashed.
    pub(crate) dashes: Option<DashRun>,
}

/// What an edge is.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    /// Between a face that is seen and one that is turned away, or the rim of an open mesh, or of a cut.
    Outline,
    /// Between faces that meet at an angle; the part of full strength.
    Crease(f32),
    /// Between triangles of one face, or of faces that look like one.
    Inner,
}

/// The creases, outlines and rims of the scene's mesh, as far as its look draws them.
pub(crate) fn feature_lines(scene: &Scene<'_>, scale: f32) -> Vec<Line> {
    let fronts: Vec<bool> = scene
        .mesh
        .triangles
        .iter()
        .map(|triangle| is_front(triangle.map(|corner| scene.screen[corner as usize])))
        .collect();
    let halves = sorted_half_edges(scene.mesh, &fronts);
    let around_edges = halves.chunk_by(|a, b| a.edge == b.edge);
    let (mut lines, mut edges) = (Vec::new(), Vec::new());
    for around in around_edges {
        if let Some(line) = line_along(scene, around, scale) {
            lines.push(line);
            edges.push(around[0].vertices());
        }
    }
    if matches!(scene.look.lines.hidden, Hidden::Dashed(_)) {
        for (line, run) in lines.iter_mut().zip(dash_runs(&edges, &scene.screen)) {
            line.dashes = Some(run);
        }
    }
    lines
}

/// One triangle's side.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct HalfEdge {
    /// The two vertices, the smaller number in the upper half.
    edge: u64,
    face: u32,
    front: bool,
}

impl HalfEdge {
    fn vertices(self) -> [u32; 2] {
        [(self.edge >> 32) as u32, self.edge as u32]
    }
}

/// Sides that belong to one edge follow one another; within an edge the order is that of the faces.
fn sorted_half_edges(mesh: &PaintedMesh<'_>, fronts: &[bool]) -> Vec<HalfEdge> {
    let mut halves = Vec::with_capacity(3 * mesh.triangles.len());
    for ((&[a, b, c], &face), &front) in mesh.triangles.iter().zip(&*mesh.triangle_faces).zip(fronts) {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let edge = u64::from(from.min(to)) << 32 | u64::from(from.max(to));
            halves.push(HalfEdge { edge, face, front });
        }
    }
    halves.par_sort_unstable();
    halves
}

fn line_along(scene: &Scene<'_>, around: &[HalfEdge], scale: f32) -> Option<Line> {
    let look = &scene.look.lines;
    let (first, last) = (around.first()?, around.last()?);
    let fronts = around.iter().filter(|half| half.front).count();
    // What is turned away is hidden, unless the surface does not hide anything.
    if fronts == 0 && look.hidden == Hidden::Omitted {
        return None;
    }
    let (opacity, width) = match kind_of(scene, around, fronts) {
        Kind::Outline => (look.outline, look.outline_width),
        Kind::Crease(part) => {
            // Where lines cannot become thinner, the faint ones become fainter: small pictures would be full of them.
            let thin = (look.crease_width * scale / LEAST_WIDTH).min(1.0);
            (look.crease * part * (part + (1.0 - part) * thin * thin), look.crease_width)
        }
        Kind::Inner => (look.inner, look.crease_width * 0.8),
    };
    if opacity == 0.0 {
        return None;
    }
    let hidden = match look.hidden {
        Hidden::Omitted => 0.0,
        Hidden::Dashed(strength) => strength,
        Hidden::Faint(part) => opacity * part,
    };
    let ends = first.vertices().map(|vertex| scene.screen[vertex as usize]);
    let faces = [first.face, last.face];
    Some(Line { ends, faces, opacity, hidden, half_width: half_width(width, scale), dashes: None })
}

fn kind_of(scene: &Scene<'_>, around: &[HalfEdge], fronts: usize) -> Kind {
    let [first, last] = [around[0].face, around[around.len() - 1].face];
    if (fronts > 0 && fronts < around.len()) || around.len() == 1 {
        return Kind::Outline;
    }
    let hatches = [first, last].map(|face| scene.hatch(face));
    if hatches[0].is_some() != hatches[1].is_some() {
        return Kind::Outline;
    }
    let normal = |face: u32| DVec3::from(scene.mesh.faces[face as usize].normal);
    let cosine = normal(first).dot(normal(last));
    let smooth = scene.look.lines.smooth_cosine;
    if hatches[0] != hatches[1] {
        Kind::Crease(1.0)
    } else if cosine > smooth {
        Kind::Inner
    } else if scene.look.fill == Fill::Opaque && smooth > SHARP_COSINE {
        let part = ((smooth - cosine) / (smooth - SHARP_COSINE)).min(1.0) as f32;
        Kind::Crease(FAINT + (1.0 - FAINT) * part)
    } else {
        Kind::Crease(1.0)
    }
}

/// Lines that are thinner, in pixels, would look broken.
const LEAST_WIDTH: f32 = 0.75;

/// Half the width of a line in pixels, where pictures are `scale` times as large as those that widths are stated for.
fn half_width(width: f32, scale: f32) -> f32 {
    (width * scale).max(LEAST_WIDTH) / 2.0
}
