//! The constrained Delaunay triangulation of a face, kept as its boundary changes.
//!
//! Sites are the corners of the face, constraints its boundary; what lies outside is triangulated as well, up to a triangle around
//! all sites. Between sites on one circle a perturbation decides ([`predicates`]), so the triangulation is a function
//! of sites and constraints alone: whatever changes led to it, it is that of a fresh build. Sites come, go and are joined one by one, each at the
//! cost of the triangles around it (de Berg et al., "Computational Geometry", chapter 9; Sloan 1993 for constraints;
//! Devillers 2002 for removal).
//!
//! Coordinates are the rounded ones. Where rounding has made two corners one, or boundary edges cross, there is no such
//! triangulation: that is a [`Conflict`], and depends on sites and constraints alone, too.

mod constraint;
mod flip;
mod insert;
mod locate;
mod move_sites;
mod predicates;
mod remove;
mod zone;

use planecut_kernel::DVec2;

use crate::closed_mesh::connectivity::{next, previous};
use crate::ids::{HalfEdgeId, Id, SiteId, number32};

/// No half-edge.
const NONE: u32 = u32::MAX;

/// A half-edge without a site at its start: that of a triangle that is free.
const FREE: SiteId = SiteId::NONE;

/// The first sites are the corners of the triangle around all others.
const OUTER: usize = 3;

/// Rounded coordinates for which there is no triangulation: two sites in one place, a constraint that crosses another one or passes a site, or
/// coordinates so large or small that a determinant of them leaves the range of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Conflict;

/// What bounds a triangle on one side.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    /// A diagonal.
    Free,
    /// A boundary edge, of which the face lies on this side.
    Inner(HalfEdgeId),
    /// The other side of a boundary edge.
    Outer,
}

#[derive(Debug, Clone, Copy)]
struct Site {
    at: DVec2,
    /// A half-edge that begins there.
    leaving: u32,
    /// How many boundary edges begin there, and one of them.
    pieces: u32,
    piece: HalfEdgeId,
}

/// A constrained Delaunay triangulation.
#[derive(Debug, Clone)]
pub(super) struct Delaunay {
    sites: Vec<Site>,
    free_sites: Vec<SiteId>,
    /// Three half-edges for each triangle, counter-clockwise: where each begins, its other side, and what bounds the triangle there.
    from: Vec<SiteId>,
    twin: Vec<u32>,
    side: Vec<Side>,
    free_triangles: Vec<u32>,
    /// For each triangle whether it is part of the face.
    is_inside: Vec<bool>,
    /// The triangles of the face, and for each triangle its place among them.
    inside: Vec<u32>,
    place: Vec<u32>,
    /// Triangles that changed since zones were last found.
    touched: Vec<u32>,
    is_touched: Vec<bool>,
    /// Where the next search begins.
    last: u32,
    /// The middle of the box in which sites may lie, and half its size.
    middle: DVec2,
    reach: f64,
    /// Half-edges that may have to be flipped.
    doubtful: Vec<u32>,
    /// Turns the order in which a search looks at the sides of a triangle, so that it cannot go in circles.
    turn: u32,
}

impl Delaunay {
    /// The triangulation of no sites; those to come lie in a box.
    pub(super) fn new(min: DVec2, max: DVec2) -> Self {
        let middle = 0.5 * (min + max);
        let size = (max - min).max_element().max(middle.abs().max_element() * 1e-12).max(f64::MIN_POSITIVE);
        let reach = 4.0 * size;
        let mut new = Self {
            sites: Vec::new(),
            free_sites: Vec::new(),
            from: Vec::new(),
            twin: Vec::new(),
            side: Vec::new(),
            free_triangles: Vec::new(),
            is_inside: Vec::new(),
            inside: Vec::new(),
            place: Vec::new(),
            touched: Vec::new(),
            is_touched: Vec::new(),
            last: 0,
            middle,
            reach,
            doubtful: Vec::new(),
            turn: 0,
        };
        let corners = [[-4.0, -4.0], [8.0, -4.0], [-4.0, 8.0]];
        let corners = corners.map(|at| new.new_site(middle + reach * DVec2::from_array(at)));
        let first = new.new_triangle(corners);
        corners.iter().zip(first..).for_each(|(site, half_edge)| new.sites[site.index()].leaving = half_edge);
        new
    }

    /// Whether a site may lie somewhere.
    pub(super) fn may_hold(&self, at: DVec2) -> bool {
        (at - self.middle).abs().max_element() <= self.reach
    }

    /// The number of triangles of the face.
    pub(super) fn triangle_count(&self) -> usize {
        self.inside.len()
    }

    /// The sides of a triangle of the face, of those up to [`Delaunay::triangle_count`]: the boundary edge that begins at
    /// each corner of the face there, and that along each side.
    pub(super) fn triangle(&self, place: usize) -> [(HalfEdgeId, Option<HalfEdgeId>); 3] {
        let first = 3 * self.inside[place];
        [first, first + 1, first + 2].map(|half_edge| {
            let along = match self.side[half_edge as usize] {
                Side::Inner(piece) => Some(piece),
                Side::Free | Side::Outer => None,
            };
            (self.piece_at(half_edge), along)
        })
    }

    /// The boundary edge that begins the corner of the face in which a triangle of the face begins a half-edge.
    fn piece_at(&self, half_edge: u32) -> HalfEdgeId {
        let site = &self.sites[self.from[half_edge as usize].index()];
        if site.pieces == 1 {
            return site.piece;
        }
        let mut half_edge = half_edge;
        loop {
            if let Side::Inner(piece) = self.side[half_edge as usize] {
                return piece;
            }
            half_edge = self.clockwise(half_edge);
        }
    }

    /// Whether a boundary edge begins at a site.
    pub(super) fn is_corner(&self, site: SiteId) -> bool {
        self.sites[site.index()].pieces > 0
    }

    /// Where a site is.
    pub(super) fn at(&self, site: SiteId) -> DVec2 {
        self.sites[site.index()].at
    }

    /// The site at which a half-edge begins.
    fn from(&self, half_edge: u32) -> SiteId {
        self.from[half_edge as usize]
    }

    /// The site at which it ends.
    fn to(&self, half_edge: u32) -> SiteId {
        self.from[next(half_edge) as usize]
    }

    /// The site across from it in its triangle.
    fn apex(&self, half_edge: u32) -> SiteId {
        self.from[previous(half_edge) as usize]
    }

    fn twin(&self, half_edge: u32) -> u32 {
        self.twin[half_edge as usize]
    }

    fn side(&self, half_edge: u32) -> Side {
        self.side[half_edge as usize]
    }

    /// The next half-edge clockwise around the site at which one begins; [`NONE`] outside of all triangles.
    fn clockwise(&self, half_edge: u32) -> u32 {
        let twin = self.twin(half_edge);
        if twin == NONE { NONE } else { next(twin) }
    }

    /// The next one counter-clockwise.
    fn counter_clockwise(&self, half_edge: u32) -> u32 {
        self.twin(previous(half_edge))
    }

    /// The half-edges that begin at a site within the outer triangle, counter-clockwise.
    fn star(&self, site: SiteId) -> impl Iterator<Item = u32> + '_ {
        let first = self.sites[site.index()].leaving;
        let mut half_edge = first;
        std::iter::from_fn(move || {
            let this = (half_edge != NONE).then_some(half_edge)?;
            let after = self.counter_clockwise(this);
            half_edge = if after == first { NONE } else { after };
            Some(this)
        })
    }

    /// The half-edge from one site to another, of which one at least is no corner of the outer triangle, where there is one.
    fn find_edge(&self, from: SiteId, to: SiteId) -> Option<u32> {
        if from.index() < OUTER {
            return self.star(to).find(|half_edge| self.to(*half_edge) == from).map(|back| self.twin(back));
        }
        self.star(from).find(|half_edge| self.to(*half_edge) == to)
    }

    fn new_site(&mut self, at: DVec2) -> SiteId {
        let site = Site { at, leaving: NONE, pieces: 0, piece: HalfEdgeId::NONE };
        match self.free_sites.pop() {
            Some(number) => {
                self.sites[number.index()] = site;
                number
            }
            None => {
                self.sites.push(site);
                SiteId::from_index(self.sites.len() - 1)
            }
        }
    }

    /// Adds a triangle without neighbours; gives its first half-edge.
    fn new_triangle(&mut self, corners: [SiteId; 3]) -> u32 {
        let triangle = self.free_triangles.pop().unwrap_or_else(|| {
            self.from.extend([FREE; 3]);
            self.twin.extend([NONE; 3]);
            self.side.extend([Side::Free; 3]);
            self.is_inside.push(false);
            self.place.push(NONE);
            self.is_touched.push(false);
            number32(self.is_inside.len()) - 1
        });
        let first = 3 * triangle as usize;
        self.from[first..first + 3].copy_from_slice(&corners);
        self.twin[first..first + 3].fill(NONE);
        self.side[first..first + 3].fill(Side::Free);
        self.touch(3 * triangle);
        3 * triangle
    }

    /// Frees the triangle of a half-edge.
    fn free_triangle(&mut self, half_edge: u32) {
        let triangle = half_edge / 3;
        self.set_inside(triangle, false);
        self.from[3 * triangle as usize] = FREE;
        self.free_triangles.push(triangle);
    }

    fn is_free(&self, triangle: u32) -> bool {
        self.from[3 * triangle as usize] == FREE
    }

    /// Makes two half-edges the two sides of one edge.
    fn link(&mut self, half_edge: u32, twin: u32) {
        self.twin[half_edge as usize] = twin;
        if twin != NONE {
            self.twin[twin as usize] = half_edge;
        }
    }

    /// Puts an edge of another half-edge into the place of one: what is across, and what bounds the triangle there.
    fn put_side(&mut self, half_edge: u32, (twin, side): (u32, Side)) {
        self.link(half_edge, twin);
        self.side[half_edge as usize] = side;
    }

    fn across(&self, half_edge: u32) -> (u32, Side) {
        (self.twin(half_edge), self.side(half_edge))
    }

    /// Notes that a triangle has changed.
    fn touch(&mut self, half_edge: u32) {
        let triangle = half_edge / 3;
        if !std::mem::replace(&mut self.is_touched[triangle as usize], true) {
            self.touched.push(triangle);
        }
    }

    fn set_inside(&mut self, triangle: u32, is_inside: bool) {
        if std::mem::replace(&mut self.is_inside[triangle as usize], is_inside) == is_inside {
            return;
        }
        if is_inside {
            self.place[triangle as usize] = number32(self.inside.len());
            self.inside.push(triangle);
        } else {
            let place = self.place[triangle as usize] as usize;
            self.inside.swap_remove(place);
            if let Some(moved) = self.inside.get(place) {
                self.place[*moved as usize] = number32(place);
            }
        }
    }
}

#[cfg(test)]
mod tests;
