//! Surfaces in pieces, and what holds of a surface.

use std::collections::BTreeMap;
use std::io;

use glam::DVec3;
use planecut_csg::{BlockOptions, Brush, MaterialId, Mesh, Model, Tree, evaluate, evaluate_in_blocks};
use planecut_csg::{Material, MeshFace};
use planecut_export::{ExportOptions, Format, MeshPieces, PiecesWritten, write_pieces};
use planecut_testkit::generate::{ball, placed, turned_box};
use planecut_testkit::random::Rng;

/// Pieces in memory.
pub(super) struct Held(pub(super) Vec<Mesh>);

impl MeshPieces for Held {
    fn count(&self) -> usize {
        self.0.len()
    }

    fn piece(&self, number: usize) -> io::Result<Mesh> {
        Ok(self.0[number].clone())
    }
}

/// The bytes of a file of pieces.
pub(super) fn encoded(pieces: &[Mesh], format: Format, options: &ExportOptions) -> (Vec<u8>, PiecesWritten) {
    let mut bytes = Vec::new();
    let written = write_pieces(&Held(pieces.to_vec()), format, options, &mut bytes).expect("written");
    (bytes, written)
}

/// A random model of two materials in blocks, and at once. The blocks have their materials in different orders.
pub(super) fn blocks(seed: u64, scale: f64, shift: DVec3) -> (Vec<Mesh>, Mesh) {
    let rng = &mut Rng::spread(seed);
    let brush = |_| {
        let at = DVec3::new(rng.float(0.0, 12.0), rng.float(0.0, 5.0), rng.float(0.0, 3.0));
        let mut brush = match rng.below(3) {
            0 => {
                let low = at.floor();
                Brush::cuboid(low, low + DVec3::from_array([0; 3].map(|_| rng.whole(1, 3))), MaterialId(0))
            }
            1 => turned_box(rng, at, DVec3::splat(0.8)),
            _ => ball(rng, at, 0.9, 24),
        };
        let material = MaterialId(rng.below(2) as u32);
        brush.faces.iter_mut().for_each(|face| face.material = material);
        brush
    };
    let parts: Vec<Tree> = (0..60).map(brush).map(Tree::from).collect();
    let (first, rest) = parts.split_at(40);
    let tree = if seed.is_multiple_of(2) {
        Tree::union(parts.clone())
    } else {
        Tree::union(first.to_vec()) - Tree::union(rest.to_vec())
    };
    let model = placed(Model { materials: materials(), tree }, scale, shift);
    let mut pieces = Vec::new();
    let all = evaluate_in_blocks(&model, BlockOptions { brushes: 6 }, |block| {
        let mut mesh = block.mesh;
        mesh.materials.truncate(2);
        if pieces.len() % 2 == 1 {
            mesh.materials.reverse();
            mesh.faces.iter_mut().for_each(|face| face.material.0 = 1 - face.material.0);
        }
        pieces.push(mesh);
        Ok::<(), ()>(())
    })
    .expect("evaluated");
    assert!(all.open_edges == 0 && pieces.len() > 8, "seed {seed}: {all:?}");
    (pieces, evaluate(&model).expect("evaluated").mesh)
}

/// Two materials that every format tells apart.
pub(super) fn materials() -> Vec<Material> {
    let stone = Material { color: Some([1.0, 0.0, 0.0]), ..Material::named("stone") };
    vec![stone, Material { color: Some([0.0, 0.0, 1.0]), ..Material::named("brick") }]
}

/// A mesh of triangles that are faces of their own, of the first material, without those whose corners all satisfy `is_wall`.
pub(super) fn open_mesh(positions: &[DVec3], triangles: &[[u32; 3]], is_wall: impl Fn(DVec3) -> bool) -> Mesh {
    let at = |corner: u32| positions[corner as usize];
    let on_wall = |triangle: &[u32; 3]| triangle.iter().all(|corner| is_wall(at(*corner)));
    let triangles: Vec<[u32; 3]> = triangles.iter().copied().filter(|triangle| !on_wall(triangle)).collect();
    let normal = |[a, b, c]: &[u32; 3]| (at(*b) - at(*a)).cross(at(*c) - at(*a)).normalize();
    let face = |triangle| MeshFace { normal: normal(triangle), material: MaterialId(0) };
    Mesh {
        positions: positions.to_vec(),
        triangle_faces: (0..triangles.len() as u32).collect(),
        faces: triangles.iter().map(face).collect(),
        triangles,
        materials: materials(),
    }
}

/// The triangles of an upright prism over a polygon, counter-clockwise seen from above: corners of the bottom, then of the top.
pub(super) fn prism(corners: u32) -> Vec<[u32; 3]> {
    let n = corners;
    let caps = (1..n - 1).flat_map(|k| [[0, k + 1, k], [n, n + k, n + k + 1]]);
    let sides = (0..n).flat_map(|k| {
        let next = (k + 1) % n;
        [[k, next, n + next], [k, n + next, n + k]]
    });
    caps.chain(sides).collect()
}

/// Every directed edge occurs once, and so does its opposite.
pub(super) fn assert_index_closed(triangles: &[[u32; 3]], what: &str) {
    let sides = |[a, b, c]: &[u32; 3]| [[*a, *b], [*b, *c], [*c, *a]];
    let mut edges: Vec<[u32; 2]> = triangles.iter().flat_map(sides).collect();
    edges.sort_unstable();
    assert!(edges.windows(2).all(|pair| pair[0] != pair[1]), "{what}: an edge occurs twice");
    assert!(edges.iter().all(|[a, b]| edges.binary_search(&[*b, *a]).is_ok()), "{what}: an edge is open");
}

/// The triangles at each vertex follow one another around it, once.
pub(super) fn assert_one_fan_at_each_vertex(triangles: &[[u32; 3]], what: &str) {
    let mut around: BTreeMap<u32, BTreeMap<u32, u32>> = BTreeMap::new();
    for [a, b, c] in triangles {
        for (vertex, from, to) in [(a, b, c), (b, c, a), (c, a, b)] {
            around.entry(*vertex).or_default().insert(*from, *to);
        }
    }
    for (vertex, next) in around {
        let first = *next.keys().next().expect("a triangle");
        let (mut at, mut steps) = (next[&first], 1);
        while at != first {
            (at, steps) = (next[&at], steps + 1);
        }
        assert_eq!(steps, next.len(), "{what}: triangles at vertex {vertex}");
    }
}

/// Between any two positions there are as many edges one way as the other.
pub(super) fn assert_closed_by_position(triangles: &[[DVec3; 3]], what: &str) {
    let mut edges: BTreeMap<[[u64; 3]; 2], i32> = BTreeMap::new();
    for triangle in triangles {
        let at = triangle.map(|position| (position + DVec3::ZERO).to_array().map(f64::to_bits));
        for (from, to) in [(at[0], at[1]), (at[1], at[2]), (at[2], at[0])] {
            if from != to {
                *edges.entry([from.min(to), from.max(to)]).or_default() += if from < to { 1 } else { -1 };
            }
        }
    }
    assert!(edges.values().all(|sum| *sum == 0), "{what}: an edge is open");
}

/// Volume, and the area of each material by its name.
pub(super) fn measures<'a>(triangles: impl Iterator<Item = ([DVec3; 3], &'a str)>) -> (f64, BTreeMap<String, f64>) {
    let (mut volume, mut areas, mut base) = (0.0, BTreeMap::new(), None);
    for (corners, material) in triangles {
        let base = *base.get_or_insert(corners[0]);
        let [a, b, c] = corners.map(|corner| corner - base);
        volume += a.dot(b.cross(c)) / 6.0;
        *areas.entry(material.to_owned()).or_default() += 0.5 * (b - a).cross(c - a).length();
    }
    (volume, areas)
}

/// The triangles of a mesh with their materials.
pub(super) fn triangles(mesh: &Mesh) -> impl Iterator<Item = ([DVec3; 3], &str)> {
    mesh.triangles.iter().zip(&mesh.triangle_faces).map(|(triangle, face)| {
        let material = &mesh.materials[mesh.faces[*face as usize].material.0 as usize];
        (triangle.map(|corner| mesh.positions[corner as usize]), material.name.as_str())
    })
}

/// What was read has the volume and the areas of the whole.
pub(super) fn assert_measures<'a>(
    read: impl Iterator<Item = ([DVec3; 3], &'a str)>,
    whole: &Mesh,
    scale: f64,
    relative: f64,
    what: &str,
) {
    let ((volume, areas), (expected, expected_areas)) = (measures(read), measures(triangles(whole)));
    let is_near = |a: f64, b: f64| (a - b).abs() <= relative * b.abs();
    assert!(is_near(volume, expected * scale.powi(3)), "{what}: volume {volume}, expected {expected}");
    assert_eq!(areas.len(), expected_areas.len(), "{what}");
    for (name, area) in &areas {
        let expected = expected_areas[name] * scale.powi(2);
        assert!(is_near(*area, expected), "{what}: {area} of {name}, expected {expected}");
    }
}
