//! What pipelines want to know of a picture: how far away the surface is at each pixel, and which face it is.

use png::{BitDepth, ColorType, Encoder};

use super::framing;
use crate::error::PictureError;
use crate::input::check::check_mesh;
use crate::input::mesh::PaintedMesh;
use crate::input::options::PreviewOptions;
use crate::picture::{encode_png, png_error};
use crate::raster::{NO_FACE, Raster, Triangles};

/// The surface seen at the middle of each pixel, row by row from the top left.
#[derive(Debug, Clone, PartialEq)]
pub struct Buffers {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Distances from the plane through the eye across the view, in the units of the model; infinite where there is nothing. Of an
    /// orthographic picture the plane lies in front of all of the model.
    pub depth: Vec<f64>,
    /// Indices of the mesh's faces; `None` where there is nothing.
    pub faces: Vec<Option<u32>>,
}

/// The depth and the faces of the picture that [`render`](crate::render) draws with the same options.
///
/// # Errors
/// As [`render`](crate::render).
pub fn render_buffers(mesh: &PaintedMesh<'_>, options: &PreviewOptions) -> Result<Buffers, PictureError> {
    options.check()?;
    check_mesh(mesh)?;
    let size = options.size();
    let empty = || Buffers {
        width: options.width,
        height: options.height,
        depth: vec![f64::INFINITY; size[0] * size[1]],
        faces: vec![None; size[0] * size[1]],
    };
    if mesh.triangles.is_empty() {
        return Ok(empty());
    }
    let Some(camera) = framing(mesh, options) else { return Ok(empty()) };
    let points: Vec<_> = mesh.positions.iter().map(|&point| camera.see(point)).collect();
    let raster =
        Raster::draw(Triangles { size, points: &points, corners: &mesh.triangles, faces: &mesh.triangle_faces });
    let radius = camera.radius();
    Ok(Buffers {
        depth: raster.nearness.iter().map(|&nearness| f64::from(camera.lens.depth(nearness)) * radius).collect(),
        faces: raster.faces.iter().map(|&face| (face != NO_FACE).then_some(face)).collect(),
        ..empty()
    })
}

/// The value of pixels without a surface in pictures of depth.
const NOTHING: u16 = u16::MAX;

impl Buffers {
    /// The nearest and the farthest depth; `None` where there is no surface at all.
    #[must_use]
    pub fn depth_range(&self) -> Option<[f64; 2]> {
        let seen = self.depth.iter().copied().filter(|depth| depth.is_finite());
        let [near, far] =
            seen.fold([f64::INFINITY, f64::NEG_INFINITY], |[near, far], depth| [near.min(depth), far.max(depth)]);
        (near <= far).then_some([near, far])
    }

    /// The depth as a picture of 16-bit greys: 0 is the nearest surface, 65,534 the farthest, linear between them, and 65,535 is nothing.
    /// The chunks `near` and `far` of text say what those depths are.
    ///
    /// # Errors
    /// [`PictureError::Encode`]; never expected.
    pub fn depth_png(&self) -> Result<Vec<u8>, PictureError> {
        let [near, far] = self.depth_range().unwrap_or([0.0, 0.0]);
        let per_range = f64::from(NOTHING - 1) / (far - near).max(f64::MIN_POSITIVE);
        let grey = |&depth: &f64| if depth.is_finite() { ((depth - near) * per_range).round() as u16 } else { NOTHING };
        let bytes: Vec<u8> = self.depth.iter().flat_map(|depth| grey(depth).to_be_bytes()).collect();
        let failed = |error| png_error(&error);
        let mut png = Vec::new();
        let mut encoder = Encoder::new(&mut png, self.width, self.height);
        encoder.set_color(ColorType::Grayscale);
        encoder.set_depth(BitDepth::Sixteen);
        for (key, value) in [("near", near), ("far", far)] {
            encoder.add_text_chunk(key.to_owned(), value.to_string()).map_err(failed)?;
        }
        let mut writer = encoder.write_header().map_err(failed)?;
        writer.write_image_data(&bytes).map_err(failed)?;
        writer.finish().map_err(failed)?;
        Ok(png)
    }

    /// Numbers of faces as a picture of colours: red, green and blue are the bytes of the number plus one, the highest first, and black is
    /// nothing. `number` tells the number to write for a face of the mesh.
    ///
    /// # Errors
    /// [`PictureError::TooLarge`] where a number plus one needs more than three bytes.
    pub fn id_png(&self, number: impl Fn(u32) -> u32) -> Result<Vec<u8>, PictureError> {
        let mut bytes = Vec::with_capacity(self.faces.len() * 3);
        for face in &self.faces {
            let value = face.map_or(0, |face| u64::from(number(face)) + 1);
            if value >= 1 << 24 {
                return Err(PictureError::TooLarge {
                    what: format!("number {value} of a face, of at most {}", (1 << 24) - 1),
                });
            }
            bytes.extend_from_slice(&(value as u32).to_be_bytes()[1..]);
        }
        encode_png(&bytes, [self.width, self.height], ColorType::Rgb)
    }
}
