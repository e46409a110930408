//! Where points lie, and how far away.

use planecut_csg::PlaneTable;
use planecut_csg::stages::Bounds;
use planecut_kernel::{DVec3, IncrementalPolytope, Location};

use super::Solid;
use super::carve::Carver;
use super::cell::{Cell, CellPlane};
use super::convex::Convex;
use super::formula::{Formula, Kind};
use super::order::Rule;

impl Solid {
    /// Whether the closed solid holds a point, exactly for the numbers given; a point that is not finite lies outside.
    #[must_use]
    pub fn contains(&self, point: DVec3) -> bool {
        self.cells_around(point).any(|cell| cell.polytope().contains(point))
    }

    /// Whether a point lies inside, on the boundary or outside, exactly for the numbers given. A wall between cells is no
    /// boundary.
    ///
    /// ```
    /// use planecut_cells::Solid;
    /// use planecut_csg::{Brush, MaterialId};
    /// use planecut_kernel::{DVec3, Location};
    ///
    /// let block = |min: f64, max: f64| {
    ///     Solid::from(Brush::cuboid(DVec3::splat(min), DVec3::splat(max), MaterialId(0)))
    /// };
    /// let shell = &block(0.0, 3.0) - &block(1.0, 2.0);
    /// assert_eq!(shell.classify(DVec3::new(0.5, 1.0, 1.0)), Location::Inside);
    /// assert_eq!(shell.classify(DVec3::new(1.0, 1.5, 1.5)), Location::On);
    /// assert_eq!(shell.classify(DVec3::splat(1.5)), Location::Outside);
    /// ```
    #[must_use]
    pub fn classify(&self, point: DVec3) -> Location {
        let mut touching: Vec<&Cell> = Vec::new();
        for cell in self.cells_around(point) {
            match cell.polytope().classify(point) {
                Location::Inside => return Location::Inside,
                Location::On => touching.push(cell),
                Location::Outside => {}
            }
        }
        match touching.as_slice() {
            [] => Location::Outside,
            [_] => Location::On,
            _ if fills_around(&self.table, &touching, point) => Location::Inside,
            _ => Location::On,
        }
    }

    /// The nearest point of the closed solid, each coordinate correctly rounded, and its distance; `None` where the solid is
    /// empty or the point not finite.
    #[must_use]
    pub fn closest_point(&self, point: DVec3) -> Option<(DVec3, f64)> {
        let mut cells: Vec<(f64, &Cell)> = self.cells().map(|cell| (distance_of(cell.bounds(), point), cell)).collect();
        cells.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut nearest: Option<(DVec3, f64)> = None;
        for (at_least, cell) in cells {
            if nearest.is_some_and(|(_, distance)| at_least > distance) {
                break;
            }
            let found = cell.polytope().closest_point(point)?;
            if nearest.is_none_or(|(_, distance)| found.distance < distance) {
                nearest = Some((found.point, found.distance));
            }
        }
        nearest
    }

    /// The distance of a point from the closed solid, correctly rounded: zero inside, infinite where the solid is empty, NaN
    /// where the point is not finite.
    #[must_use]
    pub fn distance(&self, point: DVec3) -> f64 {
        if !point.is_finite() {
            return f64::NAN;
        }
        self.closest_point(point).map_or(f64::INFINITY, |(_, distance)| distance)
    }

    fn cells_around(&self, point: DVec3) -> impl Iterator<Item = &Cell> {
        let here = Bounds { min: point, max: point };
        self.cells_where(move |bounds| bounds.touches(&here))
    }
}

/// Whether cells that all have a point on their boundary leave nothing free around it: the cones of their planes through the
/// point fill space.
fn fills_around(table: &PlaneTable, cells: &[&Cell], point: DVec3) -> bool {
    let cones: Vec<Convex> = cells.iter().map(|cell| Convex::new(table, cone_at(table, cell, point))).collect();
    let outside = Formula::combine(Kind::And, (0..cones.len() as u32).map(|cone| Formula::body(cone, true)));
    let mut free = Vec::new();
    Carver::new(table, cones.iter().collect(), Rule::default()).carve(Cell::everything(), outside, &mut free);
    free.is_empty()
}

/// What the planes of a cell bound that run through a point.
fn cone_at(table: &PlaneTable, cell: &Cell, point: DVec3) -> Cell {
    let runs_through = |plane: &CellPlane| {
        let mut half = IncrementalPolytope::with_epsilon(0.0);
        half.add_plane(*table.half_space(plane.plane));
        half.classify(point) == Location::On
    };
    let mut cone = Cell::everything();
    for facet in cell.facets().into_iter().filter(runs_through) {
        cone.add(table, facet);
    }
    cone.settle(table);
    cone
}

/// A distance that the points of a box surely have.
fn distance_of(bounds: &Bounds, point: DVec3) -> f64 {
    (bounds.min - point).max(point - bounds.max).max(DVec3::ZERO).length() * (1.0 - 8.0 * f64::EPSILON)
}
