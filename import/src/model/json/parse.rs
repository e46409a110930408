//! From text to entries: RFC 8259, and no key twice in an object.

use std::borrow::Cow;

use rustc_hash::FxHashSet;
use winnow::ascii::{digit0, digit1};
use winnow::combinator::{alt, opt};
use winnow::token::one_of;
use winnow::{ModalResult, Parser};

use super::{Document, Entry, Kind, Record};
use crate::source::shorten;

/// Where a text is not JSON.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::model) struct SyntaxFault {
    /// Where, in bytes.
    pub(in crate::model) offset: usize,
    /// The place as a path.
    pub(in crate::model) path: String,
    /// What stands there.
    pub(in crate::model) found: String,
    /// What may stand there.
    pub(in crate::model) expected: &'static str,
}

/// Takes a text apart; it must be shorter than 4 GiB.
///
/// # Errors
/// [`SyntaxFault`] where it is not one JSON value.
pub(in crate::model) fn parse(text: &str) -> Result<Document<'_>, SyntaxFault> {
    let mut parser =
        Parsing { document: Document { text, records: Vec::new() }, offset: 0, open: Vec::new(), fault: None };
    parser.run();
    match parser.fault.take() {
        Some(fault) => Err(parser.describe(fault)),
        None => Ok(parser.document),
    }
}

/// What the text may hold next.
#[derive(Clone, Copy, PartialEq)]
enum State {
    Value,
    /// A value, or the end of the list that has just begun.
    FirstItem,
    /// A key, or the end of the object that has just begun.
    FirstKey,
    Key,
    /// A comma, or the end of what holds the value before.
    AfterValue,
    Done,
}

struct Fault {
    offset: usize,
    expected: &'static str,
    /// What stands there, where it is not the token itself.
    found: Option<String>,
    /// The entry whose place the fault has, where it is not the innermost open one.
    at: Option<Entry>,
}

struct Parsing<'a> {
    document: Document<'a>,
    offset: usize,
    /// The lists and objects that have not ended.
    open: Vec<Entry>,
    fault: Option<Fault>,
}

const A_VALUE: &str = "a value";

impl<'a> Parsing<'a> {
    fn run(&mut self) {
        let mut state = State::Value;
        while self.fault.is_none() && state != State::Done {
            self.skip_blank();
            state = match state {
                State::Value => self.value(),
                State::FirstItem if self.take(b']') => self.close(),
                State::FirstItem => self.value(),
                State::FirstKey if self.take(b'}') => self.close(),
                State::FirstKey => self.key("a key in quotes, or `}`"),
                State::Key => self.key("a key in quotes"),
                State::AfterValue => self.after_value(),
                State::Done => State::Done,
            };
        }
    }

    fn rest(&self) -> &'a [u8] {
        &self.document.text.as_bytes()[self.offset..]
    }

    fn skip_blank(&mut self) {
        self.offset += self.rest().iter().take_while(|byte| matches!(byte, b' ' | b'\t' | b'\n' | b'\r')).count();
    }

    fn take(&mut self, byte: u8) -> bool {
        let found = self.rest().first() == Some(&byte);
        self.offset += usize::from(found);
        found
    }

    /// Pushes a value that begins here and has `length` bytes of its own.
    fn push(&mut self, kind: Kind, length: usize) -> Entry {
        let records = &mut self.document.records;
        let entry = Entry(records.len() as u32);
        records.push(Record { offset: self.offset as u32, next: entry.0 + 1, kind });
        self.offset += length;
        entry
    }

    fn value(&mut self) -> State {
        let (kind, length) = match self.rest() {
            [b'{', ..] => return self.begin(Kind::Object),
            [b'[', ..] => return self.begin(Kind::List),
            [b'"', ..] => match self.text_length() {
                Some(length) => (Kind::Text, length),
                None => return State::Done,
            },
            [b'-' | b'0'..=b'9', ..] => match self.number() {
                Some(number) => number,
                None => return State::Done,
            },
            rest => match [("null", Kind::Null), ("true", Kind::Bool(true)), ("false", Kind::Bool(false))]
                .into_iter()
                .find(|(word, _)| word_of(rest) == word.as_bytes())
            {
                Some((word, kind)) => (kind, word.len()),
                None => return self.fail_at_value(self.offset, A_VALUE, None),
            },
        };
        self.push(kind, length);
        State::AfterValue
    }

    fn begin(&mut self, kind: Kind) -> State {
        let entry = self.push(kind, 1);
        self.open.push(entry);
        if kind == Kind::List { State::FirstItem } else { State::FirstKey }
    }

    fn close(&mut self) -> State {
        if let Some(entry) = self.open.pop() {
            self.document.records[entry.0 as usize].next = self.document.records.len() as u32;
            self.refuse_repeated_keys(entry);
        }
        State::AfterValue
    }

    fn after_value(&mut self) -> State {
        let Some(open) = self.open.last() else {
            return if self.rest().is_empty() {
                State::Done
            } else {
                self.fail(self.offset, "the end of the file", None)
            };
        };
        let is_list = self.document.kind(*open) == Kind::List;
        if self.take(b',') {
            return if is_list { State::Value } else { State::Key };
        }
        match (is_list, self.rest().first()) {
            (true, Some(b']')) | (false, Some(b'}')) => {
                self.offset += 1;
                self.close()
            }
            (true, _) => self.fail(self.offset, "`,` or `]`", None),
            (false, _) => self.fail(self.offset, "`,` or `}`", None),
        }
    }

    fn key(&mut self, expected: &'static str) -> State {
        if self.rest().first() != Some(&b'"') {
            return self.fail(self.offset, expected, None);
        }
        let Some(length) = self.text_length() else { return State::Done };
        let key = self.push(Kind::Text, length);
        self.skip_blank();
        if self.take(b':') {
            return State::Value;
        }
        self.document.records.truncate(key.0 as usize);
        self.fail(self.offset, "`:` after a key", None)
    }

    /// The kind and length of the number here.
    fn number(&mut self) -> Option<(Kind, usize)> {
        let text = &self.document.text[self.offset..];
        let word = word_of(text.as_bytes()).len();
        let length = number.parse_peek(text).map_or(0, |(_, number)| number.len());
        if length == 0 || length < word {
            self.fail_at_value(self.offset, "a number as JSON writes it", None);
            return None;
        }
        let value: f64 = text[..length].parse().unwrap_or(f64::NAN);
        if !value.is_finite() {
            self.fail_at_value(self.offset, "a number below 1.8e308", None);
            return None;
        }
        Some((Kind::Number(value), length))
    }

    /// The length of the text in quotes here, checked.
    fn text_length(&mut self) -> Option<usize> {
        let Some(length) = quoted_length(self.rest()) else {
            self.fail_at_value(self.offset, "a closing `\"` on the same line", None);
            return None;
        };
        let token = &self.document.text[self.offset..self.offset + length];
        if token.contains('\\') && serde_json::from_str::<Cow<'_, str>>(token).is_err() {
            let found = format!("{} with an escape that JSON does not know", shorten(token));
            self.fail_at_value(
                self.offset,
                "one of \\\" \\\\ \\/ \\b \\f \\n \\r \\t, or \\u and four digits",
                Some(found),
            );
            return None;
        }
        Some(length)
    }

    fn refuse_repeated_keys(&mut self, object: Entry) {
        let mut seen = FxHashSet::default();
        let repeated = self.document.members(object).find(|(key, _)| !seen.insert(self.document.text(*key)));
        if let Some((key, value)) = repeated {
            let found = Some(format!("the key `{}` a second time", shorten(&self.document.text(key))));
            let offset = self.document.offset(key);
            self.fault = Some(Fault { offset, expected: "each key once", found, at: Some(value) });
        }
    }

    fn fail(&mut self, offset: usize, expected: &'static str, found: Option<String>) -> State {
        self.fault = Some(Fault { offset, expected, found, at: None });
        State::Done
    }

    /// A fault of the value that should begin here: a stand-in gives it a path.
    fn fail_at_value(&mut self, offset: usize, expected: &'static str, found: Option<String>) -> State {
        let at = Some(self.push(Kind::Null, 0));
        self.fault = Some(Fault { offset, expected, found, at });
        State::Done
    }

    fn describe(&mut self, fault: Fault) -> SyntaxFault {
        // What has not ended holds all that follows.
        let end = self.document.records.len() as u32;
        for entry in &self.open {
            self.document.records[entry.0 as usize].next = end;
        }
        let path = match fault.at.or(self.open.last().copied()) {
            Some(entry) => self.document.path(entry),
            None => "$".to_owned(),
        };
        let found = fault.found.unwrap_or_else(|| super::describe::token(self.document.text, fault.offset));
        // The end of the file is on the last line that holds something.
        let offset = fault.offset.min(self.document.text.trim_ascii_end().len());
        SyntaxFault { offset, path, found, expected: fault.expected }
    }
}

/// The text that begins with the quote at `offset`, without its quotes and escapes.
pub(super) fn text_at(text: &str, offset: usize) -> Cow<'_, str> {
    let rest = &text[offset..];
    let token = &rest[..quoted_length(rest.as_bytes()).unwrap_or(0)];
    let plain = token.get(1..token.len().saturating_sub(1)).unwrap_or_default();
    if !plain.contains('\\') {
        return Cow::Borrowed(plain);
    }
    // Escapes were checked when the text was taken apart.
    serde_json::from_str(token).unwrap_or(Cow::Borrowed(plain))
}

/// The length of the text in quotes that begins `bytes`; `None` where it does not end before a control character.
fn quoted_length(bytes: &[u8]) -> Option<usize> {
    let mut at = 1;
    loop {
        match bytes.get(at)? {
            b'"' => return Some(at + 1),
            b'\\' => at += 2,
            0..0x20 => return None,
            _ => at += 1,
        }
    }
}

/// The bytes up to the next one that ends a number or a word.
pub(super) fn word_of(bytes: &[u8]) -> &[u8] {
    let ends = |byte: &u8| byte.is_ascii_whitespace() || matches!(byte, b',' | b':' | b'[' | b']' | b'{' | b'}' | b'"');
    &bytes[..bytes.iter().position(ends).unwrap_or(bytes.len())]
}

/// A number as RFC 8259 has it.
fn number<'i>(input: &mut &'i str) -> ModalResult<&'i str> {
    let whole = alt(("0".void(), (one_of('1'..='9'), digit0).void()));
    let exponent = (one_of(['e', 'E']), opt(one_of(['+', '-'])), digit1);
    (opt('-'), whole, opt(('.', digit1)), opt(exponent)).take().parse_next(input)
}
