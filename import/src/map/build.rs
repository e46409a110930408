//! From entities to a model: names, options, and what is left out.

use std::borrow::Cow;
use std::num::NonZeroU32;

use glam::{DVec2, DVec3};
use planecut_csg::{Brush, BrushFace, Material, MaterialId, TextureAxes, Tree};
use rustc_hash::FxHashMap;

use super::error::MapError;
use super::glob::matches_any;
use super::grammar::{self, Entity};
use super::plane::PlaneError;
use super::{MapImport, MapOptions};
use crate::Warning;
use crate::lines::LineTable;

/// Collects the brushes of one map.
pub(super) struct Builder<'a> {
    name: &'a str,
    lines: &'a LineTable,
    options: &'a MapOptions,
    materials: FxHashMap<String, MaterialId>,
    faces_left_out: Tally,
    brushes_left_out: Tally,
    patches_left_out: Tally,
    primitives_left_out: Tally,
    is_empty: bool,
    brushes: Vec<Brush>,
    /// The lines on which the brushes begin.
    brush_lines: Vec<Option<NonZeroU32>>,
    import: MapImport,
}

impl<'a> Builder<'a> {
    /// A builder of an empty model; `name` is what errors call the file.
    pub(super) fn new(name: &'a str, lines: &'a LineTable, options: &'a MapOptions) -> Self {
        Self {
            name,
            lines,
            options,
            materials: FxHashMap::default(),
            faces_left_out: Tally::default(),
            brushes_left_out: Tally::default(),
            patches_left_out: Tally::default(),
            primitives_left_out: Tally::default(),
            is_empty: true,
            brushes: Vec::new(),
            brush_lines: Vec::new(),
            import: MapImport::default(),
        }
    }

    /// Adds the brushes of an entity, but for those that the options leave aside.
    ///
    /// # Errors
    /// [`MapError::PlaneOutOfRange`] for a face of a brush that is kept.
    pub(super) fn add_entity(&mut self, entity: &Entity<'_>) -> Result<(), MapError> {
        let index = self.import.entities;
        self.is_empty = false;
        self.import.entities += usize::from(!entity.is_bare);
        self.import.brushes_read += entity.brushes.len();
        let class = if entity.is_bare { WORLD.into() } else { text(entity.classname.as_deref().unwrap_or_default()) };
        if (self.options.world_only && !is_world(&class)) || matches_any(&self.options.skip_classes, &class) {
            self.import.brushes_skipped += entity.brushes.len();
            return Ok(());
        }
        for primitive in &entity.left_out {
            let tally = if primitive.is_patch { &mut self.patches_left_out } else { &mut self.primitives_left_out };
            tally.add(self.lines.line_of(primitive.offset));
        }
        let name = brush_name(&class, index);
        for brush in &entity.brushes {
            self.add_brush(brush, name.as_deref())?;
        }
        Ok(())
    }

    fn add_brush(&mut self, brush: &grammar::Brush<'_>, name: Option<&str>) -> Result<(), MapError> {
        if self.is_skipped(brush) {
            self.import.brushes_skipped += 1;
            return Ok(());
        }
        let line = self.lines.line_of(brush.offset);
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
                Err(PlaneError::NoArea) => self.faces_left_out.add(self.lines.line_of(face.offset)),
                Err(PlaneError::OutOfRange(source)) => {
                    let line = self.lines.line_of(face.offset);
                    return Err(MapError::PlaneOutOfRange { name: self.name.to_owned(), line, source });
                }
            }
        }
        // Without a face it would be all of space, which nobody means.
        if faces.is_empty() {
            self.brushes_left_out.add(line);
        } else {
            self.import.textures.push(textures);
            self.brushes.push(Brush { faces, name: name.map(str::to_owned), mesh: None });
            self.brush_lines.push(NonZeroU32::new(line));
        }
        Ok(())
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
        let materials = &mut self.import.model.materials;
        let id = MaterialId(u32::try_from(materials.len()).unwrap_or(u32::MAX));
        materials.push(Material::named(name));
        self.materials.insert(name.to_owned(), id);
        id
    }

    /// The import with its counts and warnings.
    ///
    /// # Errors
    /// [`MapError::Empty`] where nothing was added at all.
    pub(super) fn finish(mut self) -> Result<MapImport, MapError> {
        if self.is_empty {
            return Err(MapError::Empty { name: self.name.to_owned() });
        }
        let lines = std::mem::take(&mut self.brush_lines);
        self.import.model.tree = Tree::union_of(std::mem::take(&mut self.brushes)).with_source_lines(lines);
        self.import.warnings = self.warnings();
        self.import.faces_left_out = self.faces_left_out.count();
        self.import.brushes_left_out = self.brushes_left_out.count();
        self.import.patches_left_out = self.patches_left_out.count();
        self.import.primitives_left_out = self.primitives_left_out.count();
        Ok(self.import)
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
        if self.import.model.tree.brushes().is_empty() {
            let message = match (self.import.brushes_read, self.import.brushes_skipped) {
                (0, _) => "the map holds no brushes".to_owned(),
                (read, skipped) => format!("no brush is left: {read} read, {skipped} of them skipped by option"),
            };
            warnings.push(Warning::note(0, message));
        }
        warnings
    }
}

/// What was left out, by the lines on which it begins.
#[derive(Default)]
struct Tally {
    lines: Vec<u32>,
}

impl Tally {
    fn add(&mut self, line: u32) {
        self.lines.push(line);
    }

    fn count(&self) -> usize {
        self.lines.len()
    }

    /// The first line, and a message that names all where there are several.
    fn warning(&self, one: &str, many: &str) -> Option<(u32, String)> {
        let first = *self.lines.first()?;
        let message = match self.count() {
            1 => format!("left out a {one}"),
            count => format!("left out {count} {many}, the first of them here (lines {})", listed(&self.lines)),
        };
        Some((first, message))
    }

    /// The same for solids.
    fn loss(&self, one: &str, many: &str) -> Option<Warning> {
        self.warning(one, many).map(|(line, message)| Warning::loss(line, message, self.count()))
    }
}

fn listed(lines: &[u32]) -> String {
    lines.iter().map(u32::to_string).collect::<Vec<_>>().join(", ")
}

/// How a texture lies that is laid from an origin.
fn moved(axes: TextureAxes, origin: DVec3) -> TextureAxes {
    TextureAxes { offset: axes.offset - DVec2::new(axes.u.dot(origin), axes.v.dot(origin)), ..axes }
}

/// Class of the entity that holds the level itself.
const WORLD: &str = "worldspawn";

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
fn text(bytes: &[u8]) -> Cow<'_, str> {
    match std::str::from_utf8(bytes) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => Cow::Owned(bytes.iter().copied().map(char::from).collect()),
    }
}
