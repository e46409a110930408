//! Colours as materials.

use planecut_csg::{Material, MaterialId};
use rustc_hash::FxHashMap;

use crate::mesh::colors::linear;

/// What OpenSCAD shows solids without a colour in.
const UNCOLORED: [f64; 3] = [249.0 / 255.0, 215.0 / 255.0, 44.0 / 255.0];

/// The materials of a tree, one for each colour.
pub(super) struct Materials {
    all: Vec<Material>,
    by_name: FxHashMap<String, MaterialId>,
}

impl Materials {
    /// The material of what has no colour.
    pub(super) const UNCOLORED: MaterialId = MaterialId(0);

    pub(super) fn new() -> Self {
        let material = Material { color: Some(UNCOLORED.map(linear)), ..Material::named("uncolored") };
        Self { all: vec![material], by_name: FxHashMap::default() }
    }

    /// The material of a colour, red, green, blue and opacity from 0 to 1 as a screen shows them. It is named after the
    /// colour, `#rrggbb`, with two digits more where it is not opaque.
    pub(super) fn of_color(&mut self, color: [f64; 4]) -> MaterialId {
        let [red, green, blue, opacity] = color.map(|part| (part.clamp(0.0, 1.0) * 255.0).round() as u8);
        let mut name = format!("#{red:02x}{green:02x}{blue:02x}");
        if opacity != u8::MAX {
            name += &format!("{opacity:02x}");
        }
        let next = MaterialId(u32::try_from(self.all.len()).unwrap_or(u32::MAX));
        let id = *self.by_name.entry(name.clone()).or_insert(next);
        if id == next {
            let color = [color[0], color[1], color[2]].map(linear);
            self.all.push(Material { color: Some(color), ..Material::named(name) });
        }
        id
    }

    pub(super) fn into_all(self) -> Vec<Material> {
        self.all
    }
}
