//! Where two triangles of one plane touch.

use planecut_kernel::sign::Sign;

use super::contact::{Contacts, Cut, Place, Touch};
use super::points::PointKey;
use super::predicates::{best_axis, turn};
use super::surface::Surface;
use crate::ids::TriangleId;

/// Finds what two triangles of one plane have in common.
pub(super) fn touch(surface: &Surface, pair: [TriangleId; 2], out: &mut Contacts) {
    let Some((axis, first)) = best_axis(surface, pair[0]) else { return };
    let corners = pair.map(|triangle| surface.corners(triangle));
    let second = turn(surface, corners[1], axis);
    let facing = [first, second];
    // on which side of each edge of one triangle the corners of the other one lie; positive is inside
    let mut sides = [[[Sign::Zero; 3]; 3]; 2];
    for k in 0..2 {
        for (edge, of_edge) in sides[k].iter_mut().enumerate() {
            let (a, b) = (corners[k][edge], corners[k][(edge + 1) % 3]);
            for (side, &corner) in of_edge.iter_mut().zip(&corners[1 - k]) {
                if corner != a && corner != b {
                    *side = turn(surface, [a, b, corner], axis).times(facing[k]);
                }
            }
            if of_edge.iter().all(|side| *side == Sign::Negative) {
                return;
            }
        }
    }
    let is_separated = sides.iter().flatten().any(|of_edge| of_edge.iter().all(|side| *side != Sign::Positive));
    let touches = touches(surface, pair, &sides);
    let is_shared = |touch: &Touch| matches!(touch.places, [Place::Vertex(_), Place::Vertex(_)]);
    if touches.is_empty() {
        return;
    }
    out.coplanar.push(pair);
    if is_separated && touches.iter().all(is_shared) {
        return;
    }
    out.pairs.push(pair);
    for touch in &touches {
        out.cut_edges(pair, touch);
    }
    if !is_separated {
        out.overlapping.push(pair);
    }
    for k in 0..2 {
        if !is_separated || touches.len() > 1 {
            out.touched.push(pair[k]);
        }
        for edge in 0..3 {
            let ends: Vec<&Touch> = touches.iter().filter(|touch| touch.places[1 - k].is_on(edge)).collect();
            if let [from, to] = ends[..]
                && from.places[k].shared_edge(to.places[k]).is_none()
            {
                let ends = [from.key, to.key];
                let edge = Some(surface.edge(pair[1 - k], edge));
                out.cuts.push(Cut { triangle: pair[k], other: pair[1 - k], edge, ends });
            }
        }
    }
}

/// The points at which edges of the triangles meet, and the corners of one that lie in the other.
fn touches(surface: &Surface, pair: [TriangleId; 2], sides: &[[[Sign; 3]; 3]; 2]) -> Vec<Touch> {
    let corners = pair.map(|triangle| surface.corners(triangle));
    let mut touches = Vec::new();
    for k in 0..2 {
        for (j, &corner) in corners[1 - k].iter().enumerate() {
            let place = match corners[k].iter().position(|like| *like == corner) {
                // once is enough
                Some(_) if k == 1 => continue,
                Some(like) => Place::Vertex(like),
                None => match [0, 1, 2].map(|edge| sides[k][edge][j]) {
                    signs if signs.contains(&Sign::Negative) => continue,
                    signs => signs.iter().position(|side| *side == Sign::Zero).map_or(Place::Inside, Place::Edge),
                },
            };
            let places = if k == 0 { [place, Place::Vertex(j)] } else { [Place::Vertex(j), place] };
            touches.push(Touch { key: PointKey::Vertex(corner), places });
        }
    }
    let opposite = |a: Sign, b: Sign| a != Sign::Zero && a == b.flip();
    for i in 0..3 {
        for j in 0..3 {
            let (next_i, next_j) = ((i + 1) % 3, (j + 1) % 3);
            if opposite(sides[0][i][j], sides[0][i][next_j]) && opposite(sides[1][j][i], sides[1][j][next_i]) {
                let key = PointKey::of_edges(surface.edge(pair[0], i), surface.edge(pair[1], j));
                touches.push(Touch { key, places: [Place::Edge(i), Place::Edge(j)] });
            }
        }
    }
    touches
}
