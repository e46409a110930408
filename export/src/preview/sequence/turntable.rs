//! A model seen from all around.

use crate::ExportError;
use crate::part::check_mesh;
use crate::preview::camera::Camera;
use crate::preview::draw;
use crate::preview::options::PreviewOptions;
use crate::preview::picture::Picture;
use crate::preview::subject::Subject;

/// The pictures of one turn about the vertical. The camera keeps its distance, so that nothing but the turning moves, and light comes from the
/// same side of the picture in all of them.
#[derive(Debug)]
pub struct Turntable<'a> {
    subject: &'a Subject<'a>,
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
    pub fn new(subject: &'a Subject<'a>, options: &PreviewOptions, frames: u32) -> Result<Self, ExportError> {
        options.check()?;
        let options = PreviewOptions { dimensions: false, ..*options };
        let mesh = subject.as_mesh();
        check_mesh(mesh)?;
        let is_empty = mesh.triangles.is_empty();
        let camera = if is_empty { None } else { Camera::framing_all_around(&mesh.positions, &options) };
        Ok(Self { subject, camera, options, frames })
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
    pub fn frame(&self, number: u32) -> Result<Picture, ExportError> {
        let PreviewOptions { azimuth, elevation, .. } = self.options;
        let azimuth = azimuth - 360.0 * f64::from(number) / f64::from(self.frames.max(1));
        let camera = self.camera.as_ref().map(|camera| camera.turned(azimuth, elevation));
        draw(self.subject, camera, &PreviewOptions { azimuth, ..self.options })
    }
}
