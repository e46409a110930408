//! The sRGB transfer function (IEC 61966-2-1). Powers are those of a crate, not of the system: pictures are the same on all machines.

/// From display values to linear light, both from 0 to 1.
pub(crate) fn srgb_to_linear(value: f32) -> f32 {
    if value <= 0.040_45 { value / 12.92 } else { libm::powf((value + 0.055) / 1.055, 2.4) }
}

/// From linear light to display values, both from 0 to 1.
pub(crate) fn linear_to_srgb(value: f32) -> f32 {
    if value <= 0.003_130_8 { value * 12.92 } else { 1.055 * libm::powf(value, 1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn transfer_functions_are_inverse() {
        for step in 0..=255_u8 {
            let value = f32::from(step) / 255.0;
            assert!((linear_to_srgb(srgb_to_linear(value)) - value).abs() < 1e-6);
        }
    }
}
