//! Exploded views: parts moved away from the middle of all.

use glam::DVec3;

use super::bounds::{box_around, middle};
use super::mesh::{Face, PaintedMesh};

impl PaintedMesh<'_> {
    /// Several meshes as one, each moved as a whole. `spread` says how far: 0 leaves them where they are, with 1 the middles of their boxes
    /// are twice as far from the middle of all. Faces and paints follow one another in the order of the parts; parts without triangles are
    /// left out with their faces and paints.
    #[must_use]
    pub fn exploded(parts: &[PaintedMesh<'_>], spread: f64) -> PaintedMesh<'static> {
        let solid = parts.iter().filter(|part| !part.triangles.is_empty());
        let boxes: Vec<[DVec3; 2]> =
            solid.clone().filter_map(|part| box_around(part.positions.iter().copied())).collect();
        let center = box_around(boxes.iter().flatten().copied()).map_or(DVec3::ZERO, middle);
        let mut whole = PaintedMesh::default();
        for (part, own) in solid.zip(boxes) {
            whole.append(part, (middle(own) - center) * spread);
        }
        whole
    }
}

impl PaintedMesh<'static> {
    fn append(&mut self, part: &PaintedMesh<'_>, shift: DVec3) {
        let [first_vertex, first_face, first_paint] =
            [self.positions.len(), self.faces.len(), self.paints.len()].map(|length| length as u32);
        self.positions.extend(part.positions.iter().map(|&point| point + shift));
        let triangles = part.triangles.iter().map(|corners| corners.map(|corner| corner + first_vertex));
        self.triangles.to_mut().extend(triangles);
        self.triangle_faces.to_mut().extend(part.triangle_faces.iter().map(|face| face + first_face));
        self.faces.extend(part.faces.iter().map(|face| Face { paint: face.paint + first_paint, ..*face }));
        self.paints.extend_from_slice(&part.paints);
    }
}
