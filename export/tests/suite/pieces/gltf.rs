//! Pieces in glTF: on one grid, each a mesh node.

use std::collections::BTreeMap;

use glam::DVec3;
use planecut_csg::Mesh;
use planecut_export::{ExportOptions, Format};
use planecut_testkit::meshes;

use super::readers::{self, options};
use super::support::{assert_closed_by_position, assert_measures, blocks, encoded, open_mesh, prism};

#[test]
fn glb_is_watertight_by_position() {
    for seed in 0..8 {
        for (scale, shift) in
            [(1.0, DVec3::ZERO), (0.37, DVec3::new(1e6, -3e4 - 0.3, 0.7)), (1.0, DVec3::splat(2e6 + 0.3))]
        {
            let (pieces, whole) = blocks(seed, scale, shift);
            for (format, quantize) in [(Format::Glb, false), (Format::Glb, true), (Format::Gltf, false)] {
                let what = format!("seed {seed}, scale {scale}, {format:?}, quantized {quantize}");
                let (read, json) = readers::gltf(&encoded(&pieces, format, &options(false, quantize, 1.0)).0);
                assert_closed_by_position(&read.triangles(), &what);
                let relative = if quantize { 1e-2 } else { 1e-5 };
                if scale > 0.1 {
                    assert_measures(read.with_materials(), &whole, 1.0, relative, &what);
                }
                assert_eq!(json["nodes"].as_array().expect("nodes").len(), pieces.len() + 1, "{what}");
            }
        }
    }
}

/// Every position is within the step that is documented of one that was given.
#[test]
fn positions_are_as_precise_as_is_said() {
    for seed in 0..6 {
        let (pieces, _) = blocks(seed, 0.77, DVec3::new(1e3, 2e4, -5e5));
        let size = pieces.iter().map(largest_side).fold(0.0, f64::max);
        for quantize in [false, true] {
            // from the middle, or a sixteenth off it, to a corner
            let steps = if quantize { f64::from(1 << 14) } else { f64::from(1 << 23) };
            let most = 0.6 * size / steps;
            let (read, _) = readers::gltf(&encoded(&pieces, Format::Glb, &options(false, quantize, 1.0)).0);
            let given: Vec<DVec3> = pieces.iter().flat_map(|piece| piece.positions.clone()).collect();
            let mut by_cell: BTreeMap<[i64; 3], Vec<DVec3>> = BTreeMap::new();
            let cell = |at: DVec3| (at / (4.0 * most)).round().to_array().map(|c| c as i64);
            given.iter().for_each(|at| by_cell.entry(cell(*at)).or_default().push(*at));
            for at in &read.positions {
                let [x, y, z] = cell(*at);
                let near =
                    (-1..=1).flat_map(|i| (-1..=1).flat_map(move |j| (-1..=1).map(move |k| [x + i, y + j, z + k])));
                let mut near = near.filter_map(|cell| by_cell.get(&cell)).flatten();
                assert!(near.any(|given| given.distance(*at) < 2.0 * most), "seed {seed}: {at} is nowhere near");
            }
        }
    }
}

fn largest_side(mesh: &Mesh) -> f64 {
    let (min, max) =
        mesh.positions.iter().fold((mesh.positions[0], mesh.positions[0]), |(a, b), p| (a.min(*p), b.max(*p)));
    (max - min).max_element()
}

/// A large piece and small ones at its side, with seams at decimals: three boxes in a row, cut where their size is very different.
#[test]
fn small_pieces_fit_large_ones() {
    let cuts = [-1000.1, 0.1, 0.1001, 0.3, 0.7];
    let slab = |range: [f64; 2]| {
        let square = [(0.1, -0.2), (1.3, -0.2), (1.3, 1.1), (0.1, 1.1)];
        let positions = range.into_iter().flat_map(|z| square.map(|(x, y)| DVec3::new(x, y, z)));
        let positions: Vec<DVec3> = positions.collect();
        open_mesh(&positions, &prism(4), |_| false)
    };
    let mut pieces: Vec<Mesh> = cuts.windows(2).map(|range| slab([range[0], range[1]])).collect();
    for (number, piece) in pieces.iter_mut().enumerate() {
        let inner = |z: f64| z != cuts[0] && z != cuts[4];
        let (positions, triangles) = (piece.positions.clone(), piece.triangles.clone());
        let of_cap = |z: f64| move |at: DVec3| at.z == z;
        let mut mesh = open_mesh(&positions, &triangles, |_| false);
        for z in [cuts[number], cuts[number + 1]].into_iter().filter(|z| inner(*z)) {
            mesh = open_mesh(&positions, &mesh.triangles, of_cap(z));
        }
        *piece = mesh;
    }
    for quantize in [false, true] {
        let (bytes, written) = encoded(&pieces, Format::Glb, &options(false, quantize, 1.0));
        assert_eq!((written.open_edges, written.vertices), (0, 20));
        assert_closed_by_position(&readers::gltf(&bytes).0.triangles(), "slabs");
    }
}

/// What is open is not said to be a manifold; what is closed is.
#[test]
fn open_pieces_are_no_manifolds() {
    let (mut pieces, _) = blocks(1, 1.0, DVec3::ZERO);
    pieces.push(meshes::box_mesh(DVec3::splat(50.0), DVec3::splat(51.0), "stone"));
    let (_, json) = readers::gltf(&encoded(&pieces, Format::Glb, &ExportOptions::default()).0);
    let said = |mesh: &serde_json::Value| mesh["extensions"].get("EXT_mesh_manifold").is_some();
    let all = json["meshes"].as_array().expect("meshes");
    assert!(said(all.last().expect("the box")));
    for (mesh, piece) in all.iter().zip(&pieces) {
        let sides = |[a, b, c]: &[u32; 3]| [[*a, *b], [*b, *c], [*c, *a]];
        let edges: std::collections::BTreeSet<[u32; 2]> = piece.triangles.iter().flat_map(sides).collect();
        let is_closed = edges.iter().all(|[a, b]| edges.contains(&[*b, *a]));
        assert_eq!(said(mesh), is_closed);
    }
    let open = all.iter().position(|mesh| !said(mesh)).expect("an open piece");
    let (_, json) = readers::gltf(&encoded(&pieces[open..=open], Format::Glb, &ExportOptions::default()).0);
    assert!(json.get("extensionsUsed").is_none());
}

/// Packed pieces hold what plain ones do, but for which corner of a triangle comes first.
#[cfg(feature = "meshopt")]
#[test]
fn packed_pieces_hold_the_same() {
    let (pieces, _) = blocks(4, 1.0, DVec3::ZERO);
    let read = |options: &ExportOptions| {
        let bytes = encoded(&pieces, Format::Glb, options).0;
        let mesh = planecut_import::mesh::read_mesh(&bytes, planecut_import::mesh::MeshFormat::Gltf, "file");
        let mesh = mesh.expect("read");
        let corners = |triangle: &[u32; 3]| triangle.map(|corner| mesh.positions[corner as usize]);
        let triangles: Vec<[DVec3; 3]> = mesh.triangles.iter().map(corners).collect();
        assert_closed_by_position(&triangles, "packed");
        let turned = |triangle: &[DVec3; 3]| {
            let mut bits = triangle.map(|corner| corner.to_array().map(f64::to_bits));
            let first = (0..3).min_by_key(|k| bits[*k]).expect("three");
            bits.rotate_left(first);
            bits
        };
        let mut triangles: Vec<_> = triangles.iter().map(turned).collect();
        triangles.sort_unstable();
        (triangles, bytes.len())
    };
    for quantize in [false, true] {
        let plain = ExportOptions { quantize, ..ExportOptions::default() };
        let ((plain, length), (packed, packed_length)) =
            (read(&plain), read(&ExportOptions { meshopt: true, ..plain.clone() }));
        assert!(plain.len() > 1000 && plain == packed && packed_length < length);
    }
}
