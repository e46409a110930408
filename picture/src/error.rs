//! What can go wrong when a picture is drawn or encoded.

use std::io;

/// Why a picture could not be drawn or encoded. Each message is one line.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PictureError {
    /// The mesh refers to something that it does not hold, or holds a value that is not a number.
    #[error("invalid mesh: {0}")]
    InvalidMesh(String),
    /// The picture has a side of 0 or more than [`crate::MAX_IMAGE_SIDE`] pixels.
    #[error("picture size is {width}x{height}, expected 1 to 16384 pixels each way")]
    ImageSize {
        /// Width asked for, in pixels.
        width: u32,
        /// Height asked for, in pixels.
        height: u32,
    },
    /// A contact sheet has no room for its tiles, or nothing to show.
    #[error(
        "{count} pictures on a sheet of {width}x{height} pixels{}, expected at least 1 and room for all",
        .columns.map_or(String::new(), |columns| format!(" in {columns} columns"))
    )]
    SheetSize {
        /// Width of the sheet, in pixels.
        width: u32,
        /// Height of the sheet, in pixels.
        height: u32,
        /// Number of pictures.
        count: usize,
        /// Number of pictures side by side, where that was asked for.
        columns: Option<u32>,
    },
    /// A camera angle is not a finite number.
    #[error("camera angle is {0}, expected a finite number of degrees")]
    CameraAngle(f64),
    /// The file name ends in something that no writer of animations makes.
    #[error("unknown animation format '.{extension}', expected .gif or .apng")]
    UnknownAnimationFormat {
        /// The ending as given, without the dot.
        extension: String,
    },
    /// A frame of an animation is not as large as the animation.
    #[error("a frame is {}x{} pixels, expected {}x{}", .found[0], .found[1], .expected[0], .expected[1])]
    FrameSize {
        /// Width and height of the frame, in pixels.
        found: [u32; 2],
        /// Width and height of the animation, in pixels.
        expected: [u32; 2],
    },
    /// An animation has more or fewer frames than were announced.
    #[error("found {found} frames, expected {expected}")]
    FrameCount {
        /// Number of frames given.
        found: u32,
        /// Number of frames announced.
        expected: u32,
    },
    /// A number does not fit the format of the picture.
    #[error("the mesh is too large for the format: {what}")]
    TooLarge {
        /// Which number.
        what: String,
    },
    /// A picture has more or fewer pixels than it says, or a library below failed to encode it.
    #[error("cannot encode {format}: {message}")]
    Encode {
        /// The format that was being written.
        format: &'static str,
        /// What is wrong.
        message: String,
    },
    /// What is written to takes no more.
    #[error("cannot write: {0}")]
    Io(#[from] io::Error),
}
