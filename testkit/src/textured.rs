//! Closed meshes with texture coordinates: files of them, and what coordinates must be where, by barycentric interpolation.

use std::collections::BTreeSet;
use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use crate::random::Rng;

/// A closed mesh with texture coordinates of its own at each corner of a triangle.
#[derive(Debug, Clone)]
pub struct TexturedMesh {
    /// The places of vertices; single precision holds them.
    pub positions: Vec<DVec3>,
    /// Texture coordinates, `v` up; single precision holds them, also of `1 - v`.
    pub coordinates: Vec<DVec2>,
    /// Of each corner of a triangle the number of its vertex and that of its texture coordinates.
    pub triangles: Vec<[[usize; 2]; 3]>,
}

impl TexturedMesh {
    /// A ball of radius 1 with arbitrary coordinates: each triangle lays its part of the picture in its own way, and along a seam those on both sides differ.
    #[must_use]
    pub fn ball(rings: usize, segments: usize, seed: u64) -> Self {
        let mut random = Rng::new(seed);
        let single = |p: DVec3| p.as_vec3().as_dvec3();
        let mut positions = vec![DVec3::Z];
        for ring in 1..rings {
            let (height, radius) = ((PI * ring as f64 / rings as f64).cos(), (PI * ring as f64 / rings as f64).sin());
            positions.extend((0..segments).map(|k| {
                let angle = TAU * k as f64 / segments as f64;
                single(DVec3::new(radius * angle.cos(), radius * angle.sin(), height))
            }));
        }
        positions.push(DVec3::new(0.0, 0.0, -1.0));
        let last = positions.len() - 1;
        // a row of coordinates for each ring, its last one those of the seam's other side
        let mut number = |most: i64| random.whole(0, most) / 4096.0;
        let count = (rings + 1) * (segments + 1);
        let coordinates = (0..count).map(|_| DVec2::new(number(4096), number(8192))).collect();
        let vertex = |ring: usize, k: usize| match ring {
            0 => 0,
            ring if ring == rings => last,
            ring => 1 + (ring - 1) * segments + k % segments,
        };
        let corner = |ring: usize, k: usize| [vertex(ring, k), ring * (segments + 1) + k];
        let mut triangles = Vec::new();
        for (ring, k) in (0..rings).flat_map(|ring| (0..segments).map(move |k| (ring, k))) {
            let [a, b, c, d] = [corner(ring, k), corner(ring + 1, k), corner(ring + 1, k + 1), corner(ring, k + 1)];
            // at a pole two corners are one
            if ring + 1 < rings {
                triangles.push([a, b, c]);
            }
            if ring > 0 {
                triangles.push([a, c, d]);
            }
        }
        Self { positions, coordinates, triangles }
    }

    /// The mesh with its vertices somewhere else.
    #[must_use]
    pub fn moved(&self, map: impl Fn(DVec3) -> DVec3) -> Self {
        Self { positions: self.positions.iter().map(|p| map(*p)).collect(), ..self.clone() }
    }

    /// How many vertices there are for a renderer: pairs of a place and its texture coordinates.
    #[must_use]
    pub fn pairs(&self) -> usize {
        let bits = |corner: &[usize; 2]| (corner[0], self.coordinates[corner[1]].to_array().map(f64::to_bits));
        self.triangles.iter().flatten().map(bits).collect::<BTreeSet<_>>().len()
    }

    /// As an OBJ file.
    #[must_use]
    pub fn to_obj(&self) -> String {
        let mut text = String::new();
        self.positions.iter().for_each(|p| text += &format!("v {} {} {}\n", p.x, p.y, p.z));
        self.coordinates.iter().for_each(|at| text += &format!("vt {} {}\n", at.x, at.y));
        for triangle in &self.triangles {
            let [a, b, c] = triangle.map(|[vertex, at]| format!("{}/{}", vertex + 1, at + 1));
            text += &format!("f {a} {b} {c}\n");
        }
        text
    }

    /// As a GLB file, in which y is up and each corner a vertex; `node` is what its node has beside the mesh, such as `"scale": [2, 1, 1]`.
    #[must_use]
    pub fn to_glb(&self, node: &str) -> Vec<u8> {
        let corners: Vec<[usize; 2]> = self.triangles.iter().flatten().copied().collect();
        let count = corners.len();
        let mut binary: Vec<u8> = Vec::new();
        let mut push = |value: f64| binary.extend((value as f32).to_le_bytes());
        for [vertex, _] in &corners {
            let p = self.positions[*vertex];
            [p.x, p.z, -p.y].into_iter().for_each(&mut push);
        }
        for [_, at] in &corners {
            [self.coordinates[*at].x, 1.0 - self.coordinates[*at].y].into_iter().for_each(&mut push);
        }
        let comma = if node.is_empty() { "" } else { "," };
        let mut json = format!(
            r#"{{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0{comma}{node}}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"TEXCOORD_0":1}}}}]}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"count":{count},"type":"VEC3"}},
            {{"bufferView":1,"componentType":5126,"count":{count},"type":"VEC2"}}],
            "bufferViews":[{{"buffer":0,"byteLength":{}}},{{"buffer":0,"byteOffset":{},"byteLength":{}}}],
            "buffers":[{{"byteLength":{}}}]}}"#,
            12 * count,
            12 * count,
            8 * count,
            20 * count,
        );
        while !json.len().is_multiple_of(4) {
            json.push(' ');
        }
        let mut file = b"glTF".to_vec();
        let length = 12 + 8 + json.len() + 8 + binary.len();
        [2, length as u32, json.len() as u32].iter().for_each(|word| file.extend(word.to_le_bytes()));
        file.extend(b"JSON");
        file.extend(json.bytes());
        file.extend((binary.len() as u32).to_le_bytes());
        file.extend(b"BIN\0");
        file.extend(binary);
        file
    }

    /// The texture coordinates, `v` up, at the corners of a triangle that lies within one of the mesh: one answer for each of the mesh that it lies in, but for
    /// so much room.
    #[must_use]
    pub fn at(&self, corners: [DVec3; 3], room: f64) -> Vec<[DVec2; 3]> {
        let holder = |triangle: &[[usize; 2]; 3]| {
            let [a, b, c] = triangle.map(|[vertex, _]| self.positions[vertex]);
            let normal = (b - a).cross(c - a);
            let double_area = normal.length();
            let within = |p: DVec3| {
                // areas opposite of each corner, as shares of the whole
                let shares =
                    [(b, c), (c, a), (a, b)].map(|(q, r)| (q - p).cross(r - p).dot(normal) / double_area.powi(2));
                let far = [(b, c), (c, a), (a, b)]
                    .into_iter()
                    .zip(shares)
                    .map(|((q, r), share)| -share * double_area / q.distance(r))
                    .fold((p - a).dot(normal).abs() / double_area, f64::max);
                (far <= room).then_some(shares)
            };
            let [p, q, r] = corners.map(within);
            let mix = |shares: [f64; 3]| (0..3).map(|k| self.coordinates[triangle[k][1]] * shares[k]).sum();
            Some([p?, q?, r?].map(mix))
        };
        self.triangles.iter().filter_map(holder).collect()
    }
}
