//! Reader of OpenSCAD's evaluated trees, `.csg`.
//!
//! OpenSCAD writes one from any program (`openscad -o part.csg part.scad`): all variables, loops and modules are gone, and what is
//! left is nodes in nodes with numbers. Here such a tree becomes a [`Model`]: shapes have OpenSCAD's very corners, colours
//! become materials, and where OpenSCAD is lenient this is too, with a warning.
//!
//! The stages, each in its own file: bytes → tokens (`token`), tokens → nodes (`syntax`, `value`), what nodes inherit
//! (`frame`, `materials`), nodes → bodies and regions (`leaf`, `polyhedron`, `import`, `surface`, `fragments`,
//! `extrusion`), and their combination
//! (`evaluate`, `flat`, `solid`). No stage is recursive, so trees can be nested to any depth.
//!
//! Source: the OpenSCAD User Manual, and the behaviour of OpenSCAD 2021.01.

mod arguments;
mod error;
mod evaluate;
mod extrusion;
mod flat;
mod fragments;
mod frame;
mod import;
mod leaf;
mod materials;
mod polyhedron;
mod problem;
mod solid;
mod surface;
mod syntax;
#[cfg_attr(not(feature = "text"), path = "text_missing.rs")]
mod text;
mod token;
mod turn;
mod value;

use std::path::PathBuf;

use planecut_csg::Model;
use serde::{Deserialize, Serialize};

pub use error::ScadError;

use crate::Warning;
use crate::lines::LineTable;
use crate::source::{DEFAULT_MAX_PIECES, without_byte_order_mark};
use evaluate::Evaluator;

pub use crate::source::MAX_TEXT;

/// How a tree is read.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ScadOptions {
    /// Where files that `import` and `surface` name are looked for; the current folder by default.
    pub folder: PathBuf,
    /// Leaves out what cannot be made, with a warning, instead of failing.
    pub keep_going: bool,
    /// Keeps solids that touch themselves in an edge or a corner also where they are combined with others, as OpenSCAD does since it has Manifold
    /// (2024). OpenSCAD 2021.01 leaves them out.
    pub keep_touching: bool,
    /// Most convex bodies that are made, and most corners of all outlines, those included that later steps leave out;
    /// [`DEFAULT_MAX_PIECES`] unless it is set.
    pub max_pieces: usize,
    /// Whether texture coordinates of files that `import` names are kept, as [`SolidOptions::textures`](crate::mesh::SolidOptions::textures) says.
    pub textures: bool,
}

impl Default for ScadOptions {
    fn default() -> Self {
        Self {
            folder: PathBuf::new(),
            keep_going: false,
            keep_touching: false,
            max_pieces: DEFAULT_MAX_PIECES,
            textures: false,
        }
    }
}

/// A tree that was read.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ScadImport {
    /// The solid; each brush has the line of the node that made it.
    pub model: Model,
    /// What was left out, and what OpenSCAD warns of too.
    pub warnings: Vec<Warning>,
}

/// Reads an evaluated tree; `name` is what errors call it.
///
/// ```
/// use planecut_import::scad::{ScadOptions, read_scad};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let text = b"difference() { cube(size = [4, 4, 2]); color([1, 0, 0]) { cylinder(h = 2, r = 1, $fn = 4); } }";
/// let import = read_scad(text, "plate.csg", &ScadOptions::default())?;
/// let evaluation = planecut_csg::evaluate(&import.model)?;
/// // the quarter of a square prism is gone, and the cut is red
/// assert!((evaluation.solid.volume - (32.0 - 1.0)).abs() < 1e-12);
/// assert_eq!(import.model.materials[1].name, "#ff0000");
///
/// let error = read_scad(b"cube(1);\nteapot(size = 2);", "hill.csg", &ScadOptions::default()).unwrap_err();
/// assert!(error.to_string().starts_with("hill.csg:2: found `teapot`, "));
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// [`ScadError`], with the line, where the text is no evaluated tree, asks for something that is not supported, or for a shape
/// that cannot be made; the latter two only without [`ScadOptions::keep_going`].
pub fn read_scad(text: &[u8], name: &str, options: &ScadOptions) -> Result<ScadImport, ScadError> {
    if text.len() > MAX_TEXT {
        return Err(ScadError::TooLong { name: name.to_owned(), bytes: text.len() });
    }
    let text = without_byte_order_mark(text);
    let lines = LineTable::new(text);
    let located = |fault: error::Fault| fault.locate(name, text, &lines);
    let nodes = syntax::parse(text).map_err(located)?;
    let evaluator = Evaluator::new(&nodes, &lines, options);
    evaluator.run().map_err(located)
}
