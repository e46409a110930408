//! What a brush would gain without one of its planes.
//!
//! That is the part of what the other planes leave that lies beyond the plane: convex again, and found from the planes of the brush alone.

use planecut_kernel::{DVec3, Face, HalfSpace, IncrementalPolytope, PlaneIdx};

use super::{BrushId, EditError, LiveModel};
use crate::ids::number32;

/// What the removal of a plane would do to its brush.
#[derive(Debug, Clone, PartialEq)]
pub enum PlaneRemoval {
    /// Nothing: other planes bound the brush where this one does, or nothing is left of it either way.
    Nothing,
    /// The brush would reach infinity beyond the plane.
    Unbounded,
    /// The brush would gain a convex body.
    Gains(ConvexPiece),
}

/// A bounded convex body.
#[derive(Debug, Clone, PartialEq)]
pub struct ConvexPiece {
    /// The planes of its faces, the other side of the removed plane last.
    pub half_spaces: Vec<HalfSpace>,
    /// Its corners.
    pub positions: Vec<DVec3>,
    /// Its triangles, counter-clockwise seen from outside, by places among the corners.
    pub triangles: Vec<[u32; 3]>,
    /// Its volume.
    pub volume: f64,
}

impl LiveModel {
    /// What the removal of a plane would do to its brush, which stays as it is. The cost is that of the brush, whatever else the model holds.
    ///
    /// ```
    /// use planecut_csg::{Brush, LiveModel, Material, MaterialId, PlaneRemoval, Role};
    /// use planecut_kernel::{DVec3, HalfSpace, PlaneIdx};
    ///
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let mut model = LiveModel::new(vec![Material::named("stone")]);
    /// let cube = Brush::cuboid(DVec3::ZERO, DVec3::ONE, MaterialId(0));
    /// let (cube, _) = model.add_brush(cube, Role::Add)?;
    /// let (cut, _) = model.add_plane(cube, HalfSpace::new(DVec3::ONE, 2.0)?, MaterialId(0))?;
    /// let PlaneRemoval::Gains(corner) = model.preview_remove_plane(cube, cut)? else { panic!("a corner was cut off") };
    /// assert!(corner.half_spaces.len() == 4 && (corner.volume - 1.0 / 6.0).abs() < 1e-15);
    /// assert_eq!(model.preview_remove_plane(cube, PlaneIdx(1))?, PlaneRemoval::Unbounded);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// [`EditError::UnknownBrush`], [`EditError::Mesh`], [`EditError::UnknownPlane`].
    pub fn preview_remove_plane(&self, brush: BrushId, plane: PlaneIdx) -> Result<PlaneRemoval, EditError> {
        let state = self.convex_state(brush)?;
        let place = state.place_of(plane).ok_or(EditError::UnknownPlane { brush, plane })?;
        let operand = self.operand(self.number(brush)?);
        // as they are taken, where planes are nearly the same
        let taken = |at: usize| *self.planes.table.half_space(self.planes.id(operand.uses[at]));
        let mut beyond = IncrementalPolytope::with_epsilon(0.0);
        for at in (0..operand.uses.len()).filter(|at| *at != place) {
            beyond.add_plane(taken(at));
        }
        beyond.add_plane(taken(place).flipped());
        if beyond.is_empty() {
            return Ok(PlaneRemoval::Nothing);
        }
        let Some(measures) = beyond.measures() else { return Ok(PlaneRemoval::Unbounded) };
        let faces = beyond.faces();
        let half_spaces = faces.iter().filter_map(|face| beyond.plane(face.plane).copied()).collect();
        let (positions, _) = beyond.to_mesh();
        let fan = |face: &Face| {
            let corners: Vec<u32> = face.vertices.iter().map(|corner| number32(*corner)).collect();
            let sides = corners.windows(2).skip(1).map(|side| [corners[0], side[0], side[1]]);
            sides.collect::<Vec<[u32; 3]>>()
        };
        let triangles = faces.iter().flat_map(fan).collect();
        Ok(PlaneRemoval::Gains(ConvexPiece { half_spaces, positions, triangles, volume: measures.volume }))
    }
}
