//! Measures of a live model as they are answered.

use planecut::csg::LiveModel;
use serde_json::{Map, Value, json};

use super::answer::keys;

/// Volume, area, centroid and box of the solid, the area of each material, and counts.
pub(super) fn measures(live: &mut LiveModel) -> Map<String, Value> {
    let solid = live.measures();
    let areas = live.areas_of_materials();
    let materials =
        live.materials().iter().zip(&areas).map(|(material, area)| json!({"name": material.name, "area": area}));
    let materials: Vec<Value> = materials.collect();
    let faces = live.faces().count();
    let of_solid = |value: [f64; 3]| (faces > 0).then_some(value);
    keys(json!({
        "volume": solid.volume,
        "area": solid.area,
        "centroid": of_solid(solid.centroid.to_array()),
        "min": of_solid(solid.min.to_array()),
        "max": of_solid(solid.max.to_array()),
        "materials": materials,
        "brushes": live.brushes().len(),
        "faces": faces,
        "triangles": live.triangle_count(),
    }))
}
