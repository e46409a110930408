//! Draws the figures of `docs/kernel.md` with the kernel's public interface:
//! `cargo run -p planecut-kernel --example figures -- docs/figures`.
//!
//! The test `figures` of the crate draws them again and compares them with the files, byte by byte.

mod body;
mod camera;
mod color;
mod scenes;
mod svg;

use std::error::Error;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args_os().nth(1).ok_or("usage: figures FOLDER")?);
    std::fs::create_dir_all(&folder)?;
    for (name, figure) in scenes::all()? {
        std::fs::write(folder.join(name), figure)?;
    }
    Ok(())
}
