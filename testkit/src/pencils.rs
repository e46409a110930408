//! Random models with many faces around one line or point: wedges, pencils of planes, cones, and grids with diagonal planes, as exclusive or.

use glam::{DQuat, DVec3};
use planecut_csg::{Brush, Mesh, Model, Tree, UnboundedBrushes, evaluate_with};

use crate::meshes::mesh_volume;
use crate::random::Rng;
use crate::scene::{brush, cuboid, ensure, half_space, model};

/// What the faces of a model have in common.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Wedges of planes through the z axis.
    Wedges,
    /// Wedges of planes through a line of any direction, and some through one beside it.
    Pencil,
    /// Cones of planes through one point.
    Cones,
    /// Planes along axes and diagonals through points of a grid.
    Diagonals,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Wedges, Self::Pencil, Self::Cones, Self::Diagonals];
}

/// A random model of a kind; without a turn its planes have small integers as coefficients.
#[must_use]
pub fn random_model(kind: Kind, turn: Option<DQuat>, rng: &mut Rng) -> Model {
    let turned = |v: DVec3| turn.map_or(v, |turn| turn * v);
    let along = match kind {
        Kind::Wedges => DVec3::Z,
        _ => DVec3::from_array(rng.lattice(2)),
    };
    let places = [DVec3::from_array(rng.lattice(1)), DVec3::from_array(rng.lattice(2))];
    let body = |rng: &mut Rng| {
        let (most, place) = match kind {
            Kind::Wedges => (3, DVec3::ZERO),
            Kind::Pencil => (3, places[usize::from(rng.chance(0.2))]),
            Kind::Cones => (4, places[0]),
            Kind::Diagonals => (5, DVec3::from_array(rng.lattice(2))),
        };
        brush((0..rng.integer(1, most)).map(|_| {
            let normal = normal(kind, along, rng);
            half_space(turned(normal), normal.dot(place))
        }))
    };
    let bodies: Vec<Brush> = (0..rng.integer(2, 6)).map(|_| body(rng)).collect();
    let mut result = model(Vec::new());
    let bounds = cuboid(DVec3::splat(-3.0), DVec3::splat(3.0));
    result.tree = Tree::intersection([Tree::xor(bodies.into_iter().map(Tree::from)), Tree::from(bounds)]);
    result
}

fn normal(kind: Kind, along: DVec3, rng: &mut Rng) -> DVec3 {
    loop {
        let mut normal = DVec3::from_array(rng.lattice(if kind == Kind::Cones { 1 } else { 2 }));
        match kind {
            Kind::Wedges | Kind::Pencil => normal = along.cross(normal),
            Kind::Cones => {}
            Kind::Diagonals => {
                normal = normal.clamp(DVec3::NEG_ONE, DVec3::ONE);
                normal[rng.below(3)] = 0.0;
            }
        }
        if normal != DVec3::ZERO {
            return normal;
        }
    }
}

/// The mesh of a model whose brushes may be unbounded.
///
/// # Errors
/// Where it cannot be evaluated, or where the mesh has another volume than the solid.
pub fn mesh_of(model: &Model) -> Result<Mesh, String> {
    let evaluation = evaluate_with(model, UnboundedBrushes::Keep).map_err(|error| error.to_string())?;
    let volume = if evaluation.mesh.positions.is_empty() { 0.0 } else { mesh_volume(&evaluation.mesh) };
    let (expected, area) = (evaluation.solid.volume, evaluation.solid.area);
    // The margin is for vertices that are rounded, and contracted where edges are noise.
    ensure!((volume - expected).abs() <= 1e-9 * (1.0 + area), "volume {volume}, of the solid {expected}");
    Ok(evaluation.mesh)
}
