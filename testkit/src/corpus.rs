//! Files that the fuzzer found worth keeping.

use std::fs;
use std::path::{Path, PathBuf};

/// Each file of the corpus of a fuzz target, and what it holds.
///
/// # Panics
/// Where the folder or a file of it cannot be read.
pub fn fuzz_corpus(target: &str) -> impl Iterator<Item = (PathBuf, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/corpus").join(target);
    let files = fs::read_dir(&folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    files.map(|file| {
        let path = file.expect("a folder that can be listed").path();
        let bytes = fs::read(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        (path, bytes)
    })
}
