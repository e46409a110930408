//! Values in words, for errors.

use super::parse::word_of;
use super::{Document, Entry, Kind};
use crate::source::{shorten, shown_token};

impl Document<'_> {
    /// A value in a few words: a number or a short text as it is written.
    pub(in crate::model) fn describe(&self, entry: Entry) -> String {
        let count = |count: usize, one: &str, many: &str| match count {
            1 => format!("1 {one}"),
            count => format!("{count} {many}"),
        };
        match self.kind(entry) {
            Kind::Null => "null".to_owned(),
            Kind::Bool(value) => value.to_string(),
            Kind::Number(_) => shorten(&String::from_utf8_lossy(word_of(&self.text.as_bytes()[self.offset(entry)..]))),
            Kind::Text => format!("the text \"{}\"", shorten(&self.text(entry))),
            Kind::List if self.items(entry).next().is_none() => "an empty list".to_owned(),
            Kind::List => format!("a list of {}", count(self.items(entry).count(), "value", "values")),
            Kind::Object if self.members(entry).next().is_none() => "an empty object".to_owned(),
            Kind::Object => {
                let keys: Vec<String> = self.members(entry).take(3).map(|(key, _)| shorten(&self.text(key))).collect();
                let ellipsis = if self.members(entry).nth(3).is_some() { ", …" } else { "" };
                format!("an object with {}{ellipsis}", keys.join(", "))
            }
        }
    }
}

/// The token at `offset`, in a few words.
pub(super) fn token(text: &str, offset: usize) -> String {
    let rest = &text.as_bytes()[offset..];
    let length = match rest {
        [] => return "the end of the file".to_owned(),
        [b'"', ..] => rest[1..].iter().position(|byte| matches!(byte, b'"' | b'\n')).map_or(rest.len(), |at| at + 2),
        _ => word_of(rest).len().max(1),
    };
    shown_token(rest, length)
}
