//! Damaged mesh files: truncated at every length, with bits flipped, with words swapped. Nothing may panic, and what is still
//! read must keep the promises of `IndexedMesh`.

use planecut_import::mesh::{MeshFormat, read_mesh};
use planecut_testkit::random::Rng;

#[cfg(feature = "meshopt")]
use super::support::packed::{Positions, packed_cube};
use super::support::{glb, obj, ply, split_cube, stl_ascii, stl_binary};

fn files() -> Vec<(MeshFormat, Vec<u8>)> {
    let (json, buffer) = split_cube(
        r#""scenes": [{"nodes": [0]}], "nodes": [{"children": [1]}, {"mesh": 0, "rotation": [0, 0, 1, 0], "scale": [1, 2, 3]}]"#,
        "",
    );
    let mut files = vec![
        (MeshFormat::Obj, obj().into_bytes()),
        (MeshFormat::Stl, stl_binary()),
        (MeshFormat::Stl, stl_ascii().into_bytes()),
        (MeshFormat::Ply, ply("ascii")),
        (MeshFormat::Ply, ply("binary_little_endian")),
        (MeshFormat::Ply, ply("binary_big_endian")),
        (MeshFormat::Gltf, glb(&json, &buffer)),
    ];
    files.extend(packed_files());
    files
}

#[cfg(feature = "meshopt")]
fn packed_files() -> Vec<(MeshFormat, Vec<u8>)> {
    let cubes = [(Positions::Exponential, "TRIANGLES", 2), (Positions::Shorts, "INDICES", 4)];
    let files = cubes.map(|(positions, mode, width)| packed_cube(positions, mode, width));
    files.map(|(json, buffer)| (MeshFormat::Gltf, glb(&json, &buffer))).to_vec()
}

/// Without the feature that reads them there are none to damage.
#[cfg(not(feature = "meshopt"))]
fn packed_files() -> Vec<(MeshFormat, Vec<u8>)> {
    Vec::new()
}

/// Reads what may be damaged; whether it could be read.
fn try_read(bytes: &[u8], format: MeshFormat, context: &str) -> bool {
    match read_mesh(bytes, format, "file") {
        Ok(mesh) => {
            assert!(mesh.positions.iter().all(|p| p.is_finite()), "{context}");
            assert!(mesh.triangles.as_flattened().iter().all(|&v| (v as usize) < mesh.positions.len()), "{context}");
            let ranges = mesh.objects.iter().map(|o| o.triangles.clone());
            let end = ranges.fold(0, |end, range| {
                assert!(range.start == end && range.end > end, "{context}");
                range.end
            });
            assert!(end == mesh.triangles.len() && end > 0, "{context}");
            true
        }
        Err(error) => {
            let message = error.to_string();
            assert!(message.starts_with("file:") && !message.contains(['\n', '\r']), "{context}: {message:?}");
            false
        }
    }
}

#[test]
fn truncated_files_are_errors_or_whole_meshes() {
    for (format, bytes) in files() {
        for length in 0..bytes.len() {
            try_read(&bytes[..length], format, &format!("{format:?} cut at {length}"));
        }
        assert!(try_read(&bytes, format, "whole"));
    }
}

#[test]
fn flipped_bytes_do_no_harm() {
    let seed = 0x5eed_3002;
    let mut random = Rng::new(seed);
    for (format, whole) in files() {
        let (mut read, mut refused) = (0, 0);
        for case in 0..6000 {
            let mut bytes = whole.clone();
            for _ in 0..=random.below(3) {
                let at = random.below(bytes.len());
                bytes[at] = match random.below(4) {
                    0 => bytes[at] ^ 1 << random.below(8),
                    1 => 0xff,
                    2 => b"0129-.e/ \n"[random.below(10)],
                    _ => random.below(256) as u8,
                };
            }
            let context = format!("{format:?} seed {seed:#x} case {case}");
            if try_read(&bytes, format, &context) { read += 1 } else { refused += 1 }
        }
        assert!(read > 0 && refused > 0, "{format:?}: {read} read, {refused} refused");
    }
}

#[test]
fn spliced_and_repeated_pieces_do_no_harm() {
    let seed = 0x5eed_3003;
    let mut random = Rng::new(seed);
    for (format, whole) in files() {
        for case in 0..2000 {
            let mut bytes = whole.clone();
            let from = random.below(bytes.len());
            let to = from + random.below(40.min(bytes.len() - from));
            let piece = bytes[from..to].to_vec();
            let at = random.below(bytes.len());
            if random.below(2) == 0 {
                bytes.splice(at..at, piece);
            } else {
                bytes.drain(from..to);
            }
            try_read(&bytes, format, &format!("{format:?} seed {seed:#x} case {case}"));
        }
    }
}
