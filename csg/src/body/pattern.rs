//! Bodies of which only the distances of the planes differ from those of one that is known: copies in arrays, boxes of any size.
//!
//! A polytope whose corners all lie on three planes keeps its structure as long as no edge loses its length: polytopes with the same
//! normals and the same edges, all of positive length, have the same faces, edges and corners (McMullen, "Representations of polytopes and
//! polyhedral sets", 1973: the inside of a type cone). The length of an edge is positive where its one end lies within the plane that ends it at
//! the other. So one sign for each edge, instead of adding plane after plane, tells that a structure stays; where it does not, the
//! body is built.

use std::sync::OnceLock;

use planecut_kernel::sign::{Row, Sign};
use planecut_kernel::{HalfSpace, PlaneIdx};

use super::Shape;
use super::shape::Corners;
use crate::ids::{CornerId, Id};

/// The structure of a body with three planes at every corner.
#[derive(Debug)]
struct Structure {
    numbers: Vec<CornerId>,
    edges: Vec<PlaneIdx>,
    planes: Vec<PlaneIdx>,
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
    structure: OnceLock<Option<Structure>>,
}

impl Pattern {
    /// Makes a shape the pattern; `plane` gives the coefficients of its planes, of which there are `count`.
    pub(super) fn set<'a>(&mut self, shape: &Shape, count: usize, plane: impl Fn(usize) -> (&'a Row, &'a HalfSpace)) {
        self.normals.clear();
        self.normals.extend((0..count).map(|k| normal(plane(k).0)));
        self.shape = Some(shape.clone());
        self.structure.take();
    }

    /// What some planes bound, where it has the normals and the structure of the pattern.
    pub(super) fn shape<'a>(&self, count: usize, plane: impl Fn(usize) -> (&'a Row, &'a HalfSpace)) -> Option<Shape> {
        if count != self.normals.len() || (0..count).any(|k| normal(plane(k).0) != self.normals[k]) {
            return None;
        }
        let shape = self.shape.as_ref()?;
        self.structure.get_or_init(|| Structure::of(shape, count)).as_ref()?.shape(plane)
    }
}

/// The normal of a plane.
fn normal(row: &Row) -> [f64; 3] {
    let [x, y, z, _] = *row.coefficients();
    [x, y, z]
}

impl Structure {
    /// That of a shape of some planes; nothing where one of them has no face or more than three meet in a corner.
    fn of(shape: &Shape, count: usize) -> Option<Self> {
        let Corners { different, numbers, edges, planes, .. } = &*shape.corners;
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
            numbers: numbers.clone(),
            edges: edges.clone(),
            planes: planes.clone(),
            ends: shape.faces.iter().map(|face| face.end).collect(),
            corners,
            lengths,
        })
    }

    /// What planes with the same normals bound, where it has this structure.
    fn shape<'a>(&self, plane: impl Fn(usize) -> (&'a Row, &'a HalfSpace)) -> Option<Shape> {
        let row = |idx: &PlaneIdx| plane(idx.0).0;
        let mut corners = Corners { different: Vec::with_capacity(self.corners.len()), ..Corners::default() };
        for planes in &self.corners {
            corners.add(planes.each_ref().map(row));
        }
        let is_long = |(corner, end): &(CornerId, PlaneIdx)| {
            let planes = self.corners[corner.index()].each_ref().map(row);
            corners.different[corner.index()].point.side_of(planes, row(end)) == Sign::Negative
        };
        if !self.lengths.iter().all(is_long) {
            return None;
        }
        corners.numbers.clone_from(&self.numbers);
        corners.edges.clone_from(&self.edges);
        corners.planes.clone_from(&self.planes);
        Some(Shape::measured(&self.ends, corners, |idx| plane(idx.0)))
    }
}
