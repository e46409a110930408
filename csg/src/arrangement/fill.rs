//! Faces cut into triangles.

use planecut_kernel::sign::{Counts, Sign};

use super::facets::FacetKind;
use super::kept::Kept;
use super::merge::Face;
use super::predicates::best_axis;
use super::slits::{Edges, without_slits};
use super::surface::sorted;
use super::{Arranged, Arrangement};
use crate::base::map_weighed_chunks;
use crate::ids::{HalfEdgeId, Id, LineId, PointId, number32};
use crate::weld::Projection;
use crate::weld::triangulate::{ExactPoints, LoopCorner, Triangles, Triangulator, side_bits};
use glam::DVec3;

/// The triangles of faces, one face after the other.
#[derive(Debug, Default)]
pub(super) struct FilledFaces {
    pub(super) triangles: Vec<[u32; 3]>,
    /// The number of triangles of each face.
    pub(super) counts: Vec<u32>,
    /// For each triangle which of its sides lie on loops of its face, a bit for each.
    on_loops: Vec<u8>,
}

impl FilledFaces {
    /// Whether a half-edge lies within a face, not on a loop of it.
    pub(super) fn is_diagonal(&self, half_edge: u32) -> bool {
        self.on_loops[half_edge as usize / 3] >> (half_edge % 3) & 1 == 0
    }
}

/// Points of an arrangement, seen along an axis.
struct ArrangementPoints<'a>(&'a Arrangement<'a>);

impl ExactPoints for ArrangementPoints<'_> {
    fn turn(&self, points: [PointId; 3], Projection { u, v }: Projection) -> Sign {
        let turn = self.0.points.turn(&self.0.surface, points, 3 - u - v);
        if (u + 1) % 3 == v { turn } else { turn.flip() }
    }

    fn order(&self, a: PointId, b: PointId, Projection { u, v }: Projection) -> std::cmp::Ordering {
        self.0.points.compare_along(&self.0.surface, a, b, [u, v])
    }
}

impl Arranged<'_> {
    /// The triangles of faces, by the numbers of points.
    pub(super) fn filled(&self, faces: &[Face]) -> FilledFaces {
        let size = |face: &Face| face.loops.iter().map(Vec::len).sum::<usize>().max(3);
        let (parts, _): (Vec<FilledFaces>, Counts) =
            map_weighed_chunks(faces, 1 << 10, size, |faces| self.filled_in_a_row(faces));
        let mut all = FilledFaces::default();
        for part in parts {
            all.triangles.extend(part.triangles);
            all.counts.extend(part.counts);
            all.on_loops.extend(part.on_loops);
        }
        all
    }

    /// How a facet is seen from outside the solid.
    fn projection(&self, kept: &Kept) -> Option<Projection> {
        let triangle = self.facets.triangle(&self.arrangement.cells, kept.facet);
        let (axis, sign) = best_axis(self.arrangement.surface.input, &self.arrangement.surface.triangle(triangle))?;
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let is_upright = (sign == Sign::Positive) != kept.is_flipped;
        Some(if is_upright { Projection { u, v } } else { Projection { u: v, v: u } })
    }

    /// The loops of a facet, as seen from outside the solid, without segments that run both ways along it, but for those in which faces cross.
    pub(super) fn loops(&self, kept: &Kept, crossed: &Edges) -> Vec<Vec<PointId>> {
        let Arrangement { surface, cells, points: all, .. } = &self.arrangement;
        let mut loops: Vec<Vec<PointId>> = match self.facets.kind(kept.facet) {
            FacetKind::Cell(cell) => {
                let stays = |a: PointId, b: PointId| !crossed.is_empty() && crossed.contains(&sorted(a, b));
                let at = |point: PointId| all.at(surface, point);
                cells.loops(cell).flat_map(|points| without_slits(points, at, stays)).collect()
            }
            _ => vec![surface.corners[kept.facet.index()].to_vec()],
        };
        if kept.is_flipped {
            loops.iter_mut().for_each(|points| points.reverse());
        }
        loops
    }

    fn filled_in_a_row(&self, faces: &[Face]) -> FilledFaces {
        let exact = ArrangementPoints(&self.arrangement);
        let mut triangulator = Triangulator::new(&exact);
        let mut filled = FilledFaces::default();
        for Face { kept, loops, .. } in faces {
            let before = filled.triangles.len();
            if loops.is_empty() {
                let [a, b, c] = self.arrangement.surface.corners[kept.facet.index()].map(|point| point.number());
                filled.triangles.push(if kept.is_flipped { [a, c, b] } else { [a, b, c] });
                filled.on_loops.push(side_bits([true; 3]));
            } else if let Some(projection) = self.projection(kept) {
                triangulator.begin(projection);
                let mut first = 0;
                for points in loops {
                    triangulator.add_loop(points.iter().enumerate().map(|(k, point)| LoopCorner {
                        point: *point,
                        at: self.arrangement.points.at(&self.arrangement.surface, *point),
                        line: LineId::from_index(first + k),
                        piece: HalfEdgeId::from_index(first + k),
                    }));
                    first += points.len();
                }
                let mut triangles = Triangles::default();
                triangulator.triangulate(&mut triangles);
                filled.on_loops.extend(&triangles.on_loops);
                let all: Vec<PointId> = loops.concat();
                filled
                    .triangles
                    .extend(triangles.corners.iter().map(|corners| corners.map(|k| all[k.index()].number())));
            }
            filled.counts.push(number32(filled.triangles.len() - before));
        }
        filled
    }
}

/// Twice the area within a loop.
pub(super) fn area(points: &[PointId], at: impl Fn(PointId) -> DVec3) -> f64 {
    let origin = at(points[0]);
    let fan = points.windows(2).map(|ends| (at(ends[0]) - origin).cross(at(ends[1]) - origin));
    fan.sum::<DVec3>().length()
}
