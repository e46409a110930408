//! Copies of a node: how many, and where.

use glam::DVec3;
use planecut_csg::Transform;

use super::body::Maker;
use super::error::{Checked, Fault};
use super::json::Entry;
use super::values::Values;

/// How many copies there will be.
///
/// # Errors
/// [`Fault`] of a number that counts nothing.
pub(super) fn count_of_copies(maker: &Maker<'_, '_>, kind: &str) -> Checked<f64> {
    let counts = maker.member("count");
    let whole = |entry| {
        let value = maker.values.number(entry)?;
        if value >= 1.0 && value.fract() == 0.0 {
            return Ok(value);
        }
        Err(Fault::new(entry, maker.values.describe_number(entry), "a whole number of at least 1"))
    };
    match (kind, counts) {
        ("ring", Some(count)) => whole(count),
        ("array", Some(counts)) => {
            maker.values.document.items(counts).map(whole).try_fold(1.0, |product, count| Ok(product * count?))
        }
        _ => Ok(maker.member("at").map_or(0, |at| maker.values.document.items(at).count()) as f64),
    }
}

/// Where copies go.
#[derive(Debug)]
pub(super) enum Places {
    /// By turns about z; the value that says so, for its errors.
    Ring { value: Entry, angle: f64, count: u64 },
    /// By steps along the axes, x first.
    Grid { value: Entry, counts: [u64; 3], step: DVec3 },
    /// One by one.
    Listed(Vec<Entry>),
}

/// Where the copies go; how many there are was [counted](count_of_copies), and is no more than can be told apart.
///
/// # Errors
/// [`Fault`] of a number without a value.
pub(super) fn places(maker: &Maker<'_, '_>, kind: &str) -> Checked<Places> {
    let Maker { values, value, .. } = *maker;
    let count = maker.member("count");
    Ok(match kind {
        "ring" => {
            let angle = maker.optional("angle")?.unwrap_or(360.0);
            let count = count.map_or(Ok(1.0), |count| values.number(count))? as u64;
            Places::Ring { value, angle, count }
        }
        "array" => {
            let counts = count.map_or(Ok([1.0; 3]), |counts| values.array::<3>(counts))?.map(|count| count as u64);
            let step = maker.member("step").map_or(Ok(DVec3::ZERO), |step| values.vector(step))?;
            Places::Grid { value, counts, step }
        }
        _ => Places::Listed(values.document.items(maker.member("at").unwrap_or(value)).collect()),
    })
}

impl Places {
    /// How many there are.
    pub(super) fn count(&self) -> u64 {
        match self {
            Self::Ring { count, .. } => *count,
            Self::Grid { counts: [x, y, z], .. } => x * y * z,
            Self::Listed(places) => places.len() as u64,
        }
    }

    /// The map to one of them.
    ///
    /// # Errors
    /// [`Fault`] of a place without a map.
    pub(super) fn at(&self, values: &Values<'_, '_>, place: u64) -> Checked<Transform> {
        match self {
            Self::Ring { value, angle, count } => {
                values.accept(*value, Transform::rotation(DVec3::Z, angle * place as f64 / *count as f64))
            }
            Self::Grid { value, counts: [x, y, _], step } => {
                let cell = [place % x, place / x % y, place / x / y].map(|k| k as f64);
                values.accept(*value, Transform::translation(step * DVec3::from_array(cell)))
            }
            Self::Listed(places) => values.place(places[place as usize]),
        }
    }
}
