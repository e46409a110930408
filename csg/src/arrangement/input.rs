//! All operands of an arrangement, their vertices and triangles numbered one operand after another.

use std::sync::OnceLock;

use glam::DVec3;
use planecut_kernel::{HalfSpace, decompose};
use planecut_parallel::prelude::*;

use super::flat::are_nearly_coplanar;
use super::operand::Operand;
use super::predicates::{Corner, Triangle};
use crate::ids::{Id, InputTriangleId, InputVertexId, number32};
use crate::plane_table::{PlaneId, PlaneTable};

/// Vertices that one thread looks at in a row.
const CHUNK: usize = 1 << 14;

/// All operands of an arrangement.
#[derive(Debug)]
pub(super) struct Input<'a> {
    pub(super) operands: Vec<Operand<'a>>,
    /// The first vertex and triangle of each operand, and those after the last.
    first_vertex: Vec<u32>,
    first_triangle: Vec<u32>,
    /// Whether floating-point filters and expansions hold for all coordinates.
    pub(super) is_safe: bool,
    /// Whether some operands are convex bodies, whose corners are known by their planes.
    pub(super) has_bodies: bool,
    /// The planes of these bodies.
    table: Option<&'a PlaneTable>,
    /// The exponent of the smallest unit of any coordinate.
    lowest: OnceLock<i32>,
}

impl<'a> Input<'a> {
    /// Operands; `table` has the planes of those that are convex bodies.
    pub(super) fn new(operands: Vec<Operand<'a>>, table: Option<&'a PlaneTable>) -> Self {
        let starts = |count: &dyn Fn(&Operand<'a>) -> usize| {
            let mut sum = 0;
            let mut starts = vec![0];
            for operand in &operands {
                sum += count(operand);
                starts.push(number32(sum));
            }
            starts
        };
        let first_vertex = starts(&|operand| operand.positions().len());
        let first_triangle = starts(&|operand| operand.triangles().len());
        let is_safe = operands.iter().all(Operand::is_safe);
        let has_bodies = operands.iter().any(Operand::is_body);
        Self { operands, first_vertex, first_triangle, is_safe, has_bodies, table, lowest: OnceLock::new() }
    }

    /// The number of triangles of all operands.
    pub(super) fn triangle_count(&self) -> usize {
        self.first_triangle.last().map_or(0, |count| *count as usize)
    }

    /// The number of vertices of all operands.
    pub(super) fn vertex_count(&self) -> usize {
        self.first_vertex.last().map_or(0, |count| *count as usize)
    }

    /// A vertex of an operand by its number there.
    #[inline]
    pub(super) fn vertex(&self, operand: usize, vertex: u32) -> InputVertexId {
        InputVertexId::from_index((self.first_vertex[operand] + vertex) as usize)
    }

    /// A triangle of an operand by its number there.
    #[inline]
    pub(super) fn number(&self, operand: usize, triangle: u32) -> InputTriangleId {
        InputTriangleId::from_index((self.first_triangle[operand] + triangle) as usize)
    }

    /// The operand of a triangle, and its number there.
    pub(super) fn of_triangle(&self, triangle: InputTriangleId) -> (usize, u32) {
        place(&self.first_triangle, triangle.number())
    }

    /// The operand of a vertex, and its number there.
    pub(super) fn of_vertex(&self, vertex: InputVertexId) -> (usize, u32) {
        place(&self.first_vertex, vertex.number())
    }

    /// A triangle of an operand.
    #[inline]
    pub(super) fn triangle(&self, operand: usize, triangle: u32) -> Triangle {
        let own = &self.operands[operand];
        let corners = own.triangles()[triangle as usize];
        let corner =
            |vertex: u32| Corner { vertex: self.vertex(operand, vertex), at: own.positions()[vertex as usize] };
        Triangle { number: self.number(operand, triangle), corners: corners.map(corner) }
    }

    /// The half-edge, among those of all operands, that runs back along a half-edge of one operand.
    pub(super) fn half_edge(&self, operand: usize, half_edge: u32) -> u32 {
        3 * self.first_triangle[operand] + half_edge
    }

    /// The place of a vertex, correctly rounded.
    pub(super) fn at(&self, vertex: InputVertexId) -> DVec3 {
        let (operand, vertex) = self.of_vertex(vertex);
        self.operands[operand].positions()[vertex as usize]
    }

    /// The plane of a triangle of a convex body.
    #[inline]
    pub(super) fn plane(&self, triangle: InputTriangleId) -> Option<PlaneId> {
        if !self.has_bodies {
            return None;
        }
        let (operand, triangle) = self.of_triangle(triangle);
        self.operands[operand].plane(triangle)
    }

    /// The half-space of a triangle of a convex body.
    #[inline]
    pub(super) fn half_space(&self, triangle: InputTriangleId) -> Option<&HalfSpace> {
        let plane = self.plane(triangle)?;
        self.table.map(|table| table.half_space(plane))
    }

    /// The half-spaces whose planes meet in a vertex, where it is not at its place because that is rounded.
    pub(super) fn meeting_at(&self, vertex: InputVertexId) -> Option<[&HalfSpace; 3]> {
        if !self.has_bodies {
            return None;
        }
        let (operand, vertex) = self.of_vertex(vertex);
        let planes = self.operands[operand].meeting_at(vertex)?;
        self.table.map(|table| planes.map(|plane| table.half_space(plane)))
    }

    /// Whether a vertex is at its place, not just near it.
    pub(super) fn is_where_it_is_said(&self, vertex: InputVertexId) -> bool {
        self.meeting_at(vertex).is_none()
    }

    /// The unit normal of a triangle, or of the same turned over.
    pub(super) fn normal(&self, triangle: &Triangle, is_flipped: bool) -> DVec3 {
        let normal = match self.half_space(triangle.number) {
            Some(half_space) => unit(half_space.normal()),
            None => normal_of(triangle.places()),
        };
        if is_flipped { -normal } else { normal }
    }

    /// Whether two triangles of one mesh may lie in one plane but for the rounding of their corners.
    pub(super) fn are_nearly_coplanar(&self, [one, other]: [&Triangle; 2]) -> bool {
        let is_mesh = || !self.operands[self.of_triangle(one.number).0].is_body();
        let [a, b, c] = one.places();
        is_mesh() && other.places().iter().all(|corner| are_nearly_coplanar([a, b, c, *corner]))
    }

    /// The exponent of the smallest unit of any coordinate: all are integers in it.
    pub(super) fn lowest(&self) -> i32 {
        *self.lowest.get_or_init(|| {
            let unit = |v: f64| if v == 0.0 { i32::MAX } else { decompose(v).1 };
            let of_place = |p: &DVec3| unit(p.x).min(unit(p.y)).min(unit(p.z));
            let of_chunk = |chunk: &[DVec3]| chunk.iter().map(of_place).min().unwrap_or(i32::MAX);
            let of_operand = |operand: &Operand<'_>| {
                let of_chunks: Vec<i32> = operand.positions().par_chunks(CHUNK).map(of_chunk).collect();
                of_chunks.into_iter().min().unwrap_or(i32::MAX)
            };
            let lowest = self.operands.iter().map(of_operand).min().unwrap_or(i32::MAX);
            if lowest == i32::MAX { 0 } else { lowest }
        })
    }
}

/// Which of some ranges, given by where they start, holds a number; and its place there.
fn place(starts: &[u32], number: u32) -> (usize, u32) {
    let range = starts.partition_point(|start| *start <= number) - 1;
    (range, number - starts[range])
}

/// The unit normal of a triangle; of lengths whose products neither overflow nor vanish.
pub(super) fn normal_of([a, b, c]: [DVec3; 3]) -> DVec3 {
    let (p, q) = (b - a, c - a);
    let normal = p.cross(q);
    let length = normal.length_squared();
    if (1e-200..1e200).contains(&length) {
        return normal / length.sqrt();
    }
    unit((p / p.abs().max_element()).cross(q / q.abs().max_element()))
}

fn unit(normal: DVec3) -> DVec3 {
    (normal / normal.abs().max_element()).normalize_or(DVec3::Z)
}
