//! How much memory a large file takes while it is written. A program of its own, apart from the suite: the peak that the system tells is that of
//! the whole process.
#![cfg(target_os = "linux")]

use std::io::{self, Write};

use planecut_export::{ExportOptions, Format, Part, write_parts};

/// Counts bytes and forgets them.
struct Counter(u64);

impl Write for Counter {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0 += bytes.len() as u64;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// The most memory that this process ever had, in bytes.
fn peak() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    line.split_whitespace().nth(1)?.parse::<u64>().ok().map(|kilobytes| 1024 * kilobytes)
}

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
