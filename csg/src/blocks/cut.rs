//! Where blocks end.

use planecut_kernel::{DVec3, HalfSpace};

use crate::body::{BrushBody, build_bodies};
use crate::bounds::Bounds;
use crate::brush::{Brush, BrushFace, MaterialId};

/// So many brushes are built at a time to know where they are.
const AT_A_TIME: usize = 1 << 13;

/// A wall lies off the middle by a share of the extent that no grid of a few thousand steps has.
const STEPS: f64 = (1 << 16) as f64;

/// The boxes of brushes, those of empty ones empty; the number of one that is not bounded where there is one.
pub(super) fn bounds_of(brushes: &[Brush]) -> Result<Vec<Bounds>, usize> {
    let mut bounds = Vec::with_capacity(brushes.len());
    for some in brushes.chunks(AT_A_TIME) {
        for body in build_bodies(some).bodies {
            bounds.push(match body {
                BrushBody::Bounded(body, _) => body.bounds,
                BrushBody::Empty => Bounds::EMPTY,
                BrushBody::Unbounded => return Err(bounds.len()),
            });
        }
    }
    Ok(bounds)
}

/// A box, and the brushes that reach into it, ascending.
pub(super) struct Cut {
    pub(super) bounds: Bounds,
    pub(super) members: Vec<u32>,
}

impl Cut {
    /// All brushes that are not empty.
    pub(super) fn whole(bounds: &[Bounds]) -> Self {
        let members = (0..).zip(bounds).filter(|(_, bounds)| **bounds != Bounds::EMPTY).map(|(member, _)| member);
        Self { bounds: bounds.iter().fold(Bounds::EMPTY, |all, bounds| all.union(bounds)), members: members.collect() }
    }

    /// The block cut in two along its longest axis near the median of the brushes; nothing where a part would hold nearly as
    /// many as the whole.
    pub(super) fn halves(&self, bounds: &[Bounds]) -> Option<[Self; 2]> {
        let extent = self.bounds.max - self.bounds.min;
        let axis = extent.max_position();
        let center = |member: &u32| {
            let bounds = &bounds[*member as usize];
            bounds.center()[axis].clamp(self.bounds.min[axis], self.bounds.max[axis])
        };
        let mut centers: Vec<f64> = self.members.iter().map(center).collect();
        let half = centers.len() / 2;
        let (_, median, _) = centers.select_nth_unstable_by(half, f64::total_cmp);
        let step = (extent[axis] / STEPS).log2().floor().exp2();
        let wall = ((*median / step).floor() + 0.5) * step;
        if !(self.bounds.min[axis] < wall && wall < self.bounds.max[axis]) {
            return None;
        }
        let of = |reaches: &dyn Fn(&Bounds) -> bool| -> Vec<u32> {
            self.members.iter().copied().filter(|member| reaches(&bounds[*member as usize])).collect()
        };
        let parts = [of(&|bounds| bounds.min[axis] <= wall), of(&|bounds| bounds.max[axis] >= wall)];
        if parts.iter().any(|part| part.len() * 10 > self.members.len() * 9) {
            return None;
        }
        let [below, above] = parts;
        let (mut low, mut high) = (self.bounds, self.bounds);
        (low.max[axis], high.min[axis]) = (wall, wall);
        Some([Self { bounds: low, members: below }, Self { bounds: high, members: above }])
    }

    /// Adds the walls to a brush that it reaches over.
    pub(super) fn add_walls(&self, brush: &mut Brush, bounds: &Bounds, material: MaterialId) {
        let mut add = |normal: DVec3, offset: f64| {
            let half_space = HalfSpace::new(normal, offset).expect("a wall within the model");
            brush.faces.push(BrushFace { half_space, material });
        };
        for (axis, unit) in DVec3::AXES.into_iter().enumerate() {
            if bounds.max[axis] >= self.bounds.max[axis] {
                add(unit, self.bounds.max[axis]);
            }
            if bounds.min[axis] <= self.bounds.min[axis] {
                add(-unit, -self.bounds.min[axis]);
            }
        }
    }
}
