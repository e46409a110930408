//! Sequences of operations, each checked in layers against the independent oracle.
//!
//! See `README.md` for how to run it and how to read a finding.
#![no_main]

use libfuzzer_sys::{Corpus, fuzz_target};
use planecut_kernel::IncrementalPolytope;
use planecut_oracle::check::check_in_layers;
use planecut_oracle::decode;
use planecut_oracle::replay::Replay;
use planecut_oracle::script::as_rust;

fuzz_target!(|bytes: &[u8]| -> Corpus {
    let ops = decode::script(bytes);
    if ops.is_empty() {
        return Corpus::Reject;
    }
    // without contraction: vertices are merged because they are equal, not because they are near
    let mut replay = Replay::new(IncrementalPolytope::with_epsilon(0.0));
    for (step, op) in ops.iter().enumerate() {
        if let Err(error) = replay.apply(op).and_then(|()| check_in_layers(&replay)) {
            panic!("after operation {step}: {error}\n{}", as_rust(&ops[..=step]));
        }
    }
    Corpus::Keep
});
