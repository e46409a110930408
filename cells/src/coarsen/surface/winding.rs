//! Winding numbers of closed surfaces, exactly.

use planecut_kernel::DVec3;
use robust::{Coord, Coord3D, orient2d, orient3d};

/// Columns along each side of the grid, at most.
const MOST_COLUMNS: usize = 512;

/// The winding numbers of a closed surface, exactly: how often it goes around a point, seen by a ray upward from there.
///
/// The grid holds the triangles by the columns, along the third axis, that they reach into.
#[derive(Debug)]
pub struct Winding<'a> {
    positions: &'a [DVec3],
    triangles: &'a [[u32; 3]],
    low: DVec3,
    scale: [f64; 2],
    columns: [usize; 2],
    /// For each column where its triangles begin.
    starts: Vec<u32>,
    members: Vec<u32>,
}

impl<'a> Winding<'a> {
    /// For all points around a surface: closed, with numbers of vertices that are there.
    #[must_use]
    pub fn new(positions: &'a [DVec3], triangles: &'a [[u32; 3]]) -> Self {
        let (low, high) = super::bounds(positions.iter().copied());
        let side = ((triangles.len() as f64).sqrt() as usize).clamp(1, MOST_COLUMNS);
        let size = high - low;
        let scale = [size.x, size.y].map(|size| if size > 0.0 { side as f64 / size } else { 0.0 });
        let mut winding = Self {
            positions,
            triangles,
            low,
            scale,
            columns: [side; 2],
            starts: vec![0; side * side + 1],
            members: Vec::new(),
        };
        for pass in 0..2 {
            for (number, triangle) in (0..).zip(triangles) {
                let [from, to] = winding.reach(triangle);
                for y in from[1]..=to[1] {
                    for x in from[0]..=to[0] {
                        let column = y * side + x;
                        if pass == 0 {
                            winding.starts[column + 1] += 1;
                        } else {
                            winding.members[winding.starts[column] as usize] = number;
                            winding.starts[column] += 1;
                        }
                    }
                }
            }
            if pass == 0 {
                (1..winding.starts.len()).for_each(|k| winding.starts[k] += winding.starts[k - 1]);
                winding.members = vec![0; winding.starts[side * side] as usize];
            }
        }
        // each start was moved to the next one
        winding.starts.rotate_right(1);
        winding.starts[0] = 0;
        winding
    }

    fn column(&self, point: DVec3) -> [usize; 2] {
        [0, 1].map(|axis| {
            let place = (point[axis] - self.low[axis]) * self.scale[axis];
            (place.max(0.0) as usize).min(self.columns[axis] - 1)
        })
    }

    fn reach(&self, triangle: &[u32; 3]) -> [[usize; 2]; 2] {
        let (low, high) = super::bounds(triangle.iter().map(|corner| self.positions[*corner as usize]));
        [self.column(low), self.column(high)]
    }

    /// How often the surface goes around a point that does not lie on it.
    #[must_use]
    pub fn around(&self, point: DVec3) -> i32 {
        let [x, y] = self.column(point);
        let column = y * self.columns[0] + x;
        let members = &self.members[self.starts[column] as usize..self.starts[column + 1] as usize];
        members.iter().map(|triangle| self.crossing(self.triangles[*triangle as usize], point)).sum()
    }

    /// 1 where the ray leaves through a triangle, -1 where it enters, 0 where it misses. Edges that the ray meets belong to one side by their
    /// ends, the same for both of their triangles.
    fn crossing(&self, triangle: [u32; 3], point: DVec3) -> i32 {
        let corners = triangle.map(|corner| self.positions[corner as usize]);
        if corners.iter().all(|p| p.z < point.z)
            || corners.iter().all(|p| p.x < point.x)
            || corners.iter().all(|p| p.x > point.x)
        {
            return 0;
        }
        let mut turns = 0;
        for k in 0..3 {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            let is_up = a.y <= point.y && b.y > point.y;
            if is_up || b.y <= point.y && a.y > point.y {
                let (low, high) = if is_up { (a, b) } else { (b, a) };
                let side = orient2d(flat(low), flat(high), flat(point));
                if side > 0.0 {
                    turns += if is_up { 1 } else { -1 };
                }
            }
        }
        if turns == 0 {
            return 0;
        }
        // positive where the point lies below the plane, seen so that the corners run clockwise
        let below = orient3d(solid(corners[0]), solid(corners[1]), solid(corners[2]), solid(point));
        if below * f64::from(turns) > 0.0 { turns } else { 0 }
    }
}

fn flat(p: DVec3) -> Coord<f64> {
    Coord { x: p.x, y: p.y }
}

fn solid(p: DVec3) -> Coord3D<f64> {
    Coord3D { x: p.x, y: p.y, z: p.z }
}
