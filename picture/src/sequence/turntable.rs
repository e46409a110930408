//! A model seen from all around.

use crate::error::PictureError;
use crate::input::check::check_mesh;
use crate::input::mesh::PaintedMesh;
use crate::input::options::PreviewOptions;
use crate::picture::Picture;
use crate::render::draw;
use crate::view::camera::Camera;

/// The pictures of one turn about the vertical. The camera keeps its distance, so that nothing but the turning moves, and light comes from the
/// same side of the picture in all of them.
#[derive(Debug)]
pub struct Turntable<'a> {
    mesh: &'a PaintedMesh<'a>,
    camera: Option<Camera>,
    options: PreviewOptions,
    frames: u32,
}

impl<'a> Turntable<'a> {
    /// A turn in `frames` steps that begins with the azimuth of the options. No picture has dimensions: their lines would jump from edge to
    /// edge.
    ///
    /// # Errors
    /// As [`render`](crate::render).
    pub fn new(mesh: &'a PaintedMesh<'a>, options: &PreviewOptions, frames: u32) -> Result<Self, PictureError> {
        options.check()?;
        let options = PreviewOptions { dimensions: false, ..*options };
        check_mesh(mesh)?;
        let is_empty = mesh.triangles.is_empty();
        let camera = if is_empty { None } else { Camera::framing_all_around(&mesh.positions, &options) };
        Ok(Self { mesh, camera, options, frames })
    }

    /// How many pictures there are.
    #[must_use]
    pub fn frames(&self) -> u32 {
        self.frames
    }

    /// The picture of one step, counted from 0. The model turns counter-clockwise as seen from above.
    ///
    /// # Errors
    /// As [`render`](crate::render).
    pub fn frame(&self, number: u32) -> Result<Picture, PictureError> {
        let PreviewOptions { azimuth, elevation, .. } = self.options;
        let azimuth = azimuth - 360.0 * f64::from(number) / f64::from(self.frames.max(1));
        let camera = self.camera.as_ref().map(|camera| camera.turned(azimuth, elevation));
        draw(self.mesh, camera, &PreviewOptions { azimuth, ..self.options })
    }
}
