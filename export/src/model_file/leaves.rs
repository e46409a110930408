//! Brushes, each in one line.

use std::borrow::Cow;

use glam::DVec3;
use planecut_csg::{Brush, ClosedMesh, MaterialId, MeshBody, Transform, WindingRule};
use planecut_kernel::HalfSpace;

use super::limits::is_accepted;
use super::materials::MaterialNames;
use super::text::{Text, quoted};
use crate::ExportError;

/// The brushes of a tree, and how they are written.
pub(super) struct Leaves<'m> {
    pub(super) brushes: &'m [Brush],
    pub(super) names: &'m MaterialNames,
    /// The factor of all coordinates.
    pub(super) scale: f64,
}

/// What the faces of a brush are made of, by the places of names.
enum Made {
    /// All of one material.
    Of(usize),
    /// Of several, for each face.
    OfSeveral(Vec<usize>),
}

impl Leaves<'_> {
    /// Writes a brush that has a face or a triangle.
    ///
    /// # Errors
    /// [`ExportError::UnknownMaterial`], [`ExportError::ModelRange`], [`ExportError::ModelLimit`] and [`ExportError::Io`].
    pub(super) fn write(&self, number: usize, text: &mut Text<'_>) -> Result<(), ExportError> {
        match &self.brushes[number].mesh {
            Some(mesh) => self.write_mesh(number, mesh, text),
            None => self.write_half_spaces(number, text),
        }
    }

    fn write_half_spaces(&self, number: usize, text: &mut Text<'_>) -> Result<(), ExportError> {
        let faces = &self.brushes[number].faces;
        let made = self.made(number, faces.iter().map(|face| face.material))?;
        self.begin(number, &made, text);
        let scaled = faces.iter().map(|face| self.scaled(number, &face.half_space));
        text.push("\"halfspaces\": ");
        text.long_list(scaled.collect::<Result<Vec<HalfSpace>, ExportError>>()?, |text, half_space| {
            text.numbers(&half_space.to_array());
        })?;
        self.write_several(&made, text)?;
        text.push("}");
        Ok(())
    }

    fn write_mesh(&self, number: usize, body: &MeshBody, text: &mut Text<'_>) -> Result<(), ExportError> {
        let mesh: &ClosedMesh = body.mesh();
        let made = self.made(number, (0..mesh.triangles().len()).map(|triangle| body.material(triangle)))?;
        self.begin(number, &made, text);
        let transform = self.scaled_transform(number, body.transform())?;
        if transform != Transform::identity() {
            let (linear, shift) = (transform.linear(), transform.offset());
            let row = |row: usize| [linear.x_axis[row], linear.y_axis[row], linear.z_axis[row], shift[row]];
            text.push("\"matrix\": ");
            text.list([0, 1, 2].map(row), |text, row| text.numbers(&row));
            text.push(", ");
        }
        text.push("\"mesh\": {\"vertices\": ");
        let vertices = self.scaled_positions(number, mesh.positions())?;
        text.long_list(vertices.iter(), |text, vertex| text.numbers(&vertex.to_array()))?;
        text.push(", \"triangles\": ");
        text.long_list(mesh.triangles(), |text, triangle| text.whole_numbers(triangle))?;
        self.write_several(&made, text)?;
        match body.rule() {
            WindingRule::Positive => {}
            WindingRule::NonZero => text.push(", \"rule\": \"nonzero\""),
            WindingRule::Odd => text.push(", \"rule\": \"odd\""),
        }
        text.push("}}");
        Ok(())
    }

    /// The beginning of a node: its name, and its material where it has one alone.
    fn begin(&self, number: usize, made: &Made, text: &mut Text<'_>) {
        text.push("{");
        if let Some(name) = &self.brushes[number].name {
            text.push(&format!("\"name\": {}, ", quoted(name)));
        }
        if let Made::Of(place) = made {
            text.push(&format!("\"material\": {}, ", self.names.name(*place)));
        }
    }

    /// The list of materials, where there are several.
    fn write_several(&self, made: &Made, text: &mut Text<'_>) -> Result<(), ExportError> {
        let Made::OfSeveral(places) = made else { return Ok(()) };
        text.push(", \"materials\": ");
        text.long_list(places, |text, place| text.push(self.names.name(*place)))
    }

    fn made(&self, brush: usize, materials: impl Iterator<Item = MaterialId>) -> Result<Made, ExportError> {
        let place = |material: MaterialId| {
            let unknown = || ExportError::UnknownMaterial { brush, material: material.0, count: self.names.count() };
            self.names.place(material).ok_or_else(unknown)
        };
        let places = materials.map(place).collect::<Result<Vec<usize>, ExportError>>()?;
        Ok(match places.first() {
            Some(first) if places.iter().all(|place| place == first) => Made::Of(*first),
            _ => Made::OfSeveral(places),
        })
    }

    fn scaled(&self, brush: usize, half_space: &HalfSpace) -> Result<HalfSpace, ExportError> {
        HalfSpace::new(half_space.normal(), half_space.offset() * self.scale)
            .map_err(|error| ExportError::ModelRange { brush, reason: error.to_string() })
    }

    /// A map that does to scaled vertices what the map does to vertices, scaled in the end.
    fn scaled_transform(&self, brush: usize, transform: &Transform) -> Result<Transform, ExportError> {
        if self.scale == 1.0 {
            return Ok(*transform);
        }
        Transform::new(transform.linear(), transform.offset() * self.scale)
            .map_err(|error| ExportError::ModelRange { brush, reason: error.to_string() })
    }

    fn scaled_positions<'p>(&self, brush: usize, positions: &'p [DVec3]) -> Result<Cow<'p, [DVec3]>, ExportError> {
        let scaled = if self.scale == 1.0 {
            Cow::Borrowed(positions)
        } else {
            positions.iter().map(|position| *position * self.scale).collect()
        };
        match scaled.iter().find(|position| !is_accepted(**position)) {
            Some(position) => {
                let expected = "expected coordinates that are 0 or of magnitudes from 2^-1022 to 2^100";
                Err(ExportError::ModelRange {
                    brush,
                    reason: format!("found a vertex at {:?}, {expected}", position.to_array()),
                })
            }
            None => Ok(scaled),
        }
    }
}
