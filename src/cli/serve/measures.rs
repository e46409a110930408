//! Measures of a live model, from the triangles of its faces: here is the one place for what measures it faster.

use planecut::csg::LiveModel;
use planecut::kernel::DVec3;
use serde_json::{Map, Value, json};

use super::answer::keys;

/// Volume, area and box of the solid, the area of each material, and counts.
pub(super) fn measures(live: &LiveModel) -> Map<String, Value> {
    let mut areas = vec![0.0; live.materials().len()];
    let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let mut origin = None;
    let (mut six_volumes, mut faces) = (0.0, 0);
    for (_, face) in live.faces() {
        faces += 1;
        for corners in face.triangles() {
            let corners = corners.map(|corner| corner.1);
            let origin = *origin.get_or_insert(corners[0]);
            let [a, b, c] = corners.map(|corner| corner - origin);
            six_volumes += a.dot(b.cross(c));
            areas[face.material().0 as usize] += (b - a).cross(c - a).length() / 2.0;
            (min, max) = corners.iter().fold((min, max), |(min, max), corner| (min.min(*corner), max.max(*corner)));
        }
    }
    let materials =
        live.materials().iter().zip(&areas).map(|(material, area)| json!({"name": material.name, "area": area}));
    let bounds = (faces > 0).then(|| [min.to_array(), max.to_array()]);
    keys(json!({
        "volume": six_volumes / 6.0,
        "area": areas.iter().sum::<f64>(),
        "min": bounds.map(|bounds| bounds[0]),
        "max": bounds.map(|bounds| bounds[1]),
        "materials": materials.collect::<Vec<Value>>(),
        "brushes": live.brushes().len(),
        "faces": faces,
        "triangles": live.triangle_count(),
    }))
}
