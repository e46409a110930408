//! Small readers, which share no code with the writers.

use glam::{DVec3, Vec3};
use planecut_export::ExportOptions;
use serde_json::Value;

/// What a file holds: indices where it has them, and the name of each triangle's material as far as it says.
#[derive(Default)]
pub(super) struct Read {
    pub(super) positions: Vec<DVec3>,
    pub(super) indices: Vec<[u32; 3]>,
    pub(super) materials: Vec<String>,
}

impl Read {
    pub(super) fn triangles(&self) -> Vec<[DVec3; 3]> {
        self.indices.iter().map(|corners| corners.map(|corner| self.positions[corner as usize])).collect()
    }

    pub(super) fn with_materials(&self) -> impl Iterator<Item = ([DVec3; 3], &str)> {
        self.triangles().into_iter().zip(self.materials.iter().map(String::as_str))
    }

    fn push(&mut self, corners: [DVec3; 3], material: &str) {
        let first = self.positions.len() as u32;
        self.positions.extend(corners);
        self.indices.push([first, first + 1, first + 2]);
        self.materials.push(material.to_owned());
    }
}

pub(super) fn obj(bytes: &[u8]) -> Read {
    let (mut read, mut material) = (Read::default(), String::new());
    for line in std::str::from_utf8(bytes).expect("UTF-8").lines() {
        let mut words = line.split_whitespace();
        match words.next().expect("no empty lines") {
            "v" => {
                let numbers: Vec<f64> = words.map(|word| word.parse().expect("a number")).collect();
                read.positions.push(DVec3::from_slice(&numbers));
            }
            "f" => {
                let corner = |word: &str| -> u32 { word.split('/').next().expect("one").parse().expect("an index") };
                let corners: Vec<u32> = words.map(|word| corner(word) - 1).collect();
                assert!(corners.iter().all(|corner| (*corner as usize) < read.positions.len()), "read ahead");
                read.indices.push(corners.try_into().expect("three corners"));
                read.materials.push(material.clone());
            }
            "usemtl" => material = words.next().expect("a name").to_owned(),
            _ => {}
        }
    }
    read
}

/// Colours stand for materials: red is stone.
fn of_color(red: u8) -> String {
    if red > 0 { "stone".to_owned() } else { "brick".to_owned() }
}

pub(super) fn ply(bytes: &[u8]) -> Read {
    let end = b"end_header\n";
    let place = bytes.windows(end.len()).position(|part| part == end).expect("a header") + end.len();
    let header = std::str::from_utf8(&bytes[..place]).expect("ASCII");
    let count = |what: &str| -> usize {
        let line = header.lines().find_map(|line| line.strip_prefix(what)).expect("counted");
        line.trim().parse().expect("a number")
    };
    let floats = header.lines().filter(|line| line.starts_with("property float")).count();
    let (vertices, faces) = (count("element vertex"), count("element face"));
    let (mut read, mut body) = (Read::default(), &bytes[place..]);
    if header.contains("format ascii") {
        let mut lines = std::str::from_utf8(body)
            .expect("ASCII")
            .lines()
            .map(|line| line.split(' ').map(|word| word.parse::<f64>().expect("a number")).collect::<Vec<f64>>());
        let mut next = |numbers: usize| -> Vec<f64> {
            let line = lines.next().expect("a line");
            assert_eq!(line.len(), numbers);
            line
        };
        read.positions = (0..vertices).map(|_| DVec3::from_slice(&next(3 + floats))).collect();
        for _ in 0..faces {
            let line = next(7);
            read.indices.push([1, 2, 3].map(|k| line[k] as u32));
            read.materials.push(of_color(line[4] as u8));
        }
        assert!(lines.next().is_none(), "more lines than the header says");
        return read;
    }
    let mut take = |bytes: usize| {
        let (taken, rest) = body.split_at(bytes);
        body = rest;
        taken
    };
    for _ in 0..vertices {
        let numbers = [0; 3].map(|_| f64::from_le_bytes(take(8).try_into().expect("8 bytes")));
        take(4 * floats);
        read.positions.push(DVec3::from(numbers));
    }
    for _ in 0..faces {
        assert_eq!(take(1), [3]);
        read.indices.push([0; 3].map(|_| u32::from_le_bytes(take(4).try_into().expect("4 bytes"))));
        read.materials.push(of_color(take(3)[0]));
    }
    assert!(body.is_empty(), "more bytes than the header says");
    read
}

pub(super) fn stl(bytes: &[u8]) -> Read {
    let mut read = Read::default();
    if bytes.starts_with(b"solid") {
        let text = std::str::from_utf8(bytes).expect("ASCII");
        assert_eq!(text.lines().filter(|line| line.starts_with("solid")).count(), 1);
        let corner = |line: &str| -> DVec3 {
            let numbers = line.split(' ').map(|word| word.parse::<f32>().expect("a number"));
            Vec3::from_slice(&numbers.collect::<Vec<f32>>()).as_dvec3()
        };
        let corners: Vec<DVec3> = text.lines().filter_map(|line| line.strip_prefix("vertex ")).map(corner).collect();
        corners.chunks(3).for_each(|corners| read.push([corners[0], corners[1], corners[2]], ""));
        return read;
    }
    let (header, records) = bytes.split_at(84);
    let count = u32::from_le_bytes(header[80..].try_into().expect("4 bytes")) as usize;
    assert_eq!(records.len(), 50 * count);
    for record in records.chunks(50) {
        let numbers: Vec<f32> =
            record[12..48].chunks(4).map(|bytes| f32::from_le_bytes(bytes.try_into().expect("4 bytes"))).collect();
        read.push([0, 3, 6].map(|k| Vec3::from_slice(&numbers[k..]).as_dvec3()), "");
    }
    read
}

/// What is in a glTF file, in the frame of its root node: `translation + scale * position`.
pub(super) fn gltf(bytes: &[u8]) -> (Read, Value) {
    let is_binary = bytes.starts_with(b"glTF");
    let json: Value = if is_binary {
        serde_json::from_slice(&gltf::Glb::from_slice(bytes).expect("a GLB").json).expect("JSON")
    } else {
        serde_json::from_slice(bytes).expect("JSON")
    };
    // the reader's own validation knows no extensions
    let gltf::Gltf { document, blob } = match json.get("extensionsRequired") {
        Some(_) => gltf::Gltf::from_slice_without_validation(bytes).expect("read"),
        None => gltf::Gltf::from_slice(bytes).expect("passes the reader's full validation"),
    };
    let blob = blob.unwrap_or_else(|| json["buffers"][0]["uri"].as_str().map_or(Vec::new(), base64));
    let root = document.scenes().next().expect("a scene").nodes().next().expect("a root");
    let mut read = Read::default();
    for node in root.children() {
        let number = |value: &Value, otherwise: f64| value.as_f64().unwrap_or(otherwise);
        let of_node = &json["nodes"][node.index()];
        let vector = |key: &str, otherwise: f64| {
            DVec3::from([0, 1, 2].map(|k| of_node.get(key).map_or(otherwise, |value| number(&value[k], otherwise))))
        };
        let (translation, scale) = (vector("translation", 0.0), vector("scale", 1.0));
        for primitive in node.mesh().iter().flat_map(gltf::Mesh::primitives) {
            let positions = primitive.get(&gltf::Semantic::Positions).expect("positions");
            let local = elements(&positions, &blob);
            let (min, max) = local.iter().fold((local[0], local[0]), |(a, b), p| (a.min(*p), b.max(*p)));
            for (told, seen) in [(positions.min(), min), (positions.max(), max)] {
                let told = told.expect("bounds");
                // those of a mesh, of which a primitive may use a part
                assert_eq!([0, 1, 2].map(|k| told[k].as_f64().expect("a number") as f32 as f64), seen.to_array());
            }
            let reader = primitive.reader(|_| Some(&blob));
            let indices: Vec<u32> = reader.read_indices().expect("indices").into_u32().collect();
            let material = primitive.material().name().unwrap_or_default().to_owned();
            for corners in indices.chunks_exact(3) {
                let at = |k: usize| translation + scale * local[corners[k] as usize];
                read.push([at(0), at(1), at(2)], &material);
            }
        }
    }
    (read, json)
}

/// Positions as they are stored: the reader itself takes none of 16 bits.
fn elements(accessor: &gltf::Accessor<'_>, blob: &[u8]) -> Vec<DVec3> {
    let view = accessor.view().expect("a view");
    let start = view.offset() + accessor.offset();
    let stride = view.stride().expect("a stride");
    let element = |k: usize| {
        let bytes = &blob[start + k * stride..];
        let number = |k: usize| match accessor.data_type() {
            gltf::accessor::DataType::I16 => f64::from(i16::from_le_bytes([bytes[2 * k], bytes[2 * k + 1]])),
            _ => f64::from(f32::from_le_bytes(bytes[4 * k..4 * k + 4].try_into().expect("4 bytes"))),
        };
        DVec3::new(number(0), number(1), number(2))
    };
    (0..accessor.count()).map(element).collect()
}

fn base64(uri: &str) -> Vec<u8> {
    let (_, text) = uri.split_once("base64,").expect("Base64");
    let digit = |byte: u8| match byte {
        b'A'..=b'Z' => u32::from(byte - b'A'),
        b'a'..=b'z' => u32::from(byte - b'a') + 26,
        b'0'..=b'9' => u32::from(byte - b'0') + 52,
        b'+' => 62,
        b'/' => 63,
        _ => 0,
    };
    let of_four = |four: &[u8]| {
        let bits = four.iter().fold(0, |bits, byte| bits << 6 | digit(*byte));
        [(bits >> 16) as u8, (bits >> 8) as u8, bits as u8]
    };
    text.as_bytes().chunks(4).flat_map(of_four).collect()
}

/// What these tests ask most formats for.
pub(super) fn options(text: bool, quantize: bool, scale: f64) -> ExportOptions {
    ExportOptions { text, quantize, scale, ..ExportOptions::default() }
}
