//! Export: a model file becomes a mesh in every format, and its convex cells one mesh each.
//!
//! ```sh
//! cargo run --release --example export -- examples/gear.json out
//! ```

use std::error::Error;
use std::path::PathBuf;

use planecut::csg::polyhedron::convex_tree;
use planecut::csg::{Solid, evaluate};
use planecut::export::{ExportOptions, Format, Part, encode, encode_parts, write_atomic};
use planecut::import::model::{ModelOptions, read_model};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args_os().skip(1);
    let input = PathBuf::from(arguments.next().unwrap_or_else(|| "examples/gear.json".into()));
    let folder = PathBuf::from(arguments.next().unwrap_or_else(|| "out".into()));
    let name = input.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    std::fs::create_dir_all(&folder)?;

    let import = read_model(&std::fs::read(&input)?, &input.display().to_string(), &ModelOptions::default())?;
    for warning in &import.warnings {
        eprintln!("{warning}");
    }

    // The skin: one closed mesh with a material on each face.
    let evaluation = evaluate(&import.model)?;
    // Millimetres in, metres out.
    let options = ExportOptions { scale: 0.001, ..ExportOptions::default() };
    for format in Format::ALL {
        let path = folder.join(format!("{name}.{}", format.extension()));
        write_atomic(&path, &encode(&evaluation.mesh, format, &options)?)?;
        println!("{}: {} triangles", path.display(), evaluation.mesh.triangles.len());
    }

    // The cells: convex, disjoint, as physics engines like them.
    let solid = Solid::from_tree(&*convex_tree(&import.model.tree)?);
    let meshes = solid.cell_meshes(&import.model.materials)?;
    let names: Vec<String> = (0..meshes.len()).map(|number| format!("cell {number}")).collect();
    let parts: Vec<Part<'_>> = names.iter().zip(&meshes).map(|(name, mesh)| Part::new(name, mesh)).collect();
    let path = folder.join(format!("{name}.cells.glb"));
    write_atomic(&path, &encode_parts(&parts, Format::Glb, &options)?)?;
    println!("{}: {} cells, volume {:?}", path.display(), parts.len(), solid.volume());
    Ok(())
}
