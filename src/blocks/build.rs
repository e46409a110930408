//! From a tree that goes by to a plan.

use std::fs;
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};

use planecut_csg::{
    BlockOptions, BlockSurvey, Brush, Material, NearPlaneFinder, NearRanges, Operation, PlaneMark, Polarity,
    PolarityStack, SharedBrushes, SnappedPlanes, TreeSink, UnboundedBrush, brush_mark,
};

use super::error::BlocksError;
use super::plan::{BlockPlan, ModelCounts, SPOOL};
use super::scatter::scatter;
use super::sorted::Sorter;
use super::spool::{Leaf, Piece, Spool, SpoolWriter};
use super::spool::{number_of_polarity, polarity_of};

/// Number of brushes that are looked at together.
const AT_A_TIME: usize = 1 << 13;

/// What has come and is not in the spool yet.
enum Waiting {
    Begin(Operation),
    Leaf(Option<NonZeroU32>, Polarity),
    End,
}

/// Takes a tree piece by piece and makes the plan of its blocks.
pub struct PlanBuilder {
    folder: PathBuf,
    options: BlockOptions,
    leaves_out_unbounded: bool,
    spool: SpoolWriter,
    waiting: Vec<Waiting>,
    brushes: Vec<Brush>,
    survey: BlockSurvey,
    polarity: PolarityStack,
    /// The polarity of the first brush, and whether others have another.
    first_polarity: Option<Polarity>,
    has_several_polarities: bool,
    unbounded: u64,
    first_unbounded: Option<NonZeroU32>,
    depth: usize,
    trees: usize,
}

impl PlanBuilder {
    /// A plan that is to be in a folder, which is made where there is none. What an earlier plan left there is replaced, but for pieces that
    /// still are what their blocks say.
    ///
    /// # Errors
    /// [`BlocksError::Occupied`] where something else is in the folder: nothing of others is removed; [`BlocksError::Io`].
    pub fn create(folder: &Path, options: BlockOptions) -> Result<Self, BlocksError> {
        BlockPlan::prepare(folder)?;
        Ok(Self {
            folder: folder.to_owned(),
            options,
            leaves_out_unbounded: false,
            spool: SpoolWriter::create(&folder.join(SPOOL))?,
            waiting: Vec::new(),
            brushes: Vec::new(),
            survey: BlockSurvey::default(),
            polarity: PolarityStack::default(),
            first_polarity: None,
            has_several_polarities: false,
            unbounded: 0,
            first_unbounded: None,
            depth: 0,
            trees: 0,
        })
    }

    /// Leaves out brushes that are not bounded, as for maps, where nobody means them; they are counted
    /// ([`ModelCounts::unbounded`]). They are refused otherwise.
    #[must_use]
    pub fn leaving_out_unbounded(self) -> Self {
        Self { leaves_out_unbounded: true, ..self }
    }

    /// Number of brushes that have come.
    #[must_use]
    pub fn brushes(&self) -> u64 {
        self.survey.brushes + self.brushes.len() as u64
    }

    fn wait(&mut self, piece: Waiting) -> Result<(), BlocksError> {
        if self.depth == 0 {
            self.trees += 1;
        }
        self.waiting.push(piece);
        if self.waiting.len() >= 2 * AT_A_TIME || self.brushes.len() >= AT_A_TIME { self.flush() } else { Ok(()) }
    }

    /// Looks at what waits and puts it into the spool.
    fn flush(&mut self) -> Result<(), BlocksError> {
        let brushes = std::mem::take(&mut self.brushes);
        let before = self.survey.brushes;
        let places = self.survey.add(&brushes);
        let mut brushes = (before..).zip(brushes.into_iter().zip(places));
        for piece in self.waiting.drain(..) {
            let piece = match piece {
                Waiting::Begin(operation) => Piece::Begin(operation),
                Waiting::End => Piece::End,
                Waiting::Leaf(line, polarity) => {
                    let (number, (brush, place)) = brushes.next().expect("a brush for each leaf");
                    let is_mesh = brush.is_mesh();
                    if is_mesh || place.is_unbounded && !self.leaves_out_unbounded {
                        return Err(BlocksError::Brush { line, source: UnboundedBrush { brush: number, is_mesh } });
                    }
                    if place.is_unbounded {
                        self.unbounded += 1;
                        self.first_unbounded = self.first_unbounded.or(line);
                    }
                    Piece::Leaf(Leaf { brush, line, polarity, place })
                }
            };
            self.spool.push(&piece)?;
        }
        Ok(())
    }

    /// The plan, once the tree has gone by; `materials` are those that its brushes name.
    ///
    /// # Errors
    /// [`BlocksError`].
    pub fn finish(mut self, materials: Vec<Material>) -> Result<BlockPlan, BlocksError> {
        self.flush()?;
        if self.depth > 0 || self.trees > 1 {
            return Err(BlocksError::Tree);
        }
        let spool = self.spool.finish()?;
        let snapped = snapped(&spool, &self.survey, &self.folder)?;
        let shared = if self.has_several_polarities {
            shared(&spool, &snapped, &self.folder)?
        } else {
            SharedBrushes::default()
        };
        let model = ModelCounts {
            brushes: self.survey.brushes,
            planes: self.survey.planes,
            empty: self.survey.empty,
            redundant_planes: self.survey.redundant_planes,
            brush_volume_sum: self.survey.volume_sum(),
            snapped_planes: snapped.count() as u64,
            unbounded: self.unbounded,
            first_unbounded: self.first_unbounded.map_or(0, NonZeroU32::get),
        };
        let grid = self.survey.grid(self.options);
        let plan = BlockPlan::new(self.folder, self.options, grid, self.survey.size(), model, materials);
        let plan = scatter(&spool, plan, &snapped, &shared)?;
        fs::remove_file(&spool.path).map_err(BlocksError::io(&spool.path))?;
        plan.remove_other_pieces()?;
        plan.save()?;
        Ok(plan)
    }
}

impl TreeSink for PlanBuilder {
    type Error = BlocksError;

    fn begin(&mut self, operation: Operation) -> Result<(), BlocksError> {
        self.polarity.begin(operation);
        self.wait(Waiting::Begin(operation))?;
        self.depth += 1;
        Ok(())
    }

    fn leaf(&mut self, brush: Brush, line: Option<NonZeroU32>) -> Result<(), BlocksError> {
        let polarity = self.polarity.leaf();
        self.has_several_polarities |= *self.first_polarity.get_or_insert(polarity) != polarity;
        self.brushes.push(Brush { name: None, ..brush });
        self.wait(Waiting::Leaf(line, polarity))
    }

    fn end(&mut self) -> Result<(), BlocksError> {
        self.polarity.end();
        self.wait(Waiting::End)?;
        self.depth = self.depth.checked_sub(1).ok_or(BlocksError::Tree)?;
        Ok(())
    }
}

/// The planes for which others stand.
fn snapped(spool: &Spool, survey: &BlockSurvey, folder: &Path) -> Result<SnappedPlanes, BlocksError> {
    let planes = survey.planes();
    if !planes.has_noise() {
        return Ok(SnappedPlanes::default());
    }
    let mut sorter = Sorter::new(folder);
    spool.read_leaves(|leaf| {
        let mut marks = leaf.brush.half_spaces().flat_map(|half_space| planes.marks(half_space));
        marks.try_for_each(|PlaneMark { place, plane }| sorter.push((place, plane)))
    })?;
    let mut ranges = NearRanges::default();
    sorter.merge(|(place, plane)| ranges.push(PlaneMark { place, plane }))?;
    if ranges.is_empty() {
        return Ok(SnappedPlanes::default());
    }
    let mut finder = NearPlaneFinder::new(planes, ranges);
    spool.read_leaves(|leaf| {
        leaf.brush.half_spaces().for_each(|half_space| finder.note(half_space));
        Ok(())
    })?;
    Ok(finder.finish())
}

/// The brushes that add and take, or are equal to such.
fn shared(spool: &Spool, snapped: &SnappedPlanes, folder: &Path) -> Result<SharedBrushes, BlocksError> {
    let mut sorter = Sorter::new(folder);
    spool.read_leaves(|Leaf { mut brush, polarity, place, .. }| {
        brush.faces.iter_mut().for_each(|face| face.half_space = snapped.of_plane(&face.half_space));
        sorter.push((brush_mark(&brush, &place.redundant), u64::from(number_of_polarity(polarity))))
    })?;
    let mut shared = SharedBrushes::default();
    sorter.merge(|(mark, polarity)| {
        let polarity = u8::try_from(polarity).map(polarity_of);
        shared.push(mark, polarity.expect("a small number").expect("one of three"));
    })?;
    Ok(shared)
}
