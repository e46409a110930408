//! What a brush keeps once its body is built.

use std::sync::Arc;

use planecut_kernel::sign::Row;
use planecut_kernel::{HalfSpace, IncrementalPolytope, PlaneIdx};

use super::Shape;
use super::build::least_of_chunk;
use crate::base::map_chunks;
use crate::model::{Brush, BrushFace};
use crate::plane_table::half_space_of;

/// What a brush is, in numbers of its own.
#[derive(Debug, Clone)]
pub(super) enum BrushShape {
    Bounded(Shape),
    Empty,
    Unbounded,
}

/// The body of a brush, where it was built: evaluations start from it, and clones of the brush share it. Nothing tells brushes
/// apart by it. Where faces are changed it is passed over until it is built again.
#[derive(Clone, Default)]
pub struct Built(Option<Arc<(Vec<HalfSpace>, BrushShape)>>);

impl Built {
    /// What the brush of some faces is, where that is known.
    pub(super) fn shape_of(&self, faces: &[BrushFace]) -> Option<&BrushShape> {
        let (half_spaces, shape) = self.0.as_deref()?;
        let is_same = half_spaces.len() == faces.len()
            && half_spaces.iter().zip(faces).all(|(half_space, face)| *half_space == face.half_space);
        is_same.then_some(shape)
    }
}

impl std::fmt::Debug for Built {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(if self.0.is_some() { "built" } else { "not built" })
    }
}

impl PartialEq for Built {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// Builds the bodies of brushes that have none, in parallel.
pub(crate) fn build_ahead(brushes: &mut [Brush]) {
    let (parts, _) = map_chunks(brushes, least_of_chunk(brushes), |chunk| {
        let mut polytope = IncrementalPolytope::with_epsilon(0.0);
        chunk.iter().map(|brush| ahead(brush, &mut polytope)).collect::<Vec<Built>>()
    });
    for (brush, built) in brushes.iter_mut().zip(parts.into_iter().flatten()) {
        brush.built = built;
    }
}

fn ahead(brush: &Brush, polytope: &mut IncrementalPolytope) -> Built {
    if brush.built.shape_of(&brush.faces).is_some() {
        return brush.built.clone();
    }
    let half_spaces: Vec<HalfSpace> = brush.faces.iter().map(|face| face.half_space).collect();
    // as a table has them
    let in_table = |half_space: &HalfSpace| {
        let row = Row::new(half_space);
        (row, half_space_of(&row))
    };
    let planes: Vec<(Row, HalfSpace)> = half_spaces.iter().map(in_table).collect();
    let shape = shape_of_planes(planes.len(), |k| (&planes[k].0, &planes[k].1), polytope);
    Built(Some(Arc::new((half_spaces, shape))))
}

/// What planes bound: the coefficients of each, exact ones and the same as a half-space; `polytope` is a buffer.
pub(super) fn shape_of_planes<'a>(
    count: usize,
    plane: impl Fn(usize) -> (&'a Row, &'a HalfSpace),
    polytope: &mut IncrementalPolytope,
) -> BrushShape {
    polytope.clear();
    for k in 0..count {
        polytope.add_plane(*plane(k).1);
    }
    shape_of_polytope(polytope, |idx| plane(idx.0))
}

/// What a polytope is, whose planes have these coefficients.
pub(super) fn shape_of_polytope<'a>(
    polytope: &IncrementalPolytope,
    plane: impl Fn(PlaneIdx) -> (&'a Row, &'a HalfSpace),
) -> BrushShape {
    if polytope.is_empty() {
        return BrushShape::Empty;
    }
    let shape = if polytope.is_bounded() { Shape::of(polytope, plane) } else { None };
    shape.map_or(BrushShape::Unbounded, BrushShape::Bounded)
}
