//! Winding numbers on both sides of every facet.
//!
//! Facets that meet at an edge are sorted around it; crossing one changes the winding number of its operand by one. One ray for each
//! connected part tells the numbers beside an edge of it.

mod beside;
mod regions;
mod states;
mod within;

use beside::beside;
pub(super) use beside::{is_above_beside, winding_beside};
use regions::{FacetSide, Regions};
use states::States;
pub(super) use states::Windings;
use within::{Content, Places};

use planecut_parallel::prelude::*;

use super::Arrangement;
use super::around::{Around, HalfPlane, half_planes};
use super::facets::{FacetKind, Facets, Side};
use super::hidden::Deciders;
use super::patches::Patch;
use super::surface::sorted;
use crate::base::DisjointSets;
use crate::ids::{FacetId, Id, InputTriangleId, PointId, StateId, TriangleId, number32};

/// Facets of a region that are looked at for a place that tells its winding numbers.
const TRIES: usize = 8;

/// The winding numbers on both sides of each facet.
#[derive(Debug)]
pub(super) struct Sheets {
    pub(super) states: States,
    /// For each facet what is above it, from where its triangle is counter-clockwise, and below; none for those that are gone.
    pub(super) above: Vec<StateId>,
    pub(super) below: Vec<StateId>,
    /// What stands for all winding numbers in operands that decide, and whether it is solid there.
    pub(super) decided: Option<(StateId, bool)>,
}

/// Why there are no winding numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum NoWindings {
    /// They contradict one another: a defect of this program.
    Contradiction,
    /// Plain numbers do not tell those of regions beside facets that were left out.
    Uncertain,
}

/// The winding numbers on both sides of each facet.
pub(super) fn sheets(arrangement: &Arrangement<'_>, facets: &Facets) -> Result<Sheets, NoWindings> {
    let regions = Regions::new(arrangement, facets);
    let states = vec![StateId::NONE; regions.len()];
    let spread =
        Spread { arrangement, facets, regions, all: States::default(), states, waiting: Vec::new(), decided: None };
    match arrangement.surface.hidden.deciders() {
        Some(deciders) => spread.among(deciders),
        None => spread.everywhere(),
    }
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
    /// What stands for the winding numbers of regions in operands that decide.
    decided: Option<StateId>,
}

impl Spread<'_> {
    /// The winding numbers of all regions.
    fn everywhere(mut self) -> Result<Sheets, NoWindings> {
        for facet in self.seeds() {
            self.begin(facet)?;
            self.run()?;
        }
        Ok(self.sheets(None))
    }

    /// The winding numbers of regions that lie in no operand that decides; facets in these may be missing.
    fn among(mut self, deciders: &Deciders) -> Result<Sheets, NoWindings> {
        // no operand has this number
        let decided = self.all.number(vec![(u32::MAX, 1)]);
        self.decided = Some(decided);
        let regions = &self.regions;
        let insides = |facet: FacetId| {
            // each boundary has its inside below
            let own = std::iter::once((self.operand(facet), false));
            let doubles = self.facets.doubles(facet).iter();
            let all = own.chain(doubles.map(|double| (self.operand(double.facet), !double.is_same)));
            let deciding = all.filter(|(operand, _)| deciders.is_decider[*operand as usize]);
            deciding.map(move |(_, is_above)| regions.of(FacetSide { facet, is_above }))
        };
        let present = FacetId::all(self.facets.len()).filter(|facet| !self.facets.is_gone(*facet));
        let inside: Vec<usize> = present.flat_map(insides).collect();
        inside.into_iter().for_each(|region| self.states[region] = decided);
        let is_open = |region: &usize| {
            let mut sides = self.regions.sides(*region);
            self.states[*region] == StateId::NONE && sides.any(|side| !self.facets.is_gone(side.facet))
        };
        let open: Vec<usize> = (0..self.regions.len()).filter(is_open).collect();
        let places = Places::new(self.arrangement, self.facets, deciders);
        let content = |region: &usize| {
            let sides = self.regions.sides(*region).filter(|side| !self.facets.is_gone(side.facet));
            (*region, sides.take(TRIES).find_map(|side| places.content(side)))
        };
        let contents: Vec<(usize, Option<Content>)> = open.par_iter().map(content).collect();
        for (region, content) in &contents {
            if let Some(Content::Decided) = content {
                self.states[*region] = decided;
            }
        }
        for (region, content) in &contents {
            if let Some(Content::Windings(windings)) = content {
                let state = self.all.number(windings.clone());
                self.set_region(*region, state)?;
                self.run()?;
            }
        }
        if open.iter().any(|region| self.states[*region] == StateId::NONE) {
            return Err(NoWindings::Uncertain);
        }
        Ok(self.sheets(Some((decided, deciders.value))))
    }

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
    fn begin(&mut self, facet: FacetId) -> Result<(), NoWindings> {
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
    fn begin_with_patch(&mut self, facet: FacetId, operand: usize, first: u32) -> Result<(), NoWindings> {
        let input = self.arrangement.surface.input;
        let [a, b, _] = input.triangle(operand, first).corners;
        let state = self.all.number(beside(input, [a, b]));
        self.set(FacetSide { facet, is_above: is_above_beside(input, operand, first) }, state)
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
    fn set(&mut self, side: FacetSide, state: StateId) -> Result<(), NoWindings> {
        self.set_region(self.regions.of(side), state)
    }

    fn set_region(&mut self, region: usize, state: StateId) -> Result<(), NoWindings> {
        if self.states[region] == StateId::NONE {
            self.states[region] = state;
            self.waiting.push(region);
        }
        if self.states[region] == state { Ok(()) } else { Err(NoWindings::Contradiction) }
    }

    /// Goes on from regions that are known to those beside them.
    fn run(&mut self) -> Result<(), NoWindings> {
        while let Some(region) = self.waiting.pop() {
            let sides: Vec<FacetSide> = self.regions.sides(region).collect();
            for side in sides.into_iter().filter(|side| !self.facets.is_gone(side.facet)) {
                if self.decided.is_none_or(|decided| self.states[self.regions.of(side.across())] != decided) {
                    let state = self.across(side, self.states[region]);
                    self.set(side.across(), state)?;
                }
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

    fn sheets(self, decided: Option<(StateId, bool)>) -> Sheets {
        let side = |is_above: bool| {
            let of_facet = |facet| self.states[self.regions.of(FacetSide { facet, is_above })];
            FacetId::all(self.facets.len()).map(of_facet).collect()
        };
        Sheets { above: side(true), below: side(false), states: self.all, decided }
    }
}
