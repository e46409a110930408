//! What to draw a preview like.

use glam::DVec3;

use crate::error::PictureError;
#[cfg(doc)]
use crate::picture::MAX_IMAGE_SIDE;
use crate::picture::check_size;

/// How a preview is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum PreviewStyle {
    /// Tinted clay in soft light with shadows, on a studio floor.
    #[default]
    Shaded,
    /// A line drawing with a hint of shading, hidden edges dashed, for print.
    Technical,
    /// Bodies that are seen through, with all their edges.
    XRay,
    /// The edges of all triangles; those within a face are thin, hidden ones faint.
    Wireframe,
}

/// How depth becomes smaller on the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum CameraKind {
    /// What is far away is small.
    #[default]
    Perspective,
    /// Parallel lines stay parallel, and lengths across the view are the same everywhere.
    Orthographic,
}

/// What is behind the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Background {
    /// A light studio; paper for drawings.
    #[default]
    Light,
    /// A dark studio; drawings have light lines.
    Dark,
    /// Nothing: the picture has an alpha channel, and the shadow on the floor is in it.
    Transparent,
}

/// How to draw a preview.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PreviewOptions {
    /// Width in pixels, 1 to [`MAX_IMAGE_SIDE`].
    pub width: u32,
    /// Height in pixels, 1 to [`MAX_IMAGE_SIDE`].
    pub height: u32,
    /// The look.
    pub style: PreviewStyle,
    /// How depth is shown.
    pub camera: CameraKind,
    /// What is behind the model.
    pub background: Background,
    /// Direction from the model to the camera: degrees from the x axis towards the y axis.
    pub azimuth: f64,
    /// Height of the camera above the horizon in degrees, limited to 90 either way.
    pub elevation: f64,
    /// Whether the extents of the model along the axes are drawn and labelled.
    pub dimensions: bool,
    /// Whether a bar tells how long something is; with a perspective camera, at the depth of the model's middle.
    pub scale_bar: bool,
    /// How the unit of the model's lengths is written behind them in labels, as "mm"; without one they are bare numbers.
    pub unit: Option<&'static str>,
}

impl Default for PreviewOptions {
    /// A shaded three-quarter view from above, 1280 × 960.
    fn default() -> Self {
        Self {
            width: 1280,
            height: 960,
            style: PreviewStyle::Shaded,
            camera: CameraKind::Perspective,
            background: Background::Light,
            azimuth: -62.0,
            elevation: 32.0,
            dimensions: false,
            scale_bar: false,
            unit: None,
        }
    }
}

impl PreviewOptions {
    /// Unit direction from the model to the camera.
    #[must_use]
    pub fn towards_camera(&self) -> [f64; 3] {
        view_directions(self.azimuth, self.elevation)[1].to_array()
    }

    /// Sees that all numbers can be used.
    ///
    /// # Errors
    /// [`PictureError::ImageSize`], [`PictureError::CameraAngle`].
    pub(crate) fn check(&self) -> Result<(), PictureError> {
        let Self { width, height, azimuth, elevation, .. } = *self;
        check_size([width, height])?;
        match [azimuth, elevation].into_iter().find(|angle| !angle.is_finite()) {
            Some(angle) => Err(PictureError::CameraAngle(angle)),
            None => Ok(()),
        }
    }

    /// Width and height, in pixels.
    pub(crate) fn size(&self) -> [usize; 2] {
        [self.width as usize, self.height as usize]
    }

    /// How large the picture is, compared with one whose shorter side is 960 pixels: widths of lines and sizes of text are stated for that.
    pub(crate) fn scale(&self) -> f32 {
        self.width.min(self.height) as f32 / 960.0
    }

    /// Whether anything is written beside the model.
    pub(crate) fn has_labels(&self) -> bool {
        self.dimensions || self.scale_bar
    }
}

/// World directions to the right of the picture and towards the eye; angles in degrees.
pub(crate) fn view_directions(azimuth: f64, elevation: f64) -> [DVec3; 2] {
    // The functions of a crate, not those of the system: pictures are the same on all machines.
    let (azimuth_sine, azimuth_cosine) = libm::sincos(azimuth.to_radians());
    let (rise, reach) = libm::sincos(elevation.clamp(-90.0, 90.0).to_radians());
    let towards_eye = DVec3::new(reach * azimuth_cosine, reach * azimuth_sine, rise);
    [DVec3::new(-azimuth_sine, azimuth_cosine, 0.0), towards_eye]
}
