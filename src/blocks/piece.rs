//! The piece of a mesh that a block gives, as bytes.

use std::io::{self, Read};

use planecut_csg::stages::CompensatedSum;
use planecut_csg::{Block, BlockPlace, Material, MaterialId, Mesh, MeshFace, SeamEdge, SeamEdges, SolidMeasures};
use planecut_kernel::DVec3;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::bytes::{self, Bytes};

/// What a piece begins with.
const MAGIC: &[u8; 8] = b"pcpiece\x01";

/// What is to be known of a piece without its mesh.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct PieceHeader {
    /// The version of planecut, and SHA-256 of the bytes of the block.
    pub(super) key: String,
    pub(super) place: BlockPlace,
    pub(super) min: DVec3,
    pub(super) max: DVec3,
    pub(super) solid: SolidMeasures,
    pub(super) vertices: u64,
    pub(super) triangles: u64,
    pub(super) faces: u64,
    pub(super) materials: Vec<Material>,
    /// What the triangles enclose with the lesser corner of the box, and the sum of their area vectors.
    pub(super) mesh_volume: f64,
    pub(super) mesh_area: DVec3,
    /// Number of edges contracted or gaps closed as rounding noise, and the largest distance by which a vertex moved in that.
    pub(super) noise: (u64, f64),
    /// All signs that were asked for, those that took integers, and those that took big ones.
    pub(super) signs: [u64; 3],
    pub(super) seams: [SeamDigest; 6],
    /// The edges on lines in which walls cross.
    pub(super) crossings: Vec<SeamEdge>,
    /// SHA-256 of the mesh and the seams that follow.
    contents: String,
}

impl PieceHeader {
    /// Whether what follows the header is what it was.
    fn is_followed_by(&self, contents: &mut impl Read) -> bool {
        let mut hash = Sha256::new();
        let mut buffer = [0; 1 << 16];
        loop {
            match contents.read(&mut buffer) {
                Ok(0) => return hexadecimal(&hash.finalize()) == self.contents,
                Ok(length) => hash.update(&buffer[..length]),
                Err(_) => return false,
            }
        }
    }
}

/// The edges on a side of a block: equal for neighbours that fit together, and for no others.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct SeamDigest {
    pub(super) edges: u64,
    /// SHA-256 of their coordinates.
    sha256: String,
}

impl SeamDigest {
    fn of(edges: &[SeamEdge]) -> Self {
        let mut hash = Sha256::new();
        for value in edges.iter().flatten().flat_map(|point| (*point + 0.0).to_array()) {
            hash.update(value.to_le_bytes());
        }
        Self { edges: edges.len() as u64, sha256: hexadecimal(&hash.finalize()) }
    }

    /// That of a side without a neighbour.
    pub(super) fn none() -> Self {
        Self::of(&[])
    }
}

/// The key of the piece of a block.
pub(super) fn key_of(block: &[u8]) -> String {
    format!("{} {}", env!("CARGO_PKG_VERSION"), hexadecimal(&Sha256::digest(block)))
}

/// Whether what is read is the piece of a block, all of it.
pub(super) fn is_piece_of(from: &mut impl Read, block: &[u8]) -> bool {
    header(from).is_ok_and(|header| header.key == key_of(block) && header.is_followed_by(from))
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// A block as bytes.
pub(super) fn encode(block: &Block, place: BlockPlace, key: String) -> io::Result<Vec<u8>> {
    let mesh = &block.mesh;
    let mut contents = Bytes(Vec::with_capacity(24 * mesh.positions.len() + 16 * mesh.triangles.len()));
    mesh.positions.iter().for_each(|position| contents.point(*position));
    mesh.triangles.iter().flatten().for_each(|vertex| contents.u32(*vertex));
    mesh.triangle_faces.iter().for_each(|face| contents.u32(*face));
    for face in &mesh.faces {
        contents.point(face.normal);
        contents.u32(face.material.0);
    }
    block.seams.sides.iter().flatten().flatten().for_each(|point| contents.point(*point));
    let [mesh_volume, x, y, z] = enclosed(mesh, block.min);
    let header = PieceHeader {
        key,
        place,
        min: block.min,
        max: block.max,
        solid: block.solid,
        vertices: mesh.positions.len() as u64,
        triangles: mesh.triangles.len() as u64,
        faces: mesh.faces.len() as u64,
        materials: mesh.materials.clone(),
        mesh_volume,
        mesh_area: DVec3::new(x, y, z),
        noise: (block.noise.collapsed as u64, block.noise.thickest),
        signs: [block.signs.total, block.signs.small_int, block.signs.big],
        seams: std::array::from_fn(|side| SeamDigest::of(&block.seams.sides[side])),
        crossings: block.seams.crossings.clone(),
        contents: hexadecimal(&Sha256::digest(&contents.0)),
    };
    let mut to = Bytes::default();
    to.0.extend(MAGIC);
    to.text(&serde_json::to_vec(&header)?);
    to.0.append(&mut contents.0);
    Ok(to.0)
}

/// The volume of the cones from a point to the triangles of a mesh, and the sum of their area vectors.
fn enclosed(mesh: &Mesh, from: DVec3) -> [f64; 4] {
    let mut sums: [CompensatedSum; 4] = Default::default();
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|vertex| mesh.positions[vertex as usize] - from);
        let area = 0.5 * (b - a).cross(c - a);
        sums[0].add(a.dot(area) / 3.0);
        sums[1..].iter_mut().zip(area.to_array()).for_each(|(sum, value)| sum.add(value));
    }
    sums.map(|sum| sum.value())
}

/// Reads the header of a piece.
pub(super) fn header(from: &mut impl Read) -> io::Result<PieceHeader> {
    let mut magic = [0; MAGIC.len()];
    from.read_exact(&mut magic)?;
    if magic != *MAGIC {
        return Err(bytes::damaged());
    }
    Ok(serde_json::from_slice(&bytes::text(from)?)?)
}

/// Reads the mesh and the seams that follow a header.
pub(super) fn contents(header: &PieceHeader, from: &mut impl Read) -> io::Result<(Mesh, SeamEdges)> {
    let triple = |from: &mut _| Ok::<[u32; 3], io::Error>([bytes::u32(from)?, bytes::u32(from)?, bytes::u32(from)?]);
    let mut mesh = Mesh { materials: header.materials.clone(), ..Mesh::default() };
    mesh.positions = read_all(header.vertices, || bytes::point(from))?;
    mesh.triangles = read_all(header.triangles, || triple(from))?;
    mesh.triangle_faces = read_all(header.triangles, || bytes::u32(from))?;
    let mut face = || Ok(MeshFace { normal: bytes::point(from)?, material: MaterialId(bytes::u32(from)?) });
    mesh.faces = read_all(header.faces, &mut face)?;
    let mut seams = SeamEdges { crossings: header.crossings.clone(), ..SeamEdges::default() };
    for (edges, digest) in seams.sides.iter_mut().zip(&header.seams) {
        *edges = read_all(digest.edges, || Ok([bytes::point(from)?, bytes::point(from)?]))?;
    }
    let is_right = mesh.triangles.iter().flatten().all(|vertex| (*vertex as usize) < mesh.positions.len())
        && mesh.triangle_faces.iter().all(|face| (*face as usize) < mesh.faces.len())
        && mesh.faces.iter().all(|face| (face.material.0 as usize) < mesh.materials.len());
    if is_right { Ok((mesh, seams)) } else { Err(bytes::damaged()) }
}

/// Reads a number of things; as much memory is taken as there is to read.
fn read_all<T>(count: u64, mut read: impl FnMut() -> io::Result<T>) -> io::Result<Vec<T>> {
    (0..count).map(|_| read()).collect()
}
