//! Which triangles are part of the face.

use rustc_hash::FxHashSet;

use super::{Delaunay, NONE, Side};

impl Delaunay {
    /// Works out again which triangles are part of the face, after what changed. Boundary edges tell of the triangles beside them, and diagonals
    /// have the same on both sides; what has not changed is looked at only where it turns out to be another than it was.
    pub(crate) fn find_zones(&mut self) {
        let touched = std::mem::take(&mut self.touched);
        let (mut settled, mut unsettled) = (Vec::with_capacity(touched.len()), Vec::new());
        for triangle in touched {
            if self.is_free(triangle) {
                self.is_touched[triangle as usize] = false;
            } else if let Some(is_inside) = self.told_of(triangle) {
                self.is_touched[triangle as usize] = false;
                self.set_inside(triangle, is_inside);
                settled.push(triangle);
            } else {
                unsettled.push(triangle);
            }
        }
        let (mut way, mut seen) = (Vec::new(), FxHashSet::default());
        for triangle in unsettled {
            let is_inside = self.told_near(triangle, &mut way, &mut seen);
            self.is_touched[triangle as usize] = false;
            self.set_inside(triangle, is_inside);
            settled.push(triangle);
        }
        self.spread(settled);
    }

    /// What the sides of a triangle tell.
    fn told_of(&self, triangle: u32) -> Option<bool> {
        (3 * triangle..3 * triangle + 3).find_map(|half_edge| match self.side(half_edge) {
            Side::Inner(_) => Some(true),
            Side::Outer => Some(false),
            Side::Free if self.twin(half_edge) == NONE => Some(false),
            Side::Free => None,
        })
    }

    /// What the nearest triangle tells that is reached over diagonals and tells, or has changed and is settled.
    fn told_near(&self, triangle: u32, way: &mut Vec<u32>, seen: &mut FxHashSet<u32>) -> bool {
        way.clear();
        seen.clear();
        way.push(triangle);
        seen.insert(triangle);
        let mut at = 0;
        while at < way.len() {
            for half_edge in 3 * way[at]..3 * way[at] + 3 {
                let beyond = self.twin(half_edge) / 3;
                if let Some(is_inside) = self.told_of(beyond) {
                    return is_inside;
                }
                if seen.insert(beyond) {
                    way.push(beyond);
                }
            }
            at += 1;
        }
        unreachable!("the outer triangle bounds what no boundary edge does")
    }

    /// Carries what triangles are on over diagonals, to those of which it is news.
    fn spread(&mut self, mut news: Vec<u32>) {
        while let Some(triangle) = news.pop() {
            let is_inside = self.is_inside[triangle as usize];
            for half_edge in 3 * triangle..3 * triangle + 3 {
                let twin = self.twin(half_edge);
                if self.side(half_edge) == Side::Free && twin != NONE && self.is_inside[twin as usize / 3] != is_inside
                {
                    self.set_inside(twin / 3, is_inside);
                    news.push(twin / 3);
                }
            }
        }
    }
}
