//! Pictures of solids, meshes and cells.

use std::path::Path;

use numpy::{PyArray1, PyArray3, PyArrayMethods};
use planecut::csg::Mesh;
use planecut::export::write_atomic;
use planecut::picture::{Background, CameraKind, Picture, PreviewOptions, PreviewStyle, Subject, render};
use pyo3::prelude::*;
use serde::Deserialize;

use crate::errors::{Failure, Outcome};
use crate::files::settings;

/// How a picture looks, in words.
#[derive(Debug, Clone, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct Look {
    size: (u32, u32),
    style: String,
    azimuth: f64,
    elevation: f64,
    camera: String,
    background: String,
    dimensions: bool,
}

impl Default for Look {
    fn default() -> Self {
        let PreviewOptions { azimuth, elevation, .. } = PreviewOptions::default();
        Self::new((640, 480), "shaded", azimuth, elevation, "perspective", "light", false)
    }
}

impl Look {
    pub(crate) fn new(
        size: (u32, u32),
        style: &str,
        azimuth: f64,
        elevation: f64,
        camera: &str,
        background: &str,
        dimensions: bool,
    ) -> Self {
        let [style, camera, background] = [style, camera, background].map(str::to_owned);
        Self { size, style, azimuth, elevation, camera, background, dimensions }
    }

    /// On the page of a notebook, whatever its colour.
    pub(crate) fn of_notebook() -> Self {
        Self { background: "transparent".to_owned(), ..Self::default() }
    }

    fn options(&self) -> Outcome<PreviewOptions> {
        let unknown = |name: &str, found: &str, expected: &str| {
            Err(Failure::of(format!("{name}: found {found:?}, expected {expected}")))
        };
        let style = match self.style.as_str() {
            "shaded" => PreviewStyle::Shaded,
            "technical" => PreviewStyle::Technical,
            "xray" => PreviewStyle::XRay,
            "wireframe" => PreviewStyle::Wireframe,
            other => return unknown("style", other, "\"shaded\", \"technical\", \"xray\" or \"wireframe\""),
        };
        let camera = match self.camera.as_str() {
            "perspective" => CameraKind::Perspective,
            "orthographic" => CameraKind::Orthographic,
            other => return unknown("camera", other, "\"perspective\" or \"orthographic\""),
        };
        let background = match self.background.as_str() {
            "light" => Background::Light,
            "dark" => Background::Dark,
            "transparent" => Background::Transparent,
            other => return unknown("background", other, "\"light\", \"dark\" or \"transparent\""),
        };
        let Self { size: (width, height), azimuth, elevation, dimensions, .. } = *self;
        let default = PreviewOptions::default();
        Ok(PreviewOptions { width, height, style, camera, background, azimuth, elevation, dimensions, ..default })
    }

    /// A picture of a mesh.
    pub(crate) fn picture(&self, mesh: &Mesh) -> Outcome<Picture> {
        render(&Subject::of_mesh(mesh), &self.options()?).map_err(Failure::of)
    }

    /// A picture of convex cells, each in a colour of its own and moved away from the middle by `spread`.
    pub(crate) fn picture_of_cells(&self, cells: &[Mesh], spread: f64) -> Outcome<Picture> {
        render(&Subject::of_cells(cells, spread, &[]), &self.options()?).map_err(Failure::of)
    }

    /// A picture of a mesh as a PNG file.
    pub(crate) fn png(&self, mesh: &Mesh) -> Outcome<Vec<u8>> {
        self.picture(mesh)?.to_png().map_err(Failure::of)
    }
}

/// Whether a file is to be a picture.
pub(crate) fn is_picture(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png"))
}

/// Writes a picture of a mesh.
pub(crate) fn save_picture(mesh: &Mesh, path: &Path, options: &str) -> Outcome<()> {
    let look: Look = settings(options)?;
    write_atomic(path, &look.png(mesh)?).map_err(Failure::of)
}

/// The pixels of a picture, shape (height, width, 4).
pub(crate) fn pixels<'py>(py: Python<'py>, picture: Picture) -> PyResult<Bound<'py, PyArray3<u8>>> {
    let (width, height) = (picture.width as usize, picture.height as usize);
    PyArray1::from_vec(py, picture.pixels).reshape([height, width, 4])
}
