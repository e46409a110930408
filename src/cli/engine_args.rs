//! The options for physics engines. The doc comments here are the help texts.

use clap::{Args, ValueEnum};
use planecut::export::{Engine, EngineLimits};

/// What colliders are for.
#[derive(Debug, Clone, Copy, Args)]
#[command(next_help_heading = "Physics engines")]
pub(crate) struct EngineArgs {
    /// Caps, rounding to single precision and names that this engine wants; --max-faces, --max-vertices and --name take precedence
    #[arg(long, value_enum, value_name = "ENGINE", conflicts_with = "inner")]
    engine: Option<EngineName>,
    /// Density in kilograms per cubic metre, for mass and inertia in .xml, .urdf and .usda; lengths are metres unless --unit says otherwise
    #[arg(long, value_name = "D", default_value_t = 1000.0, value_parser = parse_density)]
    pub(crate) density: f64,
}

/// An engine by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum EngineName {
    /// MuJoCo: no caps
    Mujoco,
    /// PhysX: 64 faces and vertices, as graphics cards collide; 255 elsewhere
    Physx,
    /// Bullet, PyBullet: 100 vertices
    Bullet,
    /// Jolt: 256 vertices
    Jolt,
    /// Rapier, Parry: no caps
    Rapier,
    /// Godot: 256 vertices, nodes cell0-convcolonly, …
    Godot,
    /// Unity: 129 vertices, at most 254 triangles
    Unity,
    /// Unreal: no caps, nodes UCX_part_0, …
    Unreal,
}

impl EngineName {
    fn engine(self) -> Engine {
        match self {
            Self::Mujoco => Engine::Mujoco,
            Self::Physx => Engine::Physx,
            Self::Bullet => Engine::Bullet,
            Self::Jolt => Engine::Jolt,
            Self::Rapier => Engine::Rapier,
            Self::Godot => Engine::Godot,
            Self::Unity => Engine::Unity,
            Self::Unreal => Engine::Unreal,
        }
    }
}

impl EngineArgs {
    /// The engine, where one is named.
    pub(crate) fn engine(&self) -> Option<Engine> {
        self.engine.map(EngineName::engine)
    }

    /// What it accepts.
    pub(crate) fn limits(&self) -> Option<EngineLimits> {
        self.engine().map(Engine::limits)
    }
}

fn parse_density(text: &str) -> Result<f64, String> {
    let density = text.parse().ok().filter(|density| (1e-12..=1e12).contains(density));
    density.ok_or_else(|| "expected a number between 1e-12 and 1e12".to_owned())
}
