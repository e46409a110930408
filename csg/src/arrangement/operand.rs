//! Leaves of a tree made ready for the arrangement: closed meshes where they lie, and convex bodies as triangles.

use std::borrow::Cow;

use glam::DVec3;
use planecut_kernel::compare_exactly;
use planecut_parallel::prelude::*;

use super::flat::{are_collinear, is_surely_not_flat};
use super::stars::simple_stars;
use super::triangle_tree::{TriangleTree, bounds_of};
use crate::base::Bounds;
use crate::body::Body;
use crate::closed_mesh::connectivity::{HalfEdges, NO_TWIN, next, previous};
use crate::closed_mesh::{Star, WindingRule};
use crate::ids::{Id, number32};
use crate::model::{MaterialId, MeshBody};
use crate::plane_table::{PlaneId, PlaneTable};

/// Coordinates, other than zero, of which products of five are computed without overflow and without loss of their last bits.
const SAFE: std::ops::RangeInclusive<f64> = 1e-40..=1e50;

/// Vertices or triangles that one thread looks at in a row.
const CHUNK: usize = 1 << 13;

/// A closed mesh where it lies, or a convex body as triangles.
#[derive(Debug, Default)]
pub(super) struct Operand<'a> {
    positions: Cow<'a, [DVec3]>,
    /// Counter-clockwise seen from outside.
    triangles: Cow<'a, [[u32; 3]]>,
    twins: Cow<'a, [u32]>,
    source: Source<'a>,
    tree: TriangleTree,
    /// The triangles without an area.
    flat: Vec<u32>,
    /// Whether the triangles around each vertex have nothing in common but their edges; empty where that holds for all triangles.
    simple: Vec<bool>,
    /// The vertices around which triangles are not one fan.
    pinched: Vec<u32>,
    is_safe: bool,
}

/// What an operand is made of.
#[derive(Debug, Default)]
enum Source<'a> {
    #[default]
    Nothing,
    Mesh(&'a MeshBody),
    Body(BodyPlanes),
}

/// The planes of a convex body.
#[derive(Debug)]
struct BodyPlanes {
    /// The plane and material of each triangle.
    of_triangle: Vec<(PlaneId, MaterialId)>,
    /// The planes that meet in each vertex that is not at its rounded place.
    at_vertex: Vec<Option<[PlaneId; 3]>>,
}

/// The corners of a convex body, each once.
#[derive(Debug, Default)]
struct BodyCorners {
    positions: Vec<DVec3>,
    /// The planes that meet in each vertex that is not at its rounded place.
    at_vertex: Vec<Option<[PlaneId; 3]>>,
    /// For each number that the body gives its corners the vertex: where more than three planes meet, it may give several to one.
    of_number: Vec<u32>,
}

impl BodyCorners {
    fn new(table: &PlaneTable, body: &Body) -> Self {
        let mut meeting: Vec<Option<([PlaneId; 3], DVec3)>> = vec![None; body.corner_count()];
        for face in &body.faces {
            let edges = body.edges(face);
            for (k, corner) in body.corners(face).enumerate() {
                let planes = || [face.plane, edges[k], edges[(k + 1) % edges.len()]];
                meeting[corner.number.index()].get_or_insert_with(|| (planes(), corner.at));
            }
        }
        let corner = |(number, meeting): (usize, &Option<([PlaneId; 3], DVec3)>)| {
            let (planes, near) = (*meeting)?;
            // the zeros have one sign
            let at = table.position(planes).unwrap_or(near) + 0.0;
            let is_there = planes.iter().all(|plane| is_surely_on(table, *plane, at));
            Some((at.to_array().map(f64::to_bits), number32(number), planes, (!is_there).then_some(planes)))
        };
        let mut corners: Vec<_> = meeting.par_iter().enumerate().with_min_len(CHUNK >> 3).filter_map(corner).collect();
        corners.par_sort_unstable();
        let mut out = Self { of_number: vec![0; meeting.len()], ..Self::default() };
        let rows = |planes: [PlaneId; 3]| planes.map(|plane| table.row(plane));
        for near in corners.chunk_by(|a, b| a.0 == b.0) {
            let first = out.positions.len();
            let mut known: Vec<[PlaneId; 3]> = Vec::new();
            for (at, number, planes, meeting) in near {
                let same = known.iter().position(|own| compare_exactly(rows(*own), rows(*planes), &[0, 1, 2]).is_eq());
                out.of_number[*number as usize] = number32(first + same.unwrap_or(known.len()));
                if same.is_none() {
                    known.push(*planes);
                    out.positions.push(DVec3::from_array(at.map(f64::from_bits)));
                    out.at_vertex.push(*meeting);
                }
            }
        }
        out
    }
}

/// Whether floating-point filters and expansions hold for these coordinates.
fn are_safe(positions: &[DVec3]) -> bool {
    let is_safe = |v: f64| v == 0.0 || SAFE.contains(&v.abs());
    positions.par_iter().with_min_len(CHUNK).all(|p| is_safe(p.x) && is_safe(p.y) && is_safe(p.z))
}

impl<'a> Operand<'a> {
    /// A closed mesh where it lies.
    pub(super) fn of_mesh(body: &'a MeshBody) -> Self {
        let mesh = body.mesh();
        let (positions, triangles) = (body.positions(), body.triangles());
        let twins =
            if body.is_mirrored() { Cow::Owned(mirrored_twins(mesh.twins())) } else { Cow::Borrowed(mesh.twins()) };
        let is_safe = are_safe(&positions);
        let places = |triangle: u32| triangles[triangle as usize].map(|vertex| positions[vertex as usize]);
        let count = number32(triangles.len());
        let all = (0..count).into_par_iter().with_min_len(CHUNK);
        let flat: Vec<u32> =
            all.filter(|t| !(is_safe && is_surely_not_flat(places(*t))) && are_collinear(places(*t))).collect();
        let with_area: Vec<u32> = if flat.is_empty() {
            (0..count).collect()
        } else {
            (0..count).filter(|triangle| flat.binary_search(triangle).is_err()).collect()
        };
        let tree = TriangleTree::new(&with_area, |triangle| bounds_of(places(triangle)));
        let stars = stars_of(body);
        let simple =
            if is_safe { simple_stars(&positions, &triangles, &twins, &stars) } else { vec![false; positions.len()] };
        let is_pinched = |vertex: &u32| {
            let k = *vertex as usize;
            !simple[k] && !is_one_fan(&twins, &stars[k])
        };
        let pinched = (0..number32(positions.len())).into_par_iter().with_min_len(CHUNK).filter(is_pinched).collect();
        Self { positions, triangles, twins, source: Source::Mesh(body), tree, flat, simple, pinched, is_safe }
    }

    /// A convex body whose planes are in a table.
    pub(super) fn of_body(table: &PlaneTable, body: &Body) -> Self {
        let BodyCorners { positions, at_vertex, of_number } = BodyCorners::new(table, body);
        let (mut triangles, mut of_triangle) = (Vec::new(), Vec::new());
        let mut ring = Vec::new();
        for face in &body.faces {
            ring.clear();
            ring.extend(body.corners(face).map(|corner| of_number[corner.number.index()]));
            for k in 1..ring.len().saturating_sub(1) {
                triangles.push([ring[0], ring[k], ring[k + 1]]);
                of_triangle.push((face.plane, face.material));
            }
        }
        let twins = HalfEdges::new(positions.len(), &triangles).twins();
        let all: Vec<u32> = (0..number32(triangles.len())).collect();
        let tree = TriangleTree::new(&all, |t| {
            grown(bounds_of(triangles[t as usize].map(|vertex| positions[vertex as usize])))
        });
        let is_safe = are_safe(&positions);
        Self {
            positions: positions.into(),
            triangles: triangles.into(),
            twins: twins.into(),
            source: Source::Body(BodyPlanes { of_triangle, at_vertex }),
            tree,
            flat: Vec::new(),
            simple: Vec::new(),
            pinched: Vec::new(),
            is_safe,
        }
    }

    pub(super) fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    pub(super) fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// For each half-edge the one that runs back along the same edge, where there is exactly one of both.
    pub(super) fn twins(&self) -> &[u32] {
        &self.twins
    }

    /// A box that holds a triangle.
    #[inline]
    pub(super) fn bounds(&self, triangle: u32) -> Bounds {
        let [a, b, c] = self.triangles[triangle as usize];
        let positions = &self.positions;
        let bounds = bounds_of([positions[a as usize], positions[b as usize], positions[c as usize]]);
        if self.is_body() { grown(bounds) } else { bounds }
    }

    /// The boxes around its triangles, but for those without an area.
    pub(super) fn tree(&self) -> &TriangleTree {
        &self.tree
    }

    /// The triangles without an area.
    pub(super) fn flat(&self) -> &[u32] {
        &self.flat
    }

    /// The vertices around which triangles are not one fan.
    pub(super) fn pinched(&self) -> &[u32] {
        &self.pinched
    }

    /// Whether floating-point filters and expansions hold for all coordinates.
    pub(super) fn is_safe(&self) -> bool {
        self.is_safe
    }

    /// Whether it is a convex body: then its triangles have nothing in common but vertices and edges.
    pub(super) fn is_body(&self) -> bool {
        matches!(self.source, Source::Body(_))
    }

    /// Whether the triangles around a vertex are sure to have nothing in common but their edges.
    #[inline]
    pub(super) fn is_simple(&self, vertex: u32) -> bool {
        self.simple[vertex as usize]
    }

    /// The material of a triangle.
    pub(super) fn material(&self, triangle: u32) -> MaterialId {
        match &self.source {
            Source::Mesh(body) => body.material(triangle as usize),
            Source::Body(planes) => planes.of_triangle[triangle as usize].1,
            Source::Nothing => MaterialId(0),
        }
    }

    /// What of it is inside.
    pub(super) fn rule(&self) -> WindingRule {
        match &self.source {
            Source::Mesh(body) => body.rule(),
            Source::Nothing | Source::Body(_) => WindingRule::Positive,
        }
    }

    /// The plane of a triangle, of a convex body.
    #[inline]
    pub(super) fn plane(&self, triangle: u32) -> Option<PlaneId> {
        match &self.source {
            Source::Nothing | Source::Mesh(_) => None,
            Source::Body(planes) => Some(planes.of_triangle[triangle as usize].0),
        }
    }

    /// The planes that meet in a vertex, where it is not at its rounded place.
    #[inline]
    pub(super) fn meeting_at(&self, vertex: u32) -> Option<[PlaneId; 3]> {
        match &self.source {
            Source::Nothing | Source::Mesh(_) => None,
            Source::Body(planes) => planes.at_vertex[vertex as usize],
        }
    }
}

/// A box that holds corners whose rounded places another one holds.
fn grown(bounds: Bounds) -> Bounds {
    Bounds {
        min: DVec3::from_array(bounds.min.to_array().map(f64::next_down)),
        max: DVec3::from_array(bounds.max.to_array().map(f64::next_up)),
    }
}

/// Whether plain numbers show that a plane goes through a place: none of the products and sums is rounded.
fn is_surely_on(table: &PlaneTable, plane: PlaneId, at: DVec3) -> bool {
    let half_space = table.half_space(plane);
    let products = half_space.normal() * at;
    let is_exact = |k: usize| half_space.normal()[k].mul_add(at[k], -products[k]) == 0.0;
    let sum = |a: f64, b: f64| {
        let sum = a + b;
        let rest = (a - (sum - (sum - a))) + (b - (sum - a));
        (rest == 0.0).then_some(sum)
    };
    let total = sum(products.x, products.y).and_then(|sum_of_two| sum(sum_of_two, products.z));
    (0..3).all(is_exact) && total == Some(half_space.offset())
}

/// The triangles around each vertex of a mesh where it lies.
fn stars_of(body: &MeshBody) -> Cow<'_, [Star]> {
    let stars = body.mesh().stars();
    if !body.is_mirrored() {
        return Cow::Borrowed(stars);
    }
    let first = |star: &Star| if star.first == NO_TWIN { NO_TWIN } else { next(mirrored(star.first)) };
    Cow::Owned(stars.iter().map(|star| Star { first: first(star), ..*star }).collect())
}

/// Whether a walk from triangle to triangle around a vertex comes by all of them.
fn is_one_fan(twins: &[u32], star: &Star) -> bool {
    let mut half_edge = star.first;
    for steps in 1..=star.degree {
        match twins[previous(half_edge) as usize] {
            NO_TWIN => return false,
            twin if twin == star.first => return steps == star.degree,
            twin => half_edge = twin,
        }
    }
    star.degree == 0
}

/// Where a half-edge comes to lie as the second and third corner of each triangle change places.
fn mirrored(half_edge: u32) -> u32 {
    // half-edges 0, 1, 2 run between corners 0-1, 1-2, 2-0; afterwards these are 2, 1, 0
    3 * (half_edge / 3) + 2 - half_edge % 3
}

/// The twins of half-edges where the second and third corner of each triangle have changed places.
fn mirrored_twins(twins: &[u32]) -> Vec<u32> {
    let of = |half_edge: u32| match twins[mirrored(half_edge) as usize] {
        NO_TWIN => NO_TWIN,
        twin => mirrored(twin),
    };
    (0..number32(twins.len())).map(of).collect()
}
