//! 3MF (3D Manufacturing Format, core specification 1.3): a package with an object for each part and the materials' colours.
//!
//! Coordinates are the shortest decimals that read back as the same `f64`. Vertices are those of the mesh.

use std::io::{self, Write};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use crate::decimal::{write_decimal, write_digits};
use crate::material::Library;
use crate::material::{linear_to_srgb, material_color};
use crate::part::{ExportOptions, Unit};
use crate::xml::escaped;
use crate::{ExportError, Part};

const CONTENT_TYPES: &str = concat!(
    r#"<?xml version="1.0" encoding="UTF-8"?>"#,
    r#"<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">"#,
    r#"<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>"#,
    r#"<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>"#,
    "</Types>",
);
const RELATIONSHIPS: &str = concat!(
    r#"<?xml version="1.0" encoding="UTF-8"?>"#,
    r#"<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">"#,
    r#"<Relationship Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>"#,
    "</Relationships>",
);
const NAMESPACE: &str = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02";
/// The resource of all materials; objects follow.
const MATERIALS: usize = 1;

/// Writes the parts as a package. Those without triangles are left out, since an object must be a solid.
pub(crate) fn write_3mf(parts: &[Part<'_>], options: &ExportOptions, out: &mut dyn Write) -> Result<(), ExportError> {
    let mut package = ZipWriter::new_stream(out);
    // the date stays that of the format's beginning: the same input gives the same bytes
    let packing = SimpleFileOptions::default().compression_method(CompressionMethod::Deflated).large_file(true);
    for (name, text) in [("[Content_Types].xml", CONTENT_TYPES), ("_rels/.rels", RELATIONSHIPS)] {
        package.start_file(name, packing).map_err(failed)?;
        package.write_all(text.as_bytes())?;
    }
    package.start_file("3D/3dmodel.model", packing).map_err(failed)?;
    let mut model = io::BufWriter::new(package);
    write_model(parts, options, &mut model)?;
    let package = model.into_inner().map_err(io::IntoInnerError::into_error)?;
    package.finish().map_err(failed)?;
    Ok(())
}

fn failed(error: zip::result::ZipError) -> ExportError {
    match error {
        zip::result::ZipError::Io(error) => ExportError::Io(error),
        error => ExportError::Encode { format: "3MF", message: error.to_string() },
    }
}

fn write_model(parts: &[Part<'_>], options: &ExportOptions, out: &mut dyn Write) -> io::Result<()> {
    let unit = match options.unit.unwrap_or(Unit::Millimeter) {
        Unit::Micron => "micron",
        Unit::Millimeter => "millimeter",
        Unit::Centimeter => "centimeter",
        Unit::Inch => "inch",
        Unit::Foot => "foot",
        Unit::Meter => "meter",
    };
    write!(out, r#"<?xml version="1.0" encoding="UTF-8"?><model unit="{unit}" xml:lang="en-US" xmlns="{NAMESPACE}">"#)?;
    write!(out, r#"<metadata name="Application">planecut {}</metadata><resources>"#, env!("CARGO_PKG_VERSION"))?;
    let (library, places) =
        Library::of(parts, |name| if name.is_empty() { "material".to_owned() } else { name.to_owned() });
    if !library.materials().is_empty() {
        write!(out, r#"<basematerials id="{MATERIALS}">"#)?;
        for (name, material) in library.materials() {
            let [r, g, b] = material_color(material).map(|share| (linear_to_srgb(share) * 255.0).round() as u8);
            write!(out, r##"<base name="{}" displaycolor="#{r:02X}{g:02X}{b:02X}FF"/>"##, escaped(name))?;
        }
        out.write_all(b"</basematerials>")?;
    }
    let solids = || (0..parts.len()).filter(|number| !parts[*number].mesh.triangles.is_empty());
    for number in solids() {
        write_object(parts, number, (&library, &places[number]), options.scale, out)?;
    }
    out.write_all(b"</resources><build>")?;
    for number in solids() {
        write!(out, r#"<item objectid="{}"/>"#, object(number))?;
    }
    out.write_all(b"</build></model>")
}

fn write_object(
    parts: &[Part<'_>],
    number: usize,
    (library, places): (&Library, &[u32]),
    scale: f64,
    out: &mut dyn Write,
) -> io::Result<()> {
    let mesh = parts[number].mesh;
    let material = |triangle: usize| places[mesh.faces[mesh.triangle_faces[triangle] as usize].material.0 as usize];
    // the one of most triangles need not be said again
    let mut counts = vec![0_usize; library.materials().len()];
    (0..mesh.triangles.len()).for_each(|triangle| counts[material(triangle) as usize] += 1);
    let most = (0..counts.len()).rev().max_by_key(|place| counts[*place]).unwrap_or(0) as u32;
    write!(out, r#"<object id="{}" type="model" pid="{MATERIALS}" pindex="{most}""#, object(number))?;
    if !parts[number].name.is_empty() {
        write!(out, r#" name="{}""#, escaped(parts[number].name))?;
    }
    out.write_all(b"><mesh><vertices>")?;
    for position in &mesh.positions {
        for (before, value) in ["<vertex x=\"", "\" y=\"", "\" z=\""].into_iter().zip((*position * scale).to_array()) {
            out.write_all(before.as_bytes())?;
            write_decimal(value, out)?;
        }
        out.write_all(b"\"/>")?;
    }
    out.write_all(b"</vertices><triangles>")?;
    for (triangle, corners) in mesh.triangles.iter().enumerate() {
        for (before, corner) in ["<triangle v1=\"", "\" v2=\"", "\" v3=\""].into_iter().zip(corners) {
            out.write_all(before.as_bytes())?;
            write_digits(u64::from(*corner), out)?;
        }
        let own = material(triangle);
        if own == most {
            out.write_all(b"\"/>")?;
        } else {
            write!(out, r#"" pid="{MATERIALS}" p1="{own}"/>"#)?;
        }
    }
    out.write_all(b"</triangles></mesh></object>")
}

/// The number of a part's object.
fn object(part: usize) -> usize {
    MATERIALS + 1 + part
}
