//! Texture coordinates of triangles as surfaces, each with a texture that is linear in space.

use glam::{DVec2, DVec3};
use planecut_csg::{MaterialId, TextureAxes};
use rustc_hash::FxHashMap;

/// The texture coordinates at the corners of a triangle.
pub(super) type Corners = [DVec2; 3];

/// Where upwards is counted from below, downwards is counted from above; and the other way round.
pub(super) fn turned(v: f64) -> f64 {
    1.0 - v
}

/// The coordinates of a triangle where all of its corners have some.
pub(super) fn of_corners([a, b, c]: [Option<DVec2>; 3]) -> Option<Corners> {
    Some([a?, b?, c?])
}

/// The coordinates of triangles by those of their vertices; none where vertices have none.
pub(super) fn of_vertices(triangles: &[[u32; 3]], of_vertex: &[DVec2]) -> Vec<Option<Corners>> {
    if of_vertex.is_empty() {
        return Vec::new();
    }
    let at = |vertex: u32| of_vertex.get(vertex as usize).copied();
    triangles.iter().map(|triangle| of_corners(triangle.map(at))).collect()
}

/// The same, empty where no triangle has any.
pub(super) fn known(textures: Vec<Option<Corners>>) -> Vec<Option<Corners>> {
    if textures.iter().any(Option::is_some) { textures } else { Vec::new() }
}

/// What triangles are made of: a material, and how its texture lies.
#[derive(Debug, Default)]
pub(super) struct Surfaces {
    /// The surface of each triangle.
    pub(super) of_triangle: Vec<u32>,
    /// The material of each surface.
    pub(super) materials: Vec<MaterialId>,
    /// The texture of each surface.
    pub(super) textures: Vec<Option<TextureAxes>>,
}

impl Surfaces {
    /// Those of some triangles. Triangles have the surface of one that they share an edge with where its texture gives them their own coordinates but for
    /// rounding, as on flat faces of several triangles; those without a texture have one for each material.
    pub(super) fn of(
        points: &[DVec3],
        triangles: &[[u32; 3]],
        materials: &[MaterialId],
        textures: &[Option<Corners>],
    ) -> Self {
        let mut surfaces = Self { of_triangle: Vec::with_capacity(triangles.len()), ..Self::default() };
        let mut plain: FxHashMap<MaterialId, u32> = FxHashMap::default();
        // for each edge the surface of the last triangle there
        let mut beside: FxHashMap<[u32; 2], u32> = FxHashMap::default();
        beside.reserve(triangles.len() * 3 / 2);
        for (number, triangle) in triangles.iter().enumerate() {
            let material = materials[number];
            let corners = triangle.map(|corner| points[corner as usize]);
            let own = textures.get(number).copied().flatten();
            let axes = own.and_then(|own| TextureAxes::of_triangle(corners, own));
            let (Some(own), Some(axes)) = (own, axes) else {
                let surface = *plain.entry(material).or_insert_with(|| surfaces.push(material, None));
                surfaces.of_triangle.push(surface);
                continue;
            };
            let [a, b, c] = *triangle;
            let edges = [[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)]);
            let is_one = |surface: &&u32| {
                let place = **surface as usize;
                let lies = surfaces.textures[place].is_some_and(|axes| axes.fits(corners, own));
                surfaces.materials[place] == material && lies
            };
            let known = edges.iter().filter_map(|edge| beside.get(edge)).find(is_one).copied();
            let surface = known.unwrap_or_else(|| surfaces.push(material, Some(axes)));
            surfaces.of_triangle.push(surface);
            beside.extend(edges.map(|edge| (edge, surface)));
        }
        surfaces
    }

    fn push(&mut self, material: MaterialId, texture: Option<TextureAxes>) -> u32 {
        self.materials.push(material);
        self.textures.push(texture);
        self.materials.len() as u32 - 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_of_a_flat_face_share_a_surface_and_others_do_not() {
        let points = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y, DVec3::new(2.0, 0.0, 1.0)];
        let triangles = [[0, 1, 2], [0, 2, 3], [1, 4, 2], [0, 3, 1], [0, 2, 3]];
        let at = |vertex: u32| points[vertex as usize].truncate();
        let mut textures: Vec<Option<Corners>> = triangles.iter().map(|corners| Some(corners.map(at))).collect();
        textures[2] = Some([1, 4, 2].map(at).map(|at| at * 0.5));
        textures[3] = None;
        let materials = [0, 0, 0, 0, 1].map(MaterialId);
        let surfaces = Surfaces::of(&points, &triangles, &materials, &textures);
        // flat and alike; laid otherwise; without coordinates; of another material
        assert_eq!(surfaces.of_triangle, [0, 0, 1, 2, 3]);
        assert_eq!(surfaces.materials, [0, 0, 0, 1].map(MaterialId));
        assert_eq!(surfaces.textures.iter().filter(|texture| texture.is_none()).count(), 1);
    }

    #[test]
    fn every_corner_has_its_coordinates() {
        let points: Vec<DVec3> = (0..40_u32).map(|k| DVec3::from([7, 11, 13].map(|m| f64::from(k * k % m)))).collect();
        let triangles: Vec<[u32; 3]> = (0..38).map(|k| [k, k + 1, k + 2]).collect();
        let textures: Vec<Option<Corners>> =
            triangles.iter().map(|t| Some(t.map(|k| DVec2::new(f64::from(k % 5), f64::from(k) / 3.0)))).collect();
        let surfaces = Surfaces::of(&points, &triangles, &vec![MaterialId(0); triangles.len()], &textures);
        for (number, triangle) in triangles.iter().enumerate() {
            let Some(axes) = surfaces.textures[surfaces.of_triangle[number] as usize] else { continue };
            for (corner, at) in triangle.iter().zip(textures[number].expect("some")) {
                assert!(axes.at(points[*corner as usize]).abs_diff_eq(at, 1e-12));
            }
        }
    }
}
