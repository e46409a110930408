//! How textures lie on faces.

use glam::{DVec2, DVec3};

use super::Transform;

/// Coordinates that differ by no more than this share of their size are the same but for rounding.
const SAME: f64 = 64.0 * f64::EPSILON;
/// Sums that are no more than this share of what they are made of are zero but for rounding.
const NOISE: f64 = 1.0 / (1u64 << 44) as f64;

/// Triangles that are no higher than this share of their longest side have no area but for rounding.
const NO_HEIGHT: f64 = 8.0 * f64::EPSILON;

/// What texture coordinates count.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum TextureUnit {
    /// Texels, of which a picture has as many as it is wide or high; lengths where there is no picture.
    #[default]
    Texels,
    /// Whole pictures, whatever their size.
    Pictures,
}

/// How a texture lies on a plane: its coordinates are linear in space.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct TextureAxes {
    /// By how much `u`, which runs to the right of a picture, grows along each axis of space.
    pub u: DVec3,
    /// By how much `v`, which runs down a picture, grows along each axis of space.
    pub v: DVec3,
    /// Both at the anchor, or at the origin where there is none.
    pub offset: DVec2,
    /// What both count.
    pub unit: TextureUnit,
    /// Where the texture is stated at the corners of triangles: one of these corners, so that nothing is lost far from the origin. Such a
    /// texture goes on in the next triangle: a vertex at which both have the same coordinates need not be split.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub anchor: Option<DVec3>,
}

impl TextureAxes {
    /// The texture of a triangle by the coordinates at its corners, in whole pictures, `v` down. `None` where the triangle has no area, or numbers are
    /// not finite.
    ///
    /// ```
    /// use glam::{DVec2, DVec3};
    /// use planecut_csg::TextureAxes;
    ///
    /// let corners = [DVec3::new(9.0, 0.0, 0.0), DVec3::new(9.0, 2.0, 0.0), DVec3::new(9.0, 0.0, 4.0)];
    /// let axes = TextureAxes::of_triangle(corners, [DVec2::ZERO, DVec2::X, DVec2::Y]).unwrap();
    /// assert!(axes.at(DVec3::new(9.0, 1.0, 1.0)).abs_diff_eq(DVec2::new(0.5, 0.25), 1e-15));
    /// ```
    #[must_use]
    pub fn of_triangle(corners: [DVec3; 3], coordinates: [DVec2; 3]) -> Option<Self> {
        let lengths = [0, 1, 2].map(|k| corners[k].distance_squared(corners[(k + 1) % 3]));
        // along the longest side, and across it: then slivers lose no more digits than they must
        let first = (0..3).max_by(|a, b| lengths[*a].total_cmp(&lengths[*b])).unwrap_or(0);
        let [a, b, c] = [0, 1, 2].map(|k| (first + k) % 3);
        let (side, other) = (corners[b] - corners[a], corners[c] - corners[a]);
        let length = side.length();
        let along = side / length;
        let height = other - along * along.dot(other);
        // what is left of the one direction in the other is as large as rounding, which a thin triangle would magnify
        let height = height - along * along.dot(height);
        if height.length() <= NO_HEIGHT * length {
            return None;
        }
        let across = height / height.length();
        let by_length = (coordinates[b] - coordinates[a]) / length;
        let by_height = (coordinates[c] - coordinates[a] - by_length * along.dot(other)) / across.dot(other);
        let axes = Self {
            u: along * by_length.x + across * by_height.x,
            v: along * by_length.y + across * by_height.y,
            offset: coordinates[a],
            unit: TextureUnit::Pictures,
            anchor: Some(corners[a]),
        };
        axes.is_finite().then_some(axes)
    }

    /// The texture coordinates of a point, in [`TextureAxes::unit`].
    #[must_use]
    pub fn at(&self, point: DVec3) -> DVec2 {
        let Some(anchor) = self.anchor else {
            return DVec2::new(self.u.dot(point), self.v.dot(point)) + self.offset;
        };
        let point = point - anchor;
        // noise instead of zero would be another number in each triangle, also in single precision
        let sum = |gradient: DVec3, offset: f64| {
            let sum = gradient.dot(point) + offset;
            if sum.abs() <= NOISE * (gradient * point).abs().max_element().max(offset.abs()) { 0.0 } else { sum }
        };
        DVec2::new(sum(self.u, self.offset.x), sum(self.v, self.offset.y))
    }

    /// Whether the texture has these coordinates at these points but for rounding.
    #[must_use]
    pub fn fits(&self, points: [DVec3; 3], coordinates: [DVec2; 3]) -> bool {
        let size = coordinates.iter().fold(self.offset.abs(), |size, at| size.max(at.abs()));
        points.into_iter().zip(coordinates).all(|(point, at)| {
            let error = (self.at(point) - at).abs();
            error.x <= SAME * size.x && error.y <= SAME * size.y
        })
    }

    /// The same on what is moved by an affine map: each point keeps its coordinates.
    #[must_use]
    pub fn transformed(&self, transform: &Transform) -> Self {
        let [u, v] = [self.u, self.v].map(|gradient| transform.gradient(gradient));
        match self.anchor {
            Some(anchor) => Self { u, v, anchor: Some(transform.point(anchor) + 0.0), ..*self },
            None => {
                let origin = transform.offset();
                Self { u, v, offset: self.offset - DVec2::new(u.dot(origin), v.dot(origin)), ..*self }
            }
        }
    }

    /// Whether all numbers are finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        let is_anchored = self.anchor.is_none_or(DVec3::is_finite);
        self.u.is_finite() && self.v.is_finite() && self.offset.is_finite() && is_anchored
    }

    /// Numbers that are equal for textures that lie alike.
    pub(super) fn bits(&self) -> [u64; 13] {
        let [a, b, c] = self.u.to_array().map(f64::to_bits);
        let [d, e, f] = self.v.to_array().map(f64::to_bits);
        let [g, h] = self.offset.to_array().map(f64::to_bits);
        let [i, j, k] = self.anchor.unwrap_or_default().to_array().map(f64::to_bits);
        let unit = u64::from(self.unit == TextureUnit::Pictures);
        [a, b, c, d, e, f, g, h, i, j, k, unit, u64::from(self.anchor.is_some())]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DMat3;

    #[test]
    fn corners_have_their_coordinates_far_from_the_origin_and_on_slivers() {
        let coordinates = [DVec2::new(0.25, 0.75), DVec2::new(3.0, -1.0), DVec2::new(0.125, 0.5)];
        let small = [DVec3::ZERO, DVec3::new(1e-3, 2e-4, 0.0), DVec3::new(3e-4, 5e-4, 1e-3)];
        let sliver = [DVec3::ZERO, DVec3::new(10.0, 3.0, 1.0), DVec3::new(5.0, 1.5 + 1e-6, 0.5)];
        for (corners, error) in [(small.map(|corner| corner + 1e4), 1e-12), (sliver, 1e-8), (small, 1e-14)] {
            for turn in 0..3 {
                let turned = [0, 1, 2].map(|k| corners[(k + turn) % 3]);
                let axes = TextureAxes::of_triangle(turned, coordinates).expect("area");
                for (corner, at) in turned.into_iter().zip(coordinates) {
                    assert!(axes.at(corner).abs_diff_eq(at, error), "{corner} {}", axes.at(corner) - at);
                }
                // within the triangle, as far as a point there can be stored: 1e-12 of its size of 1e-3
                let inner = turned[0] * 0.5 + turned[1] * 0.25 + turned[2] * 0.25;
                let at = coordinates[0] * 0.5 + coordinates[1] * 0.25 + coordinates[2] * 0.25;
                assert!(axes.at(inner).abs_diff_eq(at, 1e-8), "{}", axes.at(inner) - at);
                let normal = (turned[1] - turned[0]).cross(turned[2] - turned[0]).normalize();
                assert!(axes.u.dot(normal).abs() <= 1e-9 * axes.u.length(), "within the plane of the triangle");
            }
        }
    }

    #[test]
    fn without_area_there_is_no_texture() {
        let coordinates = [DVec2::ZERO, DVec2::X, DVec2::Y];
        let flat = [DVec3::ZERO, DVec3::X, DVec3::X * 4.0];
        assert_eq!(TextureAxes::of_triangle(flat, coordinates), None);
        assert_eq!(TextureAxes::of_triangle([DVec3::ONE; 3], coordinates), None);
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
        assert_eq!(TextureAxes::of_triangle(corners, [DVec2::NAN, DVec2::X, DVec2::Y]), None);
    }

    #[test]
    fn a_texture_goes_with_what_is_moved() {
        let corners = [DVec3::new(3.0, 1.0, 2.0), DVec3::new(4.0, 1.5, 0.0), DVec3::new(3.0, 5.0, -1.0)];
        let anchored = TextureAxes::of_triangle(corners, [DVec2::ZERO, DVec2::X, DVec2::new(0.5, 2.0)]).expect("area");
        let plain = TextureAxes { anchor: None, unit: TextureUnit::Texels, ..anchored };
        let maps = [
            DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0)),
            DMat3::from_cols(DVec3::X, DVec3::new(2.0, 1.0, 0.0), DVec3::new(-0.5, 0.75, 1.0)),
            DMat3::from_cols(DVec3::new(0.0, 3.0, 0.0), DVec3::new(-2.0, 0.0, 1.0), DVec3::new(0.0, 0.5, 0.25)),
        ];
        for linear in maps {
            let map = Transform::new(linear, DVec3::new(10.0, -3.0, 0.5)).expect("a map");
            for axes in [anchored, plain] {
                let moved = axes.transformed(&map);
                for point in [DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0), corners[2]] {
                    let error = (moved.at(map.point(point)) - axes.at(point)).abs().max_element();
                    assert!(error < 1e-12, "{linear} {error}");
                }
                assert_eq!(moved.unit, axes.unit);
            }
        }
    }

    #[test]
    fn both_triangles_of_a_flat_face_have_one_texture() {
        let [a, b, c, d] = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(u, v)| DVec2::new(u, v));
        let place = |at: DVec2| DVec3::new(0.1, 0.7, 0.3) + at.x * DVec3::new(0.2, 0.1, 0.0) + at.y * DVec3::Z * 0.3;
        let axes = TextureAxes::of_triangle([a, b, c].map(place), [a, b, c]).expect("area");
        assert!(axes.fits([a, c, d].map(place), [a, c, d]));
        assert!(!axes.fits([a, c, d].map(place), [a, c, d + DVec2::new(0.0, 1e-9)]));
    }
}
