//! Packed buffer views in a build without the feature `meshopt`: an error.

use super::super::error::{Fault, Place};
use super::document::PackedView;

/// The bytes of a view from its packed ones: this build cannot tell.
pub(super) fn unpack(_: &PackedView, _: &[u8], place: &Place) -> Result<Vec<u8>, Fault> {
    let found = "packed bytes, and a program built without the feature `meshopt`";
    Err(Fault::new(place.clone(), found, "one that is built with it"))
}
