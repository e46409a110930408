//! What tests of several crates share. For tests only: no crate of the product depends on it but for its tests.
//!
//! - [`random`]: the one seeded generator; a printed seed repeats a test on every machine.
//! - [`corpus`]: files that the fuzzer found worth keeping;
//! - [`data`]: files that others made, and tests that are ignored where these are absent;
//! - [`textured`]: meshes with texture coordinates, as files, and what these must be where;
//! - with the feature `csg`: [`scene`] builds, draws, shrinks and prints models, [`generate`] draws them at random,
//!   [`pencils`] draws those with many faces around a line, [`soundness`] has what must hold of every mesh, [`sheets`] finds lines along which a surface passes through itself,
//!   [`meshes`] has some that are made by hand, [`edited`] models of any size for edits;
//! - with the feature `cells`: [`shape`] has trees whose value at a point is known from their half-spaces alone;
//! - with the feature `serde`: [`saved`] writes data types and reads them again.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod corpus;
pub mod data;
#[cfg(feature = "csg")]
pub mod edited;
#[cfg(feature = "csg")]
pub mod generate;
#[cfg(feature = "csg")]
pub mod meshes;
#[cfg(feature = "csg")]
pub mod pencils;
pub mod random;
#[cfg(feature = "serde")]
pub mod saved;
#[cfg(feature = "csg")]
pub mod scene;
#[cfg(feature = "cells")]
pub mod shape;
#[cfg(feature = "csg")]
pub mod sheets;
#[cfg(feature = "csg")]
pub mod soundness;
pub mod textured;
