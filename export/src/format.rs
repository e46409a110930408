//! The formats, and the one door to their writers.

use std::io::Write;
use std::path::Path;

use planecut_csg::Mesh;

use crate::part::check_parts;
use crate::{ExportError, ExportOptions, Part, Written, gltf, obj, ply, stl, threemf};

/// A mesh file format, with what it keeps of a [`Mesh`].
///
/// | | precision | index topology | materials | up |
/// |---|---|---|---|---|
/// | glTF | `f32` around the mesh's centre | in `EXT_mesh_manifold` | all | Y, by the root node's rotation |
/// | OBJ | `f64`, exact | yes | name; all in the MTL file | Z |
/// | STL | `f32` | no: a reader merges equal corners | no | Z |
/// | 3MF | `f64`, exact | yes | name and colour | Z |
/// | PLY | `f64`, exact | yes, unless normals or texture coordinates are asked for | colour | Z |
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Format {
    /// Binary glTF 2.0, one self-contained file.
    Glb,
    /// glTF 2.0 as JSON, with the buffer embedded as a data URI.
    Gltf,
    /// Wavefront OBJ, text.
    Obj,
    /// STL, binary or text.
    Stl,
    /// 3D Manufacturing Format, a package of XML.
    ThreeMf,
    /// Stanford polygon format, binary or text.
    Ply,
}

impl Format {
    /// All formats, in the order in which they are documented.
    pub const ALL: [Self; 6] = [Self::Glb, Self::Gltf, Self::Obj, Self::Stl, Self::ThreeMf, Self::Ply];

    /// The usual file name ending, without the dot.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Glb => "glb",
            Self::Gltf => "gltf",
            Self::Obj => "obj",
            Self::Stl => "stl",
            Self::ThreeMf => "3mf",
            Self::Ply => "ply",
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

/// Writes one mesh as a file of the given format.
///
/// # Errors
/// [`ExportError`] when an index of the mesh is out of range, a number is not finite or does not fit the format's
/// precision, or `options.scale` is unusable.
pub fn encode(mesh: &Mesh, format: Format, options: &ExportOptions) -> Result<Vec<u8>, ExportError> {
    encode_parts(&[Part::new("solid", mesh)], format, options)
}

/// Writes several meshes as one file: a mesh node each in glTF, an object each in OBJ and 3MF, one list of triangles in STL and PLY.
///
/// # Errors
/// As for [`encode`].
pub fn encode_parts(parts: &[Part<'_>], format: Format, options: &ExportOptions) -> Result<Vec<u8>, ExportError> {
    let mut bytes = Vec::new();
    write_parts(parts, format, options, &mut bytes)?;
    Ok(bytes)
}

/// The same to a writer, piece by piece: the file is never in memory as a whole.
///
/// # Errors
/// As for [`encode`], and [`ExportError::Io`] where the writer takes no more; what it took by then is no whole file
/// ([`AtomicFile`](crate::AtomicFile) guards against that).
pub fn write_parts(
    parts: &[Part<'_>],
    format: Format,
    options: &ExportOptions,
    out: &mut dyn Write,
) -> Result<(), ExportError> {
    check_parts(parts, options)?;
    match format {
        Format::Glb => gltf::write_glb(parts, options, out),
        Format::Gltf => gltf::write_gltf(parts, options, out),
        Format::Obj => obj::write_obj(parts, options, out),
        Format::Stl => stl::write_stl(parts, options, out),
        Format::ThreeMf => threemf::write_3mf(parts, options, out),
        Format::Ply => ply::write_ply(parts, options, out),
    }
}

/// What [`write_parts`](crate::write_parts) puts into a file. `None` for formats in double precision: they hold the meshes as they are.
///
/// # Errors
/// As for [`encode`](crate::encode).
pub fn written(parts: &[Part<'_>], format: Format, options: &ExportOptions) -> Result<Option<Written>, ExportError> {
    check_parts(parts, options)?;
    match format {
        Format::Glb | Format::Gltf => gltf::written(parts, options).map(Some),
        Format::Stl => stl::written(parts, options).map(Some),
        Format::Obj | Format::ThreeMf | Format::Ply => Ok(None),
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
