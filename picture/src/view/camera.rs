//! A camera that frames a model.
//!
//! Three kinds of coordinates: *world* (the input's units), *view* (x right, y up, z away from the eye, which is the
//! origin; left-handed; one unit is the model's radius) and *screen* (pixels from the top left corner, with a nearness).
//! [`Lens`] knows how the last two correspond.

use std::f64::consts::{PI, TAU};

use glam::{DMat3, DVec3};

use crate::input::bounds::{box_around, middle};
use crate::input::options::{CameraKind, PreviewOptions, view_directions};
use crate::view::lens::{Lens, ORTHOGRAPHIC_DISTANCE, ScreenPoint};

/// Tangent of half the view angle along the shorter side of the picture, the longer side gets more.
const HALF_VIEW_TANGENT: f64 = 0.25;

/// Upper bound of that tangent for the longer side: very long pictures would look distorted at their ends.
const MAX_HALF_VIEW_TANGENT: f64 = 0.7;

/// Part of the picture that the model may fill each way; the rest is margin.
const FILL: f64 = 0.88;

/// The same where dimensions stand around the model.
const FILL_BESIDE_LABELS: f64 = 0.76;

/// Distance from the eye to the nearest vertex, at least, in model radii.
const MIN_DISTANCE: f64 = 0.1;

/// How often the view is centred; other points can become the outermost ones each time, though hardly any do.
const CENTERING_STEPS: usize = 2;

/// Layers and corners of the rings that stand for a model that turns about the vertical.
const RINGS: usize = 48;
const RING_CORNERS: usize = 48;

/// Where the picture is taken from, and how large it is.
#[derive(Debug, Clone)]
pub(crate) struct Camera {
    /// Middle of the box around the model, in world coordinates.
    center: DVec3,
    /// Model radii per world unit.
    per_radius: f64,
    /// World directions of the view axes, as columns.
    axes: DMat3,
    /// The eye in unshifted view coordinates.
    eye: DVec3,
    pub(crate) lens: Lens,
}

impl Camera {
    /// A camera that looks at `points` from the side that the options state, so that all of them are on the picture with a margin.
    ///
    /// `None` when the points have no extent.
    pub(crate) fn framing(points: &[DVec3], options: &PreviewOptions) -> Option<Self> {
        let bounds @ [min, max] = box_around(points.iter().copied())?;
        let (center, half) = (middle(bounds), max * 0.5 - min * 0.5);
        let largest = half.max_element();
        // Scaled before the length is taken: squares of tiny or huge extents leave the range of numbers.
        let per_radius = 1.0 / ((half / largest).length() * largest);
        if !per_radius.is_normal() {
            return None;
        }
        let half_size = [options.width, options.height].map(|side| f64::from(side) / 2.0);
        let axes = view_axes(options.azimuth, options.elevation);
        let lens = Lens::new(options.camera, half_size, 1.0);
        let mut camera = Self { center, per_radius, axes, eye: DVec3::ZERO, lens };
        let fill = if options.dimensions { FILL_BESIDE_LABELS } else { FILL };
        match options.camera {
            CameraKind::Perspective => camera.frame_in_perspective(points, half_size, fill),
            CameraKind::Orthographic => camera.frame_in_parallel(points, half_size, fill),
        }
        Some(camera)
    }

    /// A camera that frames `points` from all sides at once: it may be [turned](Self::turned) about the vertical through their middle.
    pub(crate) fn framing_all_around(points: &[DVec3], options: &PreviewOptions) -> Option<Self> {
        Self::framing(&rings_around(points), options)
    }

    /// The same camera looking from another azimuth, in degrees.
    pub(crate) fn turned(&self, azimuth: f64, elevation: f64) -> Self {
        Self { axes: view_axes(azimuth, elevation), ..self.clone() }
    }

    fn frame_in_perspective(&mut self, points: &[DVec3], half_size: [f64; 2], fill: f64) {
        let (short, long) = (half_size[0].min(half_size[1]), half_size[0].max(half_size[1]));
        let pixel = (HALF_VIEW_TANGENT / short).min(MAX_HALF_VIEW_TANGENT / long);
        self.lens = Lens::new(CameraKind::Perspective, half_size, pixel);
        self.eye = self.framing_eye(points, half_size.map(|half| half * pixel * fill));
        for _ in 0..CENTERING_STEPS {
            self.center_on(points);
        }
    }

    fn frame_in_parallel(&mut self, points: &[DVec3], half_size: [f64; 2], fill: f64) {
        let seen = points.iter().map(|&point| self.to_view(point));
        let [min, max] = box_around(seen).unwrap_or_default();
        let extent = max - min;
        let pixel = (extent.x / half_size[0]).max(extent.y / half_size[1]) / (2.0 * fill);
        // What has no extent across the view is small, not infinitely large.
        let pixel = pixel.max(1e-3 / half_size[0].max(half_size[1]));
        self.lens = Lens::new(CameraKind::Orthographic, half_size, pixel);
        self.eye = ((min + max) * 0.5).with_z(-ORTHOGRAPHIC_DISTANCE);
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

    /// The eye that sees all points between four planes through it, which rise by `tangents`; tight for at least one of the two
    /// pairs.
    fn framing_eye(&self, points: &[DVec3], tangents: [f64; 2]) -> DVec3 {
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
    pub(crate) fn to_view(&self, world: DVec3) -> DVec3 {
        self.axes.transpose() * ((world - self.center) * self.per_radius) - self.eye
    }

    /// View direction of a world direction.
    pub(crate) fn direction_to_view(&self, world: DVec3) -> DVec3 {
        self.axes.transpose() * world
    }

    /// Where a world point is seen.
    pub(crate) fn see(&self, world: DVec3) -> ScreenPoint {
        self.lens.project(self.to_view(world))
    }

    /// World units per unit of view coordinates.
    pub(crate) fn radius(&self) -> f64 {
        1.0 / self.per_radius
    }

    /// Pixels that a world unit across the view spans, at the depth of the model's middle.
    pub(crate) fn pixels_per_world_unit(&self) -> f64 {
        let depth = self.to_view(self.center).z;
        f64::from(self.lens.pixels_per_unit(depth as f32)) * self.per_radius
    }
}

/// World directions of the view axes, as columns; angles in degrees.
fn view_axes(azimuth: f64, elevation: f64) -> DMat3 {
    let [right, towards_eye] = view_directions(azimuth, elevation);
    DMat3::from_cols(right, towards_eye.cross(right), -towards_eye)
}

/// Rings that enclose all points however they are turned about the vertical through the middle of their box.
fn rings_around(points: &[DVec3]) -> Vec<DVec3> {
    let Some(bounds @ [min, max]) = box_around(points.iter().copied()) else { return Vec::new() };
    let middle = middle(bounds);
    let height = (max.z - min.z).max(f64::MIN_POSITIVE);
    let mut radii = [0.0_f64; RINGS];
    for point in points {
        let layer = ((point.z - min.z) / height * RINGS as f64) as usize;
        let radius = &mut radii[layer.min(RINGS - 1)];
        *radius = radius.max((point.x - middle.x).hypot(point.y - middle.y));
    }
    // A ring has corners that lie outside the circle, so that its sides do not cut into it.
    let beyond = 1.0 / libm::cos(PI / RING_CORNERS as f64);
    let levels = (0..=RINGS).map(|layer| {
        let radius = radii[layer.min(RINGS - 1)].max(radii[layer.saturating_sub(1)]);
        (min.z + height * layer as f64 / RINGS as f64, radius * beyond)
    });
    let ring = |(z, radius): (f64, f64)| {
        (0..RING_CORNERS).map(move |corner| {
            let (sine, cosine) = libm::sincos(corner as f64 * TAU / RING_CORNERS as f64);
            DVec3::new(middle.x + radius * cosine, middle.y + radius * sine, z)
        })
    };
    levels.flat_map(ring).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const KINDS: [CameraKind; 2] = [CameraKind::Perspective, CameraKind::Orthographic];

    fn options(camera: CameraKind, [width, height]: [u32; 2], [azimuth, elevation]: [f64; 2]) -> PreviewOptions {
        PreviewOptions { camera, width, height, azimuth, elevation, ..PreviewOptions::default() }
    }

    fn box_corners(half: DVec3, offset: f64) -> Vec<DVec3> {
        let corner = |i: u32| DVec3::from([0, 1, 2].map(|a| if i >> a & 1 == 1 { 1.0 } else { -1.0 }));
        (0..8).map(|i| half * (corner(i) + offset)).collect()
    }

    /// The part of half the picture, each way, that points fill as seen from the middle.
    fn fill(camera: &Camera, points: &[DVec3], size: [u32; 2]) -> [f64; 2] {
        points.iter().fold([0.0_f64; 2], |fill, &p| {
            let seen = camera.see(p);
            assert!(seen.w > 0.0);
            let part = |value: f32, side: u32| (f64::from(value) / f64::from(side) * 2.0 - 1.0).abs();
            [fill[0].max(part(seen.x, size[0])), fill[1].max(part(seen.y, size[1]))]
        })
    }

    /// Points fill the picture as far as the margin, one way at least, whatever the proportions and the distance.
    #[test]
    fn every_point_is_framed_tightly() {
        let boxes = [DVec3::ONE, DVec3::new(100.0, 1.0, 1.0), DVec3::new(0.0, 0.0, 5.0), DVec3::new(1e-9, 3e-9, 0.0)];
        for half in boxes.into_iter().chain([DVec3::splat(1e200), DVec3::splat(1e-200)]) {
            for (offset, size) in [(0.0, [1280, 960]), (1e3, [17, 900]), (-1e3, [16_384, 2])] {
                for kind in KINDS {
                    let points = box_corners(half, offset);
                    let camera = Camera::framing(&points, &options(kind, size, [-60.0, 30.0])).expect("an extent");
                    let fill = fill(&camera, &points, size);
                    let largest = fill[0].max(fill[1]);
                    assert!(largest < FILL + 0.02, "{kind:?} {half} at {offset}, {size:?}: {fill:?}");
                    let is_tight = largest > FILL - 0.02;
                    assert!(is_tight || kind == CameraKind::Perspective, "{half} at {offset}, {size:?}: {fill:?}");
                }
            }
        }
    }

    /// A camera that goes around sees all of the model from every side, and at most sides does not waste the picture.
    #[test]
    fn a_turning_model_stays_on_the_picture() {
        let size = [400, 300];
        for kind in KINDS {
            let points = box_corners(DVec3::new(3.0, 1.0, 0.5), 2.0);
            let camera = Camera::framing_all_around(&points, &options(kind, size, [10.0, 25.0])).expect("an extent");
            let fills: Vec<f64> = (0..36)
                .map(|step| fill(&camera.turned(f64::from(step) * 10.0, 25.0), &points, size))
                .map(|[x, y]| x.max(y))
                .collect();
            assert!(fills.iter().all(|&part| part < FILL + 0.02), "{kind:?}: {fills:?}");
            assert!(fills.iter().any(|&part| part > FILL - 0.06), "{kind:?}: {fills:?}");
        }
    }

    #[test]
    fn points_without_extent_have_no_camera() {
        let options = options(CameraKind::Perspective, [10, 10], [0.0, 0.0]);
        assert!(Camera::framing(&[], &options).is_none());
        assert!(Camera::framing(&[DVec3::ONE; 3], &options).is_none());
    }

    /// Seen from straight above, x points right and y up, as on a map.
    #[test]
    fn the_view_from_above_is_a_plan() {
        let points = box_corners(DVec3::ONE, 0.0);
        let camera =
            Camera::framing(&points, &options(CameraKind::Orthographic, [100, 100], [-90.0, 90.0])).expect("an extent");
        let [origin, x, y, z] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|point| camera.see(point));
        assert!(x.x > origin.x + 1.0 && (x.y - origin.y).abs() < 1e-3);
        assert!(y.y < origin.y - 1.0 && (y.x - origin.x).abs() < 1e-3);
        assert!((z.place() - origin.place()).length() < 1e-3 && z.w > origin.w);
    }
}
