//! What the picture shows cell by cell: one face, or the floor, with its place in space.
//!
//! Light is computed for cells of a few pixels, since it varies slowly within a face.

use glam::Vec3;

use super::raster::{NO_FACE, Raster};
use super::scene::{Floor, Scene};

/// Number of the floor among the faces.
pub(super) const FLOOR: u32 = NO_FACE - 1;

/// Beyond this distance from the model, in its radii, the floor is not looked at: nothing falls on it there.
const FLOOR_REACH: f32 = 3.0;

/// One surface for each cell, row by row.
pub(super) struct Surface {
    /// Cells across.
    pub(super) width: usize,
    /// Cells down.
    pub(super) height: usize,
    /// Pixels along a cell.
    pub(super) cell: usize,
    /// View ray through the first cell, and the way from each cell's to the next.
    first_ray: Vec3,
    ray_step: f32,
    /// View depth; infinite where there is nothing.
    pub(super) depth: Vec<f32>,
    /// Number of the face, [`FLOOR`], or [`NO_FACE`].
    pub(super) faces: Vec<u32>,
}

impl Surface {
    /// Looks through the middle of each cell of `cell`² pixels; the picture has `size` pixels.
    pub(super) fn new(scene: &Scene<'_>, size: [usize; 2], cell: usize) -> Self {
        let points: Vec<_> = scene.screen.iter().map(|point| point.magnified(1.0 / cell as f32)).collect();
        // Cells at the right and lower edge may reach beyond the picture.
        let size = size.map(|side| side.div_ceil(cell));
        let raster = Raster::draw(scene.triangles(size, &points));
        let first_ray = scene.camera.ray(cell as f32 / 2.0, cell as f32 / 2.0);
        let ray_step = cell as f32 / scene.camera.pixels_per_unit();
        let depth = raster.nearness.iter().map(|nearness| 1.0 / nearness).collect();
        let [width, height] = size;
        let mut surface = Self { width, height, cell, first_ray, ray_step, depth, faces: raster.faces };
        if let Some(floor) = scene.floor {
            surface.add_floor(floor);
        }
        surface
    }

    fn add_floor(&mut self, floor: Floor) {
        for row in 0..self.height {
            for column in 0..self.width {
                let index = row * self.width + column;
                if self.faces[index] == NO_FACE
                    && let Some(depth) = floor.depth_along(self.ray([column, row]))
                {
                    (self.depth[index], self.faces[index]) = (depth, FLOOR);
                }
            }
        }
    }

    /// The view ray through the middle of a cell.
    pub(super) fn ray(&self, [column, row]: [usize; 2]) -> Vec3 {
        // Signed conversions are the fast ones.
        let (right, down) = (column as i32 as f32, row as i32 as f32);
        Vec3::new(self.first_ray.x + self.ray_step * right, self.first_ray.y - self.ray_step * down, 1.0)
    }
}

impl Floor {
    /// View depth at which a ray meets the floor, if it does so near the model.
    fn depth_along(&self, ray: Vec3) -> Option<f32> {
        let depth = self.center.dot(self.normal) / ray.dot(self.normal);
        // A ray along the floor has infinite depth, and fails the comparison.
        (depth > 0.0 && (ray * depth).distance(self.center) < FLOOR_REACH).then_some(depth)
    }

    /// How much the floor shows of what falls on it at a point: all near the model, nothing far away.
    pub(super) fn fade(&self, point: Vec3) -> f32 {
        let part = point.distance(self.center) / FLOOR_REACH;
        let rest = (1.0 - part * part).max(0.0);
        rest * rest
    }
}
