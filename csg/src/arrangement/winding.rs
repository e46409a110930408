//! Winding numbers on both sides of every facet.
//!
//! Facets that meet at an edge are sorted around it; crossing one changes the winding number of its operand by one. One ray for each
//! connected part tells the numbers beside an edge of it.

use planecut_kernel::sign::Sign;
use rustc_hash::FxHashMap;

use super::Arrangement;
use super::around::Around;
use super::facets::{Facets, Side};
use super::predicates::{RoundedPlane, projected, sign, turn};
use super::surface::sorted;
use super::triangle_tree::TriangleTree;
use crate::base::DisjointSets;
use crate::closed_mesh::connectivity::NO_TWIN;
use crate::ids::{FacetId, Id, PointId, StateId, TriangleId, number32};

/// Winding numbers of operands, ascending; those that are zero are left out.
pub(super) type Windings = Vec<(u32, i32)>;

/// The different combinations of winding numbers that there are.
#[derive(Debug, Default)]
pub(super) struct States {
    pub(super) windings: Vec<Windings>,
    number: FxHashMap<Windings, StateId>,
    steps: FxHashMap<(StateId, u32, bool), StateId>,
}

impl States {
    fn number(&mut self, windings: Windings) -> StateId {
        let fresh = StateId::from_index(self.windings.len());
        let number = *self.number.entry(windings.clone()).or_insert(fresh);
        if number == fresh {
            self.windings.push(windings);
        }
        number
    }

    /// The combination in which the number of an operand is one more, or one less.
    fn step(&mut self, state: StateId, operand: u32, is_up: bool) -> StateId {
        if let Some(found) = self.steps.get(&(state, operand, is_up)) {
            return *found;
        }
        let mut windings = self.windings[state.index()].clone();
        let by = if is_up { 1 } else { -1 };
        match windings.binary_search_by_key(&operand, |(operand, _)| *operand) {
            Ok(k) if windings[k].1 + by == 0 => {
                windings.remove(k);
            }
            Ok(k) => windings[k].1 += by,
            Err(k) => windings.insert(k, (operand, by)),
        }
        let found = self.number(windings);
        self.steps.insert((state, operand, is_up), found);
        found
    }
}

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
pub(super) fn sheets(
    arrangement: &Arrangement,
    facets: &Facets,
    trees: &[&TriangleTree],
) -> Result<Sheets, Contradiction> {
    let unknown = vec![StateId::NONE; facets.len()];
    let sheets = Sheets { states: States::default(), above: unknown.clone(), below: unknown };
    let mut spread =
        Spread { arrangement, facets, sheets, waiting: Vec::new(), is_done: vec![false; facets.edge_ends.len()] };
    for edge in spread.seeds() {
        let windings = beside(arrangement, trees, edge);
        spread.begin(edge, windings)?;
        spread.run()?;
    }
    Ok(spread.sheets)
}

struct Spread<'a> {
    arrangement: &'a Arrangement,
    facets: &'a Facets,
    sheets: Sheets,
    waiting: Vec<FacetId>,
    /// Whether all facets at an edge are known.
    is_done: Vec<bool>,
}

impl Spread<'_> {
    /// An edge of a triangle in each connected part.
    fn seeds(&self) -> Vec<[PointId; 2]> {
        let Arrangement { surface, .. } = self.arrangement;
        let triangle = |facet: FacetId| self.facets.triangle(&self.arrangement.cells, facet);
        let mut sets = DisjointSets::new(self.facets.len());
        for facet in FacetId::all(self.facets.len()) {
            let part_of = triangle(facet);
            if self.facets.is_gone(facet) {
                continue;
            }
            if part_of.index() != facet.index() {
                sets.join(facet.number(), part_of.number());
                continue;
            }
            if !self.arrangement.is_touched[facet.index()] {
                for twin in &surface.twins[3 * facet.index()..3 * facet.index() + 3] {
                    if *twin != NO_TWIN && !self.arrangement.is_touched[*twin as usize / 3] {
                        sets.join(facet.number(), twin / 3);
                    }
                }
            }
        }
        for edge in 0..number32(self.facets.edge_ends.len()) {
            let sides = self.facets.sides_at(edge);
            sides.windows(2).for_each(|pair| sets.join(pair[0].facet.number(), pair[1].facet.number()));
        }
        let (part, count) = sets.numbered();
        let mut seeds = vec![None; count];
        for facet in FacetId::all(self.facets.len()).filter(|facet| !self.facets.is_gone(*facet)) {
            let [a, b, _] = surface.corners(triangle(facet));
            seeds[part[facet.index()] as usize].get_or_insert([a, b]);
        }
        seeds.into_iter().flatten().collect()
    }

    /// Begins with the facets around the first piece of an edge, beside which the winding numbers are known.
    fn begin(&mut self, edge: [PointId; 2], windings: Windings) -> Result<(), Contradiction> {
        let state = self.sheets.states.number(windings);
        let first = self.arrangement.next_on_edge(edge[0], edge[1]);
        let mut sides: Vec<Side> = match self.facets.edge_between(sorted(edge[0], first)) {
            Some(sides) => sides.to_vec(),
            None => self.untouched_sides(edge),
        };
        let around = Around::new(self.arrangement, &sides[0]);
        around.sort(self.facets, &mut sides);
        let side = sides[around.after_direction(self.facets, &sides)];
        self.set(side.facet, !side.is_forward, state)
    }

    /// The triangles at an edge that nothing touches.
    fn untouched_sides(&self, edge: [PointId; 2]) -> Vec<Side> {
        let surface = &self.arrangement.surface;
        let ends = sorted(edge[0], edge[1]);
        let mut sides = Vec::new();
        for facet in FacetId::all(surface.len()).filter(|facet| !self.facets.is_gone(*facet)) {
            let corners = surface.corners[facet.index()];
            for k in 0..3 {
                if sorted(corners[k], corners[(k + 1) % 3]) == ends {
                    sides.push(Side { ends, facet, is_forward: corners[k] == ends[0] });
                }
            }
        }
        sides
    }

    /// Notes what is above a facet, or below.
    fn set(&mut self, facet: FacetId, is_above: bool, state: StateId) -> Result<(), Contradiction> {
        let Sheets { states, above, below } = &mut self.sheets;
        let k = facet.index();
        let known = if is_above { above[k] } else { below[k] };
        if known != StateId::NONE {
            return if known == state { Ok(()) } else { Err(Contradiction) };
        }
        let mut other = state;
        let surface = &self.arrangement.surface;
        let operand = |facet| surface.operands[self.facets.triangle(&self.arrangement.cells, facet).index()];
        other = states.step(other, operand(facet), is_above);
        for double in self.facets.doubles(facet) {
            other = states.step(other, operand(double.facet), is_above == double.is_same);
        }
        (above[k], below[k]) = if is_above { (state, other) } else { (other, state) };
        self.waiting.push(facet);
        Ok(())
    }

    fn run(&mut self) -> Result<(), Contradiction> {
        let surface = &self.arrangement.surface;
        let is_touched = &self.arrangement.is_touched;
        while let Some(facet) = self.waiting.pop() {
            let above = self.sheets.above[facet.index()];
            if self.facets.cell(facet).is_none() && !is_touched[facet.index()] {
                for side in 0..3 {
                    let twin = surface.twins[3 * facet.index() + side];
                    if twin != NO_TWIN && !is_touched[twin as usize / 3] {
                        self.set(FacetId::from_index(twin as usize / 3), true, above)?;
                    }
                }
            }
            let facets = self.facets;
            for &edge in facets.edges(facet) {
                if !std::mem::replace(&mut self.is_done[edge as usize], true) {
                    self.go_around(facet, edge)?;
                }
            }
        }
        Ok(())
    }

    /// Goes on to all facets at an edge from one that is known.
    fn go_around(&mut self, known: FacetId, edge: u32) -> Result<(), Contradiction> {
        let mut sides = self.facets.sides_at(edge).to_vec();
        if sides.len() > 2 {
            Around::new(self.arrangement, &sides[0]).sort(self.facets, &mut sides);
        }
        let start = sides.iter().position(|side| side.facet == known).expect("a facet is at its edges");
        let state = |sheets: &Sheets, side: &Side, is_above: bool| {
            if is_above { sheets.above[side.facet.index()] } else { sheets.below[side.facet.index()] }
        };
        for k in 0..sides.len() {
            let (this, next) = (sides[(start + k) % sides.len()], sides[(start + k + 1) % sides.len()]);
            // counter-clockwise one comes from below a facet that runs forward, and leaves it above
            let between = state(&self.sheets, &this, this.is_forward);
            self.set(next.facet, !next.is_forward, between)?;
        }
        Ok(())
    }
}

/// The winding numbers of operands at the first of two vertices, moved by `δ` towards the second and by `(ε, ε², ε³)`: both are as small
/// as need be, `ε` far smaller than `δ`. What touches in the vertex alone is told apart by that.
fn beside(arrangement: &Arrangement, trees: &[&TriangleTree], from: [PointId; 2]) -> Windings {
    let surface = &arrangement.surface;
    let at = surface.at(from[0]);
    let mut windings = Windings::new();
    for (operand, tree) in (0..).zip(trees) {
        let mut winding = 0;
        let passes = |bounds: &crate::base::Bounds| {
            bounds.max.x >= at.x
                && bounds.min.y <= at.y
                && bounds.max.y >= at.y
                && bounds.min.z <= at.z
                && bounds.max.z >= at.z
        };
        tree.for_each(passes, |triangle| {
            winding += crossing(arrangement, TriangleId::from_index(triangle as usize), from);
        });
        if winding != 0 {
            windings.push((operand, winding));
        }
    }
    windings
}

/// How a ray along x crosses a triangle, from the first of two vertices, moved towards the second and by `(ε, ε², ε³)`: 1 from below,
/// −1 from above, 0 not at all.
fn crossing(arrangement: &Arrangement, triangle: TriangleId, start: [PointId; 2]) -> i32 {
    let surface = &arrangement.surface;
    let corners = surface.corners(triangle);
    let first = |signs: [Sign; 2]| signs.into_iter().find(|sign| *sign != Sign::Zero);
    let turn = |from: PointId, to: PointId| {
        first(start.map(|point| turn(surface, [from, to, point], 0))).unwrap_or_else(|| {
            let along = projected(surface.at(to), 0) - projected(surface.at(from), 0);
            if along.y == 0.0 { sign(along.x) } else { sign(-along.y) }
        })
    };
    let facing = turn(corners[0], corners[1]);
    if facing == Sign::Zero || turn(corners[1], corners[2]) != facing || turn(corners[2], corners[0]) != facing {
        return 0;
    }
    let plane = RoundedPlane::new(surface, triangle);
    // one whose plane the whole edge lies in is left behind
    let is_ahead = first(start.map(|point| plane.side(surface, point))) == Some(facing.flip());
    match (is_ahead, facing) {
        (false, _) => 0,
        (true, Sign::Positive) => 1,
        (true, _) => -1,
    }
}
