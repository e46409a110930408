//! A closed surface, made of facets whose corners are merged by position, and cut into triangles that are paired along edges.

use planecut_csg::stages::CompensatedSum;
use planecut_kernel::DVec3;
use rustc_hash::{FxHashMap, FxHashSet};

use super::error::PolyhedronError;
use super::pairing::{pair_half_edges, split_vertices};
use super::polygon::{MAX_CONCAVE_CORNERS, area_vector, triangulate as cut};
use super::precision::Precision;

/// Largest accepted magnitude of a coordinate.
pub(super) const MAX_COORDINATE: f64 = f64::from_bits((1023 + 100) << 52);

/// A closed surface. Where it touches itself in an edge or a vertex, its sheets have vertices of their own there: every edge
/// has two triangles, every vertex one fan.
#[derive(Debug)]
pub(super) struct Surface {
    pub(super) points: Vec<DVec3>,
    /// How far each point may lie from planes that it is meant to be on.
    pub(super) slack: Vec<f64>,
    /// Counter-clockwise seen from outside.
    pub(super) triangles: Vec<[u32; 3]>,
    /// The facet of each triangle; those of one facet follow each other.
    pub(super) facet_of: Vec<u32>,
    /// The half-edge on the other side of each: half-edge `3 t + k` runs from corner `k` of triangle `t` to the next.
    pub(super) mates: Vec<u32>,
    /// Whether all facets were turned over, as they enclosed a negative volume.
    pub(super) is_turned: bool,
    /// Whether there are several sheets at an edge or a vertex.
    pub(super) touches_itself: bool,
}

impl Surface {
    pub(super) fn new<F: AsRef<[u32]>>(
        points: &[DVec3],
        facets: &[F],
        precision: Precision,
    ) -> Result<Self, PolyhedronError> {
        let (merged, number) = merge_points(points)?;
        let polygons = polygons(facets, &number)?;
        check_closed(&polygons, &merged)?;
        let (mut triangles, facet_of) = triangulate(&polygons, &merged)?;
        let six_volumes = six_volumes(&merged, &triangles);
        let is_turned = six_volumes < 0.0;
        if is_turned {
            triangles.iter_mut().for_each(|t| t.swap(1, 2));
        }
        if triangles.is_empty() || six_volumes == 0.0 {
            return Err(PolyhedronError::NoVolume);
        }
        let mates = pair_half_edges(&merged, &triangles);
        let used = used_points(&triangles, merged.len());
        let points = split_vertices(&merged, &mut triangles, &mates);
        let touches_itself = points.len() > used || repeats_an_edge(&polygons);
        let slack = precision.slack(&points);
        Ok(Self { points, slack, triangles, facet_of, mates, is_turned, touches_itself })
    }

    /// The volume by the divergence theorem.
    pub(super) fn volume(&self) -> f64 {
        six_volumes(&self.points, &self.triangles) / 6.0
    }

    /// How far the volume may be off because facets were put on common planes.
    pub(super) fn volume_slack(&self) -> f64 {
        let slack = |t: &[u32; 3]| t.iter().map(|v| self.slack[*v as usize]).fold(0.0, f64::max);
        let area = |t: usize| area_vector(&self.corners(t)).length();
        self.triangles.iter().enumerate().map(|(t, corners)| area(t) * slack(corners)).sum()
    }

    pub(super) fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].map(|v| self.points[v as usize])
    }

    /// The triangle beyond the edge from corner `k` to the next.
    pub(super) fn neighbour(&self, triangle: usize, k: usize) -> usize {
        self.mates[3 * triangle + k] as usize / 3
    }
}

/// How many points triangles use.
fn used_points(triangles: &[[u32; 3]], points: usize) -> usize {
    let mut used = vec![false; points];
    triangles.as_flattened().iter().for_each(|v| used[*v as usize] = true);
    used.into_iter().filter(|used| *used).count()
}

/// The different positions, and the number of each point's, where all are accepted.
fn merge_points(points: &[DVec3]) -> Result<(Vec<DVec3>, Vec<u32>), PolyhedronError> {
    // not true of NaN
    let is_accepted = |p: &DVec3| p.to_array().iter().all(|v| v.abs() <= MAX_COORDINATE);
    match points.iter().position(|p| !is_accepted(p)) {
        Some(point) => Err(PolyhedronError::Point { point, position: points[point] }),
        None => Ok(merged(points)),
    }
}

/// The different positions, and the number of each point's.
pub(super) fn merged(points: &[DVec3]) -> (Vec<DVec3>, Vec<u32>) {
    let mut numbers: FxHashMap<[u64; 3], u32> = FxHashMap::default();
    let mut merged = Vec::new();
    let number = points.iter().map(|&position| {
        // adding zero turns -0 into 0
        let position = position + DVec3::ZERO;
        *numbers.entry(position.to_array().map(f64::to_bits)).or_insert_with(|| {
            merged.push(position);
            merged.len() as u32 - 1
        })
    });
    let number = number.collect();
    (merged, number)
}

/// The facets that have at least three corners, with their numbers.
fn polygons<F: AsRef<[u32]>>(facets: &[F], number: &[u32]) -> Result<Vec<(u32, Vec<u32>)>, PolyhedronError> {
    let mut polygons = Vec::with_capacity(facets.len());
    for (facet, corners) in facets.iter().enumerate() {
        let mut polygon = Vec::with_capacity(corners.as_ref().len());
        for &point in corners.as_ref() {
            let unknown = PolyhedronError::UnknownPoint { facet, point, points: number.len() };
            let corner = *number.get(point as usize).ok_or(unknown)?;
            if polygon.last() != Some(&corner) {
                polygon.push(corner);
            }
        }
        while polygon.len() > 1 && polygon.first() == polygon.last() {
            polygon.pop();
        }
        if polygon.len() > 2 {
            polygons.push((facet as u32, polygon));
        }
    }
    Ok(polygons)
}

/// Whether every edge is used equally often in both directions.
fn check_closed(polygons: &[(u32, Vec<u32>)], points: &[DVec3]) -> Result<(), PolyhedronError> {
    let mut surplus: FxHashMap<(u32, u32), i64> = FxHashMap::default();
    let edges = |polygon: &[u32]| -> Vec<(u32, u32)> {
        (0..polygon.len()).map(|k| (polygon[k], polygon[(k + 1) % polygon.len()])).collect()
    };
    for (a, b) in polygons.iter().flat_map(|(_, polygon)| edges(polygon)) {
        *surplus.entry((a.min(b), a.max(b))).or_default() += if a < b { 1 } else { -1 };
    }
    let open = surplus.values().filter(|sum| **sum != 0).count();
    if open == 0 {
        return Ok(());
    }
    let is_open = |(a, b): (u32, u32)| {
        let sum = surplus.get(&(a.min(b), a.max(b))).copied().unwrap_or(0);
        if a < b { sum > 0 } else { sum < 0 }
    };
    for (facet, polygon) in polygons {
        if let Some((a, b)) = edges(polygon).into_iter().find(|edge| is_open(*edge)) {
            let (from, to) = (points[a as usize], points[b as usize]);
            return Err(PolyhedronError::Open { facet: *facet as usize, from, to, edges: open });
        }
    }
    Ok(())
}

/// Whether an edge is used more than once in the same direction.
fn repeats_an_edge(polygons: &[(u32, Vec<u32>)]) -> bool {
    let mut edges = FxHashSet::default();
    let edges_of = |polygon: &Vec<u32>| {
        let next = polygon.iter().copied().cycle().skip(1);
        polygon.iter().copied().zip(next).collect::<Vec<_>>()
    };
    polygons.iter().flat_map(|(_, polygon)| edges_of(polygon)).any(|edge| !edges.insert(edge))
}

fn triangulate(polygons: &[(u32, Vec<u32>)], points: &[DVec3]) -> Result<(Vec<[u32; 3]>, Vec<u32>), PolyhedronError> {
    let (mut triangles, mut facet_of) = (Vec::new(), Vec::new());
    for (facet, polygon) in polygons {
        let corners: Vec<DVec3> = polygon.iter().map(|v| points[*v as usize]).collect();
        let facet_error = || PolyhedronError::TooManyCorners {
            facet: *facet as usize,
            corners: polygon.len(),
            limit: MAX_CONCAVE_CORNERS,
        };
        for triangle in cut(&corners).ok_or_else(facet_error)? {
            let triangle = triangle.map(|k| polygon[k]);
            // polygons that come by a corner twice can leave such
            if triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0] {
                triangles.push(triangle);
                facet_of.push(*facet);
            }
        }
    }
    Ok((triangles, facet_of))
}

/// Six times the volume, as tetrahedra from a point amid the others: less cancels than from the origin.
pub(super) fn six_volumes(points: &[DVec3], triangles: &[[u32; 3]]) -> f64 {
    let (low, high) = points.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), p| (l.min(*p), h.max(*p)));
    let middle = 0.5 * low + 0.5 * high;
    let six = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| points[v as usize] - middle);
        a.dot(area_vector(&[DVec3::ZERO, b, c]))
    };
    let mut sum = CompensatedSum::default();
    triangles.iter().for_each(|triangle| sum.add(six(triangle)));
    sum.value()
}
