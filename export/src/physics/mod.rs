//! Rigid bodies for physics engines: a mesh to see, convex colliders, and mass.
//!
//! - [`mass`] and [`principal`]: mass, centre of mass and inertia.
//! - [`cuboid`]: colliders that are boxes.
//! - [`files`]: the formats, and which files each has.
//! - [`mjcf`], [`urdf`], [`usda`]: the documents; [`mesh_file`]: the meshes beside them; [`names`] that these accept.
//! - [`engine`]: what engines accept.

mod cuboid;
mod engine;
mod files;
mod mass;
mod mesh_file;
mod mjcf;
mod names;
mod principal;
mod urdf;
mod usda;

use planecut_csg::Mesh;

pub use cuboid::Cuboid;
pub use engine::{Engine, EngineLimits};
pub use files::{PhysicsFile, PhysicsFormat, physics_files};
pub use mass::{MassProperties, PrincipalInertia};

use crate::material_color;

/// One rigid body. All lengths are in metres, and z is up.
#[derive(Debug, Clone)]
pub struct RigidBody<'a> {
    /// Any text; files hold what their format has a place for.
    pub name: &'a str,
    /// The visual mesh; it need not be closed, and may be empty.
    pub visual: &'a Mesh,
    /// Convex bodies, each in coordinates of the whole.
    pub colliders: &'a [Collider<'a>],
    /// Mass and its distribution.
    pub mass: MassProperties,
}

/// A convex part of a rigid body.
#[derive(Debug, Clone)]
pub struct Collider<'a> {
    /// Any text; names that are equal are numbered in files.
    pub name: &'a str,
    /// A closed, convex mesh.
    pub mesh: &'a Mesh,
    /// The same as a box, where it is one: this is what is written then ([`Cuboid::of_mesh`]).
    pub cuboid: Option<Cuboid>,
}

impl<'a> Collider<'a> {
    /// A collider that is written as a box where its mesh is one.
    #[must_use]
    pub fn new(name: &'a str, mesh: &'a Mesh) -> Self {
        Self { name, mesh, cuboid: Cuboid::of_mesh(mesh) }
    }
}

/// The colour of most triangles of a mesh, linear RGB.
fn main_color(mesh: &Mesh) -> Option<[f32; 3]> {
    let mut counts = vec![0_usize; mesh.materials.len()];
    for face in &mesh.triangle_faces {
        counts[mesh.faces[*face as usize].material.0 as usize] += 1;
    }
    let most = (0..counts.len()).rev().max_by_key(|material| counts[*material])?;
    (counts[most] > 0).then(|| material_color(&mesh.materials[most]))
}
