//! A second opinion on what is seen where: every triangle at every pixel, in double precision.

use glam::{DMat3, DMat4, DVec2, DVec3, DVec4};
use planecut_csg::Mesh;
use planecut_picture::{Buffers, PreviewOptions};

use crate::support::places;

/// World directions to the right, upwards and away from the eye, as the options' documentation says.
pub(crate) fn axes(options: &PreviewOptions) -> DMat3 {
    let (azimuth, elevation) = (options.azimuth.to_radians(), options.elevation.to_radians());
    let right = DVec3::new(-azimuth.sin(), azimuth.cos(), 0.0);
    let around = DVec3::new(azimuth.cos(), azimuth.sin(), 0.0);
    let towards_eye = around * elevation.cos() + DVec3::Z * elevation.sin();
    let up = DVec3::Z * elevation.cos() - around * elevation.sin();
    DMat3::from_cols(right, up, -towards_eye)
}

/// Where the vertices of a mesh are seen: pixels from the left and from the top, and the depth.
pub(crate) struct Seen {
    pub(crate) points: Vec<DVec3>,
    /// With perspective 1 / depth is linear across a triangle, otherwise the depth is.
    pub(crate) is_perspective: bool,
    #[cfg_attr(not(feature = "text"), expect(dead_code, reason = "only labels are measured by it"))]
    pub(crate) pixels_per_unit: f64,
}

/// An orthographic picture: the model fills 88 % of it one way, and its middle is the picture's.
pub(crate) fn orthographic(mesh: &Mesh, options: &PreviewOptions) -> Seen {
    let axes = axes(options).transpose();
    let turned: Vec<DVec3> = mesh.positions.iter().map(|&point| axes * point).collect();
    let min = turned.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let max = turned.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    let size = DVec2::new(options.width.into(), options.height.into());
    let pixels_per_unit = 0.88 * (size / (max - min).truncate()).min_element();
    let place = |point: &DVec3| {
        let across = (*point - (min + max) / 2.0).truncate() * pixels_per_unit;
        (size / 2.0 + DVec2::new(across.x, -across.y)).extend(point.z)
    };
    Seen { points: turned.iter().map(place).collect(), is_perspective: false, pixels_per_unit }
}

/// A picture taken from an eye, where a pixel in its middle spans `pixel` at depth 1.
pub(crate) fn perspective(mesh: &Mesh, options: &PreviewOptions, eye: DVec3, pixel: f64) -> Seen {
    let axes = axes(options).transpose();
    let half = DVec2::new(options.width.into(), options.height.into()) / 2.0;
    let place = |&point: &DVec3| {
        let view = axes * (point - eye);
        let across = view.truncate() / (view.z * pixel);
        (half + DVec2::new(across.x, -across.y)).extend(view.z)
    };
    let points = mesh.positions.iter().map(place).collect();
    Seen { points, is_perspective: true, pixels_per_unit: f64::NAN }
}

/// The eye and the width of a pixel at depth 1 that put the points of a picture on the planes of their faces as well as any: each
/// pixel makes a linear equation. The largest distance of a point from its face's plane comes along.
pub(crate) fn eye_of(mesh: &Mesh, options: &PreviewOptions, found: &Buffers) -> (DVec3, f64, f64) {
    let axes = axes(options);
    let half = DVec2::new(options.width.into(), options.height.into()) / 2.0;
    let plane = |face: u32| {
        let triangle = mesh.triangle_faces.iter().position(|&other| other == face).expect("a triangle");
        let normal = mesh.faces[face as usize].normal;
        (normal, normal.dot(mesh.positions[mesh.triangles[triangle][0] as usize]))
    };
    let seen = places(found.width, found.height).zip(found.faces.iter().zip(&found.depth));
    let equations: Vec<(DVec4, f64)> = seen
        .filter_map(|([x, y], (face, &depth))| {
            let (normal, distance) = plane((*face)?);
            let across = DVec2::new(f64::from(x) + 0.5 - half.x, half.y - f64::from(y) - 0.5) * depth;
            let sideways = axes.x_axis * across.x + axes.y_axis * across.y;
            Some((normal.extend(normal.dot(sideways)), distance - depth * normal.dot(axes.z_axis)))
        })
        .collect();
    let (mut square, mut right) = (DMat4::ZERO, DVec4::ZERO);
    for &(row, value) in &equations {
        square += DMat4::from_cols(row * row.x, row * row.y, row * row.z, row * row.w);
        right += row * value;
    }
    let solution = square.inverse() * right;
    let worst = equations.iter().map(|(row, value)| (row.dot(solution) - value).abs()).fold(0.0, f64::max);
    (solution.truncate(), solution.w, worst)
}

/// What covers the middle of a pixel.
pub(crate) struct Hits {
    /// Depths and faces of all front sides there.
    pub(crate) layers: Vec<(f64, u32)>,
    /// Pixels to the nearest side of any triangle.
    pub(crate) from_edge: f64,
}

impl Hits {
    pub(crate) fn nearest(&self) -> Option<(f64, u32)> {
        self.layers.iter().copied().min_by(|a, b| a.0.total_cmp(&b.0))
    }
}

/// What covers a place of the picture.
pub(crate) fn hits(mesh: &Mesh, seen: &Seen, at: DVec2) -> Hits {
    let mut found = Hits { layers: Vec::new(), from_edge: f64::INFINITY };
    for (triangle, &face) in mesh.triangles.iter().zip(&mesh.triangle_faces) {
        let [a, b, c] = triangle.map(|corner| seen.points[corner as usize]);
        let places = [a, b, c].map(DVec3::truncate);
        for i in 0..3 {
            found.from_edge = found.from_edge.min(distance_to_side(at, places[i], places[(i + 1) % 3]));
        }
        let area = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p);
        let whole = area(places[0], places[1], places[2]);
        // The y axis points down: what is counter-clockwise as seen has a negative area.
        if whole >= 0.0 {
            continue;
        }
        let parts = [(1, 2), (2, 0), (0, 1)].map(|(i, j)| area(at, places[i], places[j]) / whole);
        if parts.iter().all(|&part| part >= 0.0) {
            let depths = DVec3::new(a.z, b.z, c.z);
            let parts = DVec3::from(parts);
            let depth = if seen.is_perspective { 1.0 / parts.dot(depths.recip()) } else { parts.dot(depths) };
            found.layers.push((depth, face));
        }
    }
    found
}

/// Distance of a point from a line between two points.
fn distance_to_side(at: DVec2, a: DVec2, b: DVec2) -> f64 {
    let along = b - a;
    let part = ((at - a).dot(along) / along.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    at.distance(a + along * part)
}
