//! `mesh` of the report is what the first output holds.

use std::fs;
use std::path::Path;

use planecut::kernel::DVec3;
use serde_json::{Value, json};

use crate::support::{ROOT, agree, folder, planecut};

/// Builds an example to files called `a`, and gives the report.
fn build(model: &str, folder: &Path, options: &str) -> Value {
    let mut args = vec!["build".to_owned(), format!("{ROOT}/examples/{model}.json"), "--report".to_owned()];
    args.push(folder.join("r.json").display().to_string());
    args.extend(options.split_whitespace().map(|word| word.replace("DIR", &folder.display().to_string())));
    planecut(args).expect_quiet_success();
    serde_json::from_slice(&fs::read(folder.join("r.json")).expect("a report")).expect("JSON")
}

/// The triangles of all nodes of a GLB by its JSON alone.
fn glb_triangles(path: &Path) -> u64 {
    let bytes = fs::read(path).expect("a file");
    let length = u32::from_le_bytes(bytes[12..16].try_into().expect("four bytes")) as usize;
    let json: Value = serde_json::from_slice(&bytes[20..20 + length]).expect("JSON");
    let number = |value: &Value| value.as_u64().expect("a number") as usize;
    let nodes = json["nodes"].as_array().expect("nodes").iter().filter(|node| node["mesh"].is_u64());
    let primitives = nodes.flat_map(|node| json["meshes"][number(&node["mesh"])]["primitives"].as_array().into_iter());
    let indices = primitives.flatten().map(|primitive| number(&primitive["indices"]));
    indices.map(|accessor| number(&json["accessors"][accessor]["count"]) as u64 / 3).sum()
}

/// The triangles of a binary STL file, and the volume within.
fn stl(path: &Path) -> (u64, f64) {
    let bytes = fs::read(path).expect("a file");
    let count = u32::from_le_bytes(bytes[80..84].try_into().expect("four bytes"));
    let corner = |bytes: &[u8]| {
        let at = |k: usize| f64::from(f32::from_le_bytes(bytes[4 * k..][..4].try_into().expect("four bytes")));
        DVec3::new(at(0), at(1), at(2))
    };
    let volume = |record: &[u8]| corner(&record[12..]).dot(corner(&record[24..]).cross(corner(&record[36..])));
    (u64::from(count), bytes[84..].chunks(50).map(volume).sum::<f64>() / 6.0)
}

#[test]
fn the_report_counts_what_is_in_the_first_file() {
    let folder = folder();
    let folder = folder.path();
    let (glb, stl_file) = (folder.join("a.glb"), folder.join("a.stl"));
    let info = |path: &Path| planecut(["info".as_ref(), path.as_os_str()]).json()["mesh"].clone();
    let mut fewer = Vec::new();
    for model in ["vase", "bracket"] {
        let double = build(model, folder, "-o DIR/a.obj -o DIR/a.glb");
        let obj = fs::read_to_string(folder.join("a.obj")).expect("text");
        let lines = obj.lines().filter(|line| line.starts_with("f ")).count();
        assert_eq!(double["mesh"]["triangles"], json!(lines), "{model}");
        for options in ["", "--quantize --meshopt", "--cells"] {
            let report = build(model, folder, &format!("-o DIR/a.glb -o DIR/a.obj {options}"));
            let mesh = &report["mesh"];
            assert_eq!(mesh["triangles"], json!(glb_triangles(&glb)), "{model} {options}");
            if options.is_empty() && mesh["triangles"] != double["mesh"]["triangles"] {
                fewer.push(model);
            }
            // cells are read as a solid of their own each, which takes long
            if options != "--cells" {
                let back = info(&glb);
                for key in ["vertices", "components", "genus", "watertight", "manifold"] {
                    assert_eq!(mesh[key], back[key], "{model} {options}: {key}");
                }
                let volume = back["volume"].as_f64().expect("a volume");
                assert!(agree(&mesh["volume"], volume, 1e-9), "{model} {options}");
            }
        }
        let report = build(model, folder, "-o DIR/a.stl -o DIR/a.obj");
        let (count, volume) = stl(&stl_file);
        assert_eq!(report["mesh"]["triangles"], json!(count), "{model}");
        assert!(agree(&report["mesh"]["volume"], volume, 1e-9), "{model}: {} {volume}", report["mesh"]);
        // the solid is what it is, whatever is written
        assert_eq!(report["solid"], double["solid"], "{model}");
    }
    assert!(fewer.contains(&"vase"), "{fewer:?}");
}
