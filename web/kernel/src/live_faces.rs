//! Faces of a live model: one by one, as renderers take them, and as they would be after an edit.

use planecut::csg::{FaceId, LiveModel, Preview as CorePreview, PreviewFace};
use planecut::kernel::DVec3;
use wasm_bindgen::prelude::*;

/// A planar, connected region of the boundary, of one material.
#[wasm_bindgen(getter_with_clone)]
#[derive(Clone)]
pub struct Face {
    /// The brush that it is of, where that is known.
    pub brush: Option<f64>,
    /// The plane of that brush.
    pub plane: Option<f64>,
    /// The name of what it is made of.
    pub material: String,
    /// The unit outward normal.
    pub normal: Vec<f64>,
    /// x, y and z of each corner.
    pub positions: Vec<f64>,
    /// Three numbers of corners of each triangle, counter-clockwise seen from outside.
    pub triangles: Vec<u32>,
}

impl Face {
    /// A face that is there.
    pub(crate) fn of(live: &LiveModel, id: FaceId) -> Self {
        let face = live.face(id).expect("callers name faces that are there");
        let (positions, triangles) = face.indexed();
        let source = live.source_of_face(id);
        Self {
            brush: source.map(|(brush, _)| brush.0 as f64),
            plane: source.map(|(_, plane)| plane.0 as f64),
            material: live.materials()[face.material().0 as usize].name.clone(),
            normal: face.normal().to_array().to_vec(),
            positions: positions.iter().flat_map(DVec3::to_array).collect(),
            triangles: triangles.as_flattened().to_vec(),
        }
    }
}

/// Faces in single precision, in one list of vertices and one of triangles. Faces share no vertices.
#[wasm_bindgen(getter_with_clone)]
pub struct Buffers {
    /// The corners relative to the centre.
    pub positions: Vec<f32>,
    /// The unit outward normal at each corner.
    pub normals: Vec<f32>,
    /// Three numbers of corners of each triangle.
    pub indices: Vec<u32>,
    /// The numbers of the faces.
    pub faces: Vec<u32>,
    /// For each face the name of what it is made of.
    pub materials: Vec<String>,
    /// Where the corners of each face begin, and last where those of the last one end.
    #[wasm_bindgen(js_name = vertexStarts)]
    pub vertex_starts: Vec<u32>,
    /// Where the triangles of each face begin, and last where those of the last one end.
    #[wasm_bindgen(js_name = indexStarts)]
    pub index_starts: Vec<u32>,
}

impl Buffers {
    pub(crate) fn of(live: &LiveModel, faces: &[FaceId], center: DVec3) -> Self {
        let core = live.buffers(faces, center);
        let vertex_ends = core.faces.iter().map(|face| face.vertices.end);
        let index_ends = core.faces.iter().map(|face| face.triangles.end);
        let name = |material: usize| live.materials()[material].name.clone();
        Self {
            vertex_starts: std::iter::once(0).chain(vertex_ends).collect(),
            index_starts: std::iter::once(0).chain(index_ends).collect(),
            materials: core.faces.iter().map(|face| name(face.material.0 as usize)).collect(),
            faces: core.faces.iter().map(|face| u32::from(face.face)).collect(),
            positions: core.positions.as_flattened().to_vec(),
            normals: core.normals.as_flattened().to_vec(),
            indices: core.indices.as_flattened().to_vec(),
        }
    }
}

/// What an edit would change.
#[wasm_bindgen(getter_with_clone)]
pub struct Preview {
    /// By how much the volume would grow.
    #[wasm_bindgen(js_name = volumeChange)]
    pub volume_change: f64,
    /// The numbers of the brushes that would come, go or change.
    pub brushes: Vec<f64>,
    /// The numbers of the faces that would be no more.
    pub removed: Vec<u32>,
    /// The faces that would be new.
    pub added: Vec<Face>,
}

impl Preview {
    pub(crate) fn of(core: CorePreview, names: &[String]) -> Self {
        let face = |face: PreviewFace| Face {
            brush: None,
            plane: None,
            material: names[face.material.0 as usize].clone(),
            normal: face.normal.to_array().to_vec(),
            positions: face.positions.iter().flat_map(DVec3::to_array).collect(),
            triangles: face.triangles.as_flattened().to_vec(),
        };
        Self {
            volume_change: core.volume_change,
            brushes: core.brushes.iter().map(|brush| brush.0 as f64).collect(),
            removed: core.removed.into_iter().map(u32::from).collect(),
            added: core.added.into_iter().map(face).collect(),
        }
    }
}
