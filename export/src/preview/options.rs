//! What to draw a preview like.

use glam::DVec3;

use crate::preview::camera::view_directions;
use crate::preview::style::PreviewStyle;
use crate::{ExportError, Unit};

/// Largest width and height of a preview, in pixels.
pub const MAX_IMAGE_SIDE: u32 = 16_384;

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
    /// The unit of the model's lengths, for labels; without one they are bare numbers.
    pub unit: Option<Unit>,
}

/// Sees that a picture of some width and height can be made.
///
/// # Errors
/// [`ExportError::ImageSize`].
pub(super) fn check_size([width, height]: [u32; 2]) -> Result<(), ExportError> {
    let sides = 1..=MAX_IMAGE_SIDE;
    if sides.contains(&width) && sides.contains(&height) {
        Ok(())
    } else {
        Err(ExportError::ImageSize { width, height })
    }
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
    pub fn towards_camera(&self) -> DVec3 {
        view_directions(self.azimuth, self.elevation)[1]
    }

    /// Sees that all numbers can be used.
    ///
    /// # Errors
    /// [`ExportError::ImageSize`], [`ExportError::CameraAngle`].
    pub(super) fn check(&self) -> Result<(), ExportError> {
        let Self { width, height, azimuth, elevation, .. } = *self;
        check_size([width, height])?;
        match [azimuth, elevation].into_iter().find(|angle| !angle.is_finite()) {
            Some(angle) => Err(ExportError::CameraAngle(angle)),
            None => Ok(()),
        }
    }

    /// Width and height, in pixels.
    pub(super) fn size(&self) -> [usize; 2] {
        [self.width as usize, self.height as usize]
    }

    /// Whether anything is written beside the model.
    pub(super) fn has_labels(&self) -> bool {
        self.dimensions || self.scale_bar
    }
}
