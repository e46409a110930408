//! What can go wrong on the way out.

use std::io;
use std::path::PathBuf;

/// Why a mesh could not be written. Each message is one line.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// The file name ends in something that no writer makes.
    #[error("unknown output format '.{extension}', expected .glb, .gltf, .obj, .stl, .3mf or .ply")]
    UnknownFormat {
        /// The ending as given, without the dot.
        extension: String,
    },
    /// The file name ends in something that no writer of convex bodies makes.
    #[error("unknown format of convex bodies '.{extension}', expected .map or .csg")]
    UnknownBrushFormat {
        /// The ending as given, without the dot.
        extension: String,
    },
    /// The file name ends in something that no writer of rigid bodies makes.
    #[error("unknown format of rigid bodies '.{extension}', expected .xml, .urdf or .usda")]
    UnknownPhysicsFormat {
        /// The ending as given, without the dot.
        extension: String,
    },
    /// No engine has this name.
    #[error("engine: found {name:?}, expected one of {expected}")]
    UnknownEngine {
        /// The name.
        name: String,
        /// Those that there are.
        expected: String,
    },
    /// A rigid body has nothing to collide with.
    #[error("found a rigid body without colliders, expected one at least")]
    NoColliders,
    /// Neither the mesh nor its colliders enclose a volume that has a mass.
    #[error("found no volume that has a mass at a density of {density} kg/m³, expected a body that has one")]
    NoMass {
        /// In kilograms per cubic metre.
        density: f64,
    },
    /// A mass or a moment of inertia is beyond what the numbers of a format hold (USD): engines would take it for none.
    #[error(
        "found a mass or moment of inertia of {value:e}, expected one that single precision holds: see units and density"
    )]
    MassRange {
        /// In kilograms, or times square metres.
        value: f64,
    },
    /// A brush is a closed mesh.
    #[error("brush {brush} (counted from 0) is a closed mesh, expected convex bodies alone")]
    MeshBrush {
        /// Its place among the brushes, from 0.
        brush: usize,
    },
    /// A brush reaches infinity.
    #[error("brush {brush} (counted from 0) is unbounded, expected bounded convex bodies")]
    Unbounded {
        /// Its place among the brushes, from 0.
        brush: usize,
    },
    /// A face of a brush names a material that is not there.
    #[error("brush {brush} (counted from 0) names material {material}, found {count} materials")]
    UnknownMaterial {
        /// Its place among the brushes, from 0.
        brush: usize,
        /// The number of the material.
        material: u32,
        /// How many materials there are.
        count: usize,
    },
    /// A brush reaches farther out than a file of convex bodies can say.
    #[error(
        "brush {brush} (counted from 0) has a corner at {value:e} after scaling, expected coordinates within ±1e30"
    )]
    BrushRange {
        /// Its place among the brushes, from 0.
        brush: usize,
        /// The coordinate after scaling.
        value: f64,
    },
    /// A model has more of something than the reader of model files takes.
    #[error("found {found}, expected {expected}: no more is read from a model file")]
    ModelLimit {
        /// What there is too much of.
        found: String,
        /// How much there may be.
        expected: String,
    },
    /// A material has a number that a model file cannot hold.
    #[error("material {material:?}: found a colour, metalness or roughness of {value}, expected a number from 0 to 1")]
    MaterialRange {
        /// Its name.
        material: String,
        /// The number.
        value: f32,
    },
    /// A brush is beyond what a model file can say.
    #[error("brush {brush} (counted from 0) is beyond the range of model files: {reason}")]
    ModelRange {
        /// Its place among the brushes, from 0.
        brush: usize,
        /// What of it is.
        reason: String,
    },
    /// The mesh refers to something that it does not hold, or holds a value that is not a number.
    #[error("invalid mesh: {0}")]
    InvalidMesh(String),
    /// The scale is not a positive number that single precision can hold.
    #[error("scale is {0}, expected a positive number between 1e-30 and 1e30")]
    Scale(f64),
    /// The crease angle is not an angle between two normals.
    #[error("crease angle is {0}, expected 0 to 180 degrees")]
    CreaseAngle(f64),
    /// The size of a texture is not a positive number that single precision can hold.
    #[error("texture size is {0}, expected a positive number between 1e-30 and 1e30")]
    TextureSize(f64),
    /// Tangents follow from texture coordinates.
    #[error("found tangents without texture coordinates, expected a texture mapping beside them")]
    TangentsWithoutTexture,
    /// A coordinate does not fit the single precision that the format stores.
    #[error("coordinate {value} of vertex {vertex} is beyond single precision, which the format stores")]
    CoordinateRange {
        /// Index of the vertex in the mesh.
        vertex: usize,
        /// The coordinate after scaling or shifting.
        value: f64,
    },
    /// The file would be larger than its own length fields can say.
    #[error("the mesh is too large for the format: {what}")]
    TooLarge {
        /// Which count overflows.
        what: String,
    },
    /// An option needs a library that this build leaves out.
    #[error("{what} is not in this build, expected one with the feature `{feature}`")]
    MissingFeature {
        /// What was asked for.
        what: &'static str,
        /// The feature of the crate that has it.
        feature: &'static str,
    },
    /// A library below failed to serialise; never expected.
    #[error("cannot encode {format}: {message}")]
    Encode {
        /// The format that was being written.
        format: &'static str,
        /// What the library said.
        message: String,
    },
    /// The format has no place for pieces that are open.
    #[error("no .{extension} file is written in pieces, expected .glb, .gltf, .obj, .stl or .ply")]
    NotInPieces {
        /// The file name ending of the format, without the dot.
        extension: &'static str,
    },
    /// A piece of a mesh cannot be read.
    #[error("cannot read piece {piece} (counted from 0): {source}")]
    ReadPiece {
        /// Its number, from 0.
        piece: usize,
        /// The reason.
        source: io::Error,
    },
    /// A piece of a mesh is not what it was when it was read before.
    #[error("piece {piece} (counted from 0) has changed while the file was written, expected the same mesh each time")]
    ChangedPiece {
        /// Its number, from 0.
        piece: usize,
    },
    /// What is written to takes no more.
    #[error("cannot write: {0}")]
    Io(#[from] io::Error),
    /// The file system refused.
    #[error("cannot write {}: {source}", .path.display())]
    Write {
        /// The file that was to be written.
        path: PathBuf,
        /// The reason.
        source: io::Error,
    },
}
