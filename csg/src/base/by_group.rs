//! Lists of the members of groups, one group after another.

use std::ops::Range;
use std::sync::atomic::{AtomicU32, Ordering};

use planecut_parallel::prelude::*;

use super::memory::takes_much_memory;
use super::parallel::repeated;
use crate::ids::number32;

/// Least number of members that a thread looks at in a row.
const MEMBERS_OF_CHUNK: usize = 1 << 13;

/// Most parts of the members that are looked at at once: for each there is a list of all groups.
const MOST_PARTS: usize = 16;

/// Sorts members by their groups: for groups numbered from 0 to `groups`, where each begins in a list of all members by group, where the last one ends,
/// and that list; members keep their order. `group_of` gives the group of a member from its place, and is asked twice; `number` gives what it is listed as.
pub(crate) fn by_group<M: Copy + Send + Sync>(
    groups: usize,
    members: usize,
    group_of: impl Fn(usize) -> usize + Sync,
    number: impl Fn(usize) -> M + Sync,
) -> (Vec<u32>, Vec<M>) {
    // a list of all groups for each part is not to be longer than the members of it
    let most = (members / (groups + 1)).min(members / MEMBERS_OF_CHUNK).min(MOST_PARTS);
    let parts = planecut_parallel::current_num_threads().min(most);
    // of many members there is no second list
    let has_room = !takes_much_memory::<M>(members) || size_of::<M>() == size_of::<AtomicU32>();
    if parts > 1 && has_room {
        by_group_in_parts(groups, members, parts, group_of, number)
    } else {
        by_group_in_a_row(groups, members, group_of, number)
    }
}

fn by_group_in_a_row<M: Copy>(
    groups: usize,
    members: usize,
    group_of: impl Fn(usize) -> usize,
    number: impl Fn(usize) -> M,
) -> (Vec<u32>, Vec<M>) {
    let mut starts = vec![0_u32; groups + 1];
    (0..members).for_each(|member| starts[group_of(member) + 1] += 1);
    for k in 0..groups {
        starts[k + 1] += starts[k];
    }
    if members == 0 {
        return (starts, Vec::new());
    }
    let mut next = starts.clone();
    let mut sorted = vec![number(0); members];
    for member in 0..members {
        let place = &mut next[group_of(member)];
        sorted[*place as usize] = number(member);
        *place += 1;
    }
    (starts, sorted)
}

/// The same in parts of the members: where those of a group begin that are in a part follows from how many there are in the parts before.
fn by_group_in_parts<M: Copy + Send + Sync>(
    groups: usize,
    members: usize,
    parts: usize,
    group_of: impl Fn(usize) -> usize + Sync,
    number: impl Fn(usize) -> M + Sync,
) -> (Vec<u32>, Vec<M>) {
    let part = |k: usize| -> Range<usize> { k * members / parts..(k + 1) * members / parts };
    let mut next: Vec<Vec<u32>> = planecut_parallel::map_parts(parts, |k| {
        let mut counts = vec![0_u32; groups];
        part(k).for_each(|member| counts[group_of(member)] += 1);
        counts
    });
    let (mut starts, mut end) = (Vec::with_capacity(groups + 1), 0);
    for group in 0..groups {
        starts.push(end);
        for counts in &mut next {
            end += std::mem::replace(&mut counts[group], end);
        }
    }
    starts.push(end);
    let sorted = repeated(members, || AtomicU32::new(0));
    next.par_iter_mut().enumerate().with_max_len(1).for_each(|(k, next)| {
        for member in part(k) {
            let place = &mut next[group_of(member)];
            sorted[*place as usize].store(number32(member), Ordering::Relaxed);
            *place += 1;
        }
    });
    drop(next);
    let number = |member: AtomicU32| number(member.into_inner() as usize);
    let sorted = if takes_much_memory::<M>(members) {
        // in its place
        sorted.into_iter().map(number).collect()
    } else {
        sorted.into_par_iter().with_min_len(MEMBERS_OF_CHUNK / 4).map(number).collect()
    };
    (starts, sorted)
}

#[cfg(test)]
mod tests {
    use planecut_testkit::random::Rng;

    use super::*;

    #[test]
    fn members_are_listed_by_group_in_their_order() {
        let groups = [2, 0, 2, 3, 0, 2];
        let (starts, sorted) = by_group(5, groups.len(), |member| groups[member], |member| member);
        assert_eq!(starts, [0, 2, 2, 5, 6, 6]);
        assert_eq!(sorted, [1, 4, 0, 2, 5, 3]);
        let nobody: [u32; 0] = [];
        // nobody is asked for a number
        assert_eq!(by_group(2, 0, |_| 0, |place| nobody[place]), (vec![0, 0, 0], vec![]));
    }

    #[test]
    fn parts_list_what_one_way_through_all_members_does() {
        for seed in 0..20 {
            let mut rng = Rng::spread(seed);
            let (groups, members) = (1 + rng.below(60), rng.below(2_000));
            let of_member: Vec<usize> = (0..members).map(|_| rng.below(groups)).collect();
            let mut expected: Vec<(usize, usize)> = of_member.iter().copied().zip(0..).collect();
            expected.sort_unstable();
            for parts in [1, 2, 3, 16] {
                let (starts, sorted) =
                    by_group_in_parts(groups, members, parts, |member| of_member[member], |member| member);
                let listed = (0..groups).flat_map(|group| {
                    let range = starts[group] as usize..starts[group + 1] as usize;
                    sorted[range].iter().map(move |member| (group, *member))
                });
                assert!(listed.eq(expected.iter().copied()), "seed {seed}, {parts} parts");
            }
        }
    }
}
