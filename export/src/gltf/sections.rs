//! The binary buffer: arrays of one kind after another, each with those of all meshes.

use std::io::{self, BufWriter, Write};

use super::geometry::Geometry;
use crate::material::material_color;

/// The largest vertex number that 16-bit indices can name: 65535 is reserved by glTF for primitive restart.
const MAX_SHORT_INDEX: usize = 65_534;

/// Bytes that are handed on at a time.
const BUFFER: usize = 1 << 16;

/// Width of stored indices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Width {
    U16,
    U32,
}

impl Width {
    /// The narrowest width that can name `count` things.
    fn for_count(count: usize) -> Self {
        if count <= MAX_SHORT_INDEX + 1 { Self::U16 } else { Self::U32 }
    }

    /// Bytes of one index.
    pub(super) fn bytes(self) -> usize {
        match self {
            Self::U16 => 2,
            Self::U32 => 4,
        }
    }

    fn write(self, index: u32, out: &mut impl Write) -> io::Result<()> {
        // little-endian: the low bytes come first
        out.write_all(&index.to_le_bytes()[..self.bytes()])
    }
}

/// What an array holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// `VEC3`, single precision or, on a grid, 16 bits.
    Positions,
    /// `VEC3`, single precision or 8 bits.
    Normals,
    /// `VEC4`, single precision or 8 bits.
    Tangents,
    /// `VEC2`, single precision.
    Texture,
    /// `VEC4`, 16 or 8 bits.
    Colors,
    /// Corners of triangles; of meshes that need this width.
    Indices(Width),
    /// Places of corners that another vertex stands for; of meshes whose places need this width.
    MergePlaces(Width),
    /// The vertices that stand for them; of meshes whose indices need this width.
    MergeVertices(Width),
}

impl Kind {
    /// All, in the order of the file: vertex attributes, then the others.
    pub(super) const ALL: [Self; 11] = [
        Self::Positions,
        Self::Normals,
        Self::Tangents,
        Self::Texture,
        Self::Colors,
        Self::Indices(Width::U16),
        Self::Indices(Width::U32),
        Self::MergePlaces(Width::U16),
        Self::MergePlaces(Width::U32),
        Self::MergeVertices(Width::U16),
        Self::MergeVertices(Width::U32),
    ];

    /// Whether it has one element for each vertex.
    pub(super) fn is_attribute(self) -> bool {
        matches!(self, Self::Positions | Self::Normals | Self::Tangents | Self::Texture | Self::Colors)
    }

    /// The corners of a mesh.
    pub(super) fn indices(mesh: &Geometry) -> Self {
        Self::Indices(Width::for_count(mesh.vertices.origins.len()))
    }

    /// The places of a mesh's corners.
    pub(super) fn merge_places(mesh: &Geometry) -> Self {
        Self::MergePlaces(Width::for_count(mesh.vertices.corners.len()))
    }

    /// The vertices of a mesh that stand for others: as wide as its corners, as glTF wants both.
    pub(super) fn merge_vertices(mesh: &Geometry) -> Self {
        Self::MergeVertices(Width::for_count(mesh.vertices.origins.len()))
    }
}

/// The arrays of one kind, one mesh after another.
#[derive(Debug)]
pub(super) struct Section {
    pub(super) kind: Kind,
    /// Bytes from one element to the next.
    pub(super) stride: usize,
    /// Where the array of each mesh begins, in elements, and where the last one ends.
    pub(super) starts: Vec<usize>,
    is_quantized: bool,
}

impl Section {
    /// The sections of some meshes that are not empty.
    pub(super) fn of(meshes: &[Geometry], is_quantized: bool) -> Vec<Self> {
        Kind::ALL.into_iter().filter_map(|kind| Self::of_kind(kind, meshes, is_quantized)).collect()
    }

    /// The arrays of one kind; `None` where no mesh has any.
    pub(super) fn of_kind(kind: Kind, meshes: &[Geometry], is_quantized: bool) -> Option<Self> {
        let mut starts = vec![0];
        let mut end = 0;
        for mesh in meshes {
            end += count(kind, mesh);
            starts.push(end);
        }
        let stride = match (kind, is_quantized) {
            (Kind::Positions, true) => 8,
            (Kind::Positions | Kind::Normals, false) => 12,
            (Kind::Normals | Kind::Tangents | Kind::Colors, true) => 4,
            (Kind::Tangents, false) => 16,
            (Kind::Texture, _) | (Kind::Colors, false) => 8,
            (Kind::Indices(width) | Kind::MergePlaces(width) | Kind::MergeVertices(width), _) => width.bytes(),
        };
        (end > 0).then_some(Self { kind, stride, starts, is_quantized })
    }

    /// How many elements there are.
    pub(super) fn count(&self) -> usize {
        self.starts.last().copied().unwrap_or(0)
    }

    /// How long it is.
    pub(super) fn bytes(&self) -> usize {
        self.stride * self.count()
    }

    /// Writes the arrays of all meshes.
    pub(super) fn write(&self, meshes: &[Geometry], out: &mut dyn Write) -> io::Result<()> {
        // a call across `dyn` for each number takes longer than all else
        let mut out = BufWriter::with_capacity(BUFFER, out);
        self.write_meshes(meshes, &mut out)?;
        out.flush()
    }

    fn write_meshes(&self, meshes: &[Geometry], out: &mut impl Write) -> io::Result<()> {
        meshes.iter().filter(|mesh| count(self.kind, mesh) > 0).try_for_each(|mesh| self.write_mesh(mesh, out))
    }

    fn write_mesh(&self, mesh: &Geometry, out: &mut impl Write) -> io::Result<()> {
        let vertices = &mesh.vertices;
        match self.kind {
            Kind::Positions => match mesh.rounding.step {
                Some(step) => (0..vertices.origins.len()).try_for_each(|vertex| {
                    let [x, y, z] = mesh.grid_position(vertex, step);
                    // what an element lacks to four bytes is zero
                    [x, y, z, 0].iter().try_for_each(|value| out.write_all(&value.to_le_bytes()))
                }),
                None => (0..vertices.origins.len()).try_for_each(|vertex| write_floats(&mesh.position(vertex), out)),
            },
            Kind::Normals => vertices.normals.iter().try_for_each(|[x, y, z]| match self.is_quantized {
                true => out.write_all(&[*x, *y, *z, 0.0].map(signed_byte)),
                false => write_floats(&[*x, *y, *z], out),
            }),
            Kind::Tangents => mesh.tangents.iter().try_for_each(|tangent| match self.is_quantized {
                true => out.write_all(&tangent.map(signed_byte)),
                false => write_floats(tangent, out),
            }),
            Kind::Texture => vertices.texture.iter().try_for_each(|texture| write_floats(texture, out)),
            Kind::Colors => vertices.materials.iter().try_for_each(|material| {
                let [r, g, b] = material_color(&mesh.mesh.materials[*material as usize]);
                let color = [r, g, b, 1.0];
                match self.is_quantized {
                    true => out.write_all(&color.map(|share| (share * f32::from(u8::MAX)).round() as u8)),
                    false => color.iter().try_for_each(|share| {
                        out.write_all(&((share * f32::from(u16::MAX)).round() as u16).to_le_bytes())
                    }),
                }
            }),
            Kind::Indices(width) => vertices.corners.iter().try_for_each(|corner| width.write(*corner, out)),
            Kind::MergePlaces(width) => mesh.merges().try_for_each(|(place, _)| width.write(place, out)),
            Kind::MergeVertices(width) => mesh.merges().try_for_each(|(_, vertex)| width.write(vertex, out)),
        }
    }

    /// The numbers of a section of indices, those of all meshes.
    #[cfg(feature = "meshopt")]
    pub(super) fn numbers(&self, meshes: &[Geometry]) -> Vec<u32> {
        let mesh = |mesh: &Geometry| -> Vec<u32> {
            match self.kind {
                kind if count(kind, mesh) == 0 => Vec::new(),
                Kind::Indices(_) => mesh.vertices.corners.clone(),
                Kind::MergePlaces(_) => mesh.merges().map(|(place, _)| place).collect(),
                Kind::MergeVertices(_) => mesh.merges().map(|(_, vertex)| vertex).collect(),
                _ => Vec::new(),
            }
        };
        meshes.iter().flat_map(mesh).collect()
    }
}

/// How many elements of a kind a mesh has.
fn count(kind: Kind, mesh: &Geometry) -> usize {
    match kind {
        Kind::Positions => mesh.vertices.origins.len(),
        Kind::Normals => mesh.vertices.normals.len(),
        Kind::Tangents => mesh.tangents.len(),
        Kind::Texture => mesh.vertices.texture.len(),
        Kind::Colors => mesh.vertices.materials.len(),
        Kind::Indices(_) if kind == Kind::indices(mesh) => mesh.vertices.corners.len(),
        Kind::MergePlaces(_) if kind == Kind::merge_places(mesh) => mesh.merge_count().unwrap_or(0),
        Kind::MergeVertices(_) if kind == Kind::merge_vertices(mesh) => mesh.merge_count().unwrap_or(0),
        Kind::Indices(_) | Kind::MergePlaces(_) | Kind::MergeVertices(_) => 0,
    }
}

fn write_floats(values: &[f32], out: &mut impl Write) -> io::Result<()> {
    values.iter().try_for_each(|value| out.write_all(&value.to_le_bytes()))
}

/// From -1 to 1 in a byte, as glTF reads it.
fn signed_byte(value: f32) -> u8 {
    ((value * f32::from(i8::MAX)).round() as i8).to_le_bytes()[0]
}
