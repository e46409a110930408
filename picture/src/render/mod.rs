//! The stages in their order: what [`render`] does.

pub(crate) mod buffers;

use crate::canvas::labels::draw_labels;
use crate::error::PictureError;
use crate::input::bounds::box_corners;
use crate::input::check::check_mesh;
use crate::input::mesh::PaintedMesh;
use crate::input::options::PreviewOptions;
use crate::lines::edges::feature_lines;
use crate::paint::compose::{Layers, compose, compose_background};
use crate::picture::Picture;
use crate::scene::Scene;
use crate::scene::look::{Fill, Look};
use crate::shade::light::{OPEN, reaching_light};
use crate::shade::surface::Surface;
use crate::view::camera::Camera;

/// Draws a mesh.
///
/// The camera stands outside, looks at all of it, and sees only the outer sides of faces. The same input gives the same
/// bytes, whatever the number of threads. An empty mesh gives the background alone.
///
/// # Errors
/// [`PictureError::ImageSize`] or [`PictureError::CameraAngle`] for unusable options, [`PictureError::InvalidMesh`] for an
/// index out of range or a number that is not finite.
pub fn render(mesh: &PaintedMesh<'_>, options: &PreviewOptions) -> Result<Picture, PictureError> {
    options.check()?;
    check_mesh(mesh)?;
    let framed = if mesh.triangles.is_empty() { None } else { framing(mesh, options) };
    draw(mesh, framed, options)
}

/// A camera that sees all of a mesh, and its dimensions.
fn framing(mesh: &PaintedMesh<'_>, options: &PreviewOptions) -> Option<Camera> {
    let positions = &mesh.positions;
    if !options.dimensions {
        return Camera::framing(positions, options);
    }
    // Dimensions stand beside the box around the model, which may be seen far outside of it.
    let corners = mesh.bounds().map(box_corners).unwrap_or_default();
    Camera::framing(&[&positions[..], &corners].concat(), options)
}

/// Draws what a camera sees, and what is written beside it.
pub(crate) fn draw(
    mesh: &PaintedMesh<'_>,
    camera: Option<Camera>,
    options: &PreviewOptions,
) -> Result<Picture, PictureError> {
    let look = Look::new(options.style, options.background);
    let size = options.size();
    let [width, height] = [options.width, options.height];
    let Some(camera) = camera else {
        return Ok(Picture { width, height, pixels: compose_background(&look, size) });
    };
    let scene = Scene::new(mesh, camera, look);
    let mut picture = Picture { width, height, pixels: draw_scene(&scene, size, options.scale()) };
    draw_labels(&mut picture, mesh, &scene.camera, options)?;
    Ok(picture)
}

fn draw_scene(scene: &Scene<'_>, size: [usize; 2], scale: f32) -> Vec<u8> {
    let pixels = size[0] * size[1];
    let surface = Surface::new(scene, size, pixels_along_cell(pixels));
    let light = match scene.look.fill {
        Fill::Opaque => reaching_light(scene, &surface),
        Fill::Translucent | Fill::Nothing => vec![OPEN; surface.width * surface.height],
    };
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
