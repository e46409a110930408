//! Where the faces of a mesh come from.

use crate::ids::number32;
use rustc_hash::FxHashMap;

use super::{MaterialId, MeshBody, Model, TextureAxes};

/// A face of a brush that faces of a mesh come from.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct FaceSource {
    /// The brush, by its place among the leaves.
    pub brush: u32,
    /// The plane, by its place among the faces of the brush; of a closed mesh the surface, by its place among its materials.
    pub plane: u32,
    /// How its texture lies.
    pub texture: Option<TextureAxes>,
}

impl Model {
    /// The same model with a material of its own for every face of a brush, or, unless `by_face`, for all faces of one material whose
    /// textures lie alike; and for each of the new materials where it comes from. Faces of a mesh are of one material: so each face of
    /// what is made of the new model comes from one source. New materials keep names and looks; several are alike.
    ///
    /// `textures` has for each brush how the textures of its faces lie; what it lacks is not known. Closed meshes have [textures](MeshBody::textures) of
    /// their own, which are taken where the meshes end up.
    #[must_use]
    pub fn split_by_source(&self, textures: &[Vec<Option<TextureAxes>>], by_face: bool) -> (Self, Vec<FaceSource>) {
        let mut split = Self { materials: Vec::new(), tree: self.tree.clone() };
        let mut sources = Vec::new();
        let mut known: FxHashMap<(MaterialId, Option<[u64; 13]>), MaterialId> = FxHashMap::default();
        for (number, brush) in split.tree.brushes_mut().iter_mut().enumerate() {
            let own = brush.mesh.as_ref().map(MeshBody::moved_textures).filter(|own| !own.is_empty());
            let of_brush: &[Option<TextureAxes>] = match &own {
                Some(own) => own,
                None => textures.get(number).map_or(&[], Vec::as_slice),
            };
            for (plane, material) in brush.materials_mut().enumerate() {
                let texture = of_brush.get(plane).copied().flatten();
                let old = *material;
                let mut new = || {
                    // a number that is not in the list stays out of it
                    split.materials.push(self.materials.get(old.0 as usize)?.clone());
                    sources.push(FaceSource { brush: number32(number), plane: number32(plane), texture });
                    Some(MaterialId(number32(sources.len()) - 1))
                };
                let key = (old, texture.map(|texture| texture.bits()));
                let id = match known.get(&key) {
                    Some(id) if !by_face => Some(*id),
                    _ => new(),
                };
                if let Some(id) = id {
                    known.insert(key, id);
                    *material = id;
                }
            }
        }
        (split, sources)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::evaluate;
    use crate::model::{Brush, Material, TextureUnit, Tree};
    use glam::{DVec2, DVec3};

    #[test]
    fn each_face_of_a_mesh_has_one_source() {
        let block = |x: f64| Brush::cuboid(DVec3::new(x, 0.0, 0.0), DVec3::new(x + 1.0, 1.0, 1.0), MaterialId(0));
        let tree = Tree::union_of(vec![block(0.0), block(1.0)]);
        let model = Model { materials: vec![Material::named("stone")], tree };
        let lying =
            TextureAxes { u: DVec3::X, v: DVec3::Y, offset: DVec2::ZERO, unit: TextureUnit::Texels, anchor: None };
        let textures = vec![vec![None; 6], vec![Some(lying); 6]];
        for (by_face, count, faces) in [(false, 2, 10), (true, 12, 10)] {
            let (split, sources) = model.split_by_source(&textures, by_face);
            assert_eq!((split.materials.len(), sources.len()), (count, count));
            let mesh = evaluate(&split).expect("two blocks").mesh;
            assert_eq!(mesh.faces.len(), faces);
            for (triangle, face) in mesh.triangles.iter().zip(&mesh.triangle_faces) {
                let source = sources[mesh.faces[*face as usize].material.0 as usize];
                let second = triangle.iter().all(|corner| mesh.positions[*corner as usize].x >= 1.0);
                assert_eq!(source.texture.is_some(), second, "{source:?}");
                assert_eq!(source.brush, u32::from(second));
            }
        }
        let whole = evaluate(&model).expect("two blocks").mesh;
        assert_eq!(whole.faces.len(), 6, "one material: faces go across both");
    }
}
