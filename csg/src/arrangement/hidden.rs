//! Triangles that cannot be seen in the outcome: those inside of operands that alone decide what is solid there, as each operand of a union does.
//!
//! Where many meshes overlap, most of what they have in common lies inside of others. Triangles of one mesh that another one does not touch, and that
//! hang together, lie inside of it all together or not at all; one ray tells. What is left out is as if it were not there: only regions
//! that are known to be decided have facets missing.

use planecut_parallel::prelude::*;
use rustc_hash::{FxHashMap, FxHashSet};

use super::contact::Contacts;
use super::flat_faces::FlatFaces;
use super::input::Input;
use super::winding::{is_above_beside, winding_beside};
use crate::base::{Bounds, Boxes};
use crate::closed_mesh::connectivity::NO_TWIN;
use crate::ids::{Id, InputTriangleId, number32};

/// Operands that alone decide what is solid: inside of any of them the outcome is one and the same, whatever the others hold.
#[derive(Debug, Clone)]
pub(super) struct Deciders {
    /// For each operand whether it is one.
    pub(super) is_decider: Vec<bool>,
    /// Whether the inside of these is solid.
    pub(super) value: bool,
}

/// Triangles inside of operands that decide, left out of an arrangement.
#[derive(Debug, Default)]
pub(super) struct Hidden {
    /// For each triangle of the input whether it is one; empty where none is.
    is_hidden: Vec<bool>,
    /// The operands that decide and whose boundary is crossed once: above each of their triangles is outside, below inside; with the outcome
    /// inside of them.
    deciders: Option<Deciders>,
}

/// A triangle of an operand that another operand touches, both by their numbers.
type Touched = (u32, u32, u32);

impl Hidden {
    /// Finds triangles that lie inside of operands that decide.
    pub(super) fn new(input: &Input<'_>, contacts: &[Contacts], faces: &FlatFaces<'_>, deciders: &Deciders) -> Self {
        let crossed_once = crossed_once(input, contacts, &deciders.is_decider);
        let touched = touched(input, contacts, faces, &crossed_once);
        let groups: Vec<&[Touched]> = touched.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).collect();
        let boxes = Boxes::new(input.operands.iter().map(|operand| operand.tree().all_bounds()).collect());
        let hidden_of = |operand: usize| {
            let first = groups.partition_point(|group| (group[0].0 as usize) < operand);
            let own: Vec<&[Touched]> =
                groups[first..].iter().take_while(|group| group[0].0 as usize == operand).copied().collect();
            let count = input.operands[operand].triangles().len();
            let (mut hidden, mut marks) = (vec![false; count], Marks::new(count));
            let mut near = Vec::new();
            boxes.touching(&input.operands[operand].tree().all_bounds(), &mut near);
            near.sort_unstable();
            for other in near.into_iter().filter(|other| *other as usize != operand && crossed_once[*other as usize]) {
                let touched = own.binary_search_by_key(&other, |group| group[0].1).map_or(&[][..], |k| own[k]);
                Within { input, operand, other: other as usize }.find(touched, &mut marks, &mut hidden);
            }
            hidden
        };
        let hidden: Vec<Vec<bool>> = (0..input.operands.len()).into_par_iter().map(hidden_of).collect();
        let deciders = Deciders { is_decider: crossed_once, value: deciders.value };
        Self { is_hidden: hidden.concat(), deciders: Some(deciders) }
    }

    /// Whether a triangle is left out.
    #[inline]
    pub(super) fn has(&self, triangle: InputTriangleId) -> bool {
        self.is_hidden.get(triangle.index()).is_some_and(|is_hidden| *is_hidden)
    }

    /// The operands that decide, where triangles may have been left out.
    pub(super) fn deciders(&self) -> Option<&Deciders> {
        self.deciders.as_ref()
    }
}

/// Which of the operands that decide have a boundary that is crossed once, from outside to inside: all that does not touch itself and is not
/// inside out.
fn crossed_once(input: &Input<'_>, contacts: &[Contacts], is_decider: &[bool]) -> Vec<bool> {
    let mut is_possible = is_decider.to_vec();
    let lists = contacts.iter().flat_map(|part| [&part.pairs, &part.coplanar, &part.overlapping]);
    let of_edges = contacts.iter().flat_map(|part| &part.shared_edges).map(|pair| pair.map(triangle_of));
    for pair in lists.flatten().copied().chain(of_edges) {
        let [one, other] = pair.map(|triangle| input.of_triangle(triangle).0);
        if one == other {
            is_possible[one] = false;
        }
    }
    let is_right = |operand: usize| {
        let own = &input.operands[operand];
        is_possible[operand]
            && (own.is_body() || {
                !own.twins().contains(&NO_TWIN)
                    && own.flat().is_empty()
                    && shells(own.twins()).into_iter().all(|first| {
                        let [a, b, _] = input.triangle(operand, first).corners;
                        let inside = i32::from(!is_above_beside(input, operand, first));
                        winding_beside(input, operand, [a, b]) == inside
                    })
            })
    };
    (0..input.operands.len()).into_par_iter().map(is_right).collect()
}

/// The first triangle of each connected part.
fn shells(twins: &[u32]) -> Vec<u32> {
    let mut is_known = vec![false; twins.len() / 3];
    let mut firsts = Vec::new();
    let mut waiting = Vec::new();
    for start in 0..number32(is_known.len()) {
        if std::mem::replace(&mut is_known[start as usize], true) {
            continue;
        }
        firsts.push(start);
        waiting.push(start);
        while let Some(triangle) = waiting.pop() {
            for twin in &twins[3 * triangle as usize..3 * triangle as usize + 3] {
                if *twin != NO_TWIN && !std::mem::replace(&mut is_known[*twin as usize / 3], true) {
                    waiting.push(twin / 3);
                }
            }
        }
    }
    firsts
}

fn triangle_of(half_edge: u32) -> InputTriangleId {
    InputTriangleId::from_index(half_edge as usize / 3)
}

/// Triangles that other operands touch, those of `deciders`; sorted.
fn touched(input: &Input<'_>, contacts: &[Contacts], faces: &FlatFaces<'_>, deciders: &[bool]) -> Vec<Touched> {
    let place = |triangle: InputTriangleId| {
        let (operand, own) = input.of_triangle(triangle);
        (number32(operand), own)
    };
    let of_pair = |pair: [InputTriangleId; 2]| {
        let [(i, p), (j, q)] = pair.map(place);
        let both = [(i, j, p), (j, i, q)];
        both.into_iter().filter(move |(_, other, _)| i != j && deciders[*other as usize])
    };
    let of_edges = |pair: &[u32; 2]| of_pair(pair.map(triangle_of));
    let of_part = |part: &Contacts| {
        let pairs = [&part.pairs, &part.coplanar].into_iter().flatten();
        let touched = pairs.flat_map(|pair| of_pair(*pair)).chain(part.shared_edges.iter().flat_map(of_edges));
        touched.collect::<Vec<Touched>>()
    };
    let mut touched: Vec<Touched> = contacts.par_iter().flat_map_iter(of_part).collect();
    // of flat faces upon each other not every triangle is named
    let mut of_faces: FxHashMap<(u32, u32), FxHashSet<u32>> = FxHashMap::default();
    let overlapping = contacts.iter().flat_map(|part| &part.overlapping);
    for (operand, other, own) in overlapping.flat_map(|pair| of_pair(*pair)) {
        of_faces.entry((operand, faces.of(operand as usize)[own as usize])).or_default().insert(other);
    }
    let operands: FxHashSet<u32> = of_faces.keys().map(|(operand, _)| *operand).collect();
    for operand in operands {
        for (own, first) in (0..).zip(faces.of(operand as usize)) {
            let others = of_faces.get(&(operand, *first)).into_iter().flatten();
            touched.extend(others.map(|other| (operand, *other, own)));
        }
    }
    touched.par_sort_unstable();
    touched.dedup();
    touched
}

/// The triangles of one operand and the inside of another one.
struct Within<'a> {
    input: &'a Input<'a>,
    operand: usize,
    other: usize,
}

/// What is known of the triangles of an operand beside another one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Mark {
    #[default]
    Unknown,
    /// The other one touches it.
    Touched,
    /// It was met, and may lie inside.
    Met,
    /// It does not lie inside.
    Outside,
}

/// Marks of triangles, forgotten all at once.
#[derive(Debug)]
struct Marks {
    of_triangle: Vec<(u32, Mark)>,
    now: u32,
}

impl Marks {
    fn new(count: usize) -> Self {
        Self { of_triangle: vec![(0, Mark::Unknown); count], now: 0 }
    }

    fn forget(&mut self) {
        self.now += 1;
    }

    fn of(&self, triangle: u32) -> Mark {
        let (when, mark) = self.of_triangle[triangle as usize];
        if when == self.now { mark } else { Mark::Unknown }
    }

    fn set(&mut self, triangle: u32, mark: Mark) {
        self.of_triangle[triangle as usize] = (self.now, mark);
    }
}

impl Within<'_> {
    /// Finds those that lie inside; `touched` are those that the other one touches.
    fn find(&self, touched: &[Touched], marks: &mut Marks, hidden: &mut [bool]) {
        let own = &self.input.operands[self.operand];
        let space = self.input.operands[self.other].tree().all_bounds();
        let is_within = |bounds: &Bounds| bounds.min.cmpge(space.min).all() && bounds.max.cmple(space.max).all();
        let neighbours = |triangle: u32| {
            let twins = &own.twins()[3 * triangle as usize..3 * triangle as usize + 3];
            twins.iter().filter(|twin| **twin != NO_TWIN).map(|twin| twin / 3)
        };
        let starts: Vec<u32> = if !touched.is_empty() {
            touched.iter().flat_map(|(_, _, triangle)| neighbours(*triangle)).collect()
        } else if is_within(&own.tree().all_bounds()) {
            shells(own.twins())
        } else {
            return;
        };
        marks.forget();
        touched.iter().for_each(|(_, _, triangle)| marks.set(*triangle, Mark::Touched));
        // triangles without an area are not known to be touched
        own.flat().iter().for_each(|triangle| marks.set(*triangle, Mark::Touched));
        let mut part = Vec::new();
        for start in starts {
            if marks.of(start) != Mark::Unknown {
                continue;
            }
            marks.set(start, Mark::Met);
            part.clear();
            part.push(start);
            let mut next = 0;
            // what leaves the box of the other one is not inside of it
            let mut leaves = false;
            while next < part.len() && !leaves {
                let triangle = part[next];
                next += 1;
                leaves = !is_within(&own.bounds(triangle));
                for neighbour in neighbours(triangle) {
                    match marks.of(neighbour) {
                        Mark::Unknown => {
                            marks.set(neighbour, Mark::Met);
                            part.push(neighbour);
                        }
                        Mark::Outside => leaves = true,
                        Mark::Met | Mark::Touched => {}
                    }
                }
            }
            if leaves || !self.is_inside(part[0]) {
                part.iter().for_each(|triangle| marks.set(*triangle, Mark::Outside));
            } else {
                part.iter().for_each(|triangle| hidden[*triangle as usize] = true);
            }
        }
    }

    /// Whether a triangle that the other operand does not touch, but in corners maybe, lies inside of it.
    fn is_inside(&self, triangle: u32) -> bool {
        let [a, b, _] = self.input.triangle(self.operand, triangle).corners;
        let winding = winding_beside(self.input, self.other, [a, b]);
        self.input.operands[self.other].rule().is_inside(winding)
    }
}
