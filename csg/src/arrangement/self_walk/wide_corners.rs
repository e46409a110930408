//! The corners of eight triangles, to find those that share one.

use wide::u32x4;

use super::wide_boxes::{Lanes, WIDTH};

/// A corner that counts as no other's.
pub(super) const OTHER: u32 = u32::MAX;

/// The same of a triangle that is held against others.
const OTHER_OF_ONE: u32 = u32::MAX - 1;

/// The corners of eight triangles.
#[derive(Debug)]
pub(super) struct WideCorners([[u32x4; 2]; 3]);

impl WideCorners {
    pub(super) fn new(triangles: impl Iterator<Item = [u32; 3]>) -> Self {
        let mut wide = [[OTHER; WIDTH]; 3];
        for (lane, corners) in triangles.enumerate().take(WIDTH) {
            for (k, corner) in corners.into_iter().enumerate() {
                wide[k][lane] = corner;
            }
        }
        Self(wide.map(|[a, b, c, d, e, f, g, h]| [u32x4::from([a, b, c, d]), u32x4::from([e, f, g, h])]))
    }

    /// The corners of one of them.
    #[inline]
    pub(super) fn get(&self, lane: usize) -> [u32; 3] {
        let [a, b, c] = &self.0;
        let corner = |eight: &[u32x4; 2]| eight[lane / 4].as_array()[lane % 4];
        [corner(a), corner(b), corner(c)]
    }

    /// Which of them share a corner with another triangle.
    #[inline]
    pub(super) fn sharing(&self, corners: [u32; 3]) -> Lanes {
        let [p, q, r] = corners.map(|corner| u32x4::splat(if corner == OTHER { OTHER_OF_ONE } else { corner }));
        let half = |k: usize| {
            let is_one = |own: u32x4| own.simd_eq(p) | own.simd_eq(q) | own.simd_eq(r);
            (is_one(self.0[0][k]) | is_one(self.0[1][k]) | is_one(self.0[2][k])).to_bitmask()
        };
        Lanes(half(0) | half(1) << 4)
    }
}
