//! Copies of a node: how many, and where.

use planecut_csg::Transform;

use super::MAX_BRUSHES;
use super::body::Maker;
use super::error::{Checked, Fault};

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

/// Where the copies go; there are at most [`MAX_BRUSHES`].
///
/// # Errors
/// [`Fault`] of a number without a value; each place may have one as well.
pub(super) fn places<'m>(
    maker: &'m Maker<'_, '_>,
    kind: &str,
) -> Checked<Box<dyn Iterator<Item = Checked<Transform>> + 'm>> {
    let Maker { values, value, .. } = *maker;
    let count = maker.member("count");
    match kind {
        "ring" => {
            let angle = maker.optional("angle")?.unwrap_or(360.0);
            let count = count.map_or(Ok(1), |count| values.whole(count, 1, MAX_BRUSHES as u32))?;
            let turn = move |k| Transform::rotation(glam::DVec3::Z, angle * f64::from(k) / f64::from(count));
            Ok(Box::new((0..count).map(move |k| values.accept(value, turn(k)))))
        }
        "array" => {
            let counts = count.map_or(Ok([1.0; 3]), |counts| values.array::<3>(counts))?.map(|count| count as u32);
            let step = maker.member("step").map_or(Ok(glam::DVec3::ZERO), |step| values.vector(step))?;
            let [x, y, z] = counts;
            let cells =
                (0..z).flat_map(move |k| (0..y).flat_map(move |j| (0..x).map(move |i| [i, j, k].map(f64::from))));
            let shift = move |cell: [f64; 3]| Transform::translation(step * glam::DVec3::from_array(cell));
            Ok(Box::new(cells.map(move |cell| values.accept(value, shift(cell)))))
        }
        _ => {
            let at = maker.member("at").unwrap_or(value);
            Ok(Box::new(values.document.items(at).map(move |place| values.place(place))))
        }
    }
}
