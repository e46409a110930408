//! Winding numbers on both sides of every facet.
//!
//! Facets that meet at an edge are sorted around it; crossing one changes the winding number of its operand by one. One ray for each
//! connected part tells the numbers beside an edge of it.

mod beside;
mod regions;
mod states;

use beside::{axis_between, beside};
use regions::{FacetSide, Regions};
use states::States;
pub(super) use states::Windings;

use super::Arrangement;
use super::around::{Around, HalfPlane, half_planes};
use super::facets::{FacetKind, Facets, Side};
use super::patches::Patch;
use super::predicates::Triangle;
use super::surface::sorted;
use crate::base::DisjointSets;
use crate::ids::{FacetId, Id, InputTriangleId, PointId, StateId, TriangleId, number32};

/// The winding numbers on both sides of each facet.
#[derive(Debug)]
pub(super) struct Sheets {
    pub(super) states: States,
    /// For each facet what is above it, from where its triangle is counter-clockwise, and below; none for those that are gone.
    pub(super) above: Vec<StateId>,
    pub(super) below: Vec<StateId>,
}

/// Winding numbers that contradict one another: a defect of this program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Contradiction;

/// The winding numbers on both sides of each facet.
pub(super) fn sheets(arrangement: &Arrangement<'_>, facets: &Facets) -> Result<Sheets, Contradiction> {
    let regions = Regions::new(arrangement, facets);
    let states = vec![StateId::NONE; regions.len()];
    let mut spread = Spread { arrangement, facets, regions, all: States::default(), states, waiting: Vec::new() };
    for facet in spread.seeds() {
        spread.begin(facet)?;
        spread.run()?;
    }
    Ok(spread.sheets())
}

struct Spread<'a> {
    arrangement: &'a Arrangement<'a>,
    facets: &'a Facets,
    regions: Regions,
    all: States,
    /// The winding numbers of each region.
    states: Vec<StateId>,
    /// Regions that are known, and from which others have not been looked at.
    waiting: Vec<usize>,
}

impl Spread<'_> {
    /// A facet of each connected part.
    fn seeds(&self) -> Vec<FacetId> {
        let mut sets = DisjointSets::new(self.facets.len());
        for facet in self.facets.flat_ones() {
            let triangle = self.facets.triangle(&self.arrangement.cells, facet);
            sets.join(facet.number(), triangle.number());
        }
        for edge in 0..number32(self.facets.edge_ends.len()) {
            let sides = self.facets.sides_at(edge);
            sides.windows(2).for_each(|pair| sets.join(pair[0].facet.number(), pair[1].facet.number()));
        }
        let (part, count) = sets.numbered();
        let mut seeds = vec![None; count];
        for facet in FacetId::all(self.facets.len()).filter(|facet| !self.facets.is_gone(*facet)) {
            seeds[part[facet.index()] as usize].get_or_insert(facet);
        }
        seeds.into_iter().flatten().collect()
    }

    /// Begins with a facet beside an edge of its triangle, or of one of its triangles: one ray tells the winding numbers there.
    fn begin(&mut self, facet: FacetId) -> Result<(), Contradiction> {
        let input = self.arrangement.surface.input;
        if let FacetKind::Patch(patch) = self.facets.kind(facet) {
            let Patch { operand, first } = self.arrangement.patches.all[patch.index()];
            return self.begin_with_patch(facet, operand as usize, first);
        }
        let triangle = self.facets.triangle(&self.arrangement.cells, facet);
        let Arrangement { surface, polygons, edge_points, .. } = self.arrangement;
        let half_edge = polygons.border(surface, polygons.of(triangle))[0];
        let triangle = TriangleId::from_index(half_edge as usize / 3);
        let [a, b] = [half_edge as usize % 3, (half_edge as usize + 1) % 3].map(|k| surface.corners(triangle)[k]);
        let windings = beside(input, [a, b].map(|point| surface.corner(point)));
        let next = edge_points.from(a, b).nth(1).unwrap_or(b);
        let sides = self.facets.edge_between(sorted(a, next)).expect("the edge of a facet is listed");
        let is_patch = |side: &&Side| matches!(self.facets.kind(side.facet), FacetKind::Patch(_));
        let sides: Vec<Side> = sides.iter().filter(|side| !is_patch(side)).copied().collect();
        let around = Around::of_side(self.arrangement, &sides[0]);
        let mut members = half_planes(self.arrangement, self.facets, &sides);
        // a patch beside a seam is a triangle of the input
        let seam = self.seam_at(half_edge, a, b);
        members.extend(seam);
        around.sort(&mut members);
        let (_, side) = members[around.after_direction(&members)];
        let state = self.all.number(windings);
        self.set(FacetSide { facet: side.facet, is_above: !side.is_forward }, state)
    }

    /// Begins beside the first edge of a triangle of a patch.
    fn begin_with_patch(&mut self, facet: FacetId, operand: usize, first: u32) -> Result<(), Contradiction> {
        let input = self.arrangement.surface.input;
        let triangle = input.triangle(operand, first);
        let twin = input.operands[operand].twins()[3 * first as usize];
        let [a, b, _] = triangle.corners;
        let windings = beside(input, [a, b]);
        let (axis, order) = axis_between(input, &a, &b);
        let half_plane = |triangle: Triangle, is_forward: bool| HalfPlane { triangle, plane: None, is_forward };
        let members =
            [(half_plane(triangle, true), true), (half_plane(input.triangle(operand, twin / 3), false), false)];
        let around = Around::new(input, axis, order);
        let (_, is_forward) = members[around.after_direction(&members)];
        let state = self.all.number(windings);
        self.set(FacetSide { facet, is_above: !is_forward }, state)
    }

    /// The triangle of a patch at a half-edge between two vertices.
    fn seam_at(&self, half_edge: u32, a: PointId, b: PointId) -> Option<(HalfPlane, Side)> {
        let Arrangement { surface, patches, .. } = self.arrangement;
        let seam = surface.seams.binary_search_by_key(&half_edge, |(half_edge, _)| *half_edge).ok()?;
        let (operand, number) =
            surface.input.of_triangle(InputTriangleId::from_index(surface.seams[seam].1 as usize / 3));
        let facet = self.facets.of_patch(patches.of(operand, number)?);
        let is_forward = b < a;
        let half_plane = HalfPlane { triangle: surface.input.triangle(operand, number), plane: None, is_forward };
        Some((half_plane, Side { ends: sorted(a, b), facet, is_forward }))
    }

    /// Notes the winding numbers on a side of a facet.
    fn set(&mut self, side: FacetSide, state: StateId) -> Result<(), Contradiction> {
        let region = self.regions.of(side);
        if self.states[region] == StateId::NONE {
            self.states[region] = state;
            self.waiting.push(region);
        }
        if self.states[region] == state { Ok(()) } else { Err(Contradiction) }
    }

    /// Goes on from regions that are known to those beside them.
    fn run(&mut self) -> Result<(), Contradiction> {
        while let Some(region) = self.waiting.pop() {
            let sides: Vec<FacetSide> = self.regions.sides(region).collect();
            for side in sides.into_iter().filter(|side| !self.facets.is_gone(side.facet)) {
                let state = self.across(side, self.states[region]);
                self.set(side.across(), state)?;
            }
        }
        Ok(())
    }

    /// The winding numbers on the other side of a facet.
    fn across(&mut self, side: FacetSide, state: StateId) -> StateId {
        let mut other = self.all.step(state, self.operand(side.facet), side.is_above);
        for double in self.facets.doubles(side.facet) {
            let triangle = self.facets.triangle(&self.arrangement.cells, double.facet);
            let operand = self.arrangement.surface.operands[triangle.index()];
            other = self.all.step(other, operand, side.is_above == double.is_same);
        }
        other
    }

    /// The operand that a facet belongs to.
    fn operand(&self, facet: FacetId) -> u32 {
        match self.facets.kind(facet) {
            FacetKind::Patch(patch) => self.arrangement.patches.all[patch.index()].operand,
            _ => {
                let triangle = self.facets.triangle(&self.arrangement.cells, facet);
                self.arrangement.surface.operands[triangle.index()]
            }
        }
    }

    fn sheets(self) -> Sheets {
        let side = |is_above: bool| {
            let of_facet = |facet| self.states[self.regions.of(FacetSide { facet, is_above })];
            FacetId::all(self.facets.len()).map(of_facet).collect()
        };
        Sheets { above: side(true), below: side(false), states: self.all }
    }
}
