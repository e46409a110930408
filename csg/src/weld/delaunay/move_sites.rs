//! Sites that move by little.

use planecut_kernel::DVec2;

use super::predicates::check_range;
use super::{Conflict, Delaunay};
use crate::closed_mesh::connectivity::{next, previous};
use crate::ids::{Id, SiteId, number32};

/// Where more than one in this number of sites move, all triangles are looked at.
const MOVED_SHARE: usize = 8;

impl Delaunay {
    /// Moves sites, each to a place, where no triangle turns over by that: then flips are all it takes.
    ///
    /// # Errors
    /// [`Conflict`]: a triangle would have turned over, or a place is out of range; then the triangulation is of no use any more.
    pub(crate) fn move_sites(&mut self, moved: &[(SiteId, DVec2)]) -> Result<(), Conflict> {
        for &(site, at) in moved {
            check_range(at)?;
            if !self.may_hold(at) {
                return Err(Conflict);
            }
            self.sites[site.index()].at = at;
        }
        if moved.len() * MOVED_SHARE > self.sites.len() {
            let all = 0..number32(self.is_inside.len());
            all.filter(|triangle| !self.is_free(*triangle)).try_for_each(|triangle| self.check_turn(3 * triangle))?;
            let twin = &self.twin;
            let once = |half_edge: &u32| *half_edge < twin[*half_edge as usize];
            self.doubtful.extend((0..number32(self.from.len())).filter(once));
        } else {
            for (site, _) in moved {
                let star: Vec<u32> = self.star(*site).collect();
                star.iter().try_for_each(|half_edge| self.check_turn(*half_edge))?;
                self.doubtful
                    .extend(star.iter().flat_map(|half_edge| [*half_edge, next(*half_edge), previous(*half_edge)]));
            }
        }
        self.flip_doubtful();
        self.find_zones();
        Ok(())
    }

    fn check_turn(&self, half_edge: u32) -> Result<(), Conflict> {
        let turn = self.turn(self.from(half_edge), self.to(half_edge), self.apex(half_edge));
        if turn > 0.0 { Ok(()) } else { Err(Conflict) }
    }
}
