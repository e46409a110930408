//! Random edits that make sense on any model of brushes.

use planecut_csg::{Brush, BrushId, Edit, LiveModel, Material, MaterialId, Model, Role, Transform, evaluate};
use planecut_kernel::{DMat3, DVec3, HalfSpace, PlaneIdx};
use rand::rngs::StdRng;
use rand::{Rng, SeedableRng};

/// The kinds of edits that are timed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    AddPlane,
    RemovePlane,
    MovePlane,
    AddBrush,
    RemoveBrush,
    TransformBrush,
    SetRole,
}

impl Kind {
    pub(crate) const ALL: [Self; 7] = [
        Self::AddPlane,
        Self::RemovePlane,
        Self::MovePlane,
        Self::AddBrush,
        Self::RemoveBrush,
        Self::TransformBrush,
        Self::SetRole,
    ];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::AddPlane => "add_plane",
            Self::RemovePlane => "remove_plane",
            Self::MovePlane => "move_plane",
            Self::AddBrush => "add_brush",
            Self::RemoveBrush => "remove_brush",
            Self::TransformBrush => "transform_brush",
            Self::SetRole => "set_role",
        }
    }
}

/// Where the brushes of a model are, and a source of numbers.
pub(crate) struct Draw {
    random: StdRng,
    /// Each brush with an interior, and its box.
    boxes: Vec<(BrushId, DVec3, DVec3)>,
}

impl Draw {
    pub(crate) fn new(model: &Model, seed: u64) -> Self {
        let alone = |brush: &Brush| {
            let faces = brush.faces.iter().map(|face| face.half_space);
            let tree = Brush::from_half_spaces(faces, MaterialId(0)).into();
            let solid = evaluate(&Model { materials: vec![Material::default()], tree }).ok()?.solid;
            (solid.volume > 0.0).then_some((solid.min, solid.max))
        };
        let boxes = (0..).zip(model.tree.brushes()).filter_map(|(id, brush)| {
            let (min, max) = alone(brush)?;
            Some((BrushId(id), min, max))
        });
        Self { random: StdRng::seed_from_u64(seed), boxes: boxes.collect() }
    }

    fn point(&mut self, min: DVec3, max: DVec3) -> DVec3 {
        let share = DVec3::from_array(std::array::from_fn(|_| self.random.random_range(0.0..1.0)));
        min + share * (max - min)
    }

    fn direction(&mut self) -> DVec3 {
        loop {
            let direction = self.point(-DVec3::ONE, DVec3::ONE);
            if (0.1..1.0).contains(&direction.length()) {
                return direction.normalize();
            }
        }
    }

    /// An edit of some brush: a plane through its box, a box of its size nearby, a small motion.
    pub(crate) fn edit(&mut self, kind: Kind, model: &LiveModel) -> Edit {
        let (brush, min, max) = self.boxes[self.random.random_range(0..self.boxes.len())];
        let (middle, size) = (0.5 * (min + max), max - min);
        let planes = model.planes(brush).map_or(&[][..], |planes| planes);
        let place = self.random.random_range(0..planes.len().max(1));
        let plane = planes.get(place).copied().unwrap_or(PlaneIdx(0));
        match kind {
            Kind::AddPlane => {
                let (normal, through) = (self.direction(), self.point(min, max));
                let half_space = HalfSpace::new(normal, normal.dot(through)).expect("a unit normal");
                Edit::AddPlane { brush, half_space, material: None }
            }
            Kind::RemovePlane => Edit::RemovePlane { brush, plane },
            Kind::MovePlane => {
                let face = model.brush(brush).ok().and_then(|(brush, _)| brush.faces.get(place).copied());
                let half_space = face.map_or(HalfSpace::new(DVec3::X, 0.0).expect("an axis"), |face| face.half_space);
                let by = 0.25 * self.random.random_range(-1.0..1.0) * size.min_element();
                Edit::MovePlane { brush, plane, offset: half_space.offset() + by * half_space.normal().length() }
            }
            Kind::AddBrush => {
                let at = middle + self.point(-0.5 * size, 0.5 * size);
                let half = 0.5 * size.clamp(DVec3::splat(1e-3 * size.max_element()), DVec3::splat(size.max_element()));
                let role = if self.random.random_range(0..2) == 0 { Role::Add } else { Role::Subtract };
                Edit::AddBrush { brush: Brush::cuboid(at - half, at + half, MaterialId(0)), role }
            }
            Kind::RemoveBrush => Edit::RemoveBrush { brush },
            Kind::TransformBrush => {
                let turn = DMat3::from_axis_angle(self.direction(), self.random.random_range(-0.2..0.2));
                let by = middle - turn * middle + self.point(-0.1 * size, 0.1 * size);
                Edit::TransformBrush { brush, transform: Transform::new(turn, by).expect("a rotation") }
            }
            Kind::SetRole => Edit::SetRole { operand: brush.into(), role: Role::Subtract },
        }
    }
}
