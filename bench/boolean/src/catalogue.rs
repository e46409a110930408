//! The workloads by name. A new one is a line here and a function in [`workloads`].

use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::meshes::{self, Copied, Pair};
use crate::workloads::{self, Contact, Menger, Task};

/// Series, whose growth is told.
const BOXES: &str = "random boxes";
const CARVE: &str = "carve";
const CARVE_ONE_BY_ONE: &str = "carve, one by one";
const DOME: &str = "dome carve";
const DOME_ONE_BY_ONE: &str = "dome carve, one by one";
const GRID: &str = "grid, one by one";
const MOVE: &str = "a brush moved among others";
const MESH_SPHERES: &str = "spheres as meshes";
const SPHERES: &str = "dense spheres";

/// Maps of fewer brushes are nothing to be timed.
const FEWEST_BRUSHES: u64 = 100;

type Make = Box<dyn Fn() -> Result<Task, String>>;

/// A workload that is not made yet.
pub(crate) struct Workload {
    /// The key in the JSON file.
    pub(crate) name: String,
    /// What it is one of several sizes of, and its size.
    pub(crate) series: Option<(&'static str, usize)>,
    pub(crate) is_quick: bool,
    pub(crate) in_blocks: InBlocks,
    make: Make,
}

/// Whether planecut also does a workload block by block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum InBlocks {
    No,
    Too,
    /// And nobody does it otherwise: it is too large.
    Only,
}

impl Workload {
    fn new(name: impl Into<String>, make: impl Fn() -> Task + 'static) -> Self {
        Self::read(name, move || Ok(make()))
    }

    fn read(name: impl Into<String>, make: impl Fn() -> Result<Task, String> + 'static) -> Self {
        Self { name: name.into(), series: None, is_quick: false, in_blocks: InBlocks::No, make: Box::new(make) }
    }

    fn of(self, series: &'static str, size: usize) -> Self {
        Self { series: Some((series, size)), ..self }
    }

    fn quick(self, is_quick: bool) -> Self {
        Self { is_quick, ..self }
    }

    fn in_blocks(self, in_blocks: InBlocks) -> Self {
        Self { in_blocks, ..self }
    }

    /// Its bodies, and what is done with them.
    pub(crate) fn make(&self) -> Result<Task, String> {
        (self.make)()
    }
}

/// All workloads; the sizes of a series ascend.
pub(crate) fn all() -> Vec<Workload> {
    let mut all = Vec::new();
    let rotated = |count: usize| {
        Workload::new(format!("union_{count}_rotated"), move || workloads::box_union(count, true)).of(BOXES, count)
    };
    all.push(rotated(1000).quick(true));
    all.push(Workload::new("union_1000_aligned", || workloads::box_union(1000, false)).quick(true));
    for count in [100, 250, 1000] {
        let name = format!("carve_{count}_capsules");
        all.push(Workload::new(name, move || workloads::carve(count)).of(CARVE, count).quick(count > 100));
    }
    all.push(Workload::new("carve_1000_turned", || workloads::carve_turned(1000)));
    for count in [100, 250, 1000] {
        let name = format!("carve_{count}_one_by_one");
        all.push(Workload::new(name, move || workloads::carve_one_by_one(count)).of(CARVE_ONE_BY_ONE, count));
    }
    for side in [4_u32, 6, 8, 10, 14] {
        let (name, count) = (plain("grid_iterated", side as usize, 10), side.pow(3) as usize);
        all.push(Workload::new(name, move || workloads::grid_iterated(side)).of(GRID, count).quick(side == 10));
    }
    all.push(Workload::new("menger_3", || workloads::menger(3, Menger::Batch)).quick(true));
    all.push(Workload::new("menger_3_one_by_one", || workloads::menger(3, Menger::OneByOne)));
    all.push(Workload::new("menger_3_combs", || workloads::menger(3, Menger::Combs)).quick(true));
    all.push(Workload::new("touching_by_face", || workloads::touching_cubes(10, Contact::Face)));
    all.push(Workload::new("touching_by_edge", || workloads::touching_cubes(10, Contact::Edge)));
    all.push(Workload::new("touching_by_vertex", || workloads::touching_cubes(10, Contact::Vertex)));
    all.extend(maps());
    for count in [100, 250, 500, 1000, 2000, 5000] {
        all.push(Workload::new(format!("dome_carve_{count}"), move || workloads::dome_carve(count)).of(DOME, count));
    }
    for count in [100, 250, 1000] {
        let made =
            Workload::new(format!("dome_carve_{count}_one_by_one"), move || workloads::dome_carve_one_by_one(count));
        all.push(made.of(DOME_ONE_BY_ONE, count).quick(count == 250));
    }
    all.push(Workload::new("terrain_224_cuts", || workloads::terrain(32, 224)));
    for triangles in [1000, 5000, 32_768, 200_000, 1_000_000] {
        let name = plain("dense_spheres", triangles, 32_768);
        let made = Workload::new(name, move || workloads::dense_spheres(triangles));
        all.push(made.of(SPHERES, triangles).quick(triangles == 32_768));
    }
    all.push(rotated(3000));
    all.extend([10_000, 30_000, 100_000].map(|count| rotated(count).in_blocks(InBlocks::Too)));
    all.push(rotated(1_000_000).in_blocks(InBlocks::Only));
    for count in [10, 100, 1000, 10_000, 100_000] {
        all.push(Workload::new(format!("move_in_{count}"), move || workloads::moved_box(count)).of(MOVE, count));
    }
    all.extend(ember_pairs());
    all.extend(ember_copies());
    for triangles in [1000, 8000, 32_000, 200_000, 1_000_000] {
        let made = Workload::new(format!("mesh_spheres_{triangles}"), move || meshes::spheres(triangles));
        all.push(made.of(MESH_SPHERES, triangles).quick(triangles == 32_000));
    }
    all.push(Workload::new("tori_1000", || meshes::tori(1000)));
    all
}

/// The pairs of the EMBER benchmark that are there, by their numbers in it.
fn ember_pairs() -> Vec<Workload> {
    let folder = data().join("mesh");
    let reference = reference(&folder);
    let pair = |entry: &Value| {
        let file = |key: &str| Some(folder.join(entry[key].as_str()?)).filter(|file| file.exists());
        let matrix = |key: &str| serde_json::from_value(entry[key].clone()).ok();
        Some(Pair {
            files: [file("a")?, file("b")?],
            matrices: [matrix("matrix_a")?, matrix("matrix_b")?],
            volume: entry["difference"].as_f64()?,
        })
    };
    let pairs = reference["pairs"].as_array().into_iter().flatten().map(pair);
    let numbered = ["ember_16", "ember_582", "ember_667"].into_iter().zip(pairs);
    let workload = |(name, pair): (&str, Option<Pair>)| {
        let pair = pair?;
        Some(Workload::read(name, move || meshes::pair(&pair)).quick(name == "ember_582"))
    };
    numbered.filter_map(workload).collect()
}

/// Each mesh of the EMBER benchmark that is there minus a copy of itself.
fn ember_copies() -> Vec<Workload> {
    let folder = data().join("mesh/ember");
    let files = std::fs::read_dir(&folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut files: Vec<PathBuf> = files.filter(|file| file.extension().is_some_and(|end| end == "stl")).collect();
    files.sort();
    let copies =
        [("moved", Copied::Moved), ("itself", Copied::Itself), ("flat", Copied::Flat), ("turned", Copied::Turned)];
    let workload = |file: &PathBuf, (ending, copied): (&str, Copied)| {
        let (file, stem) = (file.clone(), file.file_stem().unwrap_or_default().to_string_lossy().into_owned());
        Workload::read(format!("{stem}_{ending}"), move || meshes::minus_copy(&file, copied))
    };
    files.iter().flat_map(|file| copies.map(|copy| workload(file, copy))).collect()
}

/// A name with its size, but for the size that is best known.
fn plain(name: &str, size: usize, usual: usize) -> String {
    if size == usual { name.to_owned() } else { format!("{name}_{size}") }
}

/// The maps that are there, with the volumes of their unions; e1m1 first, and one by one too.
fn maps() -> Vec<Workload> {
    let folder = data().join("map");
    let mut maps: Vec<(String, PathBuf, f64)> = Vec::new();
    for (file, entry) in reference(&folder).as_object().into_iter().flatten() {
        let (file, stem) = (folder.join(file), Path::new(file).file_stem().unwrap_or_default().to_string_lossy());
        let is_sizeable = entry["brushes"].as_u64().is_some_and(|count| count >= FEWEST_BRUSHES);
        if let (true, Some(volume)) = (is_sizeable, entry["union_volume"].as_f64()) {
            maps.push((stem.into_owned(), file, volume));
        }
    }
    maps.sort_by_key(|(name, _, _)| name != "e1m1");
    let mut all = Vec::new();
    for (name, file, volume) in maps {
        let (is_first, one_by_one) = (name == "e1m1", format!("{name}_one_by_one"));
        all.push(Workload::read(name, {
            let file = file.clone();
            move || workloads::map(&file, volume)
        }));
        if is_first {
            all.push(Workload::read(one_by_one, move || workloads::map_one_by_one(&file, volume)));
            all.iter_mut().for_each(|workload| workload.is_quick = true);
        }
    }
    all
}

/// OpenSCAD's trees, those first that it takes longest for, with its seconds.
pub(crate) fn slowest_trees(count: usize) -> Vec<(PathBuf, f64)> {
    let folder = data().join("csg");
    let reference = reference(&folder);
    let tree = |entry: &Value| Some((folder.join(entry["file"].as_str()?), entry["openscad_seconds"].as_f64()?));
    let mut trees: Vec<(PathBuf, f64)> = reference.as_array().into_iter().flatten().filter_map(tree).collect();
    trees.sort_by(|a, b| b.1.total_cmp(&a.1));
    trees.truncate(count);
    trees
}

/// What is known about the files of a folder; nothing where it is not there.
fn reference(folder: &Path) -> Value {
    let text = std::fs::read(folder.join("reference.json")).unwrap_or_default();
    serde_json::from_slice(&text).unwrap_or_default()
}

/// Maps and trees that are no part of the project, beside its folder.
fn data() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data")
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::all;

    #[test]
    fn names_are_different_and_series_ascend() {
        let all = all();
        let names: HashSet<&str> = all.iter().map(|workload| workload.name.as_str()).collect();
        assert_eq!(names.len(), all.len());
        for (k, workload) in all.iter().enumerate() {
            let Some((series, size)) = workload.series else { continue };
            let before = all[..k].iter().filter_map(|other| other.series).filter(|other| other.0 == series);
            assert!(before.map(|other| other.1).max() < Some(size), "{}", workload.name);
        }
    }

    #[test]
    fn small_workloads_can_be_made() {
        for workload in all().iter().filter(|workload| workload.series.is_some_and(|(_, size)| size <= 250)) {
            let task = workload.make().unwrap();
            assert!(task.scene.bodies.iter().all(|body| body.triangles.len() >= 12), "{}", workload.name);
        }
    }
}
