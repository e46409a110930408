//! A plan in its folder.

use std::fs::{self, File};
use std::io::BufReader;
use std::path::{Path, PathBuf};

use planecut_csg::{BlockGrid, BlockOptions, BlockPlace, Material};
use planecut_export::write_atomic;
use rustc_hash::FxHashSet;
use serde::{Deserialize, Serialize};

use super::error::BlocksError;
use super::piece::is_piece_of;

/// The name of a plan in its folder.
const NAME: &str = "plan.json";
/// The folders of blocks and of pieces.
const BLOCKS: &str = "blocks";
const PIECES: &str = "pieces";
/// The file of all brushes, and what names of sorted ones begin with: gone once a plan is made.
pub(super) const SPOOL: &str = "brushes";
pub(super) const SORTED: &str = "sorted-";
/// A file that says whose folder it is.
const MARKER: &str = "planecut-blocks.txt";
const MARKED: &str =
    "Blocks of a model and their meshes, made by planecut. What is in this folder is replaced by the next plan.\n";

/// What a model holds.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct ModelCounts {
    /// Brushes, all of them.
    pub brushes: u64,
    /// Planes of all brushes.
    pub planes: u64,
    /// Brushes without interior.
    pub empty: u64,
    /// Planes of brushes that have no face.
    pub redundant_planes: u64,
    /// The sum of the volumes of the brushes.
    pub brush_volume_sum: f64,
    /// Different planes for which another stands that is nearly the same.
    pub snapped_planes: u64,
    /// Brushes that are left out as they are not bounded.
    pub unbounded: u64,
    /// The line of the first of these, counted from 1; 0 where there is none.
    pub first_unbounded: u32,
}

/// A block of a plan.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct PlannedBlock {
    /// Its place in the grid.
    pub place: BlockPlace,
    /// Brushes that reach into it.
    pub brushes: u64,
    /// Bytes of what it is to know.
    pub bytes: u64,
}

/// The blocks of a model: what each is to know is in a file of its own, in a folder.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BlockPlan {
    /// The version of planecut that made it.
    planecut: String,
    options: BlockOptions,
    grid: BlockGrid,
    /// The size of the smallest brush.
    size: f64,
    model: ModelCounts,
    materials: Vec<Material>,
    blocks: Vec<PlannedBlock>,
    #[serde(skip)]
    folder: PathBuf,
}

impl BlockPlan {
    pub(super) fn new(
        folder: PathBuf,
        options: BlockOptions,
        grid: BlockGrid,
        size: f64,
        model: ModelCounts,
        materials: Vec<Material>,
    ) -> Self {
        let planecut = env!("CARGO_PKG_VERSION").to_owned();
        Self { planecut, options, grid, size, model, materials, blocks: Vec::new(), folder }
    }

    pub(super) fn with_blocks(self, blocks: Vec<PlannedBlock>) -> Self {
        Self { blocks, ..self }
    }

    /// The plan that is in a folder.
    ///
    /// # Errors
    /// [`BlocksError::Io`] where there is none, [`BlocksError::Damaged`] where it is of another version, or none.
    pub fn open(folder: &Path) -> Result<Self, BlocksError> {
        let path = folder.join(NAME);
        let text = fs::read(&path).map_err(BlocksError::io(&path))?;
        let plan = serde_json::from_slice::<Self>(&text).ok();
        let plan = plan.filter(|plan| plan.planecut == env!("CARGO_PKG_VERSION"));
        let expected = concat!("a plan of blocks of planecut ", env!("CARGO_PKG_VERSION"));
        plan.map(|plan| Self { folder: folder.to_owned(), ..plan }).ok_or(BlocksError::Damaged { path, expected })
    }

    pub(super) fn save(&self) -> Result<(), BlocksError> {
        let path = self.folder.join(NAME);
        let text = serde_json::to_vec(self).map_err(|error| BlocksError::io(&path)(error.into()))?;
        Ok(write_atomic(&path, &text)?)
    }

    /// Makes a folder ready for a plan: an earlier plan is removed with its blocks, its pieces stay.
    ///
    /// # Errors
    /// [`BlocksError::Occupied`] where something else is in the folder, [`BlocksError::Io`].
    pub(super) fn prepare(folder: &Path) -> Result<(), BlocksError> {
        fs::create_dir_all(folder).map_err(BlocksError::io(folder))?;
        let marker = folder.join(MARKER);
        let is_own = marker.is_file();
        for entry in fs::read_dir(folder).map_err(BlocksError::io(folder))? {
            let path = entry.map_err(BlocksError::io(folder))?.path();
            if !is_own {
                return Err(BlocksError::Occupied { path: folder.to_owned() });
            }
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            if name == BLOCKS {
                fs::remove_dir_all(&path).map_err(BlocksError::io(&path))?;
            } else if [NAME, SPOOL].contains(&&*name) || name.starts_with(SORTED) {
                // some of it is what a plan has left that was interrupted; what others have put there stays
                fs::remove_file(&path).map_err(BlocksError::io(&path))?;
            }
        }
        fs::write(&marker, MARKED).map_err(BlocksError::io(&marker))?;
        for path in [BLOCKS, PIECES].map(|name| folder.join(name)) {
            fs::create_dir_all(&path).map_err(BlocksError::io(&path))?;
        }
        Ok(())
    }

    /// Removes the pieces of earlier plans that are of no block.
    pub(super) fn remove_other_pieces(&self) -> Result<(), BlocksError> {
        let own: FxHashSet<PathBuf> = (0..self.blocks.len()).map(|block| self.piece_path(block)).collect();
        let folder = self.folder.join(PIECES);
        for entry in fs::read_dir(&folder).map_err(BlocksError::io(&folder))? {
            let path = entry.map_err(BlocksError::io(&folder))?.path();
            if !own.contains(&path) {
                fs::remove_file(&path).map_err(BlocksError::io(&path))?;
            }
        }
        Ok(())
    }

    /// The bytes of a block whose piece is not there, or is not that of the block: what [`evaluate_block`](super::evaluate_block) takes. Nothing where
    /// the piece is there.
    ///
    /// # Errors
    /// [`BlocksError::Io`].
    pub fn missing(&self, block: usize) -> Result<Option<Vec<u8>>, BlocksError> {
        let (from, to) = (self.block_path(block), self.piece_path(block));
        let bytes = fs::read(&from).map_err(BlocksError::io(&from))?;
        let is_there =
            File::open(to).is_ok_and(|file| is_piece_of(&mut BufReader::with_capacity(1 << 18, file), &bytes));
        Ok((!is_there).then_some(bytes))
    }

    /// Takes the piece of a block that was evaluated elsewhere.
    ///
    /// # Errors
    /// [`BlocksError::Damaged`] for bytes that are something else; [`BlocksError::Io`], [`BlocksError::Export`].
    pub fn store(&self, block: usize, piece: &[u8]) -> Result<(), BlocksError> {
        let (from, to) = (self.block_path(block), self.piece_path(block));
        let bytes = fs::read(&from).map_err(BlocksError::io(&from))?;
        if !is_piece_of(&mut &*piece, &bytes) {
            let expected = concat!("the piece of this block, of planecut ", env!("CARGO_PKG_VERSION"));
            return Err(BlocksError::Damaged { path: to, expected });
        }
        Ok(write_atomic(&to, piece)?)
    }

    /// The blocks, in the order of their places.
    #[must_use]
    pub fn blocks(&self) -> &[PlannedBlock] {
        &self.blocks
    }

    /// The walls between blocks.
    #[must_use]
    pub fn grid(&self) -> &BlockGrid {
        &self.grid
    }

    /// What the model holds.
    #[must_use]
    pub fn model(&self) -> &ModelCounts {
        &self.model
    }

    /// The materials of the model.
    #[must_use]
    pub fn materials(&self) -> &[Material] {
        &self.materials
    }

    /// The size of the smallest brush.
    pub(super) fn size(&self) -> f64 {
        self.size
    }

    /// The folder of the plan.
    #[must_use]
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The file of a block, by its number: what [`evaluate_block`](super::evaluate_block) takes.
    #[must_use]
    pub fn block_path(&self, block: usize) -> PathBuf {
        self.path_of(self.blocks[block].place)
    }

    /// The file for the piece of a block: what [`evaluate_block`](super::evaluate_block) gives.
    #[must_use]
    pub fn piece_path(&self, block: usize) -> PathBuf {
        let [x, y, z] = self.blocks[block].place;
        self.folder.join(PIECES).join(format!("{x}-{y}-{z}.piece"))
    }

    pub(super) fn path_of(&self, [x, y, z]: BlockPlace) -> PathBuf {
        self.folder.join(BLOCKS).join(format!("{x}-{y}-{z}.block"))
    }
}
