//! Formats of rigid bodies, and the files that each has.

use std::io::Write;

use planecut_csg::Mesh;

use super::names::{VISUAL, collision, path_name};
use super::{RigidBody, mesh_file, mjcf, urdf, usda};
use crate::ExportError;
use crate::part::check_mesh;

/// A file format for rigid bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PhysicsFormat {
    /// MuJoCo's XML ([reference](https://mujoco.readthedocs.io/en/stable/XMLreference.html)), a model that stands by itself, with its meshes as OBJ files in a folder
    /// beside it. MuJoCo 3.3 and later.
    Mjcf,
    /// Unified Robot Description Format ([reference](https://wiki.ros.org/urdf/XML)): a robot of one link, with its meshes beside it as for MJCF, and the same ones.
    Urdf,
    /// Universal Scene Description as text, with the schemas of [UsdPhysics](https://openusd.org/release/api/usd_physics_page_front.html); one file with all meshes.
    Usda,
}

impl PhysicsFormat {
    /// All formats, in the order in which they are documented.
    pub const ALL: [Self; 3] = [Self::Mjcf, Self::Urdf, Self::Usda];

    /// The usual file name ending, without the dot.
    #[must_use]
    pub fn extension(self) -> &'static str {
        match self {
            Self::Mjcf => "xml",
            Self::Urdf => "urdf",
            Self::Usda => "usda",
        }
    }

    /// The format with this file name ending, given without the dot and in any case.
    ///
    /// # Errors
    /// [`ExportError::UnknownPhysicsFormat`] for any other ending.
    pub fn from_extension(extension: &str) -> Result<Self, ExportError> {
        Self::ALL
            .into_iter()
            .find(|format| format.extension().eq_ignore_ascii_case(extension))
            .ok_or_else(|| ExportError::UnknownPhysicsFormat { extension: extension.to_owned() })
    }

    /// Whether meshes stand in files of their own.
    #[must_use]
    pub fn has_mesh_files(self) -> bool {
        self != Self::Usda
    }
}

/// One of the files that together describe a rigid body.
#[derive(Debug)]
pub struct PhysicsFile<'a> {
    path: String,
    content: Content<'a>,
}

#[derive(Debug)]
enum Content<'a> {
    Document { body: &'a RigidBody<'a>, format: PhysicsFormat, folder: String },
    Mesh { mesh: &'a Mesh, name: String },
}

impl PhysicsFile<'_> {
    /// Where it goes: relative to the folder of the document, with `/` between folders. The document's own is empty: its name is the caller's.
    #[must_use]
    pub fn path(&self) -> &str {
        &self.path
    }

    /// Writes it.
    ///
    /// # Errors
    /// [`ExportError::Io`] where the writer takes no more; [`ExportError::CoordinateRange`] and [`ExportError::MassRange`] for a position or a mass that single precision does not hold (USD).
    pub fn write(&self, out: &mut dyn Write) -> Result<(), ExportError> {
        match &self.content {
            Content::Document { body, format: PhysicsFormat::Mjcf, folder } => Ok(mjcf::write_mjcf(body, folder, out)?),
            Content::Document { body, format: PhysicsFormat::Urdf, folder } => Ok(urdf::write_urdf(body, folder, out)?),
            Content::Document { body, format: PhysicsFormat::Usda, .. } => usda::write_usda(body, out),
            Content::Mesh { mesh, name } => Ok(mesh_file::write_mesh(mesh, name, out)?),
        }
    }
}

/// The files that describe a rigid body, the document last: who finds it finds its meshes. `stem` is the name of the document without its ending: meshes go to the folder `{stem}_meshes`,
/// as `visual.obj` and `collision_{number}.obj`, boxes left out. They are the same in all formats.
///
/// ```
/// # use planecut_csg::{Brush, Material, MaterialId, Model, evaluate};
/// # use planecut_export::{Collider, MassProperties, PhysicsFormat, RigidBody, physics_files};
/// # use planecut_kernel::DVec3;
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let tree = Brush::cuboid(DVec3::ZERO, DVec3::ONE, MaterialId(0)).into();
/// # let visual = evaluate(&Model { materials: vec![Material::named("stone")], tree })?.mesh;
/// let mass = MassProperties::of_triangles(&visual.positions, &visual.triangles, 1000.0).ok_or("no volume")?;
/// let colliders = [Collider::new("all of it", &visual)];
/// let body = RigidBody { name: "part", visual: &visual, colliders: &colliders, mass };
/// let files = physics_files(&body, PhysicsFormat::Urdf, "part")?;
/// assert_eq!(files.iter().map(|file| file.path()).collect::<Vec<_>>(), ["part_meshes/visual.obj", ""]);
/// let mut urdf = Vec::new();
/// files[1].write(&mut urdf)?;
/// assert!(String::from_utf8(urdf)?.contains("<box size=\"1 1 1\"/>"));
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// [`ExportError::InvalidMesh`] for a mesh with an index that is out of range, or a number that is not finite; [`ExportError::NoColliders`] for a body without any.
pub fn physics_files<'a>(
    body: &'a RigidBody<'a>,
    format: PhysicsFormat,
    stem: &str,
) -> Result<Vec<PhysicsFile<'a>>, ExportError> {
    if body.colliders.is_empty() {
        return Err(ExportError::NoColliders);
    }
    check_mesh(body.visual)?;
    body.colliders.iter().try_for_each(|collider| check_mesh(collider.mesh))?;
    let folder = format!("{}_meshes", path_name(stem));
    let mut files = Vec::new();
    if format.has_mesh_files() {
        let mesh = |mesh, name: String| PhysicsFile {
            path: format!("{folder}/{name}.obj"),
            content: Content::Mesh { mesh, name },
        };
        if !body.visual.triangles.is_empty() {
            files.push(mesh(body.visual, VISUAL.to_owned()));
        }
        let colliders = body.colliders.iter().enumerate().filter(|(_, collider)| collider.cuboid.is_none());
        files.extend(colliders.map(|(number, collider)| mesh(collider.mesh, collision(number))));
    }
    files.push(PhysicsFile { path: String::new(), content: Content::Document { body, format, folder } });
    Ok(files)
}
