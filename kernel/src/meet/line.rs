//! The lines in which planes meet: their coordinates and directions.

use dashu_int::IBig;
use glam::DVec3;

use super::rounded_quotients;
use crate::arithmetic::{big_cross, big_integers, round_quotient, unit_vector};
use crate::sign::{Row, minor};

/// What tells the line of two planes from all others, each number correctly rounded: its slopes against the coordinate `axis`
/// in the two coordinates after it in cyclic order, and these coordinates of the point at which `axis` is zero.
///
/// `None` where the line is perpendicular to the axis, or there is none.
#[must_use]
pub fn line_coordinates(a: &Row, b: &Row, axis: usize) -> Option<[f64; 4]> {
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    // the numerators, and last the denominator of all
    let columns = [(v, axis), (axis, u), (3, v), (u, 3), (u, v)];
    line_coordinates_in_double_doubles(a, b, columns).or_else(|| {
        let [p, q] = [a, b].map(|row| big_integers(*row.coefficients()));
        let minors = columns.map(|(i, j)| &p[i] * &q[j] - &p[j] * &q[i]);
        let [x, y, z, w, denominator] = minors;
        (!denominator.is_zero()).then(|| [x, y, z, w].map(|numerator| round_quotient(numerator, &denominator)))
    })
}

/// `None` where some number cannot be rounded with certainty.
fn line_coordinates_in_double_doubles(a: &Row, b: &Row, columns: [(usize, usize); 5]) -> Option<[f64; 4]> {
    let (a, b) = (a.coefficients(), b.coefficients());
    let permanents = columns.map(|(i, j)| (a[i] * b[j]).abs() + (a[j] * b[i]).abs());
    // outside this range the low words could underflow
    if permanents.iter().any(|p| *p != 0.0 && !(1e-200..=1e200).contains(p)) {
        return None;
    }
    let [x, y, z, w, denominator] = columns.map(|(i, j)| minor(a, b, i, j));
    rounded_quotients([x, y, z, w], denominator, |k| permanents[k], permanents[4])
}

/// The unit direction of `nₐ × n_b`, off by a few roundings; zero where the normals are parallel.
#[must_use]
pub fn line_direction(a: &Row, b: &Row) -> DVec3 {
    let (p, q) = (a.coefficients(), b.coefficients());
    let columns = [(1, 2), (2, 0), (0, 1)];
    let cross = columns.map(|(u, v)| minor(p, q, u, v).high);
    let permanent = columns.map(|(u, v)| (p[u] * q[v]).abs() + (p[v] * q[u]).abs()).into_iter().fold(0.0, f64::max);
    let cross = DVec3::from_array(cross);
    let largest = cross.abs().max_element();
    // within this range nothing underflows, and the error is far below the last place
    if permanent > 1e-200 && largest > permanent * 1e-12 { (cross / largest).normalize() } else { direction(a, b) }
}

/// The same, each component accurate to a few roundings of its own.
#[must_use]
pub(crate) fn direction(a: &Row, b: &Row) -> DVec3 {
    unit_vector(&big_cross_of([a, b]))
}

/// The unit direction of `(nₐ × n_b) × (n_c × n_d)`, each component accurate to a few roundings of its own, for pairs `a, b` and `c, d`;
/// zero where it is. It is perpendicular to both lines, however small the angle between them.
#[must_use]
pub fn direction_across([first, second]: [[&Row; 2]; 2]) -> DVec3 {
    let vector = |pair| {
        let [x, y, z] = big_cross_of(pair);
        [x, y, z, IBig::ZERO]
    };
    unit_vector(&big_cross(&vector(first), &vector(second)))
}

fn big_cross_of(pair: [&Row; 2]) -> [IBig; 3] {
    let [a, b] = pair.map(|row| big_integers(*row.coefficients()));
    big_cross(&a, &b)
}
