//! The fuzzing corpus of closed meshes without the fuzzer.

use planecut_testkit::corpus::fuzz_corpus;

#[path = "../../../fuzz/fuzz_targets/meshes/checks.rs"]
mod checks;
#[path = "../../../fuzz/fuzz_targets/meshes/decode.rs"]
mod decode;

#[test]
fn corpus_of_the_fuzzer() {
    let mut scenes = 0;
    for (path, bytes) in fuzz_corpus("meshes") {
        let Some(scene) = decode::scene(&bytes) else { continue };
        if let Err(error) = checks::check(&scene) {
            panic!("{}: {error}\n{scene}", path.display());
        }
        scenes += 1;
    }
    assert!(scenes > 0, "found no file with a scene");
}
