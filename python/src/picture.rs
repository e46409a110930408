//! Pictures of solids.

use std::sync::Arc;

use planecut::picture::{Background, CameraKind, Picture, PreviewOptions, PreviewStyle, Subject, render};
use pyo3::prelude::*;

use crate::errors::{Failure, refuse};
use crate::job::Job;
use crate::solid::Solid;

/// How a picture looks, in words.
pub(crate) struct Look<'a> {
    pub(crate) size: (u32, u32),
    pub(crate) style: &'a str,
    pub(crate) azimuth: f64,
    pub(crate) elevation: f64,
    pub(crate) camera: &'a str,
    pub(crate) background: &'a str,
    pub(crate) dimensions: bool,
}

impl Default for Look<'_> {
    fn default() -> Self {
        let PreviewOptions { width, height, azimuth, elevation, .. } = PreviewOptions::default();
        let (style, camera, background) = ("shaded", "perspective", "light");
        Self { size: (width, height), style, azimuth, elevation, camera, background, dimensions: false }
    }
}

impl Look<'_> {
    fn options(&self) -> PyResult<PreviewOptions> {
        let unknown = |name: &str, found: &str, expected: &str| Err(refuse(format!("{name}: found {found:?}, expected {expected}")));
        let style = match self.style {
            "shaded" => PreviewStyle::Shaded,
            "technical" => PreviewStyle::Technical,
            "xray" => PreviewStyle::XRay,
            "wireframe" => PreviewStyle::Wireframe,
            other => return unknown("style", other, "\"shaded\", \"technical\", \"xray\" or \"wireframe\""),
        };
        let camera = match self.camera {
            "perspective" => CameraKind::Perspective,
            "orthographic" => CameraKind::Orthographic,
            other => return unknown("camera", other, "\"perspective\" or \"orthographic\""),
        };
        let background = match self.background {
            "light" => Background::Light,
            "dark" => Background::Dark,
            "transparent" => Background::Transparent,
            other => return unknown("background", other, "\"light\", \"dark\" or \"transparent\""),
        };
        let (width, height) = self.size;
        let Self { azimuth, elevation, dimensions, .. } = *self;
        let default = PreviewOptions::default();
        Ok(PreviewOptions { width, height, style, camera, background, azimuth, elevation, dimensions, ..default })
    }
}

/// A picture of a solid.
pub(crate) fn rendered(py: Python<'_>, solid: &Solid, look: &Look<'_>) -> PyResult<Picture> {
    let options = look.options()?;
    let node = Arc::clone(solid.node());
    let draw = move || {
        let evaluated = node.evaluated()?;
        render(&Subject::of_mesh(&evaluated.evaluation.mesh), &options).map_err(Failure::of)
    };
    Job::default().run(py, draw)
}
