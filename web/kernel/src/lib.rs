//! The kernel for JavaScript, compiled to WebAssembly.
//!
//! [`editor`] is a live model that messages and calls drive: what the page in a browser has in its worker. [`faces`] and [`pieces`] are what a renderer takes: typed arrays, copied out of the module's
//! memory, so that they can be handed to another thread. [`encoding`] is what leaves as a file. Failures are exceptions ([`failure`]).
//!
//! The rest is behind the typed API of the package: [`solid`]s, made as [`shapes`] or read, their [`mesh`] and convex [`cell`]s, [`coarsened`] ones, and [`live`] models with their
//! [`live_faces`]. [`arguments`] are checked as they come in; a bug is an exception, too ([`panics`]).
#![deny(missing_docs)]

mod arguments;
mod cell;
mod coarsened;
mod colliders;
mod editor;
mod encoding;
mod faces;
mod failure;
mod live;
mod live_faces;
mod mesh;
mod panics;
mod pieces;
mod shapes;
mod solid;

use wasm_bindgen::prelude::*;

/// The version of the package.
#[wasm_bindgen]
#[must_use]
pub fn version() -> String {
    env!("CARGO_PKG_VERSION").to_owned()
}
