//! Looks for the data folder, so that tests that need it are listed as ignored where it is absent (`src/data.rs`).

use std::env;
use std::path::PathBuf;

fn main() {
    println!("cargo::rustc-check-cfg=cfg(has_data)");
    println!("cargo::rerun-if-env-changed=PLANECUT_DATA");
    println!("cargo::rerun-if-changed=build.rs");
    let beside = || PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("cargo sets it")).join("../../shared/data");
    let folder = env::var_os("PLANECUT_DATA").map_or_else(beside, PathBuf::from);
    // Only what exists may be watched: for a file that is absent all tests would be built again on every run.
    let part = folder.join("map/reference.json");
    if part.is_file() {
        println!("cargo::rustc-cfg=has_data");
        println!("cargo::rerun-if-changed={}", part.display());
    }
    println!("cargo::rustc-env=PLANECUT_DATA_FOLDER={}", folder.display());
}
