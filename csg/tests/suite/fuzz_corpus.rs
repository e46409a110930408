//! The fuzzing corpus of closed meshes without the fuzzer.

use std::fs;
use std::path::Path;

#[path = "../../../fuzz/fuzz_targets/meshes/checks.rs"]
mod checks;
#[path = "../../../fuzz/fuzz_targets/meshes/decode.rs"]
mod decode;

#[test]
fn corpus_of_the_fuzzer() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/corpus/meshes");
    let mut scenes = 0;
    for file in fs::read_dir(&folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display())) {
        let path = file.expect("a folder that can be listed").path();
        let bytes = fs::read(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let Some(scene) = decode::scene(&bytes) else { continue };
        if let Err(error) = checks::check(&scene) {
            panic!("{}: {error}\n{scene}", path.display());
        }
        scenes += 1;
    }
    assert!(scenes > 0, "found no file with a scene in {}", folder.display());
}
