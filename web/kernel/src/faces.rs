//! Faces of a live model as typed arrays.

use js_sys::{Float32Array, Float64Array, Uint32Array};
use planecut::csg::{FaceId, LiveModel};
use planecut::kernel::DVec3;
use rustc_hash::FxHashMap;
use wasm_bindgen::prelude::*;

/// Faces as a renderer takes them. Positions are relative to a centre, and each face has vertices of its own.
#[wasm_bindgen(getter_with_clone)]
#[derive(Clone)]
pub struct Faces {
    /// The number of each face.
    pub ids: Uint32Array,
    /// The number of each face's material.
    pub materials: Uint32Array,
    /// For each face the brush and the plane that it is of, -1 where there is none.
    pub sources: Float64Array,
    /// For each face how many vertices, triangles and outline segments it has.
    pub counts: Uint32Array,
    /// x, y and z of each vertex, face by face.
    pub positions: Float32Array,
    /// The unit outward normal of each face.
    pub normals: Float32Array,
    /// Three vertices of each triangle, counted within the face, counter-clockwise seen from outside.
    pub triangles: Uint32Array,
    /// Two vertices of each segment of the face's outline, counted within the face.
    pub outlines: Uint32Array,
}

impl Faces {
    pub(crate) fn of(live: &LiveModel, faces: &[FaceId], center: DVec3) -> Self {
        let buffers = live.buffers(faces, center);
        let (mut ids, mut materials, mut sources) = (Vec::new(), Vec::new(), Vec::new());
        let (mut counts, mut normals) = (Vec::new(), Vec::new());
        let (mut triangles, mut outlines) = (Vec::with_capacity(3 * buffers.indices.len()), Vec::new());
        let mut open = FxHashMap::default();
        for range in &buffers.faces {
            let (first, last) = (range.vertices.start, range.triangles.end as usize);
            let of_face = &buffers.indices[range.triangles.start as usize..last];
            let before = outlines.len();
            append_outline(of_face, first, &mut open, &mut outlines);
            triangles.extend(of_face.iter().flatten().map(|vertex| vertex - first));
            ids.push(u32::from(range.face));
            materials.push(range.material.0);
            let source = live.source_of_face(range.face);
            sources.extend(source.map_or([-1.0; 2], |(brush, plane)| [brush.0 as f64, plane.0 as f64]));
            let segments = (outlines.len() - before) / 2;
            counts.extend([range.vertices.end - first, of_face.len() as u32, segments as u32]);
            normals.extend(buffers.normals[first as usize]);
        }
        Self {
            ids: Uint32Array::from(&ids[..]),
            materials: Uint32Array::from(&materials[..]),
            sources: Float64Array::from(&sources[..]),
            counts: Uint32Array::from(&counts[..]),
            positions: Float32Array::from(buffers.positions.as_flattened()),
            normals: Float32Array::from(&normals[..]),
            triangles: Uint32Array::from(&triangles[..]),
            outlines: Uint32Array::from(&outlines[..]),
        }
    }
}

/// Adds the edges that one triangle of a face alone has; `open` is a buffer.
fn append_outline(triangles: &[[u32; 3]], first: u32, open: &mut FxHashMap<[u32; 2], bool>, outlines: &mut Vec<u32>) {
    open.clear();
    for &[a, b, c] in triangles {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            let key = [from.min(to), from.max(to)];
            open.entry(key).and_modify(|is_open| *is_open = false).or_insert(true);
        }
    }
    for &[a, b, c] in triangles {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            if open[&[from.min(to), from.max(to)]] {
                outlines.extend([from - first, to - first]);
            }
        }
    }
}

/// What an edit has done.
#[wasm_bindgen(getter_with_clone)]
pub struct Edited {
    /// The answer to the message, as JSON.
    pub answer: String,
    /// Numbers of faces that are no more.
    pub removed: Uint32Array,
    /// The faces that are new.
    pub added: Faces,
}
