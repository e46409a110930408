//! A bounded convex body in numbers of its own: faces, edges and corners, whatever ids its planes have elsewhere.

use crate::ids::number32;
use std::sync::{Arc, OnceLock};

use glam::DVec3;
use planecut_kernel::sign::{Homogeneous, Row};
use planecut_kernel::{HalfSpace, IncrementalPolytope, PlaneIdx, meet};

use super::Corner;
use super::polar_dual::PolarDual;
use crate::base::Bounds;
use crate::ids::{CornerId, Id};

/// A bounded convex body with interior, its planes named as in the polytope that it was read from.
#[derive(Debug, Clone)]
pub(crate) struct Shape {
    pub(super) faces: Vec<Face>,
    pub(super) corners: Arc<Corners>,
    pub(super) bounds: Bounds,
    pub(super) volume: f64,
}

/// A face of a [`Shape`].
#[derive(Debug, Clone)]
pub(super) struct Face {
    pub(super) bounds: Bounds,
    /// Its edges and corners among those of the body.
    pub(super) start: u32,
    pub(super) end: u32,
}

/// What bodies of the same shape share.
#[derive(Debug)]
pub(super) struct Corners {
    /// The different corners.
    pub(super) different: Vec<Corner>,
    /// Face by face the numbers of its corners.
    pub(super) numbers: Vec<CornerId>,
    pub(super) structure: Arc<Structure>,
    /// Made when first asked for.
    pub(super) polar_dual: OnceLock<Option<Box<PolarDual>>>,
}

/// Which planes and edges faces have, what bodies share that differ in distances alone.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Structure {
    /// Face by face the planes of its edges: those of the neighbouring faces.
    pub(super) edges: Vec<PlaneIdx>,
    /// The plane of each face.
    pub(super) planes: Vec<PlaneIdx>,
}

impl Corners {
    /// Different corners, numbered in their order.
    pub(super) fn new(mut different: Vec<Corner>, numbers: Vec<CornerId>, structure: Arc<Structure>) -> Self {
        CornerId::all(different.len()).zip(&mut different).for_each(|(number, corner)| corner.number = number);
        Self { different, numbers, structure, polar_dual: OnceLock::new() }
    }

    /// The mean of the corners, each counted once for each face at it.
    pub(super) fn middle(&self) -> DVec3 {
        let corners = self.numbers.iter().map(|number| self.different[number.index()].at);
        corners.sum::<DVec3>() / self.numbers.len() as f64
    }
}

impl Shape {
    /// That of a bounded polytope; nothing where it is not bounded. `plane` gives the coefficients of its planes.
    pub(crate) fn of<'a>(polytope: &IncrementalPolytope, plane: impl Fn(PlaneIdx) -> &'a Row) -> Option<Self> {
        let (mut ends, mut different, mut numbers) = (Vec::new(), Vec::new(), Vec::new());
        let mut structure = Structure::default();
        let mut is_bounded = true;
        // the corners that other faces have as well, by their numbers
        let mut shared: Vec<Option<CornerId>> = vec![None; polytope.corner_bound()];
        polytope.for_each_facet(|own, edges| {
            // loops begin at the edge whose plane comes first, so that a shape does not depend on how it was found
            let first = (0..edges.len()).min_by_key(|k| edges[*k].plane).unwrap_or(0);
            let edges = || edges[first..].iter().chain(&edges[..first]);
            let start = structure.edges.len();
            for edge in edges() {
                let Some(edge) = edge.plane else {
                    is_bounded = false;
                    return;
                };
                structure.edges.push(edge);
            }
            let count = structure.edges.len() - start;
            for (i, edge) in edges().enumerate() {
                let known = edge.corner.and_then(|number| shared[number]);
                let number = known.unwrap_or_else(|| {
                    let triple = [own, structure.edges[start + i], structure.edges[start + (i + 1) % count]];
                    let [a, b, c] = triple.map(&plane);
                    different.push(Corner::new(&Homogeneous::meet(a, b, c)));
                    CornerId::from_index(different.len() - 1)
                });
                if let Some(shared_number) = edge.corner {
                    shared[shared_number] = Some(number);
                }
                numbers.push(number);
            }
            structure.planes.push(own);
            ends.push(number32(structure.edges.len()));
        });
        structure.edges.shrink_to_fit();
        numbers.shrink_to_fit();
        is_bounded.then(|| Self::measured(&ends, Corners::new(different, numbers, Arc::new(structure)), plane))
    }

    /// The shape of known corners: boxes of its faces, of which each ends at an entry of the edges, and volume.
    pub(super) fn measured<'a>(ends: &[u32], corners: Corners, plane: impl Fn(PlaneIdx) -> &'a Row) -> Self {
        let mut volume = Volume::default();
        let mut start = 0;
        let structure = &*corners.structure;
        let face = |(&end, &own): (&u32, &PlaneIdx)| {
            let range = std::mem::replace(&mut start, end) as usize..end as usize;
            let (numbers, edges) = (&corners.numbers[range.clone()], &structure.edges[range.clone()]);
            let mut bounds = Bounds::EMPTY;
            volume.begin_face();
            for (i, number) in numbers.iter().enumerate() {
                let corner = &corners.different[number.index()];
                bounds = bounds.with_corner(corner);
                let exactly = || {
                    let [a, b, c] = [own, edges[i], edges[(i + 1) % edges.len()]].map(&plane);
                    meet(a, b, c)
                };
                volume.add(if corner.is_well_known() { Some(corner.at) } else { exactly() });
            }
            Face { bounds, start: number32(range.start), end }
        };
        let faces = ends.iter().zip(&structure.planes).map(face).collect();
        let mut shape = Self { faces, corners: Arc::new(corners), bounds: Bounds::EMPTY, volume: volume.six / 6.0 };
        shape.tighten_bounds(|idx| plane(idx).half_space());
        shape
    }

    /// Takes the structure of another shape for its own, where it is the same: it is kept once.
    pub(super) fn share_structure(&mut self, other: &Self) {
        let structure = &other.corners.structure;
        if let Some(corners) = Arc::get_mut(&mut self.corners)
            && corners.structure == *structure
        {
            corners.structure = Arc::clone(structure);
        }
    }

    /// Brings the faces into the order that their planes have.
    pub(super) fn sort_faces(&mut self, place_of: impl Fn(PlaneIdx) -> usize) {
        let planes = &self.corners.structure.planes;
        if planes.is_sorted_by_key(|plane| place_of(*plane)) {
            return;
        }
        let mut order: Vec<usize> = (0..planes.len()).collect();
        order.sort_unstable_by_key(|face| place_of(planes[*face]));
        let planes = order.iter().map(|face| planes[*face]).collect();
        self.faces = order.iter().map(|face| self.faces[*face].clone()).collect();
        let corners = Arc::get_mut(&mut self.corners).expect("a shape that was made just now shares nothing");
        Arc::get_mut(&mut corners.structure).expect("nor its structure").planes = planes;
    }

    pub(crate) fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    /// The numbers of the first `planes` planes that have no face.
    pub(super) fn without_face(&self, planes: usize) -> Vec<u32> {
        if self.faces.len() == planes {
            return Vec::new();
        }
        let has_face = |plane: &usize| self.corners.structure.planes.contains(&PlaneIdx(*plane));
        (0..planes).filter(|plane| !has_face(plane)).map(number32).collect()
    }

    /// Cuts what corners are known to lie in down to what the planes leave of it.
    fn tighten_bounds<'a>(&mut self, half_space: impl Fn(PlaneIdx) -> &'a HalfSpace) {
        let planes = &self.corners.structure.planes;
        let all = self.faces.iter().fold(Bounds::EMPTY, |bounds, face| bounds.union(&face.bounds));
        self.bounds = planes.iter().fold(all, |bounds, plane| bounds.within(half_space(*plane)));
        for (face, plane) in self.faces.iter_mut().zip(planes) {
            let on_plane = face.bounds.within(&half_space(*plane).flipped());
            face.bounds = on_plane.intersection(&self.bounds);
        }
    }
}

/// The volume between the polygons of a convex boundary, as a sum of tetrahedra from one corner: nothing cancels.
#[derive(Default)]
struct Volume {
    six: f64,
    apex: Option<DVec3>,
    /// The first corner of the face and the last one so far, seen from the apex.
    first: Option<DVec3>,
    last: Option<DVec3>,
}

impl Volume {
    fn begin_face(&mut self) {
        (self.first, self.last) = (None, None);
    }

    fn add(&mut self, corner: Option<DVec3>) {
        let Some(corner) = corner else { return };
        let corner = corner - *self.apex.get_or_insert(corner);
        let first = *self.first.get_or_insert(corner);
        if let Some(last) = self.last {
            self.six += first.cross(last).dot(corner);
        }
        self.last = Some(corner);
    }
}
