//! The options for meshes that are written. The doc comments here are the help texts.

use clap::{Args, ValueEnum};
use planecut::export::{ExportOptions, Projection, Shading, TextureMapping, Unit};

use super::error::CliError;

/// What meshes should hold, as far as their format can.
#[derive(Debug, Args)]
#[command(next_help_heading = "Options for meshes")]
pub(crate) struct AssetArgs {
    /// Unit of length: glTF is scaled to metres, 3MF names it
    #[arg(long, value_enum, value_name = "UNIT")]
    unit: Option<UnitName>,
    /// Write the materials of each OBJ file beside it, with the ending .mtl
    #[arg(long)]
    pub(crate) mtl: bool,
    /// Write text instead of binary: STL, PLY
    #[arg(long)]
    text: bool,
    /// Smooth normals across edges up to this angle in degrees, instead of flat faces: glTF, OBJ, PLY
    #[arg(long, value_name = "DEGREES")]
    smooth: Option<f64>,
    /// Texture coordinates: those of the map or of meshes, by the nearest side of a box, or projected along z: glTF, OBJ, PLY
    #[arg(long, value_enum, value_name = "HOW")]
    uv: Option<Uv>,
    /// Size of a texture: in texels for faces of a map (default 64), else in units of the input (default 1)
    #[arg(long, value_name = "LENGTH", requires = "uv")]
    uv_size: Option<f64>,
    /// Tangents, for normal maps: glTF
    #[arg(long, requires = "uv")]
    tangents: bool,
    /// Colours of vertices instead of materials: glTF
    #[arg(long)]
    vertex_colors: bool,
    /// Numbers of brush and plane for each face, in extras: glTF
    #[arg(long)]
    ids: bool,
    /// Positions in 16 bits, normals in 8: glTF (KHR_mesh_quantization)
    #[arg(long)]
    quantize: bool,
    /// Packed buffers: glTF (EXT_meshopt_compression)
    #[arg(long)]
    meshopt: bool,
}

/// A unit of length by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum UnitName {
    Um,
    Mm,
    Cm,
    In,
    Ft,
    M,
}

/// Where texture coordinates come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Uv {
    /// As stated by the faces of a map, or at the corners of a mesh's triangles (also of meshes that a .json or .csg names); otherwise as box
    Source,
    /// By the nearest side of a box
    Box,
    /// Projected along z
    Planar,
}

impl UnitName {
    /// The same as the library wants it.
    pub(crate) fn unit(self) -> Unit {
        match self {
            Self::Um => Unit::Micron,
            Self::Mm => Unit::Millimeter,
            Self::Cm => Unit::Centimeter,
            Self::In => Unit::Inch,
            Self::Ft => Unit::Foot,
            Self::M => Unit::Meter,
        }
    }
}

impl AssetArgs {
    /// The same as the library wants it.
    pub(crate) fn options(&self, scale: f64) -> ExportOptions {
        let texture = self.uv.map(|uv| {
            let (projection, size) = match uv {
                Uv::Source => (Projection::Source, 64.0),
                Uv::Box => (Projection::Box, 1.0),
                Uv::Planar => (Projection::Planar, 1.0),
            };
            TextureMapping { projection, size: self.uv_size.unwrap_or(size) }
        });
        ExportOptions {
            scale,
            unit: self.unit.map(UnitName::unit),
            text: self.text,
            shading: self.smooth.map_or(Shading::Flat, |crease| Shading::Smooth { crease }),
            texture,
            tangents: self.tangents,
            vertex_colors: self.vertex_colors,
            source_ids: self.ids,
            quantize: self.quantize,
            meshopt: self.meshopt,
            ..ExportOptions::default()
        }
    }

    /// Sees that nothing is asked for that needs the faces of the input as they are.
    ///
    /// # Errors
    /// [`CliError::Usage`].
    pub(crate) fn check_without_sources(&self) -> Result<(), CliError> {
        match self.splits_by_face() {
            Some(_) => {
                let found = if self.ids { "--ids" } else { "--uv source" };
                Err(CliError::Usage(format!("found {found} with another command, expected it with build")))
            }
            None => Ok(()),
        }
    }

    /// Whether texture coordinates of meshes that are read must be kept.
    pub(crate) fn keeps_textures(&self) -> bool {
        self.uv == Some(Uv::Source)
    }

    /// Whether faces of different sources must stay apart; `Some(true)` for each face of a brush by itself.
    pub(crate) fn splits_by_face(&self) -> Option<bool> {
        let by_texture = self.keeps_textures().then_some(false);
        if self.ids { Some(true) } else { by_texture }
    }
}
