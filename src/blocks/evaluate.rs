//! The piece of a block, from its bytes.

use std::io::{self, Read};
use std::num::NonZeroU32;
use std::path::PathBuf;

use planecut_csg::stages::Bounds;
use planecut_csg::{BlockBuilder, BlockOperation, BlockPlace, Brush, Material, Polarity};

use super::bytes;
use super::error::BlocksError;
use super::piece::{encode, key_of};
use super::scatter::{END, FIRSTS, LEAF, MAGIC, OPERATION};
use super::spool::{faces, operation_of, polarity_of};

/// What a block is to know.
struct Contents {
    entries: Vec<Entry>,
    place: BlockPlace,
    bounds: Bounds,
    size: f64,
    materials: Vec<Material>,
}

enum Entry {
    Leaf(Brush, Option<NonZeroU32>, u8, Polarity),
    Operation(BlockOperation),
}

/// Evaluates a block from the bytes of its file ([`BlockPlan::block_path`](super::BlockPlan::block_path)); gives those of its piece
/// ([`BlockPlan::piece_path`](super::BlockPlan::piece_path)). The same bytes give the same, on any machine and any number of threads.
///
/// # Errors
/// [`BlocksError::Damaged`] for other bytes, [`BlocksError::Evaluate`] for a block without a mesh.
pub fn evaluate_block(block: &[u8]) -> Result<Vec<u8>, BlocksError> {
    let key = key_of(block);
    let damaged = |_| BlocksError::Damaged { path: PathBuf::new(), expected: "a block of planecut" };
    let contents = contents(block).map_err(damaged)?;
    let place = contents.place;
    let mut builder = BlockBuilder::new(contents.bounds, contents.materials.len());
    for entry in contents.entries {
        match entry {
            Entry::Leaf(brush, line, sides, polarity) => builder.leaf(brush, line, sides, polarity),
            Entry::Operation(told) => builder.operation(&told).ok_or_else(|| damaged(bytes::damaged()))?,
        }
    }
    let evaluated = builder.evaluate(contents.materials, contents.size);
    let evaluated = evaluated.map_err(|source| BlocksError::Evaluate { place, source })?;
    encode(&evaluated, place, key).map_err(damaged)
}

fn contents(mut from: &[u8]) -> io::Result<Contents> {
    let from = &mut from;
    let mut magic = [0; MAGIC.len()];
    from.read_exact(&mut magic)?;
    if magic != *MAGIC {
        return Err(bytes::damaged());
    }
    let mut entries = Vec::new();
    loop {
        match bytes::u8(from)? {
            LEAF => {
                let line = NonZeroU32::new(bytes::u32(from)?);
                let (sides, polarity) = (bytes::u8(from)?, polarity_of(bytes::u8(from)?)?);
                entries.push(Entry::Leaf(faces(from)?, line, sides, polarity));
            }
            OPERATION => entries.push(Entry::Operation(BlockOperation {
                operation: operation_of(bytes::u8(from)?)?,
                here: bytes::u32(from)?,
                first: *FIRSTS.get(usize::from(bytes::u8(from)?)).ok_or_else(bytes::damaged)?,
                full: bytes::u32(from)?,
                has_empty: bytes::u8(from)? != 0,
            })),
            END => break,
            _ => return Err(bytes::damaged()),
        }
    }
    let place = [bytes::u32(from)?, bytes::u32(from)?, bytes::u32(from)?];
    let bounds = Bounds { min: bytes::point(from)?, max: bytes::point(from)? };
    let size = bytes::f64(from)?;
    let materials = serde_json::from_slice(&bytes::text(from)?)?;
    if from.is_empty() { Ok(Contents { entries, place, bounds, size, materials }) } else { Err(bytes::damaged()) }
}
