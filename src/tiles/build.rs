//! Tiles from the leaves up: meshes, their errors and boxes, and files.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use planecut_csg::stages::Bounds;
use planecut_csg::{Material, Mesh};
use planecut_export::{ExportError, Format, Part, write_parts};
use planecut_kernel::DVec3;
use planecut_parallel::job;
use planecut_parallel::prelude::*;

use super::cluster::{Lattice, representatives};
use super::coarse::image;
use super::document::{Documents, Made, folder_of_height, name};
use super::grid::{Tile, Tree, Walls};
use super::materials::Materials;
use super::surface::Surface;
use super::{TileLeaf, TileOptions, TileSource, TilesError, TilesSummary};

/// Cells along a tile of the usual size, where that gives neither too many triangles nor needlessly few.
const CELLS_PER_TILE: f64 = 64.0;

/// How often one tile is simplified to find how large cells should be.
const TRIALS: usize = 3;

/// Tiles are simplified together as long as their children have no more triangles than this.
const TRIANGLES_AT_ONCE: usize = 1 << 20;

/// Blocks whose materials are in memory at once.
const LEAVES_AT_ONCE: usize = 64;

/// Where the meshes of tiles lie until their parents are made.
const MESHES: &str = "meshes";

/// Errors are larger by this part than they are worked out to be, which is more than rounding.
const ERROR_MARGIN: f64 = 1e-9;

/// The farthest that coordinates reach from the middle of a tile, in steps: what files hold in 16 bits or single precision, less what
/// middles are off.
const REACH_QUANTIZED: f64 = 32_000.0;
const REACH: f64 = (1 << 22) as f64;

/// Writes all files of a tile set into a folder.
pub(super) fn build(source: &dyn TileSource, folder: &Path, options: &TileOptions) -> Result<TilesSummary, TilesError> {
    let leaves = source.leaves();
    let walls = Walls::new(leaves)?;
    let mut builder = Builder { source, folder, options, materials: Materials::default(), walls, made: Vec::new() };
    let written = builder.write_leaves()?;
    let filled: Vec<usize> = (0..leaves.len()).filter(|leaf| written[*leaf].is_some()).collect();
    if filled.is_empty() {
        return Err(TilesError::Empty { blocks: leaves.len() });
    }
    let tree = Tree::new(leaves, &filled);
    let of_leaf = |tile: &Tile| written[tile.children.start].as_ref().map(|written| (written.made, written.bytes));
    let (made, bytes): (Vec<Made>, Vec<u64>) = tree.heights[0].iter().filter_map(of_leaf).unzip();
    builder.made.push(made);
    let mut bytes: u64 = bytes.iter().sum();
    let mut before = Lattice { cell: 0.0, step: 0.0 };
    for height in 1..tree.heights.len() {
        let lattice = builder.simplify(&tree, height, &before)?;
        bytes += builder.write_height(&tree, height)?;
        builder.walls.round(|at| lattice.rounded(at));
        before = lattice;
    }
    remove(&folder.join(MESHES))?;
    let meters = options.meters();
    let documents = Documents { tree: &tree, made: &builder.made, meters, tiles_per_file: options.tiles_per_file };
    let documents = documents.write(folder)?;
    let error = |made: &Vec<Made>| made.iter().map(|made| made.error * meters).fold(0.0, f64::max);
    Ok(TilesSummary {
        tiles: tree.heights.iter().map(Vec::len).collect(),
        triangles: builder.made.iter().map(|made| made.iter().map(|made| made.triangles).sum()).collect(),
        errors: builder.made.iter().map(error).collect(),
        documents,
        bytes,
    })
}

/// What is known while tiles are made.
struct Builder<'a> {
    source: &'a dyn TileSource,
    folder: &'a Path,
    options: &'a TileOptions,
    materials: Materials,
    /// Where walls are in the meshes of the last height that was made.
    walls: Walls,
    /// The tiles of each height.
    made: Vec<Vec<Made>>,
}

/// A leaf that was written.
struct Written {
    made: Made,
    bytes: u64,
    materials: Vec<Material>,
}

impl Builder<'_> {
    /// Writes the meshes of blocks; none for those that are empty.
    fn write_leaves(&mut self) -> Result<Vec<Option<Written>>, TilesError> {
        let leaves = self.source.leaves();
        make(&folder_of_height(self.folder, 0))?;
        let mut written = Vec::with_capacity(leaves.len());
        let numbers: Vec<usize> = (0..leaves.len()).collect();
        for some in numbers.chunks(LEAVES_AT_ONCE) {
            let write = |leaf: &usize| self.write_leaf(*leaf, &leaves[*leaf]);
            let mut some: Vec<Option<Written>> = some.par_iter().map(write).collect::<Result<_, _>>()?;
            for leaf in some.iter_mut().flatten() {
                self.materials.add(&std::mem::take(&mut leaf.materials));
            }
            written.append(&mut some);
        }
        Ok(written)
    }

    fn write_leaf(&self, number: usize, leaf: &TileLeaf) -> Result<Option<Written>, TilesError> {
        job::check();
        let mesh = self.read(number)?;
        if mesh.triangles.is_empty() {
            return Ok(None);
        }
        let path = folder_of_height(self.folder, 0).join(name(leaf.place) + ".glb");
        let bytes = self.write_glb(&path, &mesh)?;
        let all = bounds_of(mesh.positions.iter().copied());
        let corners = mesh.triangles.iter().flatten();
        let mut bounds = bounds_of(corners.map(|corner| mesh.positions[*corner as usize]));
        // twice what a position moves where it is rounded
        let part = if self.options.export.quantize { 1.0 / 16_384.0 } else { f64::from(f32::EPSILON) };
        let room = reach(&all) * part;
        (bounds.min, bounds.max) = (bounds.min - room, bounds.max + room);
        let made = Made { bounds, error: 0.0, triangles: mesh.triangles.len() };
        Ok(Some(Written { made, bytes, materials: mesh.materials }))
    }

    fn read(&self, leaf: usize) -> Result<Mesh, TilesError> {
        let failed = |source| TilesError::Source { place: self.source.leaves()[leaf].place, source };
        self.source.mesh(leaf).map_err(failed)
    }

    fn write_glb(&self, path: &Path, mesh: &Mesh) -> Result<u64, TilesError> {
        let failed = |source| TilesError::Write { path: path.to_owned(), source };
        let mut out = Counted { out: BufWriter::new(File::create(path).map_err(failed)?), bytes: 0 };
        match write_parts(&[Part::new("tile", mesh)], Format::Glb, &self.options.export, &mut out) {
            Ok(()) => out.flush().map_err(failed)?,
            Err(ExportError::Io(source)) => return Err(failed(source)),
            Err(error) => return Err(error.into()),
        }
        Ok(out.bytes)
    }

    /// Simplifies the tiles of a height, with cells as large as it takes; their meshes are left in temporary files.
    fn simplify(&mut self, tree: &Tree, height: usize, before: &Lattice) -> Result<Lattice, TilesError> {
        let tiles = &tree.heights[height];
        let below: Vec<Bounds> = tiles.iter().map(|tile| self.bounds_of_children(height, tile)).collect();
        let mut extents: Vec<f64> = below.iter().map(|bounds| (bounds.max - bounds.min).max_element()).collect();
        extents.sort_by(f64::total_cmp);
        let (usual, largest) = (extents[extents.len() / 2], extents[extents.len() - 1]);
        make(&self.mesh_folder(height))?;
        let lattice = |cell: f64| Lattice { cell, step: self.step(&below, cell).max(before.step) };
        let mut cell = self.finer(tree, height, 2.0 * before.cell, usual / CELLS_PER_TILE, &lattice)?;
        loop {
            let lattice = lattice(cell);
            match self.simplify_with(tree, height, &lattice, cell < largest)? {
                Simplified::Made(made) => {
                    self.made.push(made);
                    if height > 1 {
                        remove(&self.mesh_folder(height - 1))?;
                    }
                    return Ok(lattice);
                }
                // areas are divided into squares of the cell's size
                Simplified::TooMany(triangles) => {
                    let excess = triangles as f64 / self.options.triangles.max(1) as f64;
                    cell *= (1.1 * excess.sqrt()).clamp(1.25, 8.0);
                }
            }
        }
    }

    /// The size of cells to begin with: at least as large as one that is given, and smaller than another one where the tile with most below it
    /// would otherwise be left with much less than a quarter of that, and less than tiles may have.
    fn finer(
        &self,
        tree: &Tree,
        height: usize,
        least: f64,
        usual: f64,
        lattice: &impl Fn(f64) -> Lattice,
    ) -> Result<f64, TilesError> {
        let mut cell = usual.max(least);
        let heaviest = tree.heights[height].iter().max_by_key(|tile| self.triangles_of_children(height, tile));
        let Some(heaviest) = heaviest else { return Ok(cell) };
        let wanted = (self.triangles_of_children(height, heaviest) / 4).min(self.options.triangles) as f64;
        for _ in 0..TRIALS {
            let triangles = self.simplify_tile(tree, height, heaviest, &lattice(cell))?.triangles as f64;
            if triangles > 0.6 * wanted || cell == least {
                break;
            }
            // areas are divided into squares of the cell's size
            cell = (cell * (triangles / (0.8 * wanted)).sqrt().max(0.125)).max(least);
        }
        Ok(cell)
    }

    fn triangles_of_children(&self, height: usize, tile: &Tile) -> usize {
        self.made[height - 1][tile.children.clone()].iter().map(|made| made.triangles).sum()
    }

    fn bounds_of_children(&self, height: usize, tile: &Tile) -> Bounds {
        self.made[height - 1][tile.children.clone()].iter().fold(Bounds::EMPTY, |all, made| all.union(&made.bounds))
    }

    /// A power of two whose multiples files hold exactly, in all tiles of these boxes and a little beyond.
    fn step(&self, boxes: &[Bounds], cell: f64) -> f64 {
        let reach = boxes.iter().map(reach).fold(0.0, f64::max) + cell;
        let steps = if self.options.export.quantize { REACH_QUANTIZED } else { REACH };
        (reach / steps).max(f64::from(f32::MIN_POSITIVE)).log2().ceil().exp2()
    }

    /// Simplifies the tiles of a height with cells of a size.
    fn simplify_with(
        &self,
        tree: &Tree,
        height: usize,
        lattice: &Lattice,
        may_be_larger: bool,
    ) -> Result<Simplified, TilesError> {
        let mut made = Vec::new();
        let triangles = |tile: &Tile| self.triangles_of_children(height, tile);
        for some in batches(&tree.heights[height], triangles) {
            let simplify = |tile: &Tile| self.simplify_tile(tree, height, tile, lattice);
            let some: Vec<Made> = some.par_iter().map(simplify).collect::<Result<_, _>>()?;
            let most = some.iter().map(|made| made.triangles).max().unwrap_or(0);
            if most > self.options.triangles && may_be_larger {
                return Ok(Simplified::TooMany(most));
            }
            made.extend(some);
        }
        Ok(Simplified::Made(made))
    }

    fn simplify_tile(&self, tree: &Tree, height: usize, tile: &Tile, lattice: &Lattice) -> Result<Made, TilesError> {
        job::check();
        let children: Vec<usize> = tile.children.clone().collect();
        let read = |child: &usize| self.surface(&tree.heights[height - 1][*child], height - 1);
        let surface = Surface::joined(children.par_iter().map(read).collect::<Result<_, _>>()?);
        let walls = self.walls.of_tile(tile.place, height);
        let coarse = image(&surface, &representatives(&surface, &walls, lattice), lattice);
        let below = self.made[height - 1][tile.children.clone()].iter().map(|made| made.error).fold(0.0, f64::max);
        // greater than those of children also where nothing moved
        let error = (below + (coarse.moved + coarse.radius).max(lattice.step)) * (1.0 + ERROR_MARGIN);
        let own = bounds_of(coarse.surface.positions.iter().copied());
        let bounds = self.bounds_of_children(height, tile).union(&own);
        let path = self.mesh_path(height, tile);
        coarse.surface.save(&path).map_err(|source| TilesError::Write { path, source })?;
        Ok(Made { bounds, error, triangles: coarse.surface.triangles.len() })
    }

    /// The mesh of a tile that was made.
    fn surface(&self, tile: &Tile, height: usize) -> Result<Surface, TilesError> {
        if height == 0 {
            let mesh = self.read(tile.children.start)?;
            return Ok(Surface::of_mesh(&mesh, &self.materials.numbers(&mesh.materials)));
        }
        let path = self.mesh_path(height, tile);
        Surface::load(&path).map_err(|source| TilesError::Write { path, source })
    }

    /// Writes the meshes of a height as GLBs; gives how many bytes these have.
    fn write_height(&self, tree: &Tree, height: usize) -> Result<u64, TilesError> {
        let folder = folder_of_height(self.folder, height);
        make(&folder)?;
        let write = |tile: &Tile| {
            let mesh = self.surface(tile, height)?.into_mesh(&self.materials.all);
            self.write_glb(&folder.join(name(tile.place) + ".glb"), &mesh)
        };
        let bytes: Vec<u64> = tree.heights[height].par_iter().map(write).collect::<Result<_, _>>()?;
        Ok(bytes.iter().sum())
    }

    fn mesh_folder(&self, height: usize) -> PathBuf {
        self.folder.join(MESHES).join(height.to_string())
    }

    fn mesh_path(&self, height: usize, tile: &Tile) -> PathBuf {
        self.mesh_folder(height).join(name(tile.place))
    }
}

/// What became of the tiles of a height.
enum Simplified {
    Made(Vec<Made>),
    /// Number of triangles of one of them.
    TooMany(usize),
}

/// Runs of tiles that have not too many triangles together, or are one.
fn batches(tiles: &[Tile], triangles: impl Fn(&Tile) -> usize) -> Vec<&[Tile]> {
    let (mut batches, mut start, mut sum) = (Vec::new(), 0, 0);
    for (number, tile) in tiles.iter().enumerate() {
        let more = triangles(tile);
        if number > start && sum + more > TRIANGLES_AT_ONCE {
            batches.push(&tiles[start..number]);
            (start, sum) = (number, 0);
        }
        sum += more;
    }
    batches.push(&tiles[start..]);
    batches
}

fn bounds_of(positions: impl Iterator<Item = DVec3>) -> Bounds {
    positions.fold(Bounds::EMPTY, |all, at| Bounds { min: all.min.min(at), max: all.max.max(at) })
}

/// The farthest that coordinates in a box are from the middle that files are relative to, which is off by an eighth of half its extent, and by
/// what single precision does not hold.
fn reach(bounds: &Bounds) -> f64 {
    let half = (bounds.max * 0.5 - bounds.min * 0.5).max_element();
    let far = bounds.min.abs().max(bounds.max.abs()).max_element();
    1.125 * half + far * f64::from(f32::EPSILON)
}

fn make(folder: &Path) -> Result<(), TilesError> {
    fs::create_dir_all(folder).map_err(|source| TilesError::Write { path: folder.to_owned(), source })
}

/// Removes a folder where it is there.
fn remove(folder: &Path) -> Result<(), TilesError> {
    match fs::remove_dir_all(folder) {
        Err(source) if source.kind() != io::ErrorKind::NotFound => {
            Err(TilesError::Write { path: folder.to_owned(), source })
        }
        _ => Ok(()),
    }
}

/// Counts what is written.
struct Counted<W> {
    out: W,
    bytes: u64,
}

impl<W: Write> Write for Counted<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.out.write(bytes)?;
        self.bytes += written as u64;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}
