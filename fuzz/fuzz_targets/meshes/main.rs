//! Trees over small closed meshes and a brush: what is evaluated is sound, and volumes follow set algebra.
//!
//! See `README.md` for how to run it and how to read a finding.
#![no_main]

mod checks;
mod decode;

use libfuzzer_sys::{Corpus, fuzz_target};

fuzz_target!(|bytes: &[u8]| -> Corpus {
    let Some(scene) = decode::scene(bytes) else { return Corpus::Reject };
    if let Err(error) = checks::check(&scene) {
        panic!("{error}\n{scene}");
    }
    Corpus::Keep
});
