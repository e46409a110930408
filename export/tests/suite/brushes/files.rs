//! Files that others made, in the data folder; ignored where it is absent.

use std::fs;
use std::path::{Path, PathBuf};

use planecut_cells::{Cell, Solid};
use planecut_csg::{Brush, BrushFace, Model, Tree};
use planecut_export::BrushFormat;
use planecut_import::map::{MapOptions, read_map};
use planecut_import::scad::{ScadOptions, read_scad};
use planecut_kernel::HalfSpace;
use planecut_shapes::polyhedron::convex_tree;
use planecut_testkit::data::data;

use super::support::{body, read, volume, written};

planecut_testkit::tests_on_data!(volumes_of_maps_stay, planes_of_whole_points_in_maps_stay, volumes_of_trees_stay);

/// By how much the sum of volumes may change, relatively.
const TOLERANCE: f64 = 1e-12;
/// Larger trees would take long.
const MAX_BYTES: [(&str, u64); 2] = [("map", 1 << 20), ("csg", 1 << 12)];

/// Files of one ending, by name.
fn shared(ending: &str) -> Vec<(String, PathBuf)> {
    let folder = data(ending);
    let entries = |path: &Path| fs::read_dir(path).expect("a folder").map(|e| e.expect("an entry").path());
    let files = entries(&folder).filter(|path| path.is_dir()).flat_map(|path| entries(&path).collect::<Vec<_>>());
    let most = MAX_BYTES.iter().find(|(known, _)| *known == ending).expect("a known ending").1;
    let is_wanted = |path: &PathBuf| {
        path.extension().is_some_and(|found| found == ending)
            && fs::metadata(path).is_ok_and(|metadata| metadata.len() <= most)
    };
    let name = |path: &Path| path.strip_prefix(&folder).expect("inside").display().to_string();
    let mut files: Vec<_> = files.filter(is_wanted).map(|path| (name(&path), path)).collect();
    files.sort();
    files
}

/// The maps that are well formed, and their bounded brushes.
fn maps() -> Vec<(String, Model)> {
    let read = |(name, path): (String, PathBuf)| {
        let text = fs::read(path).expect("a readable file");
        let mut model = read_map(&text, &name, &MapOptions::default()).ok()?.model;
        let brushes = model.tree.brushes().iter().filter(|brush| body(brush).is_bounded()).cloned().collect();
        model.tree = Tree::union_of(brushes);
        (!model.tree.brushes().is_empty()).then_some((name, model))
    };
    shared("map").into_iter().filter_map(read).collect()
}

/// Disjoint convex cells of a solid, where that is bounded.
fn cells(model: &Model) -> Option<Vec<Brush>> {
    let tree = convex_tree(&model.tree).unwrap_or_else(|error| panic!("{error}"));
    let solid = Solid::from_tree(&tree);
    solid.volume()?;
    let brush = |cell: &Cell| {
        let faces = cell.planes().map(|(_, plane)| {
            let half_space = *solid.table().half_space(plane.plane);
            BrushFace { half_space, material: plane.material }
        });
        Brush { faces: faces.collect(), ..Brush::default() }
    };
    Some(solid.cells().map(brush).collect())
}

fn sum(brushes: &[Brush]) -> f64 {
    brushes.iter().map(|brush| volume(&body(brush))).sum()
}

/// Compares the sums of the volumes of bodies, each built again from its planes, before and after.
fn assert_same_volumes(name: &str, brushes: &[Brush], model: &Model) {
    let expected = sum(brushes);
    for format in BrushFormat::ALL {
        let text = written(brushes, &model.materials, format, 1.0);
        let found = sum(read(&text, format).tree.brushes());
        let off = (found - expected).abs() / expected;
        assert!(off <= TOLERANCE, "{name}, {format:?}: {found} for {expected}, off by {off:e}");
    }
}

fn volumes_of_maps_stay() {
    for (name, model) in maps() {
        assert_same_volumes(&name, model.tree.brushes(), &model);
        assert_same_volumes(&name, &cells(&model).expect("brushes are bounded"), &model);
    }
}

/// Whether points with up to six digits behind the point lie on a plane: the fraction that its offset is of what its normal is a
/// multiple of has as many.
fn is_decimal(half_space: &HalfSpace) -> bool {
    let [x, y, z] = half_space.normal().to_array();
    let all = [x, y, z, half_space.offset()];
    let gcd = |mut a: i128, mut b: i128| {
        while b != 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    let is_whole = all.iter().all(|v| v.fract() == 0.0 && v.abs() < 1e9);
    is_whole && (all[3] as i128 * 1_000_000) % all[..3].iter().fold(0, |g, v| gcd(g, *v as i128)) == 0
}

/// Bodies, textures and the classes of entities come back from a map, in its order within each entity.
fn planes_of_whole_points_in_maps_stay() {
    let maps = maps();
    let mut compared = 0;
    for (name, model) in &maps {
        let after = read(&written(model.tree.brushes(), &model.materials, BrushFormat::Map, 1.0), BrushFormat::Map);
        // by their numbers, which tell their lines
        let before = model.tree.brushes();
        let (world, others): (Vec<usize>, Vec<usize>) = (0..before.len()).partition(|k| before[*k].name.is_none());
        assert_eq!(before.len(), after.tree.brushes().len(), "{name}");
        for (number, after_brush) in world.into_iter().chain(others).zip(after.tree.brushes()) {
            let before = &before[number];
            let context = format!("{name}:{:?}", model.tree.source_line(number));
            let class =
                |brush: &Brush| brush.name.as_deref().and_then(|n| n.rsplit_once(" #")).map(|(c, _)| c.to_owned());
            assert_eq!(class(before), class(after_brush), "{context}");
            let polytope = body(before);
            let with_face = polytope.planes().zip(&before.faces);
            let faces = with_face.filter(|((plane, _), _)| polytope.face_polygon(*plane).is_some());
            for ((_, face), found) in faces.zip(&after_brush.faces) {
                let texture = |model: &Model, face: &BrushFace| model.materials[face.material.0 as usize].name.clone();
                assert_eq!(texture(model, face), texture(&after, found), "{context}");
                if is_decimal(&face.half_space) {
                    assert_eq!(face.half_space, found.half_space, "{context}");
                    compared += 1;
                }
            }
        }
    }
    assert!(compared > 0);
}

fn volumes_of_trees_stay() {
    for (name, path) in shared("csg") {
        let text = fs::read(&path).expect("a readable file");
        let options = ScadOptions { folder: path.with_file_name(""), ..ScadOptions::default() };
        // those that ask for what the reader has not are no concern of the writers
        let Ok(import) = read_scad(&text, &name, &options) else { continue };
        let Some(cells) = cells(&import.model).filter(|cells| !cells.is_empty()) else { continue };
        assert_same_volumes(&name, &cells, &import.model);
    }
}
