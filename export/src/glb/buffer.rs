//! The binary buffer: five arrays, each shared by all meshes of the file.

use super::geometry::Geometry;

/// The largest vertex number that 16-bit indices can name: 65535 is reserved by glTF for primitive restart.
const MAX_SHORT_INDEX: usize = 65_534;

/// Width of stored indices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum IndexWidth {
    U16,
    U32,
}

impl IndexWidth {
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

    fn push(self, bytes: &mut Vec<u8>, index: u32) {
        let all = index.to_le_bytes();
        // Little-endian: the low bytes come first.
        bytes.extend_from_slice(&all[..self.bytes()]);
    }
}

/// Byte offsets of one mesh's arrays within the sections of the same names.
pub(super) struct Offsets {
    pub(super) positions: usize,
    pub(super) normals: usize,
    pub(super) indices: usize,
    pub(super) merge_places: usize,
    pub(super) merge_vertices: usize,
}

/// The sections of the buffer, in file order.
pub(super) struct Sections {
    pub(super) positions: Vec<u8>,
    pub(super) normals: Vec<u8>,
    pub(super) indices: Vec<u8>,
    pub(super) merge_places: Vec<u8>,
    pub(super) merge_vertices: Vec<u8>,
    /// Width of `indices` and `merge_vertices`: glTF wants both alike.
    pub(super) vertex_width: IndexWidth,
    /// Width of `merge_places`.
    pub(super) place_width: IndexWidth,
}

impl Sections {
    /// Empty sections with indices wide enough for the largest of `meshes`.
    pub(super) fn for_meshes(meshes: &[Geometry]) -> Self {
        let largest = |size: fn(&Geometry) -> usize| meshes.iter().map(size).max().unwrap_or(0);
        Self {
            positions: Vec::new(),
            normals: Vec::new(),
            indices: Vec::new(),
            merge_places: Vec::new(),
            merge_vertices: Vec::new(),
            vertex_width: IndexWidth::for_count(largest(|mesh| mesh.positions.len())),
            place_width: IndexWidth::for_count(largest(|mesh| mesh.indices.len())),
        }
    }

    /// Appends the arrays of one mesh.
    pub(super) fn push(&mut self, mesh: &Geometry) -> Offsets {
        let offsets = Offsets {
            positions: self.positions.len(),
            normals: self.normals.len(),
            indices: self.indices.len(),
            merge_places: self.merge_places.len(),
            merge_vertices: self.merge_vertices.len(),
        };
        push_vectors(&mut self.positions, &mesh.positions);
        push_vectors(&mut self.normals, &mesh.normals);
        for &index in &mesh.indices {
            self.vertex_width.push(&mut self.indices, index);
        }
        for &(place, vertex) in mesh.merges.iter().flatten() {
            self.place_width.push(&mut self.merge_places, place);
            self.vertex_width.push(&mut self.merge_vertices, vertex);
        }
        offsets
    }
}

fn push_vectors(bytes: &mut Vec<u8>, vectors: &[[f32; 3]]) {
    bytes.reserve(12 * vectors.len());
    for value in vectors.iter().flatten() {
        bytes.extend_from_slice(&value.to_le_bytes());
    }
}
