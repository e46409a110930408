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
use crate::base::Boxes;
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
    pub(super) fn new(input: &Input<'_>, contacts: &Contacts, faces: &FlatFaces<'_>, deciders: &Deciders) -> Self {
        let crossed_once = crossed_once(input, contacts, &deciders.is_decider);
        let touched = touched(input, contacts, faces, &crossed_once);
        let mut groups: Vec<&[Touched]> = touched.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).collect();
        groups.sort_by_key(|group| (group[0].0, group[0].1));
        let boxes = Boxes::new(input.operands.iter().map(|operand| operand.tree().all_bounds()).collect());
        let hidden_of = |operand: usize| {
            let first = groups.partition_point(|group| (group[0].0 as usize) < operand);
            let own: Vec<&[Touched]> =
                groups[first..].iter().take_while(|group| group[0].0 as usize == operand).copied().collect();
            let mut hidden = vec![false; input.operands[operand].triangles().len()];
            let mut near = Vec::new();
            boxes.touching(&input.operands[operand].tree().all_bounds(), &mut near);
            near.sort_unstable();
            for other in near.into_iter().filter(|other| *other as usize != operand && crossed_once[*other as usize]) {
                let touched = own.iter().find(|group| group[0].1 == other).copied().unwrap_or_default();
                Within { input, operand, other: other as usize }.find(touched, &mut hidden);
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

    /// What the other triangles have in common.
    pub(super) fn without(&self, contacts: Contacts) -> Contacts {
        if self.is_hidden.is_empty() {
            return contacts;
        }
        contacts.of_triangles(|triangle| !self.has(triangle))
    }
}

/// Which of the operands that decide have a boundary that is crossed once, from outside to inside: all that does not touch itself and is not
/// inside out.
fn crossed_once(input: &Input<'_>, contacts: &Contacts, is_decider: &[bool]) -> Vec<bool> {
    let mut is_possible = is_decider.to_vec();
    let lists = [&contacts.pairs, &contacts.coplanar, &contacts.overlapping].into_iter().flatten().copied();
    let of_edges = contacts.shared_edges.iter().map(|pair| pair.map(triangle_of));
    for pair in lists.chain(of_edges) {
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
fn touched(input: &Input<'_>, contacts: &Contacts, faces: &FlatFaces<'_>, deciders: &[bool]) -> Vec<Touched> {
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
    let chunk = 1 << 12;
    let mut touched: Vec<Touched> =
        contacts.pairs.par_iter().with_min_len(chunk).flat_map_iter(|pair| of_pair(*pair)).collect();
    touched.par_extend(contacts.coplanar.par_iter().with_min_len(chunk).flat_map_iter(|pair| of_pair(*pair)));
    touched.extend(contacts.shared_edges.iter().flat_map(of_edges));
    // of flat faces upon each other not every triangle is named
    let mut of_faces: FxHashMap<(u32, u32), FxHashSet<u32>> = FxHashMap::default();
    for (operand, other, own) in contacts.overlapping.iter().flat_map(|pair| of_pair(*pair)) {
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

impl Within<'_> {
    /// Finds those that lie inside; `touched` are those that the other one touches.
    fn find(&self, touched: &[Touched], hidden: &mut [bool]) {
        let own = &self.input.operands[self.operand];
        let space = self.input.operands[self.other].tree().all_bounds();
        // what leaves the box of the other one is not inside of it
        let is_near = |triangle: u32| {
            let bounds = own.bounds(triangle);
            bounds.min.cmpge(space.min).all() && bounds.max.cmple(space.max).all()
        };
        let neighbours = |triangle: u32| {
            let twins = &own.twins()[3 * triangle as usize..3 * triangle as usize + 3];
            twins.iter().filter(|twin| **twin != NO_TWIN).map(|twin| twin / 3)
        };
        let is_barrier = |triangle: u32| {
            own.flat().binary_search(&triangle).is_ok()
                || touched.binary_search_by_key(&triangle, |(_, _, own)| *own).is_ok()
        };
        let starts: Vec<u32> = if touched.is_empty() {
            let bounds = own.tree().all_bounds();
            if !(bounds.min.cmpge(space.min).all() && bounds.max.cmple(space.max).all()) {
                return;
            }
            shells(own.twins())
        } else {
            touched.iter().flat_map(|(_, _, triangle)| neighbours(*triangle)).collect()
        };
        // whether what was met may lie inside; what leaves the box does not
        let mut met: FxHashSet<u32> = FxHashSet::default();
        let mut outside: FxHashSet<u32> = FxHashSet::default();
        let mut part = Vec::new();
        for start in starts {
            if is_barrier(start) || !met.insert(start) {
                continue;
            }
            part.clear();
            part.push(start);
            let mut next = 0;
            let mut leaves = false;
            while next < part.len() && !leaves {
                let triangle = part[next];
                next += 1;
                leaves = !is_near(triangle);
                for neighbour in neighbours(triangle).filter(|neighbour| !is_barrier(*neighbour)) {
                    if met.insert(neighbour) {
                        part.push(neighbour);
                    } else if outside.contains(&neighbour) {
                        leaves = true;
                    }
                }
            }
            if leaves || !self.is_inside(part[0]) {
                outside.extend(&part);
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
