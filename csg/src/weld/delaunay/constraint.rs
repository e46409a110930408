//! Constraints: boundary edges that are edges of the triangulation, whatever the circles say.

use std::collections::VecDeque;

use super::{Conflict, Delaunay, Side};
use crate::closed_mesh::connectivity::{next, previous};
use crate::ids::{HalfEdgeId, Id, SiteId};

impl Delaunay {
    /// Makes a boundary edge of the face an edge; the face lies to its left.
    ///
    /// # Errors
    /// [`Conflict`]: it crosses another one, or passes a site.
    pub(crate) fn constrain(&mut self, from: SiteId, to: SiteId, piece: HalfEdgeId) -> Result<(), Conflict> {
        let half_edge = match self.find_edge(from, to) {
            Some(half_edge) => half_edge,
            None => self.make_edge(from, to)?,
        };
        self.side[half_edge as usize] = Side::Inner(piece);
        let twin = self.twin(half_edge);
        if self.side(twin) == Side::Free {
            self.side[twin as usize] = Side::Outer;
        }
        self.touch(half_edge);
        self.touch(twin);
        let site = &mut self.sites[from.index()];
        (site.pieces, site.piece) = (site.pieces + 1, piece);
        Ok(())
    }

    /// Removes a boundary edge.
    ///
    /// # Errors
    /// [`Conflict`] where there is none.
    pub(crate) fn release(&mut self, from: SiteId, to: SiteId) -> Result<(), Conflict> {
        let half_edge = self.find_edge(from, to).ok_or(Conflict)?;
        let twin = self.twin(half_edge);
        if matches!(self.side(twin), Side::Inner(_)) {
            self.side[half_edge as usize] = Side::Outer;
        } else {
            self.side[half_edge as usize] = Side::Free;
            self.side[twin as usize] = Side::Free;
            self.doubtful.push(half_edge);
        }
        self.touch(half_edge);
        self.touch(twin);
        let left = self.sites[from.index()].pieces - 1;
        let inner = |half_edge: u32| match self.side(half_edge) {
            Side::Inner(piece) => Some(piece),
            Side::Free | Side::Outer => None,
        };
        let another = if left == 0 { None } else { self.star(from).find_map(inner) };
        let site = &mut self.sites[from.index()];
        (site.pieces, site.piece) = (left, another.unwrap_or(HalfEdgeId::NONE));
        self.flip_doubtful();
        Ok(())
    }

    /// Flips diagonals until one joins two sites (Sloan, "A fast algorithm for generating constrained Delaunay triangulations", 1993); gives
    /// its half-edge.
    fn make_edge(&mut self, from: SiteId, to: SiteId) -> Result<u32, Conflict> {
        let mut crossed = self.crossed(from, to)?;
        let mut made: Vec<[SiteId; 2]> = Vec::new();
        let crosses = |delaunay: &Self, [a, b]: [SiteId; 2]| {
            // no site lies on the way, so what ends at neither end lies on different sides of it
            ![a, b].contains(&from)
                && ![a, b].contains(&to)
                && (delaunay.turn(from, to, a) > 0.0) != (delaunay.turn(from, to, b) > 0.0)
        };
        while let Some([a, b]) = crossed.pop_front() {
            let half_edge = self.find_edge(a, b).ok_or(Conflict)?;
            if !self.is_convex(half_edge) {
                crossed.push_back([a, b]);
                continue;
            }
            self.flip(half_edge);
            let ends = [self.from(half_edge), self.to(half_edge)];
            if crosses(self, ends) { crossed.push_back(ends) } else { made.push(ends) }
        }
        let wanted = self.find_edge(from, to).ok_or(Conflict)?;
        // the others may have to be flipped, but not that one
        let twin = self.twin(wanted);
        self.side[wanted as usize] = Side::Outer;
        self.side[twin as usize] = Side::Outer;
        for [a, b] in made.into_iter().filter(|ends| !(ends.contains(&from) && ends.contains(&to))) {
            self.doubtful.extend(self.find_edge(a, b));
        }
        self.flip_doubtful();
        let wanted = self.find_edge(from, to).ok_or(Conflict)?;
        let twin = self.twin(wanted);
        self.side[wanted as usize] = Side::Free;
        self.side[twin as usize] = Side::Free;
        Ok(wanted)
    }

    /// The diagonals that the way from one site to another crosses, in their order.
    fn crossed(&self, from: SiteId, to: SiteId) -> Result<VecDeque<[SiteId; 2]>, Conflict> {
        let ahead_of = |half_edge: &u32| {
            self.turn(from, to, self.to(*half_edge)) < 0.0 && self.turn(from, to, self.apex(*half_edge)) > 0.0
        };
        let mut half_edge = self.star(from).find(ahead_of).map(next).ok_or(Conflict)?;
        let mut crossed = VecDeque::new();
        loop {
            // it begins right of the way and ends left of it
            if self.side(half_edge) != Side::Free {
                return Err(Conflict);
            }
            crossed.push_back([self.from(half_edge), self.to(half_edge)]);
            let twin = self.twin(half_edge);
            let ahead = self.apex(twin);
            if ahead == to {
                return Ok(crossed);
            }
            let turn = self.turn(from, to, ahead);
            if turn == 0.0 {
                return Err(Conflict);
            }
            half_edge = if turn > 0.0 { next(twin) } else { previous(twin) };
        }
    }
}
