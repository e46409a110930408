//! Bodies to write, readers to read them back, and what to compare.

use planecut_csg::{Brush, Material, Model};
use planecut_export::{BrushFormat, write_brushes};
use planecut_import::map::{MapOptions, read_map};
use planecut_import::scad::{ScadOptions, read_scad};
use planecut_kernel::{DVec3, IncrementalPolytope};

/// The text of bodies.
pub(crate) fn written(brushes: &[Brush], materials: &[Material], format: BrushFormat, scale: f64) -> String {
    let mut text = Vec::new();
    write_brushes(brushes, materials, format, scale, &mut text).expect("written");
    String::from_utf8(text).expect("UTF-8")
}

/// What the reader makes of a text, which it has to take without a warning.
pub(crate) fn read(text: &str, format: BrushFormat) -> Model {
    let (model, warnings) = match format {
        BrushFormat::Map => {
            let import = read_map(text.as_bytes(), "written.map", &MapOptions::default());
            import.map(|import| (import.model, import.warnings)).unwrap_or_else(|error| panic!("{error}"))
        }
        BrushFormat::Scad => {
            let import = read_scad(text.as_bytes(), "written.csg", &ScadOptions::default());
            import.map(|import| (import.model, import.warnings)).unwrap_or_else(|error| panic!("{error}"))
        }
    };
    assert_eq!(warnings, [], "{format:?}");
    model
}

/// Bodies after they were written and read.
pub(crate) fn back(brushes: &[Brush], format: BrushFormat, scale: f64) -> Vec<Brush> {
    let materials = [Material::named("stone"), Material::named("wood")];
    read(&written(brushes, &materials, format, scale), format).tree.brushes().to_vec()
}

/// The body of a brush, without a tolerance.
pub(crate) fn body(brush: &Brush) -> IncrementalPolytope {
    let mut polytope = IncrementalPolytope::with_epsilon(0.0);
    for face in &brush.faces {
        polytope.add_plane(face.half_space);
    }
    polytope
}

/// The volume of a bounded body; 0 where it is empty.
pub(crate) fn volume(body: &IncrementalPolytope) -> f64 {
    if body.is_empty() { 0.0 } else { body.measures().expect("a bounded body").volume }
}

/// A body's largest coordinate, by magnitude, and about how thick it is.
pub(crate) fn extent(body: &IncrementalPolytope) -> (f64, f64) {
    let reach = body.to_mesh().0.iter().map(|corner| corner.abs().max_element()).fold(0.0, f64::max);
    let widest = body.planes().filter_map(|(plane, _)| body.face_area(plane)).fold(0.0, f64::max);
    (reach, 3.0 * volume(body) / widest)
}

/// The corners of each face, by plane.
pub(crate) fn polygons(body: &IncrementalPolytope) -> Vec<Vec<DVec3>> {
    body.planes().filter_map(|(plane, _)| body.face_polygon(plane)).map(|polygon| polygon.corners).collect()
}
