//! From the planes of brushes to their bodies, all at once and in parallel.

use std::borrow::{Borrow, Cow};

use planecut_kernel::sign::{Counts, Row};
use planecut_kernel::{HalfSpace, IncrementalPolytope, PlaneIdx};
use planecut_parallel::prelude::*;
use rustc_hash::FxHashMap;

use super::built::{self, BrushShape, BuiltBodies, ShapeBuilder};
use super::{Body, BrushBody, Shape};
use crate::base::{Bounds, map_chunks};
use crate::ids::number32;
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
    let (mut table, mut planes) = intern_planes(brushes, size);
    let with_planes: Vec<(&Brush, &Vec<PlaneId>)> = brushes.iter().zip(&planes).collect();
    let (parts, signs) = map_chunks(&with_planes, least_of_chunk(brushes), |chunk| {
        let mut builder = ShapeBuilder::default();
        chunk.iter().map(|&(brush, planes)| shape_of(&table, built, brush, planes, &mut builder)).collect::<Vec<_>>()
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

/// The planes of brushes in a table, and those of each brush, in its order; `size` as for [`build_other_bodies`].
fn intern_planes(brushes: &[Brush], size: f64) -> (PlaneTable, Vec<Vec<PlaneId>>) {
    let lengths = brushes.iter().map(|brush| brush.faces.len());
    let half_space = |brush: usize, k: usize| &brushes[brush].faces[k].half_space;
    let (table, ids) = PlaneTable::intern_parts(lengths, half_space, size);
    let mut rest = ids.as_slice();
    let of_brush = |brush: &Brush| {
        let (own, others) = rest.split_at(brush.faces.len());
        rest = others;
        own.to_vec()
    };
    let planes = brushes.iter().map(of_brush).collect();
    (table, planes)
}

/// The same for brushes many of which have planes in common: what is the same in every bit is looked for first.
fn intern_repeated_planes(brushes: &[Brush], size: f64) -> (PlaneTable, Vec<Vec<PlaneId>>) {
    let mut different: Vec<HalfSpace> = Vec::new();
    let mut known: FxHashMap<[u64; 4], u32> = FxHashMap::default();
    let mut number = |half_space: &HalfSpace| {
        *known.entry(half_space.to_array().map(f64::to_bits)).or_insert_with(|| {
            different.push(*half_space);
            number32(different.len() - 1)
        })
    };
    let of_brush = |brush: &Brush| brush.half_spaces().map(&mut number).collect();
    let numbers: Vec<Vec<u32>> = brushes.iter().map(of_brush).collect();
    drop(known);
    let (table, ids) = PlaneTable::intern_parts(std::iter::once(different.len()), |_, k| &different[k], size);
    let of_brush = |numbers: Vec<u32>| numbers.into_iter().map(|number| ids[number as usize]).collect();
    (table, numbers.into_iter().map(of_brush).collect())
}

/// What is known of a brush of which nothing but its planes is kept.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum BrushExtent {
    /// A bounded body.
    Bounded {
        /// The box around it.
        bounds: Bounds,
        /// Its volume.
        volume: f64,
        /// Numbers of its planes that have no face.
        redundant: Vec<u32>,
    },
    /// No interior.
    Empty,
    /// Not bounded.
    Unbounded,
}

/// Where the brushes of a model are.
pub(crate) struct BrushExtents {
    pub(crate) table: PlaneTable,
    /// The planes of each brush, in its order.
    pub(crate) planes: Vec<Vec<PlaneId>>,
    pub(crate) extents: Vec<BrushExtent>,
    pub(crate) signs: Counts,
}

/// Interns the planes of brushes and tells what each is, without keeping the bodies: some kilobytes for each are a lot for a million of
/// them. They are built again, some of them at a time, by [`built_or_build`].
pub(crate) fn brush_extents(brushes: &[Brush], built: &BuiltBodies, size: f64) -> BrushExtents {
    let (mut table, mut planes) = intern_repeated_planes(brushes, size);
    let with_planes: Vec<(&Brush, &Vec<PlaneId>)> = brushes.iter().zip(&planes).collect();
    let (parts, signs) = map_chunks(&with_planes, least_of_chunk(brushes), |chunk| {
        let mut builder = ShapeBuilder::default();
        let extent =
            |&(brush, planes): &(&Brush, &Vec<PlaneId>)| match &*shape_of(&table, built, brush, planes, &mut builder) {
                BrushShape::Bounded(shape) => BrushExtent::Bounded {
                    bounds: *shape.bounds(),
                    volume: shape.volume,
                    redundant: shape.without_face(planes.len()),
                },
                BrushShape::Empty => BrushExtent::Empty,
                BrushShape::Unbounded => BrushExtent::Unbounded,
            };
        chunk.iter().map(extent).collect::<Vec<BrushExtent>>()
    });
    let extents = parts.concat();
    let bounds: Vec<Option<Bounds>> = extents.iter().map(|extent| extent.bounds().copied()).collect();
    renumber_planes(&mut table, &mut planes, &bounds);
    BrushExtents { table, planes, extents, signs }
}

impl BrushExtent {
    /// The box around a bounded body.
    pub(crate) fn bounds(&self) -> Option<&Bounds> {
        match self {
            Self::Bounded { bounds, .. } => Some(bounds),
            Self::Empty | Self::Unbounded => None,
        }
    }
}

/// Number of brushes in a chunk; each chunk has a polytope of its own, which is worth the while from some planes on.
pub(super) fn least_of_chunk<B: Borrow<Brush>>(brushes: &[B]) -> usize {
    let planes: usize = brushes.iter().map(|brush| brush.borrow().faces.len()).sum();
    PLANES_OF_CHUNK * brushes.len() / planes.max(1)
}

/// What a brush is, whose planes have ids in a table. It is not built again where that was done and the
/// table has taken none of the planes for another.
fn shape_of<'a>(
    table: &PlaneTable,
    built: &'a BuiltBodies,
    brush: &Brush,
    planes: &[PlaneId],
    builder: &mut ShapeBuilder,
) -> Cow<'a, BrushShape> {
    let stays = |(face, plane): (&BrushFace, &PlaneId)| {
        let row = Row::new(&face.half_space);
        row.coefficients() == table.row(*plane).coefficients() || row.is_same_plane(table.row(*plane))
    };
    // most tables took no plane for another
    let all_stay = || table.snapped() == 0 || brush.faces.iter().zip(planes).all(stays);
    match built.shape_of(&brush.faces).filter(|_| all_stay()) {
        Some(known) => Cow::Borrowed(known),
        None => Cow::Owned(shape_in_table(table, planes, builder)),
    }
}

fn shape_in_table(table: &PlaneTable, planes: &[PlaneId], builder: &mut ShapeBuilder) -> BrushShape {
    builder.shape(planes.len(), |k| table.row(planes[k]))
}

/// The body of a brush, whose planes have ids in a table.
pub(crate) fn built_or_build(
    table: &PlaneTable,
    built: &BuiltBodies,
    brush: &Brush,
    planes: &[PlaneId],
    builder: &mut ShapeBuilder,
) -> BrushBody {
    shape_of(table, built, brush, planes, builder).body(planes, |k| brush.faces[k].material)
}

/// The body that planes bound, each with the material of its face.
pub(crate) fn build(
    table: &PlaneTable,
    planes: &[PlaneId],
    materials: &[MaterialId],
    builder: &mut ShapeBuilder,
) -> BrushBody {
    shape_in_table(table, planes, builder).body(planes, |k| materials[k])
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
    let plane = |idx: PlaneIdx| table.row(planes[place_of(idx)]);
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
