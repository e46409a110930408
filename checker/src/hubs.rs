//! Places where very many triangles meet: each would have to be compared with each.
//!
//! Two triangles that share a corner have another point in common exactly where the angles that they fill there do: where their arcs on a
//! small sphere around the corner meet. Arcs of triangles that lie side by side are side by side.

use std::collections::HashMap;

use glam::DVec3;

use crate::bvh::Aabb;

/// Triangles at a place from which on it is treated on its own.
const MANY: u32 = 64;
/// Growth of arcs at most: only what is a hundred times longer than the tolerance counts as overlapping or crossing along an edge.
const MOST_GROWTH: f64 = 0.01;

/// Triangles by the hub that they are at: the first group is of those at none, the others have their place.
pub(crate) struct Groups {
    /// Triangles of each group.
    pub(crate) groups: Vec<Vec<u32>>,
    /// The place of each group but the first.
    pub(crate) places: Vec<DVec3>,
}

impl Groups {
    /// Groups the given triangles; each is in one, that of its corner with the most triangles.
    pub(crate) fn new(positions: &[DVec3], triangles: &[[u32; 3]], chosen: &[u32]) -> Self {
        let mut degrees: HashMap<[u64; 3], (u32, u32)> = HashMap::new();
        let key = |vertex: u32| (positions[vertex as usize] + DVec3::ZERO).to_array().map(f64::to_bits);
        for &vertex in chosen.iter().flat_map(|&t| &triangles[t as usize]) {
            let next = degrees.len() as u32;
            degrees.entry(key(vertex)).or_insert((next, 0)).1 += 1;
        }
        let mut result = Self { groups: vec![Vec::new()], places: Vec::new() };
        let mut numbers = HashMap::new();
        for &t in chosen {
            let corners = triangles[t as usize].map(|vertex| (degrees[&key(vertex)], vertex));
            let ((place, degree), vertex) =
                corners.into_iter().max_by_key(|((place, degree), _)| (*degree, *place)).unwrap_or_default();
            let group = if degree < MANY {
                0
            } else {
                *numbers.entry(place).or_insert_with(|| {
                    result.places.push(positions[vertex as usize]);
                    result.groups.push(Vec::new());
                    result.groups.len() - 1
                })
            };
            result.groups[group].push(t);
        }
        result
    }
}

/// A box around the arc of directions in which a triangle is seen from one of its corners; triangles that have a contact deeper than `limit`
/// have boxes that meet.
pub(crate) fn arc(corners: [DVec3; 3], hub: DVec3, limit: f64) -> Aabb {
    let sides = corners.map(|corner| corner - hub);
    let shortest = sides.iter().map(|side| side.length()).filter(|length| *length > 0.0).fold(f64::INFINITY, f64::min);
    let directions: Vec<DVec3> = sides.iter().filter_map(|side| side.try_normalize()).collect();
    let chord = directions.iter().fold(DVec3::ZERO, |sum, direction| sum + direction) / 2.0;
    // How far the arc bulges beyond its chord.
    let bulge = if directions.len() == 2 { 1.0 - chord.length() } else { 0.0 };
    Aabb::of_points(&directions).grown(bulge + (limit / shortest).min(MOST_GROWTH) + 1e-12)
}
