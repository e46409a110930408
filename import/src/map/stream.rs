//! Maps that are longer than memory: one window of text after another goes through the grammar.

use std::io::{ErrorKind, Read};

use planecut_csg::{Operation, TreeSink};
use winnow::stream::{LocatingSlice, Location};

use super::build::{Builder, Built};
use super::entity::Collector;
use super::error::{LOOKED_AHEAD, MapError, Surroundings};
use super::grammar::{self, Brush};
use super::window::Window;
use super::{MapOptions, MapSummary};
use crate::source::MAX_TEXT;
use crate::stream_error::StreamError;

/// Bytes of text in memory: 4 MiB.
const WINDOW: usize = 1 << 22;

/// Reads a map of any length and hands its brushes to a sink, as the operands of one union, in the order of the file, each with its line.
///
/// Brushes, materials, lines, warnings and errors are those of [`read_map`](super::read_map), for which the text has to be in memory. Here a window
/// of 4 MiB of it is, more only where a single brush, with the comments in it, is longer. Brushes that stand before the `classname` of their entity wait for it. What is
/// handed on cannot be changed any more: where a later key of an entity would change brushes before it (another `classname` or, for planes of four
/// numbers, another `origin`), that is an error, while `read_map` goes by the last one. The sink may have taken brushes before any error.
///
/// ```
/// use planecut_csg::TreeBuilder;
/// use planecut_import::map::{MapOptions, read_map, stream_map};
///
/// let text = br#"{
/// "classname" "worldspawn"
/// {
/// ( 0 0 0 ) ( 0 1 0 ) ( 0 0 1 ) stone 0 0 0 1 1
/// ( 8 0 0 ) ( 8 0 1 ) ( 8 1 0 ) stone 0 0 0 1 1
/// }
/// }"#;
/// let mut builder = TreeBuilder::default();
/// let summary = stream_map(&text[..], "slab.map", &MapOptions::default(), &mut builder).unwrap();
/// assert_eq!((summary.brushes, summary.materials[0].name.as_str()), (1, "stone"));
/// let import = read_map(text, "slab.map", &MapOptions::default()).unwrap();
/// assert_eq!(builder.finish(), import.model.tree);
/// ```
///
/// # Errors
/// [`StreamError::Input`] with the [`MapError`] that `read_map` gives, or with [`MapError::LateKey`], with [`MapError::TooLong`] where a single
/// piece has more than 1 GiB, or with [`MapError::Unreadable`] where the reader fails. [`StreamError::Sink`] where the sink does not take a piece.
pub fn stream_map<S: TreeSink>(
    reader: impl Read,
    name: &str,
    options: &MapOptions,
    sink: &mut S,
) -> Result<MapSummary, StreamError<MapError, S::Error>> {
    stream_window(&mut Window::new(reader, WINDOW), name, options, sink)
}

fn stream_window<R: Read, S: TreeSink>(
    window: &mut Window<R>,
    name: &str,
    options: &MapOptions,
    sink: &mut S,
) -> Result<MapSummary, StreamError<MapError, S::Error>> {
    let mut collector = Collector::new(Builder::new(name, options), false);
    sink.begin(Operation::Union).map_err(StreamError::Sink)?;
    let mut send = |built: Built| sink.leaf(built.brush, built.line);
    loop {
        window.skip_blank();
        match next(window, &mut collector, name, &mut send)? {
            Step::Taken(length) => window.advance(length),
            Step::Short => fill(window, name).map_err(StreamError::Input)?,
            Step::End => break,
        }
    }
    let summary = collector.into_builder().finish().map_err(StreamError::Input)?;
    sink.end().map_err(StreamError::Sink)?;
    Ok(summary)
}

/// What became of the text in the window.
enum Step {
    /// A piece of this length was taken.
    Taken(usize),
    /// What comes next is not all there.
    Short,
    /// There is nothing left.
    End,
}

/// Takes the next piece of the map, where all that it depends on is in the window.
fn next<R: Read, E>(
    window: &Window<R>,
    collector: &mut Collector<'static, '_>,
    name: &str,
    send: &mut impl FnMut(Built) -> Result<(), E>,
) -> Result<Step, StreamError<MapError, E>> {
    let text = window.rest();
    let line_of = |offset| window.line_of(offset);
    let mut input = LocatingSlice::new(text);
    let event = grammar::event(&mut input, collector.is_inside());
    let position = input.current_token_start();
    match event {
        Ok(event) if window.is_whole() || position + LOOKED_AHEAD <= text.len() => {
            let Some(event) = event else { return Ok(Step::End) };
            collector.take(event, line_of, Brush::into_owned, send)?;
            Ok(Step::Taken(position))
        }
        Err(error) if window.is_whole() || error.is_certain(text, position) => {
            let (line_before, entity_line) = (window.line_before(), collector.entity_line());
            let located = error.locate(&Surroundings { name, text, line_of, line_before, entity_line });
            Err(StreamError::Input(collector.earlier_error().unwrap_or(located)))
        }
        _ => Ok(Step::Short),
    }
}

fn fill<R: Read>(window: &mut Window<R>, name: &str) -> Result<(), MapError> {
    let name = name.to_owned();
    window.fill().map_err(|error| match error.kind() {
        ErrorKind::FileTooLarge if window.rest().len() >= MAX_TEXT => {
            MapError::TooLong { name, line: window.line_of(0), bytes: MAX_TEXT }
        }
        kind => MapError::Unreadable { name, bytes: window.bytes_read(), kind, reason: error.to_string() },
    })
}

#[cfg(test)]
mod tests;
