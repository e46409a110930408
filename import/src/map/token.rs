//! Tokens of a map: white space, punctuation, numbers, names, quoted texts.

use std::borrow::Cow;

use winnow::Parser;
use winnow::error::{AddContext, ParserError};
use winnow::stream::{LocatingSlice, Location, Stream};
use winnow::token::{any, literal, take_till, take_while};

use super::decimal::Decimal;
use super::error::{Found, SyntaxError};

/// What is left of the text.
pub(super) type Input<'a> = LocatingSlice<&'a [u8]>;

/// The grammar looks one byte ahead and never goes back, so each error is final.
pub(super) type Parsed<T> = Result<T, SyntaxError>;

impl ParserError<Input<'_>> for SyntaxError {
    type Inner = Self;

    fn from_input(input: &Input<'_>) -> Self {
        Self { offset: input.current_token_start(), found: Found::Token, expected: "", opened: None }
    }

    fn into_inner(self) -> Result<Self::Inner, Self> {
        Ok(self)
    }
}

impl AddContext<Input<'_>> for SyntaxError {
    fn add_context(mut self, _: &Input<'_>, _: &<Input<'_> as Stream>::Checkpoint, expected: &'static str) -> Self {
        // The innermost parser says it best.
        if self.expected.is_empty() {
            self.expected = expected;
        }
        self
    }
}

/// Blank bytes are all up to the space, control characters included, as for id Software's parsers: files from DOS end
/// with 0x1A or with zeros.
pub(super) fn is_blank(byte: u8) -> bool {
    byte <= b' '
}

/// Whether a number or a word ends before this byte.
pub(super) fn is_delimiter(byte: u8) -> bool {
    is_blank(byte) || matches!(byte, b'(' | b')' | b'[' | b']' | b'{' | b'}' | b'"')
}

/// What comments begin with: `//` or, as QuArK writes them, `;`.
pub(super) const COMMENTS: &[&[u8]] = &[b"//", b";"];

/// Skips white space and comments.
fn blank(input: &mut Input<'_>) -> Parsed<()> {
    skip(input, COMMENTS)
}

/// Skips white space and comments that begin with one of `marks`.
fn skip(input: &mut Input<'_>, marks: &[&[u8]]) -> Parsed<()> {
    loop {
        take_while(0.., is_blank).void().parse_next(input)?;
        if !marks.iter().any(|mark| input.starts_with(mark)) {
            return Ok(());
        }
        take_till(0.., (b'\n', b'\r')).void().parse_next(input)?;
    }
}

/// The first byte of the next token, which is not taken; `None` at the end of the text.
pub(super) fn peek(input: &mut Input<'_>) -> Parsed<Option<u8>> {
    blank(input)?;
    Ok(input.first().copied())
}

/// One byte of punctuation.
pub(super) fn punctuation<'a>(byte: u8, expected: &'static str) -> impl Parser<Input<'a>, (), SyntaxError> {
    (blank, literal(byte)).void().context(expected)
}

/// What is expected where a number stands.
pub(super) const NUMBER: &str = "a finite decimal number";

/// A number, by [`Decimal::parse`].
pub(super) fn number(input: &mut Input<'_>) -> Parsed<Decimal> {
    blank(input)?;
    take_till(1.., is_delimiter).verify_map(Decimal::parse).context(NUMBER).parse_next(input)
}

/// The name of a primitive.
pub(super) fn word<'a>(input: &mut Input<'a>) -> Parsed<&'a [u8]> {
    blank(input)?;
    take_till(1.., is_delimiter).context("a word").parse_next(input)
}

/// A name between blanks, whatever its characters, or in quotes: a texture.
pub(super) fn name<'a>(input: &mut Input<'a>) -> Parsed<Cow<'a, [u8]>> {
    // names may begin with a semicolon
    skip(input, &[b"//"])?;
    match input.first() {
        Some(b'"') => quoted(input),
        _ => take_till(1.., is_blank).map(Cow::Borrowed).context("a texture name").parse_next(input),
    }
}

/// A text in quotes, on one line or several.
///
/// A backslash escapes a quote, but not the last one of a line: many maps hold paths like `"c:\maps\"`, for which the
/// first parsers knew no escapes. TrenchBroom decides in the same way.
pub(super) fn quoted<'a>(input: &mut Input<'a>) -> Parsed<Cow<'a, [u8]>> {
    blank(input)?;
    let offset = input.current_token_start();
    literal(b'"').context("a text in quotes").parse_next(input)?;
    let Some(length) = quoted_length(input) else {
        return Err(SyntaxError { offset, found: Found::OpenQuote, expected: "a closing `\"`", opened: None });
    };
    let text = input.next_slice(length);
    any.void().parse_next(input)?;
    Ok(unescape(text))
}

/// `\"` means a quote and `\\` a backslash; a backslash before anything else is itself, as in paths of Windows.
fn unescape(text: &[u8]) -> Cow<'_, [u8]> {
    if !text.contains(&b'\\') {
        return Cow::Borrowed(text);
    }
    let mut plain = Vec::with_capacity(text.len());
    let mut bytes = text.iter().copied().peekable();
    while let Some(byte) = bytes.next() {
        let escaped = if byte == b'\\' { bytes.next_if(|next| matches!(next, b'"' | b'\\')) } else { None };
        plain.push(escaped.unwrap_or(byte));
    }
    Cow::Owned(plain)
}

/// Bytes up to the closing quote.
fn quoted_length(text: &[u8]) -> Option<usize> {
    let mut escaped = false;
    for (i, byte) in text.iter().enumerate() {
        let ends_line = || matches!(text.get(i + 1), None | Some(b'\n' | b'\r' | b'}'));
        match byte {
            b'"' if !escaped || ends_line() => return Some(i),
            b'\\' => escaped = !escaped,
            _ => escaped = false,
        }
    }
    None
}
