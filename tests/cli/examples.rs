//! The example models: each is built, its skin is sound, and its cells add up to it.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use crate::support::{ROOT, agree, folder, planecut};

pub(crate) fn examples() -> Vec<PathBuf> {
    let folder = std::fs::read_dir(Path::new(ROOT).join("examples")).expect("the examples");
    let paths = folder.map(|entry| entry.expect("an entry").path());
    let mut models: Vec<PathBuf> =
        paths.filter(|path| path.extension().is_some_and(|ending| ending == "json")).collect();
    models.sort();
    models
}

fn report(model: &Path, options: &[&str]) -> Value {
    let folder = folder();
    let (mesh, report) = (folder.path().join("m.obj"), folder.path().join("r.json"));
    let files =
        ["build".as_ref(), model.as_os_str(), "-o".as_ref(), mesh.as_os_str(), "--report".as_ref(), report.as_os_str()];
    planecut(files.into_iter().chain(options.iter().map(|option| option.as_ref()))).expect_quiet_success();
    if options.is_empty() {
        planecut(["check".as_ref(), mesh.as_os_str()]).expect_quiet_success();
    }
    serde_json::from_slice(&std::fs::read(report).expect("a report")).expect("JSON")
}

#[test]
fn every_example_is_sound_and_its_cells_add_up() {
    let models = examples();
    assert!(models.len() >= 10);
    for model in models {
        let name = model.display();
        let skin = report(&model, &[]);
        assert_eq!((&skin["mesh"]["watertight"], &skin["mesh"]["manifold"]), (&json!(true), &json!(true)), "{name}");
        let volume = skin["solid"]["volume"].as_f64().expect("a volume");
        assert!(agree(&skin["mesh"]["volume"], volume, 1e-12), "{name}: {skin}");
        let cells = report(&model, &["--cells"]);
        assert!(agree(&cells["solid"]["volume"], volume, 1e-12), "{name}: {volume}, {cells}");
        assert!(agree(&cells["mesh"]["volume"], volume, 1e-12), "{name}: {volume}, {cells}");
        assert_eq!(cells["mesh"]["components"], cells["solid"]["cells"], "{name}");
    }
}

/// The volume of a sponge of depth three: 20³ of 27³ small cubes.
#[test]
fn the_sponge_has_the_volume_it_should() {
    let sponge = Path::new(ROOT).join("examples/menger.json");
    assert_eq!(report(&sponge, &[])["solid"]["volume"], json!(8000.0));
}
