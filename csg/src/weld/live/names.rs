//! Things that several names stand for, numbered as long as one of the names is in use.

use std::hash::Hash;

use hashbrown::HashTable;

use crate::base::{hash_of, map_chunks};
use crate::ids::{Id, NameId};

/// The numbers of things by name. Equal things have equal marks, which are hashes; different ones hardly ever do. Tables hold numbers alone: there are very many.
#[derive(Debug, Clone)]
pub(super) struct Names<N, T> {
    by_name: HashTable<NameId>,
    names: Vec<Name<N, T>>,
    free_names: Vec<NameId>,
    /// The last thing of each mark.
    by_mark: HashTable<T>,
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
            by_name: HashTable::new(),
            names: Vec::new(),
            free_names: Vec::new(),
            by_mark: HashTable::new(),
            things: Vec::new(),
            free_things: Vec::new(),
        }
    }
}

impl<N: Copy + Eq + Hash, T: Id> Names<N, T> {
    /// The number of a name, where it is known.
    pub(super) fn find(&self, name: &N) -> Option<NameId> {
        let is_same = |number: &NameId| self.names[number.index()].name == *name;
        self.by_name.find(hash_of(name), is_same).copied()
    }

    /// Uses names, each once for each time it is given.
    pub(super) fn use_all(&mut self, numbers: &[NameId]) {
        for number in numbers {
            self.names[number.index()].uses += 1;
        }
    }

    /// Makes room for many names that are not known.
    pub(super) fn reserve(&mut self, count: usize) {
        let Self { by_name, names, by_mark, things, .. } = self;
        by_name.reserve(count, |number| hash_of(&names[number.index()].name));
        by_mark.reserve(count, |thing| things[thing.index()].mark);
        names.reserve(count);
        things.reserve(count);
    }

    /// Adds a name that is not known, for the thing of a mark that `is_same`, or for a new one; whether it is new. The name is to be used then.
    pub(super) fn add(&mut self, name: N, mark: u64, is_same: impl Fn(T) -> bool) -> (NameId, bool) {
        let Self { by_name, names, free_names, by_mark, things, free_things } = self;
        let marked = by_mark.find_mut(mark, |thing| things[thing.index()].mark == mark);
        let last = marked.as_deref().copied().unwrap_or(T::NONE);
        let mut alike = first_of(things, last, is_same);
        let is_new = alike == T::NONE;
        if is_new {
            alike = place(things, free_things, Thing { mark, before: last, names: 0 });
            match marked {
                Some(marked) => *marked = alike,
                None => {
                    by_mark.insert_unique(mark, alike, |thing| things[thing.index()].mark);
                }
            }
        }
        things[alike.index()].names += 1;
        let number = place(names, free_names, Name { name, thing: alike, uses: 0 });
        by_name.insert_unique(hash_of(&name), number, |number| hash_of(&names[number.index()].name));
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
        if let Ok(entry) = self.by_name.find_entry(hash_of(&name.name), |other| *other == number) {
            entry.remove();
        }
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

    /// By how many names in use a thing is known.
    pub(super) fn count_of(&self, thing: T) -> usize {
        self.things[thing.index()].names as usize
    }

    /// A thing other than one that has a mark and `is_same`.
    pub(super) fn another(&self, thing: T, mark: u64, is_same: impl Fn(T) -> bool) -> Option<T> {
        let last = self.by_mark.find(mark, |other| self.things[other.index()].mark == mark).copied()?;
        let alike = first_of(&self.things, last, |other| other != thing && is_same(other));
        (alike != T::NONE).then_some(alike)
    }

    /// Takes a thing out of the list of those of its mark, so that it is found no more; it gets no other names. Its number is in use until [`Names::free`].
    pub(super) fn retire(&mut self, thing: T) {
        let Thing { mark, before, .. } = self.things[thing.index()];
        self.unlink(thing, mark, before);
    }

    /// Makes a name stand for another thing than one that has been retired.
    pub(super) fn rename(&mut self, name: NameId, thing: T) {
        let old = std::mem::replace(&mut self.names[name.index()].thing, thing);
        if old != thing {
            self.things[old.index()].names -= 1;
            self.things[thing.index()].names += 1;
        }
    }

    /// The number of a thing that has been retired and has no names is free for another.
    pub(super) fn free(&mut self, thing: T) {
        self.free_things.push(thing);
    }

    /// Gives a thing another mark, where it is in use.
    pub(super) fn set_mark(&mut self, thing: T, mark: u64) {
        let Thing { mark: old, before, names } = self.things[thing.index()];
        if names > 0 && old != mark {
            self.unlink(thing, old, before);
            let Self { by_mark, things, .. } = self;
            let is_same = |other: &T| things[other.index()].mark == mark;
            let last = match by_mark.find_mut(mark, is_same) {
                Some(marked) => std::mem::replace(marked, thing),
                None => T::NONE,
            };
            things[thing.index()] = Thing { mark, before: last, names };
            if last == T::NONE {
                by_mark.insert_unique(mark, thing, |thing| things[thing.index()].mark);
            }
        }
    }

    /// Takes a thing out of the list of those of its mark.
    fn unlink(&mut self, thing: T, mark: u64, before: T) {
        let Self { by_mark, things, .. } = self;
        let is_same = |other: &T| things[other.index()].mark == mark;
        let mut last = by_mark.find_entry(mark, is_same).expect("the mark of a thing is known");
        if *last.get() != thing {
            let mut later = *last.get();
            while things[later.index()].before != thing {
                later = things[later.index()].before;
            }
            things[later.index()].before = before;
        } else if before != T::NONE {
            *last.get_mut() = before;
        } else {
            last.remove();
        }
    }
}

/// Of the things of one mark, the last of which is given, one that `is_same`; [`Id::NONE`] where there is none.
fn first_of<T: Id>(things: &[Thing<T>], last: T, is_same: impl Fn(T) -> bool) -> T {
    let mut alike = last;
    while alike != T::NONE && !is_same(alike) {
        alike = things[alike.index()].before;
    }
    alike
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
