//! From a group to the exact body around it.

use planecut_csg::stages::{KnownPlanes, compare};
use planecut_kernel::{DVec3, HalfSpace, hull};

use super::CoarsenError;
use super::clear::Clear;
use super::part::{Part, bounds_of, holds, material_of_most};
use crate::tolerances::FLAT_PADDING;

impl Part {
    /// The body around parts, of the material of most of them.
    ///
    /// # Errors
    /// [`CoarsenError::OutOfRange`] for coordinates that no plane can have.
    pub(super) fn around(parts: &[&Self], clear: &Clear) -> Result<Self, CoarsenError> {
        Self::of_cell(enclose(parts, clear)?, material_of_most(parts.iter().copied()))
    }
}

/// Half-spaces whose intersection holds all parts, exactly, and about is their hull; of one part, its own.
///
/// Where a facet of the hull is one of a part, it is the very same plane. `clear` are regions that the hull does not reach into but
/// for rounding: where one of their planes has all parts on its other side, this side of it is one of the half-spaces.
pub(super) fn enclose(parts: &[&Part], clear: &Clear) -> Result<Vec<HalfSpace>, CoarsenError> {
    if let [part] = parts
        && part.points.iter().all(|point| part.polytope.contains(*point))
    {
        return Ok(part.half_spaces.clone());
    }
    let points: Vec<DVec3> = parts.iter().flat_map(|part| part.all_points()).collect();
    let mut half_spaces = match hull(&points) {
        Ok(polytope) => {
            let own = KnownPlanes::new(parts.iter().flat_map(|part| &part.half_spaces));
            let exact = |plane: &HalfSpace| {
                let mut same = own.like(plane);
                let held = same.find(|plane| parts.iter().all(|part| part.is_within(plane)));
                held.unwrap_or_else(|| loosened(*plane, parts))
            };
            let facets = polytope.facets();
            facets.iter().filter_map(|(plane, _)| polytope.plane(*plane)).map(exact).collect()
        }
        Err(_) => box_around(&points, parts)?,
    };
    for region in clear.near(&bounds_of(&points)) {
        let sides = region.half_spaces.iter().map(HalfSpace::flipped);
        half_spaces.extend(sides.filter(|side| parts.iter().all(|part| part.is_within(side))).take(1));
    }
    half_spaces.sort_by(compare);
    half_spaces.dedup();
    Ok(half_spaces)
}

/// The half-space moved outward until it holds all parts.
fn loosened(half_space: HalfSpace, parts: &[&Part]) -> HalfSpace {
    let normal = half_space.normal();
    let reach = parts.iter().flat_map(|part| part.all_points()).map(|p| normal.abs().dot(p.abs())).fold(0.0, f64::max);
    let (mut held, mut step) = (half_space, f64::EPSILON * reach.max(half_space.offset().abs()));
    let mut outside: Vec<&Part> = parts.to_vec();
    loop {
        outside.retain(|part| !part.is_within(&held));
        if outside.is_empty() {
            return held;
        }
        match HalfSpace::new(normal, held.offset() + step) {
            Ok(wider) => held = wider,
            Err(_) => return held,
        }
        step *= 2.0;
    }
}

/// The box around points that span no space in numbers, although bodies do.
fn box_around(points: &[DVec3], parts: &[&Part]) -> Result<Vec<HalfSpace>, CoarsenError> {
    let bounds = bounds_of(points);
    let padding = FLAT_PADDING * bounds.min.abs().max(bounds.max.abs()).max_element().max(f64::MIN_POSITIVE);
    let mut sides = Vec::new();
    for axis in DVec3::AXES {
        for (normal, offset) in [(axis, axis.dot(bounds.max) + padding), (-axis, padding - axis.dot(bounds.min))] {
            let side = HalfSpace::new(normal, offset).map_err(|_| CoarsenError::OutOfRange)?;
            sides.push(loosened(side, parts));
        }
    }
    Ok(sides)
}

/// Whether half-spaces hold a point, exactly.
pub(super) fn all_hold(half_spaces: &[HalfSpace], point: DVec3) -> bool {
    half_spaces.iter().all(|half_space| holds(half_space, point))
}
