//! Cast shadows: the model drawn once from the light's side, as a map of what the light reaches first.

use glam::{Mat3, Vec3};

use crate::raster::Raster;
use crate::scene::Scene;
use crate::view::lens::ScreenPoint;

/// Texels along a side of the map.
const SIDE: f32 = 1024.0;

/// Texels around the model that stay empty, so that looking up beyond it finds nothing.
const BORDER: f32 = 2.0;

/// Half the width of a shadow's soft border, in model radii.
const SOFTNESS: f32 = 0.014;

/// A surface is in shadow only when something is nearer to the light by this many texels.
const BIAS: f32 = 1.6;

/// Steepest slope towards the light that the bias follows; steeper surfaces get next to no direct light anyway.
const MAX_SLOPE: f32 = 6.0;

/// Where the light is looked for around a point: a spiral of equal areas (Vogel 1979) on the unit disk.
const TAPS: usize = 8;

/// Distances of surfaces from the light.
pub(crate) struct ShadowMap {
    map: Raster,
    /// View directions of the map's axes and to the light, as rows.
    axes: Mat3,
    /// Map coordinates of the view origin.
    origin: Vec3,
    /// Texels per model radius.
    scale: f32,
}

impl ShadowMap {
    pub(crate) fn new(scene: &Scene<'_>) -> Self {
        let (u, v) = scene.light.any_orthonormal_pair();
        // Seen from the light, like any picture: x to the right, y down, heights towards the viewer. That is a left-handed
        // frame, and so is that of the view coordinates, so the light's right-handed pair serves as it is.
        let axes = Mat3::from_cols(u, v, scene.light).transpose();
        let turned = scene.view.iter().map(|&p| axes * p);
        let (min, max) = turned.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)));
        let extent = (max - min).truncate().max_element().max(f32::MIN_POSITIVE);
        let scale = (SIDE - 2.0 * BORDER) / extent;
        // Heights start at 1, since 0 means that nothing is there.
        let origin = Vec3::new(BORDER - min.x * scale, BORDER - min.y * scale, 1.0 - min.z);
        let mut shadows = Self { map: Raster::default(), axes, origin, scale };
        let to_point = |place: Vec3| ScreenPoint { x: place.x, y: place.y, w: place.z };
        let points: Vec<_> = scene.view.iter().map(|&p| to_point(shadows.place(p))).collect();
        shadows.map = Raster::draw(scene.triangles([SIDE as usize; 2], &points));
        shadows
    }

    /// Column and row on the map, and height towards the light.
    fn place(&self, view: Vec3) -> Vec3 {
        let turned = self.axes * view;
        Vec3::new(turned.x * self.scale, turned.y * self.scale, turned.z) + self.origin
    }

    /// The part of the key light that reaches a point, 0 to 1. `turn` is a unit vector (cosine, sine) by which the pattern
    /// of taps is turned.
    pub(crate) fn lit(&self, point: Vec3, normal: Vec3, turn: [f32; 2]) -> f32 {
        let place = self.place(point);
        let facing = self.axes * normal;
        // Height that the surface itself gains per model radius along the map's axes.
        let slope = (-facing.truncate() / facing.z.max(1e-3)).clamp_length_max(MAX_SLOPE);
        let bias = BIAS / self.scale * (1.0 + slope.length());
        let radius = SOFTNESS * self.scale;
        let mut free = 0;
        for [x, y] in disk_taps() {
            let [dx, dy] = [(x * turn[0] - y * turn[1]) * radius, (x * turn[1] + y * turn[0]) * radius];
            let own = place.z + (slope.x * dx + slope.y * dy) / self.scale;
            let (x, y) = (place.x + dx, place.y + dy);
            let inside = (0.0..SIDE).contains(&x) && (0.0..SIDE).contains(&y);
            free += u32::from(!inside || self.map.at(x, y).0 <= own + bias);
        }
        free as f32 / TAPS as f32
    }
}

fn disk_taps() -> [[f32; 2]; TAPS] {
    // cos and sin of multiples of the golden angle, times the square root of (i + ½) / 8.
    [
        [0.25, 0.0],
        [-0.319_290, 0.292_496],
        [0.048_872, -0.556_877],
        [0.402_445, 0.524_918],
        [-0.738_535, -0.130_636],
        [0.699_605, -0.445_031],
        [-0.234_004, 0.870_484],
        [-0.446_271, -0.859_268],
    ]
}
