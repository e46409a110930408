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
//! (`token`), tokens → entities with planes (`grammar`, `decimal`, `plane`), entities → model (`build`).
//!
//! Sources: the parsers of id Software's `qbsp`, of ericw-tools and of TrenchBroom, and the maps made with them.

mod build;
mod decimal;
mod error;
mod glob;
mod grammar;
mod plane;
mod texture;
mod token;

use planecut_csg::{Model, TextureAxes};
use serde::{Deserialize, Serialize};
use winnow::stream::LocatingSlice;

pub use error::MapError;

use crate::Warning;
use crate::lines::LineTable;
use crate::source::without_byte_order_mark;
use build::Builder;

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
    /// What was left out, one warning for each kind, naming the first line.
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
    let mut builder = Builder::new(name, &lines, options);
    let mut input = LocatingSlice::new(text);
    while let Some(entity) = grammar::entity(&mut input).map_err(|error| error.locate(name, text, &lines))? {
        builder.add_entity(&entity)?;
    }
    builder.finish()
}
