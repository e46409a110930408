//! From the world to places on the picture.

pub(crate) mod camera;
pub(crate) mod lens;
