//! JSON as a flat list of entries that remember where they stand.
//!
//! A tree of owned values would need a deep stack to be dropped, and would forget its lines. Here each value is one entry in
//! the order of the text, a container knowing where it ends; nothing is recursive, so depth costs nothing.

mod describe;
mod parse;
mod path;

use std::borrow::Cow;

pub(super) use parse::parse;

/// A value: its place in [`Document`]'s list.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) struct Entry(u32);

impl Entry {
    /// The outermost value.
    pub(super) const ROOT: Self = Self(0);
}

/// What a value is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Kind {
    Null,
    Bool(bool),
    Number(f64),
    /// Also the key of a member, in front of its value.
    Text,
    List,
    Object,
}

/// One value of the text.
#[derive(Debug, Clone, Copy)]
struct Record {
    /// Where it begins, in bytes.
    offset: u32,
    /// The entry that follows it and all that it holds.
    next: u32,
    kind: Kind,
}

/// A JSON text, taken apart.
#[derive(Debug)]
pub(super) struct Document<'a> {
    text: &'a str,
    records: Vec<Record>,
}

impl<'a> Document<'a> {
    /// The outermost value.
    pub(super) fn root(&self) -> Entry {
        Entry::ROOT
    }

    /// What a value is.
    pub(super) fn kind(&self, entry: Entry) -> Kind {
        self.record(entry).kind
    }

    /// Where a value begins, in bytes.
    pub(super) fn offset(&self, entry: Entry) -> usize {
        self.record(entry).offset as usize
    }

    /// The values of a list; nothing for another kind.
    pub(super) fn items(&self, entry: Entry) -> Items<'_, 'a> {
        let end = if self.kind(entry) == Kind::List { self.record(entry).next } else { 0 };
        Items { document: self, at: entry.0 + 1, end }
    }

    /// A number, or those of a list; expressions are left out.
    pub(super) fn numbers_of(&self, entry: Entry) -> impl Iterator<Item = f64> {
        let number = |entry| match self.kind(entry) {
            Kind::Number(value) => Some(value),
            _ => None,
        };
        self.items(entry).chain((self.kind(entry) != Kind::List).then_some(entry)).filter_map(number)
    }

    /// Keys and values of an object; nothing for another kind.
    pub(super) fn members(&self, entry: Entry) -> impl Iterator<Item = (Entry, Entry)> {
        let end = if self.kind(entry) == Kind::Object { self.record(entry).next } else { 0 };
        let mut values = Items { document: self, at: entry.0 + 1, end };
        std::iter::from_fn(move || Some((values.next()?, values.next()?)))
    }

    /// The value of a key of an object.
    pub(super) fn member(&self, entry: Entry, key: &str) -> Option<Entry> {
        self.members(entry).find(|(name, _)| self.text(*name) == key).map(|(_, value)| value)
    }

    /// A text without its quotes and escapes; empty for another kind.
    pub(super) fn text(&self, entry: Entry) -> Cow<'a, str> {
        match self.kind(entry) {
            Kind::Text => parse::text_at(self.text, self.offset(entry)),
            _ => Cow::Borrowed(""),
        }
    }

    fn record(&self, entry: Entry) -> &Record {
        &self.records[entry.0 as usize]
    }
}

/// The values of a list, in order.
#[derive(Debug, Clone)]
pub(super) struct Items<'d, 'a> {
    document: &'d Document<'a>,
    at: u32,
    end: u32,
}

impl Iterator for Items<'_, '_> {
    type Item = Entry;

    fn next(&mut self) -> Option<Entry> {
        if self.at >= self.end {
            return None;
        }
        let entry = Entry(self.at);
        self.at = self.document.record(entry).next;
        Some(entry)
    }
}
