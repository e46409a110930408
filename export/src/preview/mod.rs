//! Preview pictures, drawn without a graphics card.
//!
//! Way of a mesh through this folder: [`camera`] frames it, [`scene`] brings it into view coordinates and colours its
//! faces, [`surface`] finds what is seen in each cell of a few pixels, [`light`] computes how much light gets there ([`shadow`],
//! [`occlusion`]), [`edges`] finds the lines, and [`mod@compose`] puts all of it together at several samples per pixel.
//! [`raster`] is the z-buffer that all of these share. Numbers that are a matter of taste are in [`style`].

mod animation;
mod camera;
mod compose;
mod edges;
mod light;
mod occlusion;
mod overlay;
mod picture;
mod raster;
mod scene;
mod shadow;
mod sheet;
mod style;
mod surface;
mod text;

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use planecut_csg::Mesh;

pub use self::animation::{AnimationFormat, AnimationWriter};
use self::camera::Camera;
use self::compose::{Layers, compose, compose_background};
use self::edges::feature_lines;
use self::light::reaching_light;
pub use self::picture::Picture;
use self::scene::Scene;
pub use self::sheet::{SheetColors, SheetLayout, Tile, contact_sheet, sheet_layout};
use self::style::Look;
pub use self::style::PreviewStyle;
use self::surface::Surface;
use crate::ExportError;
use crate::check::check_mesh;

/// Largest width and height of a preview, in pixels.
pub const MAX_IMAGE_SIDE: u32 = 16_384;

/// How to draw a preview.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PreviewOptions {
    /// Width in pixels, 1 to [`MAX_IMAGE_SIDE`].
    pub width: u32,
    /// Height in pixels, 1 to [`MAX_IMAGE_SIDE`].
    pub height: u32,
    /// The look.
    pub style: PreviewStyle,
    /// Direction from the model to the camera: degrees from the x axis towards the y axis.
    pub azimuth: f64,
    /// Height of the camera above the horizon in degrees, limited to 89 either way.
    pub elevation: f64,
}

impl Default for PreviewOptions {
    /// A shaded three-quarter view from above, 1280 × 960.
    fn default() -> Self {
        Self { width: 1280, height: 960, style: PreviewStyle::Shaded, azimuth: -62.0, elevation: 32.0 }
    }
}

/// A picture with 8 bits per channel, ready for any encoder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RgbImage {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Red, green and blue of each pixel (sRGB), row by row from the top left: 3 · width · height bytes.
    pub pixels: Vec<u8>,
}

/// Draws `mesh` and encodes the picture as PNG.
///
/// The camera stands outside, looks at the whole mesh, and sees only the outer sides of faces. The same input gives the same
/// bytes, whatever the number of threads. An empty mesh gives the background alone.
///
/// # Errors
/// [`ExportError::ImageSize`] or [`ExportError::CameraAngle`] for unusable options, [`ExportError::InvalidMesh`] for an
/// index out of range or a number that is not finite.
pub fn render_preview(mesh: &Mesh, options: &PreviewOptions) -> Result<Vec<u8>, ExportError> {
    let image = render_rgb(mesh, options)?;
    let mut png = Vec::new();
    // Fast: the better settings take longer than the drawing and save a fifth of the bytes.
    PngEncoder::new_with_quality(&mut png, CompressionType::Best, FilterType::Adaptive)
        .write_image(&image.pixels, image.width, image.height, ExtendedColorType::Rgb8)
        .map_err(|error| ExportError::Encode { format: "PNG", message: error.to_string() })?;
    Ok(png)
}

/// Draws `mesh` as [`render_preview`] does, without encoding the picture.
///
/// # Errors
/// As for [`render_preview`].
pub fn render_rgb(mesh: &Mesh, options: &PreviewOptions) -> Result<RgbImage, ExportError> {
    let PreviewOptions { width, height, azimuth, elevation, .. } = *options;
    let sides = 1..=MAX_IMAGE_SIDE;
    if !(sides.contains(&width) && sides.contains(&height)) {
        return Err(ExportError::ImageSize { width, height });
    }
    if let Some(angle) = [azimuth, elevation].into_iter().find(|angle| !angle.is_finite()) {
        return Err(ExportError::CameraAngle(angle));
    }
    check_mesh(mesh)?;
    let look = Look::new(options.style);
    let size = [width as usize, height as usize];
    let framed = if mesh.triangles.is_empty() {
        None
    } else {
        Camera::framing(&mesh.positions, [azimuth, elevation], [width, height])
    };
    let pixels = match framed {
        Some(camera) => draw(&Scene::new(mesh, camera, look), size),
        None => compose_background(&look, size),
    };
    Ok(RgbImage { width, height, pixels })
}

fn draw(scene: &Scene<'_>, size: [usize; 2]) -> Vec<u8> {
    let pixels = size[0] * size[1];
    let surface = Surface::new(scene, size, pixels_along_cell(pixels));
    let light = reaching_light(scene, &surface);
    let lines = feature_lines(scene);
    let factor = samples_along_pixel(pixels);
    compose(&Layers { scene, size, factor, surface: &surface, light: &light, lines: &lines })
}

/// Pixels along each side of a cell of light: as few as keep the number of cells near half a million.
fn pixels_along_cell(pixels: usize) -> usize {
    (pixels as f64 / 500_000.0).sqrt().ceil() as usize
}

/// Samples along each side of a pixel: more for small pictures, where they cost little.
fn samples_along_pixel(pixels: usize) -> usize {
    if pixels <= 500_000 { 4 } else { 2 }
}
