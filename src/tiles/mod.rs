//! Tile sets of huge models: 3D Tiles 1.1, which viewers load piece by piece and in more detail the nearer they come.
//!
//! A model that was evaluated block by block is in space cut by walls that go through all of it. [`write_tiles`] makes a tree of its blocks: the leaves are the
//! blocks as they are, and a tile above them holds up to 2 × 2 × 2 tiles of the height below, as one mesh with fewer triangles.
//! The tile set is written as explicit tiles whose contents are GLBs ([`TileOptions`] says with what in them); a viewer replaces a tile by its
//! children (`refine: REPLACE`).
//!
//! # How far a tile is from the model
//!
//! `geometricError` of a tile is a proven bound of the Hausdorff distance between its surface and that of all blocks in it. Vertices of the children are
//! clustered (Rossignac and Borrel 1993), which maps each vertex `v` to a representative `φ(v)`, and every triangle to the one of its corners' representatives.
//!
//! 1. `φ` is linear on a triangle, so a point of it moves by at most the farthest that a corner moves. All points of the children's surface
//!    have an image and every point of the image has an origin, so the Hausdorff distance of both is at most `δ = max |v − φ(v)|`.
//! 2. The image consists of triangles, of segments and of points. Of equal triangles those of opposite orientation cancel, and of what cancels
//!    entirely one stays with either side, so that the set of points is the same. A segment that is an edge of a triangle that stays, and a
//!    point that is a corner of one, are part of it.
//! 3. Any other segment or point is within a closed prism or octahedron of radius `r` that replaces it: each point of one is within `r` of
//!    the other. So the distance of the image and the mesh of the tile is at most `r`.
//! 4. Positions of representatives are multiples of a power of two that files hold exactly, so that nothing is added by rounding.
//! 5. With the triangle inequality the tile is at most `δ + r` and the largest bound of its children from the model. Leaves have 0.
//!
//! # Why neighbours fit together
//!
//! The boundary of a tile's triangles as a chain lies on its walls, and it is the opposite of those of its neighbours there. An image of a chain's boundary
//! is the boundary of its image, so images fit together where both sides map the vertices of this boundary alike (`cluster` does so), whatever
//! happens within. Prisms and octahedra are closed and change nothing about it. Of this the tiles of one height are sure: they close as the model does. Where a viewer shows
//! tiles of two heights side by side, they are apart by at most the sum of their errors, which is what it takes for small.

mod bodies;
mod build;
mod cluster;
mod coarse;
mod document;
mod folder;
mod grid;
mod materials;
mod quadric;
mod surface;
#[cfg(test)]
mod tests;

use std::io;
use std::path::{Path, PathBuf};

use planecut_csg::Mesh;
use planecut_export::{ExportError, ExportOptions};
use planecut_kernel::DVec3;
use thiserror::Error;

/// One block of a model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TileLeaf {
    /// Its place in the grid of blocks along each axis.
    pub place: [u32; 3],
    /// The corner of its box of smallest coordinates, in the units of its mesh. Boxes of blocks with the same place along an axis end at the same walls.
    pub min: DVec3,
    /// The corner of largest coordinates.
    pub max: DVec3,
}

/// The blocks of a model, whose meshes are read when they are needed, each two times or more.
pub trait TileSource: Sync {
    /// The blocks, sorted by place, each place once.
    fn leaves(&self) -> &[TileLeaf];

    /// The part of the model's boundary in a block, which has a number in the list: closed but for edges on walls, where the neighbour's mesh goes on with
    /// equal positions. Each mesh may have materials of its own. It may be empty.
    ///
    /// # Errors
    /// Where it cannot be read.
    fn mesh(&self, leaf: usize) -> io::Result<Mesh>;
}

/// How a tile set is written.
#[derive(Debug, Clone, PartialEq)]
pub struct TileOptions {
    /// Tiles above the leaves have no more triangles than this, where clusters not larger than a tile suffice for that.
    pub triangles: usize,
    /// A tile set of more tiles than this is divided among several JSON files.
    pub tiles_per_file: usize,
    /// How GLBs are written. Scale and unit must give metres: they are applied to boxes and errors too.
    pub export: ExportOptions,
}

impl Default for TileOptions {
    /// 50,000 triangles, and 500 tiles in one JSON file: about a tenth of a megabyte.
    fn default() -> Self {
        Self { triangles: 50_000, tiles_per_file: 500, export: ExportOptions::default() }
    }
}

impl TileOptions {
    /// Metres that one unit of the meshes has.
    fn meters(&self) -> f64 {
        self.export.scale * self.export.unit.map_or(1.0, planecut_export::Unit::meters)
    }
}

/// What was written.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TilesSummary {
    /// Tiles of each height, leaves first; the last is the root alone.
    pub tiles: Vec<usize>,
    /// Triangles of all tiles of each height.
    pub triangles: Vec<usize>,
    /// The largest `geometricError` of each height, in metres.
    pub errors: Vec<f64>,
    /// JSON files, `tileset.json` among them.
    pub documents: usize,
    /// Bytes of all GLBs.
    pub bytes: u64,
}

/// Why no tile set was written. What was there before is as it was.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum TilesError {
    /// No block has a triangle.
    #[error("found no triangle in {blocks} blocks, expected one at least")]
    Empty {
        /// How many blocks there are.
        blocks: usize,
    },
    /// Blocks are not those of one grid.
    #[error("block {}: {what}", show(.place))]
    Grid {
        /// The place of the block.
        place: [u32; 3],
        /// What is wrong with it.
        what: &'static str,
    },
    /// A mesh was not read.
    #[error("block {}: {source}", show(.place))]
    Source {
        /// The place of the block.
        place: [u32; 3],
        /// The reason.
        source: io::Error,
    },
    /// A mesh does not fit the format.
    #[error(transparent)]
    Export(#[from] ExportError),
    /// There is something else where the tile set is to be.
    #[error("found {} which is no tile set of planecut, expected a new name: nothing is overwritten", .path.display())]
    Occupied {
        /// What is there.
        path: PathBuf,
    },
    /// The file system refused.
    #[error("cannot write {}: {source}", .path.display())]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// The reason.
        source: io::Error,
    },
}

fn show([x, y, z]: &[u32; 3]) -> String {
    format!("({x}, {y}, {z})")
}

/// Writes blocks as a tile set: `tileset.json` in a folder, and beside it `tiles/HEIGHT/X-Y-Z.glb`. A tile set that planecut wrote before is replaced once the
/// new one is complete. The bytes depend on the blocks and options alone.
///
/// At one time the meshes of as many blocks are in memory as there are threads, or the children of some tiles, with 1,000,000 triangles together where these are not those
/// of one tile. Other meshes lie in temporary files beside the folder.
///
/// ```
/// use planecut::csg::{BlockOptions, Brush, Material, MaterialId, Mesh, Model, Tree, evaluate_in_blocks};
/// use planecut::kernel::DVec3;
/// use planecut::tiles::{TileLeaf, TileOptions, TileSource, write_tiles};
///
/// struct Blocks(Vec<TileLeaf>, Vec<Mesh>);
///
/// impl TileSource for Blocks {
///     fn leaves(&self) -> &[TileLeaf] {
///         &self.0
///     }
///
///     fn mesh(&self, leaf: usize) -> std::io::Result<Mesh> {
///         Ok(self.1[leaf].clone())
///     }
/// }
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let cube = |k: u32| Brush::cuboid(DVec3::X * f64::from(k), DVec3::X * f64::from(k) + 0.5, MaterialId(0));
/// let model = Model { materials: vec![Material::named("stone")], tree: Tree::union_of((0..64).map(cube).collect()) };
/// let mut blocks = Blocks(Vec::new(), Vec::new());
/// evaluate_in_blocks(&model, BlockOptions { brushes: 8 }, |block| {
///     blocks.0.push(TileLeaf { place: [blocks.0.len() as u32, 0, 0], min: block.min, max: block.max });
///     blocks.1.push(block.mesh);
///     Ok::<(), ()>(())
/// })
/// .unwrap();
/// let folder = tempfile::tempdir()?;
/// let summary = write_tiles(&blocks, &folder.path().join("cubes"), &TileOptions::default())?;
/// assert_eq!((summary.tiles[0], summary.tiles.last()), (blocks.0.len(), Some(&1)));
/// assert!(summary.triangles[0] >= 64 * 12 && summary.errors[0] == 0.0);
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// [`TilesError`]; by then temporary files are gone, and what was in the folder is as it was.
pub fn write_tiles(source: &dyn TileSource, folder: &Path, options: &TileOptions) -> Result<TilesSummary, TilesError> {
    let building = folder::Building::begin(folder)?;
    let built = build::build(source, building.path(), options)?;
    building.finish()?;
    Ok(built)
}
