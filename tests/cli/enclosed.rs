//! What `coarsen` writes holds its input: files read by a few lines of their own, judged in exact rationals.

use std::collections::HashMap;
use std::fs;
use std::path::Path;

use dashu_ratio::RBig;
use planecut_testkit::data::data;
use serde_json::Value;

use crate::support::{folder as scratch, planecut};

planecut_testkit::tests_on_data!(
    cells_of_meshes_hold_all_vertices_in_every_format,
    cells_of_decompositions_hold_all_vertices_in_every_format
);

type Exact = [RBig; 3];

/// A convex cell of a file: its vertices, and its triangles by their numbers.
struct Cell {
    vertices: Vec<Exact>,
    triangles: Vec<[usize; 3]>,
}

fn rational(value: f64) -> RBig {
    RBig::try_from(value).expect("a finite number")
}

/// The objects of an OBJ file; faces may have any number of corners.
fn obj(path: &Path) -> Vec<Cell> {
    let (mut vertices, mut objects) = (Vec::new(), vec![Vec::new()]);
    for line in fs::read_to_string(path).expect("text").lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => vertices.push([(); 3].map(|()| rational(words.next().expect("v").parse().expect("a number")))),
            Some("o" | "g") if objects.last().is_some_and(|object| !object.is_empty()) && line.starts_with("o ") => {
                objects.push(Vec::new());
            }
            Some("f") => {
                let number = |word: &str| word.split('/').next().expect("v").parse::<usize>().expect("a number") - 1;
                let corners: Vec<usize> = words.map(number).collect();
                let fan = (1..corners.len() - 1).map(|k| [corners[0], corners[k], corners[k + 1]]);
                objects.last_mut().expect("an object").extend(fan);
            }
            _ => {}
        }
    }
    objects.into_iter().map(|triangles| used(&vertices, &triangles)).collect()
}

/// A cell of some triangles, equal vertices being one.
fn used(vertices: &[Exact], triangles: &[[usize; 3]]) -> Cell {
    let mut cell = Cell { vertices: Vec::new(), triangles: Vec::new() };
    let mut numbers: HashMap<&Exact, usize> = HashMap::new();
    for corners in triangles {
        cell.triangles.push(corners.map(|corner| {
            *numbers.entry(&vertices[corner]).or_insert_with(|| {
                cell.vertices.push(vertices[corner].clone());
                cell.vertices.len() - 1
            })
        }));
    }
    cell
}

fn single(bytes: &[u8], place: usize) -> f64 {
    f64::from(f32::from_le_bytes(bytes[place..place + 4].try_into().expect("four bytes")))
}

/// The cell of a binary STL file.
fn stl(path: &Path) -> Cell {
    let bytes = fs::read(path).expect("a file");
    let corners = bytes[84..].chunks_exact(50).flat_map(|facet| (0..3).map(move |corner| (facet, 12 + 12 * corner)));
    let vertices: Vec<Exact> =
        corners.map(|(facet, at)| [0, 4, 8].map(|axis| rational(single(facet, at + axis)))).collect();
    let triangles: Vec<[usize; 3]> = (0..vertices.len() / 3).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    used(&vertices, &triangles)
}

/// The nodes with a mesh of a GLB file, each moved by its translation and scale, in the axes of its mesh.
fn glb(path: &Path) -> Vec<Cell> {
    let bytes = fs::read(path).expect("a file");
    let json_length = u32::from_le_bytes(bytes[12..16].try_into().expect("four bytes")) as usize;
    let json: Value = serde_json::from_slice(&bytes[20..20 + json_length]).expect("JSON");
    let buffer = &bytes[28 + json_length..];
    let nodes = json["nodes"].as_array().expect("nodes").iter().filter(|node| node["mesh"].is_u64());
    nodes.map(|node| node_cell(&json, node, buffer)).collect()
}

fn node_cell(json: &Value, node: &Value, buffer: &[u8]) -> Cell {
    let number = |value: &Value| value.as_u64().expect("a number") as usize;
    let factor = |key: &str, axis: usize, default: f64| rational(node[key][axis].as_f64().unwrap_or(default));
    let start = |accessor: &Value| {
        let view = &json["bufferViews"][number(&accessor["bufferView"])];
        let offset = |of: &Value| of["byteOffset"].as_u64().unwrap_or(0) as usize;
        (offset(view) + offset(accessor), view["byteStride"].as_u64().map(|stride| stride as usize))
    };
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for primitive in json["meshes"][number(&node["mesh"])]["primitives"].as_array().expect("primitives") {
        let first = vertices.len();
        let positions = &json["accessors"][number(&primitive["attributes"]["POSITION"])];
        let is_single = positions["componentType"] == 5126;
        let (at, stride) = start(positions);
        let stride = stride.unwrap_or(if is_single { 12 } else { 8 });
        for vertex in 0..number(&positions["count"]) {
            let place = at + vertex * stride;
            let whole = |k: usize| f64::from(i16::from_le_bytes([buffer[place + 2 * k], buffer[place + 2 * k + 1]]));
            let value = |k: usize| if is_single { single(buffer, place + 4 * k) } else { whole(k) };
            let moved = |k: usize| rational(value(k)) * factor("scale", k, 1.0) + factor("translation", k, 0.0);
            vertices.push([0, 1, 2].map(moved));
        }
        let indices = &json["accessors"][number(&primitive["indices"])];
        let (at, _) = start(indices);
        let bytes = match number(&indices["componentType"]) {
            5121 => 1,
            5123 => 2,
            _ => 4,
        };
        let index = |k: usize| (0..bytes).rev().fold(0, |sum, byte| sum << 8 | buffer[at + k * bytes + byte] as usize);
        let corners: Vec<usize> = (0..number(&indices["count"])).map(|k| first + index(k)).collect();
        triangles.extend(corners.chunks_exact(3).map(|t| [t[0], t[1], t[2]]));
    }
    used(&vertices, &triangles)
}

fn plane(cell: &Cell, corners: [usize; 3]) -> (Exact, RBig) {
    let [a, b, c] = corners.map(|corner| &cell.vertices[corner]);
    let minus = |p: &Exact| [0, 1, 2].map(|k| &p[k] - &a[k]);
    let ([u, v, w], [x, y, z]) = (minus(b), minus(c));
    let normal = [&v * &z - &w * &y, &w * &x - &u * &z, &u * &y - &v * &x];
    let offset = dot(&normal, a);
    (normal, offset)
}

fn dot(a: &Exact, b: &Exact) -> RBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

/// Fails unless every cell is closed, convex and without doubled corners, and each of the points is in one.
#[track_caller]
fn assert_encloses(cells: &[Cell], points: &[Exact], case: &str) {
    let extent = |axis: usize| {
        let along = || cells.iter().flat_map(|cell| &cell.vertices).map(|vertex| &vertex[axis]);
        along().max().expect("a vertex") - along().min().expect("a vertex")
    };
    let least = (0..3).map(extent).max().expect("three axes") * rational(1e-9);
    let mut left: Vec<&Exact> = points.iter().collect();
    for cell in cells {
        let mut edges: HashMap<[usize; 2], u32> = HashMap::new();
        for [a, b, c] in &cell.triangles {
            [[*a, *b], [*b, *c], [*c, *a]].into_iter().for_each(|edge| *edges.entry(edge).or_default() += 1);
        }
        assert!(edges.iter().all(|([a, b], n)| *n == 1 && edges.contains_key(&[*b, *a])), "{case}: not closed");
        let planes: Vec<(Exact, RBig)> = cell.triangles.iter().map(|corners| plane(cell, *corners)).collect();
        let holds = |point: &Exact| planes.iter().all(|(normal, offset)| dot(normal, point) <= *offset);
        assert!(cell.vertices.iter().all(holds), "{case}: not convex");
        left.retain(|point| !holds(point));
        for (number, a) in cell.vertices.iter().enumerate() {
            let is_near = |b: &Exact| (0..3).all(|k| (&a[k] - &b[k]) <= least && (&b[k] - &a[k]) <= least);
            assert!(!cell.vertices[..number].iter().any(is_near), "{case}: doubled corners");
        }
    }
    assert!(left.is_empty(), "{case}: {} of {} points are outside of all cells", left.len(), points.len());
}

/// Coarsens a file and judges what was written of it in each precision.
fn judge(input: &Path, cells: usize) {
    let folder = scratch();
    let name = |name: &str| folder.path().join(name).display().to_string();
    let (input_name, count) = (input.display().to_string(), cells.to_string());
    let outputs = ["a.obj", "a.glb", "part_{}.stl"].map(name);
    let mut args = vec!["coarsen", &input_name, "--max-cells", &count, "-q"];
    outputs.iter().for_each(|output| args.extend(["-o", output]));
    assert_eq!(planecut(&args).status, 0, "{input_name}");
    let points: Vec<Exact> = obj(input).into_iter().flat_map(|cell| cell.vertices).collect();
    let written = obj(&folder.path().join("a.obj"));
    assert!(!written.is_empty() && written.len() <= cells, "{input_name}: {} cells", written.len());
    let parts: Vec<Cell> = (0..written.len()).map(|k| stl(&folder.path().join(format!("part_{k}.stl")))).collect();
    for (format, cells) in [("obj", &written), ("glb", &glb(&folder.path().join("a.glb"))), ("stl", &parts)] {
        assert_eq!(cells.len(), written.len(), "{input_name} as {format}");
        assert_encloses(cells, &points, &format!("{input_name} as {format}"));
    }
}

fn cells_of_meshes_hold_all_vertices_in_every_format() {
    for (name, cells) in [("regressions/mug_col.obj", 16), ("mesh/vhacd/hose.obj", 16)] {
        judge(&data(name), cells);
    }
}

fn cells_of_decompositions_hold_all_vertices_in_every_format() {
    for (name, cells) in [("cup_vhacd.obj", 8), ("duck_vhacd.obj", 6), ("link2_vhacd.obj", 4)] {
        judge(&data("convex/bullet3").join(name), cells);
    }
}
