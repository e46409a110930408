//! Random sets of planes.

use planecut_kernel::{DVec3, HalfSpace, IncrementalPolytope};
use planecut_oracle::generators;
use planecut_oracle::random::Rng;
use planecut_oracle::settings::first_seed;

pub(crate) type Coefficients = [f64; 4];

/// A set of planes and where it came from.
pub(crate) struct Case {
    pub(crate) seed: u64,
    pub(crate) planes: Vec<Coefficients>,
    pub(crate) rng: Rng,
}

impl Case {
    /// The polytope, the planes added in their order so that plane `i` has handle `i`.
    pub(crate) fn polytope(&self) -> IncrementalPolytope {
        build(&self.planes)
    }

    /// What to print where something is wrong.
    pub(crate) fn report(&self, what: &str) -> String {
        format!("{what}\nseed {}, planes:\nlet planes: Vec<[f64; 4]> = vec!{:?};", self.seed, self.planes)
    }
}

pub(crate) fn build(planes: &[Coefficients]) -> IncrementalPolytope {
    let mut polytope = IncrementalPolytope::new();
    for &[x, y, z, d] in planes {
        polytope.add_plane(HalfSpace::new(DVec3::new(x, y, z), d).expect("the generators keep to the range"));
    }
    polytope
}

/// Bounded or not, with or without interior; the kinds take turns.
pub(crate) fn any(count: u64) -> impl Iterator<Item = Case> {
    (0..count).map(|k| {
        let seed = first_seed() + k;
        let mut rng = Rng::new(seed);
        let planes = match k % 8 {
            0 => (0..rng.below(7)).map(|_| generators::grid(&mut rng, 3)).collect(),
            1 => (0..rng.below(7)).map(|_| generators::generic(&mut rng)).collect(),
            2 => (0..1 + rng.below(6)).map(|_| generators::thin(&mut rng)).collect(),
            3 => (0..1 + rng.below(7))
                .map(|_| generators::prism_side(&mut rng, Some([[1.0, 0.0, 1.0], [0.0, 1.0, 0.0]])))
                .collect(),
            _ => bounded_planes(&mut rng, k / 8),
        };
        Case { seed, planes, rng }
    })
}

/// Bounded ones, most of them with interior.
pub(crate) fn bounded(count: u64) -> impl Iterator<Item = Case> {
    (0..count).map(|k| {
        let seed = first_seed() + 1_000_000 + k;
        let mut rng = Rng::new(seed);
        let planes = bounded_planes(&mut rng, k);
        Case { seed, planes, rng }
    })
}

fn bounded_planes(rng: &mut Rng, kind: u64) -> Vec<Coefficients> {
    let cuts = rng.below(4);
    let mut planes = match kind % 8 {
        // grids, all coincidences
        0 | 1 => {
            let mut planes = generators::container(rng, 20, 2.0);
            planes.extend((0..cuts).map(|_| generators::grid(rng, 2)));
            planes
        }
        // no coincidences
        2 => {
            let mut planes = generators::container(rng, 20, 1.1);
            planes.extend((0..cuts + 2).map(|_| generators::generic(rng)));
            planes
        }
        // a needle
        3 => {
            let width = 2f64.powi(-(rng.below(70) as i32));
            let mut planes = box_planes(rng, [1.0, width, width]);
            planes
                .extend((0..cuts).map(|_| {
                    generators::plane([rng.float(-1.0, 1.0) * width, 1.0, rng.float(-1.0, 1.0)], 0.4 * width)
                }));
            planes
        }
        // a thin plate that lies askew
        4 => {
            let n = rng.direction();
            let d = rng.float(-0.3, 0.3);
            let mut planes = generators::cube(rng, 1.0);
            planes.push(generators::plane(n, d));
            let thickness = 2f64.powi(-(rng.below(52) as i32));
            planes.push(generators::plane(n.map(|v| -v), (d.abs() * thickness + thickness * 0.5) - d));
            planes
        }
        // an askew box that is symmetric about the origin
        5 => {
            let (a, b) = (rng.direction(), rng.direction());
            let axes = [a, b, rng.direction()];
            let mut planes = Vec::new();
            for n in axes {
                let d = rng.float(0.2, 2.0);
                planes.extend([generators::plane(n, d), generators::plane(n.map(|v| -v), d)]);
            }
            planes
        }
        // a pyramid or prism
        6 => {
            let ring = generators::Ring { sides: 3 + rng.below(5), slope: 0.5, jitter: 0.0, whole: rng.chance(0.5) };
            let mut planes = ring.planes(rng);
            planes.push([0.0, 0.0, -1.0, rng.whole(0, 2)]);
            planes
        }
        // a box of any numbers
        _ => {
            let size = [rng.float(0.1, 3.0), rng.float(0.1, 3.0), rng.float(0.1, 3.0)];
            box_planes(rng, size)
        }
    };
    if rng.chance(0.25) {
        let by = [rng.float(-1e8, 1e8), rng.whole(-100_000_000, 100_000_000), rng.float(-1.0, 1.0)];
        for plane in &mut planes {
            plane[3] += plane[0] * by[0] + plane[1] * by[1] + plane[2] * by[2];
        }
    }
    rng.shuffle(&mut planes);
    planes
}

fn box_planes(rng: &mut Rng, size: [f64; 3]) -> Vec<Coefficients> {
    let mut planes = Vec::new();
    for axis in 0..3 {
        for side in [1.0, -1.0] {
            let mut plane = [0.0; 4];
            plane[axis] = side;
            plane[3] = size[axis] * rng.float(0.3, 0.7);
            planes.push(plane);
        }
    }
    planes
}
