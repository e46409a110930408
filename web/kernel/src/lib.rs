//! The kernel for JavaScript, compiled to WebAssembly.
//!
//! [`editor`] is a live model that messages and calls drive: what the page in a browser has in its worker. [`faces`] and [`pieces`] are what a renderer takes: typed arrays, copied out of the module's
//! memory, so that they can be handed to another thread. [`encoding`] is what leaves as a file. Failures are exceptions ([`failure`]).
#![deny(missing_docs)]

mod colliders;
mod editor;
mod encoding;
mod faces;
mod failure;
mod pieces;

use wasm_bindgen::prelude::*;

/// The version of the package.
#[wasm_bindgen]
#[must_use]
pub fn version() -> String {
    env!("CARGO_PKG_VERSION").to_owned()
}
