//! Boxes in single precision, eight side by side, and a hierarchy of them: compilers make one instruction of what is done to several.

use glam::DVec3;
use planecut_parallel::prelude::*;

/// Boxes that are held against another one at once.
pub(super) const WIDTH: usize = 8;

/// What rounding to single precision, and turning before that, may do to coordinates of a mesh whose largest extent is 2.
pub(super) const SLACK: f32 = 8.0 * f32::EPSILON;

/// Leaves that one thread looks at in a row.
const CHUNK: usize = 1 << 9;

/// A box.
#[derive(Debug, Clone, Copy)]
pub(super) struct SmallBox {
    min: [f32; 3],
    max: [f32; 3],
}

impl SmallBox {
    const EMPTY: Self = Self { min: [f32::INFINITY; 3], max: [f32::NEG_INFINITY; 3] };

    /// A box around three places, with room for rounding.
    pub(super) fn around([a, b, c]: [DVec3; 3], slack: f32) -> Self {
        let (min, max) = (a.min(b).min(c), a.max(b).max(c));
        Self {
            min: min.to_array().map(|v| narrowed(v) - slack),
            max: max.to_array().map(|v| narrowed(v) + slack),
        }
    }

    fn union(&self, other: &Self) -> Self {
        let pick = |f: fn(f32, f32) -> f32, a: [f32; 3], b: [f32; 3]| [f(a[0], b[0]), f(a[1], b[1]), f(a[2], b[2])];
        Self { min: pick(f32::min, self.min, other.min), max: pick(f32::max, self.max, other.max) }
    }

    /// The sum of its extents along all axes.
    #[inline]
    pub(super) fn extent(&self) -> f32 {
        (self.max[0] - self.min[0]) + (self.max[1] - self.min[1]) + (self.max[2] - self.min[2])
    }

    /// Its middle, and half of its extent with room for rounding of both.
    #[inline]
    pub(super) fn middle_and_half(&self) -> [[f32; 3]; 2] {
        let middle = |k: usize| 0.5 * (self.min[k] + self.max[k]);
        let half = |k: usize| 0.5 * (self.max[k] - self.min[k]) + SLACK;
        [[middle(0), middle(1), middle(2)], [half(0), half(1), half(2)]]
    }
}

/// Eight boxes; those that are missing touch nothing.
#[derive(Debug, Clone)]
pub(super) struct WideBox {
    min: [[f32; WIDTH]; 3],
    max: [[f32; WIDTH]; 3],
}

impl WideBox {
    fn new(boxes: impl Iterator<Item = SmallBox>) -> Self {
        let mut wide = Self { min: [[f32::INFINITY; WIDTH]; 3], max: [[f32::NEG_INFINITY; WIDTH]; 3] };
        for (k, own) in boxes.enumerate().take(WIDTH) {
            for axis in 0..3 {
                wide.min[axis][k] = own.min[axis];
                wide.max[axis][k] = own.max[axis];
            }
        }
        wide
    }

    /// One of the boxes.
    #[inline]
    pub(super) fn get(&self, k: usize) -> SmallBox {
        let ([a, b, c], [d, e, f]) = (&self.min, &self.max);
        SmallBox { min: [a[k], b[k], c[k]], max: [d[k], e[k], f[k]] }
    }

    /// A box around all of them.
    fn around(&self) -> SmallBox {
        (0..WIDTH).fold(SmallBox::EMPTY, |all, k| all.union(&self.get(k)))
    }

    /// Which of the boxes touch another one, as bits.
    #[inline]
    pub(super) fn touching(&self, other: &SmallBox) -> Lanes {
        let mut hits = [!0_u32; WIDTH];
        for axis in 0..3 {
            let (low, high) = (other.min[axis], other.max[axis]);
            let (min, max) = (&self.min[axis], &self.max[axis]);
            for k in 0..WIDTH {
                hits[k] &= if min[k] <= high { !0 } else { 0 };
            }
            for k in 0..WIDTH {
                hits[k] &= if max[k] >= low { !0 } else { 0 };
            }
        }
        Lanes::of(hits)
    }
}

/// Some of eight, as bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Lanes(u32);

impl Lanes {
    /// Those whose number is not zero; all bits of it are set then.
    #[inline]
    pub(super) fn of(mut members: [u32; WIDTH]) -> Self {
        for (k, member) in members.iter_mut().enumerate() {
            *member &= 1 << k;
        }
        Self(members.iter().fold(0, |bits, member| bits | member))
    }

    pub(super) fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Those that others are, too.
    #[inline]
    pub(super) fn and(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// Those after one of them.
    #[inline]
    pub(super) fn after(self, k: usize) -> Self {
        Self(self.0 & (!0 << k << 1))
    }
}

impl Iterator for Lanes {
    type Item = usize;

    #[inline]
    fn next(&mut self) -> Option<usize> {
        let first = self.0.trailing_zeros();
        self.0 &= self.0.wrapping_sub(1);
        (first < 32).then_some(first as usize)
    }
}

/// A hierarchy of boxes: each box of a node is around all boxes of a node of the level below.
#[derive(Debug)]
pub(super) struct WideBoxes {
    /// The nodes of each level; those of the first one, the leaves, hold the boxes that were given.
    pub(super) levels: Vec<Vec<WideBox>>,
}

impl WideBoxes {
    /// A hierarchy over boxes, eight of those that follow one another in each leaf.
    pub(super) fn new(boxes: &[SmallBox]) -> Self {
        let leaf = |boxes: &[SmallBox]| WideBox::new(boxes.iter().copied());
        let mut levels: Vec<Vec<WideBox>> = vec![boxes.par_chunks(WIDTH).with_min_len(CHUNK).map(leaf).collect()];
        while let Some(last) = levels.last().filter(|last| last.len() > 1 || levels.len() == 1) {
            let node = |below: &[WideBox]| WideBox::new(below.iter().map(WideBox::around));
            let next = last.par_chunks(WIDTH).with_min_len(CHUNK).map(node).collect();
            levels.push(next);
        }
        Self { levels }
    }

    /// The number of leaves.
    pub(super) fn leaves(&self) -> usize {
        self.levels[0].len()
    }
}

#[expect(clippy::cast_possible_truncation, reason = "boxes are grown by more than that rounds")]
fn narrowed(v: f64) -> f32 {
    v as f32
}
