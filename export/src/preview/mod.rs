//! Preview pictures, drawn without a graphics card.
//!
//! Way of a mesh through this folder: [`camera`] frames it, [`scene`] brings it into view coordinates and colours its
//! faces, [`raster`] finds the nearest face at several samples per pixel, [`surface`] picks one surface per pixel,
//! [`light`] computes how much light gets there ([`shadow`], [`occlusion`]), [`edges`] finds the lines, and [`compose`]
//! puts all of it together. Numbers that are a matter of taste are in [`style`].

mod camera;
mod compose;
mod edges;
mod light;
mod occlusion;
mod raster;
mod scene;
mod shadow;
mod style;
mod surface;

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use planecut_csg::Mesh;

use self::camera::Camera;
use self::compose::{Layers, compose, compose_background};
use self::edges::feature_lines;
use self::light::reaching_light;
use self::raster::Raster;
use self::scene::Scene;
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
    PngEncoder::new_with_quality(&mut png, CompressionType::Fast, FilterType::Adaptive)
        .write_image(&image.pixels, image.width, image.height, ExtendedColorType::Rgb8)
        .map_err(|error| ExportError::Encode { format: "PNG", message: error.to_string() })?;
    Ok(png)
}

/// Draws `mesh` as [`render_preview`] does, without encoding the picture.
///
/// Takes about 40 bytes of memory per pixel.
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

fn draw(scene: &Scene<'_>, [width, height]: [usize; 2]) -> Vec<u8> {
    let t0 = std::time::Instant::now();
    let factor = samples_along_pixel(width * height);
    eprintln!("factor {:?}", t0.elapsed());
    let points: Vec<_> = scene.screen.iter().map(|point| point.magnified(factor as f32)).collect();
    let size = [width * factor, height * factor];
    eprintln!("size {:?}", t0.elapsed());
    let samples = Raster::draw(size, &points, &scene.mesh.triangles, &scene.mesh.triangle_faces);
    eprintln!("samples {:?}", t0.elapsed());
    let surface = Surface::new(scene, &samples, factor, pixels_along_cell(width * height));
    eprintln!("surface {:?}", t0.elapsed());
    let light = reaching_light(scene, &surface);
    eprintln!("light {:?}", t0.elapsed());
    let lines = feature_lines(scene);
    eprintln!("lines {:?}", t0.elapsed());
    let r = compose(&Layers { scene, samples: &samples, factor, surface: &surface, light: &light, lines: &lines }); eprintln!("compose {:?}", t0.elapsed()); r
}

/// Pixels along each side of a cell of light: one for small pictures, where a pixel is a large part of the model.
fn pixels_along_cell(pixels: usize) -> usize {
    if pixels <= 500_000 { 1 } else { 2 }
}

/// Samples along each side of a pixel: more for small pictures, where they cost nothing, and one for those so large that
/// memory matters more.
fn samples_along_pixel(pixels: usize) -> usize {
    match pixels {
        0..=500_000 => 4,
        500_001..=20_000_000 => 2,
        _ => 1,
    }
}
