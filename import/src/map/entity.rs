//! From the pieces of entities to brushes: which wait for what a later key may say of them, and which are built at once.

use std::mem::take;

use super::build::{Builder, Built, Fate, WORLD, text};
use super::decimal::Decimal;
use super::error::MapError;
use super::grammar::{Brush, Event, NOWHERE, Primitive, point_of};
use super::plane::Point;
use crate::source::shorten;
use crate::stream_error::StreamError;

/// An entity that has begun.
#[derive(Debug, Default)]
struct Entity<'t> {
    /// The line of its brace.
    line: u32,
    /// Its number.
    index: usize,
    /// The last value of `classname`.
    class: Option<Vec<u8>>,
    /// The last value of `origin` that is three numbers.
    origin: Option<Point>,
    /// Brushes that wait.
    brushes: Vec<Brush<'t>>,
    /// Lines of primitives that wait, and whether they are patches.
    left_out: Vec<(u32, bool)>,
    /// What became of the first of its brushes and primitives that were taken, and so becomes of all.
    fate: Option<Fate>,
    /// Whether a brush that counts from the origin was taken.
    is_placed: bool,
}

/// Takes the pieces of a map in their order; `'t` is how long the brushes that wait may borrow from the text.
pub(super) struct Collector<'t, 'o> {
    builder: Builder<'o>,
    /// Whether all brushes of an entity wait for its end: then its last keys count. Otherwise they wait for its class alone.
    waits: bool,
    /// The entity that has begun and not ended.
    entity: Option<Entity<'t>>,
}

impl<'t, 'o> Collector<'t, 'o> {
    /// A collector that has taken nothing.
    pub(super) fn new(builder: Builder<'o>, waits: bool) -> Self {
        Self { builder, waits, entity: None }
    }

    /// Whether an entity has begun and not ended.
    pub(super) fn is_inside(&self) -> bool {
        self.entity.is_some()
    }

    /// The line on which that entity begins.
    pub(super) fn entity_line(&self) -> u32 {
        self.entity.as_ref().map_or(0, |entity| entity.line)
    }

    /// Takes a piece; offsets in it are of lines that `line_of` tells, brushes that wait are put away by `keep`, others are handed to `send`.
    ///
    /// # Errors
    /// [`MapError::PlaneOutOfRange`] for a face of a brush that is taken, [`MapError::LateKey`], and those of `send`.
    pub(super) fn take<'e, E>(
        &mut self,
        event: Event<'e>,
        line_of: impl Fn(usize) -> u32,
        keep: impl FnOnce(Brush<'e>) -> Brush<'t>,
        send: &mut impl FnMut(Built) -> Result<(), E>,
    ) -> Result<(), StreamError<MapError, E>> {
        match event {
            Event::Begins(offset) => {
                let index = self.builder.begin_entity();
                self.entity = Some(Entity { line: line_of(offset), index, ..Entity::default() });
                Ok(())
            }
            Event::Key { offset, key, value } => {
                self.key(&key, &value, || line_of(offset)).map_err(StreamError::Input)?;
                if self.waits { Ok(()) } else { self.settle(false, send) }
            }
            Event::Primitive(primitive) => self.primitive(primitive, line_of, keep, send),
            Event::Bare(primitive) => {
                let fate = self.builder.fate_of(WORLD.as_bytes(), 0);
                match primitive {
                    Primitive::Brush(mut brush) => {
                        brush.count_lines(line_of);
                        self.builder.add(&brush, &fate, send)
                    }
                    Primitive::LeftOut(primitive) => {
                        self.builder.leave_out(line_of(primitive.offset), primitive.is_patch, &fate);
                        Ok(())
                    }
                }
            }
            Event::Ends => {
                let settled = self.settle(true, send);
                self.entity = None;
                settled
            }
        }
    }

    /// An error that comes before one of syntax that was found just now: that of a brush which waits although its class is known.
    pub(super) fn earlier_error(&mut self) -> Option<MapError> {
        self.entity.as_ref()?.class.as_ref()?;
        match self.settle(false, &mut |_| Ok::<(), std::convert::Infallible>(())) {
            Err(StreamError::Input(error)) => Some(error),
            _ => None,
        }
    }

    /// The builder, after the last piece.
    pub(super) fn into_builder(self) -> Builder<'o> {
        self.builder
    }

    fn primitive<'e, E>(
        &mut self,
        primitive: Primitive<'e>,
        line_of: impl Fn(usize) -> u32,
        keep: impl FnOnce(Brush<'e>) -> Brush<'t>,
        send: &mut impl FnMut(Built) -> Result<(), E>,
    ) -> Result<(), StreamError<MapError, E>> {
        let Some(entity) = &mut self.entity else { return Ok(()) };
        let is_known = entity.class.is_some() && !self.waits;
        match primitive {
            Primitive::Brush(mut brush) => {
                brush.count_lines(line_of);
                if !is_known {
                    entity.brushes.push(keep(brush));
                    return Ok(());
                }
                let class = entity.class.as_deref();
                let fate = settled(&mut entity.fate, &self.builder, class, entity.index);
                put(&mut brush, fate, entity.origin, &mut entity.is_placed);
                self.builder.add(&brush, fate, send)
            }
            Primitive::LeftOut(primitive) => {
                entity.left_out.push((line_of(primitive.offset), primitive.is_patch));
                if is_known { self.settle(false, send) } else { Ok(()) }
            }
        }
    }

    fn key(&mut self, key: &[u8], value: &[u8], line: impl Fn() -> u32) -> Result<(), MapError> {
        let Some(entity) = &mut self.entity else { return Ok(()) };
        let late = |taken: String| {
            Err(MapError::LateKey {
                name: self.builder.name().to_owned(),
                line: line(),
                found: format!("the key `{}` with the value `{}`", shorten(&text(key)), shorten(&text(value))),
                expected: format!("it before the brushes of its entity, which were taken for {taken}"),
            })
        };
        match key {
            b"classname" => {
                if let Some(fate) = &entity.fate
                    && *fate != self.builder.fate_of(value, entity.index)
                {
                    let class = entity.class.as_deref().unwrap_or_default();
                    return late(format!("those of `{}`", shorten(&text(class))));
                }
                entity.class = Some(value.to_vec());
            }
            b"origin" => {
                let origin = point_of(value).or(entity.origin);
                if entity.is_placed && origin.unwrap_or(NOWHERE) != entity.origin.unwrap_or(NOWHERE) {
                    let [x, y, z] = entity.origin.unwrap_or(NOWHERE).map(Decimal::to_f64);
                    return late(format!("those of the origin `{x} {y} {z}`"));
                }
                entity.origin = origin;
            }
            _ => {}
        }
        Ok(())
    }

    /// Builds what waits, where the class is known or the entity ends.
    fn settle<E>(
        &mut self,
        at_end: bool,
        send: &mut impl FnMut(Built) -> Result<(), E>,
    ) -> Result<(), StreamError<MapError, E>> {
        let Some(entity) = &mut self.entity else { return Ok(()) };
        let (brushes, left_out) = (take(&mut entity.brushes), take(&mut entity.left_out));
        if !at_end && entity.class.is_none() {
            (entity.brushes, entity.left_out) = (brushes, left_out);
            return Ok(());
        }
        if brushes.is_empty() && left_out.is_empty() {
            return Ok(());
        }
        let fate = settled(&mut entity.fate, &self.builder, entity.class.as_deref(), entity.index);
        for (line, is_patch) in left_out {
            self.builder.leave_out(line, is_patch, fate);
        }
        for mut brush in brushes {
            put(&mut brush, fate, entity.origin, &mut entity.is_placed);
            self.builder.add(&brush, fate, send)?;
        }
        Ok(())
    }
}

/// What becomes of the brushes of an entity, from now on for all of them.
fn settled<'f>(fate: &'f mut Option<Fate>, builder: &Builder<'_>, class: Option<&[u8]>, index: usize) -> &'f Fate {
    fate.get_or_insert_with(|| builder.fate_of(class.unwrap_or_default(), index))
}

/// Moves a brush to where its entity is; the world has no origin.
fn put(brush: &mut Brush<'_>, fate: &Fate, origin: Option<Point>, is_placed: &mut bool) {
    if fate.is_skipped || fate.name.is_none() || !brush.has_equations() {
        return;
    }
    *is_placed = true;
    if let Some(origin) = origin {
        brush.put_at(&origin);
    }
}
