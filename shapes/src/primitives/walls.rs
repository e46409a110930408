//! Upright walls over the sides of a loop, and the convex cells between them.

use planecut_csg::PlaneTable;
use planecut_csg::stages::size_of;
use planecut_kernel::{DVec2, DVec3, HalfSpace};

use super::cells::{PlaneSide, Surface};
use super::partition::partition;
use super::simple::plane;
use crate::outline::{largest_coordinate, signed_area};
use crate::parameter::{ShapeError, refuse};
use crate::tolerances::SHORT_SIDE;

/// The upright prism over a loop.
pub(super) struct Walls {
    /// The loop, counter-clockwise.
    pub(super) corners: Vec<DVec2>,
    /// The half-space of each side, the prism below it; sides on one line have the same plane.
    pub(super) half_spaces: Vec<HalfSpace>,
    /// Of each side the number of its line.
    lines: Vec<u32>,
}

impl Walls {
    /// Walls over a loop that runs either way.
    pub(super) fn over(corners: &[DVec2]) -> Result<Self, ShapeError> {
        let mut corners = corners.to_vec();
        if signed_area(&corners) < 0.0 {
            corners.reverse();
        }
        drop_short_sides(&mut corners);
        let n = corners.len();
        let half_space = |k: usize| side(corners[k], corners[(k + 1) % n]);
        let mut half_spaces = (0..n).map(half_space).collect::<Result<Vec<HalfSpace>, ShapeError>>()?;
        // what is one plane in the finished model is one here: cells are told apart by the same lines
        let (table, ids) = PlaneTable::intern(&half_spaces, size_of(half_spaces.iter()).unwrap_or(0.0));
        for (half_space, id) in half_spaces.iter_mut().zip(&ids).filter(|_| table.snapped() > 0) {
            *half_space = *table.half_space(*id);
        }
        // a side between two sides on one line is on it too, however it is turned by rounding
        let mut ids = ids;
        for k in 0..2 * n {
            let [before, at, after] = [k + n - 1, k, k + 1].map(|k| k % n);
            if ids[before] == ids[after] && ids[at] != ids[before] {
                (ids[at], half_spaces[at]) = (ids[before], half_spaces[before]);
            }
        }
        let lines = ids.iter().map(|id| id.index()).collect();
        Ok(Self { corners, half_spaces, lines })
    }

    /// The two ends of each side.
    pub(super) fn ends(&self) -> impl Iterator<Item = [DVec2; 2]> + '_ {
        let n = self.corners.len();
        (0..n).map(move |k| [self.corners[k], self.corners[(k + 1) % n]])
    }

    /// Convex cells that together are the prism.
    pub(super) fn cells(&self) -> Result<Vec<Vec<PlaneSide>>, ShapeError> {
        if self.corners.len() < 3 {
            return Ok(Vec::new());
        }
        match partition(&self.corners, &self.lines) {
            Some(cells) => Ok(cells),
            None => self.cells_in_space(),
        }
    }

    /// The same for loops that touch themselves, by planes through all of space.
    fn cells_in_space(&self) -> Result<Vec<Vec<PlaneSide>>, ShapeError> {
        // any height does; one like the outline's size keeps the numbers short
        let size = largest_coordinate(&self.corners);
        let height = f64::from_bits(size.to_bits() & !((1 << 52) - 1));
        let points: Vec<DVec3> =
            [0.0, height].into_iter().flat_map(|z| self.corners.iter().map(move |p| p.extend(z))).collect();
        let n = self.corners.len() as u32;
        let facets: Vec<Vec<u32>> = (0..n).map(|p| (p, (p + 1) % n)).map(|(p, q)| vec![p, q, q + n, p + n]).collect();
        let surface = Surface::new(&points, &facets);
        surface.ok_or_else(|| refuse("polygon", &"a side of no length", &"corners apart"))?.cells()
    }
}

fn drop_short_sides(corners: &mut Vec<DVec2>) {
    let size = largest_coordinate(&*corners);
    let is_short = |p: DVec2, q: DVec2| p.distance(q) <= SHORT_SIDE * size;
    corners.dedup_by(|q, p| is_short(*p, *q));
    while corners.len() > 1 && is_short(corners[0], corners[corners.len() - 1]) {
        corners.pop();
    }
}

/// The half-space to the left of a side: exact where the side runs along an axis or its coefficients fit, else the normal
/// rounded and the offset in the middle of what the two ends ask for.
pub(super) fn side(p: DVec2, q: DVec2) -> Result<HalfSpace, ShapeError> {
    if p == q {
        return Err(refuse("polygon", &"a side of no length", &"corners apart"));
    }
    if p.x == q.x {
        let along = if q.y > p.y { 1.0 } else { -1.0 };
        return plane(DVec3::X * along, p.x * along);
    }
    if p.y == q.y {
        let along = if p.x > q.x { 1.0 } else { -1.0 };
        return plane(DVec3::Y * along, p.y * along);
    }
    let along = q - p;
    let normal = DVec2::new(along.y, -along.x);
    let is_exact = is_exact_difference(q.x, p.x) && is_exact_difference(q.y, p.y);
    let offset = if is_exact { exact_dot(normal, p) } else { None };
    let offset = offset.unwrap_or_else(|| 0.5 * (normal.dot(p) + normal.dot(q)));
    // a largest component from 1 to 2 keeps the coefficients within their range wherever lengths are
    let scale = f64::from_bits(normal.abs().max_element().to_bits() & !((1 << 52) - 1)).recip();
    plane((normal * scale).extend(0.0), offset * scale)
}

fn is_exact_difference(a: f64, b: f64) -> bool {
    // Knuth's two-sum, of which only the error matters
    let difference = a - b;
    let subtracted = difference - a;
    (a - (difference - subtracted)) + (-b - subtracted) == 0.0
}

/// The scalar product, where it is a number without rounding.
fn exact_dot(a: DVec2, b: DVec2) -> Option<f64> {
    let (x, y) = (a.x * b.x, a.y * b.y);
    let is_exact = a.x.mul_add(b.x, -x) == 0.0 && a.y.mul_add(b.y, -y) == 0.0 && is_exact_difference(x, -y);
    is_exact.then_some(x + y)
}
