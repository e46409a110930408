//! Reader of Quake-family `.map` files.
//!
//! A map is a list of entities; an entity is a list of quoted key/value pairs and of brushes; a brush is a list of
//! faces, each of a plane, mostly as three points, a texture and how the texture is laid on. What is read here is the planes, the texture
//! names and the class names. These dialects are taken, also mixed in one file:
//!
//! | dialect | after the texture |
//! |---|---|
//! | Quake | `x y rotation x-scale y-scale` |
//! | Hexen II | the same and one value |
//! | Quake 2, Quake 3 | the same and `contents flags value` |
//! | Daikatana | the same and three values of colour |
//! | Valve 220 | `[ ux uy uz x ] [ vx vy vz y ] rotation x-scale y-scale`, and any of the additions above |
//! | `brushDef` | nothing or `contents flags value`; a texture matrix stands before the texture |
//! | `brushDef3` | the same; four numbers `a b c d` state the half-space `a x + b y + c z + d ≤ 0`, relative to the entity's `origin` |
//!
//! Comments begin with `//` or `;`. Patches and other primitives are left out, with a warning. The stages, each in its own file: bytes → tokens
//! (`token`), tokens → pieces of entities, with planes (`grammar`, `decimal`, `plane`), pieces → brushes (`entity`, `build`). A map that is
//! read as a stream goes through them one window of its text after another (`stream`, `window`).
//!
//! Sources: the parsers of id Software's `qbsp`, of ericw-tools and of TrenchBroom, and the maps made with them.

mod build;
mod decimal;
mod entity;
mod error;
mod glob;
mod grammar;
mod plane;
mod stream;
mod texture;
mod token;
mod window;

use std::convert::Infallible;

use planecut_csg::{Material, Model, TextureAxes, Tree};
use serde::{Deserialize, Serialize};
use winnow::stream::LocatingSlice;

pub use error::MapError;
pub use stream::stream_map;

use crate::Warning;
use crate::lines::LineTable;
use crate::source::without_byte_order_mark;
use build::{Builder, Built};
use entity::Collector;
use error::Surroundings;

/// Which brushes of a map to leave aside.
///
/// Patterns are globs over the whole name (`*` any run of characters, `?` any one character), without regard to ASCII
/// case.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MapOptions {
    /// Take only what map compilers make part of the world: brushes of `worldspawn`, of `func_group` and of
    /// `func_detail…`, and brushes outside any entity.
    pub world_only: bool,
    /// Skip a brush when the texture of *every* face matches one of these patterns (`clip`, `trigger`, `hint*`, …).
    pub skip_textures: Vec<String>,
    /// Skip all brushes of an entity whose class name matches one of these patterns.
    pub skip_classes: Vec<String>,
}

/// A map that was read.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MapImport {
    /// The brushes, in the order of the file; a brush outside the world is named `classname #entity`, entities being
    /// counted from 0.
    pub model: Model,
    /// For each brush how the textures of its faces lie, in texels, or in whole pictures where it is a brush primitive (`brushDef`); not known where
    /// numbers run out of range.
    pub textures: Vec<Vec<Option<TextureAxes>>>,
    /// Entities in the file, skipped ones included.
    pub entities: usize,
    /// Brushes in the file, those included that were skipped or left out.
    pub brushes_read: usize,
    /// Brushes that the options leave aside.
    pub brushes_skipped: usize,
    /// Brushes left out because no face was left.
    pub brushes_left_out: usize,
    /// Faces left out because their three points lie on one line.
    pub faces_left_out: usize,
    /// Curved patches left out (`patchDef2`, `patchDef3`, …).
    pub patches_left_out: usize,
    /// Primitives of other kinds left out (`terrainDef`, `meshDef`, …).
    pub primitives_left_out: usize,
    /// What was left out, one warning for each kind, naming the first thousand lines.
    pub warnings: Vec<Warning>,
}

/// What a map held whose brushes were handed on.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MapSummary {
    /// The materials of all faces: brushes name them by their places here.
    pub materials: Vec<Material>,
    /// Brushes that were handed on.
    pub brushes: usize,
    /// As [`MapImport::entities`].
    pub entities: usize,
    /// As [`MapImport::brushes_read`].
    pub brushes_read: usize,
    /// As [`MapImport::brushes_skipped`].
    pub brushes_skipped: usize,
    /// As [`MapImport::brushes_left_out`].
    pub brushes_left_out: usize,
    /// As [`MapImport::faces_left_out`].
    pub faces_left_out: usize,
    /// As [`MapImport::patches_left_out`].
    pub patches_left_out: usize,
    /// As [`MapImport::primitives_left_out`].
    pub primitives_left_out: usize,
    /// As [`MapImport::warnings`].
    pub warnings: Vec<Warning>,
}

/// Reads a map; `name` is what errors call the file.
///
/// The plane of a face through `p0, p1, p2` has the outward normal `(p0 − p1) × (p2 − p1)`. Coefficients are exact
/// integers without a common factor where these fit an `f64`, otherwise the exact plane rounded once; coplanar faces of
/// usual maps thus come out bit-identical, whatever points gave them.
///
/// Texts are UTF-8 where they are valid UTF-8, Latin-1 otherwise. Whether a brush is empty or unbounded is not looked at.
///
/// # Errors
/// [`MapError`], with the line, where the text is not a map, a plane is outside the accepted range, or the file is
/// empty. A map whose brushes were all skipped or left out is no error; it carries a warning.
pub fn read_map(text: &[u8], name: &str, options: &MapOptions) -> Result<MapImport, MapError> {
    let text = without_byte_order_mark(text);
    let lines = LineTable::new(text);
    let line_of = |offset| lines.line_of(offset);
    let mut collector = Collector::new(Builder::new(name, options), true);
    let (mut brushes, mut brush_lines, mut textures) = (Vec::new(), Vec::new(), Vec::new());
    let mut send = |built: Built| -> Result<(), Infallible> {
        brushes.push(built.brush);
        brush_lines.push(built.line);
        textures.push(built.textures);
        Ok(())
    };
    let mut input = LocatingSlice::new(text);
    loop {
        match grammar::event(&mut input, collector.is_inside()) {
            Ok(None) => break,
            Ok(Some(event)) => collector.take(event, line_of, |brush| brush, &mut send).map_err(|e| e.into_input())?,
            Err(error) => {
                let entity_line = collector.entity_line();
                let located = error.locate(&Surroundings { name, text, line_of, line_before: 1, entity_line });
                return Err(collector.earlier_error().unwrap_or(located));
            }
        }
    }
    let summary = collector.into_builder().finish()?;
    let tree = Tree::union_of(brushes).with_source_lines(brush_lines);
    Ok(MapImport {
        model: Model { materials: summary.materials, tree },
        textures,
        entities: summary.entities,
        brushes_read: summary.brushes_read,
        brushes_skipped: summary.brushes_skipped,
        brushes_left_out: summary.brushes_left_out,
        faces_left_out: summary.faces_left_out,
        patches_left_out: summary.patches_left_out,
        primitives_left_out: summary.primitives_left_out,
        warnings: summary.warnings,
    })
}
