//! The formats, and the one door to their writers.

use std::path::Path;

use planecut_csg::Mesh;

use crate::check::check_mesh;
use crate::{ExportError, glb, obj, stl};

/// A mesh file format, with what it keeps of a [`Mesh`].
///
/// | | precision | index topology | materials | up |
/// |---|---|---|---|---|
/// | glTF | `f32` around the mesh's centre | in `EXT_mesh_manifold` | name and colour | Y, by the root node's rotation |
/// | OBJ | `f64`, exact | yes | name | Z |
/// | STL | `f32` | no: a reader merges equal corners | no | Z |
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Format {
    /// Binary glTF 2.0, one self-contained file.
    Glb,
    /// glTF 2.0 as JSON, with the buffer embedded as a data URI.
    Gltf,
    /// Wavefront OBJ, text.
    Obj,
    /// Binary STL.
    Stl,
}

impl Format {
    /// All formats, in the order in which they are documented.
    pub const ALL: [Self; 4] = [Self::Glb, Self::Gltf, Self::Obj, Self::Stl];

    /// The usual file name ending, without the dot.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Glb => "glb",
            Self::Gltf => "gltf",
            Self::Obj => "obj",
            Self::Stl => "stl",
        }
    }

    /// The format with this file name ending, given without the dot and in any case.
    ///
    /// # Errors
    /// [`ExportError::UnknownFormat`] for any other ending.
    pub fn from_extension(extension: &str) -> Result<Self, ExportError> {
        Self::ALL
            .into_iter()
            .find(|format| format.extension().eq_ignore_ascii_case(extension))
            .ok_or_else(|| ExportError::UnknownFormat { extension: extension.to_owned() })
    }

    /// The format that a file name asks for by its ending.
    ///
    /// # Errors
    /// [`ExportError::UnknownFormat`] when the name has no ending or another one.
    pub fn from_path(path: &Path) -> Result<Self, ExportError> {
        Self::from_extension(&path.extension().unwrap_or_default().to_string_lossy())
    }
}

/// How to write a mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExportOptions {
    /// Factor from the input's units to those of the file: 1 keeps them, 0.0254 turns inches into metres.
    ///
    /// glTF carries it as the root node's scale, the other formats multiply the coordinates.
    pub scale: f64,
    /// Says of each part that it is a convex collider: in glTF by `{"collider": "convex"}` in the extras of its node. Other formats have no
    /// place for it.
    pub convex_colliders: bool,
}

impl Default for ExportOptions {
    fn default() -> Self {
        Self { scale: 1.0, convex_colliders: false }
    }
}

/// One named mesh of a file that holds several, such as a convex cell of a decomposition.
#[derive(Debug, Clone, Copy)]
pub struct Part<'a> {
    /// The name of the mesh node (glTF) or object (OBJ); may be empty.
    pub name: &'a str,
    /// The mesh, in the same coordinates as all others.
    pub mesh: &'a Mesh,
}

/// Writes one mesh as a file of the given format.
///
/// # Errors
/// [`ExportError`] when an index of the mesh is out of range, a number is not finite or does not fit the format's
/// precision, or `options.scale` is unusable.
pub fn encode(mesh: &Mesh, format: Format, options: &ExportOptions) -> Result<Vec<u8>, ExportError> {
    encode_parts(&[Part { name: "solid", mesh }], format, options)
}

/// Writes several meshes as one file: a mesh node each in glTF, an object each in OBJ, one list of triangles in STL.
///
/// # Errors
/// As for [`encode`].
pub fn encode_parts(parts: &[Part<'_>], format: Format, options: &ExportOptions) -> Result<Vec<u8>, ExportError> {
    // NaN fails this comparison as well. The bounds keep the scale and its inverse normal in single precision.
    if !(1e-30..=1e30).contains(&options.scale) {
        return Err(ExportError::Scale(options.scale));
    }
    for part in parts {
        check_mesh(part.mesh)?;
    }
    match format {
        Format::Glb => glb::encode_glb(parts, options),
        Format::Gltf => glb::encode_gltf(parts, options),
        Format::Obj => Ok(obj::encode_obj(parts, options)),
        Format::Stl => stl::encode_stl(parts, options),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn endings_are_recognised_in_any_case() {
        for format in Format::ALL {
            let name = format!("dir.x/a.{}", format.extension().to_uppercase());
            assert_eq!(Format::from_path(Path::new(&name)).expect("known"), format);
        }
        for name in ["a", "a.", "a.fbx", ".glb", "glb"] {
            let error = Format::from_path(Path::new(name)).expect_err(name);
            assert!(matches!(error, ExportError::UnknownFormat { .. }));
        }
    }

    #[test]
    fn unusable_scales_are_refused() {
        for scale in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-40, 1e40] {
            let error = encode(&Mesh::default(), Format::Stl, &ExportOptions { scale, ..ExportOptions::default() })
                .expect_err("refused");
            assert!(matches!(error, ExportError::Scale(_)));
        }
    }
}
