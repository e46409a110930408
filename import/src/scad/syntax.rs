//! The grammar: nodes with arguments, one within another.
//!
//! A statement is `name(argument, …)` and then `;`, a block of statements in braces, or one statement more. In front stand any
//! number of modifiers. Nothing is recursive, so trees can be nested as deep as memory goes.

use winnow::stream::{LocatingSlice, Stream};

use super::error::Fault;
use super::token::{Input, Parsed, accept, is_word, peek, punctuation, quoted, word};
use super::value::Value;

/// Deepest vector in vectors: points in paths need three levels.
const MAX_VECTORS: usize = 64;

/// `%`, `#`, `*` and `!` in front of a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Modifiers {
    /// `%` shows a node without it being part of the solid, and `*` leaves it out: either way it is not there.
    pub(super) is_left_out: bool,
    /// `!`: only this node counts.
    pub(super) is_root: bool,
}

/// One node of the tree.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Node<'a> {
    pub(super) name: &'a str,
    /// Values with their names, where they have one.
    pub(super) arguments: Vec<(Option<&'a str>, Value)>,
    pub(super) modifiers: Modifiers,
    /// Offset of its name.
    pub(super) offset: usize,
    /// The node around it, which always comes earlier in the list.
    pub(super) parent: Option<u32>,
}

/// A node whose statement is not complete.
struct Open {
    node: u32,
    /// Where its block begins; a single statement takes no block.
    brace: Option<usize>,
}

/// All nodes in the order of the text: each before those within it.
pub(super) fn parse(text: &[u8]) -> Parsed<Vec<Node<'_>>> {
    let mut input = LocatingSlice::new(text);
    let mut nodes: Vec<Node<'_>> = Vec::new();
    let mut open: Vec<Open> = Vec::new();
    loop {
        let (offset, next) = peek(&mut input)?;
        let within_block = open.last().is_none_or(|open| open.brace.is_some());
        match next {
            None if open.is_empty() => return Ok(nodes),
            None => return Err(unfinished(offset, &open)),
            Some(b'}') if within_block && !open.is_empty() => {
                input.next_slice(1);
                open.pop();
                close_single(&mut open);
            }
            Some(b';') => {
                input.next_slice(1);
                close_single(&mut open);
            }
            Some(_) => {
                let parent = open.last().map(|open| open.node);
                let mut node = head(&mut input)?;
                node.parent = parent;
                let number = u32::try_from(nodes.len())
                    .map_err(|_| Fault::found(offset, "more than 2^32 nodes", "a smaller tree"))?;
                nodes.push(node);
                body(&mut input, number, &mut open)?;
            }
        }
    }
}

/// After a statement, those that it was the single child of are complete too.
fn close_single(open: &mut Vec<Open>) {
    while open.last().is_some_and(|open| open.brace.is_none()) {
        open.pop();
    }
}

fn unfinished(offset: usize, open: &[Open]) -> Fault {
    match open.last() {
        Some(Open { brace: Some(_), .. }) => Fault::token(offset, "a statement or `}`"),
        _ => Fault::token(offset, "`;`, `{` or a statement"),
    }
}

/// What follows the arguments.
fn body(input: &mut Input<'_>, node: u32, open: &mut Vec<Open>) -> Parsed<()> {
    match peek(input)? {
        (_, Some(b';')) => {
            input.next_slice(1);
            close_single(open);
        }
        (offset, Some(b'{')) => {
            input.next_slice(1);
            open.push(Open { node, brace: Some(offset) });
        }
        (_, Some(byte)) if begins_statement(byte) => open.push(Open { node, brace: None }),
        (offset, _) => return Err(Fault::token(offset, "`;`, `{` or a statement")),
    }
    Ok(())
}

fn begins_statement(byte: u8) -> bool {
    matches!(byte, b'%' | b'#' | b'*' | b'!') || is_word(byte)
}

/// Modifiers, name and arguments.
fn head<'a>(input: &mut Input<'a>) -> Parsed<Node<'a>> {
    let modifiers = modifiers(input)?;
    let (offset, _) = peek(input)?;
    let expected = "a node such as `cube(…)`";
    let name = name(word(input)?).ok_or_else(|| Fault::token(offset, expected))?;
    if accept(input, b'=')? {
        let expected =
            "an evaluated tree, which has no variables: OpenSCAD makes one from a program with `-o name.csg`";
        return Err(Fault::found(offset, format!("an assignment to `{name}`"), expected));
    }
    punctuation(input, b'(', "`(`")?;
    let arguments = arguments(input)?;
    Ok(Node { name, arguments, modifiers, offset, parent: None })
}

/// A name, not a number.
fn name(word: &[u8]) -> Option<&str> {
    let begins = word.first().is_some_and(|byte| byte.is_ascii_alphabetic() || matches!(byte, b'_' | b'$'));
    let continues = word.iter().all(|byte| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'$'));
    std::str::from_utf8(word).ok().filter(|_| begins && continues)
}

fn modifiers(input: &mut Input<'_>) -> Parsed<Modifiers> {
    let mut modifiers = Modifiers::default();
    loop {
        match peek(input)?.1 {
            Some(b'%' | b'*') => modifiers.is_left_out = true,
            Some(b'!') => modifiers.is_root = true,
            Some(b'#') => {}
            _ => return Ok(modifiers),
        }
        input.next_slice(1);
    }
}

/// Up to the closing parenthesis; a comma may stand after the last one.
fn arguments<'a>(input: &mut Input<'a>) -> Parsed<Vec<(Option<&'a str>, Value)>> {
    let mut arguments = Vec::new();
    loop {
        if accept(input, b')')? {
            return Ok(arguments);
        }
        arguments.push(argument(input)?);
        if !accept(input, b',')? {
            punctuation(input, b')', "`,` or `)`")?;
            return Ok(arguments);
        }
    }
}

fn argument<'a>(input: &mut Input<'a>) -> Parsed<(Option<&'a str>, Value)> {
    let (offset, next) = peek(input)?;
    if !next.is_some_and(|byte| is_word(byte) && !byte.is_ascii_digit()) {
        return Ok((None, value(input)?));
    }
    let text = word(input)?;
    if let (Some(name), true) = (name(text), accept(input, b'=')?) {
        return Ok((Some(name), value(input)?));
    }
    Ok((None, scalar(text, offset)?))
}

/// A value, vectors of any depth up to [`MAX_VECTORS`].
fn value(input: &mut Input<'_>) -> Parsed<Value> {
    let mut open: Vec<(Vec<Value>, bool)> = Vec::new();
    loop {
        let (offset, next) = peek(input)?;
        let mut complete = match next {
            Some(b'[') => {
                input.next_slice(1);
                if open.len() == MAX_VECTORS {
                    return Err(Fault::found(offset, "vectors in vectors", format!("at most {MAX_VECTORS} of them")));
                }
                open.push((Vec::new(), false));
                if !accept(input, b']')? {
                    continue;
                }
                open.pop().map_or(Value::Undefined, |_| Value::Vector(Vec::new()))
            }
            Some(b'"') => Value::Text(quoted(input)?),
            _ => scalar(word(input)?, offset)?,
        };
        // What is complete belongs into the vector around it, which may be complete then too.
        loop {
            let Some((items, is_range)) = open.last_mut() else { return Ok(complete) };
            items.push(complete);
            let closes = if accept(input, b',')? {
                accept(input, b']')?
            } else if accept(input, b':')? {
                *is_range = true;
                false
            } else {
                punctuation(input, b']', "`,` or `]`")?;
                true
            };
            if !closes {
                break;
            }
            let closed =
                open.pop().map(|(items, is_range)| if is_range { Value::Undefined } else { Value::Vector(items) });
            complete = closed.unwrap_or(Value::Undefined);
        }
    }
}

/// A number, a truth value or `undef`.
fn scalar(text: &[u8], offset: usize) -> Parsed<Value> {
    let expected = "a value: a number, a text in quotes, `true`, `false`, `undef` or a vector";
    Ok(match text {
        b"true" => Value::Boolean(true),
        b"false" => Value::Boolean(false),
        // OpenSCAD writes `inf` and `nan`, and when it reads them knows no such names
        b"undef" | b"inf" | b"-inf" | b"nan" | b"-nan" => Value::Undefined,
        _ => Value::Number(number(text).ok_or_else(|| Fault::token(offset, expected))?),
    })
}

/// A decimal number; what is too large for a double is infinite, as in OpenSCAD.
fn number(text: &[u8]) -> Option<f64> {
    let begins = text.iter().find(|byte| !matches!(byte, b'+' | b'-'))?;
    if !(begins.is_ascii_digit() || *begins == b'.') {
        return None;
    }
    std::str::from_utf8(text).ok()?.parse().ok()
}
