//! A convex body that cells are held against.

use planecut_csg::stages::Bounds;
use planecut_csg::{PlaneId, PlaneTable};
use planecut_kernel::sign::Sign;

use super::cell::{Cell, CellPlane, Corner, Cut};

/// On which sides of a plane a body lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum BodySide {
    Inside,
    Outside,
    Both,
}

/// A convex body with interior, its faces and corners at hand.
#[derive(Debug, Clone)]
pub(super) struct Convex {
    pub(super) cell: Cell,
    /// The planes of its faces.
    pub(super) facets: Vec<CellPlane>,
    corners: Vec<Corner>,
    /// How much space it takes: for choosing an order only. Infinite where it is unbounded.
    pub(super) size: f64,
}

impl Convex {
    pub(super) fn new(table: &PlaneTable, cell: Cell) -> Self {
        let size = cell.polytope().measures().map_or(f64::INFINITY, |measures| measures.volume);
        let (facets, corners) = (cell.facets(), cell.corners(table));
        Self { cell, facets, corners, size }
    }

    pub(super) fn bounds(&self) -> &Bounds {
        self.cell.bounds()
    }

    /// On which sides of a plane its interior lies; where it is unbounded this may be told as both.
    pub(super) fn side(&self, table: &PlaneTable, plane: PlaneId) -> BodySide {
        if !self.size.is_finite() {
            return BodySide::Both;
        }
        side_of(table, &self.corners, self.bounds(), plane)
    }

    /// Whether a plane of the cell, or one of its own, surely parts it from a cell.
    pub(super) fn is_parted_from(&self, table: &PlaneTable, cell: &Cell) -> bool {
        !self.bounds().touches(cell.bounds())
            || cell.planes().any(|(_, plane)| self.side(table, plane.plane) == BodySide::Outside)
    }

    /// What the body and a cell have in common, and the body's planes that carry faces of it; `None` where they have no
    /// interior in common.
    pub(super) fn common(&self, table: &PlaneTable, cell: &Cell) -> Option<(Cell, Vec<CellPlane>)> {
        let mut common = cell.clone();
        let mut cut = false;
        for facet in &self.facets {
            match common.add(table, *facet) {
                Cut::Empty => return None,
                Cut::Face => cut = true,
                Cut::Nothing => {}
            }
        }
        let is_new = |plane: &CellPlane| cell.handle(plane.plane).is_none();
        let carrying = if cut { common.facets().into_iter().filter(is_new).collect() } else { Vec::new() };
        Some((common, carrying))
    }
}

/// On which sides of a plane a bounded body lies.
pub(super) fn side_of(table: &PlaneTable, corners: &[Corner], bounds: &Bounds, plane: PlaneId) -> BodySide {
    let side = box_side(table, bounds, plane);
    if side != BodySide::Both {
        return side;
    }
    let (mut inside, mut outside) = (false, false);
    for (ids, point) in corners {
        match table.side(*ids, point, plane) {
            Sign::Negative => inside = true,
            Sign::Positive => outside = true,
            Sign::Zero => {}
        }
        if inside && outside {
            return BodySide::Both;
        }
    }
    if outside { BodySide::Outside } else { BodySide::Inside }
}

/// On which sides of a plane a box lies; both where that is not certain.
pub(super) fn box_side(table: &PlaneTable, bounds: &Bounds, plane: PlaneId) -> BodySide {
    let half_space = table.half_space(plane);
    let (low, high) = bounds.extent_along(half_space.normal(), half_space.offset());
    if high < 0.0 {
        BodySide::Inside
    } else if low > 0.0 {
        BodySide::Outside
    } else {
        BodySide::Both
    }
}
