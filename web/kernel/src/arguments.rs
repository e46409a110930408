//! What comes in as flat arrays of numbers, checked.

use planecut::csg::outline::Outline;
use planecut::csg::{Material, Transform};
use planecut::expression::DEFAULT_MATERIAL;
use planecut::kernel::{DMat3, DVec2, DVec3, HalfSpace};
use serde::de::DeserializeOwned;

use crate::failure::{Failure, Outcome};

/// The largest integer up to which all have numbers of their own in JavaScript.
const MAX_SAFE_INTEGER: f64 = 9_007_199_254_740_991.0;

/// As many numbers as an array has; all of them finite.
fn row<const N: usize>(values: &[f64], name: &str) -> Outcome<[f64; N]> {
    let row = <[f64; N]>::try_from(values)
        .map_err(|_| Failure::of(format!("{name}: found {} numbers, expected {N}", values.len())))?;
    match row.iter().find(|value| !value.is_finite()) {
        Some(found) => Err(Failure::of(format!("{name}: found {found}, expected finite numbers"))),
        None => Ok(row),
    }
}

/// Rows of as many numbers each.
fn rows<const N: usize>(values: &[f64], name: &str) -> Outcome<Vec<[f64; N]>> {
    let (rows, rest) = values.as_chunks::<N>();
    if !rest.is_empty() {
        let found = values.len();
        return Err(Failure::of(format!("{name}: found {found} numbers, expected a multiple of {N}")));
    }
    match rows.as_flattened().iter().position(|value| !value.is_finite()) {
        Some(place) => {
            let found = values[place];
            Err(Failure::of(format!("{name}[{}]: found {found}, expected finite numbers", place / N)))
        }
        None => Ok(rows.to_vec()),
    }
}

/// A vector.
pub(crate) fn vector(values: &[f64], name: &str) -> Outcome<DVec3> {
    row::<3>(values, name).map(DVec3::from)
}

/// Points one after another.
pub(crate) fn points(values: &[f64], name: &str) -> Outcome<Vec<DVec3>> {
    Ok(rows::<3>(values, name)?.into_iter().map(DVec3::from).collect())
}

/// Half-spaces one after another, each by its normal and its offset.
pub(crate) fn half_spaces(values: &[f64], name: &str) -> Outcome<Vec<HalfSpace>> {
    let half_space = |(number, plane): (usize, [f64; 4])| {
        HalfSpace::from_array(plane).map_err(|error| Failure::of(format!("{name}[{number}]: {error}")))
    };
    rows::<4>(values, name)?.into_iter().enumerate().map(half_space).collect()
}

/// An affine map by three or four rows of four numbers.
pub(crate) fn transform(values: &[f64], name: &str) -> Outcome<Transform> {
    let rows = rows::<4>(values, name)?;
    let is_affine = rows.len() == 3 || rows.len() == 4 && rows[3] == [0.0, 0.0, 0.0, 1.0];
    if !is_affine {
        let found = rows.len();
        return Err(Failure::of(format!(
            "{name}: found {found} rows, expected 3, or 4 of which the last is 0, 0, 0, 1"
        )));
    }
    let column = |k: usize| DVec3::new(rows[0][k], rows[1][k], rows[2][k]);
    Transform::new(DMat3::from_cols(column(0), column(1), column(2)), column(3)).map_err(Failure::of)
}

/// Triangles by numbers of vertices, of which there are `count`.
pub(crate) fn triangles(values: &[u32], count: usize, name: &str) -> Outcome<Vec<[u32; 3]>> {
    let (triangles, rest) = values.as_chunks::<3>();
    if !rest.is_empty() {
        let found = values.len();
        return Err(Failure::of(format!("{name}: found {found} numbers, expected a multiple of 3")));
    }
    numbers_below(values, count, name)?;
    Ok(triangles.to_vec())
}

/// Checks that numbers stand for something of which there are `count`.
pub(crate) fn numbers_below(values: &[u32], count: usize, name: &str) -> Outcome<()> {
    match values.iter().find(|value| **value as usize >= count) {
        Some(found) => Err(Failure::of(format!("{name}: found {found}, expected numbers below {count}"))),
        None => Ok(()),
    }
}

/// The number of a brush, a plane or an operation.
pub(crate) fn number(value: f64, name: &str) -> Outcome<u64> {
    let is_one = value.fract() == 0.0 && (0.0..=MAX_SAFE_INTEGER).contains(&value);
    if is_one {
        Ok(value as u64)
    } else {
        Err(Failure::of(format!("{name}: found {value}, expected a number that counts, from 0")))
    }
}

/// Loops one after another: the coordinates of all corners, and how many corners each loop has.
pub(crate) fn outline(coordinates: &[f64], lengths: &[u32]) -> Outcome<Outline> {
    let corners: Vec<DVec2> = rows::<2>(coordinates, "outline")?.into_iter().map(DVec2::from).collect();
    let (mut loops, mut rest) = (Vec::new(), &corners[..]);
    for &length in lengths {
        let Some((own, others)) = rest.split_at_checked(length as usize) else {
            return Err(Failure::of(format!("outline: found {} corners, expected those of all loops", corners.len())));
        };
        loops.push(own.to_vec());
        rest = others;
    }
    Outline::from_loops(&loops).map_err(Failure::of)
}

/// A material by its name; without one what nobody has given a material.
pub(crate) fn material(name: Option<String>) -> Material {
    Material::named(name.unwrap_or_else(|| DEFAULT_MATERIAL.to_owned()))
}

/// Settings as a JSON object.
pub(crate) fn settings<T: DeserializeOwned>(text: &str) -> Outcome<T> {
    serde_json::from_str(text).map_err(|error| {
        // the place in a text that nobody wrote says nothing
        let message = error.to_string();
        Failure::of(format!("options: {}", message.split(" at line ").next().unwrap_or_default()))
    })
}
