//! Faces as renderers take them: positions in single precision, normals and indices.

use std::ops::Range;

use planecut_kernel::DVec3;
use rustc_hash::FxHashMap;

use super::{LiveFace, LiveModel};
use crate::ids::{FaceId, number32};
use crate::model::MaterialId;

/// A face as vertices and triangles.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FaceBuffers {
    /// The corners, each once, relative to the center that was given.
    pub positions: Vec<[f32; 3]>,
    /// The unit outward normal of all of them.
    pub normal: [f32; 3],
    /// Three corners each, counter-clockwise seen from outside.
    pub indices: Vec<[u32; 3]>,
}

/// Several faces in one list of vertices and one of triangles. Faces share no vertices, as each has a normal of its own.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ModelBuffers {
    /// The corners of all faces, face by face, relative to the center that was given.
    pub positions: Vec<[f32; 3]>,
    /// The unit outward normal at each.
    pub normals: Vec<[f32; 3]>,
    /// Three corners each, counted among all, counter-clockwise seen from outside.
    pub indices: Vec<[u32; 3]>,
    /// Which of these are each face's, in the order in which faces were asked for.
    pub faces: Vec<FaceRange>,
}

/// A face in [`ModelBuffers`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FaceRange {
    /// The face.
    pub face: FaceId,
    /// What it is made of.
    pub material: MaterialId,
    /// Its corners, of all positions.
    pub vertices: Range<u32>,
    /// Its triangles, of all indices.
    pub triangles: Range<u32>,
}

impl LiveFace<'_> {
    /// The face as vertices and triangles around a center near it: single precision has seven digits of what is left.
    #[must_use]
    pub fn buffers(&self, center: DVec3) -> FaceBuffers {
        let mut all = ModelBuffers::default();
        let normal = all.append(*self, center, &mut FxHashMap::default());
        FaceBuffers { positions: all.positions, normal, indices: all.indices }
    }
}

impl LiveModel {
    /// Faces as one list of vertices and triangles; those that are not there are left out. After an edit a renderer has to take the faces that
    /// it [added](super::Change::added).
    ///
    /// ```
    /// use planecut_csg::{Brush, LiveModel, Material, MaterialId, Role};
    /// use planecut_kernel::DVec3;
    ///
    /// # fn main() -> Result<(), planecut_csg::EditError> {
    /// let mut model = LiveModel::new(vec![Material::named("stone")]);
    /// let low = DVec3::splat(1e6);
    /// let (_, change) = model.add_brush(Brush::cuboid(low, low + DVec3::ONE, MaterialId(0)), Role::Add)?;
    /// let buffers = model.buffers(&change.added, low);
    /// assert_eq!((buffers.positions.len(), buffers.indices.len(), buffers.faces.len()), (24, 12, 6));
    /// assert!(buffers.positions.contains(&[1.0, 1.0, 1.0]));
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn buffers(&self, faces: &[FaceId], center: DVec3) -> ModelBuffers {
        let (mut all, mut places) = (ModelBuffers::default(), FxHashMap::default());
        for id in faces {
            let Some(face) = self.face(*id) else { continue };
            let [vertices, triangles] = [all.positions.len(), all.indices.len()].map(number32);
            let normal = all.append(face, center, &mut places);
            all.normals.resize(all.positions.len(), normal);
            all.faces.push(FaceRange {
                face: *id,
                material: face.material(),
                vertices: vertices..number32(all.positions.len()),
                triangles: triangles..number32(all.indices.len()),
            });
        }
        all
    }
}

impl ModelBuffers {
    /// Adds the corners and triangles of a face; gives its normal. `places` is a buffer.
    fn append(&mut self, face: LiveFace<'_>, center: DVec3, places: &mut FxHashMap<u32, u32>) -> [f32; 3] {
        let form = |at: DVec3| (at - center).as_vec3().to_array();
        face.append_indexed(&mut self.positions, &mut self.indices, form, places);
        face.normal().as_vec3().to_array()
    }
}
