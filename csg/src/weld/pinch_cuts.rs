//! Half-edges that are in the order of their regions, cut where corners touch their insides: the regions of those that are cut are put in
//! order again, the others move on as they are.

use std::ops::Range;

use planecut_parallel::prelude::*;

use super::cancel::HalfEdge;
use super::lines::Line;
use super::points::Points;
use super::regions::RegionPieces;
use super::stops::sort_along;
use crate::ids::{HalfEdgeId, Id, LineId, PointId, PointOnLine, RegionId};
use crate::plane_table::PlaneTable;

impl RegionPieces {
    /// Cuts half-edges at further points of their lines, given by line. Pairs stay paired: what bounds one wedge of solid does so on either
    /// side of a cut.
    pub(super) fn cut(&mut self, table: &PlaneTable, points: &Points, lines: &[Line], cuts: &[PointOnLine]) {
        let on_lines = self.forward_on(lines.len(), cuts);
        let known = self.pieces.len();
        let mut regions = Vec::new();
        let mut stops: Vec<PointId> = Vec::new();
        for group in cuts.chunk_by(|a, b| a.line == b.line) {
            let number = group[0].line;
            let line = &lines[number.index()];
            stops.clear();
            stops.extend(group.iter().map(|cut| cut.point));
            sort_along(table, points, line, &mut stops);
            let start = on_lines.partition_point(|piece| piece.0 < number);
            for (_, piece) in on_lines[start..].iter().take_while(|piece| piece.0 == number) {
                self.cut_piece(*piece, &stops, |p, q| line.compare(table, points, p, q).is_lt(), &mut regions);
            }
        }
        regions.sort_unstable();
        regions.dedup();
        self.sort_again(known, &regions);
    }

    /// The half-edges along lines on which something is cut, by line.
    fn forward_on(&self, lines: usize, cuts: &[PointOnLine]) -> Vec<(LineId, HalfEdgeId)> {
        let mut is_cut = vec![false; lines];
        cuts.iter().for_each(|cut| is_cut[cut.line.index()] = true);
        let is_concerned = |(number, piece): (usize, &HalfEdge)| {
            (piece.is_forward() && is_cut[piece.line().index()]).then(|| (piece.line(), HalfEdgeId::from_index(number)))
        };
        let pieces = self.pieces.par_iter().enumerate().with_min_len(1 << 11);
        let mut on_lines: Vec<(LineId, HalfEdgeId)> = pieces.filter_map(is_concerned).collect();
        on_lines.sort_unstable();
        on_lines
    }

    /// Cuts a half-edge and its twin at those of some stops that lie inside of it; what comes from that is put at the end. Notes whose
    /// half-edges these are.
    fn cut_piece(
        &mut self,
        mut number: HalfEdgeId,
        stops: &[PointId],
        is_before: impl Fn(PointId, PointId) -> bool,
        regions: &mut Vec<RegionId>,
    ) {
        let pieces = &mut self.pieces;
        for &stop in stops {
            let piece = pieces[number.index()];
            if !is_before(piece.from, stop) || !is_before(stop, piece.to) {
                continue;
            }
            let (twin, rest) = (pieces[piece.twin.index()], HalfEdgeId::from_index(pieces.len()));
            pieces[number.index()] = HalfEdge { to: stop, twin: rest.plus(1), ..piece };
            pieces[piece.twin.index()] = HalfEdge { to: stop, twin: rest, ..twin };
            pieces.push(HalfEdge { from: stop, ..piece });
            pieces.push(HalfEdge { from: stop, twin: number, ..twin });
            regions.extend([piece.region, twin.region]);
            number = rest;
        }
    }

    /// Puts half-edges in order, of which the first `known` were: those of some regions have changed, and what follows belongs to them.
    fn sort_again(&mut self, known: usize, regions: &[RegionId]) {
        let changed = Changed::of(self, known, regions);
        let new = |piece: &mut HalfEdge| piece.twin = changed.new_number(piece.twin);
        self.pieces.par_iter_mut().with_min_len(1 << 11).for_each(new);
        changed.move_pieces(&mut self.pieces);
        let mut added = 0;
        let mut rest = changed.regions.iter().peekable();
        for range in &mut self.ranges {
            let old = range.clone();
            range.start += added;
            if let Some(region) = rest.next_if(|region| region.old == old) {
                added = region.added;
            }
            range.end += added;
        }
    }
}

/// Regions whose half-edges have changed, in the order of regions.
struct Changed {
    regions: Vec<ChangedRegion>,
    /// How many half-edges there were before.
    known: usize,
    /// Those that came since: their new numbers.
    of_new: Vec<HalfEdgeId>,
}

struct ChangedRegion {
    /// Where its half-edges were.
    old: Range<usize>,
    /// How many came to it and to regions before it.
    added: usize,
    /// Its half-edges in order, by their numbers so far.
    members: Vec<HalfEdgeId>,
    /// For each of those that it had the new number.
    of_old: Vec<HalfEdgeId>,
}

impl Changed {
    fn of(RegionPieces { pieces, ranges }: &RegionPieces, known: usize, regions: &[RegionId]) -> Self {
        let mut new: Vec<HalfEdgeId> = (known..pieces.len()).map(HalfEdgeId::from_index).collect();
        new.sort_unstable_by_key(|piece| pieces[piece.index()].region);
        let mut changed = Self {
            regions: Vec::with_capacity(regions.len()),
            known,
            of_new: vec![HalfEdgeId::NONE; pieces.len() - known],
        };
        let (mut added, mut rest) = (0, new.as_slice());
        for region in regions {
            let old = ranges[ranges.partition_point(|range| pieces[range.start].region < *region)].clone();
            let (own, others) = rest.split_at(rest.partition_point(|piece| pieces[piece.index()].region <= *region));
            rest = others;
            let mut members: Vec<HalfEdgeId> =
                old.clone().map(HalfEdgeId::from_index).chain(own.iter().copied()).collect();
            members.sort_unstable_by_key(|piece| (pieces[piece.index()].from, pieces[piece.index()].to));
            let mut of_old = vec![HalfEdgeId::NONE; old.len()];
            for (place, member) in (old.start + added..).map(HalfEdgeId::from_index).zip(&members) {
                match member.index().checked_sub(known) {
                    Some(new) => changed.of_new[new] = place,
                    None => of_old[member.index() - old.start] = place,
                }
            }
            added += own.len();
            changed.regions.push(ChangedRegion { old, added, members, of_old });
        }
        changed
    }

    fn new_number(&self, number: HalfEdgeId) -> HalfEdgeId {
        let old = number.index();
        if old >= self.known {
            return self.of_new[old - self.known];
        }
        let before = self.regions.partition_point(|region| region.old.start <= old);
        match self.regions[..before].last() {
            None => number,
            Some(region) if old < region.old.end => region.of_old[old - region.old.start],
            Some(region) => number.plus(region.added),
        }
    }

    /// Moves half-edges to their new places, the last ones first.
    fn move_pieces(&self, pieces: &mut [HalfEdge]) {
        let parts: Vec<Vec<HalfEdge>> = self
            .regions
            .iter()
            .map(|region| region.members.iter().map(|member| pieces[member.index()]).collect())
            .collect();
        let mut end = self.known;
        for (region, part) in self.regions.iter().zip(&parts).rev() {
            pieces.copy_within(region.old.end..end, region.old.end + region.added);
            let part_end = region.old.end + region.added;
            pieces[part_end - part.len()..part_end].copy_from_slice(part);
            end = region.old.start;
        }
    }
}

#[cfg(test)]
mod tests {
    use planecut_kernel::{DVec3, HalfSpace};

    use super::*;
    use crate::body::build_bodies;
    use crate::boundary::boundary_of_union;
    use crate::model::{Brush, MaterialId};
    use crate::weld::half_edges;

    /// A prism over a square that stands on its corner, which touches the side of a long bar.
    fn prism(k: u32) -> Brush {
        let [x, y] = [f64::from(k) + 0.5, 0.5];
        let across = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
        let side = |[a, b]: [f64; 2]| (DVec3::new(a, b, 0.0), a * x + b * y + 0.5);
        let ends = [(DVec3::Z, 1.0), (DVec3::NEG_Z, 0.0)];
        let plane = |(normal, offset)| HalfSpace::new(normal, offset).expect("a plane");
        Brush::from_half_spaces(across.map(side).into_iter().chain(ends).map(plane), MaterialId(0))
    }

    #[test]
    fn half_edges_are_in_order_and_paired_after_cuts() {
        const PRISMS: u32 = 40;
        let bar = Brush::cuboid(DVec3::new(0.0, -1.0, 0.0), DVec3::new(f64::from(PRISMS), 0.0, 1.0), MaterialId(0));
        let brushes: Vec<Brush> = std::iter::once(bar).chain((0..PRISMS).map(prism)).collect();
        let built = build_bodies(&brushes);
        let bodies: Vec<_> = built.bodies.into_iter().filter_map(|body| body.bounded()).collect();
        let (edges, _) = boundary_of_union(&built.table, &bodies, &[0]);
        let (_, _, RegionPieces { pieces, ranges }, _) = half_edges(&built.table, edges, &[0]).expect("closed");
        // each prism cuts two edges of the bar
        let edges_of_bar = 12 + 2 * PRISMS as usize;
        assert_eq!(pieces.len(), 2 * edges_of_bar + 24 * PRISMS as usize);
        assert_eq!(ranges.iter().cloned().flatten().collect::<Vec<_>>(), (0..pieces.len()).collect::<Vec<_>>());
        for range in ranges {
            let region = &pieces[range];
            assert!(region.iter().all(|piece| piece.region == region[0].region));
            assert!(region.windows(2).all(|pair| (pair[0].from, pair[0].to) < (pair[1].from, pair[1].to)));
        }
        for (number, piece) in pieces.iter().enumerate() {
            let twin = pieces[piece.twin.index()];
            assert_eq!(twin.twin.index(), number);
            assert_eq!((twin.line(), twin.from, twin.to), (piece.line(), piece.to, piece.from));
        }
    }
}
