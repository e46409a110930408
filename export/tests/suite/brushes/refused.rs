//! What cannot be written is refused, and the message says what it is.

use std::io;
use std::path::Path;

use planecut_csg::{Brush, Material, MaterialId};
use planecut_export::{BrushFormat, ExportError, write_brushes};
use planecut_kernel::DVec3;

use crate::full_disk::Full;

fn cube() -> Brush {
    Brush::cuboid(DVec3::ZERO, DVec3::ONE, MaterialId(0))
}

/// The error of writing brushes with one material, which is one line.
fn error(brushes: &[Brush], scale: f64, format: BrushFormat) -> ExportError {
    let result = write_brushes(brushes, &[Material::named("t")], format, scale, &mut Vec::new());
    let error = result.expect_err("refused");
    assert!(!error.to_string().contains('\n'), "{error}");
    error
}

#[test]
fn unbounded_brushes_are_named_by_number() {
    for format in BrushFormat::ALL {
        for (number, missing) in [(0, 0), (2, 3), (600, 5)] {
            let mut brushes = vec![cube(); number + 1];
            brushes[number].faces.remove(missing);
            // the first one counts, whichever thread is done first
            brushes.push(Brush::default());
            let error = error(&brushes, 1.0, format);
            assert!(matches!(error, ExportError::Unbounded { brush } if brush == number), "{error}");
            assert!(error.to_string().contains(&number.to_string()), "{error}");
        }
    }
}

#[test]
fn unknown_materials_are_named() {
    for format in BrushFormat::ALL {
        let mut brush = cube();
        brush.faces[4].material = MaterialId(1);
        let error = error(&[cube(), brush], 1.0, format);
        assert!(matches!(error, ExportError::UnknownMaterial { brush: 1, material: 1, count: 1 }), "{error}");
    }
}

#[test]
fn scales_and_coordinates_out_of_range_are_refused() {
    for format in BrushFormat::ALL {
        for scale in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-40, 1e40] {
            assert!(matches!(error(&[cube()], scale, format), ExportError::Scale(_)));
        }
        let far = Brush::cuboid(DVec3::ZERO, DVec3::splat(1e20), MaterialId(0));
        let error = error(&[cube(), far], 1e15, format);
        assert!(matches!(error, ExportError::BrushRange { brush: 1, .. }), "{error}");
    }
}

#[test]
fn errors_of_the_output_are_passed_on() {
    for format in BrushFormat::ALL {
        let mut text = Vec::new();
        write_brushes(&[cube()], &[Material::named("t")], format, 1.0, &mut text).expect("written");
        for room in 0..text.len() {
            let result = write_brushes(&[cube()], &[Material::named("t")], format, 1.0, &mut Full(room));
            let error = result.expect_err("full");
            assert!(
                matches!(&error, ExportError::Io(source) if source.kind() == io::ErrorKind::StorageFull),
                "{error}"
            );
            assert!(error.to_string().starts_with("cannot write: "), "{error}");
        }
    }
}

#[test]
fn endings_are_recognised_in_any_case() {
    for format in BrushFormat::ALL {
        let name = format!("dir.x/a.{}", format.extension().to_uppercase());
        assert_eq!(BrushFormat::from_path(Path::new(&name)).expect("known"), format);
    }
    for name in ["a", "a.", "a.glb", ".map", "csg"] {
        let error = BrushFormat::from_path(Path::new(name)).expect_err(name);
        assert!(matches!(error, ExportError::UnknownBrushFormat { .. }), "{error}");
    }
}
