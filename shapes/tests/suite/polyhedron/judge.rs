//! What must hold of the cells of a surface.

use glam::DVec3;
use planecut_check::check_topology;
use planecut_csg::{Brush, Evaluation, Material, MaterialId, Model, Tree, evaluate};
use planecut_shapes::polyhedron::{Polyhedron, PolyhedronError, PolyhedronOptions, Precision, polyhedron};

use planecut_testkit::random::Rng;
use planecut_testkit::scene::ensure;

/// A surface of polygons.
#[derive(Debug, Clone, Default)]
pub(crate) struct Given {
    pub(crate) points: Vec<DVec3>,
    pub(crate) facets: Vec<Vec<u32>>,
}

impl Given {
    /// Convex facets as fans.
    pub(crate) fn triangles(&self) -> Vec<[DVec3; 3]> {
        let at = |v: u32| self.points[v as usize];
        let fan = |facet: &Vec<u32>| -> Vec<[DVec3; 3]> {
            facet[1..].windows(2).map(|pair| [at(facet[0]), at(pair[0]), at(pair[1])]).collect()
        };
        self.facets.iter().flat_map(fan).collect()
    }

    /// By the divergence theorem, also for facets that are not convex.
    pub(crate) fn volume(&self) -> f64 {
        self.triangles().iter().map(|[a, b, c]| a.dot(b.cross(*c))).sum::<f64>() / 6.0
    }

    pub(crate) fn area(&self) -> f64 {
        self.triangles().iter().map(|[a, b, c]| (b - a).cross(c - a).length()).sum::<f64>() / 2.0
    }

    pub(crate) fn size(&self) -> f64 {
        self.points.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max)
    }

    /// Whether the surface winds around a point, by the solid angles of its triangles (van Oosterom, Strackee 1983).
    pub(crate) fn winds_around(&self, point: DVec3) -> bool {
        let angle = |triangle: &[DVec3; 3]| {
            let [a, b, c] = triangle.map(|p| p - point);
            let (i, j, k) = (a.length(), b.length(), c.length());
            2.0 * a.dot(b.cross(c)).atan2(i * j * k + a.dot(b) * k + b.dot(c) * i + c.dot(a) * j)
        };
        self.triangles().iter().map(angle).sum::<f64>() > std::f64::consts::TAU
    }

    pub(crate) fn cells(&self, precision: Precision) -> Result<Polyhedron, PolyhedronError> {
        polyhedron(&self.points, &self.facets, &[MaterialId(0)], &PolyhedronOptions { precision })
    }

    /// The corners changed one by one.
    pub(crate) fn moved(&self, change: impl Fn(DVec3) -> DVec3) -> Self {
        Self { points: self.points.iter().map(|p| change(*p)).collect(), facets: self.facets.clone() }
    }

    /// Adds another surface.
    pub(crate) fn and(mut self, other: &Self) -> Self {
        let first = self.points.len() as u32;
        self.points.extend(&other.points);
        self.facets.extend(other.facets.iter().map(|facet| facet.iter().map(|v| v + first).collect()));
        self
    }

    /// The other side out.
    pub(crate) fn turned(mut self) -> Self {
        self.facets.iter_mut().for_each(|facet| facet.reverse());
        self
    }
}

/// The box between two corners.
pub(crate) fn cube(low: DVec3, high: DVec3) -> Given {
    let corner = |k: u32| DVec3::from_array([0, 1, 2].map(|a| if k >> a & 1 == 1 { high[a] } else { low[a] }));
    let facets = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    Given { points: (0..8).map(corner).collect(), facets: facets.map(Vec::from).to_vec() }
}

/// An upright prism over a loop of points, counter-clockwise, its ends whole.
pub(crate) fn prism(outline: &[[f64; 2]], height: f64) -> Given {
    let n = outline.len() as u32;
    let level = |z: f64| outline.iter().map(move |[x, y]| DVec3::new(*x, *y, z));
    let side = |k: u32| vec![k, (k + 1) % n, (k + 1) % n + n, k + n];
    let ends = [(0..n).rev().collect(), (n..2 * n).collect()];
    Given { points: level(0.0).chain(level(height)).collect(), facets: (0..n).map(side).chain(ends).collect() }
}

/// How far the point is inside a brush: less than 0 outside.
fn depth(brush: &Brush, point: DVec3) -> f64 {
    brush.faces.iter().map(|face| -face.half_space.signed_distance(point)).fold(f64::INFINITY, f64::min)
}

/// Random points must be in one cell where the surface winds around them, and in none elsewhere.
pub(crate) fn ensure_membership(given: &Given, cells: &[Brush], count: usize, margin: f64) -> Result<(), String> {
    let mut rng = Rng::spread(count as u64);
    let (low, high) =
        given.points.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), p| (l.min(*p), h.max(*p)));
    for _ in 0..count {
        let point = low + (high - low) * rng.point(-0.05, 1.05);
        let depths: Vec<f64> = cells.iter().map(|cell| depth(cell, point)).collect();
        if depths.iter().any(|depth| depth.abs() <= margin) {
            continue;
        }
        let (found, expected) =
            (depths.iter().filter(|depth| **depth > 0.0).count(), usize::from(given.winds_around(point)));
        ensure!(found == expected, "{point:?} is in {found} cells, expected {expected}");
    }
    Ok(())
}

pub(crate) fn evaluated(cells: &[Brush]) -> Evaluation {
    let used = cells.iter().flat_map(|cell| &cell.faces).map(|face| face.material.0 + 1).max().unwrap_or(1);
    let materials = (0..used).map(|k| Material::named(format!("material {k}"))).collect();
    evaluate(&Model { materials, tree: Tree::union_of(cells.to_vec()) }).expect("a closed boundary")
}

/// The skin of the cells must be closed, and have the volume; gives components and genus.
pub(crate) fn ensure_skin(cells: &[Brush], volume: f64, tolerance: f64) -> Result<(usize, Option<i64>), String> {
    let evaluation = evaluated(cells);
    let topology = check_topology(&evaluation.mesh.positions, &evaluation.mesh.triangles);
    ensure!(topology.manifold, "the skin is not manifold: {:?}", topology.first_defect);
    let found = evaluation.solid.volume;
    ensure!((found - volume).abs() <= tolerance, "the skin has a volume of {found}, expected {volume}");
    Ok((topology.components, topology.genus))
}
