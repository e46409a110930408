//! Moving solids.

use std::sync::Arc;

use planecut_csg::stages::smallest_size;
use planecut_csg::{PlaneId, PlaneTable, Transform, TransformError};
use planecut_kernel::{DVec3, HalfSpace};

use super::Solid;
use super::cell::Cell;

impl Solid {
    /// The solid moved by an affine map. Cuts become part of it.
    ///
    /// Coefficients are rounded, except where map and planes are short numbers. Planes stay shared: what lay on one plane
    /// still does, so walls between cells fit. Only where more than three planes met in a point, cells can overlap or
    /// part there by the rounding.
    ///
    /// ```
    /// use planecut_cells::Solid;
    /// use planecut_csg::{Brush, MaterialId, Transform};
    /// use planecut_kernel::DVec3;
    ///
    /// # fn main() -> Result<(), planecut_csg::TransformError> {
    /// let bar = Solid::from(Brush::cuboid(DVec3::ZERO, DVec3::new(4.0, 1.0, 1.0), MaterialId(0)));
    /// let turned = bar.transformed(&Transform::rotation(DVec3::Z, 90.0)?)?;
    /// assert_eq!(turned.bounding_box().map(|bounds| bounds.max), Some(DVec3::new(0.0, 4.0, 1.0)));
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// [`TransformError::OutOfRange`] where a plane leaves the accepted range.
    pub fn transformed(&self, transform: &Transform) -> Result<Self, TransformError> {
        let this = self.baked();
        let planes = (0..this.table.len() as u32).map(PlaneId::of_index);
        let moved: Vec<HalfSpace> =
            planes.map(|plane| transform.half_space(this.table.half_space(plane))).collect::<Result<_, _>>()?;
        let planes_of =
            |cell: &'_ Cell| cell.planes().map(|(_, plane)| plane.plane.index() as usize).collect::<Vec<_>>();
        let cells: Vec<Vec<usize>> = this.cells.iter().map(planes_of).collect();
        let size = smallest_size(cells.iter().map(|planes| planes.iter().map(|plane| &moved[*plane])));
        let (table, ids) = PlaneTable::intern(&moved, size);
        let id = |plane: PlaneId| {
            let unsided = ids[plane.index() as usize];
            if plane == plane.unsided() { unsided } else { unsided.flipped() }
        };
        let carried = |cell: &Cell| cell.renumbered(&table, id, |_| false, 0);
        let cells = this.cells.iter().filter_map(carried).collect();
        let cover = this.cover.as_ref();
        let cover = cover.map(|cover| cover.iter().filter_map(|cell| carried(cell)).map(Arc::new).collect());
        Ok(Self { cover, ..Self::of_cells(Arc::new(table), cells, this.sources.renumbered(id)) })
    }

    /// The mirror image in the plane through the origin with this normal; see [`Solid::transformed`].
    ///
    /// # Errors
    /// [`TransformError::NotFinite`], [`TransformError::Singular`] for a normal of length zero, and
    /// [`TransformError::OutOfRange`].
    pub fn mirrored(&self, normal: DVec3) -> Result<Self, TransformError> {
        self.transformed(&Transform::mirror(normal)?)
    }
}
