//! Preview pictures, drawn without a graphics card.
//!
//! Way of a [`subject`] through this folder: [`camera`] frames it, [`scene`] brings it into view coordinates and colours its
//! faces, [`surface`] finds what is seen in each cell of a few pixels, [`light`] computes how much light gets there ([`shadow`],
//! [`occlusion`]), [`edges`] finds the lines ([`dashes`] along them), and [`mod@compose`] puts all of it together at several samples
//! per pixel: [`ink`] of lines, [`hatch`] on cuts, [`veil`] of surfaces that are seen through, and [`display`] makes bytes of it.
//! [`raster`] is the z-buffer that all of these share, [`lens`] the projection. Numbers that are a matter of taste are in [`style`].

mod animation;
mod buffers;
mod camera;
mod compose;
mod dashes;
mod display;
mod edges;
mod hatch;
mod ink;
mod labels;
mod lens;
mod light;
mod occlusion;
mod options;
mod overlay;
mod picture;
mod raster;
mod scene;
mod shadow;
mod sheet;
mod style;
mod subject;
mod surface;
mod text;
mod turntable;
mod veil;

pub use self::animation::{AnimationFormat, AnimationWriter};
pub use self::buffers::{Buffers, render_buffers};
use self::camera::Camera;
use self::compose::{Layers, compose, compose_background};
use self::edges::feature_lines;
use self::labels::draw_labels;
use self::light::{OPEN, reaching_light};
pub use self::options::{Background, CameraKind, MAX_IMAGE_SIDE, PreviewOptions};
pub use self::picture::Picture;
use self::scene::Scene;
pub use self::sheet::{SheetColors, SheetLayout, Tile, contact_sheet, sheet_layout};
pub use self::style::PreviewStyle;
use self::style::{Fill, Look};
pub use self::subject::Subject;
use self::surface::Surface;
pub use self::turntable::Turntable;
use crate::ExportError;
use crate::check::check_mesh;

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
    let framed = if mesh.triangles.is_empty() { None } else { Camera::framing(&mesh.positions, options) };
    draw(subject, framed, options)
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
    draw_labels(&mut picture, &scene, options)?;
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
