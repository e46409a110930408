//! Which vertices of the simple structure are seen as one.

use std::collections::{BTreeMap, BTreeSet};

use super::super::IncrementalPolytope;
use super::super::store::NONE;
use super::edge::Bundle;

/// Bound of the cached position's errors in units of its permanents, as in the filter of the signs but with more room.
const POSITION_BOUND: f64 = 32.0 * f64::EPSILON;

/// Numbers by number: an array for questions about the whole polytope, a map for questions about one place of it.
#[derive(Debug)]
pub(super) enum Table {
    Whole(Vec<u32>),
    Local(BTreeMap<u32, u32>),
}

impl Table {
    fn get(&self, key: u32) -> Option<u32> {
        match self {
            Self::Whole(values) => Some(values[key as usize]).filter(|value| *value != NONE),
            Self::Local(values) => values.get(&key).copied(),
        }
    }

    fn set(&mut self, key: u32, value: u32) {
        match self {
            Self::Whole(values) => values[key as usize] = value,
            Self::Local(values) => {
                values.insert(key, value);
            }
        }
    }
}

/// Which contractions count.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Naming {
    /// All of exactly no length or shorter than the tolerance.
    Tentative,
    /// Those that leave a polytope's topology: what is seen.
    Settled,
}

/// Why an edge is contracted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Contraction {
    /// Its ends coincide exactly.
    Exact,
    /// It is shorter than the tolerance.
    Short,
}

/// The clusters of coincident vertices, the seen faces and the bundles of edges of a polytope that is not empty, worked
/// out as they are asked for. A cluster is named by its smallest slot, of those with fewest infinity planes.
#[derive(Debug)]
pub(in super::super) struct Clusters<'a> {
    pub(super) polytope: &'a IncrementalPolytope,
    /// By slot, all contractions made.
    tentative: Table,
    /// Names of tentative clusters that need the tolerance.
    inexact: BTreeSet<u32>,
    /// Whether the tolerance may contract a tentative cluster.
    pub(super) kept: BTreeMap<u32, bool>,
    /// By slot, exact contractions only, where the tolerance may not contract.
    exact: Table,
    /// By plane: 1 where it has a seen face, else 0.
    seen: Table,
    /// The same with all contractions made.
    seen_tentatively: Table,
    /// By half-edge, the number of its bundle.
    bundle_of: Table,
    pub(super) bundles: Vec<Bundle>,
}

impl<'a> Clusters<'a> {
    /// For questions about a few vertices: costs what is looked at.
    pub(in super::super) fn local(polytope: &'a IncrementalPolytope) -> Self {
        Self::with(polytope, |_| Table::Local(BTreeMap::new()))
    }

    /// For questions about all of a polytope.
    pub(in super::super) fn whole(polytope: &'a IncrementalPolytope) -> Self {
        Self::with(polytope, |length| Table::Whole(vec![NONE; length]))
    }

    fn with(polytope: &'a IncrementalPolytope, table: impl Fn(usize) -> Table) -> Self {
        let slots = polytope.vertices.slot_count();
        Self {
            polytope,
            tentative: table(slots),
            inexact: BTreeSet::new(),
            kept: BTreeMap::new(),
            // rarely needed at all
            exact: Table::Local(BTreeMap::new()),
            seen_tentatively: Table::Local(BTreeMap::new()),
            seen: table(polytope.planes.slot_count() as usize),
            bundle_of: table(4 * slots),
            bundles: Vec::new(),
        }
    }

    /// The name of the cluster that a vertex belongs to, by either way to name clusters.
    pub(super) fn named(&mut self, slot: u32, by: Naming) -> u32 {
        match by {
            Naming::Tentative => self.tentative(slot),
            Naming::Settled => self.cluster(slot),
        }
    }

    /// The name of the cluster that a vertex belongs to.
    pub(super) fn cluster(&mut self, slot: u32) -> u32 {
        let tentative = self.tentative(slot);
        if !self.inexact.contains(&tentative) || self.is_kept(tentative) {
            return tentative;
        }
        if let Some(name) = self.exact.get(slot) {
            return name;
        }
        let members = self.connected(slot, |contraction| contraction == Contraction::Exact).0;
        let name = self.name(&members);
        for member in members {
            self.exact.set(member, name);
        }
        name
    }

    /// The name of the cluster that a vertex would belong to if the tolerance might contract everywhere.
    pub(super) fn tentative(&mut self, slot: u32) -> u32 {
        if let Some(name) = self.tentative.get(slot) {
            return name;
        }
        let (members, is_exact) = self.connected(slot, |_| true);
        let name = self.name(&members);
        for member in members {
            self.tentative.set(member, name);
        }
        if !is_exact {
            self.inexact.insert(name);
        }
        name
    }

    /// The vertices joined to one by contracted edges, and whether all of those are exactly of zero length.
    fn connected(&self, slot: u32, follows: impl Fn(Contraction) -> bool) -> (Vec<u32>, bool) {
        let (mut members, mut known, mut is_exact) = (vec![slot], BTreeSet::new(), true);
        let mut next = 0;
        while let Some(&member) = members.get(next) {
            next += 1;
            for k in 0..3 {
                let neighbour = self.polytope.vertices.link(member, k).vertex();
                let Some(contraction) = self.contraction(member, k).filter(|c| follows(*c)) else { continue };
                is_exact &= contraction == Contraction::Exact;
                if neighbour != slot && known.insert(neighbour) {
                    members.push(neighbour);
                }
            }
        }
        (members, is_exact)
    }

    fn name(&self, members: &[u32]) -> u32 {
        let key = |slot: &&u32| (self.polytope.infinity_planes(**slot), **slot);
        *members.iter().min_by_key(key).expect("a cluster has a member")
    }

    /// The vertices of a cluster, by either way to name clusters; it hangs together by edges.
    pub(super) fn members(&mut self, slot: u32, by: Naming) -> Vec<u32> {
        let name = self.named(slot, by);
        let (mut members, mut known) = (vec![slot], BTreeSet::from([slot]));
        let mut next = 0;
        while let Some(&member) = members.get(next) {
            next += 1;
            for neighbour in self.polytope.vertices.neighbours(member) {
                if self.named(neighbour, by) == name && known.insert(neighbour) {
                    members.push(neighbour);
                }
            }
        }
        members
    }

    /// Whether a cluster is hidden: a place at infinity that no edge between planes of the user's reaches.
    pub(super) fn is_hidden(&self, name: u32) -> bool {
        self.polytope.infinity_planes(name) > 1
    }

    /// Whether and why the edge that leaves a vertex at index `k` is contracted.
    pub(super) fn contraction(&self, slot: u32, k: usize) -> Option<Contraction> {
        let polytope = self.polytope;
        let link = polytope.vertices.link(slot, k);
        let neighbour = link.vertex();
        let is_ideal = polytope.vertices.is_ideal(slot);
        if is_ideal != polytope.vertices.is_ideal(neighbour) || (!is_ideal && self.is_surely_long(slot, neighbour)) {
            return None;
        }
        let across = polytope.vertices.planes(neighbour)[link.index()];
        if polytope.is_exactly_on(polytope.vertices.planes(slot), across) {
            return Some(Contraction::Exact);
        }
        let is_short = !is_ideal && polytope.position(slot).distance(polytope.position(neighbour)) < polytope.epsilon;
        is_short.then_some(Contraction::Short)
    }

    /// Whether the cached positions show that two finite vertices lie farther apart than the tolerance.
    fn is_surely_long(&self, a: u32, b: u32) -> bool {
        let [(a, a_error), (b, b_error)] = [a, b].map(|slot| self.rough_position(slot));
        let tolerance = self.polytope.epsilon.max(0.0) * (1.0 + 1e-9);
        (0..3).any(|axis| (a[axis] - b[axis]).abs() - a_error[axis] - b_error[axis] > tolerance)
    }

    /// A position from the cache, and bounds of how far the correctly rounded one is from it.
    fn rough_position(&self, slot: u32) -> ([f64; 3], [f64; 3]) {
        let point = self.polytope.vertices.point(slot).homogeneous();
        let (value, permanent) = (point.value, point.permanent);
        let w = value[3].abs() - POSITION_BOUND * permanent[3];
        if w.is_nan() || w <= 0.5 * value[3].abs() {
            return ([0.0; 3], [f64::INFINITY; 3]);
        }
        let position: [f64; 3] = std::array::from_fn(|axis| value[axis] / value[3]);
        let error = std::array::from_fn(|axis| {
            let magnitude = position[axis].abs();
            POSITION_BOUND * (permanent[axis] + magnitude * permanent[3]) / w + POSITION_BOUND * magnitude
        });
        (position, error)
    }

    /// Whether a plane with a face in the structure has a seen face: three different corners or more. `start` is one of
    /// its vertices.
    pub(super) fn is_seen(&mut self, plane: u32, start: u32, by: Naming) -> bool {
        let known = match by {
            Naming::Tentative => self.seen_tentatively.get(plane),
            Naming::Settled => self.seen.get(plane),
        };
        if let Some(known) = known {
            return known == 1;
        }
        let polytope = self.polytope;
        let first = self.named(start, by);
        let mut second = None;
        let is_seen = polytope.vertices.face_ring(plane, start).any(|slot| {
            let name = self.named(slot, by);
            name != first && *second.get_or_insert(name) != name
        });
        match by {
            Naming::Tentative => self.seen_tentatively.set(plane, u32::from(is_seen)),
            Naming::Settled => self.seen.set(plane, u32::from(is_seen)),
        }
        is_seen
    }

    /// The number of the bundle of a half-edge, where it was worked out.
    pub(super) fn known_bundle(&self, half_edge: u32) -> Option<u32> {
        self.bundle_of.get(half_edge)
    }

    /// Remembers the bundle of a half-edge.
    pub(super) fn set_bundle(&mut self, half_edge: u32, number: u32) {
        self.bundle_of.set(half_edge, number);
    }
}
