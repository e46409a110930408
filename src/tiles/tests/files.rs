//! Tile sets as they are on disk, read without anything of the writer.

use std::fs;
use std::path::{Path, PathBuf};

use planecut_kernel::DVec3;
use serde_json::Value;

/// A tile of a tile set.
pub(super) struct Tile {
    pub(super) content: PathBuf,
    pub(super) error: f64,
    pub(super) center: DVec3,
    pub(super) half: DVec3,
    pub(super) children: Vec<Tile>,
}

/// The tiles of a tile set, and how many documents they are in.
pub(super) fn read(folder: &Path) -> (Tile, usize) {
    let mut documents = 0;
    let tile = document(&folder.join("tileset.json"), &mut documents);
    (tile, documents)
}

fn document(path: &Path, documents: &mut usize) -> Tile {
    *documents += 1;
    let bytes = fs::read(path).expect("a document");
    let json: Value = serde_json::from_slice(&bytes).expect("JSON");
    assert_eq!((&json["asset"]["version"], &json["root"]["refine"]), (&"1.1".into(), &"REPLACE".into()));
    let tile = tile(&json["root"], path, documents);
    assert!(json["geometricError"].as_f64().expect("a number") >= tile.error);
    tile
}

fn tile(json: &Value, path: &Path, documents: &mut usize) -> Tile {
    let uri = json["content"]["uri"].as_str().expect("an address");
    let content = path.parent().expect("a folder").join(uri);
    let error = json["geometricError"].as_f64().expect("a number");
    if uri.ends_with(".json") {
        assert_eq!(json["children"], Value::Null);
        let root = document(&content, documents);
        assert_eq!(root.error, error);
        return root;
    }
    let numbers: Vec<f64> =
        json["boundingVolume"]["box"].as_array().expect("a box").iter().filter_map(Value::as_f64).collect();
    assert!([4, 5, 6, 8, 9, 10].iter().all(|k| numbers[*k] == 0.0) && numbers.len() == 12);
    let (center, half) =
        (DVec3::new(numbers[0], numbers[1], numbers[2]), DVec3::new(numbers[3], numbers[7], numbers[11]));
    let children =
        json["children"].as_array().into_iter().flatten().map(|child| tile(child, path, documents)).collect();
    Tile { content, error, center, half, children }
}

/// The triangles of a GLB of one mesh in the coordinates of the input, and its JSON.
pub(super) fn triangles(path: &Path) -> (Vec<[DVec3; 3]>, Value) {
    let bytes = fs::read(path).expect("a GLB");
    let number = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().expect("four")) as usize;
    assert_eq!((&bytes[..4], number(8)), (&b"glTF"[..], bytes.len()));
    let json: Value = serde_json::from_slice(&bytes[20..20 + number(12)]).expect("JSON");
    let buffer = &bytes[28 + number(12)..];
    let node = &json["nodes"][1];
    let vector =
        |value: &Value, otherwise: f64| DVec3::from_array([0, 1, 2].map(|k| value[k].as_f64().unwrap_or(otherwise)));
    let (translation, scale) = (vector(&node["translation"], 0.0), vector(&node["scale"], 1.0));
    let mut triangles = Vec::new();
    for primitive in json["meshes"][0]["primitives"].as_array().expect("primitives") {
        let (places, size, _, stride) = array(&json, &primitive["attributes"]["POSITION"]);
        let position = |vertex: usize| {
            let coordinate = |axis: usize| {
                let at = &buffer[places + vertex * stride + axis * size..][..size];
                if size == 4 {
                    f64::from(f32::from_le_bytes(at.try_into().expect("four")))
                } else {
                    f64::from(i16::from_le_bytes(at.try_into().expect("two")))
                }
            };
            DVec3::from_array([0, 1, 2].map(coordinate)) * scale + translation
        };
        let (places, size, count, _) = array(&json, &primitive["indices"]);
        let corners: Vec<usize> = (0..count)
            .map(|k| (0..size).map(|byte| usize::from(buffer[places + k * size + byte]) << (8 * byte)).sum())
            .collect();
        triangles.extend(corners.chunks(3).map(|corners| [0, 1, 2].map(|k| position(corners[k]))));
    }
    (triangles, json)
}

/// Where an accessor's array begins, the bytes of a component, the number of elements, and the bytes from one to the next.
fn array(json: &Value, accessor: &Value) -> (usize, usize, usize, usize) {
    let accessor = &json["accessors"][accessor.as_u64().expect("a number") as usize];
    let view = &json["bufferViews"][accessor["bufferView"].as_u64().expect("a number") as usize];
    let number = |value: &Value| value.as_u64().unwrap_or(0) as usize;
    let size = match number(&accessor["componentType"]) {
        5122 | 5123 => 2,
        _ => 4,
    };
    (
        number(&accessor["byteOffset"]) + number(&view["byteOffset"]),
        size,
        number(&accessor["count"]),
        number(&view["byteStride"]),
    )
}
