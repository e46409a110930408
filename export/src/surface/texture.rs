//! Texture coordinates by projection.

use glam::{DVec2, DVec3};
use planecut_csg::{FaceSource, Mesh, TextureAxes, TextureUnit};

use crate::part::{Projection, TextureMapping};

/// Faces whose normals are as near to z as to another axis, but for rounding, are floors and ceilings.
const AXIS_TIE: f64 = 1e-9;

/// How textures lie on the faces of a mesh.
#[derive(Debug, Clone, Copy)]
pub(super) struct Texture<'a> {
    mapping: TextureMapping,
    sources: &'a [FaceSource],
}

impl<'a> Texture<'a> {
    pub(super) fn new(mapping: TextureMapping, sources: &'a [FaceSource]) -> Self {
        Self { mapping, sources }
    }

    /// The coordinates at a point of a face: `u` to the right of the picture, `v` down, from 0 to 1 across it once.
    pub(super) fn at(&self, mesh: &Mesh, face: u32, point: DVec3) -> DVec2 {
        let axes = self.axes(mesh, face);
        match axes.unit {
            TextureUnit::Texels => axes.at(point) / self.mapping.size,
            TextureUnit::Pictures => axes.at(point),
        }
    }

    /// Whether some texture goes on from triangle to triangle.
    pub(super) fn is_continued_somewhere(&self) -> bool {
        let is_anchored = |source: &FaceSource| source.texture.is_some_and(|axes| axes.anchor.is_some());
        self.mapping.projection == Projection::Source && self.sources.iter().any(is_anchored)
    }

    /// Whether the texture of a face goes on in others: then a vertex is split where coordinates differ, not wherever textures do.
    pub(super) fn is_continued(&self, mesh: &Mesh, face: u32) -> bool {
        self.mapping.projection == Projection::Source
            && self.source(mesh, face).is_some_and(|axes| axes.anchor.is_some())
    }

    /// A number that is the same for faces on which textures lie alike.
    pub(super) fn chart(&self, mesh: &Mesh, face: u32) -> u32 {
        let sides = Side::COUNT;
        let side = || Side::of(mesh.faces[face as usize].normal).number();
        match self.mapping.projection {
            Projection::Planar => 0,
            Projection::Box => side(),
            Projection::Source if self.source(mesh, face).is_none() => side(),
            Projection::Source => sides + mesh.faces[face as usize].material.0,
        }
    }

    fn axes(&self, mesh: &Mesh, face: u32) -> TextureAxes {
        match self.mapping.projection {
            Projection::Planar => Side::Up.axes(),
            Projection::Box => Side::of(mesh.faces[face as usize].normal).axes(),
            Projection::Source => {
                let side = || Side::of(mesh.faces[face as usize].normal).axes();
                self.source(mesh, face).unwrap_or_else(side)
            }
        }
    }

    fn source(&self, mesh: &Mesh, face: u32) -> Option<TextureAxes> {
        self.sources.get(mesh.faces[face as usize].material.0 as usize)?.texture
    }
}

/// A side of a box.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    East,
    West,
    North,
    South,
    Up,
    Down,
}

impl Side {
    const COUNT: u32 = 6;

    /// The side that a normal is nearest to.
    fn of(normal: DVec3) -> Self {
        let DVec3 { x, y, z } = normal.normalize();
        if z.abs() >= x.abs().max(y.abs()) - AXIS_TIE {
            return if z > 0.0 { Self::Up } else { Self::Down };
        }
        match (x.abs() >= y.abs(), x > 0.0, y > 0.0) {
            (true, true, _) => Self::East,
            (true, false, _) => Self::West,
            (false, _, true) => Self::North,
            (false, _, false) => Self::South,
        }
    }

    fn number(self) -> u32 {
        self as u32
    }

    /// To the right and down as seen from outside, upright on walls.
    fn axes(self) -> TextureAxes {
        let (u, v) = match self {
            Self::East => (DVec3::Y, -DVec3::Z),
            Self::West => (-DVec3::Y, -DVec3::Z),
            Self::North => (-DVec3::X, -DVec3::Z),
            Self::South => (DVec3::X, -DVec3::Z),
            Self::Up => (DVec3::X, -DVec3::Y),
            Self::Down => (DVec3::X, DVec3::Y),
        };
        TextureAxes { u, v, offset: DVec2::ZERO, unit: TextureUnit::Texels, anchor: None }
    }
}
