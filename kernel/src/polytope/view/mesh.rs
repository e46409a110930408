//! The boundary as a polygon mesh.

use glam::DVec3;

use super::super::IncrementalPolytope;
use crate::half_space::{HalfSpace, MAX_OFFSET_RATIO};

impl IncrementalPolytope {
    /// The finite vertices, in the order of [`vertices`](Self::vertices), and the bounded faces among them, each
    /// counter-clockwise seen from outside, by plane.
    ///
    /// For a bounded polytope this is its whole boundary; unbounded faces are left out, see
    /// [`to_mesh_clipped`](Self::to_mesh_clipped). The coordinates are correctly rounded.
    #[must_use]
    pub fn to_mesh(&self) -> (Vec<DVec3>, Vec<Vec<usize>>) {
        let names: Vec<u32> = self.vertex_names().filter(|slot| !self.vertices.is_ideal(*slot)).collect();
        let polygons = self.faces_among(&names).into_iter().filter(|face| face.is_bounded).map(|face| face.vertices);
        let positions = names.iter().map(|slot| self.position(*slot).truncate());
        (positions.collect(), polygons.collect())
    }

    /// The mesh of a bounded polytope as it is, that of an unbounded one clipped to a box given by its corners.
    ///
    /// A box without interior, and one that the set does not reach into, give an empty mesh. Bounds that are farther away
    /// than the accepted offsets count as the farthest accepted ones.
    #[must_use]
    pub fn to_mesh_clipped(&self, min: impl Into<DVec3>, max: impl Into<DVec3>) -> (Vec<DVec3>, Vec<Vec<usize>>) {
        self.mesh_in_box(min.into(), max.into())
    }

    fn mesh_in_box(&self, min: DVec3, max: DVec3) -> (Vec<DVec3>, Vec<Vec<usize>>) {
        if self.is_bounded() {
            return self.to_mesh();
        }
        if !min.cmplt(max).all() {
            return (Vec::new(), Vec::new());
        }
        let mut clipped = self.clone();
        for axis in 0..3 {
            for (normal, offset) in [(DVec3::AXES[axis], max[axis]), (-DVec3::AXES[axis], -min[axis])] {
                clipped.add_plane(wall(normal, offset));
            }
        }
        clipped.to_mesh()
    }
}

/// A half-space with a unit normal, its offset brought into the accepted range.
fn wall(normal: DVec3, offset: f64) -> HalfSpace {
    let nearest = 1.0 / MAX_OFFSET_RATIO;
    let offset = if offset.abs() < nearest { 0.0 } else { offset.clamp(-MAX_OFFSET_RATIO, MAX_OFFSET_RATIO) };
    HalfSpace::new(normal, offset).expect("the normal is of unit length and the offset in the accepted range")
}
