//! Convex bodies about the z axis: every circle is a regular polygon with a corner on the x axis.

use planecut_csg::{Brush, MaterialId};
use planecut_kernel::{DVec2, DVec3};

use super::simple::brush;
use crate::parameter::{
    ShapeError, apothem, direction, middle, not_negative, pieces, positive, refuse, segments as accepted_segments,
};

/// A face plane, as a normal and an offset.
type Plane = (DVec3, f64);

/// A sphere of `⌊(n + 1) / 2⌋` rings of `n` corners, flat on top and bottom.
///
/// # Errors
/// [`ShapeError::Parameter`] where the radius is not above 0 or the segments are not 3 to 10,000; [`ShapeError::TooLarge`] where it has more than 4,194,304 faces.
pub fn sphere(radius: f64, segments: u32, material: MaterialId) -> Result<Brush, ShapeError> {
    let (radius, segments) = (positive("radius", radius)?, accepted_segments("segments", segments)?);
    pieces(faces_of_sphere(segments))?;
    brush(sphere_planes(radius, segments, 0.0), material)
}

/// The convex hull of two spheres about `(0, 0, 0)` and `(0, 0, height)`.
///
/// # Errors
/// [`ShapeError::Parameter`] where the height is below 0, the radius is not above 0 or the segments are not 3 to 10,000; [`ShapeError::TooLarge`].
pub fn capsule(height: f64, radius: f64, segments: u32, material: MaterialId) -> Result<Brush, ShapeError> {
    let height = not_negative("height", height)?;
    let (radius, segments) = (positive("radius", radius)?, accepted_segments("segments", segments)?);
    pieces(faces_of_sphere(segments))?;
    brush(sphere_planes(radius, segments, height), material)
}

/// About how many faces a sphere has.
fn faces_of_sphere(segments: u32) -> u64 {
    u64::from(segments) * u64::from(segments.div_ceil(2))
}

/// The planes of a sphere whose upper half is lifted by `height`.
fn sphere_planes(radius: f64, segments: u32, height: f64) -> Vec<Plane> {
    let rings = segments.div_ceil(2);
    let cap = radius * latitude(1, 2 * rings).x;
    let mut planes = vec![(DVec3::Z, cap + height), (-DVec3::Z, cap)];
    let is_odd = rings % 2 == 1;
    for band in 1..rings {
        planes.extend(band_planes(radius, segments, height, band));
        if is_odd && band == rings / 2 && height > 0.0 {
            let sides = prism_sides(radius, segments);
            planes.extend(sides);
        }
    }
    planes
}

/// The direction at the polar angle `180° · part / whole`, as its distance along z and from the axis.
fn latitude(part: u32, whole: u32) -> DVec2 {
    direction(u64::from(part), 2 * u64::from(whole))
}

/// The planes between the rings `band − 1` and `band`, that is, about the polar angle `180° · band / rings`. With half a
/// step of `δ`, chords at `ρᵢ = r sin θᵢ cos(π/n)` and heights `r cos θᵢ`, the trapezoids lie on
/// `(sin θ cos φ, sin θ sin φ, cos(π/n) cos θ) · x = r cos(π/n) cos δ`.
fn band_planes(radius: f64, segments: u32, height: f64, band: u32) -> impl Iterator<Item = Plane> {
    let rings = segments.div_ceil(2);
    let (at, chord) = (latitude(band, rings), apothem(segments));
    let offset = radius * (chord * latitude(1, 2 * rings).x);
    let slope = chord * at.x;
    (0..segments).map(move |k| {
        let outward = middle(k, segments) * at.y;
        let scale = outward.abs().max_element().max(slope.abs()).recip();
        let normal = outward.extend(slope) * scale;
        (normal, offset * scale + normal.z.max(0.0) * height)
    })
}

/// A cylinder or frustum of a cone along z from 0, of `segments` sides; one of the radii may be 0.
///
/// # Errors
/// [`ShapeError::Parameter`] where the height is not above 0, a radius is below 0, both radii are 0, or the segments are
/// not 3 to 10,000.
pub fn cylinder(
    height: f64,
    radius: f64,
    top_radius: f64,
    segments: u32,
    material: MaterialId,
) -> Result<Brush, ShapeError> {
    let radius = not_negative("radius", radius)?;
    let top_radius = not_negative("top_radius", top_radius)?;
    if radius == 0.0 && top_radius == 0.0 {
        return Err(refuse("radius", &0.0, &"a number above 0, as top_radius is 0"));
    }
    frustum(positive("height", height)?, [radius, top_radius], accepted_segments("segments", segments)?, material)
}

/// A cone along z from 0, its tip on top.
///
/// # Errors
/// [`ShapeError::Parameter`] where height or radius are not above 0 or the segments are not 3 to 10,000.
pub fn cone(height: f64, radius: f64, segments: u32, material: MaterialId) -> Result<Brush, ShapeError> {
    let (height, radius) = (positive("height", height)?, positive("radius", radius)?);
    frustum(height, [radius, 0.0], accepted_segments("segments", segments)?, material)
}

/// A prism along z from 0 over a regular polygon.
///
/// # Errors
/// [`ShapeError::Parameter`] where height or radius are not above 0 or the sides are not 3 to 10,000.
pub fn prism(height: f64, radius: f64, sides: u32, material: MaterialId) -> Result<Brush, ShapeError> {
    let (height, radius) = (positive("height", height)?, positive("radius", radius)?);
    frustum(height, [radius, radius], accepted_segments("sides", sides)?, material)
}

/// A pyramid along z from 0 over a regular polygon, its tip on top.
///
/// # Errors
/// [`ShapeError::Parameter`] where height or radius are not above 0 or the sides are not 3 to 10,000.
pub fn pyramid(height: f64, radius: f64, sides: u32, material: MaterialId) -> Result<Brush, ShapeError> {
    let (height, radius) = (positive("height", height)?, positive("radius", radius)?);
    frustum(height, [radius, 0.0], accepted_segments("sides", sides)?, material)
}

fn frustum(height: f64, radii: [f64; 2], n: u32, material: MaterialId) -> Result<Brush, ShapeError> {
    let sides: Vec<Plane> = match radii {
        [bottom, top] if bottom == top => prism_sides(bottom, n).collect(),
        [bottom, 0.0] => cone_sides(height, bottom, n).collect(),
        radii => frustum_sides(height, radii, n).collect(),
    };
    let bottom = (radii[0] > 0.0).then_some((-DVec3::Z, 0.0));
    let top = (radii[1] > 0.0).then_some((DVec3::Z, height));
    brush(bottom.into_iter().chain(top).chain(sides), material)
}

/// The direction of the middle of side `k`, scaled to a largest component of 1, and the chord's distance from the axis in
/// the same scale for a radius of 1. For four sides these are whole numbers.
fn side(k: u32, n: u32) -> (DVec2, f64) {
    let outward = middle(k, n);
    let scale = outward.abs().max_element();
    (outward / scale, apothem(n) / scale)
}

fn prism_sides(radius: f64, n: u32) -> impl Iterator<Item = Plane> {
    (0..n).map(move |k| {
        let (outward, chord) = side(k, n);
        (outward.extend(0.0), radius * chord)
    })
}

/// The chord's distance from the axis falls from `bottom · chord` to `top · chord` over the height.
fn frustum_sides(height: f64, [bottom, top]: [f64; 2], n: u32) -> impl Iterator<Item = Plane> {
    (0..n).map(move |k| {
        let (outward, chord) = side(k, n);
        ((outward * height).extend((bottom - top) * chord), (bottom * height) * chord)
    })
}

/// The sides of a cone all pass through its tip, exactly.
fn cone_sides(height: f64, radius: f64, n: u32) -> impl Iterator<Item = Plane> {
    let is_exact = n == 4 && is_exact_product(height, radius);
    (0..n).map(move |k| {
        let (outward, chord) = side(k, n);
        if is_exact {
            ((outward * height).extend(radius), height * radius)
        } else {
            ((outward * (height / (radius * chord))).extend(1.0), height)
        }
    })
}

fn is_exact_product(a: f64, b: f64) -> bool {
    a.mul_add(b, -(a * b)) == 0.0
}
