//! How to write a mesh.

use serde::{Deserialize, Serialize};

use crate::ExportError;

/// How to write a mesh. Each format takes what it has a place for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ExportOptions {
    /// Factor from the input's units to those of the file: 1 keeps them, 0.0254 turns inches into metres.
    ///
    /// glTF carries it as the root node's scale, the other formats multiply the coordinates.
    pub scale: f64,
    /// What the lengths of the file are in, `scale` included. glTF is in metres by its specification: with a unit its root node is scaled
    /// to them. 3MF names it. Others have no place for it.
    pub unit: Option<Unit>,
    /// Text instead of numbers as they are in memory: STL and PLY.
    pub text: bool,
    /// Normals of vertices: glTF, OBJ and PLY.
    pub shading: Shading,
    /// Texture coordinates: glTF, OBJ and PLY.
    pub texture: Option<TextureMapping>,
    /// Tangents by MikkTSpace, which normal maps are made for: glTF. They need texture coordinates.
    pub tangents: bool,
    /// Colours of vertices instead of materials of these colours, so that a mesh is drawn at once: glTF.
    pub vertex_colors: bool,
    /// Brush and plane of each face, in the extras of primitives: glTF, for parts whose sources are known.
    pub source_ids: bool,
    /// Positions in 16 bits, normals, tangents and colours in 8 (`KHR_mesh_quantization`): glTF. Positions lie on a grid whose step is a power of
    /// two: coordinates on a coarser one stay exact.
    pub quantize: bool,
    /// Buffers packed by `EXT_meshopt_compression`: glTF. Needs the feature `meshopt`, else writers give [`ExportError::MissingFeature`].
    pub meshopt: bool,
    /// Says of each part that it is a convex collider: in glTF by `{"collider": "convex"}` in the extras of its node. Other formats have no
    /// place for it.
    pub convex_colliders: bool,
    /// The file of materials that an OBJ file names: see [`write_mtl`](crate::write_mtl).
    pub material_library: Option<String>,
}

impl Default for ExportOptions {
    fn default() -> Self {
        Self {
            scale: 1.0,
            unit: None,
            text: false,
            shading: Shading::Flat,
            texture: None,
            tangents: false,
            vertex_colors: false,
            source_ids: false,
            quantize: false,
            meshopt: false,
            convex_colliders: false,
            material_library: None,
        }
    }
}

/// A unit of length.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Unit {
    /// 10⁻⁶ m.
    Micron,
    /// 10⁻³ m.
    Millimeter,
    /// 10⁻² m.
    Centimeter,
    /// 0.0254 m.
    Inch,
    /// 0.3048 m.
    Foot,
    /// The metre.
    Meter,
}

impl Unit {
    /// How many metres it is.
    #[must_use]
    pub fn meters(self) -> f64 {
        match self {
            Self::Micron => 1e-6,
            Self::Millimeter => 1e-3,
            Self::Centimeter => 1e-2,
            Self::Inch => 0.0254,
            Self::Foot => 0.3048,
            Self::Meter => 1.0,
        }
    }

    /// How it is written behind a number.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Micron => "µm",
            Self::Millimeter => "mm",
            Self::Centimeter => "cm",
            Self::Inch => "in",
            Self::Foot => "ft",
            Self::Meter => "m",
        }
    }
}

/// Which way the normals of vertices point.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Shading {
    /// Each face has its own: edges are seen.
    Flat,
    /// Faces that meet at no more than the crease angle share theirs: what approximates a curved surface looks smooth.
    Smooth {
        /// The crease angle, between the normals of both faces, from 0 to 180.
        crease: f64,
    },
}

/// Where texture coordinates come from.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct TextureMapping {
    /// How they follow from positions.
    pub projection: Projection,
    /// Length that a texture covers once: in units of the input, in texels where the source counts in these. Where it counts in whole
    /// pictures this has no say.
    pub size: f64,
}

/// How textures are projected onto faces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Projection {
    /// As the source says: the axes of a map's faces, the coordinates of a mesh's triangles. Faces of which nothing is known get
    /// [`Projection::Box`].
    Source,
    /// Each face along the axis that its normal is nearest to, upright on walls.
    Box,
    /// All along z, from above.
    Planar,
}

impl ExportOptions {
    /// Checks that all numbers can be used.
    pub(crate) fn check(&self) -> Result<(), ExportError> {
        // NaN fails these comparisons as well. The bounds keep the scale and its inverse normal in single precision.
        let usable = 1e-30..=1e30;
        if !usable.contains(&self.scale) {
            return Err(ExportError::Scale(self.scale));
        }
        if let Shading::Smooth { crease } = self.shading
            && !(0.0..=180.0).contains(&crease)
        {
            return Err(ExportError::CreaseAngle(crease));
        }
        match self.texture {
            Some(TextureMapping { size, .. }) if !usable.contains(&size) => Err(ExportError::TextureSize(size)),
            None if self.tangents => Err(ExportError::TangentsWithoutTexture),
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_go_through_json_and_what_is_not_said_is_the_default() {
        let options: ExportOptions =
            serde_json::from_str(r#"{"unit": "inch", "shading": {"smooth": {"crease": 30.0}}}"#).expect("options");
        let expected = ExportOptions {
            unit: Some(Unit::Inch),
            shading: Shading::Smooth { crease: 30.0 },
            ..ExportOptions::default()
        };
        assert_eq!(options, expected);
        let text = serde_json::to_string(&options).expect("JSON");
        assert_eq!(serde_json::from_str::<ExportOptions>(&text).expect("options"), expected);
        serde_json::from_str::<ExportOptions>(r#"{"units": "inch"}"#).expect_err("an unknown field");
    }
}
