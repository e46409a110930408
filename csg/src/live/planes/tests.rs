//! Planes that come and go, against a table of all that are there.

use planecut_kernel::DVec3;

use super::*;
use crate::ids::Id;
use crate::plane_table::is_reversed;

/// A little generator of numbers below a bound.
struct Draw(u64);

impl Draw {
    fn below(&mut self, bound: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % bound
    }

    /// Few directions and distances, most of them with noise of the size of the tolerance.
    fn half_space(&mut self) -> HalfSpace {
        let normals = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.6, 0.7, 0.0], [0.0, 0.3, -0.8], [0.3, 0.5, 0.7]];
        let [x, y, z] = normals[self.below(5) as usize];
        let offset = [0.0, 1.0, 1.5, 3.0][self.below(4) as usize];
        let scale = [1.0, 3.0, -1.0, -7.0][self.below(4) as usize];
        let mut noise = |v: f64| if self.below(3) == 0 { v } else { v + 3e-13 * (self.below(9) as f64 - 4.0) };
        let normal = DVec3::new(noise(x), noise(y), noise(z));
        HalfSpace::new(normal * scale, noise(offset) * scale).expect("a valid half-space")
    }
}

#[test]
fn planes_come_apart_as_the_smallest_body_shrinks() {
    let half_space = |offset: f64| HalfSpace::new(DVec3::new(0.6, 0.7, 0.0), offset).expect("a valid half-space");
    let mut planes = LivePlanes::default();
    let user = OperandId::from_index(0);
    let [low, high] = [0.0, 4e-12].map(|offset| planes.take(&half_space(offset), user));
    planes.count_size(Some(8.0), true);
    planes.settle(&[]);
    assert_eq!(planes.id(low), planes.id(high));
    planes.count_size(Some(1.0), true);
    let settled = planes.settle(&[]);
    assert_ne!(planes.id(low), planes.id(high));
    assert_eq!(settled.users, [user]);
    planes.count_size(Some(1.0), false);
    planes.settle(&[]);
    assert_eq!(planes.id(low), planes.id(high));
}

#[test]
fn planes_are_snapped_as_in_a_table_of_all_of_them() {
    let user = OperandId::from_index(0);
    for seed in 0..60 {
        let mut draw = Draw(seed);
        let mut planes = LivePlanes::default();
        let mut held: Vec<(HalfSpace, PlaneUse)> = Vec::new();
        let mut size = None;
        for step in 0..120 {
            for _ in 0..=draw.below(3) {
                if held.is_empty() || draw.below(5) < 3 {
                    let half_space = draw.half_space();
                    held.push((half_space, planes.take(&half_space, user)));
                } else {
                    let (half_space, used) = held.swap_remove(draw.below(held.len() as u64) as usize);
                    planes.release(&half_space, used, user);
                }
            }
            if draw.below(4) == 0 {
                planes.count_size(size, false);
                size = [None, Some(0.3), Some(1.0), Some(100.0)][draw.below(4) as usize];
                planes.count_size(size, true);
            }
            let settled = planes.settle(&[]);
            settled.retired.iter().for_each(|index| planes.free(*index));
            let all: Vec<HalfSpace> = held.iter().map(|held| held.0).collect();
            let (table, ids) = PlaneTable::intern(&all, size.unwrap_or(0.0));
            for (k, (half_space, used)) in held.iter().enumerate() {
                let (found, expected) = (planes.table.row(planes.id(*used)), table.row(ids[k]));
                assert!(
                    found.is_same_plane(expected) && is_reversed(found) == is_reversed(expected),
                    "seed {seed}, step {step}: {half_space:?} is taken for {found:?} instead of {expected:?} of {all:?}"
                );
            }
        }
    }
}
