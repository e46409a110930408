//! Cells within the solid: each part grown as far as the solid goes, and of these the ones that hold most.

use planecut_csg::stages::Boxes;
use planecut_kernel::{HalfSpace, IncrementalPolytope};
use planecut_parallel::prelude::*;

use super::part::{Part, built};
use super::subtract::subtract;
use super::{CoarsenError, CoarsenOptions};
use crate::tolerances::GROWN;

/// Maximum number of steps in which a part grows.
const MOST_STEPS: usize = 32;
/// Parts without those of their planes that nothing but another part lies behind, each once.
pub(super) fn grown(parts: &[Part], boxes: &Boxes, options: &CoarsenOptions) -> Result<Vec<Part>, CoarsenError> {
    let grown: Vec<Part> =
        parts.par_iter().map(|part| grown_part(part, parts, boxes, options)).collect::<Result<_, _>>()?;
    // what another one holds is of no use
    let volumes: Vec<f64> = grown.iter().map(Part::volume).collect();
    let mut order: Vec<usize> = (0..grown.len()).collect();
    order.sort_by(|a, b| volumes[*b].total_cmp(&volumes[*a]).then(a.cmp(b)));
    let mut kept: Vec<Part> = Vec::new();
    for part in order.into_iter().map(|place| &grown[place]) {
        let is_within = |other: &Part| {
            other.bounds.touches(&part.bounds) && other.half_spaces.iter().all(|plane| part.is_within(plane))
        };
        if !kept.iter().any(is_within) {
            kept.push(part.clone());
        }
    }
    Ok(kept)
}

/// The part grown beyond one facet after another, as long as that is possible: into a neighbour behind it, as far as its own other planes and
/// those of the neighbour's that hold all of it go.
fn grown_part(part: &Part, parts: &[Part], boxes: &Boxes, options: &CoarsenOptions) -> Result<Part, CoarsenError> {
    let mut grown = part.clone();
    let mut near = Vec::new();
    for _ in 0..MOST_STEPS {
        boxes.touching(&grown.bounds, &mut near);
        let fits = |place: &&u32| !options.by_material || parts[**place as usize].material == part.material;
        let neighbours: Vec<&Part> = near.iter().filter(fits).map(|place| &parts[*place as usize]).collect();
        let is_inside = |wider: &Part| subtract(&wider.polytope, &neighbours).is_empty();
        let beyond = |facet: &HalfSpace, other: &Part| -> Result<Option<Part>, CoarsenError> {
            if !other.is_within(&facet.flipped()) {
                return Ok(None);
            }
            let own = grown.half_spaces.iter().filter(|plane| *plane != facet);
            let around = other.half_spaces.iter().filter(|plane| grown.is_within(plane));
            let polytope = built(own.chain(around).copied());
            if !polytope.is_bounded() {
                return Ok(None);
            }
            let wider = Part::of_polytope(polytope, part.material)?;
            Ok(wider.filter(|wider| is_inside(wider) && grown.volume() < wider.volume() * GROWN))
        };
        let pairs = grown.half_spaces.iter().flat_map(|facet| neighbours.iter().map(move |other| (facet, *other)));
        let wider = pairs.filter_map(|(facet, other)| beyond(facet, other).transpose()).next().transpose()?;
        match wider {
            Some(wider) => grown = wider,
            None => break,
        }
    }
    Ok(grown)
}

/// The bodies, at most a given number, that hold most of the solid together: always the one that adds most.
pub(super) fn chosen(bodies: &[Part], count: usize) -> Vec<Part> {
    let mut chosen: Vec<usize> = Vec::new();
    // what a body adds never becomes more
    let mut at_most: Vec<f64> = bodies.iter().map(Part::volume).collect();
    while chosen.len() < count.min(bodies.len()) {
        let mut known = vec![false; bodies.len()];
        let best = loop {
            let open = (0..bodies.len()).filter(|place| !chosen.contains(place));
            let Some(best) = open.max_by(|a, b| at_most[*a].total_cmp(&at_most[*b]).then(b.cmp(a))) else { break None };
            if known[best] {
                break Some(best);
            }
            known[best] = true;
            let own = &bodies[best];
            let near = chosen.iter().map(|place| &bodies[*place]).filter(|other| other.bounds.touches(&own.bounds));
            let left = subtract(&own.polytope, &near.collect::<Vec<_>>());
            at_most[best] = left.iter().filter_map(IncrementalPolytope::measures).map(|measures| measures.volume).sum();
        };
        match best.filter(|best| at_most[*best] > 0.0) {
            Some(best) => chosen.push(best),
            None => break,
        }
    }
    chosen.into_iter().map(|place| bodies[place].clone()).collect()
}
