//! What physics engines and the editors around them accept of convex colliders, as far as they say so.

use crate::error::ExportError;

/// A physics engine, or a game engine with one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Engine {
    /// MuJoCo.
    Mujoco,
    /// PhysX, on processors and graphics cards; Isaac Sim.
    Physx,
    /// Bullet and PyBullet.
    Bullet,
    /// Jolt Physics.
    Jolt,
    /// Rapier, and its collision detection Parry.
    Rapier,
    /// Godot 4, with Godot Physics or Jolt.
    Godot,
    /// Unity, with PhysX.
    Unity,
    /// Unreal Engine, with Chaos.
    Unreal,
}

/// Limits on a convex collider, and how it is to be written. Sources stand in `docs/engines.md`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EngineLimits {
    /// Maximum number of faces, coplanar triangles being one; `None` where none is documented, or it follows from that of vertices.
    pub max_faces: Option<usize>,
    /// Maximum number of vertices; `None` where none is documented.
    pub max_vertices: Option<usize>,
    /// What its importer wants a collider to be called, `{}` standing for its number and `{stem}` for the name of the file without its ending.
    pub name: Option<&'static str>,
}

impl Engine {
    /// All engines, in the order in which they are documented.
    pub const ALL: [Self; 8] =
        [Self::Mujoco, Self::Physx, Self::Bullet, Self::Jolt, Self::Rapier, Self::Godot, Self::Unity, Self::Unreal];

    /// Its name in lower case.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Mujoco => "mujoco",
            Self::Physx => "physx",
            Self::Bullet => "bullet",
            Self::Jolt => "jolt",
            Self::Rapier => "rapier",
            Self::Godot => "godot",
            Self::Unity => "unity",
            Self::Unreal => "unreal",
        }
    }

    /// The engine of a name.
    ///
    /// # Errors
    /// [`ExportError::UnknownEngine`].
    pub fn from_name(name: &str) -> Result<Self, ExportError> {
        let known = Self::ALL.into_iter().find(|engine| engine.name() == name);
        let expected = || Self::ALL.map(Self::name).join(", ");
        known.ok_or_else(|| ExportError::UnknownEngine { name: name.to_owned(), expected: expected() })
    }

    /// What it accepts. All of them hold vertices in single precision as they are usually built.
    #[must_use]
    pub fn limits(self) -> EngineLimits {
        let none = EngineLimits { max_faces: None, max_vertices: None, name: None };
        match self {
            Self::Mujoco | Self::Rapier => none,
            // of hulls that graphics cards collide; 255 of both elsewhere
            Self::Physx => EngineLimits { max_faces: Some(64), max_vertices: Some(64), ..none },
            Self::Bullet => EngineLimits { max_vertices: Some(100), ..none },
            Self::Jolt => EngineLimits { max_vertices: Some(256), ..none },
            Self::Godot => EngineLimits { max_vertices: Some(256), name: Some("cell{}-convcolonly"), ..none },
            // 255 triangles: a hull of v vertices has 2·v − 4 at most
            Self::Unity => EngineLimits { max_vertices: Some(129), ..none },
            Self::Unreal => EngineLimits { name: Some("UCX_{stem}_{}"), ..none },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_of_unity_follow_from_vertices() {
        let most = Engine::Unity.limits().max_vertices.expect("a limit");
        assert!(2 * most - 4 <= 255 && 2 * (most + 1) - 4 > 255);
    }

    #[test]
    fn names_are_distinct() {
        let names = std::collections::BTreeSet::from(Engine::ALL.map(Engine::name));
        assert_eq!(names.len(), Engine::ALL.len());
    }
}
