//! Measures of a live model as they are answered.

use crate::csg::{EvaluateError, LiveModel, Material};
use serde_json::{Map, Value, json};

use super::answer::keys;

/// Volume, area, centroid and box of the solid, the area of each material and, where it is asked for, its volume, and counts.
pub(super) fn measures(live: &mut LiveModel, with_volumes: bool) -> Result<Map<String, Value>, EvaluateError> {
    let solid = live.measures();
    let areas = live.areas_of_materials();
    let volumes = if with_volumes { live.volumes_of_materials()? } else { Vec::new() };
    let material = |(k, (material, area)): (usize, (&Material, &f64))| {
        let mut entry = json!({"name": material.name, "area": area});
        if let Some(volume) = volumes.get(k) {
            entry["volume"] = json!(volume);
        }
        entry
    };
    let materials: Vec<Value> = live.materials().iter().zip(&areas).enumerate().map(material).collect();
    let faces = live.faces().count();
    let of_solid = |value: [f64; 3]| (faces > 0).then_some(value);
    Ok(keys(json!({
        "volume": solid.volume,
        "area": solid.area,
        "centroid": of_solid(solid.centroid.to_array()),
        "min": of_solid(solid.min.to_array()),
        "max": of_solid(solid.max.to_array()),
        "materials": materials,
        "brushes": live.brushes().len(),
        "faces": faces,
        "triangles": live.triangle_count(),
    })))
}
