//! Boxes in single precision, eight side by side, and a hierarchy of them.

use glam::DVec3;
use planecut_parallel::prelude::*;
use wide::f32x4;

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
        Self { min: min.to_array().map(|v| narrowed(v) - slack), max: max.to_array().map(|v| narrowed(v) + slack) }
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

/// Eight numbers: two times as many as processors of the oldest kind that matters take at once.
pub(super) type Eight = [f32x4; 2];

/// The numbers of a list.
pub(super) fn eight(values: [f32; WIDTH]) -> Eight {
    let [a, b, c, d, e, f, g, h] = values;
    [f32x4::from([a, b, c, d]), f32x4::from([e, f, g, h])]
}

/// One of eight numbers.
#[inline]
fn one_of(eight: &Eight, k: usize) -> f32 {
    eight[k / 4].as_array()[k % 4]
}

/// Eight boxes; those that are missing touch nothing.
#[derive(Debug, Clone)]
pub(super) struct WideBox {
    min: [Eight; 3],
    max: [Eight; 3],
}

impl WideBox {
    fn new(boxes: impl Iterator<Item = SmallBox>) -> Self {
        let (mut min, mut max) = ([[f32::INFINITY; WIDTH]; 3], [[f32::NEG_INFINITY; WIDTH]; 3]);
        for (k, own) in boxes.enumerate().take(WIDTH) {
            for axis in 0..3 {
                min[axis][k] = own.min[axis];
                max[axis][k] = own.max[axis];
            }
        }
        Self { min: min.map(eight), max: max.map(eight) }
    }

    /// One of the boxes.
    #[inline]
    pub(super) fn get(&self, k: usize) -> SmallBox {
        let corner = |[x, y, z]: &[Eight; 3]| [one_of(x, k), one_of(y, k), one_of(z, k)];
        SmallBox { min: corner(&self.min), max: corner(&self.max) }
    }

    /// A box around all of them.
    fn around(&self) -> SmallBox {
        (0..WIDTH).fold(SmallBox::EMPTY, |all, k| all.union(&self.get(k)))
    }

    /// Which of the boxes touch another one, as bits.
    #[inline]
    pub(super) fn touching(&self, other: &SmallBox) -> Lanes {
        let [low_x, low_y, low_z] = other.min.map(f32x4::splat);
        let [high_x, high_y, high_z] = other.max.map(f32x4::splat);
        let ([min_x, min_y, min_z], [max_x, max_y, max_z]) = (&self.min, &self.max);
        let half = |k: usize| {
            let along_x = min_x[k].simd_le(high_x) & max_x[k].simd_ge(low_x);
            let along_y = min_y[k].simd_le(high_y) & max_y[k].simd_ge(low_y);
            let along_z = min_z[k].simd_le(high_z) & max_z[k].simd_ge(low_z);
            (along_x & along_y & along_z).to_bitmask()
        };
        Lanes(half(0) | half(1) << 4)
    }
}

/// Some of eight, as bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Lanes(pub(super) u32);

impl Lanes {
    pub(super) fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Those that others are, too.
    #[inline]
    pub(super) fn and(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// Those that others are not.
    #[inline]
    pub(super) fn without(self, others: Self) -> Self {
        Self(self.0 & !others.0)
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
        if self.0 == 0 {
            return None;
        }
        let first = self.0.trailing_zeros() as usize;
        self.0 &= self.0 - 1;
        Some(first)
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
