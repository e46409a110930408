//! Unions of lattice cubes, whose faces are counted.

use glam::DVec3;
use planecut_shapes::polyhedron::Precision;
use rustc_hash::FxHashMap;

use super::judge::{Given, ensure_skin};
use planecut_testkit::random::Rng;
use planecut_testkit::scene::{ensure, scaled};

/// Side of the lattice.
const SIDE: i32 = 5;

/// Which cubes of the lattice are there.
#[derive(Debug, Clone)]
struct Voxels(Vec<bool>);

impl Voxels {
    fn random(rng: &mut Rng) -> Self {
        let density = rng.float(0.2, 0.9);
        Self((0..SIDE.pow(3)).map(|_| rng.chance(density)).collect())
    }

    fn holds(&self, [x, y, z]: [i32; 3]) -> bool {
        let within = [x, y, z].iter().all(|v| (0..SIDE).contains(v));
        within && self.0[(x + SIDE * (y + SIDE * z)) as usize]
    }

    fn cubes(&self) -> impl Iterator<Item = [i32; 3]> + '_ {
        let all = (0..SIDE.pow(3)).map(|k| [k % SIDE, k / SIDE % SIDE, k / SIDE / SIDE]);
        all.filter(|cube| self.holds(*cube))
    }

    /// A square for each face between a cube and nothing; corners merged, so that cubes that touch share them.
    fn surface(&self) -> Given {
        let mut given = Given::default();
        let mut numbers: FxHashMap<[i32; 3], u32> = FxHashMap::default();
        for cube in self.cubes() {
            for (axis, step) in (0..3).flat_map(|axis| [(axis, -1), (axis, 1)]) {
                let mut beyond = cube;
                beyond[axis] += step;
                if self.holds(beyond) {
                    continue;
                }
                let square = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[u, v]| {
                    let mut corner = cube;
                    corner[axis] += i32::from(step > 0);
                    corner[(axis + 1) % 3] += u;
                    corner[(axis + 2) % 3] += v;
                    let next = given.points.len() as u32;
                    *numbers.entry(corner).or_insert_with(|| {
                        given.points.push(DVec3::from_array(corner.map(f64::from)));
                        next
                    })
                });
                given.facets.push(if step > 0 { square.to_vec() } else { square.into_iter().rev().collect() });
            }
        }
        given
    }
}

fn judge(voxels: &Voxels, turn: &dyn Fn(DVec3) -> DVec3, noise: f64) -> Result<(), String> {
    let count = voxels.cubes().count();
    if count == 0 {
        return Ok(());
    }
    let solid = voxels.surface().moved(turn).cells(Precision::Double).map_err(|error| format!("refused: {error}"))?;
    ensure!((solid.volume - count as f64).abs() <= noise, "volume {}, expected {count}", solid.volume);
    ensure!(solid.cells.len() <= count, "{} cells of {count} cubes", solid.cells.len());
    for cube in (0..SIDE.pow(3)).map(|k| [k % SIDE, k / SIDE % SIDE, k / SIDE / SIDE]) {
        let middle = turn(DVec3::from_array(cube.map(|v| f64::from(v) + 0.5)));
        let inside =
            |cell: &&planecut_csg::Brush| cell.faces.iter().all(|face| face.half_space.signed_distance(middle) < 0.0);
        let (found, expected) = (solid.cells.iter().filter(inside).count(), usize::from(voxels.holds(cube)));
        ensure!(found == expected, "{cube:?} is in {found} cells, expected {expected}");
    }
    ensure_skin(&solid.cells, count as f64, noise).map(drop)
}

/// Random lattices; one that fails loses cubes for as long as it does.
fn sweep(count: u64, turn: &dyn Fn(DVec3) -> DVec3, noise: f64) {
    for seed in 0..scaled(count) {
        let mut voxels = Voxels::random(&mut Rng::spread(seed));
        let Err(mut message) = judge(&voxels, turn, noise) else { continue };
        while let Some((smaller, still)) = (0..voxels.0.len()).filter(|k| voxels.0[*k]).find_map(|k| {
            let mut smaller = voxels.clone();
            smaller.0[k] = false;
            let message = judge(&smaller, turn, noise).err()?;
            Some((smaller, message))
        }) {
            (voxels, message) = (smaller, still);
        }
        panic!("seed {seed}: {message}\nlet cubes = {:?};", voxels.cubes().collect::<Vec<_>>());
    }
}

#[test]
fn cubes_that_touch_anyhow() {
    sweep(150, &|p| p, 1e-12);
}

#[test]
fn turned_cubes_that_touch_anyhow() {
    let turn = glam::DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 0.7);
    sweep(60, &|p| turn * p + DVec3::new(0.3, -7.0, 0.1), 1e-9);
}

#[test]
fn chosen_cubes() {
    let two = |a: [i32; 3], b: [i32; 3]| {
        let mut voxels = Voxels(vec![false; SIDE.pow(3) as usize]);
        for [x, y, z] in [a, b] {
            voxels.0[(x + SIDE * (y + SIDE * z)) as usize] = true;
        }
        voxels.surface().cells(Precision::Double).expect("a closed surface")
    };
    let (edge, corner, apart) = (two([0, 0, 0], [1, 1, 0]), two([0, 0, 0], [1, 1, 1]), two([0, 0, 0], [2, 0, 0]));
    assert_eq!([&edge, &corner, &apart].map(|solid| solid.cells.len()), [2, 2, 2]);
    assert_eq!([&edge, &corner, &apart].map(|solid| solid.touches_itself), [true, true, false]);
    assert_eq!(two([0, 0, 0], [1, 0, 0]).cells.len(), 1, "two cubes side by side are a box");
}
