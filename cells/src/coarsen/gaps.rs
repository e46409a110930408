//! Which parts are so near each other that a cell around both is no bar in the air.

use planecut_csg::stages::{Bounds, Boxes};

use super::options::CoarsenOptions;
use super::part::Part;
use crate::tolerances::DEFAULT_MAX_GAP;

/// For each part the others whose boxes are near its own.
#[derive(Debug, Clone, Default)]
pub(super) struct Gaps {
    /// Ascending.
    near: Vec<Vec<u32>>,
    is_strict: bool,
}

impl Gaps {
    pub(super) fn new(parts: &[Part], boxes: &Boxes, options: &CoarsenOptions) -> Self {
        let all = parts.iter().fold(Bounds::EMPTY, |all, part| all.union(&part.bounds));
        let most = options.max_gap.unwrap_or(DEFAULT_MAX_GAP * (all.max - all.min).length());
        let near = parts.iter().map(|part| {
            let mut near = Vec::new();
            boxes.touching(&Bounds { min: part.bounds.min - most, max: part.bounds.max + most }, &mut near);
            near.sort_unstable();
            near
        });
        Self { near: near.collect(), is_strict: options.max_gap.is_some() }
    }

    /// Whether what is not near may not become one cell.
    pub(super) fn is_strict(&self) -> bool {
        self.is_strict
    }

    /// The parts that are near one; nothing where nothing is known.
    pub(super) fn near(&self, part: u32) -> Option<&[u32]> {
        self.near.get(part as usize).map(Vec::as_slice)
    }

    /// Whether any of some parts is near any of others. Where nothing is known of parts, all are.
    pub(super) fn are_near(&self, some: &[u32], others: &[u32]) -> bool {
        if self.near.is_empty() {
            return true;
        }
        let (fewer, more) = if some.len() <= others.len() { (some, others) } else { (others, some) };
        let mut sorted = more.to_vec();
        sorted.sort_unstable();
        fewer.iter().any(|part| self.near[*part as usize].iter().any(|near| sorted.binary_search(near).is_ok()))
    }
}
