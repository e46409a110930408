//! A boundary that is evaluated again by each edit, its faces numbered on.

use std::cmp::Ordering;
use std::sync::OnceLock;

use planecut_kernel::DVec3;

use super::LiveFace;
use crate::base::{Ray, RayCaster};
use crate::ids::{FaceId, Id, number32};
use crate::mesh::Mesh;
use crate::model::Material;

/// The boundary of a model some of whose leaves are closed meshes.
#[derive(Clone, Default)]
pub(super) struct EvaluatedBoundary {
    mesh: Mesh,
    /// Where the triangles of each face begin, and last where those of the last one end.
    starts: Vec<u32>,
    /// The number of each face.
    ids: Vec<FaceId>,
    /// The face that has each number.
    by_id: Vec<Option<u32>>,
    /// The faces, sorted by what they are.
    order: Vec<u32>,
    /// The triangles, for rays; made when first asked for.
    rays: OnceLock<RayCaster>,
}

impl EvaluatedBoundary {
    /// The boundary that takes the place of this one, the numbers of the faces that are gone, and those of the ones that are new. Faces
    /// that are the same to the last bit keep their numbers.
    pub(super) fn replaced_by(&self, mesh: Mesh) -> (Self, Vec<FaceId>, Vec<FaceId>) {
        let mut new = Self::unnumbered(mesh);
        let mut removed = Vec::new();
        let mut old = self.order.iter().copied().peekable();
        for face in new.order.clone() {
            let order = |old: u32| self.description(old).cmp(new.description(face));
            while let Some(gone) = old.next_if(|old| order(*old) == Ordering::Less) {
                removed.push(self.ids[gone as usize]);
            }
            if let Some(same) = old.next_if(|old| order(*old) == Ordering::Equal) {
                new.ids[face as usize] = self.ids[same as usize];
            }
        }
        removed.extend(old.map(|gone| self.ids[gone as usize]));
        removed.sort_unstable();
        let added = new.number();
        (new, removed, added)
    }

    fn unnumbered(mesh: Mesh) -> Self {
        let faces = mesh.faces.len();
        let starts = (0..=faces).map(|face| number32(mesh.triangle_faces.partition_point(|of| (*of as usize) < face)));
        let starts = starts.collect();
        let mut new = Self { mesh, starts, ids: vec![FaceId::NONE; faces], ..Self::default() };
        let mut order: Vec<u32> = (0..number32(faces)).collect();
        order.sort_by(|a, b| new.description(*a).cmp(new.description(*b)));
        new.order = order;
        new
    }

    /// Gives faces without a number the least ones that are free; gives these.
    fn number(&mut self) -> Vec<FaceId> {
        let numbered = self.ids.iter().filter(|id| **id != FaceId::NONE).map(|id| id.index() + 1);
        self.by_id = vec![None; numbered.max().unwrap_or(0).max(self.ids.len())];
        for (face, id) in (0..).zip(&self.ids) {
            if *id != FaceId::NONE {
                self.by_id[id.index()] = Some(face);
            }
        }
        let free: Vec<usize> = (0..self.by_id.len()).filter(|number| self.by_id[*number].is_none()).collect();
        let mut added = Vec::new();
        let new = (0..).zip(&mut self.ids).filter(|(_, id)| **id == FaceId::NONE);
        for ((face, id), number) in new.zip(free) {
            *id = FaceId::from_index(number);
            self.by_id[number] = Some(face);
            added.push(*id);
        }
        added
    }

    /// All that a face is, as numbers: equal for equal faces.
    fn description(&self, face: u32) -> impl Iterator<Item = u64> + '_ {
        let bits = |place: DVec3| place.to_array().map(f64::to_bits);
        let entry = &self.mesh.faces[face as usize];
        let corners = self.triangles(face).iter().flatten();
        let places = corners.flat_map(move |vertex| bits(self.mesh.positions[*vertex as usize]));
        places.chain(bits(entry.normal)).chain([u64::from(entry.material.0)])
    }

    fn triangles(&self, face: u32) -> &[[u32; 3]] {
        let [start, end] = [face, face + 1].map(|face| self.starts[face as usize] as usize);
        &self.mesh.triangles[start..end]
    }

    pub(super) fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    pub(super) fn add_material(&mut self, material: Material) {
        self.mesh.materials.push(material);
    }

    /// Forgets all materials but the first ones, which no face names.
    pub(super) fn keep_materials(&mut self, count: usize) {
        self.mesh.materials.truncate(count);
    }

    pub(super) fn face(&self, id: FaceId) -> Option<LiveFace<'_>> {
        let face = (*self.by_id.get(id.index())?)?;
        Some(LiveFace::evaluated(&self.mesh, self.triangles(face), self.mesh.faces[face as usize].material))
    }

    /// The first face that a ray meets, and how far away that is.
    pub(super) fn first_hit(&self, ray: &Ray) -> Option<(FaceId, f64)> {
        let at = |vertex: u32| self.mesh.positions[vertex as usize];
        let rays = self
            .rays
            .get_or_init(|| RayCaster::new(self.mesh.triangles.iter().map(|triangle| triangle.map(at)).collect()));
        let (triangle, distance) = rays.first_hit(ray)?;
        Some((self.ids[self.mesh.triangle_faces[triangle as usize] as usize], distance))
    }

    /// The numbers of all faces.
    pub(super) fn ids(&self) -> &[FaceId] {
        &self.ids
    }
}
