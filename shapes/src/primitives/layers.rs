//! Extrusions that are turned or stretched, layer by layer.
//!
//! The sides of a layer are planar or cut along a diagonal; between two planes across z they are a closed surface, which is
//! cut into convex cells loop by loop. Without change of scale all layers are one, turned.

use planecut_check::{CheckOptions, check_mesh};
use planecut_csg::{Brush, MaterialId, Tree};
use planecut_kernel::{DVec2, DVec3};
use robust::{Coord3D, orient3d};

use super::cells::{PlaneSide, Surface};
use super::extruded::{Extrusion, LayerRules, brush_of, ends};
use crate::outline::largest_coordinate;
use crate::parameter::{ShapeError, pieces, refuse};

/// Of each facet the numbers of its corners, counter-clockwise seen from outside.
type Facets = Vec<Vec<u32>>;

/// A loop on its way up: the outer one of a shape, or a hole, which both run counter-clockwise.
struct Ring {
    /// A little narrower, and a little wider, as even and odd layers are.
    corners: [Vec<DVec2>; 2],
    is_hole: bool,
    /// The facets and cells of the layer before, where all layers are alike.
    known: Option<(Facets, Vec<Vec<PlaneSide>>)>,
    brushes: Vec<Brush>,
}

/// The cells over the outer loop of a shape, and over each of its holes; `count` is how many there are before.
pub(super) fn layered(
    shape: &[Vec<DVec2>],
    extrusion: &Extrusion,
    material: MaterialId,
    count: u64,
) -> Result<Vec<Vec<Tree>>, ShapeError> {
    let size = largest_coordinate(shape.iter().flatten());
    let step = if extrusion.layers() == 1 { 0.0 } else { STEP * size };
    let mut rings: Vec<Ring> = shape.iter().enumerate().map(|(k, corners)| Ring::new(corners, k > 0, step)).collect();
    for layer in 0..extrusion.layers() {
        let points: Vec<Vec<DVec3>> = rings.iter().map(|ring| ring.points(extrusion, layer)).collect();
        let is_new = rings[0].known.is_none();
        let facets: Vec<Facets> = rings
            .iter_mut()
            .zip(&points)
            .map(|(ring, points)| match &ring.known {
                Some((facets, _)) => facets.clone(),
                None => ring_facets(points, extrusion, layer, ring.is_hole),
            })
            .collect();
        if is_new {
            check_layer(&points, &facets, extrusion, layer)?;
        }
        let ends = ends(extrusion, layer, layer + 1)?;
        for ((ring, points), facets) in rings.iter_mut().zip(&points).zip(facets) {
            let surface =
                Surface::new(points, &facets).ok_or_else(|| refuse("polygon", &"a side", &"one of some width"))?;
            let cells = ring.known.take().map_or_else(|| surface.cells(), |(_, cells)| Ok(cells))?;
            let sides = surface.half_spaces()?;
            ring.brushes.extend(cells.iter().filter_map(|cell| brush_of(cell, &sides, &ends, material)));
            ring.known = (extrusion.scale == DVec2::ONE).then_some((facets, cells));
        }
        let made = rings.iter().map(|ring| ring.brushes.len() as u64).sum::<u64>();
        pieces(count + made / u64::from(layer + 1) * u64::from(extrusion.layers()))?;
    }
    Ok(rings.into_iter().map(|ring| ring.brushes.into_iter().map(Tree::from).collect()).collect())
}

/// The outlines of odd layers are wider by this part of their size, and those of even ones narrower. Where layers meet, their
/// outlines are the same but for rounding; so one lies within the other, and what is left of the difference are strips that are
/// thin everywhere and contracted in the mesh. Outlines that cross each other by rounding would leave corners where they cross,
/// and tunnels as wide as an ulp. Several roundings of planes that are moved later are still less, the mesh takes seventy times
/// as much for noise, and the volume stays what it was, as half of the layers gain what the others lose.
const STEP: f64 = 1.0 / (1u64 << 47) as f64;

impl Ring {
    fn new(corners: &[DVec2], is_hole: bool, step: f64) -> Self {
        let (mut corners, step) = (corners.to_vec(), if is_hole { -step } else { step });
        if is_hole {
            corners.reverse();
        }
        let corners = [-step, step].map(|by| widened(&corners, by));
        Self { corners, is_hole, known: None, brushes: Vec::new() }
    }

    /// The corners at the bottom of a layer and then those on top.
    fn points(&self, extrusion: &Extrusion, layer: u32) -> Vec<DVec3> {
        let corners = &self.corners[layer as usize % 2];
        let at = |level: u32| corners.iter().map(move |p| extrusion.corner(*p, level));
        at(layer).chain(at(layer + 1)).collect()
    }
}

/// A loop whose sides are moved outward by a distance, far less than any of them is long.
fn widened(corners: &[DVec2], by: f64) -> Vec<DVec2> {
    let outward = |from: DVec2, to: DVec2| (from - to).normalize_or_zero().perp();
    let n = corners.len();
    let corner = |k: usize| {
        let at = corners[k];
        let (a, b) = (outward(corners[(k + n - 1) % n], at), outward(at, corners[(k + 1) % n]));
        // where the moved sides meet, but not out of proportion at a needle's tip
        at + (a + b) / (1.0 + a.dot(b)).max(1e-3) * by
    };
    (0..n).map(corner).collect()
}

/// The sides of a layer over one loop: planar ones as they are, the others cut along a diagonal.
fn ring_facets(points: &[DVec3], extrusion: &Extrusion, layer: u32, is_hole: bool) -> Facets {
    let n = points.len() as u32 / 2;
    let side = |p: u32| [p, (p + 1) % n, (p + 1) % n + n, p + n];
    (0..n).map(side).flat_map(|side| side_facets(points, side, extrusion, layer, is_hole)).collect()
}

/// One side, given by its corners counter-clockwise, the first two below.
fn side_facets(
    points: &[DVec3],
    [p, q, above_q, above_p]: [u32; 4],
    extrusion: &Extrusion,
    layer: u32,
    is_hole: bool,
) -> Facets {
    let corners = [p, q, above_q, above_p].map(|k| points[k as usize]);
    if corners[2] == corners[3] {
        return vec![vec![p, q, above_q]];
    }
    // Exactly so where the outline is only stretched along an axis; where rounding comes between, triangles are exact.
    if is_planar(corners) {
        return vec![vec![p, q, above_q, above_p]];
    }
    if rises(corners, extrusion, layer, is_hole) {
        vec![vec![p, q, above_q], vec![p, above_q, above_p]]
    } else {
        vec![vec![p, q, above_p], vec![q, above_q, above_p]]
    }
}

/// Whether a side is cut from its first corner up to the one above its second.
fn rises([p, q, above_q, above_p]: [DVec3; 4], extrusion: &Extrusion, layer: u32, is_hole: bool) -> bool {
    match extrusion.rules {
        LayerRules::ModelFile => {
            let (rising, falling) = (p.distance(above_q), q.distance(above_p));
            // sides of a hole begin at their other end there
            if is_hole { rising < falling * (1.0 - 1e-9) } else { falling >= rising * (1.0 - 1e-9) }
        }
        LayerRules::OpenScad => {
            let length = |a: DVec3, b: DVec3| (a - b).truncate().length();
            let (rising, falling) = (length(p, above_q), length(q, above_p));
            let is_tie = (rising - falling).abs() * 2e5 <= rising + falling;
            let rises = if is_tie { extrusion.twist > 0.0 } else { rising < falling };
            let has_width = layer + 1 < extrusion.layers() || extrusion.scale.min_element() > 0.0;
            rises == has_width
        }
    }
}

/// Whether four points lie exactly on one plane.
fn is_planar(points: [DVec3; 4]) -> bool {
    let [a, b, c, d] = points.map(|p| Coord3D { x: p.x, y: p.y, z: p.z });
    orient3d(a, b, c, d) == 0.0
}

/// Whether the sides of a layer pass through each other, exactly.
fn check_layer(points: &[Vec<DVec3>], facets: &[Facets], extrusion: &Extrusion, layer: u32) -> Result<(), ShapeError> {
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    let mut start = 0;
    for (points, facets) in points.iter().zip(facets) {
        let fan = |facet: &Vec<u32>| {
            let corner = |k: usize| facet[k] + start;
            (1..facet.len() - 1).map(|k| [corner(0), corner(k), corner(k + 1)]).collect::<Vec<_>>()
        };
        triangles.extend(facets.iter().flat_map(fan));
        start += points.len() as u32;
    }
    let options = CheckOptions { tolerance: 1e-12, crossings: true };
    let crossings = check_mesh(&points.concat(), &triangles, &options).crossings;
    if crossings.is_some_and(|report| report.first.is_some()) {
        return Err(ShapeError::CrossingSides { layer, slices: extrusion.layers() });
    }
    Ok(())
}
