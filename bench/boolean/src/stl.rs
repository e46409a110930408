//! Reads the binary STL files that meshes come in.

use std::collections::HashMap;
use std::path::Path;

use crate::scene::Body;

/// Bytes before the number of triangles, and of each triangle: its normal, three corners, and two bytes more.
const HEADER: usize = 80;
const RECORD: usize = 50;

/// The triangles of a file; corners at the same place are one.
pub(crate) fn read(file: &Path) -> Result<Body, String> {
    let bytes = std::fs::read(file).map_err(|error| format!("{}: {error}", file.display()))?;
    triangles(&bytes).ok_or_else(|| format!("{}: found {} bytes, expected a binary STL", file.display(), bytes.len()))
}

fn triangles(bytes: &[u8]) -> Option<Body> {
    let count = u32::from_le_bytes(bytes.get(HEADER..HEADER + 4)?.try_into().ok()?) as usize;
    let records = bytes.get(HEADER + 4..)?;
    if records.len() != count * RECORD {
        return None;
    }
    let mut body = Body::default();
    let mut places: HashMap<[u32; 3], u32> = HashMap::new();
    for record in records.chunks_exact(RECORD) {
        let corner = |k: usize| [0, 1, 2].map(|axis| number(record, 12 + 12 * k + 4 * axis));
        let corners = [0, 1, 2].map(corner).map(|place| {
            // -0 and 0 are one place
            *places.entry(place.map(|v| (v + 0.0).to_bits())).or_insert_with(|| {
                body.positions.push(place.map(f64::from));
                body.positions.len() as u32 - 1
            })
        });
        body.triangles.push(corners);
    }
    Some(body)
}

fn number(record: &[u8], at: usize) -> f32 {
    f32::from_le_bytes([record[at], record[at + 1], record[at + 2], record[at + 3]])
}

#[cfg(test)]
mod tests {
    use super::{HEADER, triangles};

    #[test]
    fn corners_are_joined() {
        let mut bytes = vec![0; HEADER];
        bytes.extend(2_u32.to_le_bytes());
        for corners in [[0.0_f32, 1.0, 2.0], [1.0, -0.0, 3.0]] {
            bytes.extend([0; 12]);
            corners.iter().for_each(|x| [*x, 0.0, 5.0].iter().for_each(|v: &f32| bytes.extend(v.to_le_bytes())));
            bytes.extend([0; 2]);
        }
        let body = triangles(&bytes).unwrap();
        assert_eq!(body.positions, [[0.0, 0.0, 5.0], [1.0, 0.0, 5.0], [2.0, 0.0, 5.0], [3.0, 0.0, 5.0]]);
        assert_eq!(body.triangles, [[0, 1, 2], [1, 0, 3]]);
        bytes.pop();
        assert_eq!(triangles(&bytes), None);
    }
}
