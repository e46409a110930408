//! Sites that go.

use super::{Conflict, Delaunay, Side};
use crate::closed_mesh::connectivity::{next, previous};
use crate::ids::{Id, SiteId};

impl Delaunay {
    /// Removes a site at which no constraint ends: flips take its edges away until three or four are left (Devillers, "On deletion in Delaunay
    /// triangulations", 2002).
    ///
    /// # Errors
    /// [`Conflict`] where that does not come to an end, which it does.
    pub(crate) fn remove(&mut self, site: SiteId) -> Result<(), Conflict> {
        let mut degree = self.star(site).count();
        let mut half_edge = self.sites[site.index()].leaving;
        let mut tried = 0;
        while degree > 3 && tried <= degree {
            let after = self.counter_clockwise(half_edge);
            let [before, tip, beyond] =
                [self.clockwise(half_edge), half_edge, after].map(|half_edge| self.to(half_edge));
            if self.turn(before, tip, beyond) > 0.0 && self.turn(before, beyond, site) > 0.0 {
                let cut_off = self.twin(half_edge);
                self.flip(half_edge);
                self.doubtful.extend([cut_off, next(cut_off), previous(cut_off)]);
                degree -= 1;
                tried = 0;
                // on to the one before, which may be cut off now
                half_edge = previous(half_edge);
            } else {
                half_edge = after;
                tried += 1;
            }
        }
        if degree > 4 {
            return Err(Conflict);
        }
        self.fill_star(site);
        self.flip_doubtful();
        Ok(())
    }

    /// Puts one or two triangles in the place of the three or four around a site.
    fn fill_star(&mut self, site: SiteId) {
        let star: Vec<u32> = self.star(site).collect();
        let ring: Vec<(SiteId, (u32, Side))> =
            star.iter().map(|half_edge| (self.to(*half_edge), self.across(next(*half_edge)))).collect();
        let is_inside = self.is_inside[star[0] as usize / 3];
        star.into_iter().for_each(|half_edge| self.free_triangle(half_edge));
        self.sites[site.index()].leaving = super::NONE;
        self.free_sites.push(site);
        let add = |delaunay: &mut Self, corners: [usize; 3], sides: [Option<usize>; 3]| {
            let first = delaunay.new_triangle(corners.map(|k| ring[k].0));
            delaunay.set_inside(first / 3, is_inside);
            for ((half_edge, corner), side) in (first..).zip(corners).zip(sides) {
                delaunay.sites[ring[corner].0.index()].leaving = half_edge;
                if let Some(side) = side {
                    delaunay.put_side(half_edge, ring[side].1);
                }
                delaunay.doubtful.push(half_edge);
            }
            delaunay.last = first;
            first
        };
        if ring.len() == 3 {
            add(self, [0, 1, 2], [Some(0), Some(1), Some(2)]);
        } else {
            let one = add(self, [0, 1, 2], [Some(0), Some(1), None]);
            let other = add(self, [2, 3, 0], [Some(2), Some(3), None]);
            self.link(one + 2, other + 2);
        }
    }
}
