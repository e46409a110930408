//! planecut, a convex-CSG modeling kernel.
#![forbid(unsafe_code)]
#![deny(missing_docs)]
