//! Convex decompositions that others wrote: in the data folder; ignored where it is absent.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use glam::DVec3;
use planecut_check::{CheckOptions, check_mesh};
use planecut_import::mesh::{IndexedMesh, MeshFormat, read_mesh};
use planecut_testkit::data::data;

planecut_testkit::tests_on_data!(decompositions_read_as_closed_objects);

fn obj_files(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
    let mut files: Vec<PathBuf> = paths
        .flat_map(|path| if path.is_dir() { obj_files(&path) } else { vec![path] })
        .filter(|path| path.extension().is_some_and(|e| e == "obj"))
        .collect();
    files.sort();
    files
}

/// Vertices, edges and faces of some triangles, counted with sets; and whether each directed edge has its opposite.
fn count(triangles: &[[u32; 3]]) -> (usize, usize, usize, bool) {
    let vertices: BTreeSet<u32> = triangles.iter().flatten().copied().collect();
    let mut directed: BTreeMap<(u32, u32), usize> = BTreeMap::new();
    for &[a, b, c] in triangles {
        [(a, b), (b, c), (c, a)].into_iter().for_each(|e| *directed.entry(e).or_default() += 1);
    }
    let edges: BTreeSet<(u32, u32)> = directed.keys().map(|&(a, b)| (a.min(b), a.max(b))).collect();
    let closed = directed.iter().all(|(&(a, b), &n)| n == 1 && directed.get(&(b, a)) == Some(&1));
    (vertices.len(), edges.len(), triangles.len(), closed)
}

/// Volume by tetrahedra with the first corner, in plain sums.
fn volume(mesh: &IndexedMesh, triangles: &[[u32; 3]]) -> f64 {
    let at = |v: u32| mesh.positions[v as usize];
    let apex = at(triangles[0][0]);
    triangles.iter().map(|&[a, b, c]| (at(a) - apex).dot((at(b) - apex).cross(at(c) - apex)) / 6.0).sum()
}

fn decompositions_read_as_closed_objects() {
    let files = obj_files(&data("convex"));
    assert!(!files.is_empty());
    for file in files {
        let name = file.display().to_string();
        let bytes = std::fs::read(&file).expect("the file was listed");
        let mesh = read_mesh(&bytes, MeshFormat::Obj, &name).unwrap_or_else(|error| panic!("{error}"));
        let lines = |keyword: &[u8]| bytes.split(|&b| b == b'\n').filter(|line| line.starts_with(keyword)).count();
        assert_eq!(mesh.positions.len(), lines(b"v "), "{name}");
        assert_eq!(mesh.triangles.len(), lines(b"f "), "{name}: all faces are triangles");
        for object in &mesh.objects {
            let triangles = &mesh.triangles[object.triangles.clone()];
            let report = check_mesh(&mesh.positions, triangles, &CheckOptions::default());
            let (v, e, f, closed) = count(triangles);
            let topology = &report.topology;
            let context = format!("{name} {:?}", object.name);
            assert_eq!((topology.vertices, topology.edges, topology.triangles), (v, e, f), "{context}");
            assert_eq!(topology.manifold, closed, "{context}: {report}");
            assert_eq!(topology.euler_characteristic, v as i64 - e as i64 + f as i64, "{context}");
            let expected = volume(&mesh, triangles);
            let (min, max) = (DVec3::from(topology.measures.min), DVec3::from(topology.measures.max));
            let extent = (max - min).element_product();
            assert!((topology.measures.volume - expected).abs() <= 1e-12 * extent, "{context}");
            let convex = lines(b"o ") > 1;
            if convex && closed {
                assert_eq!(topology.genus, Some(0), "{context}");
                assert!(expected > 0.0, "{context}");
                let centroid = DVec3::from(topology.measures.centroid);
                assert!(centroid.cmpge(min).all() && centroid.cmple(max).all());
            }
            println!("{context}: {report}");
        }
    }
}
