//! Where the tolerance may contract: only where a polytope's topology is left.
//!
//! Short edges form chains, and a needle, a plate or a polytope smaller than the tolerance would collapse. The rule:
//! call *tentative* the clusters that all contractions together give. Two of them belong together where a face has
//! corners in these two only. A group so connected is contracted where each of its clusters
//!
//! 1. is a disk: `V − E + F = 1` for the vertices in it and the edges and faces between them,
//! 2. meets each face in one run of its ring,
//! 3. has at least three faces with three different corners or more,
//!
//! and where no two such faces that the contraction brings together meet along another edge as well; otherwise none of
//! the group is contracted beyond exact coincidence.
//!
//! Why the result is sound: a sphere with disjoint disks shrunk to points is a sphere, so Euler's formula holds; by 2 a
//! face is a polygon with different corners; by 3 faces with two corners, which are left out and their edges merged,
//! never go all around a vertex; and by the last condition two faces have one edge in common at most. A group that is
//! not contracted has its exact faces, because every face that the contraction would flatten lies in one group.

use std::collections::{BTreeMap, BTreeSet};

use super::super::store::{BEFORE, Link};
use super::cluster::{Clusters, Contraction, Naming};
use super::edge::handle;

/// A face with corners in two tentative clusters only.
struct Flattened {
    plane: u32,
    /// A corner in the one.
    start: u32,
    /// The name of the other.
    other: u32,
}

impl Clusters<'_> {
    /// Whether the tolerance may contract a tentative cluster.
    pub(super) fn is_kept(&mut self, tentative: u32) -> bool {
        if let Some(kept) = self.kept.get(&tentative) {
            return *kept;
        }
        let mut group = vec![tentative];
        let mut flattened = Vec::new();
        let mut is_sound = true;
        let mut next = 0;
        while let Some(&cluster) = group.get(next) {
            next += 1;
            let (cluster_is_sound, between) = self.examine(cluster);
            is_sound &= cluster_is_sound;
            for face in between {
                // `kept` marks what the group holds until the answer is known
                if self.kept.insert(face.other, true).is_none() && face.other != tentative {
                    group.push(face.other);
                }
                flattened.push(face);
            }
        }
        let is_sound = is_sound && self.meet_once(&flattened);
        for cluster in group {
            self.kept.insert(cluster, is_sound);
        }
        is_sound
    }

    /// Whether the faces on both sides of flattened ones meet along no other edge.
    fn meet_once(&mut self, flattened: &[Flattened]) -> bool {
        let mut known = BTreeSet::new();
        for face in flattened {
            let mut edges = self.polytope.edges_of_face(face.plane, face.start).map(|(edge, _)| edge);
            let Some(edge) = edges.find(|edge| self.has_length(*edge, Naming::Tentative)) else { return false };
            if known.contains(&handle(self.polytope.smaller_half(edge))) {
                continue;
            }
            let Some((bundled, planes)) = self.walk_bundle(edge, Naming::Tentative) else { return false };
            if self.meet_elsewhere(&bundled, planes) {
                return false;
            }
            known.extend(bundled.into_iter().map(handle));
        }
        true
    }

    /// Whether two planes have an edge between them that is not in a bundle. Both rings are walked together, so that the
    /// shorter one sets the cost.
    fn meet_elsewhere(&mut self, bundled: &[Link], [p, q]: [u32; 2]) -> bool {
        let polytope = self.polytope;
        let ring = |plane: u32| polytope.edges_of_face(plane, polytope.planes.face_vertex(plane));
        ring(p).zip(ring(q)).any(|(at_p, at_q)| self.joins(at_p, [p, q], bundled) || self.joins(at_q, [q, p], bundled))
    }

    /// Whether an edge of the ring of `from` leads to `to` and is not in a bundle.
    fn joins(&mut self, (edge, across): (Link, u32), [from, to]: [u32; 2], bundled: &[Link]) -> bool {
        if bundled.contains(&self.polytope.smaller_half(edge)) {
            return false;
        }
        if across == to {
            // an edge of some length, even a contracted one: its own group may not be contracted in the end
            return self.contraction(edge.vertex(), edge.index()) != Some(Contraction::Exact);
        }
        self.walk_bundle(edge, Naming::Tentative).is_some_and(|(_, planes)| planes == [from.min(to), from.max(to)])
    }

    /// Whether a tentative cluster fulfils the three conditions, and the faces that have corners in it and one other only.
    fn examine(&mut self, cluster: u32) -> (bool, Vec<Flattened>) {
        let polytope = self.polytope;
        let members = self.members(cluster, Naming::Tentative);
        let mut half_edges = 0;
        // for each face: one corner in the cluster, and how often its ring enters the cluster
        let mut faces: BTreeMap<u32, (u32, usize)> = BTreeMap::new();
        for &member in &members {
            for (k, plane) in polytope.vertices.planes(member).into_iter().enumerate() {
                let inside = |clusters: &mut Self, k: usize| {
                    clusters.tentative(polytope.vertices.link(member, k).vertex()) == cluster
                };
                half_edges += usize::from(inside(self, k));
                // the edge to the vertex before on the ring leaves off the plane before
                let enters = !inside(self, BEFORE[k]);
                faces.entry(plane).or_insert((member, 0)).1 += usize::from(enters);
            }
        }
        let flat = faces.values().filter(|(_, runs)| *runs == 0).count();
        let is_disk = members.len() + flat == 1 + half_edges / 2;
        let in_one_run = faces.values().all(|(_, runs)| *runs <= 1);
        let (mut proper, mut flattened) = (0, Vec::new());
        for (&plane, &(start, runs)) in &faces {
            if runs == 0 {
                continue;
            }
            match self.only_other(cluster, plane, start) {
                None => proper += 1,
                Some(other) if polytope.vertices.is_ideal(other) => {}
                Some(other) => flattened.push(Flattened { plane, start, other }),
            }
        }
        (is_disk && in_one_run && proper >= 3, flattened)
    }

    /// The other tentative cluster of a face that has corners in two only.
    fn only_other(&mut self, cluster: u32, plane: u32, start: u32) -> Option<u32> {
        let polytope = self.polytope;
        let mut found = None;
        for slot in polytope.vertices.face_ring(plane, start) {
            let name = self.tentative(slot);
            if name != cluster && *found.get_or_insert(name) != name {
                return None;
            }
        }
        found
    }
}
