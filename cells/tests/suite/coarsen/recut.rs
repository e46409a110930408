//! Cells of which the boundaries lie in any direction: of rings, of which the points inside are known without the code under test.

use glam::{DQuat, DVec3};
use planecut_cells::coarsen::{Bounded, CoarsenOptions, Coarsened, Coarsener, Surface};
use planecut_testkit::random::Rng;
use planecut_testkit::scene::scaled;

use super::judge::{assert_holds_points, holds};

const RINGS: u64 = 4;

/// A ring of prisms around the y axis: what is between two of its sections is convex.
struct Ring {
    sections: u32,
    sides: u32,
    positions: Vec<DVec3>,
}

impl Ring {
    fn new(sections: u32, sides: u32, inner: f64, outer: f64) -> Self {
        let at = |k: u32, of: u32| std::f64::consts::TAU * f64::from(k) / f64::from(of);
        let (middle, half) = (0.5 * (inner + outer), 0.5 * (outer - inner));
        let point = |k: u32| {
            let (around, along) = (at(k / sides, sections), at(k % sides, sides));
            let radius = middle + half * along.cos();
            DVec3::new(radius * around.cos(), half * along.sin(), radius * around.sin())
        };
        Self { sections, sides, positions: (0..sections * sides).map(point).collect() }
    }

    fn moved(mut self, by: impl Fn(DVec3) -> DVec3) -> Self {
        self.positions.iter_mut().for_each(|p| *p = by(*p));
        self
    }

    fn triangles(&self) -> Vec<[u32; 3]> {
        let number = |i: u32, j: u32| i % self.sections * self.sides + j % self.sides;
        let two = |k: u32| {
            let (i, j) = (k / self.sides, k % self.sides);
            let [a, b, c, d] = [number(i, j), number(i, j + 1), number(i + 1, j + 1), number(i + 1, j)];
            [[a, b, c], [a, c, d]]
        };
        (0..self.sections * self.sides).flat_map(two).collect()
    }

    fn coarsened(&self, options: &CoarsenOptions) -> Coarsened {
        let triangles = self.triangles();
        let surface =
            Surface { positions: &self.positions, triangles: &triangles, materials: &[], bounded: Bounded::Solid };
        Coarsener::of_surface(&surface, None, options).expect("a surface").coarsened().expect("cells")
    }

    /// A point between two of its sections: with weights for all of their corners.
    fn point_inside(&self, rng: &mut Rng) -> DVec3 {
        let section = rng.below(self.sections as usize) as u32;
        let corners = [section, (section + 1) % self.sections].into_iter();
        let corners = corners.flat_map(|section| section * self.sides..(section + 1) * self.sides);
        mean(corners.map(|corner| self.positions[corner as usize]), rng)
    }
}

/// A random mean of points, near one of them more often than not.
fn mean(points: impl Iterator<Item = DVec3>, rng: &mut Rng) -> DVec3 {
    let weighted = points.map(|p| (p, rng.float(0.0, 1.0).powi(8)));
    let (sum, all) = weighted.fold((DVec3::ZERO, 0.0), |(sum, all), (p, weight)| (sum + weight * p, all + weight));
    sum / all
}

fn of_cells(cells: usize) -> CoarsenOptions {
    CoarsenOptions { max_cells: Some(cells), ..CoarsenOptions::default() }
}

#[test]
fn a_ring_is_cut_across() {
    let ring = || Ring::new(24, 12, 0.873, 1.273);
    for (cells, most) in [(16, 0.045), (32, 0.016), (64, 0.0085)] {
        let found = ring().coarsened(&of_cells(cells));
        assert!(found.cells.len() <= cells);
        assert!(found.excess() <= most, "{cells}: {}", found.excess());
        assert!(found.sum_excess() <= 0.06, "{cells}: {}", found.sum_excess());
    }
    // where no section lies across an axis
    let turn = DQuat::from_euler(glam::EulerRot::XYZ, 0.4, 0.5, 0.6);
    let found = ring().moved(|p| turn * p).coarsened(&of_cells(24));
    assert!(found.excess() <= 0.02, "{}", found.excess());
}

#[test]
fn all_of_a_ring_is_in_a_cell_wherever_it_is() {
    for seed in 0..scaled(RINGS) {
        let mut rng = Rng::spread(seed);
        let turn = rng.rotation();
        let (scale, shift) = [(1.0, 0.0), (1e-3, 5.0), (2e5, -1e6), (1.0, 1e9)][(seed % 4) as usize];
        let ring = Ring::new(11, 7, 0.5, 1.25).moved(|p| turn * p * scale + DVec3::splat(shift));
        let triangles = ring.triangles();
        eprintln!("seed {seed}: turned by {turn}, times {scale}, moved by {shift}");
        for cells in [3, 8, 20] {
            let found = ring.coarsened(&of_cells(cells));
            assert!(found.cells.len() <= cells);
            assert_holds_points(&found.cells, &ring.positions);
            for k in 0..400 {
                let corners = triangles[rng.below(triangles.len())].map(|corner| ring.positions[corner as usize]);
                let point = if k % 2 == 0 { ring.point_inside(&mut rng) } else { mean(corners.into_iter(), &mut rng) };
                assert!(found.cells.iter().any(|cell| holds(cell, point)), "{point:?} is in no cell of {cells}");
            }
        }
    }
}

#[test]
fn the_number_of_threads_changes_no_cut() {
    let ring = Ring::new(13, 8, 0.6, 1.0).moved(|p| DQuat::from_rotation_x(0.3) * p);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| ring.coarsened(&of_cells(10)))
    };
    let one = on(1);
    assert_eq!(one, on(2));
    assert_eq!(one, on(3));
}
