//! What is drawn, and how it is asked for.

pub(crate) mod bounds;
pub(crate) mod check;
pub(crate) mod explode;
pub(crate) mod mesh;
pub(crate) mod options;
