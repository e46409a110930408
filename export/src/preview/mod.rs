//! Preview pictures, drawn without a graphics card.
//!
//! Way of a [`subject`] through this folder: a [`camera`] frames it ([`lens`] is the projection), [`scene`] brings it into view
//! coordinates and colours its faces, [`shade`] finds what is seen and how much light gets there, [`lines`] finds the edges worth
//! drawing, [`paint`] makes pixels of all that, and [`labels`] writes beside it, on a [`canvas`]. [`buffers`] tells what is behind the
//! pixels, and [`sequence`] makes turntables and contact sheets of several pictures. [`raster`] is the z-buffer that all of these share.
//! Numbers that are a matter of taste are in [`style`].

mod buffers;
mod camera;
mod canvas;
mod labels;
mod lens;
mod lines;
mod options;
mod paint;
mod picture;
mod raster;
mod scene;
mod sequence;
mod shade;
mod style;
mod subject;

use glam::DVec3;

pub use self::buffers::{Buffers, render_buffers};
use self::camera::Camera;
use self::labels::draw_labels;
use self::lines::edges::feature_lines;
pub use self::options::{Background, CameraKind, MAX_IMAGE_SIDE, PreviewOptions};
use self::paint::compose::{Layers, compose, compose_background};
pub use self::picture::Picture;
use self::scene::Scene;
pub use self::sequence::animation::{AnimationFormat, AnimationWriter};
pub use self::sequence::sheet::{SheetColors, SheetLayout, Tile, contact_sheet, sheet_layout};
pub use self::sequence::turntable::Turntable;
use self::shade::light::{OPEN, reaching_light};
use self::shade::surface::Surface;
pub use self::style::PreviewStyle;
use self::style::{Fill, Look};
pub use self::subject::Subject;
use crate::ExportError;
use crate::part::check_mesh;

/// Draws a subject.
///
/// The camera stands outside, looks at all of it, and sees only the outer sides of faces. The same input gives the same
/// bytes, whatever the number of threads. An empty mesh gives the background alone.
///
/// # Errors
/// [`ExportError::ImageSize`] or [`ExportError::CameraAngle`] for unusable options, [`ExportError::InvalidMesh`] for an
/// index out of range or a number that is not finite.
pub fn render(subject: &Subject<'_>, options: &PreviewOptions) -> Result<Picture, ExportError> {
    options.check()?;
    let mesh = subject.as_mesh();
    check_mesh(mesh)?;
    let framed = if mesh.triangles.is_empty() { None } else { framing(subject, options) };
    draw(subject, framed, options)
}

/// A camera that sees all of a subject, and its dimensions.
fn framing(subject: &Subject<'_>, options: &PreviewOptions) -> Option<Camera> {
    let positions = &subject.as_mesh().positions;
    if !options.dimensions {
        return Camera::framing(positions, options);
    }
    // Dimensions stand beside the box around the model, which may be seen far outside of it.
    let corners = subject.bounds().map(box_corners).unwrap_or_default();
    Camera::framing(&[&positions[..], &corners].concat(), options)
}

/// The corners of a box; the bits of their numbers say at which end of each axis they lie.
fn box_corners([min, max]: [DVec3; 2]) -> [DVec3; 8] {
    let corner = |number: usize| DVec3::from([0, 1, 2].map(|axis| [min, max][number >> axis & 1][axis]));
    std::array::from_fn(corner)
}

/// Draws what a camera sees, and what is written beside it.
fn draw(subject: &Subject<'_>, camera: Option<Camera>, options: &PreviewOptions) -> Result<Picture, ExportError> {
    let look = Look::new(options.style, options.background);
    let size = options.size();
    let [width, height] = [options.width, options.height];
    let Some(camera) = camera else {
        return Ok(Picture { width, height, pixels: compose_background(&look, size) });
    };
    let scene = Scene::new(subject, camera, look);
    let mut picture = Picture { width, height, pixels: draw_scene(&scene, size) };
    draw_labels(&mut picture, subject, &scene.camera, options)?;
    Ok(picture)
}

fn draw_scene(scene: &Scene<'_>, size: [usize; 2]) -> Vec<u8> {
    let pixels = size[0] * size[1];
    let surface = Surface::new(scene, size, pixels_along_cell(pixels));
    let light = match scene.look.fill {
        Fill::Opaque => reaching_light(scene, &surface),
        Fill::Translucent | Fill::Nothing => vec![OPEN; surface.width * surface.height],
    };
    let scale = scale_of(size);
    let lines = feature_lines(scene, scale);
    let factor = samples_along_pixel(pixels);
    compose(&Layers { scene, size, scale, factor, surface: &surface, light: &light, lines: &lines })
}

/// Pixels along each side of a cell of light: as few as keep the number of cells near half a million.
fn pixels_along_cell(pixels: usize) -> usize {
    (pixels as f64 / 500_000.0).sqrt().ceil() as usize
}

/// Samples along each side of a pixel: more for small pictures, where they cost little.
fn samples_along_pixel(pixels: usize) -> usize {
    if pixels <= 500_000 { 4 } else { 2 }
}

/// How large a picture is, compared with one whose shorter side is 960 pixels: widths of lines and sizes of text are stated for that.
fn scale_of(size: [usize; 2]) -> f32 {
    size[0].min(size[1]) as f32 / 960.0
}
