//! Flips of diagonals until all are Delaunay (Lawson 1977).

use super::predicates::is_in_circle;
use super::{Delaunay, NONE, Side};
use crate::closed_mesh::connectivity::{next, previous};
use crate::ids::Id;

impl Delaunay {
    /// Flips what has to be flipped among the doubtful half-edges and around what was.
    pub(super) fn flip_doubtful(&mut self) {
        while let Some(half_edge) = self.doubtful.pop() {
            if !self.is_free(half_edge / 3) && self.must_flip(half_edge) {
                let twin = self.twin(half_edge);
                self.flip(half_edge);
                self.doubtful.extend([next(half_edge), previous(half_edge), next(twin), previous(twin)]);
            }
        }
    }

    /// The same after a site came into a Delaunay triangulation, where the doubtful half-edges are those across from it: the edges that end at the site are Delaunay at once
    /// (de Berg et al., lemma 9.10), so of each flip only the two sides across from the site may have to be flipped.
    pub(super) fn flip_around_new_site(&mut self) {
        while let Some(half_edge) = self.doubtful.pop() {
            if self.must_flip(half_edge) {
                let twin = self.twin(half_edge);
                self.flip(half_edge);
                self.doubtful.extend([previous(half_edge), next(twin)]);
            }
        }
    }

    /// Whether a half-edge is that of a diagonal which is not Delaunay.
    fn must_flip(&self, half_edge: u32) -> bool {
        if self.side(half_edge) != Side::Free || self.twin(half_edge) == NONE {
            return false;
        }
        let [a, b, c] = [self.from(half_edge), self.to(half_edge), self.apex(half_edge)].map(|site| self.at(site));
        is_in_circle(a, b, c, self.at(self.apex(self.twin(half_edge))))
    }

    /// Puts the other diagonal of the quadrilateral, which is convex, of two triangles in the place of the one of a half-edge.
    pub(super) fn flip(&mut self, half_edge: u32) {
        let (e, f) = (half_edge, self.twin(half_edge));
        let (a, b, c, d) = (self.from(e), self.from(f), self.apex(e), self.apex(f));
        let [bc, ca, ad, db] = [next(e), previous(e), next(f), previous(f)].map(|side| self.across(side));
        for (place, site) in [(e, d), (next(e), c), (previous(e), a), (f, c), (next(f), d), (previous(f), b)] {
            self.from[place as usize] = site;
            self.sites[site.index()].leaving = place;
        }
        self.put_side(next(e), ca);
        self.put_side(previous(e), ad);
        self.put_side(next(f), db);
        self.put_side(previous(f), bc);
        self.link(e, f);
        self.touch(e);
        self.touch(f);
    }

    /// Whether the two triangles of a half-edge make a strictly convex quadrilateral.
    pub(super) fn is_convex(&self, half_edge: u32) -> bool {
        let twin = self.twin(half_edge);
        let (a, b, c, d) = (self.from(half_edge), self.from(twin), self.apex(half_edge), self.apex(twin));
        self.turn(d, b, c) > 0.0 && self.turn(c, a, d) > 0.0
    }
}
