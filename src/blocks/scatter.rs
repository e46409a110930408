//! What each block is to know, into a file of its own.

use std::fs::OpenOptions;
use std::io::Write;
use std::num::NonZeroU32;

use planecut_csg::stages::check_materials;
use planecut_csg::{
    BlockOperation, BlockPlace, BlockSides, Brush, FirstOperand, Material, MaterialId, Polarity, SharedBrushes,
    SnappedPlanes, TreeScatter, brush_mark,
};
use rustc_hash::FxHashMap;

use super::bytes::Bytes;
use super::error::BlocksError;
use super::plan::{BlockPlan, PlannedBlock};
use super::spool::{Leaf, Piece, Spool, number_of_operation, number_of_polarity, put_faces};

/// Bytes of all blocks that wait in memory until they are written.
const WAITING: usize = 1 << 26;

/// What a file of a block begins with.
pub(super) const MAGIC: &[u8; 8] = b"pcblock\x01";
/// Numbers that entries of a block begin with.
pub(super) const LEAF: u8 = 0;
pub(super) const OPERATION: u8 = 1;
pub(super) const END: u8 = 2;

/// The numbers of what a first operand is.
pub(super) const FIRSTS: [FirstOperand; 3] = [FirstOperand::Here, FirstOperand::Empty, FirstOperand::Full];

/// A block while it is told what there is.
#[derive(Default)]
struct Told {
    waiting: Bytes,
    written: u64,
    brushes: u64,
    /// The numbers of materials that it knows, by those of the model, in the order in which they came.
    materials: FxHashMap<MaterialId, u32>,
    order: Vec<MaterialId>,
}

impl Told {
    fn leaf(&mut self, brush: &Brush, line: Option<NonZeroU32>, sides: BlockSides, polarity: Polarity) {
        self.brushes += 1;
        let Self { waiting, materials, order, .. } = self;
        waiting.u8(LEAF);
        waiting.u32(line.map_or(0, NonZeroU32::get));
        waiting.u8(sides);
        waiting.u8(number_of_polarity(polarity));
        let number = |material| {
            *materials.entry(material).or_insert_with(|| {
                order.push(material);
                order.len() as u32 - 1
            })
        };
        put_faces(brush, number, waiting);
    }

    fn operation(&mut self, told: &BlockOperation) {
        let to = &mut self.waiting;
        to.u8(OPERATION);
        to.u8(number_of_operation(told.operation));
        to.u32(told.here);
        to.u8(FIRSTS.iter().position(|first| *first == told.first).expect("all are listed") as u8);
        to.u32(told.full);
        to.u8(u8::from(told.has_empty));
    }
}

/// The blocks of a plan on their way to files.
struct Blocks {
    plan: BlockPlan,
    told: FxHashMap<BlockPlace, Told>,
    waiting: usize,
}

impl Blocks {
    fn with<T>(&mut self, place: BlockPlace, tell: impl FnOnce(&mut Told) -> T) {
        let told = self.told.entry(place).or_default();
        let before = told.waiting.0.len();
        tell(told);
        self.waiting += told.waiting.0.len() - before;
    }

    /// Appends what waits to the files.
    fn flush(&mut self) -> Result<(), BlocksError> {
        for (place, told) in &mut self.told {
            if told.waiting.0.is_empty() {
                continue;
            }
            let path = self.plan.path_of(*place);
            let append = || {
                let mut file = OpenOptions::new().create(true).append(true).open(&path)?;
                if told.written == 0 {
                    file.write_all(MAGIC)?;
                }
                file.write_all(&told.waiting.0)
            };
            append().map_err(BlocksError::io(&path))?;
            told.written += told.waiting.0.len() as u64 + if told.written == 0 { MAGIC.len() as u64 } else { 0 };
            told.waiting.0 = Vec::new();
        }
        self.waiting = 0;
        Ok(())
    }

    /// Ends all files; gives the blocks in their order.
    fn finish(mut self, size: f64) -> Result<BlockPlan, BlocksError> {
        let mut places: Vec<BlockPlace> = self.told.keys().copied().collect();
        places.sort_unstable();
        for place in &places {
            let bounds = self.plan.grid().bounds(*place);
            let told = self.told.get_mut(place).expect("a block of its place");
            check_materials(told.order.iter().copied(), self.plan.materials().len())
                .map_err(|source| BlocksError::Evaluate { place: *place, source })?;
            let materials: Vec<&Material> = told.order.iter().map(|id| &self.plan.materials()[id.0 as usize]).collect();
            let materials =
                serde_json::to_vec(&materials).map_err(|error| BlocksError::io(self.plan.folder())(error.into()))?;
            let to = &mut told.waiting;
            to.u8(END);
            place.iter().for_each(|number| to.u32(*number));
            to.point(bounds.min);
            to.point(bounds.max);
            to.f64(size);
            to.text(&materials);
            if self.waiting > WAITING {
                self.flush()?;
            }
        }
        self.flush()?;
        let planned = places.into_iter().map(|place| {
            let told = &self.told[&place];
            PlannedBlock { place, brushes: told.brushes, bytes: told.written }
        });
        let planned = planned.collect();
        Ok(self.plan.with_blocks(planned))
    }
}

/// Tells each block what of a tree is there.
pub(super) fn scatter(
    spool: &Spool,
    plan: BlockPlan,
    snapped: &SnappedPlanes,
    shared: &SharedBrushes,
) -> Result<BlockPlan, BlocksError> {
    let size = plan.size();
    let grid = plan.grid().clone();
    let mut blocks = Blocks { plan, told: FxHashMap::default(), waiting: 0 };
    let mut tree = TreeScatter::default();
    spool.read(|piece| {
        match piece {
            Piece::Begin(operation) => tree.begin(operation),
            Piece::End => tree.end().for_each(|(place, told)| blocks.with(place, |block| block.operation(&told))),
            Piece::Leaf(Leaf { mut brush, line, polarity, place }) => {
                brush.faces.iter_mut().for_each(|face| face.half_space = snapped.of_plane(&face.half_space));
                let polarity = if shared.is_empty() {
                    polarity
                } else {
                    shared.polarity(brush_mark(&brush, &place.redundant), polarity)
                };
                tree.leaf(grid.reached(&place.bounds).map(|(place, sides)| {
                    blocks.with(place, |block| block.leaf(&brush, line, sides, polarity));
                    place
                }));
            }
        }
        if blocks.waiting > WAITING { blocks.flush() } else { Ok(()) }
    })?;
    if tree.holds_outside() {
        return Err(BlocksError::Unbounded);
    }
    blocks.finish(size)
}
