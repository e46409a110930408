//! The planes in use, snapped as a table of all of them would be, whatever the order in which they came.
//!
//! [`PlaneTable::intern`] goes through all planes in an order that depends on the planes alone and takes each for an earlier one
//! that is near. What becomes of a plane so depends on those within the tolerance of it, of these, and so on: mostly on none.
//! When a plane comes or goes, that is worked out again for what it hangs together with. Near the origin the tolerance depends on the size
//! of the smallest body; when that changes, all planes are looked at that have any other near.

#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use planecut_kernel::HalfSpace;
use planecut_kernel::sign::Row;
use planecut_parallel::prelude::*;
use rustc_hash::{FxHashMap, FxHashSet};
use smallvec::{SmallVec, smallvec};

use crate::ids::{Id, OperandId, RowGroupId, holds};
use crate::plane_table::{
    Key, NearCells, PlaneId, PlaneTable, compare_coefficients, first_side, is_exact, is_nearly_same, key,
    settling_order, unit,
};

/// A plane that a face uses: the group of what is exactly the same plane, and whether it is the other side.
#[derive(Debug, Clone, Copy)]
pub(super) struct PlaneUse {
    group: RowGroupId,
    is_reversed: bool,
}

/// Planes in use.
#[derive(Clone, Default)]
pub(super) struct LivePlanes {
    pub(super) table: PlaneTable,
    groups: Vec<EqualRows>,
    free_groups: Vec<RowGroupId>,
    by_key: FxHashMap<Key, SmallVec<[RowGroupId; 1]>>,
    /// The sizes of the bodies, each with the number of bodies that have it.
    sizes: BTreeMap<u64, u32>,
    /// The smallest of them, when planes were last settled.
    size: f64,
    near: NearCells,
    /// Groups with others near them.
    crowded: FxHashSet<RowGroupId>,
    /// What came, went or has another row since the last time.
    changed: Vec<RowGroupId>,
    free_indices: Vec<u32>,
}

/// Rows of exactly one plane, on its side with a positive first coefficient. Most planes are those of one face of one body.
#[derive(Clone, Default)]
struct EqualRows {
    /// One of them, in use or not.
    plane: Option<Row>,
    /// Each with how often it is used; the least stands for the plane.
    rows: SmallVec<[(Row, u32); 1]>,
    /// The numbers of those who use it, as often as they do.
    users: SmallVec<[OperandId; 2]>,
    /// The unit normal and distance under which it is hashed, and whether it is exact; nothing before that.
    hashed: Option<([f64; 4], bool)>,
    /// The plane that it is taken for.
    id: Option<PlaneId>,
    /// The index in the table where it stands for itself.
    own: Option<u32>,
    is_changed: bool,
}

/// What settling came to.
#[derive(Default)]
pub(super) struct Settled {
    /// Users of planes that are now taken for others than before, ascending.
    pub(super) users: Vec<OperandId>,
    /// Indices that no group uses any more.
    pub(super) retired: Vec<u32>,
}

/// Number of groups from which all threads look for what is near them.
const MANY: usize = 1024;

impl EqualRows {
    fn is_plane_of(&self, row: &Row) -> bool {
        self.plane.as_ref().is_some_and(|plane| plane.is_same_plane(row))
    }

    /// The row that stands for the plane, where it is in use.
    fn row(&self) -> Option<&Row> {
        self.rows.iter().map(|(row, _)| row).min_by(|p, q| compare_coefficients(p, q))
    }
}

impl LivePlanes {
    /// None, beside those of a table that stay as they are.
    pub(super) fn new(table: PlaneTable) -> Self {
        Self { table, ..Self::default() }
    }

    /// Makes room for many planes.
    pub(super) fn reserve(&mut self, count: usize) {
        self.by_key.reserve(count);
        self.groups.reserve(count);
        self.near.reserve(count);
    }

    /// Uses the plane of a half-space; its id is known once it is settled.
    pub(super) fn take(&mut self, half_space: &HalfSpace, user: OperandId) -> PlaneUse {
        let (row, is_reversed) = first_side(&Row::new(half_space));
        let alike = self.by_key.entry(key(&row)).or_default();
        let known = alike.iter().copied().find(|group| self.groups[group.index()].is_plane_of(&row));
        let number = known.unwrap_or_else(|| {
            let number = self.free_groups.pop().unwrap_or_else(|| {
                self.groups.push(EqualRows::default());
                RowGroupId::from_index(self.groups.len() - 1)
            });
            self.groups[number.index()].plane = Some(row);
            alike.push(number);
            number
        });
        let group = &mut self.groups[number.index()];
        group.users.push(user);
        match group.rows.iter_mut().find(|known| known.0 == row) {
            Some(known) => known.1 += 1,
            None => {
                group.rows.push((row, 1));
                self.mark(number);
            }
        }
        PlaneUse { group: number, is_reversed }
    }

    /// Uses a plane once less.
    pub(super) fn release(&mut self, half_space: &HalfSpace, used: PlaneUse, user: OperandId) {
        let (row, _) = first_side(&Row::new(half_space));
        let group = &mut self.groups[used.group.index()];
        let place = group.users.iter().rposition(|known| *known == user).expect("a user is known");
        group.users.swap_remove(place);
        let place = group.rows.iter().position(|known| known.0 == row).expect("a row in use is known");
        group.rows[place].1 -= 1;
        if group.rows[place].1 == 0 {
            group.rows.swap_remove(place);
            self.mark(used.group);
        }
    }

    /// Puts another plane in the place of one under the same index, where that changes nothing for other planes: one face alone uses it, no
    /// other plane is near it, before or after, and what is near stays so. Otherwise nothing happens. `sizes` are those of the body before and after.
    pub(super) fn move_plane(&mut self, used: PlaneUse, to: &HalfSpace, sizes: [Option<f64>; 2]) -> bool {
        let (row, is_reversed) = first_side(&Row::new(to));
        let group = &self.groups[used.group.index()];
        let (Some(own), Some((before, _)), Some(plane)) = (group.own, group.hashed, group.plane) else { return false };
        let is_alone = group.users.len() == 1
            && group.id == Some(PlaneId::of_index(own))
            && is_reversed == used.is_reversed
            && !self.crowded.contains(&used.group);
        let alike = self.by_key.get(&key(&row)).map_or(&[][..], SmallVec::as_slice);
        let is_there = |other: &RowGroupId| *other != used.group && self.groups[other.index()].is_plane_of(&row);
        let after = unit(&row);
        let mut near = Vec::new();
        self.near.find(&after, |group| self.place_of(group), &mut near);
        near.retain(|other| *other != used.group);
        if !is_alone || alike.iter().any(is_there) || !near.is_empty() || !self.keeps_tolerance(sizes) {
            return false;
        }
        self.near.remove(&before, used.group);
        self.near.insert(&after, used.group);
        if let Some(alike) = self.by_key.get_mut(&key(&plane)) {
            alike.retain(|other| *other != used.group);
            if alike.is_empty() {
                self.by_key.remove(&key(&plane));
            }
        }
        self.by_key.entry(key(&row)).or_default().push(used.group);
        let group = &mut self.groups[used.group.index()];
        group.plane = Some(row);
        group.rows = smallvec![(row, 1)];
        group.hashed = Some((after, is_exact(&row)));
        self.table.put(own, &row);
        true
    }

    /// Counts the size of a body that changes, where planes that are nearly the same stay so.
    fn keeps_tolerance(&mut self, sizes: [Option<f64>; 2]) -> bool {
        let [before, after] = sizes;
        self.count_size(before, false);
        self.count_size(after, true);
        let smallest = self.smallest_size();
        if smallest == self.size || self.crowded.is_empty() && cell_size(smallest) == self.near.size() {
            self.size = smallest;
            return true;
        }
        self.count_size(after, false);
        self.count_size(before, true);
        false
    }

    fn smallest_size(&self) -> f64 {
        self.sizes.first_key_value().map_or(0.0, |(bits, _)| f64::from_bits(*bits))
    }

    fn mark(&mut self, number: RowGroupId) {
        let group = &mut self.groups[number.index()];
        if !group.is_changed {
            group.is_changed = true;
            self.changed.push(number);
        }
    }

    /// The id of a plane in use that is settled.
    pub(super) fn id(&self, used: PlaneUse) -> PlaneId {
        let id = self.groups[used.group.index()].id.expect("planes are settled before they are asked for");
        if used.is_reversed { id.flipped() } else { id }
    }

    /// Frees an index that was retired, for another plane.
    pub(super) fn free(&mut self, index: u32) {
        self.free_indices.push(index);
    }

    /// Works out for what each plane is taken that may be affected by what came and went. Planes that had an index among `kept`
    /// get it back.
    pub(super) fn settle(&mut self, kept: &[u32]) -> Settled {
        let mut settled = Settled::default();
        let mut doubtful: Vec<RowGroupId> = Vec::new();
        let mut moved: Vec<RowGroupId> = Vec::new();
        for number in std::mem::take(&mut self.changed) {
            let group = &mut self.groups[number.index()];
            group.is_changed = false;
            let hashed = group.row().map(|row| (unit(row), is_exact(row)));
            let before = std::mem::replace(&mut group.hashed, hashed);
            if hashed != before {
                if let Some((old, _)) = before {
                    self.near.remove(&old, number);
                    self.leave_crowd(number, &old, &mut doubtful);
                }
                if hashed.is_some() {
                    moved.push(number);
                }
            }
            if hashed.is_none() {
                self.drop_group(number, &mut settled);
            } else {
                doubtful.push(number);
            }
        }
        self.rehash(&moved, &mut doubtful);
        let mut seen: FxHashSet<RowGroupId> = FxHashSet::default();
        for number in doubtful {
            if self.groups[number.index()].hashed.is_none() || seen.contains(&number) {
                continue;
            }
            if !self.crowded.contains(&number) {
                // as most of them
                let own = self.own_index(number, kept);
                self.take_for(number, PlaneId::of_index(own), &mut settled);
                continue;
            }
            let cluster = self.cluster(number);
            seen.extend(cluster.iter().copied());
            self.settle_cluster(&cluster, kept, &mut settled);
        }
        settled.users.sort_unstable();
        settled.users.dedup();
        settled
    }

    /// Counts the size of a body that comes or goes.
    pub(super) fn count_size(&mut self, size: Option<f64>, comes: bool) {
        let Some(size) = size else { return };
        // of positive numbers the bits are in the same order
        let count = self.sizes.entry(size.to_bits()).or_default();
        if comes {
            *count += 1;
        } else {
            *count -= 1;
            if *count == 0 {
                self.sizes.remove(&size.to_bits());
            }
        }
    }

    /// Notes who is no longer near another, as a group is no longer where it was.
    fn leave_crowd(&mut self, number: RowGroupId, old: &[f64; 4], doubtful: &mut Vec<RowGroupId>) {
        if !self.crowded.remove(&number) {
            return;
        }
        let mut near = Vec::new();
        self.near.find(old, |group| self.place_of(group), &mut near);
        near.retain(|other| *other != number);
        doubtful.extend_from_slice(&near);
        for other in near {
            if self.neighbours(other).is_empty() {
                self.crowded.remove(&other);
            }
        }
    }

    /// Puts into the hash what is at another place, or all where the smallest size has grown or shrunk by much.
    fn rehash(&mut self, moved: &[RowGroupId], doubtful: &mut Vec<RowGroupId>) {
        let smallest = self.smallest_size();
        let is_other_size = self.size != smallest;
        self.size = smallest;
        let size = cell_size(smallest);
        let all: Vec<RowGroupId>;
        let moved = if size == self.near.size() {
            moved
        } else {
            self.near = NearCells::new(size);
            self.near.reserve(self.groups.len());
            doubtful.extend(self.crowded.drain());
            all = RowGroupId::all(self.groups.len()).collect();
            &all
        };
        for &number in moved {
            if let Some((unit, _)) = &self.groups[number.index()].hashed {
                self.near.insert(unit, number);
            }
        }
        let crowded = |number: &RowGroupId| {
            let near = self.neighbours(*number);
            (!near.is_empty()).then_some((*number, near))
        };
        let crowded: Vec<(RowGroupId, Vec<RowGroupId>)> = if moved.len() < MANY {
            moved.iter().filter_map(crowded).collect()
        } else {
            moved.par_iter().with_min_len(MANY / 4).filter_map(crowded).collect()
        };
        for (number, near) in crowded {
            self.crowded.extend(near);
            self.crowded.insert(number);
        }
        if is_other_size {
            doubtful.extend(self.crowded.iter());
        }
        // whatever the order of the set
        doubtful.sort_unstable();
    }

    /// The unit normal and distance under which a group is hashed.
    fn place_of(&self, number: RowGroupId) -> Option<[f64; 4]> {
        self.groups[number.index()].hashed.map(|(unit, _)| unit)
    }

    /// The other groups that are near a group, or would be if the tolerance were a little larger.
    fn neighbours(&self, number: RowGroupId) -> Vec<RowGroupId> {
        let mut near = Vec::new();
        if let Some((unit, _)) = &self.groups[number.index()].hashed {
            self.near.find(unit, |group| self.place_of(group), &mut near);
        }
        near.retain(|other| *other != number);
        near
    }

    /// What hangs together with a group.
    fn cluster(&self, number: RowGroupId) -> Vec<RowGroupId> {
        let mut cluster = vec![number];
        let mut next = 0;
        while next < cluster.len() {
            for other in self.neighbours(cluster[next]) {
                if !holds(&cluster, other) {
                    cluster.push(other);
                }
            }
            next += 1;
        }
        cluster
    }

    /// Finds for what each group of a cluster is taken: exact ones for themselves, others for the first within the tolerance.
    fn settle_cluster(&mut self, cluster: &[RowGroupId], kept: &[u32], settled: &mut Settled) {
        let mut order = cluster.to_vec();
        order.sort_by_cached_key(|number| self.groups[number.index()].row().map(settling_order));
        let mut leaders: Vec<RowGroupId> = Vec::new();
        for number in order {
            let (unit, is_exact) = self.groups[number.index()].hashed.expect("what is in a cluster is hashed");
            let leads = |flipped: bool| {
                let is_near = |leader: &&RowGroupId| {
                    let (other, _) = self.groups[leader.index()].hashed.expect("what leads a cluster is hashed");
                    is_nearly_same(&unit, &other, flipped, self.size)
                };
                leaders.iter().find(is_near).map(|leader| (*leader, flipped))
            };
            let leader = if is_exact { None } else { leads(false).or_else(|| leads(true)) };
            let id = match leader {
                Some((leader, flipped)) => {
                    let id = self.groups[leader.index()].id.expect("what leads comes first");
                    settled.retired.extend(self.groups[number.index()].own.take());
                    if flipped { id.flipped() } else { id }
                }
                None => {
                    leaders.push(number);
                    PlaneId::of_index(self.own_index(number, kept))
                }
            };
            self.take_for(number, id, settled);
        }
    }

    /// Takes the planes of a group for one.
    fn take_for(&mut self, number: RowGroupId, id: PlaneId, settled: &mut Settled) {
        let group = &mut self.groups[number.index()];
        if group.id.replace(id) != Some(id) {
            settled.users.extend_from_slice(&group.users);
        }
    }

    /// The index of a group that stands for itself.
    fn own_index(&mut self, number: RowGroupId, kept: &[u32]) -> u32 {
        let group = &mut self.groups[number.index()];
        if let Some(own) = group.own {
            return own;
        }
        let row = *group.row().expect("what is settled is in use");
        let is_same = |index: &&u32| self.table.row(PlaneId::of_index(**index)).is_same_plane(&row);
        let index = if let Some(index) = kept.iter().find(is_same) {
            *index
        } else if let Some(index) = self.free_indices.pop() {
            self.table.put(index, &row);
            index
        } else {
            self.table.push(&row).index()
        };
        self.groups[number.index()].own = Some(index);
        index
    }

    /// Forgets a group that nobody uses.
    fn drop_group(&mut self, number: RowGroupId, settled: &mut Settled) {
        let group = &mut self.groups[number.index()];
        settled.retired.extend(group.own.take());
        group.id = None;
        let row = group.plane.take().expect("a group that was used has a plane");
        let alike = self.by_key.get_mut(&key(&row)).expect("a group is found by its plane");
        alike.retain(|other| *other != number);
        if alike.is_empty() {
            self.by_key.remove(&key(&row));
        }
        self.free_groups.push(number);
    }
}

/// The size for which planes are hashed where that of the smallest body is known: the next power of two.
fn cell_size(smallest: f64) -> f64 {
    smallest.max(f64::MIN_POSITIVE).log2().ceil().exp2()
}
