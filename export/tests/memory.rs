//! How much memory a large file takes while it is written. A program of its own, apart from the suite: the peak that the system tells is that of
//! the whole process.
#![cfg(target_os = "linux")]

mod peak_memory;

use planecut_export::{ExportOptions, Format, Part, write_parts};

use peak_memory::{Counter, peak};

#[test]
fn a_million_triangles_take_less_than_three_times_their_file() {
    let mesh = planecut_testkit::meshes::random_boxes(83_334, 1);
    assert!(mesh.triangles.len() >= 1_000_000);
    let Some(before) = peak() else {
        println!("skipped: this system does not tell");
        return;
    };
    let mut out = Counter(0);
    write_parts(&[Part::new("m", &mesh)], Format::Glb, &ExportOptions::default(), &mut out).expect("written");
    let ratio = peak().expect("told before") as f64 / out.0 as f64;
    println!("{} bytes, {before} bytes of memory before, {ratio:.2} times the file in all", out.0);
    assert!(ratio < 3.0, "{ratio}");
}
