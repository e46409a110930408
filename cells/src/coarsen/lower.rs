//! Fewer planes for a convex body, one after another the one whose removal adds least.

use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

use planecut_kernel::sign::Row;
use planecut_kernel::{DVec3, HalfSpace, IncrementalPolytope, PlaneIdx, VertexIdx, meet};
use planecut_parallel::job;

use super::CoarsenError;
use super::clear::Clear;
use super::options::{LEAST_MAX_FACES, LEAST_MAX_VERTICES};
use super::part::built;

/// Takes planes out of a bounded polytope until it has no more faces and vertices than asked, always the plane whose removal adds least volume; returns about how much that
/// added, in the cube of its units. No plane is moved, so the polytope that is left encloses the one that was there, exactly.
///
/// Greedy removal with a heap is that of Jacobson, "Progressive Convex Hull Simplification" (2026, arXiv 2604.14468). There, the costs of all neighbours are computed again after each removal.
/// Here, a cost that is out of date stays in the heap: what a removal adds can only grow when other planes go, for it is the volume of the points that the plane alone keeps out; so
/// a cost is a lower bound for ever, and is computed again only where it comes first. With `n` planes this takes about `n log n` steps.
///
/// Faces are counted exactly, vertices as the polytope's tolerance shows them ([`IncrementalPolytope::vertex_count`]). Planes without a face are taken out first.
///
/// # Errors
/// [`CoarsenError::Unbounded`], [`CoarsenError::Empty`], and [`CoarsenError::Option`] for caps below [`LEAST_MAX_FACES`] and [`LEAST_MAX_VERTICES`]; the polytope is as it was.
///
/// ```
/// use planecut_cells::coarsen::lower;
/// use planecut_kernel::{DVec3, HalfSpace, IncrementalPolytope};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mut body = IncrementalPolytope::new();
/// for axis in DVec3::AXES {
///     body.add_plane(HalfSpace::new(axis, 1.0)?);
///     body.add_plane(HalfSpace::new(-axis, 1.0)?);
/// }
/// body.add_plane(HalfSpace::new(DVec3::ONE, 2.0)?);
/// let added = lower(&mut body, Some(6), None)?;
/// assert!((added - 1.0 / 6.0).abs() < 1e-15);
/// assert_eq!((body.faces().len(), body.vertex_count()), (6, 8));
/// # Ok(())
/// # }
/// ```
pub fn lower(
    polytope: &mut IncrementalPolytope,
    max_faces: Option<usize>,
    max_vertices: Option<usize>,
) -> Result<f64, CoarsenError> {
    let refuse =
        |option, found: usize, expected| Err(CoarsenError::Option { option, found: found.to_string(), expected });
    if let Some(found) = max_faces.filter(|faces| *faces < LEAST_MAX_FACES) {
        return refuse("max_faces", found, "at least 6");
    }
    if let Some(found) = max_vertices.filter(|vertices| *vertices < LEAST_MAX_VERTICES) {
        return refuse("max_vertices", found, "at least 8");
    }
    if polytope.is_empty() {
        return Err(CoarsenError::Empty);
    }
    if !polytope.is_bounded() {
        return Err(CoarsenError::Unbounded);
    }
    lower_beside(polytope, max_faces, max_vertices, &Clear::default())
}

/// The same for a bounded polytope that must not grow into some regions.
///
/// # Errors
/// [`CoarsenError::Blocked`] where they do not allow that.
pub(super) fn lower_beside(
    polytope: &mut IncrementalPolytope,
    max_faces: Option<usize>,
    max_vertices: Option<usize>,
    clear: &Clear,
) -> Result<f64, CoarsenError> {
    let mut lowering = Lowering::of(polytope, max_vertices);
    let max_faces = max_faces.unwrap_or(usize::MAX);
    while lowering.faces > max_faces || lowering.has_too_many_vertices() {
        job::check();
        lowering.step(clear)?;
    }
    Ok(lowering.added)
}

/// What taking a plane out adds at least.
struct Cost {
    volume: f64,
    plane: PlaneIdx,
}

impl Ord for Cost {
    fn cmp(&self, other: &Self) -> Ordering {
        self.volume.total_cmp(&other.volume).then(self.plane.cmp(&other.plane))
    }
}

impl PartialOrd for Cost {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Cost {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Cost {}

/// A polytope that loses planes.
struct Lowering<'a> {
    polytope: &'a mut IncrementalPolytope,
    /// Each plane at most once; those that can never go are left out.
    costs: BinaryHeap<Reverse<Cost>>,
    /// By plane: whether its cost was computed before a plane beside it went.
    is_old: Vec<bool>,
    faces: usize,
    vertices: Option<VertexCap>,
    added: f64,
}

/// When vertices have to be counted again: counting takes as long as there are vertices.
struct VertexCap {
    most: usize,
    /// How many there are at least; `None` where they were never counted.
    least: Option<usize>,
}

impl<'a> Lowering<'a> {
    fn of(polytope: &'a mut IncrementalPolytope, max_vertices: Option<usize>) -> Self {
        let mut has_facet = Vec::new();
        polytope.for_each_facet(|plane, _| {
            has_facet.resize(has_facet.len().max(plane.0 + 1), false);
            has_facet[plane.0] = true;
        });
        let (facets, others): (Vec<PlaneIdx>, Vec<PlaneIdx>) =
            polytope.planes().map(|(plane, _)| plane).partition(|plane| has_facet.get(plane.0) == Some(&true));
        polytope.remove_planes(&others);
        let cost =
            |plane: &PlaneIdx| polytope.volume_beyond(*plane).map(|volume| Reverse(Cost { volume, plane: *plane }));
        let costs: Vec<Reverse<Cost>> = facets.iter().filter_map(cost).collect();
        Self {
            costs: costs.into(),
            is_old: vec![false; has_facet.len()],
            faces: facets.len(),
            vertices: max_vertices.map(|most| VertexCap { most, least: None }),
            polytope,
            added: 0.0,
        }
    }

    fn has_too_many_vertices(&mut self) -> bool {
        let Some(cap) = &mut self.vertices else { return false };
        let polytope = &*self.polytope;
        let least = cap.least.filter(|least| *least > cap.most).unwrap_or_else(|| polytope.vertex_count());
        cap.least = Some(least);
        least > cap.most
    }

    /// Takes out the plane whose removal adds least.
    fn step(&mut self, clear: &Clear) -> Result<(), CoarsenError> {
        while let Some(Reverse(Cost { volume, plane })) = self.costs.pop() {
            let mut volume = volume;
            if std::mem::take(&mut self.is_old[plane.0]) {
                // what has no end never gets one
                let Some(now) = self.polytope.volume_beyond(plane) else { continue };
                volume = now;
                let now = Reverse(Cost { volume, plane });
                if self.costs.peek().is_some_and(|next| next > &now) {
                    self.costs.push(now);
                    continue;
                }
            }
            if self.remove(plane, clear) {
                self.added += volume;
                return Ok(());
            }
        }
        Err(CoarsenError::Blocked { faces: self.faces, vertices: self.polytope.vertex_count() })
    }

    /// Takes a plane out; false, and it stays for ever, where the body would grow into a region that is kept clear.
    fn remove(&mut self, plane: PlaneIdx, clear: &Clear) -> bool {
        let Some(result) = self.polytope.remove_plane(plane) else { return false };
        let (half_space, removed) = (result.half_space, result.removed_vertices.len());
        let created = result.new_vertices.to_vec();
        if !clear.is_empty() && !clear.allows(&self.gained(&half_space, &created)) {
            // under the same handle, which is the last one that became free
            self.polytope.add_plane(half_space);
            return false;
        }
        // each plane that was beside the face is at one of its new corners
        let beside: Vec<PlaneIdx> = self.planes_at(&created).collect();
        beside.into_iter().for_each(|plane| self.is_old[plane.0] = true);
        self.faces -= 1;
        if let Some(VertexCap { most, least: Some(least) }) = self.vertices {
            self.vertices = Some(VertexCap { most, least: Some(self.fewest_vertices(least, removed, &created)) });
        }
        true
    }

    /// What the removal of a half-space added, which made some vertices.
    fn gained(&self, half_space: &HalfSpace, created: &[VertexIdx]) -> IncrementalPolytope {
        let mut sides: Vec<PlaneIdx> = self.planes_at(created).collect();
        sides.sort_unstable();
        sides.dedup();
        let sides = sides.into_iter().filter_map(|side| self.polytope.plane(side).copied());
        built(sides.chain([half_space.flipped()]))
    }

    /// The planes at vertices.
    fn planes_at(&self, vertices: &[VertexIdx]) -> impl Iterator<Item = PlaneIdx> {
        vertices
            .iter()
            .filter_map(|vertex| self.polytope.simple_vertex(*vertex))
            .flat_map(|(planes, _)| planes)
            .flatten()
    }

    /// How many vertices there are at least, where there were `least` before some were removed and others were created.
    fn fewest_vertices(&self, least: usize, removed: usize, created: &[VertexIdx]) -> usize {
        let is_alone = |vertex: &VertexIdx| {
            let Some((_, neighbours)) = self.polytope.simple_vertex(*vertex) else { return false };
            let place = self.place(*vertex);
            // a little more than what is contracted
            let near = 2.0 * self.polytope.epsilon().max(0.0);
            neighbours.iter().all(|other| match (place, self.place(*other)) {
                (Some(place), Some(other)) => place.distance(other) > near,
                _ => false,
            })
        };
        let alone = created.iter().filter(|vertex| is_alone(vertex)).count();
        // one that is not may make one of the three beside it
        (least + alone).saturating_sub(removed + 2 * (created.len() - alone))
    }

    fn place(&self, vertex: VertexIdx) -> Option<DVec3> {
        let [a, b, c] = self.polytope.simple_vertex(vertex)?.0;
        let row = |plane: Option<PlaneIdx>| plane.and_then(|plane| self.polytope.plane(plane)).map(Row::new);
        meet(&row(a)?, &row(b)?, &row(c)?)
    }
}
