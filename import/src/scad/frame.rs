//! What a node inherits from those around it: where it is put, and its colour.
//!
//! Maps are multiplied on the way down, so that each plane and each corner is moved once. Where a result is measured or summed
//! before it is put in place (extrusions, Minkowski sums, offsets) a node starts in a frame of its own.

use glam::{DMat2, DMat3};
use planecut_csg::{MaterialId, Transform};
use planecut_kernel::{DVec2, DVec3};

use super::materials::Materials;
use super::syntax::Node;
use super::value::Value;

/// A map of the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FlatMap {
    pub(super) linear: DMat2,
    pub(super) translation: DVec2,
}

/// What a node inherits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Frame {
    linear: DMat3,
    translation: DVec3,
    /// OpenSCAD cuts a matrix down to the plane each time that it meets one, so this does not follow from the other map.
    flat: FlatMap,
    pub(super) material: MaterialId,
    /// Whether the material comes from a colour; the outermost colour wins.
    is_colored: bool,
    /// Whether the node does not count.
    pub(super) is_left_out: bool,
}

impl Frame {
    /// Nothing inherited.
    pub(super) fn outermost() -> Self {
        Self {
            linear: DMat3::IDENTITY,
            translation: DVec3::ZERO,
            flat: FlatMap::identity(),
            material: Materials::UNCOLORED,
            is_colored: false,
            is_left_out: false,
        }
    }

    /// The same, but in place.
    pub(super) fn unplaced(self) -> Self {
        Self {
            material: self.material,
            is_colored: self.is_colored,
            is_left_out: self.is_left_out,
            ..Self::outermost()
        }
    }

    /// What the node's children inherit from a matrix.
    pub(super) fn within_matrix(self, matrix: &Matrix) -> Self {
        Self {
            linear: self.linear * matrix.linear,
            translation: self.linear * matrix.translation + self.translation,
            flat: FlatMap {
                linear: self.flat.linear * matrix.flat().linear,
                translation: self.flat.linear * matrix.flat().translation + self.flat.translation,
            },
            ..self
        }
    }

    /// What the node's children inherit from a colour; one that is not known has negative parts, and says nothing.
    pub(super) fn within_color(self, color: Option<[f64; 4]>, materials: &mut Materials) -> Self {
        match color.filter(|color| !self.is_colored && color.iter().all(|part| *part >= 0.0)) {
            Some(color) => Self { material: materials.of_color(color), is_colored: true, ..self },
            None => self,
        }
    }

    /// Where solids are put; `None` where they are flattened.
    pub(super) fn solid_map(&self) -> Option<Transform> {
        Transform::new(self.linear, self.translation).ok()
    }

    /// Where a point is put, also where solids are flattened.
    pub(super) fn flattened(&self, point: DVec3) -> DVec3 {
        self.linear * point + self.translation
    }

    /// Where outlines are put; `None` where they are flattened.
    pub(super) fn flat_map(&self) -> Option<FlatMap> {
        self.flat.is_invertible().then_some(self.flat)
    }
}

impl FlatMap {
    pub(super) fn identity() -> Self {
        Self { linear: DMat2::IDENTITY, translation: DVec2::ZERO }
    }

    pub(super) fn is_invertible(&self) -> bool {
        let size = self.linear.x_axis.length() * self.linear.y_axis.length();
        self.linear.determinant().abs() > 1e-14 * size && size.is_finite() && self.translation.is_finite()
    }
}

/// The matrix of `multmatrix`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Matrix {
    linear: DMat3,
    translation: DVec3,
}

impl Matrix {
    /// The first three rows of a matrix; numbers that are missing are those of the identity.
    pub(super) fn of(node: &Node<'_>) -> Self {
        let value = node.arguments.iter().find(|(name, _)| name.is_none_or(|name| name == "m")).map(|(_, value)| value);
        let rows = value.map(Value::items).unwrap_or_default();
        let entry = |row: usize, column: usize| {
            let given = rows.get(row).and_then(|row| row.items().get(column)).and_then(Value::number);
            given.unwrap_or(if row == column { 1.0 } else { 0.0 })
        };
        let column = |column| DVec3::from_array(std::array::from_fn(|row| entry(row, column)));
        // a last row other than 0 0 0 1 divides by its last entry
        let weight = entry(3, 3);
        let scale = if weight == 0.0 { 1.0 } else { weight.recip() };
        Self { linear: DMat3::from_cols(column(0), column(1), column(2)) * scale, translation: column(3) * scale }
    }

    pub(super) fn is_finite(&self) -> bool {
        self.linear.is_finite() && self.translation.is_finite()
    }

    pub(super) fn flattens_solids(&self) -> bool {
        Transform::new(self.linear, self.translation).is_err()
    }

    pub(super) fn flattens_outlines(&self) -> bool {
        !self.flat().is_invertible()
    }

    fn flat(&self) -> FlatMap {
        let linear = DMat2::from_cols(self.linear.x_axis.truncate(), self.linear.y_axis.truncate());
        FlatMap { linear, translation: self.translation.truncate() }
    }
}
