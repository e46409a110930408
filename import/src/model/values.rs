//! Values of a text whose form was checked: numbers, vectors, maps.

use glam::{DMat2, DMat3, DVec2, DVec3};
use planecut_csg::Transform;
use rustc_hash::FxHashMap;

use super::error::{Checked, Fault};
use super::expression::Expression;
use super::form::{PlaceForm, kind_of, place_of};
use super::json::{Document, Entry, Kind};
use super::keys::STEP_KINDS;
use crate::source::shorten;

/// Reads values, with parameters of certain values.
#[derive(Debug, Clone, Copy)]
pub(super) struct Values<'v, 'a> {
    pub(super) document: &'v Document<'a>,
    pub(super) expressions: &'v FxHashMap<Entry, Expression>,
    /// By the numbers of the parameters.
    pub(super) parameters: &'v [f64],
}

impl Values<'_, '_> {
    /// A number, worked out where it is an expression.
    pub(super) fn number(&self, entry: Entry) -> Checked<f64> {
        if let Kind::Number(value) = self.document.kind(entry) {
            return Ok(value);
        }
        let value = self.expressions.get(&entry).and_then(|expression| expression.value(self.parameters));
        value.ok_or_else(|| {
            let found = format!("\"{}\", which has no finite value", shorten(&self.document.text(entry)));
            Fault::new(entry, found, "an expression with a finite value")
        })
    }

    /// A number in words: as it is written, and what it comes to.
    pub(super) fn describe_number(&self, entry: Entry) -> String {
        match (self.document.kind(entry), self.number(entry)) {
            (Kind::Text, Ok(value)) => format!("{value} from \"{}\"", shorten(&self.document.text(entry))),
            _ => self.document.describe(entry),
        }
    }

    /// A whole number between two others.
    pub(super) fn whole(&self, entry: Entry, least: u32, most: u32) -> Checked<u32> {
        let value = self.number(entry)?;
        if value.fract() == 0.0 && (f64::from(least)..=f64::from(most)).contains(&value) {
            return Ok(value as u32);
        }
        Err(Fault::new(entry, self.describe_number(entry), format!("a whole number from {least} to {most}")))
    }

    /// A number between 0 and 1.
    pub(super) fn share(&self, entry: Entry) -> Checked<f32> {
        let value = self.number(entry)?;
        if (0.0..=1.0).contains(&value) {
            return Ok(value as f32);
        }
        Err(Fault::new(entry, self.describe_number(entry), "a number from 0 to 1"))
    }

    /// A list of N numbers.
    pub(super) fn array<const N: usize>(&self, entry: Entry) -> Checked<[f64; N]> {
        let mut values = [0.0; N];
        for (value, item) in values.iter_mut().zip(self.document.items(entry)) {
            *value = self.number(item)?;
        }
        Ok(values)
    }

    /// A list of three numbers.
    pub(super) fn vector(&self, entry: Entry) -> Checked<DVec3> {
        self.array(entry).map(DVec3::from_array)
    }

    /// A list of two numbers.
    pub(super) fn point(&self, entry: Entry) -> Checked<DVec2> {
        self.array(entry).map(DVec2::from_array)
    }

    /// One number for all of N, or a list of N.
    pub(super) fn scale<const N: usize>(&self, entry: Entry) -> Checked<[f64; N]> {
        match self.document.kind(entry) {
            Kind::List => self.array(entry),
            _ => Ok([self.number(entry)?; N]),
        }
    }

    /// The loops of a polygon.
    pub(super) fn loops(&self, entry: Entry) -> Checked<Vec<Vec<DVec2>>> {
        let is_list = |entry: Option<Entry>| entry.filter(|entry| self.document.kind(*entry) == Kind::List);
        let first = is_list(self.document.items(entry).next());
        let is_nested = first.and_then(|first| is_list(self.document.items(first).next())).is_some();
        let points = |entry| self.document.items(entry).map(|point| self.point(point)).collect();
        if is_nested { self.document.items(entry).map(points).collect() } else { Ok(vec![points(entry)?]) }
    }

    /// The map of a matrix of 3 or 4 rows of 4.
    pub(super) fn matrix(&self, entry: Entry) -> Checked<Transform> {
        let mut rows = [[0.0; 4]; 4];
        for (row, item) in rows.iter_mut().zip(self.document.items(entry)) {
            *row = self.array(item)?;
        }
        if let Some(last) = self.document.items(entry).nth(3).filter(|_| rows[3] != [0.0, 0.0, 0.0, 1.0]) {
            return Err(Fault::new(last, format!("{:?}", rows[3]), "[0, 0, 0, 1], the last row of an affine map"));
        }
        let column = |column: usize| DVec3::new(rows[0][column], rows[1][column], rows[2][column]);
        let linear = DMat3::from_cols(column(0), column(1), column(2));
        self.accept(entry, Transform::new(linear, column(3)))
    }

    /// The map of a matrix of 2 or 3 rows of 3.
    pub(super) fn planar_matrix(&self, entry: Entry) -> Checked<(DMat2, DVec2)> {
        let mut rows = [[0.0; 3]; 3];
        for (row, item) in rows.iter_mut().zip(self.document.items(entry)) {
            *row = self.array(item)?;
        }
        if let Some(last) = self.document.items(entry).nth(2).filter(|_| rows[2] != [0.0, 0.0, 1.0]) {
            return Err(Fault::new(last, format!("{:?}", rows[2]), "[0, 0, 1], the last row of an affine map"));
        }
        let column = |column: usize| DVec2::new(rows[0][column], rows[1][column]);
        Ok((DMat2::from_cols(column(0), column(1)), column(2)))
    }

    /// The map of a list of steps.
    pub(super) fn steps(&self, entry: Entry) -> Checked<Transform> {
        let mut all = Transform::identity();
        for step in self.document.items(entry) {
            all = self.accept(step, all.then(&self.step(step)?))?;
        }
        Ok(all)
    }

    fn step(&self, step: Entry) -> Checked<Transform> {
        let (field, value) = kind_of(self.document, step, STEP_KINDS, &[], "a transform step")?;
        match field.key {
            "translate" => self.accept(value, Transform::translation(self.vector(value)?)),
            "rotate" => self.turn(value),
            "scale" => self.accept(value, Transform::scale(DVec3::from_array(self.scale(value)?))),
            "mirror" => self.accept(value, Transform::mirror(self.vector(value)?)),
            _ => self.matrix(value),
        }
    }

    /// The turn of a vector of angles about x, then y, then z, or about an axis.
    fn turn(&self, entry: Entry) -> Checked<Transform> {
        if let Some(axis) = self.document.member(entry, "axis") {
            let angle = self.document.member(entry, "angle").map_or(Ok(0.0), |angle| self.number(angle))?;
            return self.accept(axis, Transform::rotation(self.vector(axis)?, angle));
        }
        let mut all = Transform::identity();
        for (axis, angle) in DVec3::AXES.into_iter().zip(self.array::<3>(entry)?) {
            let turn = self.accept(entry, Transform::rotation(axis, angle))?;
            all = self.accept(entry, all.then(&turn))?;
        }
        Ok(all)
    }

    /// The map to a place of an instance.
    pub(super) fn place(&self, entry: Entry) -> Checked<Transform> {
        match place_of(self.document, entry) {
            Some(PlaceForm::Point) => self.accept(entry, Transform::translation(self.vector(entry)?)),
            Some(PlaceForm::Steps) => self.steps(entry),
            Some(PlaceForm::Matrix) | None => {
                let matrix = self.document.member(entry, "matrix");
                matrix.map_or_else(|| self.document.refuse(entry, "a place"), |matrix| self.matrix(matrix))
            }
        }
    }

    /// The result, or a fault of `entry`.
    pub(super) fn accept<T, E: std::fmt::Display>(&self, entry: Entry, result: Result<T, E>) -> Checked<T> {
        result.map_err(|error| Fault::new(entry, error.to_string(), "an invertible map of finite numbers"))
    }
}
