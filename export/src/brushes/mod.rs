//! Convex bodies in the formats of editors.
//!
//! - `body`: what is left of a brush: the faces it really has, and their corners.
//! - `points`: three points that say a face's plane, exactly where decimals can (`lattice`).
//! - `map`, `scad`: the formats.

mod body;
mod lattice;
mod map;
mod points;
mod scad;

use std::io::Write;
use std::path::Path;

use planecut_csg::{Brush, Material};
use planecut_parallel::prelude::*;

use crate::ExportError;
use body::Body;

/// A file format of convex bodies, with what it keeps of a [`Brush`].
///
/// | | planes | materials | names |
/// |---|---|---|---|
/// | map | exact where decimals of six places can say them, else by points rounded to `f64` | name, of each face | `classname #n`: an entity of its own |
/// | OpenSCAD | by corners rounded to `f64` | colour, of each body | no |
///
/// OpenSCAD rounds corners to a grid of `2^-20` (about `1e-6`) when it combines bodies, whatever is written; bodies that are
/// needles on that grid are left out of its files. A scale can make details larger.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum BrushFormat {
    /// A Quake-family map in the Valve 220 format, which the editors for these games open.
    Map,
    /// OpenSCAD's evaluated tree: the union of one `polyhedron` for each body.
    Scad,
}

impl BrushFormat {
    /// All formats, in the order in which they are documented.
    pub const ALL: [Self; 2] = [Self::Map, Self::Scad];

    /// The usual file name ending, without the dot.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Map => "map",
            Self::Scad => "csg",
        }
    }

    /// The format with this file name ending, given without the dot and in any case.
    ///
    /// # Errors
    /// [`ExportError::UnknownBrushFormat`] for any other ending.
    pub fn from_extension(extension: &str) -> Result<Self, ExportError> {
        Self::ALL
            .into_iter()
            .find(|format| format.extension().eq_ignore_ascii_case(extension))
            .ok_or_else(|| ExportError::UnknownBrushFormat { extension: extension.to_owned() })
    }

    /// The format that a file name asks for by its ending.
    ///
    /// # Errors
    /// [`ExportError::UnknownBrushFormat`] when the name has no ending or another one.
    pub fn from_path(path: &Path) -> Result<Self, ExportError> {
        Self::from_extension(&path.extension().unwrap_or_default().to_string_lossy())
    }
}

/// Writes bounded convex bodies with their materials, all coordinates times `scale`.
///
/// Bodies without interior are left out, as are bodies so thin that rounded coordinates cannot say them (a few roundings of
/// their largest coordinate), and planes without a face. Text goes out body after body: the whole file is
/// never in memory. The bytes are the same whatever the number of threads.
///
/// ```
/// use planecut_csg::{Brush, Material, MaterialId};
/// use planecut_export::{BrushFormat, write_brushes};
/// use planecut_kernel::DVec3;
///
/// # fn main() -> Result<(), planecut_export::ExportError> {
/// let cube = Brush::cuboid(DVec3::ZERO, DVec3::splat(64.0), MaterialId(0));
/// let mut text = Vec::new();
/// write_brushes(&[cube], &[Material::named("brick")], BrushFormat::Map, 1.0, &mut text)?;
/// assert!(text.starts_with(b"// Game: Generic\n// Format: Valve\n"));
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// [`ExportError::Unbounded`], [`ExportError::UnknownMaterial`] and [`ExportError::BrushRange`] name the brush by its number;
/// [`ExportError::Scale`] for a scale that is not between 1e-30 and 1e30; [`ExportError::Io`] where `out` refuses. Part of the
/// text may have been written by then.
pub fn write_brushes(
    brushes: &[Brush],
    materials: &[Material],
    format: BrushFormat,
    scale: f64,
    out: &mut dyn Write,
) -> Result<(), ExportError> {
    // NaN fails this comparison as well.
    if !(1e-30..=1e30).contains(&scale) {
        return Err(ExportError::Scale(scale));
    }
    let source = Source { brushes, materials, scale };
    match format {
        BrushFormat::Map => map::write(&source, out),
        BrushFormat::Scad => scad::write(&source, out),
    }
}

/// What is to be written.
struct Source<'a> {
    brushes: &'a [Brush],
    materials: &'a [Material],
    scale: f64,
}

/// Number of bodies that all threads make at once.
const AT_ONCE: usize = 512;

impl Source<'_> {
    /// Hands over what `encode` makes of the bodies with these numbers, in this order; those without interior are passed over.
    fn for_each<T: Send>(
        &self,
        numbers: &[usize],
        encode: impl Fn(&Body) -> T + Sync,
        mut take: impl FnMut(T) -> Result<(), ExportError>,
    ) -> Result<(), ExportError> {
        for some in numbers.chunks(AT_ONCE) {
            // all results, then the first error: which one comes first must not depend on threads
            let bodies: Vec<_> =
                some.par_iter().map(|number| self.body(*number).map(|body| body.as_ref().map(&encode))).collect();
            for encoded in bodies {
                if let Some(encoded) = encoded? {
                    take(encoded)?;
                }
            }
        }
        Ok(())
    }

    fn body(&self, number: usize) -> Result<Option<Body>, ExportError> {
        Body::of(number, &self.brushes[number], self.materials.len(), self.scale)
    }
}
