//! Tokens of expressions.

use winnow::ascii::{digit0, digit1, multispace0};
use winnow::combinator::{alt, opt, preceded};
use winnow::token::{any, one_of, take_while};
use winnow::{ModalResult, Parser};

/// The smallest piece of an expression.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Token<'a> {
    /// A number as it is written.
    Number(&'a str),
    /// A parameter or a function.
    Name(&'a str),
    /// Anything else, one character.
    Symbol(char),
    /// Nothing is left.
    End,
}

impl std::fmt::Display for Token<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Number(text) | Self::Name(text) => write!(f, "`{}`", crate::source::shorten(text)),
            Self::Symbol(symbol) => write!(f, "`{symbol}`"),
            Self::End => f.write_str("its end"),
        }
    }
}

/// Takes the next token and the white space before it.
pub(super) fn next<'a>(input: &mut &'a str) -> Token<'a> {
    let number = number.map(Token::Number);
    let token = alt((number, name.map(Token::Name), any.map(Token::Symbol)));
    let taken: ModalResult<Token<'a>> = preceded(multispace0, token).parse_next(input);
    taken.unwrap_or(Token::End)
}

/// Whether a text may name a parameter.
pub(in crate::model) fn is_name(text: &str) -> bool {
    name.parse(text).is_ok()
}

fn number<'a>(input: &mut &'a str) -> ModalResult<&'a str> {
    let exponent = (one_of(['e', 'E']), opt(one_of(['+', '-'])), digit1);
    let digits = alt(((digit1, opt(('.', digit0))).void(), ('.', digit1).void()));
    (digits, opt(exponent)).take().parse_next(input)
}

fn name<'a>(input: &mut &'a str) -> ModalResult<&'a str> {
    let first = one_of(|c: char| c.is_ascii_alphabetic() || c == '_');
    (first, take_while(0.., |c: char| c.is_ascii_alphanumeric() || c == '_')).take().parse_next(input)
}
