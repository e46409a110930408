//! A perspective camera that frames a model.
//!
//! Three kinds of coordinates: *world* (the input's units), *view* (x right, y up, z away from the eye, which is the
//! origin; left-handed; one unit is the model's radius) and *screen* (pixels from the top left corner, with the reciprocal view depth
//! `w`, which unlike the depth itself is linear across the picture).

use glam::{DMat3, DVec3, Vec3};

/// Tangent of half the view angle along the shorter side of the picture, the longer side gets more.
const HALF_VIEW_TANGENT: f64 = 0.25;

/// Upper bound of that tangent for the longer side: very long pictures would look distorted at their ends.
const MAX_HALF_VIEW_TANGENT: f64 = 0.7;

/// Part of the picture that the model may fill each way; the rest is margin.
const FILL: f64 = 0.88;

/// Distance from the eye to the nearest vertex, at least, in model radii.
const MIN_DISTANCE: f64 = 0.1;

/// How often the view is centred; other points can become the outermost ones each time, though hardly any do.
const CENTERING_STEPS: usize = 2;

/// A vertex on the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ScreenPoint {
    /// Pixels from the left edge.
    pub(super) x: f32,
    /// Pixels from the top edge.
    pub(super) y: f32,
    /// Reciprocal view depth; larger is nearer.
    pub(super) w: f32,
}

impl ScreenPoint {
    /// The same point where a pixel is `factor` samples wide.
    pub(super) fn magnified(self, factor: f32) -> Self {
        Self { x: self.x * factor, y: self.y * factor, w: self.w }
    }
}

/// Where the picture is taken from, and how large it is.
#[derive(Debug, Clone)]
pub(super) struct Camera {
    /// Middle of the box around the model, in world coordinates.
    center: DVec3,
    /// Model radii per world unit.
    per_radius: f64,
    /// World directions of the view axes, as columns.
    axes: DMat3,
    /// The eye in unshifted view coordinates.
    eye: DVec3,
    /// Half the picture, in pixels.
    half_size: [f64; 2],
    /// View units at depth 1 for one pixel.
    pixel: f64,
}

impl Camera {
    /// A camera that looks down at `points` from the given side, so that all of them are on the picture with a margin.
    /// Angles are in degrees: `azimuth` from the x axis towards the y axis, `elevation` above the horizon.
    ///
    /// `None` when the points have no extent.
    pub(super) fn framing(points: &[DVec3], [azimuth, elevation]: [f64; 2], size: [u32; 2]) -> Option<Self> {
        let first = *points.first()?;
        let (min, max) = points.iter().fold((first, first), |(min, max), &p| (min.min(p), max.max(p)));
        // Halved before subtracting, so that no finite box overflows.
        let (center, half) = (min * 0.5 + max * 0.5, max * 0.5 - min * 0.5);
        let largest = half.max_element();
        // Scaled before the length is taken: squares of tiny or huge extents leave the range of numbers.
        let per_radius = 1.0 / ((half / largest).length() * largest);
        if !per_radius.is_normal() {
            return None;
        }
        let half_size = size.map(|side| f64::from(side) / 2.0);
        let short = half_size[0].min(half_size[1]);
        let long = half_size[0].max(half_size[1]);
        let pixel = (HALF_VIEW_TANGENT / short).min(MAX_HALF_VIEW_TANGENT / long);
        let mut camera = Self {
            center,
            per_radius,
            axes: view_axes(azimuth.to_radians(), elevation.clamp(-89.0, 89.0).to_radians()),
            eye: DVec3::ZERO,
            half_size,
            pixel,
        };
        camera.eye = camera.framing_eye(points);
        for _ in 0..CENTERING_STEPS {
            camera.center_on(points);
        }
        Some(camera)
    }

    /// Moves the eye sideways so that what were the outermost points each way are equally far from the middle.
    fn center_on(&mut self, points: &[DVec3]) {
        let first = points.first().map_or(DVec3::Z, |&p| self.to_view(p));
        // For each axis the points that are furthest left and right, or down and up.
        let mut ends = [[first; 2]; 2];
        for &point in points {
            let view = self.to_view(point);
            for axis in 0..2 {
                let [low, high] = &mut ends[axis];
                if view[axis] * low.z < low[axis] * view.z {
                    *low = view;
                }
                if view[axis] * high.z > high[axis] * view.z {
                    *high = view;
                }
            }
        }
        for axis in 0..2 {
            let [low, high] = ends[axis];
            self.eye[axis] += (low[axis] * high.z + high[axis] * low.z) / (low.z + high.z);
        }
    }

    /// The eye that sees all points between four planes through it, tight for at least one of the two pairs.
    fn framing_eye(&self, points: &[DVec3]) -> DVec3 {
        let tangents = self.half_size.map(|half| half * self.pixel * FILL);
        // Largest value of ±x − t·z (and ±y − t·z): the planes' offsets.
        let mut support = [[f64::NEG_INFINITY; 2]; 2];
        let mut nearest = f64::INFINITY;
        for &point in points {
            let view = self.to_view(point);
            for axis in 0..2 {
                let shear = tangents[axis] * view.z;
                support[axis][0] = support[axis][0].max(view[axis] - shear);
                support[axis][1] = support[axis][1].max(-view[axis] - shear);
            }
            nearest = nearest.min(view.z);
        }
        let depth = |axis: usize| -(support[axis][0] + support[axis][1]) / (2.0 * tangents[axis]);
        let middle = |axis: usize| (support[axis][0] - support[axis][1]) / 2.0;
        DVec3::new(middle(0), middle(1), depth(0).min(depth(1)).min(nearest - MIN_DISTANCE))
    }

    /// View coordinates of a world point.
    pub(super) fn to_view(&self, world: DVec3) -> DVec3 {
        self.axes.transpose() * ((world - self.center) * self.per_radius) - self.eye
    }

    /// View direction of a world direction.
    pub(super) fn direction_to_view(&self, world: DVec3) -> DVec3 {
        self.axes.transpose() * world
    }

    /// Screen coordinates of a point in view coordinates.
    pub(super) fn project(&self, view: DVec3) -> ScreenPoint {
        let w = 1.0 / view.z;
        let x = self.half_size[0] + view.x * w / self.pixel;
        let y = self.half_size[1] - view.y * w / self.pixel;
        ScreenPoint { x: x as f32, y: y as f32, w: w as f32 }
    }

    /// View coordinates, at depth 1, of a point on the picture.
    pub(super) fn ray(&self, x: f32, y: f32) -> Vec3 {
        let [half_width, half_height] = self.half_size.map(|half| half as f32);
        let pixel = self.pixel as f32;
        Vec3::new((x - half_width) * pixel, (half_height - y) * pixel, 1.0)
    }

    /// Pixels that a length of one view unit spans at depth 1.
    pub(super) fn pixels_per_unit(&self) -> f32 {
        (1.0 / self.pixel) as f32
    }
}

fn view_axes(azimuth: f64, elevation: f64) -> DMat3 {
    let towards_eye = DVec3::new(elevation.cos() * azimuth.cos(), elevation.cos() * azimuth.sin(), elevation.sin());
    let right = DVec3::new(-azimuth.sin(), azimuth.cos(), 0.0);
    DMat3::from_cols(right, towards_eye.cross(right), -towards_eye)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points fill the picture as far as the margin, one way at least, whatever the proportions and the distance.
    #[test]
    fn every_point_is_framed_tightly() {
        let boxes = [DVec3::ONE, DVec3::new(100.0, 1.0, 1.0), DVec3::new(0.0, 0.0, 5.0), DVec3::new(1e-9, 3e-9, 0.0)];
        for half in boxes.into_iter().chain([DVec3::splat(1e200), DVec3::splat(1e-200)]) {
            for (offset, size) in [(0.0, [1280, 960]), (1e3, [17, 900]), (-1e3, [16_384, 2])] {
                let corner = |i: u32| DVec3::from([0, 1, 2].map(|a| if i >> a & 1 == 1 { 1.0 } else { -1.0 }));
                let points: Vec<_> = (0..8).map(|i| half * (corner(i) + offset)).collect();
                let camera = Camera::framing(&points, [-60.0, 30.0], size).expect("an extent");
                let fill = points.iter().fold([0.0_f64; 2], |fill, &p| {
                    let seen = camera.project(camera.to_view(p));
                    assert!(seen.w > 0.0);
                    let part = |value: f32, side: u32| (f64::from(value) / f64::from(side) * 2.0 - 1.0).abs();
                    [fill[0].max(part(seen.x, size[0])), fill[1].max(part(seen.y, size[1]))]
                });
                let largest = fill[0].max(fill[1]);
                assert!(largest < FILL + 0.02, "{half} at {offset}, {size:?}: {fill:?}");
            }
        }
    }

    #[test]
    fn points_without_extent_have_no_camera() {
        assert!(Camera::framing(&[], [0.0, 0.0], [10, 10]).is_none());
        assert!(Camera::framing(&[DVec3::ONE; 3], [0.0, 0.0], [10, 10]).is_none());
    }

    #[test]
    fn rays_undo_the_projection() {
        let points = [DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0)];
        let camera = Camera::framing(&points, [20.0, 40.0], [300, 200]).expect("an extent");
        for point in points {
            let view = camera.to_view(point);
            let seen = camera.project(view);
            let back = camera.ray(seen.x, seen.y) / seen.w;
            assert!(back.distance(view.as_vec3()) < 1e-5);
        }
    }
}
