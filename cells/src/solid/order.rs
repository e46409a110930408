//! In which order bodies are carved out of a cell, and along which of their planes first.
//!
//! Whatever the order, one body leaves one piece for each of its planes that carries a face of what it has in common with
//! the cell. What the order decides is how often the other bodies are cut by these pieces, and which pieces can be merged.
//!
//! The rule: of several bodies the one nearest to the middle of all comes first, so that lists halve. Of its planes those
//! come first whose direction many bodies share, all cells taking them in one and the same order: the pieces become slabs
//! that end where their neighbours do, and merge. Then come the others, first the one that cuts the fewest of the other
//! bodies.

use planecut_csg::stages::Bounds;
use planecut_csg::{PlaneId, PlaneTable};
use planecut_kernel::DVec3;
use rustc_hash::{FxHashMap, FxHashSet};

use super::carve::Carver;
use super::cell::{Cell, CellPlane};
use super::convex::{BodySide, Convex};

/// A direction is common where at least this many bodies have a face across it,
const FEW: u32 = 3;
/// and at least this share of all bodies.
const SHARE: f64 = 0.25;

/// How to choose, and whether neighbours are merged in the end; without choosing, all is done in the order given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Rule {
    pub(super) chooses: bool,
    pub(super) merges: bool,
}

impl Default for Rule {
    fn default() -> Self {
        Self { chooses: true, merges: true }
    }
}

/// The next body to carve out, by its place in the list.
pub(super) fn next_body(carver: &Carver, cell: &Cell, bodies: &[u32]) -> Option<usize> {
    if bodies.len() < 3 || !carver.rule.chooses {
        return bodies.len().checked_sub(1);
    }
    let center = |body: &u32| within(carver.bodies[*body as usize].bounds(), cell.bounds()).center();
    let middle = bodies.iter().map(center).sum::<DVec3>() / bodies.len() as f64;
    let far = |k: &usize| (center(&bodies[*k]) - middle).length_squared();
    (0..bodies.len()).min_by(|a, b| far(a).total_cmp(&far(b)))
}

fn within(a: &Bounds, b: &Bounds) -> Bounds {
    Bounds { min: a.min.max(b.min), max: a.max.min(b.max) }
}

/// The next plane to cut along, by its place in the list.
pub(super) fn next_plane(carver: &Carver, bodies: &[u32], planes: &[CellPlane]) -> Option<usize> {
    if planes.len() < 2 || !carver.rule.chooses {
        return planes.len().checked_sub(1);
    }
    let cuts = |plane: PlaneId| bodies.iter().filter(|body| carver.box_side(**body, plane) == BodySide::Both).count();
    let score = |plane: PlaneId| if carver.is_common(plane) { 0 } else { 1 + cuts(plane) };
    let scored = planes.iter().enumerate().map(|(place, plane)| ((score(plane.plane), plane.plane), place));
    scored.min().map(|(_, place)| place)
}

/// The directions across which many bodies have faces.
pub(super) fn common_directions(table: &PlaneTable, bodies: &[&Convex]) -> FxHashSet<Direction> {
    // how many bodies, and the last one
    let mut counts: FxHashMap<Direction, (u32, usize)> = FxHashMap::default();
    for (number, body) in bodies.iter().enumerate() {
        for facet in &body.facets {
            let count = counts.entry(direction(table, facet.plane)).or_insert((0, usize::MAX));
            if count.1 != number {
                *count = (count.0 + 1, number);
            }
        }
    }
    let is_common = |count: u32| count >= FEW && f64::from(count) >= SHARE * bodies.len() as f64;
    counts.into_iter().filter(|(_, (count, _))| is_common(*count)).map(|(direction, _)| direction).collect()
}

/// A normal up to its sign and length, rounded: for counting only.
pub(super) type Direction = [i64; 3];

pub(super) fn direction(table: &PlaneTable, plane: PlaneId) -> Direction {
    let [x, y, z, _] = *table.row(plane.unsided()).coefficients();
    let unit = DVec3::new(x, y, z).normalize() * f64::from(1 << 30);
    unit.to_array().map(|v| v.round() as i64)
}

#[cfg(test)]
mod tests {
    use glam::{DMat3, DVec3};
    use planecut_kernel::HalfSpace;

    use super::Rule;
    use crate::solid::Solid;
    use planecut_csg::{Brush, MaterialId, Tree};

    /// Numbers in `0..1` (Marsaglia's xorshift).
    struct Random(u64);

    impl Random {
        fn next(&mut self) -> f64 {
            self.0 ^= self.0 << 13;
            self.0 ^= self.0 >> 7;
            self.0 ^= self.0 << 17;
            (self.0 >> 11) as f64 / (1_u64 << 53) as f64
        }

        fn point(&mut self, size: f64) -> DVec3 {
            DVec3::new(self.next(), self.next(), self.next()) * size
        }
    }

    fn block(min: DVec3, max: DVec3) -> Tree {
        Tree::from(Brush::cuboid(min, max, MaterialId(0)))
    }

    /// A body of planes around a point, in a random attitude.
    fn body(random: &mut Random, at: DVec3, planes: impl Iterator<Item = (DVec3, f64)>) -> Tree {
        let axis = (random.point(2.0) - 1.0).normalize_or(DVec3::X);
        let turn = DMat3::from_axis_angle(axis, 7.0 * random.next());
        let plane = |(normal, distance): (DVec3, f64)| {
            let normal = turn * normal;
            HalfSpace::new(normal, normal.dot(at) + distance).expect("a plane")
        };
        Tree::from(Brush::from_half_spaces(planes.map(plane), MaterialId(0)))
    }

    fn turned_box(random: &mut Random, at: DVec3, half: DVec3) -> Tree {
        let sides = DVec3::AXES.into_iter().zip(half.to_array()).flat_map(|(axis, h)| [(axis, h), (-axis, h)]);
        body(random, at, sides)
    }

    /// 100 planes around a segment.
    fn capsule(random: &mut Random, at: DVec3) -> Tree {
        let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
        let planes = (0..100).map(|k| {
            let z = 1.0 - (2.0 * f64::from(k) + 1.0) / 100.0;
            let (sine, cosine) = (golden * f64::from(k)).sin_cos();
            let radius = (1.0 - z * z).sqrt();
            (DVec3::new(cosine * radius, sine * radius, z), 0.6 + z.abs())
        });
        body(random, at, planes)
    }

    /// Each scene with the share of the cells of the given order that the rule may need.
    fn scenes() -> Vec<(&'static str, f64, Tree)> {
        let mut random = Random(88_172_645_463_325_252);
        let minus = |size: f64, tools: Vec<Tree>| {
            Tree::difference([block(DVec3::ZERO, DVec3::splat(size))].into_iter().chain(tools))
        };
        let mut draw = |count: usize, size: f64, tool: fn(&mut Random, DVec3) -> Tree| -> Vec<Tree> {
            (0..count)
                .map(|_| {
                    let at = random.point(size);
                    tool(&mut random, at)
                })
                .collect()
        };
        vec![
            (
                "block minus 200 cubes on a lattice",
                0.8,
                minus(40.0, draw(200, 37.0, |_, at| block(at.floor(), at.floor() + 2.0))),
            ),
            ("block minus 200 turned cubes", 0.8, minus(40.0, draw(200, 40.0, |r, at| turned_box(r, at, DVec3::ONE)))),
            ("block minus 40 capsules", 0.95, minus(11.0, draw(40, 11.0, capsule))),
            (
                "union of 200 boxes on a lattice",
                0.8,
                Tree::union(draw(200, 30.0, |r, at| block(at.floor(), (at + 1.0 + r.point(9.0)).floor()))),
            ),
            (
                "union of 200 turned boxes",
                0.8,
                Tree::union(draw(200, 30.0, |r, at| {
                    let half = 0.5 + r.point(4.0);
                    turned_box(r, at, half)
                })),
            ),
        ]
    }

    #[test]
    fn choosing_makes_fewer_cells_than_the_order_given() {
        let rules = [(false, false), (false, true), (true, false), (true, true)];
        for (name, share, tree) in scenes() {
            let solids = rules.map(|(chooses, merges)| Solid::from_tree_by(&tree, Rule { chooses, merges }));
            let [given, given_merged, chosen, merged] = solids.each_ref().map(|solid| solid.cells().count());
            let planes = |solid: &Solid| solid.cells().map(|cell| cell.planes().count()).sum::<usize>();
            let facets = |solid: &Solid| solid.cells().map(|cell| cell.facets().len()).sum::<usize>();
            let idle = (planes(&solids[3]) - facets(&solids[3])) as f64 / merged as f64;
            eprintln!(
                "{name}: {given}, merged {given_merged}; chosen {chosen}, merged {merged}; {idle:.2} idle planes a cell"
            );
            assert!((merged as f64) < share * given as f64, "{name}: {merged} of {given}");
            let volumes = solids.each_ref().map(|solid| solid.volume().expect("bounded"));
            assert!(volumes.iter().all(|volume| (volume - volumes[0]).abs() <= 1e-12 * volumes[0]), "{volumes:?}");
        }
    }
}
