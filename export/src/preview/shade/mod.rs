//! What is seen in each cell of a few pixels, and how much light gets there.

pub(super) mod light;
pub(super) mod occlusion;
pub(super) mod shadow;
pub(super) mod surface;
