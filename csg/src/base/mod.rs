//! What several stages build on: boxes and a tree of them, rays, union-find, numbers for keys, sums, a clock, work in parallel.

mod bounds;
mod box_tree;
mod by_group;
mod clock;
mod exact_sum;
mod interning;
mod memory;
mod parallel;
mod push_if;
mod rays;
mod sorting;
pub(crate) mod sum;
pub(crate) mod union_find;
mod workers;

pub use bounds::Bounds;
pub use box_tree::Boxes;
pub(crate) use by_group::by_group;
pub(crate) use clock::Clock;
pub(crate) use exact_sum::ExactSum;
pub(crate) use interning::{WEIGHTS, hash_of, intern, sortable};
pub(crate) use memory::{takes_much_memory, with_room};
pub(crate) use parallel::{
    by_parts, concat_made, concat_owned, made_by_place, map_chunks, map_fixed_chunks, map_items, map_owned, map_ranges,
    map_weighed_chunks, map_weighed_chunks_into, repeated, runs_apart, split_by, starts_of, weighed_runs,
};
pub(crate) use push_if::push_if;
pub(crate) use rays::IN_BOX;
pub use rays::{Ray, RayCaster};
pub(crate) use sorting::{number_of_two, sort_by_number, sort_few};
pub use sum::CompensatedSum;
pub use union_find::DisjointSets;
pub(crate) use workers::Workers;
