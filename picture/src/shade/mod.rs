//! What is seen in each cell of a few pixels, and how much light gets there.

pub(crate) mod light;
pub(crate) mod occlusion;
pub(crate) mod shadow;
pub(crate) mod surface;
