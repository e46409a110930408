//! Bodies that were built ahead.

use std::hash::Hasher;
use std::sync::Arc;

use planecut_kernel::sign::Row;
use planecut_kernel::{HalfSpace, IncrementalPolytope, PlaneIdx};
use rustc_hash::{FxHashMap, FxHasher};

use super::Shape;
use super::build::least_of_chunk;
use super::pattern::Pattern;
use crate::base::map_chunks;
use crate::model::{Brush, BrushFace};

/// What a brush is, in numbers of its own.
#[derive(Debug, Clone)]
pub(super) enum BrushShape {
    Bounded(Shape),
    Empty,
    Unbounded,
}

/// The half-spaces of a brush, and what it is.
type BuiltBody = (Vec<HalfSpace>, BrushShape);

/// Bodies of brushes that were built ahead, to be found by the half-spaces of a brush in their order: what is given them builds only the
/// bodies that are not among them. Outcomes are the same with and without. They take memory, some 150 bytes for each face; clones share
/// it.
///
/// ```
/// use planecut_csg::{Brush, BuiltBodies, Material, MaterialId, Model, Tree, UnboundedBrushes, evaluate_built};
/// use planecut_kernel::DVec3;
///
/// # fn main() -> Result<(), planecut_csg::EvaluateError> {
/// let block = Brush::cuboid(DVec3::ZERO, DVec3::splat(2.0), MaterialId(0));
/// let tool = Brush::cuboid(DVec3::ONE, DVec3::splat(3.0), MaterialId(0));
/// let bodies = BuiltBodies::of([&block, &tool]);
/// let cut = Model { materials: vec![Material::named("steel")], tree: Tree::from(block) - tool.into() };
/// assert_eq!(evaluate_built(&cut, UnboundedBrushes::Keep, &bodies)?.solid.volume, 7.0);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Default)]
pub struct BuiltBodies(Arc<FxHashMap<u64, Vec<BuiltBody>>>);

impl BuiltBodies {
    /// Builds the bodies of brushes, in parallel.
    #[must_use]
    pub fn of<'a>(brushes: impl IntoIterator<Item = &'a Brush>) -> Self {
        let brushes: Vec<&Brush> = brushes.into_iter().collect();
        let (parts, _) = map_chunks(&brushes, least_of_chunk(&brushes), |chunk| {
            let mut builder = ShapeBuilder::default();
            chunk.iter().map(|brush| ahead(brush, &mut builder)).collect::<Vec<BuiltBody>>()
        });
        let mut bodies: FxHashMap<u64, Vec<BuiltBody>> = FxHashMap::default();
        for (brush, built) in brushes.iter().zip(parts.into_iter().flatten()) {
            // mostly there is one, and room for more is not kept
            let alike = bodies.entry(key(&brush.faces)).or_insert_with(|| Vec::with_capacity(1));
            if shape_among(alike, &brush.faces).is_none() {
                alike.push(built);
            }
        }
        Self(Arc::new(bodies))
    }

    /// How many different bodies there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.0.values().map(Vec::len).sum()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// What the brush of some faces is, where that is known.
    pub(super) fn shape_of(&self, faces: &[BrushFace]) -> Option<&BrushShape> {
        if self.is_empty() { None } else { shape_among(self.0.get(&key(faces))?, faces) }
    }
}

impl std::fmt::Debug for BuiltBodies {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} bodies", self.len())
    }
}

/// A number that depends on the half-spaces of faces alone.
fn key(faces: &[BrushFace]) -> u64 {
    let mut hasher = FxHasher::default();
    for face in faces {
        let [x, y, z] = face.half_space.normal().to_array();
        [x, y, z, face.half_space.offset()].iter().for_each(|v| hasher.write_u64(v.to_bits()));
    }
    hasher.finish()
}

fn shape_among<'a>(bodies: &'a [BuiltBody], faces: &[BrushFace]) -> Option<&'a BrushShape> {
    let is_same = |half_spaces: &[HalfSpace]| half_spaces.iter().eq(faces.iter().map(|face| &face.half_space));
    bodies.iter().find(|(half_spaces, _)| is_same(half_spaces)).map(|(_, shape)| shape)
}

fn ahead(brush: &Brush, builder: &mut ShapeBuilder) -> BuiltBody {
    let half_spaces: Vec<HalfSpace> = brush.faces.iter().map(|face| face.half_space).collect();
    let planes: Vec<Row> = half_spaces.iter().map(Row::new).collect();
    let shape = builder.shape(planes.len(), |k| &planes[k]);
    (half_spaces, shape)
}

/// Builds one shape after another; shapes do not depend on those before them.
#[derive(Debug)]
pub(crate) struct ShapeBuilder {
    polytope: IncrementalPolytope,
    /// The last shape that was built.
    pattern: Pattern,
}

impl Default for ShapeBuilder {
    fn default() -> Self {
        Self { polytope: IncrementalPolytope::with_epsilon(0.0), pattern: Pattern::default() }
    }
}

impl ShapeBuilder {
    /// What the next shape is compared with.
    #[cfg(test)]
    pub(super) fn pattern_for_tests(&self) -> &Pattern {
        &self.pattern
    }

    /// What planes bound, of each of which the coefficients are given.
    pub(super) fn shape<'a>(&mut self, count: usize, plane: impl Fn(usize) -> &'a Row) -> BrushShape {
        if let Some(shape) = self.pattern.shape(count, &plane) {
            return BrushShape::Bounded(shape);
        }
        let mut shape = shape_of_planes(count, &plane, &mut self.polytope);
        if let BrushShape::Bounded(shape) = &mut shape {
            if let Some(last) = self.pattern.last() {
                shape.share_structure(last);
            }
            self.pattern.set(shape, count, plane);
        }
        shape
    }
}

/// What planes bound, of each of which the coefficients are given; `polytope` is a buffer.
pub(super) fn shape_of_planes<'a>(
    count: usize,
    plane: impl Fn(usize) -> &'a Row,
    polytope: &mut IncrementalPolytope,
) -> BrushShape {
    polytope.clear();
    for k in 0..count {
        polytope.add_plane(*plane(k).half_space());
    }
    shape_of_polytope(polytope, |idx| plane(idx.0))
}

/// What a polytope is, whose planes have these coefficients.
pub(super) fn shape_of_polytope<'a>(polytope: &IncrementalPolytope, plane: impl Fn(PlaneIdx) -> &'a Row) -> BrushShape {
    if polytope.is_empty() {
        return BrushShape::Empty;
    }
    let shape = if polytope.is_bounded() { Shape::of(polytope, plane) } else { None };
    shape.map_or(BrushShape::Unbounded, BrushShape::Bounded)
}
