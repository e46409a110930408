//! Where two triangles touch: signs of their vertices against each other's planes tell (Guigue and Devillers 2003).

use planecut_kernel::DVec3;
use planecut_kernel::sign::Sign;

use super::coplanar;
use super::exact::are_one;
use super::flat_faces::FlatFaces;
use super::input::Input;
use super::pairs::Probe;
use super::points::Key;
use super::predicates::{Corner, orient};
use super::surface::sorted;
use crate::ids::{Id, InputTriangleId, InputVertexId, number32};

/// What defines a point, in numbers of the input.
pub(super) type InputKey = Key<InputVertexId, InputTriangleId>;

/// Where in a triangle a point lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    Vertex(usize),
    /// Inside the edge that begins at a corner.
    Edge(usize),
    Inside,
}

impl Place {
    /// Whether a point lies on an edge, ends included.
    pub(super) fn is_on(self, edge: usize) -> bool {
        match self {
            Self::Vertex(k) => k == edge || k == (edge + 1) % 3,
            Self::Edge(k) => k == edge,
            Self::Inside => false,
        }
    }

    /// The edge on which two points lie.
    pub(super) fn shared_edge(self, other: Self) -> Option<usize> {
        (0..3).find(|edge| self.is_on(*edge) && other.is_on(*edge))
    }
}

/// A point in which two triangles touch, and where in each it lies.
#[derive(Debug, Clone, Copy)]
pub(super) struct Touch {
    pub(super) key: InputKey,
    pub(super) places: [Place; 2],
}

/// A segment within a triangle, along which it is to be cut. Its ends are one point where the other triangle just touches this one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cut {
    pub(super) triangle: InputTriangleId,
    /// The triangle that it comes from.
    pub(super) other: InputTriangleId,
    /// The edge of the other triangle that it lies on.
    pub(super) edge: Option<[InputVertexId; 2]>,
    pub(super) ends: [InputKey; 2],
}

/// A point inside an edge, at which it is to be cut.
#[derive(Debug, Clone, Copy)]
pub(super) struct EdgeCut {
    /// A half-edge along it.
    pub(super) side: u32,
    /// The triangle that cuts it.
    pub(super) other: InputTriangleId,
    pub(super) key: InputKey,
}

/// A segment along an edge of a triangle, which is no cut of that.
#[derive(Debug, Clone, Copy)]
pub(super) struct Along {
    /// A half-edge along it.
    pub(super) side: u32,
    /// The triangle that it comes from.
    pub(super) other: InputTriangleId,
    /// The edge of the other triangle that it lies on.
    pub(super) edge: Option<[InputVertexId; 2]>,
    pub(super) ends: [InputKey; 2],
}

/// What pairs of triangles have in common.
#[derive(Debug, Default)]
pub(super) struct Contacts {
    pub(super) cuts: Vec<Cut>,
    pub(super) edge_cuts: Vec<EdgeCut>,
    pub(super) along: Vec<Along>,
    /// Half-edges of triangles that are not neighbours, along an edge between the same two vertices.
    pub(super) shared_edges: Vec<[u32; 2]>,
    /// Triangles whose edges other surfaces share.
    pub(super) touched: Vec<InputTriangleId>,
    /// Triangles that have more in common than vertices and edges of a mesh.
    pub(super) pairs: Vec<[InputTriangleId; 2]>,
    /// Triangles in one plane that share a part of it, at least a point.
    pub(super) coplanar: Vec<[InputTriangleId; 2]>,
    /// Those of them that share an area.
    pub(super) overlapping: Vec<[InputTriangleId; 2]>,
    /// Those of these that have the same corners.
    pub(super) identical: Vec<[InputTriangleId; 2]>,
}

impl Contacts {
    /// What triangles of some kind have in common, of all parts, one after the other.
    pub(super) fn joined(parts: &[Self], is_one: impl Fn(InputTriangleId) -> bool) -> Self {
        let is_pair = |[one, other]: [InputTriangleId; 2]| is_one(one) && is_one(other);
        let of_side = |side: u32| InputTriangleId::from_index(side as usize / 3);
        Self {
            cuts: joined(parts, |part| &part.cuts, |cut| is_pair([cut.triangle, cut.other])),
            edge_cuts: joined(parts, |part| &part.edge_cuts, |cut| is_pair([of_side(cut.side), cut.other])),
            along: joined(parts, |part| &part.along, |along| is_pair([of_side(along.side), along.other])),
            shared_edges: joined(parts, |part| &part.shared_edges, |sides| is_pair(sides.map(of_side))),
            touched: joined(parts, |part| &part.touched, |triangle| is_one(*triangle)),
            pairs: joined(parts, |part| &part.pairs, |pair| is_pair(*pair)),
            coplanar: joined(parts, |part| &part.coplanar, |pair| is_pair(*pair)),
            overlapping: joined(parts, |part| &part.overlapping, |pair| is_pair(*pair)),
            identical: joined(parts, |part| &part.identical, |pair| is_pair(*pair)),
        }
    }

    /// Takes a segment that a triangle has in common with another one: a cut, unless it runs along a side of the triangle.
    pub(super) fn divide(&mut self, cut: Cut, side: Option<usize>) {
        let Cut { triangle, other, edge, ends } = cut;
        match side {
            None => self.cuts.push(cut),
            Some(side) => self.along.push(Along { side: half_edge(triangle, side), other, edge, ends }),
        }
    }

    /// Edges are cut at a point that lies inside of them.
    pub(super) fn cut_edges(&mut self, pair: &Pair<'_>, touch: &Touch) {
        for (k, place) in touch.places.into_iter().enumerate() {
            if let Place::Edge(side) = place {
                let (side, other) = (half_edge(pair.number(k), side), pair.number(1 - k));
                self.edge_cuts.push(EdgeCut { side, other, key: touch.key });
            }
        }
    }
}

/// What a list of each part has of some kind; it grows once, since moving what was found takes longer than finding it.
fn joined<T: Copy>(parts: &[Contacts], list: impl Fn(&Contacts) -> &Vec<T>, is_one: impl Fn(&T) -> bool) -> Vec<T> {
    let mut all = Vec::with_capacity(parts.iter().map(|part| list(part).len()).sum());
    parts.iter().for_each(|part| all.extend(list(part).iter().filter(|item| is_one(item))));
    all
}

/// The half-edge of a triangle that begins at a corner.
pub(super) fn half_edge(triangle: InputTriangleId, side: usize) -> u32 {
    3 * triangle.number() + number32(side)
}

/// Two triangles that are compared.
pub(super) struct Pair<'a> {
    pub(super) input: &'a Input<'a>,
    probes: [&'a Probe; 2],
    /// The corners of each; those at the same place have the number of the first triangle's.
    pub(super) corners: [[Corner; 3]; 2],
    /// For each corner of the first the place of its like in the second.
    like: [Option<usize>; 3],
}

impl<'a> Pair<'a> {
    fn new(input: &'a Input<'a>, probes: [&'a Probe; 2]) -> Self {
        let mut corners = probes.map(|probe| probe.triangle.corners);
        let [first, second] = &mut corners;
        let is_one =
            |a: &Corner, b: &Corner| a.vertex == b.vertex || a.at == b.at && are_one(input, a.vertex, b.vertex);
        let like = first.map(|corner| second.iter().position(|other| is_one(&corner, other)));
        for (corner, like) in first.iter().zip(like) {
            if let Some(like) = like {
                second[like] = *corner;
            }
        }
        Self { input, probes, corners, like }
    }

    /// The number of a triangle.
    pub(super) fn number(&self, k: usize) -> InputTriangleId {
        self.probes[k].triangle.number
    }

    pub(super) fn numbers(&self) -> [InputTriangleId; 2] {
        [0, 1].map(|k| self.number(k))
    }

    /// The ends of an edge of a triangle, the smaller one first.
    pub(super) fn edge(&self, k: usize, side: usize) -> [InputVertexId; 2] {
        sorted(self.corners[k][side].vertex, self.corners[k][(side + 1) % 3].vertex)
    }

    /// Whether a vertex is a corner of a triangle.
    fn has(&self, k: usize, corner: &Corner) -> bool {
        self.corners[k].iter().any(|own| own.vertex == corner.vertex)
    }

    /// On which side of the plane of a triangle a corner of the other one lies.
    fn side(&self, plane: usize, corner: usize) -> Sign {
        let corner = &self.corners[1 - plane][corner];
        if self.has(plane, corner) { Sign::Zero } else { self.probes[plane].plane.side(self.input, corner) }
    }

    /// Whether triangles that share a vertex are sure to lie on different sides of a plane through it, perpendicular to the difference of
    /// their directions from there.
    fn are_apart(&self) -> bool {
        let Some(first) = self.like.iter().position(Option::is_some) else { return false };
        let places = [first, self.like[first].unwrap_or(0)];
        let at = self.corners[0][first].at;
        let along = [0, 1].map(|k| [1, 2].map(|j| self.corners[k][(places[k] + j) % 3].at - at));
        let direction =
            |[p, q]: [DVec3; 2]| (p / p.abs().max_element() + q / q.abs().max_element()).normalize_or_zero();
        let across = direction(along[0]) - direction(along[1]);
        // the shared vertex is exact, each difference off by half a unit in the last place, as is each product
        let height = |p: DVec3| across.dot(p) / (across.abs().dot(p.abs()) * 8.0 * f64::EPSILON);
        let is_known = self.input.is_safe && !self.input.has_bodies;
        is_known && along[0].iter().all(|p| height(*p) > 1.0) && along[1].iter().all(|p| height(*p) < -1.0)
    }

    /// Whether triangles one of which has corners nearly in the plane of the other, as neighbours of large flat faces have, are sure to lie
    /// side by side.
    fn are_side_by_side(&self) -> bool {
        let [one, other] = self.probes;
        let is_near = |k: usize| {
            let is_uncertain =
                |corner: &Corner| !self.has(k, corner) && !self.probes[k].plane.is_sure_of(self.input, corner);
            self.corners[1 - k].iter().any(is_uncertain)
        };
        (is_near(0) || is_near(1))
            && (one.plane.has_beyond_an_edge(self.input, &self.corners[1])
                || other.plane.has_beyond_an_edge(self.input, &self.corners[0]))
    }
}

/// Finds what two triangles have in common. Where the flat faces of operands are given, nothing need be told of triangles of one plane
/// no edge of whose faces is near.
pub(super) fn touch(input: &Input<'_>, probes: [&Probe; 2], faces: Option<&FlatFaces<'_>>, out: &mut Contacts) {
    let pair = Pair::new(input, probes);
    match pair.like.iter().flatten().count() {
        3 => {
            out.coplanar.push(pair.numbers());
            out.overlapping.push(pair.numbers());
            out.identical.push(pair.numbers());
            out.pairs.push(pair.numbers());
            return;
        }
        2 => return share_edge(&pair, out),
        1 if pair.are_apart() => return,
        _ => {}
    }
    if pair.are_side_by_side() {
        return;
    }
    let [one, other] = probes;
    if one.is_in_plane_of_axes(input, other) {
        return coplanar::touch(&pair, out);
    }
    let of_second = [0, 1, 2].map(|k| pair.side(0, k));
    if all_on_one_side(of_second) {
        return;
    }
    if of_second == [Sign::Zero; 3] {
        if faces.is_none_or(|faces| one.has_edges_near(input, other, faces)) {
            coplanar::touch(&pair, out);
        }
        return;
    }
    let of_first = [0, 1, 2].map(|k| pair.side(1, k));
    if all_on_one_side(of_first) {
        return;
    }
    let line = Line { pair: &pair, signs: [of_first, of_second] };
    let Some(ends) = line.common() else { return };
    add(&pair, ends, out);
}

fn all_on_one_side(signs: [Sign; 3]) -> bool {
    signs[0] != Sign::Zero && signs[0] == signs[1] && signs[1] == signs[2]
}

/// What two triangles have in common whose planes meet in a line.
fn add(pair: &Pair<'_>, ends: [Touch; 2], out: &mut Contacts) {
    let corners = &pair.corners;
    let is_point = ends[0].key == ends[1].key;
    let is_shared = |touch: &Touch| matches!(touch.places, [Place::Vertex(j), Place::Vertex(k)] if corners[0][j].vertex == corners[1][k].vertex);
    if is_point && is_shared(&ends[0]) {
        return;
    }
    out.pairs.push(pair.numbers());
    for end in &ends[..if is_point { 1 } else { 2 }] {
        out.cut_edges(pair, end);
    }
    for k in 0..2 {
        let (triangle, other) = (pair.number(k), pair.number(1 - k));
        if is_point {
            // other cuts may go through it
            if ends[0].places[k] == Place::Inside {
                out.cuts.push(Cut { triangle, other, edge: None, ends: [ends[0].key; 2] });
            }
            continue;
        }
        out.touched.push(triangle);
        let shared_edge = |k: usize| ends[0].places[k].shared_edge(ends[1].places[k]);
        let edge = shared_edge(1 - k).map(|edge| pair.edge(1 - k, edge));
        let ends = ends.map(|end| end.key);
        out.divide(Cut { triangle, other, edge, ends }, shared_edge(k));
    }
}

/// Triangles that share an edge: nothing else, unless they are folded upon each other.
fn share_edge(pair: &Pair<'_>, out: &mut Contacts) {
    let apex = pair.like.iter().position(Option::is_none).expect("two vertices are shared");
    let side = (apex + 1) % 3;
    let other = (0..3).find(|k| !pair.like.contains(&Some(*k))).expect("two vertices are shared");
    if !pair.probes[0].is_neighbour(side, pair.probes[1]) {
        out.touched.extend(pair.numbers());
        out.shared_edges.push([half_edge(pair.number(0), side), half_edge(pair.number(1), (other + 1) % 3)]);
    }
    let plane = &pair.probes[0].plane;
    if plane.tells_apart(pair.input, side, pair.corners[1][other].at) || pair.side(0, other) != Sign::Zero {
        return;
    }
    coplanar::touch(pair, out);
}

/// An end of what a triangle has in common with the line in which two planes meet.
#[derive(Debug, Clone, Copy)]
struct End {
    place: Place,
    /// An edge through that end that does not lie in the other plane.
    edge: usize,
}

/// The line in which the planes of two triangles meet.
struct Line<'a> {
    pair: &'a Pair<'a>,
    /// On which side of the other's plane the corners of each lie.
    signs: [[Sign; 3]; 2],
}

impl Line<'_> {
    /// The ends of what both triangles have in common.
    fn common(&self) -> Option<[Touch; 2]> {
        let [low, high] = self.ends(0);
        let [other_low, other_high] = self.ends(1);
        let at_point = |places| Some([self.touch(places); 2]);
        match (self.is_before(&low, &other_high), self.is_before(&high, &other_low)) {
            (Sign::Negative, _) | (_, Sign::Positive) => return None,
            (Sign::Zero, _) => return at_point([low.place, other_high.place]),
            (_, Sign::Zero) => return at_point([high.place, other_low.place]),
            _ => {}
        }
        let along = [0, 1]
            .map(|k| (0..3).find(|j| self.signs[k][*j] == Sign::Zero && self.signs[k][(j + 1) % 3] == Sign::Zero));
        let of = |k: usize, end: &End| {
            let within = along[1 - k].map_or(Place::Inside, Place::Edge);
            self.touch(if k == 0 { [end.place, within] } else { [within, end.place] })
        };
        let start = match self.is_before(&low, &other_low) {
            Sign::Positive => of(1, &other_low),
            Sign::Negative => of(0, &low),
            Sign::Zero => self.touch([low.place, other_low.place]),
        };
        let end = match self.is_before(&high, &other_high) {
            Sign::Positive => of(0, &high),
            Sign::Negative => of(1, &other_high),
            Sign::Zero => self.touch([high.place, other_high.place]),
        };
        Some([start, end])
    }

    /// The ends of what a triangle has in common with the line, in the direction of the cross product of both normals.
    ///
    /// Seen with its normal towards the viewer and the line to the right, the positive side of the first triangle is below, that of
    /// the second above; so counter-clockwise the first goes from negative to positive on the left, the second on the right.
    fn ends(&self, k: usize) -> [End; 2] {
        let signs = if k == 0 { self.signs[0] } else { self.signs[1].map(Sign::flip) };
        let mut ends: [Option<End>; 2] = [None; 2];
        for j in 0..3 {
            let (before, this, after) = (signs[(j + 2) % 3], signs[j], signs[(j + 1) % 3]);
            if this == Sign::Zero {
                let edge = if after == Sign::Zero { (j + 2) % 3 } else { j };
                let end = Some(End { place: Place::Vertex(j), edge });
                if after == Sign::Positive || before == Sign::Negative {
                    ends[0] = end;
                }
                if before == Sign::Positive || after == Sign::Negative {
                    ends[1] = end;
                }
            } else if after == this.flip() {
                ends[usize::from(this == Sign::Positive)] = Some(End { place: Place::Edge(j), edge: j });
            }
        }
        ends.map(|end| end.expect("a triangle that meets a plane has two ends there"))
    }

    /// Positive where an end of the first triangle comes before one of the second, zero where they are at one place.
    fn is_before(&self, end: &End, other: &End) -> Sign {
        let [e, f] = [(0, end.edge), (1, other.edge)].map(|(k, j)| {
            let (from, to) = (j, (j + 1) % 3);
            let ends = [self.pair.corners[k][from], self.pair.corners[k][to]];
            if self.signs[k][from] < self.signs[k][to] { ends } else { [ends[1], ends[0]] }
        });
        if e.iter().any(|corner| f.iter().any(|other| other.vertex == corner.vertex)) {
            return Sign::Zero;
        }
        orient(self.pair.input, [e[0], e[1], f[0], f[1]])
    }

    /// The point at given places in both triangles.
    fn touch(&self, places: [Place; 2]) -> Touch {
        Touch { key: self.key(places), places }
    }

    fn key(&self, places: [Place; 2]) -> InputKey {
        let Pair { corners, .. } = self.pair;
        let edge = |k: usize, side: usize| self.pair.edge(k, side);
        match places {
            [Place::Vertex(j), _] => Key::Vertex(corners[0][j].vertex),
            [_, Place::Vertex(j)] => Key::Vertex(corners[1][j].vertex),
            [Place::Edge(i), Place::Edge(j)] => Key::of_edges(edge(0, i), edge(1, j)),
            [Place::Edge(i), Place::Inside] => Key::EdgePlane { edge: edge(0, i), triangle: self.pair.number(1) },
            [Place::Inside, Place::Edge(j)] => Key::EdgePlane { edge: edge(1, j), triangle: self.pair.number(0) },
            [Place::Inside, Place::Inside] => unreachable!("an end lies on an edge of one triangle"),
        }
    }
}
