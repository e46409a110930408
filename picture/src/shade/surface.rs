//! What the picture shows cell by cell: one face, or the floor, with its place in space.
//!
//! Light is computed for cells of a few pixels, since it varies slowly within a face.

use glam::Vec3;

use crate::raster::{NO_FACE, Raster};
use crate::scene::{Floor, Scene};
use crate::view::lens::Lens;

/// Number of the floor among the faces.
pub(crate) const FLOOR: u32 = NO_FACE - 1;

/// Beyond this distance from the model, in its radii, the floor is not looked at: nothing falls on it there.
const FLOOR_REACH: f32 = 3.0;

/// One surface for each cell, row by row.
pub(crate) struct Surface {
    /// Cells across.
    pub(crate) width: usize,
    /// Cells down.
    pub(crate) height: usize,
    /// Pixels along a cell.
    pub(crate) cell: usize,
    /// The picture of the cells.
    pub(crate) lens: Lens,
    /// View depth; infinite where there is nothing.
    pub(crate) depth: Vec<f32>,
    /// Number of the face, [`FLOOR`], or [`NO_FACE`].
    pub(crate) faces: Vec<u32>,
}

impl Surface {
    /// Looks through the middle of each cell of `cell`² pixels; the picture has `size` pixels.
    pub(crate) fn new(scene: &Scene<'_>, size: [usize; 2], cell: usize) -> Self {
        let points: Vec<_> = scene.screen.iter().map(|point| point.magnified(1.0 / cell as f32)).collect();
        // Cells at the right and lower edge may reach beyond the picture.
        let size = size.map(|side| side.div_ceil(cell));
        let raster = Raster::draw(scene.triangles(size, &points));
        let lens = scene.camera.lens.with_cells_of(cell);
        let depth = raster.nearness.iter().map(|&nearness| lens.depth(nearness)).collect();
        let [width, height] = size;
        let mut surface = Self { width, height, cell, lens, depth, faces: raster.faces };
        if let Some(floor) = scene.floor {
            surface.add_floor(floor);
        }
        surface
    }

    fn add_floor(&mut self, floor: Floor) {
        for row in 0..self.height {
            for column in 0..self.width {
                let index = row * self.width + column;
                let [x, y] = middle([column, row]);
                if self.faces[index] == NO_FACE
                    && let Some(depth) = floor.depth_along(self.lens.ray(x, y))
                {
                    (self.depth[index], self.faces[index]) = (depth, FLOOR);
                }
            }
        }
    }

    /// The point that a cell shows, in view coordinates; infinitely far away where there is nothing.
    pub(crate) fn point(&self, at: [usize; 2]) -> Vec3 {
        let [x, y] = middle(at);
        self.lens.point(x, y, self.depth[at[1] * self.width + at[0]])
    }
}

/// The middle of a cell.
fn middle([column, row]: [usize; 2]) -> [f32; 2] {
    // Signed conversions are the fast ones.
    [column as i32 as f32 + 0.5, row as i32 as f32 + 0.5]
}

impl Floor {
    /// View depth at which a line of sight meets the floor, if it does so near the model.
    fn depth_along(&self, (start, direction): (Vec3, Vec3)) -> Option<f32> {
        // Directions have a depth of one: what is counted along them is depth.
        let depth = (self.center - start).dot(self.normal) / direction.dot(self.normal);
        // A ray along the floor has infinite depth, and fails the comparison.
        (depth > 0.0 && (start + direction * depth).distance(self.center) < FLOOR_REACH).then_some(depth)
    }

    /// How much the floor shows of what falls on it at a point: all near the model, nothing far away.
    pub(crate) fn fade(&self, point: Vec3) -> f32 {
        let part = point.distance(self.center) / FLOOR_REACH;
        let rest = (1.0 - part * part).max(0.0);
        rest * rest
    }
}
