//! What a set of half-spaces is, not perturbed: decided over all triples of planes, a filter first.
//!
//! A set with rank 3 is the convex hull of its vertices plus the cone of its extreme directions (Minkowski–Weyl), so
//! all answers follow from which planes pass through which vertex and hold which direction. A set of lower rank is a
//! prism without ends; it gets ends first.

mod filter;

use std::collections::BTreeMap;

use dashu_int::IBig;
use dashu_ratio::RBig;

use crate::exact::{Coefficients, cross, integer_row, normal};
use filter::Rows;

/// What a list of half-spaces bounds. All of it exact but for the rounding of the positions.
#[derive(Debug, Clone, PartialEq)]
pub struct Outline {
    /// The set has no interior. The rest is then as for a bounded set without vertices, edges and faces.
    pub empty: bool,
    /// Empty, or no direction in which the set goes on for ever.
    pub bounded: bool,
    /// The distinct vertices.
    pub vertices: Vec<Corner>,
    /// Segments, rays and lines.
    pub edges: usize,
    /// Faces of positive area; of equal planes one counts.
    pub faces: usize,
}

/// A finite vertex.
#[derive(Debug, Clone, PartialEq)]
pub struct Corner {
    /// Each coordinate correctly rounded.
    pub position: [f64; 3],
    /// All planes through it, by their index in the list, ascending; those that only touch included.
    pub planes: Vec<usize>,
}

impl Outline {
    /// Decides everything about `planes`. O(n³) filtered signs where planes are in general position, O(n⁴) at worst.
    ///
    /// # Panics
    /// Where a coefficient is not finite or a normal is zero.
    #[must_use]
    pub fn of(planes: &[Coefficients]) -> Self {
        let exact: Vec<[IBig; 4]> = planes.iter().map(|&plane| integer_row(plane)).collect();
        assert!(exact.iter().all(|row| row[..3].iter().any(|c| !c.is_zero())), "a normal is zero: {planes:?}");
        Self::of_rows(exact)
    }

    fn of_rows(exact: Vec<[IBig; 4]>) -> Self {
        let rows = Rows::new(exact);
        let Some(vertices) = rows.vertices() else { return Self::of_prism(rows.exact) };
        let directions = rows.directions();
        let bounded = directions.is_empty();
        let on = |h: &usize| {
            let through = vertices.keys().filter(|planes| planes.binary_search(h).is_ok()).count();
            through + directions.iter().filter(|planes| planes.binary_search(h).is_ok()).count()
        };
        let all = vertices.len() + directions.len();
        if vertices.is_empty() || (0..rows.len()).any(|h| on(&h) == all) {
            return Self::empty();
        }
        let mut faces: Vec<Vec<bool>> = Vec::new();
        for h in 0..rows.len() {
            let holds = |planes: &Vec<usize>| planes.binary_search(&h).is_ok();
            // a polygon has three vertices or more, each direction in which it goes on standing for one
            if vertices.keys().any(holds) && on(&h) >= 3 {
                faces.push(vertices.keys().chain(&directions).map(holds).collect());
            }
        }
        faces.sort_unstable();
        faces.dedup();
        // Euler's formula; an open surface lacks the point at infinity
        let edges = vertices.len() + faces.len() - if bounded { 2 } else { 1 };
        let vertices =
            vertices.into_iter().map(|(planes, point)| Corner { position: rounded(point), planes }).collect();
        Self { empty: false, bounded, vertices, edges, faces: faces.len() }
    }

    fn empty() -> Self {
        Self { empty: true, bounded: true, vertices: Vec::new(), edges: 0, faces: 0 }
    }

    /// Normals of rank below 3: the set is a prism without ends. With ends it has a vertex at either end of each line.
    fn of_prism(mut exact: Vec<[IBig; 4]>) -> Self {
        let Some(first) = exact.first().map(normal) else {
            return Self { empty: false, bounded: false, vertices: Vec::new(), edges: 0, faces: 0 };
        };
        let across = exact.iter().map(|row| cross(&first, &normal(row))).find(is_non_zero);
        let rank = if across.is_some() { 2 } else { 1 };
        let free = across.map_or_else(|| plane_basis(&first), |u| vec![u]);
        for u in &free {
            for factor in [1, -1] {
                let [x, y, z] = u.clone().map(|c| c * factor);
                exact.push([x, y, z, IBig::ONE]);
            }
        }
        let closed = Self::of_rows(exact);
        if closed.empty {
            return closed;
        }
        let edges = if rank == 2 { closed.vertices.len() / 2 } else { 0 };
        let faces = closed.faces - 2 * free.len();
        Self { empty: false, bounded: false, vertices: Vec::new(), edges, faces }
    }
}

fn is_non_zero(u: &[IBig; 3]) -> bool {
    u.iter().any(|c| !c.is_zero())
}

/// Two independent vectors across `n`.
fn plane_basis(n: &[IBig; 3]) -> Vec<[IBig; 3]> {
    let axes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map(|axis| axis.map(IBig::from));
    let u = axes.iter().map(|axis| cross(n, axis)).find(is_non_zero).expect("the normal is not zero");
    let v = cross(n, &u);
    vec![u, v]
}

fn rounded(([x, y, z], w): ([IBig; 3], IBig)) -> [f64; 3] {
    [x, y, z].map(|c| (RBig::from(c) / RBig::from(w.clone())).to_f64().value())
}

/// The homogeneous point `(X, Y, Z), W` with `W > 0` of each vertex, by the planes through it.
type Points = BTreeMap<Vec<usize>, ([IBig; 3], IBig)>;

#[cfg(test)]
mod tests;
