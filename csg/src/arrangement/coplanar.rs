//! Where two triangles of one plane touch.

use planecut_kernel::sign::Sign;

use super::contact::{Contacts, Cut, Pair, Place, Touch};
use super::points::Key;
use super::predicates::{Triangle, best_axis, normal_component, turn};

/// Finds what two triangles of one plane have in common.
pub(super) fn touch(pair: &Pair<'_>, out: &mut Contacts) {
    let Pair { input, corners, .. } = pair;
    let first = Triangle { number: pair.number(0), corners: corners[0] };
    let Some((axis, first)) = best_axis(input, &first) else { return };
    let second = normal_component(input, &Triangle { number: pair.number(1), corners: corners[1] }, axis);
    let facing = [first, second];
    // on which side of each edge of one triangle the corners of the other one lie; positive is inside
    let mut sides = [[[Sign::Zero; 3]; 3]; 2];
    for k in 0..2 {
        for (edge, of_edge) in sides[k].iter_mut().enumerate() {
            let (a, b) = (corners[k][edge], corners[k][(edge + 1) % 3]);
            for (side, &corner) in of_edge.iter_mut().zip(&corners[1 - k]) {
                if corner.vertex != a.vertex && corner.vertex != b.vertex {
                    *side = turn(input, [a, b, corner], axis).times(facing[k]);
                }
            }
            if of_edge.iter().all(|side| *side == Sign::Negative) {
                return;
            }
        }
    }
    let is_separated = sides.iter().flatten().any(|of_edge| of_edge.iter().all(|side| *side != Sign::Positive));
    let touches = touches(pair, &sides);
    let is_shared = |touch: &Touch| matches!(touch.places, [Place::Vertex(_), Place::Vertex(_)]);
    if touches.is_empty() {
        return;
    }
    out.coplanar.push(pair.numbers());
    if is_separated && touches.iter().all(is_shared) {
        return;
    }
    out.pairs.push(pair.numbers());
    for touch in &touches {
        out.cut_edges(pair, touch);
    }
    if !is_separated {
        out.overlapping.push(pair.numbers());
    }
    for k in 0..2 {
        if !is_separated || touches.len() > 1 {
            out.touched.push(pair.number(k));
        }
        for edge in 0..3 {
            let ends: Vec<&Touch> = touches.iter().filter(|touch| touch.places[1 - k].is_on(edge)).collect();
            let [from, to] = ends[..] else { continue };
            let (triangle, other) = (pair.number(k), pair.number(1 - k));
            let (edge, ends) = (Some(pair.edge(1 - k, edge)), [from.key, to.key]);
            out.divide(Cut { triangle, other, edge, ends }, from.places[k].shared_edge(to.places[k]));
        }
    }
}

/// The points at which edges of the triangles meet, and the corners of one that lie in the other.
fn touches(pair: &Pair<'_>, sides: &[[[Sign; 3]; 3]; 2]) -> Vec<Touch> {
    let corners = &pair.corners;
    let mut touches = Vec::new();
    for k in 0..2 {
        for (j, &corner) in corners[1 - k].iter().enumerate() {
            let place = match corners[k].iter().position(|like| like.vertex == corner.vertex) {
                // once is enough
                Some(_) if k == 1 => continue,
                Some(like) => Place::Vertex(like),
                None => match [0, 1, 2].map(|edge| sides[k][edge][j]) {
                    signs if signs.contains(&Sign::Negative) => continue,
                    signs => signs.iter().position(|side| *side == Sign::Zero).map_or(Place::Inside, Place::Edge),
                },
            };
            let places = if k == 0 { [place, Place::Vertex(j)] } else { [Place::Vertex(j), place] };
            touches.push(Touch { key: Key::Vertex(corner.vertex), places });
        }
    }
    let opposite = |a: Sign, b: Sign| a != Sign::Zero && a == b.flip();
    for i in 0..3 {
        for j in 0..3 {
            let (next_i, next_j) = ((i + 1) % 3, (j + 1) % 3);
            if opposite(sides[0][i][j], sides[0][i][next_j]) && opposite(sides[1][j][i], sides[1][j][next_i]) {
                let key = Key::of_edges(pair.edge(0, i), pair.edge(1, j));
                touches.push(Touch { key, places: [Place::Edge(i), Place::Edge(j)] });
            }
        }
    }
    touches
}
