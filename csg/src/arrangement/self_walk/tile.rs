//! A triangle in the frame, with planes that tell others apart from it. All tests may only say *surely apart*.

use glam::DVec3;

use super::wide_boxes::{Lanes, SmallBox, WIDTH};

/// What turning and rounding to double precision may do to coordinates in the frame, with room for a few products and sums of them.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// The same for single precision.
const NARROW_ROUNDING: f64 = 64.0 * f32::EPSILON as f64;

/// More than the sum of the magnitudes of a place's coordinates in the frame, and of a difference of two: the largest extent is 2 before it
/// is turned.
const FRAME_SIZE: f64 = 16.0;

/// More than what is lost where products are too small for the exponents of double precision, and of single precision.
const UNDERFLOW: f64 = 1e-280;
const NARROW_UNDERFLOW: f64 = 1e-36;

/// A triangle: its plane, and planes through its edges that are perpendicular to that.
#[derive(Debug)]
pub(super) struct Tile {
    /// The normal of its plane, and those of planes through its edges along that, pointing away from it.
    normals: [DVec3; 4],
    /// The heights of these planes over the origin, along their normals.
    offsets: [f64; 4],
    /// What rounding may do to the height of a place over each.
    doubts: [f64; 4],
}

impl Tile {
    pub(super) fn new([a, b, c]: [DVec3; 3]) -> Self {
        let (ab, bc, ca) = (b - a, c - b, a - c);
        let normal = ca.cross(ab);
        let length = |v: DVec3| v.abs().element_sum();
        let doubt = ROUNDING * (length(ab) + length(ca));
        let of_normal = ROUNDING * length(normal);
        let (over_ab, over_bc, over_ca) = (ab.cross(normal), bc.cross(normal), ca.cross(normal));
        let room = |along: DVec3, over: DVec3| {
            FRAME_SIZE * (of_normal + length(along) * doubt + ROUNDING * length(over)) + UNDERFLOW
        };
        let room_over = FRAME_SIZE * (doubt + of_normal) + UNDERFLOW;
        Self {
            normals: [normal, over_ab, over_bc, over_ca],
            offsets: [normal.dot(a), over_ab.dot(a), over_bc.dot(b), over_ca.dot(c)],
            doubts: [room_over, room(ab, over_ab), room(bc, over_bc), room(ca, over_ca)],
        }
    }

    /// Whether another triangle is sure to lie beyond its plane or one of its edges.
    #[inline]
    pub(super) fn has_beyond(&self, places: &[DVec3; 3]) -> bool {
        let heights = |k: usize| {
            let (normal, offset) = (self.normals[k], self.offsets[k]);
            places.map(|place| normal.dot(place) - offset)
        };
        let ([a, b, c], doubt) = (heights(0), self.doubts[0]);
        if (a > doubt) & (b > doubt) & (c > doubt) || (a < -doubt) & (b < -doubt) & (c < -doubt) {
            return true;
        }
        (1..4).any(|k| {
            let ([a, b, c], doubt) = (heights(k), self.doubts[k]);
            (a > doubt) & (b > doubt) & (c > doubt)
        })
    }
}

/// The planes of eight triangles.
#[derive(Debug)]
pub(super) struct WidePlanes {
    /// For each of the four planes of a tile the components of the normals.
    normals: [[[f32; WIDTH]; 3]; 4],
    offsets: [[f32; WIDTH]; 4],
    doubts: [[f32; WIDTH]; 4],
}

impl WidePlanes {
    pub(super) fn new<'a>(tiles: impl Iterator<Item = &'a Tile>) -> Self {
        let mut planes =
            Self { normals: [[[0.0; WIDTH]; 3]; 4], offsets: [[0.0; WIDTH]; 4], doubts: [[0.0; WIDTH]; 4] };
        for (lane, tile) in tiles.enumerate().take(WIDTH) {
            for k in 0..4 {
                let normal = tile.normals[k];
                for axis in 0..3 {
                    planes.normals[k][axis][lane] = narrowed(normal[axis]);
                }
                planes.offsets[k][lane] = narrowed(tile.offsets[k]);
                let rounding = NARROW_ROUNDING * normal.abs().element_sum();
                planes.doubts[k][lane] = narrowed(2.0 * (tile.doubts[k] + rounding + NARROW_UNDERFLOW));
            }
        }
        planes
    }

    /// Which of the triangles are not sure to be apart from a box.
    #[inline]
    pub(super) fn near(&self, bounds: &SmallBox) -> Lanes {
        let [middle, half] = bounds.middle_and_half();
        let mut near = [!0_u32; WIDTH];
        for k in 0..4 {
            let ([xs, ys, zs], offsets, doubts) = (&self.normals[k], &self.offsets[k], &self.doubts[k]);
            for lane in 0..WIDTH {
                let (x, y, z) = (xs[lane], ys[lane], zs[lane]);
                let height = x * middle[0] + y * middle[1] + z * middle[2] - offsets[lane];
                let reach = x.abs() * half[0] + y.abs() * half[1] + z.abs() * half[2] + doubts[lane];
                let height = if k == 0 { height.abs() } else { height };
                // also where that is not a number
                near[lane] &= if height > reach { 0 } else { !0 };
            }
        }
        Lanes::of(near)
    }
}

#[expect(clippy::cast_possible_truncation, reason = "doubts are larger than what that rounds")]
fn narrowed(v: f64) -> f32 {
    v as f32
}
