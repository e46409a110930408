//! From the planes of brushes to their bodies, all at once and in parallel.

use std::borrow::{Borrow, Cow};

use planecut_kernel::sign::{Counts, Row};
use planecut_kernel::{HalfSpace, IncrementalPolytope, PlaneIdx};
use planecut_parallel::prelude::*;
use smallvec::SmallVec;

use super::built::{self, BrushShape, BuiltBodies, ShapeBuilder};
use super::{Body, BrushBody, Shape};
use crate::base::{Bounds, hash_of, intern, map_fixed_chunks, starts_of};
use crate::ids::number32;
use crate::model::{Brush, BrushFace, MaterialId};
use crate::plane_table::{InternedPlanes, PlaneId, PlaneTable, in_order_of_space, smallest_size};

/// Least number of planes, about, of bodies that are built in a row.
const PLANES_OF_CHUNK: usize = 100;

/// Number of planes, about, of which some may be the same.
const PLANES_OF_GROUP: usize = 4;

/// Least number of planes of brushes that a thread numbers in a row.
const IDS_OF_CHUNK: usize = 1 << 12;

/// The planes of brushes, one after another.
#[derive(Default)]
pub(crate) struct BrushPlanes {
    /// Where those of each brush begin, and where the last ones end.
    starts: Vec<usize>,
    ids: Vec<PlaneId>,
}

impl BrushPlanes {
    fn new(brushes: &[Brush], ids: Vec<PlaneId>) -> Self {
        Self { starts: starts_of(lengths(brushes)), ids }
    }

    /// The planes of a brush, in its order.
    pub(crate) fn of(&self, brush: usize) -> &[PlaneId] {
        &self.ids[self.starts[brush]..self.starts[brush + 1]]
    }
}

/// How many planes each brush has.
fn lengths(brushes: &[Brush]) -> impl Iterator<Item = usize> {
    brushes.iter().map(|brush| brush.faces.len())
}

/// The bodies of the brushes of a model.
pub(crate) struct BrushBodies {
    pub(crate) table: PlaneTable,
    pub(crate) planes: BrushPlanes,
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
    let half_space = |brush: usize, k: usize| &brushes[brush].faces[k].half_space;
    let (interned, ids) = InternedPlanes::of(lengths(brushes), half_space, size);
    let mut planes = BrushPlanes::new(brushes, ids);
    let (shapes, signs) = of_shapes(brushes, &planes, &interned, built, |_, shape| shape);
    let order = in_order_of_space(interned.len(), brushes.len(), |k| shapes[k].bounds(), |k| planes.of(k));
    let table = interned.into_table(&order, &mut planes.ids);
    let body = |(number, shape): (usize, Cow<'_, BrushShape>)| {
        shape.body(planes.of(number), |k| brushes[number].faces[k].material)
    };
    let bodies = shapes.into_par_iter().enumerate().with_min_len(64).map(body).collect();
    BrushBodies { table, planes, bodies, signs }
}

/// What is made of the shape of each brush and its number, in parallel.
fn of_shapes<'a, R: Send>(
    brushes: &[Brush],
    planes: &BrushPlanes,
    interned: &InternedPlanes,
    built: &'a BuiltBodies,
    make: impl Fn(usize, Cow<'a, BrushShape>) -> R + Sync,
) -> (Vec<R>, Counts) {
    let numbers: Vec<usize> = (0..brushes.len()).collect();
    let row = |plane: PlaneId| interned.row(plane);
    let (parts, signs) = map_fixed_chunks(&numbers, least_of_chunk(brushes), |chunk| {
        let mut builder = ShapeBuilder::default();
        let shape = |&number: &usize| {
            make(number, shape_of(row, interned.snapped(), built, &brushes[number], planes.of(number), &mut builder))
        };
        chunk.iter().map(shape).collect::<Vec<R>>()
    });
    (parts.into_iter().flatten().collect(), signs)
}

/// Interns the planes of brushes many of which have planes in common: what is the same in every bit is looked for first.
fn intern_repeated_planes(brushes: &[Brush], size: f64) -> (InternedPlanes, BrushPlanes) {
    let all: Vec<&HalfSpace> = brushes.iter().flat_map(Brush::half_spaces).collect();
    let bits = |place: usize| all[place].to_array().map(f64::to_bits);
    let groups = 1 + all.len() / PLANES_OF_GROUP;
    let group_of = |bits: &[u64; 4]| usize::try_from(hash_of(bits) % groups as u64).expect("less than their number");
    let (different, mut numbers) = intern(all.len(), bits, groups, group_of, number32);
    // in the order given, as brushes that are near each other mostly are in it
    let (mut places, mut in_order) = (Vec::with_capacity(different.len()), vec![u32::MAX; different.len()]);
    drop(different);
    for (place, number) in numbers.iter_mut().enumerate() {
        let in_order = &mut in_order[*number as usize];
        if *in_order == u32::MAX {
            *in_order = number32(places.len());
            places.push(place);
        }
        *number = *in_order;
    }
    let (interned, ids) = InternedPlanes::of(std::iter::once(places.len()), |_, k| all[places[k]], size);
    let of_brushes = numbers.par_iter().with_min_len(IDS_OF_CHUNK).map(|number| ids[*number as usize]);
    (interned, BrushPlanes::new(brushes, of_brushes.collect()))
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
    pub(crate) planes: BrushPlanes,
    pub(crate) extents: Vec<BrushExtent>,
    pub(crate) signs: Counts,
}

/// Interns the planes of brushes and tells what each is, without keeping the bodies: some kilobytes for each are a lot for a million of
/// them. They are built again, some of them at a time, by [`built_or_build`].
pub(crate) fn brush_extents(brushes: &[Brush], built: &BuiltBodies, size: f64) -> BrushExtents {
    let (interned, mut planes) = intern_repeated_planes(brushes, size);
    let extent = |number: usize, shape: Cow<'_, BrushShape>| match &*shape {
        BrushShape::Bounded(shape) => BrushExtent::Bounded {
            bounds: *shape.bounds(),
            volume: shape.volume,
            redundant: shape.without_face(brushes[number].faces.len()),
        },
        BrushShape::Empty => BrushExtent::Empty,
        BrushShape::Unbounded => BrushExtent::Unbounded,
    };
    let (extents, signs) = of_shapes(brushes, &planes, &interned, built, extent);
    let order = in_order_of_space(interned.len(), brushes.len(), |k| extents[k].bounds(), |k| planes.of(k));
    let table = interned.into_table(&order, &mut planes.ids);
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

/// What a brush is, whose planes have ids; `row` gives the coefficients of each. It is not built again where that was done and none of the planes was
/// taken for another one; `snapped` is the number of planes that were.
fn shape_of<'a>(
    row: impl Fn(PlaneId) -> Row,
    snapped: usize,
    built: &'a BuiltBodies,
    brush: &Brush,
    planes: &[PlaneId],
    builder: &mut ShapeBuilder,
) -> Cow<'a, BrushShape> {
    let stays = |(face, plane): (&BrushFace, &PlaneId)| {
        let (given, kept) = (Row::new(&face.half_space), row(*plane));
        given.coefficients() == kept.coefficients() || given.is_same_plane(&kept)
    };
    // most tables took no plane for another
    let all_stay = || snapped == 0 || brush.faces.iter().zip(planes).all(stays);
    match built.shape_of(&brush.faces).filter(|_| all_stay()) {
        Some(known) => Cow::Borrowed(known),
        None => Cow::Owned(shape_of_ids(row, planes, builder)),
    }
}

fn shape_of_ids(row: impl Fn(PlaneId) -> Row, planes: &[PlaneId], builder: &mut ShapeBuilder) -> BrushShape {
    let rows: SmallVec<[Row; 8]> = planes.iter().map(|plane| row(*plane)).collect();
    builder.shape(rows.len(), |k| &rows[k])
}

/// The body of a brush, whose planes have ids in a table.
pub(crate) fn built_or_build(
    table: &PlaneTable,
    built: &BuiltBodies,
    brush: &Brush,
    planes: &[PlaneId],
    builder: &mut ShapeBuilder,
) -> BrushBody {
    shape_of(|plane| *table.row(plane), table.snapped(), built, brush, planes, builder)
        .body(planes, |k| brush.faces[k].material)
}

/// The body that planes bound, each with the material of its face.
pub(crate) fn build(
    table: &PlaneTable,
    planes: &[PlaneId],
    materials: &[MaterialId],
    builder: &mut ShapeBuilder,
) -> BrushBody {
    shape_of_ids(|plane| *table.row(plane), planes, builder).body(planes, |k| materials[k])
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

#[cfg(test)]
mod tests {
    use planecut_kernel::DVec3;

    use super::*;

    /// What a body asks for depends on whether the one before it in its chunk is like it.
    #[test]
    fn the_number_of_threads_does_not_change_the_count_of_signs() {
        let of_size = |k: u32| Brush::cuboid(DVec3::ZERO, DVec3::new(1.0, 1.0 + f64::from(k), 2.0), MaterialId(0));
        let cut = |k: u32| {
            let mut brush = of_size(k);
            let half_space = HalfSpace::new(DVec3::ONE, 3.5 + f64::from(k)).expect("a valid plane");
            brush.faces.push(BrushFace { half_space, material: MaterialId(0) });
            brush
        };
        let brushes: Vec<Brush> = (0..150).map(|k| if k % 50 < 30 { of_size(k) } else { cut(k) }).collect();
        let counted = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool of threads");
            pool.install(|| build_bodies(&brushes).signs)
        };
        let one = counted(1);
        assert!([2, 3, 8].iter().all(|threads| counted(*threads) == one));
    }
}
