//! Colours of triangles as materials.

use planecut_csg::Material;
use rustc_hash::FxHashMap;

use super::IndexedMesh;

/// Most colours that are kept apart; where there are more, they are rounded.
const MAX_COLORS: usize = 4096;
/// Bits of a channel that are left then.
const ROUNDED_BITS: u32 = 5;

/// A colour on the linear scale of light, each channel from 0 to 1.
pub(crate) type Color = [f32; 3];

/// A colour as a screen shows it, from 0 to 255.
type ScreenColor = [u8; 3];

impl IndexedMesh {
    /// The same with materials for its [`colors`](Self::colors), of which none are left; and what is to be said of colours that were rounded.
    ///
    /// A triangle of a colour and no material gets a material that is named after the colour as screens show it, `#rrggbb`. Where it has a
    /// material, too, the colour is multiplied with that of the material, and named after both; white changes nothing.
    #[must_use]
    pub fn painted(mut self) -> (Self, Option<String>) {
        let colors = std::mem::take(&mut self.colors);
        if colors.iter().all(Option::is_none) {
            return (self, None);
        }
        self.material_of.resize(self.triangles.len(), None);
        let (shown, warning) = shown(&colors);
        let mut known: FxHashMap<(Option<u32>, ScreenColor), u32> = FxHashMap::default();
        for (material, color) in self.material_of.iter_mut().zip(shown) {
            let Some(color) = color.filter(|color| material.is_none() || *color != [u8::MAX; 3]) else { continue };
            let number = known.entry((*material, color)).or_insert_with(|| {
                let base = material.map(|material| self.materials[material as usize].clone());
                self.materials.push(painted_material(base, color));
                self.materials.len() as u32 - 1
            });
            *material = Some(*number);
        }
        (self, warning)
    }
}

/// A material in a colour.
fn painted_material(base: Option<Material>, color: ScreenColor) -> Material {
    let [red, green, blue] = color;
    let name = format!("#{red:02x}{green:02x}{blue:02x}");
    let linear = color.map(|channel| linear(f64::from(channel) / 255.0));
    match base {
        None => Material { color: Some(linear), ..Material::named(name) },
        Some(base) => {
            let own = base.color.unwrap_or([1.0; 3]);
            let color = Some([0, 1, 2].map(|k| own[k] * linear[k]));
            Material { color, name: format!("{} {name}", base.name), ..base }
        }
    }
}

/// Colours as screens show them, rounded further where there are too many.
fn shown(colors: &[Option<Color>]) -> (Vec<Option<ScreenColor>>, Option<String>) {
    let mut shown: Vec<Option<ScreenColor>> =
        colors.iter().map(|color| color.map(|color| color.map(on_screen))).collect();
    let distinct = |shown: &[Option<ScreenColor>]| {
        let mut distinct: Vec<ScreenColor> = shown.iter().flatten().copied().collect();
        distinct.sort_unstable();
        distinct.dedup();
        distinct.len()
    };
    let count = distinct(&shown);
    if count <= MAX_COLORS {
        return (shown, None);
    }
    let round = |channel: u8| {
        let kept = channel >> (8 - ROUNDED_BITS);
        (kept << (8 - ROUNDED_BITS)) | (kept >> (2 * ROUNDED_BITS - 8))
    };
    shown.iter_mut().flatten().for_each(|color| *color = color.map(round));
    let left = distinct(&shown);
    let message = format!("found {count} colours, rounded them to {ROUNDED_BITS} bits a channel, which leaves {left}");
    (shown, Some(message))
}

/// The mean of the colours of a triangle's corners, where all have one.
pub(super) fn mean(corners: [Option<Color>; 3]) -> Option<Color> {
    let [a, b, c] = corners;
    let (a, b, c) = (a?, b?, c?);
    // exact where all are the same
    let channel = |k: usize| if a[k] == b[k] && b[k] == c[k] { a[k] } else { (a[k] + b[k] + c[k]) / 3.0 };
    Some([0, 1, 2].map(channel))
}

/// A channel on the linear scale of light, from the sRGB scale of screens (IEC 61966-2-1); both from 0 to 1.
pub(crate) fn linear(channel: f64) -> f32 {
    let channel = if channel.is_nan() { 0.0 } else { channel.clamp(0.0, 1.0) };
    let linear = if channel <= 0.04045 { channel / 12.92 } else { ((channel + 0.055) / 1.055).powf(2.4) };
    linear as f32
}

/// A channel as a screen shows it.
fn on_screen(channel: f32) -> u8 {
    let channel = if channel.is_nan() { 0.0 } else { f64::from(channel).clamp(0.0, 1.0) };
    let shown = if channel <= 0.003_130_8 { channel * 12.92 } else { 1.055 * channel.powf(1.0 / 2.4) - 0.055 };
    (shown * 255.0).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use planecut_shapes::polyhedron::Precision;

    #[test]
    fn every_colour_of_a_screen_comes_back() {
        for channel in 0..=u8::MAX {
            assert_eq!(on_screen(linear(f64::from(channel) / 255.0)), channel);
        }
    }

    fn mesh(colors: Vec<Option<Color>>) -> IndexedMesh {
        let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
        let triangles = vec![[0, 1, 2]; colors.len()];
        IndexedMesh { colors, ..IndexedMesh::plain(positions, triangles, Precision::Double) }
    }

    #[test]
    fn colours_are_materials_of_their_own_or_shades_of_others() {
        let (red, white) = ([1.0, 0.0, 0.0], [1.0; 3]);
        let brass = Material { color: Some([0.5, 0.5, 0.25]), metallic: Some(1.0), ..Material::named("brass") };
        let mesh = IndexedMesh {
            materials: vec![brass.clone()],
            material_of: vec![None, Some(0), Some(0), None, None],
            ..mesh(vec![Some(red), Some(red), Some(white), Some(white), None])
        };
        let (painted, warning) = mesh.painted();
        assert_eq!(warning, None);
        assert_eq!(painted.material_of, [Some(1), Some(2), Some(0), Some(3), None]);
        let names: Vec<&str> = painted.materials.iter().map(|material| material.name.as_str()).collect();
        assert_eq!(names, ["brass", "#ff0000", "brass #ff0000", "#ffffff"]);
        assert_eq!(painted.materials[2].color, Some([0.5, 0.0, 0.0]));
        assert_eq!(painted.materials[2].metallic, Some(1.0));
    }

    #[test]
    fn too_many_colours_are_rounded() {
        let color = |k: u32| [k & 255, k >> 8, 0].map(|channel| linear(f64::from(channel) / 255.0));
        let of = |count: u32| mesh((0..count).map(|k| Some(color(k))).collect()).painted();
        let (kept, warning) = of(MAX_COLORS as u32);
        assert_eq!((kept.materials.len(), warning), (MAX_COLORS, None));
        let (rounded, warning) = of(1 << 16);
        assert_eq!(rounded.materials.len(), 1 << 10);
        assert_eq!(
            warning.as_deref(),
            Some("found 65536 colours, rounded them to 5 bits a channel, which leaves 1024")
        );
        let ends = [rounded.materials[0].name.as_str(), rounded.materials[1023].name.as_str()];
        assert_eq!(ends, ["#000000", "#ffff00"]);
    }
}
