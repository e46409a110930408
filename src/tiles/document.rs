//! The JSON documents of a tile set: <https://docs.ogc.org/cs/22-025r4/22-025r4.html>.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use planecut_csg::stages::Bounds;
use serde_json::{Value, json};

use super::TilesError;
use super::grid::Tree;

/// The name of the first document.
pub(super) const ROOT: &str = "tileset.json";

/// The folder of contents.
pub(super) const CONTENTS: &str = "tiles";

/// What a document of ours says that it was made by, so that it may be replaced.
pub(super) const GENERATOR: &str = "planecut";

/// Where a tile set is divided, each document holds tiles of this number of heights, and the roots of those below: 585 tiles at most.
const HEIGHTS_PER_FILE: usize = 3;

/// Boxes are larger than what is in them by this part of their coordinates, which is more than rounding.
const BOX_MARGIN: f64 = 1e-12;

/// What is known of a tile that was made.
#[derive(Debug, Clone, Copy)]
pub(super) struct Made {
    /// The box of its mesh and those of all tiles below it.
    pub(super) bounds: Bounds,
    /// How far it is from the model, in the units of the meshes.
    pub(super) error: f64,
    /// Its triangles.
    pub(super) triangles: usize,
}

/// The tiles of all heights, and what was made of them.
pub(super) struct Documents<'a> {
    pub(super) tree: &'a Tree,
    pub(super) made: &'a [Vec<Made>],
    /// Metres of a unit.
    pub(super) meters: f64,
    /// Of more tiles there are several documents.
    pub(super) tiles_per_file: usize,
}

/// The name of a tile, without an ending: that of its GLB, and of its document where it has one.
pub(super) fn name([x, y, z]: [u32; 3]) -> String {
    format!("{x}-{y}-{z}")
}

/// The folder of the contents of a height.
pub(super) fn folder_of_height(folder: &Path, height: usize) -> PathBuf {
    folder.join(CONTENTS).join(height.to_string())
}

impl Documents<'_> {
    /// Writes all; gives how many there are.
    pub(super) fn write(&self, folder: &Path) -> Result<usize, TilesError> {
        let top = self.tree.heights.len() - 1;
        self.write_one(&folder.join(ROOT), top, 0, "tiles/")?;
        let mut documents = 1;
        for height in (0..top).filter(|height| self.is_divided_at(*height)) {
            for (number, tile) in self.tree.heights[height].iter().enumerate() {
                let path = folder_of_height(folder, height).join(name(tile.place) + ".json");
                self.write_one(&path, height, number, "../")?;
                documents += 1;
            }
        }
        Ok(documents)
    }

    /// Whether tiles of a height begin documents of their own.
    fn is_divided_at(&self, height: usize) -> bool {
        let top = self.tree.heights.len() - 1;
        self.tree.len() > self.tiles_per_file && height < top && height > 0 && height.is_multiple_of(HEIGHTS_PER_FILE)
    }

    /// Writes the document of a tile; `contents` leads from it to the folder of contents.
    fn write_one(&self, path: &Path, height: usize, number: usize, contents: &str) -> Result<(), TilesError> {
        let mut root = self.tile(height, number, contents, true);
        root["refine"] = "REPLACE".into();
        let made = &self.made[height][number];
        // what is seen where nothing of the tile set is: all of it is missing
        let missing = made.error.max((made.bounds.max - made.bounds.min).length());
        let document = json!({
            "asset": {"version": "1.1", "extras": {"generator": GENERATOR}},
            "geometricError": missing * self.meters,
            "root": root,
        });
        let write = || -> io::Result<()> {
            let mut out = BufWriter::new(File::create(path)?);
            serde_json::to_writer(&mut out, &document)?;
            out.flush()
        };
        write().map_err(|source| TilesError::Write { path: path.to_owned(), source })
    }

    /// A tile and those below it, as far as they are in the same document.
    fn tile(&self, height: usize, number: usize, contents: &str, is_root: bool) -> Value {
        let (tile, made) = (&self.tree.heights[height][number], &self.made[height][number]);
        let is_elsewhere = !is_root && self.is_divided_at(height);
        let ending = if is_elsewhere { "json" } else { "glb" };
        let mut value = json!({
            "boundingVolume": {"box": self.bounding_box(&made.bounds)},
            "geometricError": made.error * self.meters,
            "content": {"uri": format!("{contents}{height}/{}.{ending}", name(tile.place))},
        });
        if height > 0 && !is_elsewhere {
            let children = tile.children.clone().map(|child| self.tile(height - 1, child, contents, false));
            value["children"] = children.collect();
        }
        value
    }

    /// The centre of a box in metres and its half axes, with some room.
    fn bounding_box(&self, bounds: &Bounds) -> [f64; 12] {
        let (min, max) = (bounds.min * self.meters, bounds.max * self.meters);
        let center = min * 0.5 + max * 0.5;
        let half = (max * 0.5 - min * 0.5) + BOX_MARGIN * min.abs().max(max.abs());
        [center.x, center.y, center.z, half.x, 0.0, 0.0, 0.0, half.y, 0.0, 0.0, 0.0, half.z]
    }
}
