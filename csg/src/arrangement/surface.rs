//! The triangles of operands near which something is to be done, with vertices that are joined where they are at the same place.

use glam::DVec3;
use planecut_parallel::prelude::*;
use rustc_hash::FxHashMap;

use super::contact::Contacts;
use super::exact::are_one;
use super::flat_faces::{FlatFaces, is_within_plane};
use super::hidden::Hidden;
use super::input::Input;
use super::predicates::{Corner, Triangle};
use crate::closed_mesh::connectivity::NO_TWIN;
use crate::ids::{Id, InputTriangleId, InputVertexId, PointId, TriangleId, number32};
use crate::model::MaterialId;

/// Triangles that one thread looks at in a row.
const CHUNK: usize = 1 << 14;

/// The triangles of operands that touch others, and all that share a vertex with these. All others pass through as they are, or go.
#[derive(Debug)]
pub(super) struct Surface<'a> {
    pub(super) input: &'a Input<'a>,
    pub(super) hidden: &'a Hidden,
    /// The places of vertices, correctly rounded.
    pub(super) positions: Vec<DVec3>,
    /// One of the vertices of operands that each vertex is.
    pub(super) origins: Vec<InputVertexId>,
    /// The vertices of each triangle, counter-clockwise seen from outside.
    pub(super) corners: Vec<[PointId; 3]>,
    /// For each half-edge the one that runs back along the same edge; none where there is not exactly one of both, or where that
    /// belongs to a triangle that passes through.
    pub(super) twins: Vec<u32>,
    /// The half-edges at which triangles that pass through begin, and the half-edges of these among those of the input.
    pub(super) seams: Vec<(u32, u32)>,
    /// The operand of each triangle.
    pub(super) operands: Vec<u32>,
    /// The triangles, ascending.
    numbers: Vec<InputTriangleId>,
    /// Whether floating-point filters and expansions hold for all coordinates.
    pub(super) is_safe: bool,
    /// Of several vertices at one rounded place the one before each.
    before: FxHashMap<PointId, PointId>,
    /// For each vertex of the input whether all of its triangles are here.
    is_core: Vec<bool>,
    /// For each vertex of the input one more than its number here, or 0.
    vertex_number: Vec<u32>,
    /// The same for triangles.
    triangle_number: Vec<u32>,
}

impl<'a> Surface<'a> {
    /// The triangles that contacts name, and those around their vertices, but for those that are hidden.
    pub(super) fn new(input: &'a Input<'a>, contacts: &Contacts, faces: &FlatFaces<'_>, hidden: &'a Hidden) -> Self {
        let is_core = core_vertices(input, contacts, faces);
        let mut surface = Self {
            input,
            hidden,
            positions: Vec::new(),
            origins: Vec::new(),
            corners: Vec::new(),
            twins: Vec::new(),
            seams: Vec::new(),
            operands: Vec::new(),
            numbers: Vec::new(),
            is_safe: input.is_safe,
            before: FxHashMap::default(),
            is_core,
            vertex_number: vec![0; input.vertex_count()],
            triangle_number: vec![0; input.triangle_count()],
        };
        surface.take_triangles();
        surface.join_vertices();
        surface.link();
        surface
    }

    /// The triangles with a vertex all of whose triangles are to be here.
    fn take_triangles(&mut self) {
        let Self { input, hidden, is_core, .. } = self;
        for (operand, own) in input.operands.iter().enumerate() {
            let first = input.vertex(operand, 0).index();
            let core = &is_core[first..first + own.positions().len()];
            let is_taken = |triangle: &u32| {
                own.triangles()[*triangle as usize].iter().any(|v| core[*v as usize])
                    && !hidden.has(input.number(operand, *triangle))
            };
            let all = (0..number32(own.triangles().len())).into_par_iter().with_min_len(CHUNK);
            let taken: Vec<u32> = all.filter(is_taken).collect();
            self.operands.extend(std::iter::repeat_n(number32(operand), taken.len()));
            self.numbers.extend(taken.into_iter().map(|triangle| input.number(operand, triangle)));
        }
        for (number, triangle) in (1..).zip(&self.numbers) {
            self.triangle_number[triangle.index()] = number;
        }
    }

    /// Numbers the vertices of all triangles; those at one place get one number.
    fn join_vertices(&mut self) {
        let mut at_place = FxHashMap::default();
        at_place.reserve(self.numbers.len());
        for k in 0..self.numbers.len() {
            let triangle = self.triangle(TriangleId::from_index(k));
            let corners = triangle.corners.map(|corner| match self.vertex_number[corner.vertex.index()] {
                0 => {
                    let point = self.vertex_at(&corner, &mut at_place);
                    self.vertex_number[corner.vertex.index()] = point.number() + 1;
                    point
                }
                known => PointId::from_index(known as usize - 1),
            });
            self.corners.push(corners);
        }
    }

    /// The number of a vertex: that of one at the same place, where there is one. `at_place` has the last vertex at each rounded
    /// place.
    fn vertex_at(&mut self, corner: &Corner, at_place: &mut FxHashMap<[u64; 3], PointId>) -> PointId {
        let fresh = PointId::from_index(self.positions.len());
        let key = (corner.at + 0.0).to_array().map(f64::to_bits);
        let last = *at_place.entry(key).or_insert(fresh);
        if last != fresh {
            // corners of bodies may differ there
            let mut there = Some(last);
            while let Some(known) = there {
                if are_one(self.input, self.origins[known.index()], corner.vertex) {
                    return known;
                }
                there = self.before.get(&known).copied();
            }
            self.before.insert(fresh, last);
            at_place.insert(key, fresh);
        }
        self.positions.push(corner.at);
        self.origins.push(corner.vertex);
        fresh
    }

    fn link(&mut self) {
        let Self { input, hidden, numbers, operands, triangle_number, .. } = self;
        for (k, (triangle, operand)) in numbers.iter().zip(&*operands).enumerate() {
            let operand = *operand as usize;
            let own = triangle.number() - input.number(operand, 0).number();
            for side in 0..3 {
                let half_edge = 3 * number32(k) + side;
                let twin = match input.operands[operand].twins()[(3 * own + side) as usize] {
                    NO_TWIN => NO_TWIN,
                    twin => {
                        let twin = input.half_edge(operand, twin);
                        match triangle_number[twin as usize / 3] {
                            0 if hidden.has(InputTriangleId::from_index(twin as usize / 3)) => NO_TWIN,
                            0 => {
                                self.seams.push((half_edge, twin));
                                NO_TWIN
                            }
                            number => 3 * (number - 1) + twin % 3,
                        }
                    }
                };
                self.twins.push(twin);
            }
        }
    }

    /// The operand of a half-edge, and its number there.
    #[inline]
    pub(super) fn in_operand(&self, half_edge: u32) -> (usize, u32) {
        let triangle = half_edge as usize / 3;
        let operand = self.operands[triangle] as usize;
        let own = self.numbers[triangle].number() - self.input.number(operand, 0).number();
        (operand, 3 * own + half_edge % 3)
    }

    /// Half-edges, each the smaller one of two along an edge, with triangles of one plane on both sides.
    pub(super) fn flat_edges(&self) -> Vec<u32> {
        let is_flat = |half_edge: &u32| {
            let twin = self.twins[*half_edge as usize];
            twin != NO_TWIN && *half_edge < twin && {
                let (operand, own) = self.in_operand(*half_edge);
                is_within_plane(self.input, operand, own)
            }
        };
        (0..number32(self.twins.len())).into_par_iter().with_min_len(CHUNK).filter(is_flat).collect()
    }

    /// The number of triangles.
    pub(super) fn len(&self) -> usize {
        self.corners.len()
    }

    /// The number that a triangle has in the input.
    pub(super) fn number(&self, triangle: TriangleId) -> InputTriangleId {
        self.numbers[triangle.index()]
    }

    /// A triangle of the input that is here.
    pub(super) fn triangle_of(&self, triangle: InputTriangleId) -> TriangleId {
        TriangleId::from_index(self.triangle_number[triangle.index()] as usize - 1)
    }

    /// Whether a triangle of the input is here.
    #[inline]
    pub(super) fn has(&self, triangle: InputTriangleId) -> bool {
        self.triangle_number[triangle.index()] > 0
    }

    /// The number here of a vertex of the input that is a corner of some triangle here.
    pub(super) fn vertex_of(&self, vertex: InputVertexId) -> PointId {
        PointId::from_index(self.vertex_number[vertex.index()] as usize - 1)
    }

    /// Whether all triangles at a vertex of the input are here.
    pub(super) fn is_core(&self, vertex: InputVertexId) -> bool {
        self.is_core[vertex.index()]
    }

    /// A half-edge of the input among those of the triangles here.
    pub(super) fn half_edge_of(&self, half_edge: u32) -> u32 {
        let triangle = self.triangle_of(InputTriangleId::from_index(half_edge as usize / 3));
        3 * triangle.number() + half_edge % 3
    }

    /// The place of a vertex.
    #[inline]
    pub(super) fn at(&self, vertex: PointId) -> DVec3 {
        self.positions[vertex.index()]
    }

    /// A vertex as one of the input.
    #[inline]
    pub(super) fn corner(&self, vertex: PointId) -> Corner {
        Corner { vertex: self.origins[vertex.index()], at: self.at(vertex) }
    }

    /// Whether a vertex is at its place, not just near it.
    #[inline]
    pub(super) fn is_where_it_is_said(&self, vertex: PointId) -> bool {
        self.input.is_where_it_is_said(self.origins[vertex.index()])
    }

    /// The vertices of a triangle.
    #[inline]
    pub(super) fn corners(&self, triangle: TriangleId) -> [PointId; 3] {
        self.corners[triangle.index()]
    }

    /// A triangle as one of the input.
    #[inline]
    pub(super) fn triangle(&self, triangle: TriangleId) -> Triangle {
        let (operand, number) = (self.operands[triangle.index()] as usize, self.numbers[triangle.index()]);
        self.input.triangle(operand, number.number() - self.input.number(operand, 0).number())
    }

    /// The material of a triangle.
    pub(super) fn material(&self, triangle: TriangleId) -> MaterialId {
        let (operand, number) = self.input.of_triangle(self.numbers[triangle.index()]);
        self.input.operands[operand].material(number)
    }

    /// The ends of an edge of a triangle, the smaller one first.
    #[inline]
    pub(super) fn edge(&self, triangle: TriangleId, side: usize) -> [PointId; 2] {
        let corners = self.corners(triangle);
        sorted(corners[side], corners[(side + 1) % 3])
    }
}

/// The vertices of triangles that touch others or have no area, and those where the triangles of an operand are not one fan.
fn core_vertices(input: &Input<'_>, contacts: &Contacts, faces: &FlatFaces<'_>) -> Vec<bool> {
    let mut is_core = vec![false; input.vertex_count()];
    let mut take = |operand: usize, triangle: u32| {
        for vertex in input.operands[operand].triangles()[triangle as usize] {
            is_core[input.vertex(operand, vertex).index()] = true;
        }
    };
    let of_pairs = [&contacts.pairs, &contacts.coplanar, &contacts.overlapping];
    let of_cuts = contacts.cuts.iter().flat_map(|cut| [cut.triangle, cut.other]);
    let all = of_pairs.into_iter().flat_map(|pairs| pairs.as_flattened()).copied();
    for triangle in all.chain(of_cuts).chain(contacts.touched.iter().copied()) {
        let (operand, triangle) = input.of_triangle(triangle);
        take(operand, triangle);
    }
    // of faces upon each other not every triangle need be named
    for triangle in faces.overlapping(&contacts.overlapping, &contacts.identical) {
        let (operand, triangle) = input.of_triangle(triangle);
        take(operand, triangle);
    }
    for cut in &contacts.edge_cuts {
        let (operand, triangle) = input.of_triangle(InputTriangleId::from_index(cut.side as usize / 3));
        take(operand, triangle);
        let twin = input.operands[operand].twins()[3 * triangle as usize + cut.side as usize % 3];
        if twin != NO_TWIN {
            take(operand, twin / 3);
        }
    }
    for (operand, own) in input.operands.iter().enumerate() {
        for triangle in own.flat() {
            take(operand, *triangle);
        }
        for (triangle, _) in (0..).zip(own.twins().chunks(3)).filter(|(_, twins)| twins.contains(&NO_TWIN)) {
            take(operand, triangle);
        }
    }
    for (operand, own) in input.operands.iter().enumerate() {
        for vertex in own.pinched() {
            is_core[input.vertex(operand, *vertex).index()] = true;
        }
    }
    is_core
}

/// Two numbers in ascending order.
#[inline]
pub(super) fn sorted<T: Ord>(a: T, b: T) -> [T; 2] {
    if a < b { [a, b] } else { [b, a] }
}
