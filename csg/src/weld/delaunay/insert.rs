//! Sites that come.

use planecut_kernel::DVec2;

use super::locate::Place;
use super::predicates::check_range;
use super::{Conflict, Delaunay, Side};
use crate::closed_mesh::connectivity::{next, previous};
use crate::ids::{Id, SiteId};

impl Delaunay {
    /// Adds a site.
    ///
    /// # Errors
    /// [`Conflict`]: another site is there, or a constraint passes the place.
    pub(crate) fn insert(&mut self, at: DVec2) -> Result<SiteId, Conflict> {
        check_range(at)?;
        match self.locate(at) {
            Place::At(_) => Err(Conflict),
            Place::On(half_edge) if self.side(half_edge) != Side::Free => Err(Conflict),
            Place::Within(half_edge) => {
                let site = self.new_site(at);
                self.split_triangle(half_edge, site);
                self.flip_around_new_site();
                Ok(site)
            }
            Place::On(half_edge) => {
                let site = self.new_site(at);
                self.split_edge(half_edge, site);
                self.flip_around_new_site();
                Ok(site)
            }
        }
    }

    /// Splits a triangle in three at a site within it.
    fn split_triangle(&mut self, half_edge: u32, site: SiteId) {
        let sides = [half_edge, next(half_edge), previous(half_edge)];
        let ends = sides.map(|side| (self.from(side), self.to(side), self.across(side)));
        let is_inside = self.is_inside[half_edge as usize / 3];
        self.free_triangle(half_edge);
        let [one, two, three] = ends.map(|(from, to, across)| self.add_triangle([from, to, site], across, is_inside));
        for (a, b) in [(one, two), (two, three), (three, one)] {
            self.link(next(a), previous(b));
        }
    }

    /// Splits both triangles of an edge at a site on it.
    fn split_edge(&mut self, half_edge: u32, site: SiteId) {
        let twin = self.twin(half_edge);
        let around = [next(half_edge), previous(half_edge), next(twin), previous(twin)];
        let ends = around.map(|side| (self.from(side), self.to(side), self.across(side)));
        let inside = [half_edge, half_edge, twin, twin].map(|side| self.is_inside[side as usize / 3]);
        self.free_triangle(half_edge);
        self.free_triangle(twin);
        let mut new = [0; 4];
        for (k, (from, to, across)) in ends.into_iter().enumerate() {
            new[k] = self.add_triangle([from, to, site], across, inside[k]);
        }
        for k in 0..4 {
            self.link(next(new[k]), previous(new[(k + 1) % 4]));
        }
    }

    /// Adds a triangle with what lies across from its first side; that side may have to be flipped.
    pub(super) fn add_triangle(&mut self, corners: [SiteId; 3], across: (u32, Side), is_inside: bool) -> u32 {
        let first = self.new_triangle(corners);
        self.put_side(first, across);
        self.set_inside(first / 3, is_inside);
        for (site, half_edge) in corners.into_iter().zip(first..) {
            self.sites[site.index()].leaving = half_edge;
        }
        self.doubtful.push(first);
        self.last = first;
        first
    }
}
