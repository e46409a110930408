//! Pieces of facets and how a plane cuts them.

use std::cmp::Ordering;
use std::rc::Rc;

use crate::polyhedron::exact::{Grid, Plane, Point};

/// A convex piece of a facet.
#[derive(Debug, Clone)]
pub(super) struct Fragment {
    pub(super) facet: u32,
    corners: Vec<Corner>,
}

/// A corner, and a plane other than the facet's through the edge to the next one.
#[derive(Debug, Clone)]
struct Corner {
    point: Rc<Point>,
    edge: Rc<Plane>,
}

/// What a plane makes of a piece.
pub(super) enum Split {
    /// It lies below the plane.
    Inside,
    /// It lies above the plane.
    Outside,
    /// It lies on the plane.
    On,
    /// The parts below and above.
    Both(Fragment, Fragment),
}

impl Fragment {
    /// A whole facet on its plane, its corners all different.
    pub(super) fn new(facet: u32, plane: &Plane, polygon: &[Rc<Point>]) -> Self {
        let next = |k: usize| &polygon[(k + 1) % polygon.len()];
        let corner = |(k, point): (usize, &Rc<Point>)| Corner {
            point: Rc::clone(point),
            edge: Rc::new(plane.across_edge(point, next(k))),
        };
        Self { facet, corners: polygon.iter().enumerate().map(corner).collect() }
    }

    /// The least and the greatest side on which a corner lies.
    pub(super) fn extent(&self, plane: &Plane) -> (Ordering, Ordering) {
        let (mut least, mut greatest) = (Ordering::Greater, Ordering::Less);
        for corner in &self.corners {
            let side = plane.side(&corner.point);
            (least, greatest) = (least.min(side), greatest.max(side));
        }
        (least, greatest)
    }

    /// Splits the piece along a plane.
    pub(super) fn split(&self, grid: Grid, plane: &Rc<Plane>, own: &Plane) -> Split {
        match self.extent(plane) {
            (Ordering::Equal, Ordering::Equal) => Split::On,
            (_, Ordering::Less | Ordering::Equal) => Split::Inside,
            (Ordering::Greater | Ordering::Equal, _) => Split::Outside,
            _ => {
                let crossings = self.crossings(grid, plane, own);
                let side = |outer| Self { facet: self.facet, corners: self.part(plane, &crossings, outer) };
                Split::Both(side(Ordering::Less), side(Ordering::Greater))
            }
        }
    }

    /// The point in which each edge crosses the plane, where it does.
    fn crossings(&self, grid: Grid, plane: &Plane, own: &Plane) -> Vec<Option<Rc<Point>>> {
        let sides: Vec<Ordering> = self.corners.iter().map(|corner| plane.side(&corner.point)).collect();
        let crossing = |(k, corner): (usize, &Corner)| {
            let next = sides[(k + 1) % sides.len()];
            let crosses = sides[k] != Ordering::Equal && next == sides[k].reverse();
            crosses.then(|| Rc::new(Point::meet(grid, own, &corner.edge, plane)))
        };
        self.corners.iter().enumerate().map(crossing).collect()
    }

    /// The corners on one side of the plane and on it, the edge along it given its plane.
    fn part(&self, plane: &Rc<Plane>, crossings: &[Option<Rc<Point>>], wanted: Ordering) -> Vec<Corner> {
        let mut corners = Vec::with_capacity(self.corners.len() + 1);
        let n = self.corners.len();
        for (k, corner) in self.corners.iter().enumerate() {
            let side = plane.side(&corner.point);
            let next = plane.side(&self.corners[(k + 1) % n].point);
            let leaves = |to: Ordering| to == wanted.reverse();
            if side == wanted {
                corners.push(corner.clone());
            } else if side == Ordering::Equal {
                let edge = if leaves(next) { plane } else { &corner.edge };
                corners.push(Corner { point: Rc::clone(&corner.point), edge: Rc::clone(edge) });
            }
            if let Some(point) = &crossings[k] {
                let edge = if leaves(next) { plane } else { &corner.edge };
                corners.push(Corner { point: Rc::clone(point), edge: Rc::clone(edge) });
            }
        }
        corners
    }
}
