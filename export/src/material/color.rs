//! Colours of materials.

use planecut_csg::Material;

/// Linear RGB base colour of a material, each channel from 0 to 1: the stated one, or one derived from the name.
///
/// The derived colour depends on the name alone, so a material looks the same in every file and on every run.
#[must_use]
pub fn material_color(material: &Material) -> [f32; 3] {
    match material.color {
        Some(color) => color.map(|channel| if channel.is_nan() { 0.0 } else { channel.clamp(0.0, 1.0) }),
        None => name_color(&material.name),
    }
}

/// A muted colour of medium lightness: names differ in hue, and a little in saturation and lightness.
fn name_color(name: &str) -> [f32; 3] {
    let hash = fnv1a(name.as_bytes());
    let unit = |shift: u32| ((hash >> shift) & 0xffff) as f32 / 65535.0;
    let (hue, saturation, lightness) = (unit(0), 0.22 + 0.26 * unit(16), 0.56 + 0.16 * unit(32));
    let chroma = (1.0 - (2.0 * lightness - 1.0).abs()) * saturation;
    ramps(hue).map(|ramp| srgb_to_linear(lightness + chroma * (ramp - 0.5)))
}

/// A colour for a number, linear RGB: numbers that follow one another have hues that are far apart, and differ in lightness.
#[must_use]
pub fn distinct_color(number: usize) -> [f32; 3] {
    const GOLDEN_RATIO: f64 = 0.618_033_988_749_895;
    let hue = (number as f64 * GOLDEN_RATIO).fract() as f32;
    let lightness = [0.42, 0.3, 0.52][number % 3];
    ramps(hue).map(|ramp| (lightness + 0.42 * (ramp - 0.5)).clamp(0.02, 1.0))
}

/// How much of red, green and blue there is in a pure hue, each from 0 to 1.
fn ramps(hue: f32) -> [f32; 3] {
    [0.0, 2.0 / 3.0, 1.0 / 3.0].map(|offset| (((hue + offset).fract() * 6.0 - 3.0).abs() - 1.0).clamp(0.0, 1.0))
}

/// 64-bit FNV-1a with a final mix, so that names which differ in their last letter differ in hue.
fn fnv1a(bytes: &[u8]) -> u64 {
    let hash =
        bytes.iter().fold(0xcbf2_9ce4_8422_2325_u64, |hash, &b| (hash ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3));
    let mixed = (hash ^ (hash >> 33)).wrapping_mul(0xff51_afd7_ed55_8ccd);
    mixed ^ (mixed >> 33)
}

/// The sRGB transfer function (IEC 61966-2-1), display to linear.
pub(crate) fn srgb_to_linear(value: f32) -> f32 {
    if value <= 0.040_45 { value / 12.92 } else { libm::powf((value + 0.055) / 1.055, 2.4) }
}

/// The sRGB transfer function (IEC 61966-2-1), linear to display.
pub(crate) fn linear_to_srgb(value: f32) -> f32 {
    if value <= 0.003_130_8 { value * 12.92 } else { 1.055 * libm::powf(value, 1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derived_colours_are_muted_and_differ() {
        let colors: Vec<_> = (0..200).map(|i| name_color(&format!("wall{i}"))).collect();
        for color in &colors {
            let display = color.map(linear_to_srgb);
            let (low, high) = display.iter().fold((1.0_f32, 0.0_f32), |(l, h), &v| (l.min(v), h.max(v)));
            assert!(low > 0.3 && high < 0.9, "{display:?} is too dark or too bright");
        }
        let mut distinct: Vec<_> = colors.iter().map(|c| c.map(f32::to_bits)).collect();
        distinct.sort_unstable();
        distinct.dedup();
        assert_eq!(distinct.len(), colors.len());
    }

    #[test]
    fn a_stated_colour_is_kept_within_range() {
        let material = Material { color: Some([0.25, 2.0, f32::NAN]), ..Material::named("m") };
        assert_eq!(material_color(&material), [0.25, 1.0, 0.0]);
    }

    #[test]
    fn transfer_functions_are_inverse() {
        for step in 0..=255_u8 {
            let value = f32::from(step) / 255.0;
            assert!((linear_to_srgb(srgb_to_linear(value)) - value).abs() < 1e-6);
        }
    }
}
