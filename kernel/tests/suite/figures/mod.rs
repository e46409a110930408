//! The figures in `docs/figures` are what `examples/figures` draws today, byte by byte.
//!
//! Where this fails after a change that is meant, draw them again:
//! `cargo run -p planecut-kernel --example figures -- docs/figures`.

#[path = "../../../examples/figures/body.rs"]
mod body;
#[path = "../../../examples/figures/camera.rs"]
mod camera;
#[path = "../../../examples/figures/color.rs"]
mod color;
#[path = "../../../examples/figures/scenes/mod.rs"]
mod scenes;
#[path = "../../../examples/figures/svg.rs"]
mod svg;

use std::collections::BTreeSet;
use std::path::Path;

#[test]
fn the_committed_figures_are_what_the_program_draws() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/figures");
    let figures = scenes::all().expect("the scenes have accepted planes");
    for (name, drawn) in &figures {
        let committed = std::fs::read_to_string(folder.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(committed == *drawn, "{name} is not what the program draws");
    }
    let drawn: BTreeSet<String> = figures.iter().map(|(name, _)| (*name).to_owned()).collect();
    let present = std::fs::read_dir(&folder).expect("the folder of the figures is there");
    let present: BTreeSet<String> =
        present.map(|file| file.expect("it can be read").file_name().to_string_lossy().into_owned()).collect();
    assert_eq!(present, drawn, "every file in the folder is drawn by the program");
}
