//! The convex bodies that are to become fewer.

use std::cmp::Ordering;
use std::collections::BTreeMap;

use planecut_csg::stages::{Bounds, Boxes};
use planecut_csg::{Brush, MaterialId};
use planecut_kernel::{AddPlaneResult, DVec3, HalfSpace, IncrementalPolytope};

use super::CoarsenError;

/// Room for the rounding of a corner's coordinates and of its distance from a plane, relative to the terms of the latter.
const DISTANCE_BOUND: f64 = 16.0 * f64::EPSILON;

/// A bounded convex body with interior.
#[derive(Debug, Clone)]
pub(super) struct Part {
    pub(super) polytope: IncrementalPolytope,
    /// Those that carry a face.
    pub(super) half_spaces: Vec<HalfSpace>,
    /// Where they meet, rounded.
    pub(super) corners: Vec<DVec3>,
    /// Points of the input that belong to it although, by rounding, they may lie outside.
    pub(super) points: Vec<DVec3>,
    pub(super) material: MaterialId,
    pub(super) bounds: Bounds,
}

impl Part {
    /// A brush's body; `None` where it has no interior.
    pub(super) fn of_brush(brush: &Brush) -> Result<Option<Self>, CoarsenError> {
        let polytope = built(brush.faces.iter().map(|face| face.half_space));
        Ok(Self::of_polytope(polytope, MaterialId(0))?.map(|part| Self { material: material_of(&part, brush), ..part }))
    }

    /// The body of half-spaces; `None` where it has no interior.
    pub(super) fn of_half_spaces(
        half_spaces: impl IntoIterator<Item = HalfSpace>,
        material: MaterialId,
    ) -> Result<Option<Self>, CoarsenError> {
        Self::of_polytope(built(half_spaces), material)
    }

    /// The body of a polytope without epsilon; `None` where it has no interior.
    pub(super) fn of_polytope(
        polytope: IncrementalPolytope,
        material: MaterialId,
    ) -> Result<Option<Self>, CoarsenError> {
        if polytope.is_empty() {
            return Ok(None);
        }
        if !polytope.is_bounded() {
            return Err(CoarsenError::Unbounded);
        }
        let (corners, _) = mesh_of(&polytope);
        let half_spaces: Vec<HalfSpace> =
            polytope.facets().iter().filter_map(|(plane, _)| polytope.plane(*plane).copied()).collect();
        let bounds = bounds_of(&corners);
        Ok(Some(Self { polytope, half_spaces, corners, points: Vec::new(), material, bounds }))
    }

    /// The body of half-spaces that is sure to have interior.
    pub(super) fn of_cell(
        half_spaces: impl IntoIterator<Item = HalfSpace>,
        material: MaterialId,
    ) -> Result<Self, CoarsenError> {
        Self::of_half_spaces(half_spaces, material)?.ok_or(CoarsenError::OutOfRange)
    }

    /// The same body as a brush.
    pub(super) fn brush(&self) -> Brush {
        Brush::from_half_spaces(self.half_spaces.iter().copied(), self.material)
    }

    /// The length of the diagonal of its box.
    pub(super) fn size(&self) -> f64 {
        (self.bounds.max - self.bounds.min).length()
    }

    pub(super) fn volume(&self) -> f64 {
        self.polytope.measures().map_or(f64::INFINITY, |measures| measures.volume)
    }

    /// All points that a hull of it must hold, up to the rounding of corners.
    pub(super) fn all_points(&self) -> impl Iterator<Item = DVec3> + '_ {
        self.corners.iter().chain(&self.points).copied()
    }

    /// Whether it lies within a half-space, exactly.
    pub(super) fn is_within(&self, half_space: &HalfSpace) -> bool {
        if !self.points.iter().all(|point| holds(half_space, *point)) {
            return false;
        }
        let (normal, offset) = (half_space.normal(), half_space.offset());
        let reach = self.bounds.min.abs().max(self.bounds.max.abs());
        let margin = DISTANCE_BOUND * (normal.abs().dot(reach) + offset.abs());
        let farthest = self.corners.iter().map(|corner| normal.dot(*corner) - offset).fold(f64::NEG_INFINITY, f64::max);
        if farthest.abs() > margin {
            return farthest < 0.0;
        }
        let mut cut = self.polytope.clone();
        matches!(cut.add_plane(*half_space), AddPlaneResult::Redundant { .. })
    }
}

/// Whether a half-space holds a point, exactly.
pub(super) fn holds(half_space: &HalfSpace, point: DVec3) -> bool {
    let distance = half_space.normal().dot(point) - half_space.offset();
    let magnitude = half_space.normal().abs().dot(point.abs()) + half_space.offset().abs();
    if distance.abs() > DISTANCE_BOUND * magnitude {
        return distance < 0.0;
    }
    built([*half_space]).contains(point)
}

/// The polytope of half-spaces, with nothing contracted.
pub(super) fn built(half_spaces: impl IntoIterator<Item = HalfSpace>) -> IncrementalPolytope {
    let mut polytope = IncrementalPolytope::with_epsilon(0.0);
    for half_space in half_spaces {
        polytope.add_plane(half_space);
    }
    polytope
}

/// The mesh of a bounded polytope: corners in the order of their coordinates, and each polygon from the first of its corners.
///
/// In the order of the kernel's numbers, sums would be rounded otherwise after other cuts, and of cuts that are equally good another would be taken.
pub(super) fn mesh_of(polytope: &IncrementalPolytope) -> (Vec<DVec3>, Vec<Vec<usize>>) {
    let (found, mut polygons) = polytope.to_mesh();
    let mut order: Vec<usize> = (0..found.len()).collect();
    order.sort_by(|a, b| by_coordinates(&found[*a], &found[*b]));
    let mut numbers = vec![0; found.len()];
    order.iter().enumerate().for_each(|(number, old)| numbers[*old] = number);
    for polygon in &mut polygons {
        polygon.iter_mut().for_each(|corner| *corner = numbers[*corner]);
        let first = (0..polygon.len()).min_by_key(|place| polygon[*place]).unwrap_or(0);
        polygon.rotate_left(first);
    }
    (order.into_iter().map(|old| found[old]).collect(), polygons)
}

/// The boxes of parts.
pub(super) fn boxes_of(parts: &[Part]) -> Boxes {
    Boxes::new(parts.iter().map(|part| part.bounds).collect())
}

/// The box around points.
pub(super) fn bounds_of(points: &[DVec3]) -> Bounds {
    points.iter().fold(Bounds::EMPTY, |b, p| Bounds { min: b.min.min(*p), max: b.max.max(*p) })
}

/// Puts points in order, each once.
pub(super) fn sort_and_dedup(points: &mut Vec<DVec3>) {
    points.sort_by(by_coordinates);
    points.dedup();
}

fn by_coordinates(a: &DVec3, b: &DVec3) -> Ordering {
    a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)).then(a.z.total_cmp(&b.z))
}

/// The material of most of a brush's surface; of several the one with the lowest number.
fn material_of(part: &Part, brush: &Brush) -> MaterialId {
    let first = brush.faces.first().map_or(MaterialId(0), |face| face.material);
    if brush.faces.iter().all(|face| face.material == first) {
        return first;
    }
    let faces = part.polytope.planes().zip(&brush.faces);
    most(faces.map(|((plane, _), face)| (face.material, part.polytope.face_area(plane).unwrap_or(0.0))))
}

/// The material of most of the volume of parts.
pub(super) fn material_of_most<'a>(parts: impl Iterator<Item = &'a Part> + Clone) -> MaterialId {
    let mut materials = parts.clone().map(|part| part.material);
    match materials.next() {
        // volumes are measured exactly, which takes its time
        Some(first) if materials.all(|other| other == first) => first,
        _ => most(parts.map(|part| (part.material, part.volume()))),
    }
}

/// The material with the greatest sum; of several the one with the lowest number.
pub(super) fn most(shares: impl Iterator<Item = (MaterialId, f64)>) -> MaterialId {
    let mut sums: BTreeMap<MaterialId, f64> = BTreeMap::new();
    shares.for_each(|(material, share)| *sums.entry(material).or_default() += share);
    let most = sums.into_iter().rev().max_by(|a, b| a.1.total_cmp(&b.1));
    most.map_or(MaterialId(0), |(material, _)| material)
}

#[cfg(test)]
mod tests {
    use planecut_kernel::IncrementalPolytope;
    use planecut_testkit::generate::ball;
    use planecut_testkit::random::Rng;

    use super::{built, mesh_of};

    /// Planes that come and go in between leave the same body with other numbers.
    #[test]
    fn the_mesh_does_not_depend_on_how_vertices_are_numbered() {
        let mut renumbered = 0;
        for seed in 0..20 {
            let mut rng = Rng::spread(seed);
            let half_spaces: Vec<_> =
                ball(&mut rng, glam::DVec3::ZERO, 1.0, 24).faces.iter().map(|face| face.half_space).collect();
            let direct = built(half_spaces.iter().copied());
            let mut other = IncrementalPolytope::with_epsilon(0.0);
            for half_space in &half_spaces {
                other.add_plane(*half_space);
                let passing = ball(&mut rng, glam::DVec3::ZERO, 0.5, 1).faces[0].half_space;
                let handle = other.add_plane(passing).plane();
                other.remove_plane(handle);
            }
            eprintln!("seed {seed}");
            renumbered += usize::from(direct.to_mesh() != other.to_mesh());
            assert_eq!(mesh_of(&direct), mesh_of(&other));
        }
        assert!(renumbered > 0, "all have the same numbers, so this shows nothing");
    }
}
