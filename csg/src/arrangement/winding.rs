//! Winding numbers on both sides of every facet.
//!
//! Facets that meet at an edge are sorted around it; crossing one changes the winding number of its operand by one. One ray for each
//! connected part tells the numbers beside an edge of it.

use std::cmp::Ordering;

use planecut_kernel::sign::Sign;
use rustc_hash::FxHashMap;

use super::Arrangement;
use super::around::{Around, HalfPlane, half_planes};
use super::exact::compare_vertices;
use super::facets::{FacetKind, Facets, Side};
use super::input::Input;
use super::patches::Patch;
use super::predicates::{Corner, RoundedPlane, Triangle, sign, turn};
use super::surface::sorted;
use crate::base::{Bounds, DisjointSets};
use crate::ids::{FacetId, Id, InputTriangleId, PointId, StateId, TriangleId, number32};

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
pub(super) fn sheets(arrangement: &Arrangement<'_>, facets: &Facets) -> Result<Sheets, Contradiction> {
    let unknown = vec![StateId::NONE; facets.len()];
    let sheets = Sheets { states: States::default(), above: unknown.clone(), below: unknown };
    let mut spread =
        Spread { arrangement, facets, sheets, waiting: Vec::new(), is_done: vec![false; facets.edge_ends.len()] };
    for facet in spread.seeds() {
        spread.begin(facet)?;
        spread.run()?;
    }
    Ok(spread.sheets)
}

struct Spread<'a> {
    arrangement: &'a Arrangement<'a>,
    facets: &'a Facets,
    sheets: Sheets,
    waiting: Vec<FacetId>,
    /// Whether all facets at an edge are known.
    is_done: Vec<bool>,
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
        let state = self.sheets.states.number(windings);
        self.set(side.facet, !side.is_forward, state)
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
        let state = self.sheets.states.number(windings);
        self.set(facet, !is_forward, state)
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

    /// Notes what is above a facet, or below.
    fn set(&mut self, facet: FacetId, is_above: bool, state: StateId) -> Result<(), Contradiction> {
        let operand = self.operand(facet);
        let Sheets { states, above, below } = &mut self.sheets;
        let k = facet.index();
        let known = if is_above { above[k] } else { below[k] };
        if known != StateId::NONE {
            return if known == state { Ok(()) } else { Err(Contradiction) };
        }
        let mut other = states.step(state, operand, is_above);
        for double in self.facets.doubles(facet) {
            let triangle = self.facets.triangle(&self.arrangement.cells, double.facet);
            let operand = self.arrangement.surface.operands[triangle.index()];
            other = states.step(other, operand, is_above == double.is_same);
        }
        (above[k], below[k]) = if is_above { (state, other) } else { (other, state) };
        self.waiting.push(facet);
        Ok(())
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

    fn run(&mut self) -> Result<(), Contradiction> {
        while let Some(facet) = self.waiting.pop() {
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
        let sides = self.facets.sides_at(edge);
        let sorted;
        let sides = if sides.len() > 2 {
            let mut members = half_planes(self.arrangement, self.facets, sides);
            Around::of_side(self.arrangement, &sides[0]).sort(&mut members);
            sorted = members.into_iter().map(|(_, side)| side).collect::<Vec<Side>>();
            &sorted[..]
        } else {
            sides
        };
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
fn beside(input: &Input<'_>, from: [Corner; 2]) -> Windings {
    let at = from[0].at;
    let mut windings = Windings::new();
    // corners of bodies may be a little away
    let (low, high) = (at.to_array().map(f64::next_down), at.to_array().map(f64::next_up));
    let passes = |bounds: &Bounds| {
        bounds.max.x >= low[0]
            && bounds.min.y <= high[1]
            && bounds.max.y >= low[1]
            && bounds.min.z <= high[2]
            && bounds.max.z >= low[2]
    };
    for (operand, own) in input.operands.iter().enumerate() {
        let mut winding = 0;
        own.tree().for_each(passes, |triangle| winding += crossing(input, &input.triangle(operand, triangle), &from));
        if winding != 0 {
            windings.push((number32(operand), winding));
        }
    }
    windings
}

/// How a ray along x crosses a triangle, from the first of two vertices, moved towards the second and by `(ε, ε², ε³)`: 1 from below,
/// −1 from above, 0 not at all.
fn crossing(input: &Input<'_>, triangle: &Triangle, start: &[Corner; 2]) -> i32 {
    let first = |signs: [Sign; 2]| signs.into_iter().find(|sign| *sign != Sign::Zero);
    let turn = |from: Corner, to: Corner| {
        first(start.map(|point| turn(input, [from, to, point], 0))).unwrap_or_else(|| {
            // which way the edge runs, along y and then along z
            let along = [1, 2].map(|axis| order_along(input, &from, &to, axis));
            if along[1] == Sign::Zero { along[0] } else { along[1].flip() }
        })
    };
    let corners = triangle.corners;
    let facing = turn(corners[0], corners[1]);
    if facing == Sign::Zero || turn(corners[1], corners[2]) != facing || turn(corners[2], corners[0]) != facing {
        return 0;
    }
    let plane = RoundedPlane::new(input, triangle);
    // one whose plane the whole edge lies in is left behind
    let is_ahead = first(start.map(|point| plane.side(input, &point))) == Some(facing.flip());
    match (is_ahead, facing) {
        (false, _) => 0,
        (true, Sign::Positive) => 1,
        (true, _) => -1,
    }
}

/// An axis along which two vertices differ, and their order along it.
fn axis_between(input: &Input<'_>, from: &Corner, to: &Corner) -> (usize, Ordering) {
    let longest = (to.at - from.at).abs().max_position();
    let order = |axis: usize| match order_along(input, from, to, axis) {
        Sign::Positive => Ordering::Less,
        Sign::Zero => Ordering::Equal,
        Sign::Negative => Ordering::Greater,
    };
    let axes = [longest, (longest + 1) % 3, (longest + 2) % 3];
    axes.map(|axis| (axis, order(axis)))
        .into_iter()
        .find(|(_, order)| order.is_ne())
        .unwrap_or((longest, Ordering::Equal))
}

/// The sign of the difference of two vertices along an axis.
fn order_along(input: &Input<'_>, from: &Corner, to: &Corner, axis: usize) -> Sign {
    let difference = sign(to.at[axis] - from.at[axis]);
    let is_there = |corner: &Corner| input.is_where_it_is_said(corner.vertex);
    if difference != Sign::Zero || is_there(from) && is_there(to) {
        return difference;
    }
    compare_vertices(input, to.vertex, from.vertex, axis)
}
