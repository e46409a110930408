//! What the writers of text formats share: numbers and names.

use std::io::Write;

use planecut_csg::Material;
use rustc_hash::FxHashSet;

/// The shortest decimal that reads back as `value`.
pub(crate) fn push_decimal(text: &mut Vec<u8>, value: f64) {
    const WRITES: &str = "a byte vector takes every write";
    // Grid coordinates are the common case, and an integer is several times faster to print.
    if value.fract() == 0.0 && value.abs() < 1e15 {
        let magnitude = value.abs() as u64;
        if value < 0.0 {
            text.push(b'-');
        }
        push_digits(text, magnitude);
    } else if (1e-5..1e17).contains(&value.abs()) {
        write!(text, "{value}").expect(WRITES);
    } else {
        write!(text, "{value:e}").expect(WRITES);
    }
}

/// The digits of an integer.
pub(crate) fn push_digits(text: &mut Vec<u8>, mut value: u64) {
    let mut digits = [b'0'; 20];
    let mut start = digits.len();
    loop {
        start -= 1;
        digits[start] = b'0' + (value % 10) as u8;
        value /= 10;
        if value == 0 {
            break;
        }
    }
    text.extend_from_slice(&digits[start..]);
}

/// A name for each material, each one once: what `token` makes of the material's own, numbered where that is taken.
pub(crate) fn unique_names(materials: &[Material], token: impl Fn(&str) -> String) -> Vec<String> {
    let mut taken = FxHashSet::default();
    let mut unique = |wanted: String| {
        let mut name = wanted.clone();
        let mut copy = 2;
        while !taken.insert(name.clone()) {
            name = format!("{wanted}_{copy}");
            copy += 1;
        }
        name
    };
    materials.iter().map(|material| unique(token(&material.name))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimals_read_back_as_the_same_number() {
        let mut state = 0x9e37_79b9_7f4a_7c15_u64;
        let random = std::iter::repeat_with(|| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            f64::from_bits(state ^ (state >> 29))
        });
        let chosen = [0.0, 1.0, -1.0, 0.1, -2.5, 1e15, -1e15, 999_999_999_999_999.0, 1e17, 1e-5, 5e-324, f64::MAX];
        for value in chosen.into_iter().chain(random.take(10_000)).filter(|v| v.is_finite()) {
            let mut text = Vec::new();
            push_decimal(&mut text, value);
            let text = String::from_utf8(text).expect("ASCII");
            assert_eq!(text.parse::<f64>().expect("a number").to_bits(), value.to_bits(), "{text}");
        }
    }
}
