//! What the picture shows cell by cell: one face, or the floor, with its place in space.
//!
//! Light is computed for cells of a few pixels, since it varies slowly within a face.

use glam::Vec3;
use rayon::prelude::*;

use super::camera::Camera;
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
    /// View depth; infinite where there is nothing.
    pub(super) depth: Vec<f32>,
    /// Number of the face, [`FLOOR`], or [`NO_FACE`].
    pub(super) faces: Vec<u32>,
}

impl Surface {
    /// Takes one sample near the middle of each cell of `cell`² pixels, from a raster of `factor`² samples per pixel.
    pub(super) fn new(scene: &Scene<'_>, samples: &Raster, factor: usize, cell: usize) -> Self {
        let step = cell * factor;
        let (width, height) = (samples.width.div_ceil(step), samples.height.div_ceil(step));
        let mut surface =
            Self { width, height, cell, depth: vec![0.0; width * height], faces: vec![NO_FACE; width * height] };
        let rows = surface.depth.par_chunks_mut(width).zip(surface.faces.par_chunks_mut(width));
        rows.enumerate().for_each(|(row, (depth, faces))| {
            // Cells at the right and lower edge may reach beyond the picture.
            let middle = |index: usize, size: usize| (index * step + step / 2).min(size - 1);
            let start = middle(row, samples.height) * samples.width;
            for column in 0..width {
                let sample = start + middle(column, samples.width);
                (depth[column], faces[column]) = (1.0 / samples.nearness[sample], samples.faces[sample]);
                if let (NO_FACE, Some(floor)) = (faces[column], scene.floor) {
                    if let Some(distance) = floor.depth_along(cell_ray(&scene.camera, cell, [column, row])) {
                        (depth[column], faces[column]) = (distance, FLOOR);
                    }
                }
            }
        });
        surface
    }

    /// The view ray through the middle of a cell.
    pub(super) fn ray(&self, camera: &Camera, at: [usize; 2]) -> Vec3 {
        cell_ray(camera, self.cell, at)
    }
}

fn cell_ray(camera: &Camera, cell: usize, at: [usize; 2]) -> Vec3 {
    let [x, y] = at.map(|index| (index as f32 + 0.5) * cell as f32);
    camera.ray(x, y)
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
