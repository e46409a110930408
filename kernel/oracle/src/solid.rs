//! The vertices, edges and faces of a bounded polytope with interior, as they are: not perturbed, exact.

use std::collections::BTreeSet;

use dashu_int::IBig;
use dashu_ratio::RBig;

use crate::exact::{Coefficients, cross, det3, integer_row, normal, sign};

/// A vertex with all planes that pass through it.
#[derive(Debug, Clone)]
pub struct Vertex {
    /// Where it is.
    pub position: [RBig; 3],
    /// The planes through it, ascending.
    pub planes: Vec<usize>,
}

/// A face of positive area; of equal planes only the oldest owns it.
#[derive(Debug, Clone)]
pub struct Facet {
    /// Its plane.
    pub plane: usize,
    /// Indices of its vertices, in no particular order.
    pub vertices: BTreeSet<usize>,
}

/// A bounded polytope with interior.
#[derive(Debug, Clone)]
pub struct Solid {
    /// The vertices.
    pub vertices: Vec<Vertex>,
    /// The faces.
    pub facets: Vec<Facet>,
    /// Pairs of vertices, the smaller index first.
    pub edges: BTreeSet<[usize; 2]>,
}

impl Solid {
    /// Tries all triples of planes. The caller knows that the set is bounded and has interior.
    ///
    /// # Panics
    /// Where they break Euler's formula.
    #[must_use]
    pub fn of(planes: &[Coefficients]) -> Self {
        let rows: Vec<[IBig; 4]> = planes.iter().map(|&p| integer_row(p)).collect();
        let normals: Vec<[IBig; 3]> = rows.iter().map(normal).collect();
        let vertices = vertices(&rows, &normals);
        let facets = facets(planes.len(), &vertices);
        let edges = edges(&normals, &vertices);
        assert_eq!(vertices.len() + facets.len(), edges.len() + 2, "the oracle breaks Euler's formula: {planes:?}");
        Self { vertices, facets, edges }
    }

    /// Sign of the turn `p → q → r` about the outward `normal`: 1 is counter-clockwise.
    #[must_use]
    pub fn turn(&self, outward: &[IBig; 3], [p, q, r]: [usize; 3]) -> i32 {
        let side = |a: usize, b: usize| -> [RBig; 3] {
            std::array::from_fn(|i| &self.vertices[b].position[i] - &self.vertices[a].position[i])
        };
        let (u, v) = (side(p, q), side(q, r));
        let turn = (0..3).fold(RBig::ZERO, |sum, i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            sum + (&u[j] * &v[k] - &u[k] * &v[j]) * RBig::from(outward[i].clone())
        });
        sign(turn.numerator())
    }
}

/// Meeting points of three planes that violate no plane. Two of them are equal exactly when the same planes pass through both.
fn vertices(rows: &[[IBig; 4]], normals: &[[IBig; 3]]) -> Vec<Vertex> {
    let n = rows.len();
    let mut found: Vec<Vertex> = Vec::new();
    for i in 0..n {
        for j in i + 1..n {
            for k in j + 1..n {
                let Some((point, w)) = meet([&rows[i], &rows[j], &rows[k]]) else { continue };
                let sides: Vec<i32> =
                    (0..n).map(|h| sign(&(crate::exact::dot(&normals[h], &point) - &rows[h][3] * &w))).collect();
                if sides.iter().any(|&s| s > 0) {
                    continue;
                }
                let planes: Vec<usize> = (0..n).filter(|&h| sides[h] == 0).collect();
                if found.iter().all(|v| v.planes != planes) {
                    let position = point.map(|c| RBig::from(c) / RBig::from(w.clone()));
                    found.push(Vertex { position, planes });
                }
            }
        }
    }
    found
}

/// Homogeneous `(X, Y, Z), W` with `W > 0` by Cramer's rule.
fn meet(rows: [&[IBig; 4]; 3]) -> Option<([IBig; 3], IBig)> {
    let [a, b, c] = rows.map(normal);
    let w = det3(&a, &b, &c);
    let orientation = sign(&w);
    if orientation == 0 {
        return None;
    }
    let (bc, ca, ab) = (cross(&b, &c), cross(&c, &a), cross(&a, &b));
    let point: [IBig; 3] =
        std::array::from_fn(|i| (&rows[0][3] * &bc[i] + &rows[1][3] * &ca[i] + &rows[2][3] * &ab[i]) * orientation);
    Some((point, w * orientation))
}

/// Vertices of a polytope are extreme points, so three of them are never collinear: three make a face.
fn facets(planes: usize, vertices: &[Vertex]) -> Vec<Facet> {
    let mut found: Vec<Facet> = Vec::new();
    for plane in 0..planes {
        let on: BTreeSet<usize> = (0..vertices.len()).filter(|&v| vertices[v].planes.contains(&plane)).collect();
        if on.len() >= 3 && found.iter().all(|f| f.vertices != on) {
            found.push(Facet { plane, vertices: on });
        }
    }
    found
}

/// Two vertices are joined when the planes through both meet in a line.
fn edges(normals: &[[IBig; 3]], vertices: &[Vertex]) -> BTreeSet<[usize; 2]> {
    let mut found = BTreeSet::new();
    for q in 0..vertices.len() {
        for p in 0..q {
            let common: Vec<usize> =
                vertices[p].planes.iter().copied().filter(|h| vertices[q].planes.contains(h)).collect();
            let independent = |&h: &usize| cross(&normals[common[0]], &normals[h]).iter().any(|c| !c.is_zero());
            if common.iter().any(independent) {
                found.insert([p, q]);
            }
        }
    }
    found
}

#[test]
fn a_pyramid_with_a_touching_plane() {
    // Four sides through the apex (0, 0, 1) and a horizontal plane that touches it.
    let side = |x: f64, y: f64| [x, y, 1.0, 1.0];
    let planes =
        [side(1.0, 0.0), side(-1.0, 0.0), side(0.0, 1.0), side(0.0, -1.0), [0.0, 0.0, -1.0, 0.0], [0.0, 0.0, 1.0, 1.0]];
    let solid = Solid::of(&planes);
    assert_eq!((solid.vertices.len(), solid.edges.len(), solid.facets.len()), (5, 8, 5));
    let apex = solid.vertices.iter().find(|v| v.planes.len() == 5).expect("the apex");
    assert_eq!(apex.position, [RBig::ZERO, RBig::ZERO, RBig::ONE]);
}
