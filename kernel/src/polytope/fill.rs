//! Closing a hole with the planes around it: the new vertices are a triangulation of the ring in the dual.
//!
//! Take two planes of the ring and the edge between them that enters the hole. It ends where it leaves the first of the
//! planes between them; that is a new vertex, from which two edges go on, each into its own part of the ring. Only the
//! order in which one line leaves planes is asked, so `orient3` and `orient4` suffice; ordering the events of a face that
//! moves outward would need degree 7. It looks at no more than `8·k·(log₂ k + 1)` candidates for a ring of `k` planes and then
//! gives up; even parts need about `k·log₂ k`.

use super::remove::RingEdge;
use super::store::Link;
use super::{IncrementalPolytope, VertexIdx};
use crate::sign::{Corner, Sign, orient3};

/// Candidates looked at for each plane of the ring and each doubling of its length: beyond them the parts are uneven. Even
/// parts need one.
const PATIENCE: usize = 8;

/// A part of a ring that is still open: the edge between its first and its last plane enters it from `end`.
#[derive(Debug, Clone, Copy)]
pub(super) struct OpenPart {
    first: u32,
    last: u32,
    end: Link,
}

impl IncrementalPolytope {
    /// Closes the hole with new vertices; false where an edge never ends, so that the hole is open at infinity, or where
    /// the parts are so uneven that another way is faster. What was made until then is in the change.
    pub(super) fn fill(&mut self, ring: &[RingEdge]) -> bool {
        let last = ring.len() - 1;
        if last < 2 {
            return false;
        }
        let mut open = std::mem::take(&mut self.scratch.open_parts);
        open.clear();
        open.push(OpenPart { first: 0, last: last as u32, end: ring[last].end });
        let mut is_closed = true;
        let mut patience = PATIENCE * ring.len() * (ring.len().ilog2() as usize + 1);
        while let Some(part) = open.pop() {
            let candidates = (part.last - part.first) as usize;
            if candidates > patience {
                is_closed = false;
                break;
            }
            patience -= candidates;
            let Some((between, planes, point)) = self.first_left(ring, part) else {
                is_closed = false;
                break;
            };
            let vertex = self.vertices.insert(planes, point);
            self.change.created.push(VertexIdx(vertex));
            self.vertices.join(Link::new(vertex, 1), part.end);
            for plane in planes {
                self.planes.set_face(plane, vertex);
            }
            for (k, first, last) in [(2, part.first, between), (0, between, part.last)] {
                let end = Link::new(vertex, k);
                if first + 1 == last {
                    self.vertices.join(end, ring[first as usize].end);
                } else {
                    open.push(OpenPart { first, last, end });
                }
            }
        }
        self.scratch.open_parts = open;
        is_closed
    }

    /// Which of the planes between the ends of a part the edge between the ends leaves first, and the meeting point.
    fn first_left(&self, ring: &[RingEdge], part: OpenPart) -> Option<(u32, [u32; 3], Corner)> {
        let (a, b) = (ring[part.first as usize].plane, ring[part.last as usize].plane);
        let mut found: Option<(u32, [u32; 3], Corner)> = None;
        for at in part.first + 1..part.last {
            let planes = [a, ring[at as usize].plane, b];
            match &found {
                // The edge begins inside every plane, so a plane that the best point violates is left before it.
                Some((_, best, point)) if !self.is_point_outside(*best, point, planes[1]) => continue,
                Some(_) => {}
                None => {
                    let [a, c, b] = planes.map(|plane| self.row(plane));
                    if orient3(a, c, b) != Sign::Positive {
                        continue;
                    }
                }
            }
            found = Some((at, planes, self.meeting_point(planes)));
        }
        found
    }
}
