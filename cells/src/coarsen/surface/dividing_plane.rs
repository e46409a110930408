//! The plane that divides what two groups hold best.

use std::sync::Arc;

use planecut_kernel::{DVec3, approximate_hull_triangles};

use super::body::used_points;
use super::chunk::{Chunk, Place};
use super::fragment::Plane;
use super::region::hull_volume;
use crate::tolerances::HULL_TOUCHING;

/// The first step by which a plane is turned, in radians, and how often it is halved.
const TURNED: f64 = 0.3;
const HALVINGS: usize = 5;
/// How far a plane is moved where it is turned by 1, relative to the size.
const MOVED: f64 = 0.25;
/// Steps of one length, each to the best of the planes around.
const STEPS: usize = 2;

/// What is to be divided.
pub(super) struct Dividing<'a> {
    chunks: &'a [Arc<Chunk>],
    /// The middles of both sides so far.
    middles: [DVec3; 2],
    /// What the first of both holds, as a share.
    share: f64,
    size: f64,
    /// Chunks that lie far below the planes that are tried, and far above.
    cores: [Core; 2],
    /// The number of corners in all hulls that were tried.
    pub(super) work: usize,
}

/// Chunks on one side of all planes that are tried.
#[derive(Default)]
struct Core {
    /// Their numbers, in order.
    chunks: Vec<usize>,
    /// The corners of their hull.
    corners: Vec<DVec3>,
}

impl<'a> Dividing<'a> {
    pub(super) fn new(chunks: &'a [Arc<Chunk>], sides: [&[Arc<Chunk>]; 2]) -> Self {
        let totals = sides.map(|side| {
            let each = side.iter().map(|chunk| (chunk.middle, chunk.volume.max(f64::MIN_POSITIVE)));
            each.fold((DVec3::ZERO, 0.0), |(sum, all), (center, volume)| (sum + volume * center, all + volume))
        });
        let middles = totals.map(|(sum, all)| sum / all);
        let share = totals[0].1 / (totals[0].1 + totals[1].1);
        let (low, high) = super::bounds(chunks.iter().flat_map(|chunk| chunk.corners.iter().copied()));
        Self { chunks, middles, share, size: (high - low).length(), cores: Default::default(), work: 0 }
    }

    /// The best plane that is found.
    pub(super) fn best(&mut self) -> Option<Plane> {
        let along = (self.middles[1] - self.middles[0]).try_normalize();
        let mut best: Option<(f64, Plane)> = None;
        for normal in along.into_iter().chain(DVec3::AXES) {
            for offset in self.offsets(normal) {
                let volume = self.volume((normal, offset));
                if best.is_none_or(|(least, _)| volume < least) {
                    best = Some((volume, (normal, offset)));
                }
            }
        }
        let (volume, plane) = best.filter(|(volume, _)| volume.is_finite())?;
        Some(self.refined(volume, plane))
    }

    /// Offsets across a direction at which a plane is tried: where it leaves both sides what they have, and halves.
    fn offsets(&self, normal: DVec3) -> [f64; 2] {
        let mut heights: Vec<(f64, f64)> =
            self.chunks.iter().map(|chunk| (normal.dot(chunk.middle), chunk.volume)).collect();
        heights.sort_by(|a, b| a.0.total_cmp(&b.0));
        let all: f64 = heights.iter().map(|(_, volume)| volume).sum();
        let is_first_below = normal.dot(self.middles[0]) <= normal.dot(self.middles[1]);
        let share = if is_first_below { self.share } else { 1.0 - self.share };
        [share, 0.5].map(|share| {
            let mut below = 0.0;
            let at = heights.iter().find(|(_, volume)| {
                below += volume;
                below >= share * all
            });
            at.or(heights.last()).map_or(0.0, |(height, _)| *height)
        })
    }

    /// The plane turned and moved a little to where the volume is less.
    fn refined(&mut self, volume: f64, plane: Plane) -> Plane {
        let mut best = (volume, plane);
        let center = 0.5 * (self.middles[0] + self.middles[1]);
        let mut step = TURNED;
        for _ in 0..HALVINGS {
            self.cores = self.cores_beside(best.1, MOVED * step * self.size);
            for _ in 0..STEPS {
                let (before, (normal, offset)) = best;
                let (x, y) = normal.any_orthonormal_pair();
                let foot = center - normal * (normal.dot(center) - offset);
                let turned = [x, -x, y, -y].map(|way| {
                    let normal = (normal + step * way).normalize();
                    (normal, normal.dot(foot))
                });
                let moved = [1.0, -1.0].map(|way| (normal, offset + way * step * MOVED * self.size));
                for plane in turned.into_iter().chain(moved) {
                    let volume = self.volume(plane);
                    if volume < best.0 {
                        best = (volume, plane);
                    }
                }
                if best.0 >= before {
                    break;
                }
            }
            step /= 2.0;
        }
        best.1
    }

    /// The chunks that are farther from a plane than a distance.
    fn cores_beside(&self, (normal, offset): Plane, distance: f64) -> [Core; 2] {
        [1.0, -1.0].map(|way| {
            let plane = (way * normal, way * offset - distance);
            let is_far = |k: &usize| self.place(*k, plane) == Place::Below;
            let chunks: Vec<usize> = (0..self.chunks.len()).filter(is_far).collect();
            let all: Vec<DVec3> = chunks.iter().flat_map(|k| self.chunks[*k].corners.iter().copied()).collect();
            let corners = match approximate_hull_triangles(&all, HULL_TOUCHING) {
                Ok(triangles) => used_points(triangles).into_iter().map(|k| all[k as usize]).collect(),
                Err(_) => all,
            };
            Core { chunks, corners }
        })
    }

    fn place(&self, number: usize, plane: Plane) -> Place {
        let chunk = &self.chunks[number];
        let height = plane.0.dot(chunk.middle) - plane.1;
        if height < -chunk.radius {
            Place::Below
        } else if height > chunk.radius {
            Place::Above
        } else {
            chunk.place(plane, 0.0)
        }
    }

    /// The volume of the hulls of both sides; infinite where one is empty.
    fn volume(&mut self, plane: Plane) -> f64 {
        let places: Vec<Place> = (0..self.chunks.len()).map(|k| self.place(k, plane)).collect();
        let mut sides = [Vec::new(), Vec::new()];
        let mut is_in_core = vec![false; places.len()];
        for ((core, side), place) in self.cores.iter().zip(&mut sides).zip([Place::Below, Place::Above]) {
            if core.chunks.iter().all(|k| places[*k] == place) {
                side.extend_from_slice(&core.corners);
                core.chunks.iter().for_each(|k| is_in_core[*k] = true);
            }
        }
        for ((chunk, place), _) in self.chunks.iter().zip(places).zip(is_in_core).filter(|(_, is_in_core)| !is_in_core)
        {
            match place {
                Place::Below => sides[0].extend_from_slice(&chunk.corners),
                Place::Above => sides[1].extend_from_slice(&chunk.corners),
                Place::Across => {
                    let skeleton = chunk.skeleton();
                    for p in &skeleton.corners {
                        sides[usize::from(plane.0.dot(*p) > plane.1)].push(*p);
                    }
                    for p in skeleton.rim(plane) {
                        sides.iter_mut().for_each(|side| side.push(p));
                    }
                }
            }
        }
        self.work += sides.iter().map(Vec::len).sum::<usize>();
        if sides.iter().any(Vec::is_empty) {
            return f64::INFINITY;
        }
        sides.iter().map(|side| hull_volume(side)).sum()
    }
}
