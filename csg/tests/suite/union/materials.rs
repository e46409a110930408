//! Materials change labels and where faces end, never the shape. Lattice scenes with materials are counted in `grid`.

use planecut_csg::{MaterialId, Model};

use planecut_testkit::generate::{general_scene, kindred_scene, sloped_scene, with_materials};
use planecut_testkit::random::Rng;
use planecut_testkit::scene::{ensure, ensure_eq, sweep};
use planecut_testkit::soundness::{area_by_material, contraction, evaluate_soundly};

fn scene(rng: &mut Rng) -> Model {
    let scene = match rng.integer(0, 2) {
        0 => general_scene(rng),
        1 => kindred_scene(rng),
        _ => sloped_scene(rng),
    };
    with_materials(rng, scene, 3)
}

#[test]
fn the_shape_does_not_depend_on_materials() {
    sweep(300, scene, |model| {
        let found = evaluate_soundly(model)?;
        let mut plain = model.clone();
        for face in plain.tree.brushes_mut().iter_mut().flat_map(|brush| &mut brush.faces) {
            face.material = MaterialId(0);
        }
        let plain = evaluate_soundly(&plain)?;
        let (a, b) = (&found.solid, &plain.solid);
        let (size, slack) = ((a.max - a.min).length(), contraction(a) * model.tree.brushes().len() as f64);
        ensure!(
            (a.volume - b.volume).abs() <= slack * b.area + slack * size.powi(2),
            "volume {}, {}",
            a.volume,
            b.volume
        );
        let total: f64 = area_by_material(&found.mesh).iter().sum();
        for area in [a.area, total] {
            ensure!((area - b.area).abs() <= slack * size, "area {area}, {}", b.area);
        }
        ensure_eq!((a.min, a.max), (b.min, b.max), "box");
        ensure!(found.mesh.faces.len() >= plain.mesh.faces.len(), "fewer faces than of one material");
        Ok(())
    });
}

/// Only names order materials: with the list reversed, everything but the ids is the same.
#[test]
fn the_order_of_the_list_of_materials_changes_nothing() {
    sweep(200, scene, |model| {
        let expected = evaluate_soundly(model)?.mesh;
        let last = model.materials.len() as u32 - 1;
        let mut reversed = model.clone();
        reversed.materials.reverse();
        for face in reversed.tree.brushes_mut().iter_mut().flat_map(|brush| &mut brush.faces) {
            face.material = MaterialId(last - face.material.0);
        }
        let mut found = evaluate_soundly(&reversed)?.mesh;
        for face in &mut found.faces {
            face.material = MaterialId(last - face.material.0);
        }
        ensure!(found.positions == expected.positions && found.triangles == expected.triangles, "meshes differ");
        ensure_eq!(found.faces, expected.faces, "faces");
        Ok(())
    });
}
