//! From brushes as they are stated to those of a model: names, options, and what is left out.

use std::borrow::Cow;
use std::num::NonZeroU32;

use glam::{DVec2, DVec3};
use planecut_csg::{Brush, BrushFace, Material, MaterialId, TextureAxes};
use rustc_hash::FxHashMap;

use super::error::MapError;
use super::glob::matches_any;
use super::grammar;
use super::plane::PlaneError;
use super::{MapOptions, MapSummary};
use crate::Warning;
use crate::stream_error::StreamError;

/// Builds the brushes of one map.
pub(super) struct Builder<'a> {
    name: &'a str,
    options: &'a MapOptions,
    materials: FxHashMap<String, MaterialId>,
    faces_left_out: Tally,
    brushes_left_out: Tally,
    patches_left_out: Tally,
    primitives_left_out: Tally,
    is_empty: bool,
    summary: MapSummary,
}

/// A brush that is taken.
pub(super) struct Built {
    pub(super) brush: Brush,
    /// How the textures of its faces lie.
    pub(super) textures: Vec<Option<TextureAxes>>,
    /// The line on which it begins.
    pub(super) line: Option<NonZeroU32>,
}

/// What becomes of the brushes of an entity.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Fate {
    /// Whether the options leave them aside.
    pub(super) is_skipped: bool,
    /// Their name, where they are not of the world. That of brushes that are left aside does not count.
    pub(super) name: Option<String>,
}

impl<'a> Builder<'a> {
    /// A builder of an empty map; `name` is what errors call the file.
    pub(super) fn new(name: &'a str, options: &'a MapOptions) -> Self {
        Self {
            name,
            options,
            materials: FxHashMap::default(),
            faces_left_out: Tally::default(),
            brushes_left_out: Tally::default(),
            patches_left_out: Tally::default(),
            primitives_left_out: Tally::default(),
            is_empty: true,
            summary: MapSummary::default(),
        }
    }

    /// What errors call the file.
    pub(super) fn name(&self) -> &'a str {
        self.name
    }

    /// Counts an entity, and gives its number.
    pub(super) fn begin_entity(&mut self) -> usize {
        self.is_empty = false;
        self.summary.entities += 1;
        self.summary.entities - 1
    }

    /// What becomes of the brushes of an entity of this class and number.
    pub(super) fn fate_of(&self, class: &[u8], entity: usize) -> Fate {
        let class = text(class);
        let is_skipped =
            (self.options.world_only && !is_world(&class)) || matches_any(&self.options.skip_classes, &class);
        Fate { is_skipped, name: if is_skipped { None } else { brush_name(&class, entity) } }
    }

    /// Counts a primitive that is not read.
    pub(super) fn leave_out(&mut self, line: u32, is_patch: bool, fate: &Fate) {
        self.is_empty = false;
        if !fate.is_skipped {
            let tally = if is_patch { &mut self.patches_left_out } else { &mut self.primitives_left_out };
            tally.add(line);
        }
    }

    /// Builds a brush and hands it on, unless the options leave it aside.
    ///
    /// # Errors
    /// [`MapError::PlaneOutOfRange`] for a face of a brush that is taken; those of `send`.
    pub(super) fn add<E>(
        &mut self,
        brush: &grammar::Brush<'_>,
        fate: &Fate,
        send: &mut impl FnMut(Built) -> Result<(), E>,
    ) -> Result<(), StreamError<MapError, E>> {
        self.is_empty = false;
        self.summary.brushes_read += 1;
        if fate.is_skipped || self.is_skipped(brush) {
            self.summary.brushes_skipped += 1;
            return Ok(());
        }
        match self.build(brush, fate).map_err(StreamError::Input)? {
            Some(built) => {
                self.summary.brushes += 1;
                send(built).map_err(StreamError::Sink)
            }
            None => Ok(()),
        }
    }

    fn build(&mut self, brush: &grammar::Brush<'_>, fate: &Fate) -> Result<Option<Built>, MapError> {
        let mut faces = Vec::with_capacity(brush.faces.len());
        let mut textures = Vec::with_capacity(brush.faces.len());
        for face in &brush.faces {
            match face.plane {
                Ok(half_space) => {
                    let normal = half_space.normal();
                    let scale = normal.abs().max_element();
                    let axes = face.alignment.axes((normal / scale).normalize());
                    textures.push(axes.map(|axes| moved(axes, face.origin)));
                    faces.push(BrushFace { half_space, material: self.material(&text(&face.texture)) });
                }
                Err(PlaneError::NoArea) => self.faces_left_out.add(face.line),
                Err(PlaneError::OutOfRange(source)) => {
                    return Err(MapError::PlaneOutOfRange { name: self.name.to_owned(), line: face.line, source });
                }
            }
        }
        // Without a face it would be all of space, which nobody means.
        if faces.is_empty() {
            self.brushes_left_out.add(brush.line);
            return Ok(None);
        }
        let brush_line = NonZeroU32::new(brush.line);
        Ok(Some(Built { brush: Brush { faces, name: fate.name.clone(), mesh: None }, textures, line: brush_line }))
    }

    /// Whether the textures of all faces that have an area match a pattern to skip.
    fn is_skipped(&self, brush: &grammar::Brush<'_>) -> bool {
        let patterns = &self.options.skip_textures;
        let mut textures = brush.faces.iter().filter(|face| face.plane != Err(PlaneError::NoArea)).peekable();
        !patterns.is_empty()
            && textures.peek().is_some()
            && textures.all(|face| matches_any(patterns, &text(&face.texture)))
    }

    /// The material called `name`, a new one at its first appearance.
    fn material(&mut self, name: &str) -> MaterialId {
        if let Some(id) = self.materials.get(name) {
            return *id;
        }
        let materials = &mut self.summary.materials;
        let id = MaterialId(u32::try_from(materials.len()).unwrap_or(u32::MAX));
        materials.push(Material::named(name));
        self.materials.insert(name.to_owned(), id);
        id
    }

    /// The materials, counts and warnings.
    ///
    /// # Errors
    /// [`MapError::Empty`] where nothing was added at all.
    pub(super) fn finish(mut self) -> Result<MapSummary, MapError> {
        if self.is_empty {
            return Err(MapError::Empty { name: self.name.to_owned() });
        }
        self.summary.warnings = self.warnings();
        self.summary.faces_left_out = self.faces_left_out.count;
        self.summary.brushes_left_out = self.brushes_left_out.count;
        self.summary.patches_left_out = self.patches_left_out.count;
        self.summary.primitives_left_out = self.primitives_left_out.count;
        Ok(self.summary)
    }

    /// One warning for each kind of thing left out, by line.
    fn warnings(&self) -> Vec<Warning> {
        let mut warnings: Vec<Warning> = [
            self.faces_left_out
                .warning("face whose three points lie on one line", "faces whose three points lie on one line")
                .map(|(line, message)| Warning::note(line, message)),
            self.brushes_left_out.loss("brush without faces", "brushes without faces"),
            self.patches_left_out.loss("patch", "patches"),
            self.primitives_left_out.loss("primitive that is not supported", "primitives that are not supported"),
        ]
        .into_iter()
        .flatten()
        .collect();
        warnings.sort_by_key(|warning| warning.line);
        if self.summary.brushes == 0 {
            let message = match (self.summary.brushes_read, self.summary.brushes_skipped) {
                (0, _) => "the map holds no brushes".to_owned(),
                (read, skipped) => format!("no brush is left: {read} read, {skipped} of them skipped by option"),
            };
            warnings.push(Warning::note(0, message));
        }
        warnings
    }
}

/// Most lines that a warning names one by one.
const MAX_LINES: usize = 1000;

/// What was left out, by the lines on which it begins.
#[derive(Default)]
struct Tally {
    count: usize,
    /// The first of them, at most [`MAX_LINES`].
    lines: Vec<u32>,
}

impl Tally {
    fn add(&mut self, line: u32) {
        self.count += 1;
        if self.lines.len() < MAX_LINES {
            self.lines.push(line);
        }
    }

    /// The first line, and a message that names all, or a thousand, where there are several.
    fn warning(&self, one: &str, many: &str) -> Option<(u32, String)> {
        let first = *self.lines.first()?;
        let message = match self.count {
            1 => format!("left out a {one}"),
            count => format!("left out {count} {many}, the first of them here (lines {})", self.listed()),
        };
        Some((first, message))
    }

    /// The same for solids.
    fn loss(&self, one: &str, many: &str) -> Option<Warning> {
        self.warning(one, many).map(|(line, message)| Warning::loss(line, message, self.count))
    }

    fn listed(&self) -> String {
        let lines = self.lines.iter().map(u32::to_string).collect::<Vec<_>>().join(", ");
        match self.count - self.lines.len() {
            0 => lines,
            more => format!("{lines} and {more} more"),
        }
    }
}

/// How a texture lies that is laid from an origin.
fn moved(axes: TextureAxes, origin: DVec3) -> TextureAxes {
    TextureAxes { offset: axes.offset - DVec2::new(axes.u.dot(origin), axes.v.dot(origin)), ..axes }
}

/// Class of the entity that holds the level itself.
pub(super) const WORLD: &str = "worldspawn";

/// Whether compilers make brushes of this class part of the world.
fn is_world(class: &str) -> bool {
    class == WORLD || class == "func_group" || class.starts_with("func_detail")
}

/// The name of the brushes of an entity, where it is not the world.
fn brush_name(class: &str, entity: usize) -> Option<String> {
    match class {
        WORLD => None,
        "" => Some(format!("entity #{entity}")),
        _ => Some(format!("{class} #{entity}")),
    }
}

/// UTF-8 where it is valid, Latin-1 otherwise: no byte is lost.
pub(super) fn text(bytes: &[u8]) -> Cow<'_, str> {
    match std::str::from_utf8(bytes) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => Cow::Owned(bytes.iter().copied().map(char::from).collect()),
    }
}
