//! Convex bodies around points of a surface.

use planecut_csg::MaterialId;
use planecut_kernel::{DVec3, HalfSpace, IncrementalPolytope, hull, hull_triangles};

use super::super::CoarsenError;
use super::super::part::Part;
use super::super::search::farthest;
use super::ROUNDING;
use super::fragment::Plane;

/// Points whose hull, grown a little, holds all that is to be held.
#[derive(Debug, Clone, Default)]
pub(in super::super) struct Points {
    /// Vertices of the surface.
    pub(super) vertices: Vec<DVec3>,
    /// Points where it was cut, and corners of boxes inside: most of them lie in the hull of the vertices, or outside of it by rounding alone.
    pub(super) cuts: Vec<DVec3>,
}

/// What bodies are larger by than the points that they hold.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Growth {
    /// Each way along the axes: half of the thickness of a surface that bounds nothing.
    pub(super) thickness: f64,
    /// More than all rounding.
    pub(super) rounding: f64,
}

impl Points {
    /// Those of several pieces.
    pub(in super::super) fn joined<'a>(pieces: impl Iterator<Item = &'a Self>) -> Self {
        let mut all = Self::default();
        for piece in pieces {
            all.vertices.extend_from_slice(&piece.vertices);
            all.cuts.extend_from_slice(&piece.cuts);
        }
        all
    }

    /// Without those that are no corners of their hull.
    pub(super) fn without_inner(self) -> Self {
        let all: Vec<DVec3> = self.all().copied().collect();
        let Ok(triangles) = hull_triangles(&all) else { return self };
        let used = used_points(triangles);
        let (vertices, cuts) = used.split_at(used.partition_point(|k| (*k as usize) < self.vertices.len()));
        let [vertices, cuts] = [vertices, cuts].map(|used| used.iter().map(|k| all[*k as usize]).collect());
        Self { vertices, cuts }
    }

    /// The corners of all that must be held: of cubes around the points where a surface has thickness.
    pub(super) fn thick(&self, half: f64) -> Vec<DVec3> {
        let points: Vec<DVec3> = self.all().copied().collect();
        if half > 0.0 { boxes_around(&points, half) } else { points }
    }

    pub(super) fn all(&self) -> impl Iterator<Item = &DVec3> {
        self.vertices.iter().chain(&self.cuts)
    }

    /// Some of the points, of whose hull no other is outside by more than rounding. What was cut has many points that lie on one plane or line but for rounding.
    fn needed(&self, growth: &Growth) -> Vec<DVec3> {
        let all: Vec<DVec3> = self.all().copied().collect();
        let mut chosen = farthest(if self.vertices.is_empty() { &all } else { &self.vertices });
        if !self.vertices.is_empty() {
            chosen.extend_from_slice(&self.vertices);
            chosen = corners_of(chosen);
        }
        // vertices are held already, exactly
        let mut rest = if self.vertices.is_empty() { all } else { self.cuts.clone() };
        loop {
            let Ok(triangles) = hull_triangles(&chosen) else {
                // flat so far
                chosen.append(&mut rest);
                return chosen;
            };
            let planes: Vec<Plane> = triangles.iter().filter_map(|triangle| plane_through(&chosen, triangle)).collect();
            let mut farthest: Vec<(f64, usize)> = vec![(0.5 * growth.rounding, usize::MAX); planes.len()];
            rest.retain(|p| planes.iter().any(|(normal, offset)| normal.dot(*p) > offset + 0.5 * growth.rounding));
            for (number, p) in rest.iter().enumerate() {
                for ((normal, offset), farthest) in planes.iter().zip(&mut farthest) {
                    let height = normal.dot(*p) - offset;
                    if height > farthest.0 {
                        *farthest = (height, number);
                    }
                }
            }
            let mut taken: Vec<usize> =
                farthest.into_iter().map(|(_, number)| number).filter(|k| *k != usize::MAX).collect();
            if taken.is_empty() {
                return chosen;
            }
            taken.sort_unstable();
            taken.dedup();
            // the plane of a sliver may leave out its own corners: none is taken twice
            for number in taken.into_iter().rev() {
                chosen.push(rest.swap_remove(number));
            }
        }
    }

    /// The body that holds the points and everything that is no farther from them than the growth; none where its numbers are out of range.
    ///
    /// # Errors
    /// [`CoarsenError::OutOfRange`] for coordinates that no plane can have.
    pub(in super::super) fn body(&self, growth: &Growth, material: MaterialId) -> Result<Option<Part>, CoarsenError> {
        let needed = self.needed(growth);
        let body = if growth.thickness > 0.0 {
            hull(&boxes_around(&corners_of(needed), growth.thickness))
        } else {
            hull(&needed)
        };
        // what is flat is as thick as it grows
        let Ok(body) = body.or_else(|_| hull(&boxes_around(&self.all().copied().collect::<Vec<_>>(), growth.rounding)))
        else {
            return Ok(None);
        };
        Part::of_half_spaces(self.moved_outward(&body, growth), material)
    }

    /// The planes of a body, moved outward until the points are as far within as they must be. The body holds the vertices, as thick as they are.
    fn moved_outward(&self, body: &IncrementalPolytope, growth: &Growth) -> Vec<HalfSpace> {
        let facets = body.facets();
        let planes = facets.iter().filter_map(|(plane, _)| body.plane(*plane));
        let moved = planes.filter_map(|plane| {
            let normal = plane.normal();
            let thick = growth.thickness * (normal.x.abs() + normal.y.abs() + normal.z.abs());
            let farthest = self.cuts.iter().map(|p| normal.dot(*p)).fold(f64::NEG_INFINITY, f64::max) + thick;
            let offset = farthest.max(plane.offset()) + normal.length() * growth.rounding;
            HalfSpace::new(normal, offset + ROUNDING * offset.abs()).ok()
        });
        moved.collect()
    }
}

/// The corners of the hull of points; all of them where there is none.
fn corners_of(points: Vec<DVec3>) -> Vec<DVec3> {
    let Ok(triangles) = hull_triangles(&points) else { return points };
    used_points(triangles).into_iter().map(|k| points[k as usize]).collect()
}

/// The numbers of the points that triangles use, ascending.
pub(super) fn used_points(triangles: Vec<[u32; 3]>) -> Vec<u32> {
    let mut used: Vec<u32> = triangles.into_iter().flatten().collect();
    used.sort_unstable();
    used.dedup();
    used
}

/// The corners of cubes around points.
fn boxes_around(points: &[DVec3], half: f64) -> Vec<DVec3> {
    let corner =
        |p: DVec3, k: i32| p + half * DVec3::from_array([k & 1, k >> 1 & 1, k >> 2].map(|v| f64::from(v * 2 - 1)));
    points.iter().flat_map(|p| (0..8).map(|k| corner(*p, k))).collect()
}

/// Unit normal and offset of a triangle; none where it has no area.
fn plane_through(points: &[DVec3], triangle: &[u32; 3]) -> Option<Plane> {
    let [a, b, c] = triangle.map(|corner| points[corner as usize]);
    let normal = (b - a).cross(c - a).try_normalize()?;
    Some((normal, normal.dot(a).max(normal.dot(b)).max(normal.dot(c))))
}
