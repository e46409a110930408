//! Tokens of the evaluated language: white space, comments, names, numbers, texts, punctuation.

use std::borrow::Cow;

use winnow::Parser;
use winnow::error::ParserError;
use winnow::stream::{LocatingSlice, Location, Stream};
use winnow::token::{take_till, take_while};

use super::error::Fault;
use crate::source::shown_token;

/// What is left of the text.
pub(super) type Input<'a> = LocatingSlice<&'a [u8]>;

/// The grammar looks one byte ahead and never goes back, so each fault is final.
pub(super) type Parsed<T> = Result<T, Fault>;

impl ParserError<Input<'_>> for Fault {
    type Inner = Self;

    fn from_input(input: &Input<'_>) -> Self {
        Self::token(input.current_token_start(), "")
    }

    fn into_inner(self) -> Result<Self::Inner, Self> {
        Ok(self)
    }
}

/// Whether a byte can be part of a name or a number.
pub(super) fn is_word(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'$' | b'.' | b'+' | b'-') || byte >= 0x80
}

/// Skips white space and both kinds of comments.
fn blank(input: &mut Input<'_>) -> Parsed<()> {
    loop {
        take_while(0.., |byte: u8| byte.is_ascii_whitespace() || byte == 0x0b).void().parse_next(input)?;
        let offset = input.current_token_start();
        if input.starts_with(b"//") {
            take_till(0.., (b'\n', b'\r')).void().parse_next(input)?;
        } else if input.starts_with(b"/*") {
            let end = input[2..].windows(2).position(|pair| pair == b"*/");
            let Some(end) = end else {
                return Err(Fault::found(offset, "a comment without an end", "a closing `*/`"));
            };
            input.next_slice(end + 4);
        } else {
            return Ok(());
        }
    }
}

/// The first byte of the next token, which is not taken, and its offset; `None` at the end of the text.
pub(super) fn peek(input: &mut Input<'_>) -> Parsed<(usize, Option<u8>)> {
    blank(input)?;
    Ok((input.current_token_start(), input.first().copied()))
}

/// Takes a byte of punctuation where it comes next.
pub(super) fn accept(input: &mut Input<'_>, byte: u8) -> Parsed<bool> {
    let (_, next) = peek(input)?;
    if next == Some(byte) {
        input.next_slice(1);
        return Ok(true);
    }
    Ok(false)
}

/// Takes a byte of punctuation, which has to come next.
pub(super) fn punctuation(input: &mut Input<'_>, byte: u8, expected: &'static str) -> Parsed<()> {
    if accept(input, byte)? { Ok(()) } else { Err(Fault::token(input.current_token_start(), expected)) }
}

/// A name or a number; empty where neither comes next.
pub(super) fn word<'a>(input: &mut Input<'a>) -> Parsed<&'a [u8]> {
    blank(input)?;
    take_while(0.., is_word).parse_next(input)
}

/// A text in quotes, its escapes undone.
pub(super) fn quoted(input: &mut Input<'_>) -> Parsed<String> {
    punctuation(input, b'"', "a text in quotes")?;
    let offset = input.current_token_start() - 1;
    let Some(length) = quoted_length(input) else {
        return Err(Fault::found(offset, "a text in quotes without an end", "a closing `\"`"));
    };
    let text = String::from_utf8_lossy(input.next_slice(length)).into_owned();
    input.next_slice(1);
    Ok(unescape(text))
}

/// Bytes up to the closing quote.
fn quoted_length(text: &[u8]) -> Option<usize> {
    let mut escaped = false;
    text.iter().position(|byte| {
        let ends = *byte == b'"' && !escaped;
        escaped = *byte == b'\\' && !escaped;
        ends
    })
}

/// The escapes that OpenSCAD writes; a backslash before anything else is itself.
fn unescape(text: String) -> String {
    if !text.contains('\\') {
        return text;
    }
    let mut plain = String::with_capacity(text.len());
    let mut rest = text.as_str();
    while let Some(at) = rest.find('\\') {
        plain.push_str(&rest[..at]);
        let after = &rest[at + 1..];
        let meant = match after.bytes().next() {
            Some(b'n') => Some('\n'),
            Some(b't') => Some('\t'),
            Some(b'r') => Some('\r'),
            Some(b'"') => Some('"'),
            Some(b'\\') => Some('\\'),
            _ => None,
        };
        plain.push(meant.unwrap_or('\\'));
        rest = if meant.is_some() { &after[1..] } else { after };
    }
    plain.push_str(rest);
    plain
}

/// The token at the start of a text, on one line and not too long.
pub(super) fn describe(text: &[u8]) -> Cow<'static, str> {
    let Some(first) = text.first() else { return "the end of the file".into() };
    let length = match first {
        byte if is_word(*byte) => text.iter().position(|byte| !is_word(*byte)).unwrap_or(text.len()),
        b'"' => text[1..].iter().position(|byte| matches!(byte, b'"' | b'\n' | b'\r')).map_or(text.len(), |i| i + 2),
        _ => 1,
    };
    shown_token(text, length).into()
}
