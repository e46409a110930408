//! Pictures of triangle meshes, drawn without a graphics card.
//!
//! - [`render`] draws a [`PaintedMesh`], plain arrays of positions, triangles, faces and their colours, by [`PreviewOptions`] as a
//!   [`Picture`], which gives PNG.
//! - [`render_buffers`] tells the depth and the face at each pixel of that picture.
//! - [`Turntable`] gives the pictures of one turn, [`AnimationWriter`] puts them into a GIF or APNG file, and [`contact_sheet`] puts pictures
//!   side by side.
//!
//! The same input gives the same bytes on all machines, whatever the number of threads.
//!
//! ```
//! use planecut_picture::{Face, PaintedMesh, PreviewOptions, Tint, render};
//!
//! // A tetrahedron: a face for each of its triangles, all of one colour.
//! let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
//! let triangles = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
//! let third = 1.0 / 3.0_f64.sqrt();
//! let normals = [[0.0, 0.0, -1.0], [0.0, -1.0, 0.0], [-1.0, 0.0, 0.0], [third; 3]];
//! let faces = normals.map(|normal| Face { normal, paint: 0 }).to_vec();
//! let mesh = PaintedMesh::new(positions, triangles, vec![0, 1, 2, 3], faces, vec![Tint::Stated([0.6, 0.2, 0.1]).into()]);
//! let picture = render(&mesh, &PreviewOptions { width: 64, height: 48, ..PreviewOptions::default() })?;
//! assert_eq!(picture.pixels.len(), 4 * 64 * 48);
//! assert!(picture.to_png()?.starts_with(b"\x89PNG"));
//! # Ok::<(), planecut_picture::PictureError>(())
//! ```
//!
//! Way of a mesh through the modules: `input` holds it and the options, a camera of `view` frames it, `scene` brings it into view coordinates
//! and colours its faces, `shade` finds what is seen and how much light gets there, `lines` finds the edges worth drawing, `paint` makes
//! pixels of all that, and `canvas` writes beside it. `render` runs them, `sequence` makes files of several pictures. `raster` is the z-buffer
//! that all of these share.
//!
//! # Features
//! `text` (on unless turned off): letters. Without it dimensions and scale bars have no numbers, and contact sheets no titles; the font, of
//! 680 kB, and its reader are left out.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod canvas;
mod color;
mod error;
mod input;
mod lines;
mod paint;
mod picture;
mod raster;
mod render;
mod scene;
mod sequence;
mod shade;
mod view;

pub use error::PictureError;
pub use input::mesh::{Face, Paint, PaintedMesh, Tint};
pub use input::options::{Background, CameraKind, PreviewOptions, PreviewStyle};
pub use picture::{MAX_IMAGE_SIDE, Picture};
pub use render::buffers::{Buffers, render_buffers};
pub use render::render;
pub use sequence::animation::{AnimationFormat, AnimationWriter};
pub use sequence::sheet::{SheetColors, SheetLayout, Tile, contact_sheet, sheet_layout};
pub use sequence::turntable::Turntable;
