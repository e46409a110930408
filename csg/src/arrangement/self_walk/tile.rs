//! A triangle in the frame, with planes that tell others apart from it. All tests may only say *surely apart*.

use glam::DVec3;
use wide::f32x4;

use super::wide_boxes::{Eight, Lanes, SmallBox, WIDTH, eight};

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
pub(super) struct WidePlanes([WidePlane; 4]);

/// One of the four planes of each of eight tiles.
#[derive(Debug, Clone, Copy)]
struct WidePlane {
    normals: [Eight; 3],
    offsets: Eight,
    doubts: Eight,
}

impl WidePlanes {
    pub(super) fn new(tiles: &[Option<Tile>; WIDTH]) -> Self {
        let of_all = |value: &dyn Fn(&Tile) -> f64| {
            eight(std::array::from_fn(|k| tiles[k].as_ref().map_or(0.0, |tile| narrowed(value(tile)))))
        };
        Self([0, 1, 2, 3].map(|k| WidePlane {
            normals: [0, 1, 2].map(|axis| of_all(&|tile| tile.normals[k][axis])),
            offsets: of_all(&|tile| tile.offsets[k]),
            doubts: of_all(&|tile| {
                let rounding = NARROW_ROUNDING * tile.normals[k].abs().element_sum();
                2.0 * (tile.doubts[k] + rounding + NARROW_UNDERFLOW)
            }),
        }))
    }

    /// Which of the triangles are not sure to be apart from a box.
    #[inline]
    pub(super) fn near(&self, bounds: &SmallBox) -> Lanes {
        let [middle, half] = bounds.middle_and_half().map(|[x, y, z]| [x, y, z].map(f32x4::splat));
        let apart = |k: usize| {
            let height_and_reach = |plane: &WidePlane| {
                let [x, y, z] = [plane.normals[0][k], plane.normals[1][k], plane.normals[2][k]];
                let height = x * middle[0] + y * middle[1] + z * middle[2] - plane.offsets[k];
                (height, x.abs() * half[0] + y.abs() * half[1] + z.abs() * half[2] + plane.doubts[k])
            };
            let [of_plane, ab, bc, ca] = [0, 1, 2, 3].map(|plane| height_and_reach(&self.0[plane]));
            let beyond = |(height, reach): (f32x4, f32x4)| height.simd_gt(reach);
            (of_plane.0.abs().simd_gt(of_plane.1) | beyond(ab) | beyond(bc) | beyond(ca)).to_bitmask()
        };
        // what is not a number tells nothing apart
        Lanes(!(apart(0) | apart(1) << 4) & ALL)
    }
}

/// All of eight.
const ALL: u32 = (1 << WIDTH) - 1;

#[expect(clippy::cast_possible_truncation, reason = "doubts are larger than what that rounds")]
fn narrowed(v: f64) -> f32 {
    v as f32
}
