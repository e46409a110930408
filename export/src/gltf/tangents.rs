//! Tangents by MikkTSpace, the way that bakers of normal maps agreed on.

use bevy_mikktspace::{Geometry as MikkGeometry, TangentSpace, generate_tangents};
use glam::{DVec3, Vec3};
use rustc_hash::FxHashMap;

use crate::surface::Vertices;

/// Triangles with the tangents of their corners.
struct Corners<'a> {
    vertices: &'a Vertices,
    positions: &'a [DVec3],
    origin: DVec3,
    tangents: Vec<[f32; 4]>,
}

impl Corners<'_> {
    fn vertex(&self, face: usize, corner: usize) -> usize {
        self.vertices.corners[3 * face + corner] as usize
    }
}

impl MikkGeometry for Corners<'_> {
    fn num_faces(&self) -> usize {
        self.vertices.corners.len() / 3
    }

    fn num_vertices_of_face(&self, _: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        let origin = self.vertices.origins[self.vertex(face, corner)];
        (self.positions[origin as usize] - self.origin).as_vec3().to_array()
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        self.vertices.normals[self.vertex(face, corner)]
    }

    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        let [u, v] = self.vertices.texture[self.vertex(face, corner)];
        // MikkTSpace has v run up, glTF down
        [u, 1.0 - v]
    }

    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, corner: usize) {
        let normal = Vec3::from(self.normal(face, corner));
        let [x, y, z, w] = space.map_or([0.0; 4], |space| space.tangent_encoded());
        let tangent = Vec3::new(x, y, z).reject_from_normalized(normal).try_normalize();
        // where texture coordinates say nothing any tangent is as good
        let tangent = tangent.unwrap_or_else(|| normal.any_orthonormal_vector());
        let handedness = if w < 0.0 { -1.0 } else { 1.0 };
        self.tangents[3 * face + corner] = (tangent + Vec3::ZERO).extend(handedness).to_array();
    }
}

/// The tangent and handedness of each vertex; vertices whose triangles have different ones are split.
pub(super) fn tangents(vertices: &mut Vertices, positions: &[DVec3], origin: DVec3) -> Vec<[f32; 4]> {
    let count = vertices.corners.len();
    let mut corners = Corners { vertices, positions, origin, tangents: vec![[1.0, 0.0, 0.0, 1.0]; count] };
    // it fails for nothing but more corners than numbers, which was seen to
    let _ = generate_tangents(&mut corners);
    let of_corners = corners.tangents;
    let mut of_vertices: Vec<Option<[f32; 4]>> = vec![None; vertices.origins.len()];
    let mut split: FxHashMap<(u32, [u32; 4]), u32> = FxHashMap::default();
    for (place, tangent) in of_corners.into_iter().enumerate() {
        let vertex = vertices.corners[place];
        let known = of_vertices[vertex as usize].get_or_insert(tangent);
        if *known == tangent {
            continue;
        }
        let copy = *split.entry((vertex, tangent.map(f32::to_bits))).or_insert_with(|| {
            of_vertices.push(Some(tangent));
            vertices.repeat(vertex)
        });
        vertices.corners[place] = copy;
    }
    of_vertices.into_iter().map(|tangent| tangent.unwrap_or([1.0, 0.0, 0.0, 1.0])).collect()
}
