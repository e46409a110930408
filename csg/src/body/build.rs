//! From the planes of brushes to their bodies, all at once and in parallel.

use std::borrow::{Borrow, Cow};

use planecut_kernel::sign::{Counts, Row};
use planecut_kernel::{HalfSpace, IncrementalPolytope, PlaneIdx};
use planecut_parallel::prelude::*;

use super::built::{self, BrushShape, BuiltBodies};
use super::{Body, BrushBody, Shape};
use crate::base::{Bounds, map_chunks};
use crate::model::{Brush, BrushFace, MaterialId};
use crate::plane_table::{PlaneId, PlaneTable, renumber_planes, smallest_size};

/// Least number of planes, about, of bodies that are built in a row.
const PLANES_OF_CHUNK: usize = 100;

/// The bodies of the brushes of a model.
pub(crate) struct BrushBodies {
    pub(crate) table: PlaneTable,
    /// The planes of each brush, in its order.
    pub(crate) planes: Vec<Vec<PlaneId>>,
    pub(crate) bodies: Vec<BrushBody>,
    pub(crate) signs: Counts,
}

/// Interns the planes of brushes and builds the body of each, in parallel.
pub(crate) fn build_bodies(brushes: &[Brush]) -> BrushBodies {
    build_other_bodies(brushes, &BuiltBodies::default(), smallest_size(brushes.iter().map(Brush::half_spaces)))
}

/// The same, where some may be built already; `size` is the size of the smallest of these brushes and of all others that their planes are
/// to be the same with.
pub(crate) fn build_other_bodies(brushes: &[Brush], built: &BuiltBodies, size: f64) -> BrushBodies {
    let half_spaces: Vec<HalfSpace> = brushes.iter().flat_map(Brush::half_spaces).copied().collect();
    let (mut table, ids) = PlaneTable::intern(&half_spaces, size);
    let mut rest = ids.as_slice();
    let mut planes: Vec<Vec<PlaneId>> = brushes
        .iter()
        .map(|brush| {
            let (own, others) = rest.split_at(brush.faces.len());
            rest = others;
            own.to_vec()
        })
        .collect();
    let with_planes: Vec<(&Brush, &Vec<PlaneId>)> = brushes.iter().zip(&planes).collect();
    let (parts, signs) = map_chunks(&with_planes, least_of_chunk(brushes), |chunk| {
        let mut polytope = IncrementalPolytope::with_epsilon(0.0);
        chunk.iter().map(|&(brush, planes)| shape_of(&table, built, brush, planes, &mut polytope)).collect::<Vec<_>>()
    });
    let shapes: Vec<Cow<'_, BrushShape>> = parts.into_iter().flatten().collect();
    let bounds: Vec<Option<Bounds>> = shapes.iter().map(|shape| shape.bounds().copied()).collect();
    renumber_planes(&mut table, &mut planes, &bounds);
    let bodies: Vec<BrushBody> = shapes
        .par_iter()
        .zip(brushes.par_iter().zip(&planes))
        .with_min_len(64)
        .map(|(shape, (brush, planes))| shape.body(planes, |k| brush.faces[k].material))
        .collect();
    BrushBodies { table, planes, bodies, signs }
}

/// Number of brushes in a chunk; each chunk has a polytope of its own, which is worth the while from some planes on.
pub(super) fn least_of_chunk<B: Borrow<Brush>>(brushes: &[B]) -> usize {
    let planes: usize = brushes.iter().map(|brush| brush.borrow().faces.len()).sum();
    PLANES_OF_CHUNK * brushes.len() / planes.max(1)
}

/// What a brush is, whose planes have ids in a table; `polytope` is a buffer. It is not built again where that was done and the
/// table has taken none of the planes for another.
fn shape_of<'a>(
    table: &PlaneTable,
    built: &'a BuiltBodies,
    brush: &Brush,
    planes: &[PlaneId],
    polytope: &mut IncrementalPolytope,
) -> Cow<'a, BrushShape> {
    let stays = |(face, plane): (&BrushFace, &PlaneId)| {
        let row = Row::new(&face.half_space);
        row.coefficients() == table.row(*plane).coefficients() || row.is_same_plane(table.row(*plane))
    };
    let known = built.shape_of(&brush.faces);
    match known.filter(|_| brush.faces.iter().zip(planes).all(stays)) {
        Some(known) => Cow::Borrowed(known),
        None => Cow::Owned(shape_in_table(table, planes, polytope)),
    }
}

fn shape_in_table(table: &PlaneTable, planes: &[PlaneId], polytope: &mut IncrementalPolytope) -> BrushShape {
    let plane = |k: usize| (table.row(planes[k]), table.half_space(planes[k]));
    built::shape_of_planes(planes.len(), plane, polytope)
}

/// The body of a brush, whose planes have ids in a table; `polytope` is a buffer.
pub(crate) fn built_or_build(
    table: &PlaneTable,
    built: &BuiltBodies,
    brush: &Brush,
    planes: &[PlaneId],
    polytope: &mut IncrementalPolytope,
) -> BrushBody {
    shape_of(table, built, brush, planes, polytope).body(planes, |k| brush.faces[k].material)
}

/// The body that planes bound, each with the material of its face; `polytope` is a buffer.
pub(crate) fn build(
    table: &PlaneTable,
    planes: &[PlaneId],
    materials: &[MaterialId],
    polytope: &mut IncrementalPolytope,
) -> BrushBody {
    shape_in_table(table, planes, polytope).body(planes, |k| materials[k])
}

/// The body of a polytope, its faces in the order of the planes, whatever that in which they were added: `planes` have ids in a
/// table, `material` gives that of each, and `place_of` its place for a handle of the polytope.
pub(crate) fn read(
    table: &PlaneTable,
    polytope: &IncrementalPolytope,
    planes: &[PlaneId],
    material: impl Fn(usize) -> MaterialId,
    place_of: impl Fn(PlaneIdx) -> usize,
) -> BrushBody {
    let plane = |idx: PlaneIdx| {
        let plane = planes[place_of(idx)];
        (table.row(plane), table.half_space(plane))
    };
    let mut shape = built::shape_of_polytope(polytope, plane);
    if let BrushShape::Bounded(shape) = &mut shape {
        shape.sort_faces(&place_of);
    }
    shape.body_at(planes, material, place_of)
}

impl BrushShape {
    fn body(&self, planes: &[PlaneId], material: impl Fn(usize) -> MaterialId) -> BrushBody {
        self.body_at(planes, material, |idx| idx.0)
    }

    fn body_at(
        &self,
        planes: &[PlaneId],
        material: impl Fn(usize) -> MaterialId,
        place_of: impl Fn(PlaneIdx) -> usize,
    ) -> BrushBody {
        match self {
            Self::Bounded(shape) => {
                let face_of = |idx| {
                    let place = place_of(idx);
                    (planes[place], material(place))
                };
                let body = Body::new(shape, face_of);
                let redundant = planes.len() - body.faces.len();
                BrushBody::Bounded(body, redundant)
            }
            Self::Empty => BrushBody::Empty,
            Self::Unbounded => BrushBody::Unbounded,
        }
    }

    fn bounds(&self) -> Option<&Bounds> {
        match self {
            Self::Bounded(shape) => Some(Shape::bounds(shape)),
            Self::Empty | Self::Unbounded => None,
        }
    }
}
