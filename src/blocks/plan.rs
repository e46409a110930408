//! A plan in its folder.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use planecut_csg::{BlockGrid, BlockOptions, BlockPlace, Material};
use planecut_export::write_atomic;
use serde::{Deserialize, Serialize};

use super::error::BlocksError;

/// The name of a plan in its folder.
const NAME: &str = "plan.json";
/// The folders of blocks and of pieces.
const BLOCKS: &str = "blocks";
const PIECES: &str = "pieces";

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

    /// Removes the plan of a folder and its blocks, and leaves its pieces.
    pub(super) fn remove(folder: &Path) -> Result<(), BlocksError> {
        let absent = |error: &std::io::Error| error.kind() == ErrorKind::NotFound;
        let path = folder.join(NAME);
        fs::remove_file(&path)
            .or_else(|error| if absent(&error) { Ok(()) } else { Err(error) })
            .map_err(BlocksError::io(&path))?;
        let path = folder.join(BLOCKS);
        fs::remove_dir_all(&path)
            .or_else(|error| if absent(&error) { Ok(()) } else { Err(error) })
            .map_err(BlocksError::io(&path))?;
        for path in [path, folder.join(PIECES)] {
            fs::create_dir_all(&path).map_err(BlocksError::io(&path))?;
        }
        Ok(())
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
