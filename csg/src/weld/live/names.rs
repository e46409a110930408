//! Things that several names stand for, numbered as long as one of the names is in use.

use std::hash::Hash;

use rustc_hash::FxHashMap;

use crate::base::map_chunks;
use crate::ids::{Id, NameId};

/// The numbers of things by name. Equal things have equal marks; different ones hardly ever do.
#[derive(Debug, Clone)]
pub(super) struct Names<N, T> {
    by_name: FxHashMap<N, NameId>,
    names: Vec<Name<N, T>>,
    free_names: Vec<NameId>,
    /// The last thing of each mark.
    by_mark: FxHashMap<u64, T>,
    things: Vec<Thing<T>>,
    free_things: Vec<T>,
}

#[derive(Debug, Clone)]
struct Name<N, T> {
    name: N,
    thing: T,
    uses: u32,
}

#[derive(Debug, Clone, Copy)]
struct Thing<T> {
    mark: u64,
    /// The one before of the same mark, [`Id::NONE`] where there is none.
    before: T,
    names: u32,
}

impl<N, T> Default for Names<N, T> {
    fn default() -> Self {
        Self {
            by_name: FxHashMap::default(),
            names: Vec::new(),
            free_names: Vec::new(),
            by_mark: FxHashMap::default(),
            things: Vec::new(),
            free_things: Vec::new(),
        }
    }
}

impl<N: Copy + Eq + Hash, T: Id> Names<N, T> {
    /// The number of a name, where it is known.
    pub(super) fn find(&self, name: &N) -> Option<NameId> {
        self.by_name.get(name).copied()
    }

    /// Uses names, each once for each time it is given.
    pub(super) fn use_all(&mut self, numbers: &[NameId]) {
        for number in numbers {
            self.names[number.index()].uses += 1;
        }
    }

    /// Makes room for many names that are not known.
    pub(super) fn reserve(&mut self, count: usize) {
        self.by_name.reserve(count);
        self.by_mark.reserve(count);
    }

    /// Adds a name that is not known, for the thing of a mark that `is_same`, or for a new one; whether it is new. The name is to be used then.
    pub(super) fn add(&mut self, name: N, mark: u64, is_same: impl Fn(T) -> bool) -> (NameId, bool) {
        let last = self.by_mark.get(&mark).copied().unwrap_or(T::NONE);
        let mut alike = last;
        while alike != T::NONE && !is_same(alike) {
            alike = self.things[alike.index()].before;
        }
        let is_new = alike == T::NONE;
        if is_new {
            alike = place(&mut self.things, &mut self.free_things, Thing { mark, before: last, names: 0 });
            self.by_mark.insert(mark, alike);
        }
        self.things[alike.index()].names += 1;
        let number = place(&mut self.names, &mut self.free_names, Name { name, thing: alike, uses: 0 });
        self.by_name.insert(name, number);
        (number, is_new)
    }

    /// The number of the thing that a name stands for.
    pub(super) fn thing(&self, name: NameId) -> T {
        self.names[name.index()].thing
    }

    /// Uses a name once less; gives the number of its thing where that has no name left, and is free for another.
    pub(super) fn release(&mut self, number: NameId) -> Option<T> {
        let name = &mut self.names[number.index()];
        name.uses -= 1;
        if name.uses > 0 {
            return None;
        }
        let thing = name.thing;
        self.by_name.remove(&name.name);
        self.free_names.push(number);
        let Thing { mark, before, names } = &mut self.things[thing.index()];
        *names -= 1;
        if *names > 0 {
            return None;
        }
        let (mark, before) = (*mark, *before);
        self.unlink(thing, mark, before);
        self.free_things.push(thing);
        Some(thing)
    }

    /// Whether a thing has a name.
    pub(super) fn is_in_use(&self, thing: T) -> bool {
        self.things[thing.index()].names > 0
    }

    /// Gives a thing another mark, where it is in use.
    pub(super) fn set_mark(&mut self, thing: T, mark: u64) {
        let Thing { mark: old, before, names } = self.things[thing.index()];
        if names > 0 && old != mark {
            self.unlink(thing, old, before);
            let last = self.by_mark.insert(mark, thing).unwrap_or(T::NONE);
            self.things[thing.index()] = Thing { mark, before: last, names };
        }
    }

    /// Takes a thing out of the list of those of its mark.
    fn unlink(&mut self, thing: T, mark: u64, before: T) {
        let last = self.by_mark.get_mut(&mark).expect("the mark of a thing is known");
        if *last != thing {
            let mut later = *last;
            while self.things[later.index()].before != thing {
                later = self.things[later.index()].before;
            }
            self.things[later.index()].before = before;
        } else if before != T::NONE {
            *last = before;
        } else {
            self.by_mark.remove(&mark);
        }
    }
}

/// For each of different names its number, or where it is not known what it takes to add it; worked out by all threads.
pub(super) fn find_all<N: Copy + Eq + Hash + Sync, T: Id, R: Send>(
    names: &Names<N, T>,
    different: &[N],
    work: impl Fn(&N) -> R + Sync,
) -> Vec<Result<NameId, R>> {
    let find = |name: &N| names.find(name).ok_or_else(|| work(name));
    let (parts, _) = map_chunks(different, 256, |names| names.iter().map(find).collect::<Vec<_>>());
    parts.into_iter().flatten().collect()
}

/// Puts an entry into a free place, or at the end; gives the place.
pub(super) fn place<I: Id, T>(entries: &mut Vec<T>, free: &mut Vec<I>, entry: T) -> I {
    match free.pop() {
        Some(place) => {
            entries[place.index()] = entry;
            place
        }
        None => {
            let place = I::from_index(entries.len());
            entries.push(entry);
            place
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ids::PointId;

    #[test]
    fn things_live_as_long_as_a_name_is_in_use() {
        let mut names: Names<u32, PointId> = Names::default();
        // names below 10 stand for 1, others for 2; all have one mark
        let meaning = |name: u32| if name < 10 { 1 } else { 2 };
        let mut meanings = [0; 4];
        let mut take = |names: &mut Names<u32, PointId>, name: u32| {
            let (id, is_new) = match names.find(&name) {
                Some(id) => (id, false),
                None => names.add(name, 7, |thing| meanings[thing.index()] == meaning(name)),
            };
            if is_new {
                meanings[names.thing(id).index()] = meaning(name);
            }
            names.use_all(&[id]);
            id
        };
        let [a, b, c, again] = [1, 11, 2, 1].map(|name| take(&mut names, name));
        assert_eq!((names.thing(a), a), (names.thing(c), again));
        assert_ne!(names.thing(a), names.thing(b));
        let (one, two) = (names.thing(a), names.thing(b));
        assert_eq!([a, c].map(|name| names.release(name)), [None, None]);
        assert_eq!(names.release(a), Some(one));
        let [other, reused] = [12, 3].map(|name| take(&mut names, name));
        assert_eq!((names.thing(other), names.thing(reused)), (two, one));
    }
}
