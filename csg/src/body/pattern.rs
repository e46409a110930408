//! Bodies of which only the distances of the planes differ from those of one that is known: copies in arrays, boxes of any size.
//!
//! A polytope whose corners all lie on three planes keeps its structure as long as no edge loses its length: polytopes with the same
//! normals and the same edges, all of positive length, have the same faces, edges and corners (McMullen, "Representations of polytopes and
//! polyhedral sets", 1973: the inside of a type cone). The length of an edge is positive where its one end lies within the plane that ends it at
//! the other. So one sign for each edge, instead of adding plane after plane, tells that a structure stays; where it does not, the
//! body is built.

use std::sync::{Arc, OnceLock};

use planecut_kernel::PlaneIdx;
use planecut_kernel::sign::{Homogeneous, Row, Sign};

use super::shape::{Corners, Structure};
use super::{Corner, Shape};
use crate::ids::{CornerId, Id};

/// The structure of a body with three planes at every corner.
#[derive(Debug)]
struct SimpleStructure {
    structure: Arc<Structure>,
    numbers: Vec<CornerId>,
    /// Where the edges of each face end.
    ends: Vec<u32>,
    /// The planes of each corner, right-handed.
    corners: Vec<[PlaneIdx; 3]>,
    /// For each edge the corner at its beginning, and the plane at its end.
    lengths: Vec<(CornerId, PlaneIdx)>,
}

/// A shape that was built, to make others like it.
#[derive(Debug, Default)]
pub(super) struct Pattern {
    /// The normals of its planes.
    normals: Vec<[f64; 3]>,
    shape: Option<Shape>,
    /// Its structure, read when a second shape has the same normals.
    structure: OnceLock<Option<SimpleStructure>>,
}

impl Pattern {
    /// The shape that is the pattern.
    pub(super) fn last(&self) -> Option<&Shape> {
        self.shape.as_ref()
    }

    /// Makes a shape the pattern; `plane` gives the coefficients of its planes, of which there are `count`.
    pub(super) fn set<'a>(&mut self, shape: &Shape, count: usize, plane: impl Fn(usize) -> &'a Row) {
        self.normals.clear();
        self.normals.extend((0..count).map(|k| normal(plane(k))));
        self.shape = Some(shape.clone());
        self.structure.take();
    }

    /// What some planes bound, where it has the normals and the structure of the pattern.
    pub(super) fn shape<'a>(&self, count: usize, plane: impl Fn(usize) -> &'a Row) -> Option<Shape> {
        if count != self.normals.len() || (0..count).any(|k| normal(plane(k)) != self.normals[k]) {
            return None;
        }
        let shape = self.shape.as_ref()?;
        self.structure.get_or_init(|| SimpleStructure::of(shape, count)).as_ref()?.shape(plane)
    }
}

fn meet([a, b, c]: [&Row; 3]) -> Homogeneous {
    Homogeneous::meet(a, b, c)
}

/// The normal of a plane.
fn normal(row: &Row) -> [f64; 3] {
    let [x, y, z, _] = *row.coefficients();
    [x, y, z]
}

impl SimpleStructure {
    /// That of a shape of some planes; nothing where one of them has no face or more than three meet in a corner.
    fn of(shape: &Shape, count: usize) -> Option<Self> {
        let Corners { different, numbers, structure, .. } = &*shape.corners;
        let Structure { edges, planes } = &**structure;
        // a corner that several faces share by one number is shared by three; Euler's formula tells that none is named twice
        let is_simple = numbers.len() == 3 * different.len() && different.len() + planes.len() == numbers.len() / 2 + 2;
        if !is_simple || planes.len() != count {
            return None;
        }
        let (mut corners, mut lengths) = (Vec::with_capacity(different.len()), Vec::with_capacity(numbers.len() / 2));
        for (face, own) in shape.faces.iter().zip(planes) {
            let range = face.start as usize..face.end as usize;
            let (numbers, edges) = (&numbers[range.clone()], &edges[range]);
            for k in 0..edges.len() {
                let next = (k + 1) % edges.len();
                if numbers[k].index() == corners.len() {
                    corners.push([*own, edges[k], edges[next]]);
                }
                // the edge on the next plane begins here
                if *own < edges[next] {
                    lengths.push((numbers[k], edges[(next + 1) % edges.len()]));
                }
            }
        }
        Some(Self {
            structure: Arc::clone(structure),
            numbers: numbers.clone(),
            ends: shape.faces.iter().map(|face| face.end).collect(),
            corners,
            lengths,
        })
    }

    /// What planes with the same normals bound, where it has this structure.
    fn shape<'a>(&self, plane: impl Fn(usize) -> &'a Row) -> Option<Shape> {
        let row = |idx: &PlaneIdx| plane(idx.0);
        let points: Vec<Homogeneous> = self.corners.iter().map(|planes| meet(planes.each_ref().map(row))).collect();
        let is_long = |(corner, end): &(CornerId, PlaneIdx)| {
            let planes = self.corners[corner.index()].each_ref().map(row);
            points[corner.index()].side_of(planes, row(end)) == Sign::Negative
        };
        if !self.lengths.iter().all(is_long) {
            return None;
        }
        let different = points.iter().map(Corner::new).collect();
        let corners = Corners::new(different, self.numbers.clone(), Arc::clone(&self.structure));
        Some(Shape::measured(&self.ends, corners, |idx| plane(idx.0)))
    }
}

#[cfg(test)]
mod tests {
    use super::super::built::{BrushShape, ShapeBuilder, shape_of_planes};
    use super::*;
    use planecut_kernel::{DVec3, HalfSpace, IncrementalPolytope};

    fn planes(normals: &[DVec3], offsets: &[f64]) -> Vec<Row> {
        let plane = |(normal, offset): (&DVec3, &f64)| Row::new(&HalfSpace::new(*normal, *offset).expect("a plane"));
        normals.iter().zip(offsets).map(plane).collect()
    }

    /// All that a shape says.
    fn told(shape: &BrushShape) -> String {
        match shape {
            BrushShape::Bounded(Shape { faces, corners, bounds, volume }) => {
                let Corners { different, numbers, structure, .. } = &**corners;
                format!("{faces:?} {different:?} {numbers:?} {structure:?} {bounds:?} {volume:?}")
            }
            other => format!("{other:?}"),
        }
    }

    /// Compares what one builder makes of planes that move, one after another, with what is built from nothing; gives how often the structure
    /// stayed, and how often it changed.
    fn compare(normals: &[DVec3], random: &mut impl FnMut() -> f64) -> (usize, usize) {
        let mut builder = ShapeBuilder::default();
        let (mut stayed, mut changed) = (0, 0);
        for step in 0..200 {
            // short numbers, so that corners of more than three planes are frequent
            let offsets: Vec<f64> = normals.iter().map(|_| 4.0 + (random() * 3.0).floor()).collect();
            let planes = planes(normals, &offsets);
            let plane = |k: usize| &planes[k];
            let made = builder.pattern_for_tests().shape(planes.len(), plane);
            let fresh = shape_of_planes(planes.len(), plane, &mut IncrementalPolytope::with_epsilon(0.0));
            if let Some(made) = made {
                stayed += 1;
                assert_eq!(told(&BrushShape::Bounded(made)), told(&fresh), "step {step}: {normals:?} {offsets:?}");
            } else {
                changed += 1;
            }
            assert_eq!(told(&builder.shape(planes.len(), plane)), told(&fresh), "step {step}: {normals:?} {offsets:?}");
        }
        (stayed, changed)
    }

    #[test]
    fn shapes_of_moved_planes_are_those_that_are_built() {
        let mut state = 1_u64;
        let mut random = move || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 40) as f64 / f64::from(1 << 24)
        };
        let cube: Vec<DVec3> = DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]).collect();
        assert_eq!(compare(&cube, &mut random), (199, 1));
        let (mut stayed, mut changed) = (0, 0);
        for _ in 0..40 {
            let mut normals = cube.clone();
            for _ in 0..3 {
                let normal = DVec3::new(random() - 0.5, random() - 0.5, random() - 0.5);
                normals.push((normal * 8.0).round() + DVec3::X * 0.25);
            }
            let (s, c) = compare(&normals, &mut random);
            (stayed, changed) = (stayed + s, changed + c);
        }
        assert!(stayed > 100 && changed > 100, "{stayed} stayed, {changed} changed");
    }
}
