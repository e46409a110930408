//! What must not change the outcome, bit for bit: order, threads, repetition, what lies inside, walls between touching parts.

use glam::DVec3;
use planecut_csg::{Brush, BuiltBodies, Evaluation, MaterialId, Model, UnboundedBrushes, evaluate, evaluate_built};
use planecut_testkit::generate::{
    general_scene, kindred_scene, placed, sloped_brush, sloped_scene, split, with_materials, with_noise,
};
use planecut_testkit::random::Rng;
use planecut_testkit::scene::{brush, cuboid, ensure, ensure_eq, half_space, model, sweep, with_brushes};
use planecut_testkit::soundness::evaluate_soundly;

/// Every part of two outcomes that must agree.
pub(crate) fn same(found: &Evaluation, expected: &Evaluation, what: &str) -> Result<(), String> {
    let counts = |e: &Evaluation| (e.mesh.positions.len(), e.mesh.triangles.len(), e.mesh.faces.len());
    ensure_eq!(counts(found), counts(expected), format!("{what}: vertices, triangles, faces"));
    ensure_eq!(found.solid, expected.solid, format!("{what}: solid"));
    let bits = |e: &Evaluation| e.mesh.positions.iter().map(|p| p.to_array().map(f64::to_bits)).collect::<Vec<_>>();
    ensure!(bits(found) == bits(expected), "{what}: positions differ");
    ensure!(found.mesh.triangles == expected.mesh.triangles, "{what}: triangles differ");
    ensure!(found.mesh.triangle_faces == expected.mesh.triangle_faces, "{what}: faces of triangles differ");
    ensure!(found.mesh.faces == expected.mesh.faces, "{what}: faces differ");
    Ok(())
}

fn any_scene(rng: &mut Rng) -> Model {
    let scene = match rng.integer(0, 3) {
        0 => general_scene(rng),
        1 => kindred_scene(rng),
        _ => sloped_scene(rng),
    };
    let relative = 10_f64.powi(-rng.integer(10, 16) as i32);
    match rng.integer(0, 4) {
        0 => with_noise(rng, scene, relative),
        1 => placed(scene, 1.0 / 3.0, DVec3::new(1e3, 0.1, 1e6)),
        _ => scene,
    }
}

/// Brushes, and the planes of each, in another order.
fn shuffled(model: &Model, rng: &mut Rng) -> Model {
    with_brushes(model, |brushes| {
        rng.shuffle(brushes);
        for brush in brushes {
            rng.shuffle(&mut brush.faces);
        }
    })
}

#[test]
fn the_order_of_brushes_and_planes_changes_nothing() {
    sweep(500, any_scene, |model| {
        let expected = evaluate_soundly(model)?;
        (0..2).try_for_each(|k| same(&evaluate_soundly(&shuffled(model, &mut Rng::spread(k)))?, &expected, "shuffled"))
    });
}

#[test]
fn the_order_of_brushes_of_many_materials_changes_nothing() {
    let generate = |rng: &mut Rng| {
        let scene = any_scene(rng);
        with_materials(rng, scene, 3)
    };
    sweep(300, generate, |model| {
        let expected = evaluate_soundly(model)?;
        let other = with_brushes(model, |brushes| Rng::spread(1).shuffle(brushes));
        same(&evaluate_soundly(&other)?, &expected, "shuffled")
    });
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a thread pool");
    let pools = [pool(1), pool(2), pool(5)];
    let generate = |rng: &mut Rng| {
        let scenes = (0..8).map(|k| placed(any_scene(rng), 1.0, DVec3::splat(0.7 * f64::from(k))));
        model(scenes.flat_map(|scene| scene.tree.into_brushes()).collect())
    };
    sweep(20, generate, |model| {
        let outcome = |k: usize| pools[k].install(|| evaluate(model)).map_err(|error| error.to_string());
        let expected = outcome(0)?;
        (1..3).try_for_each(|k| same(&outcome(k)?, &expected, "threads"))
    });
}

#[test]
fn bodies_that_were_built_before_change_nothing() {
    sweep(300, any_scene, |model| {
        let expected = evaluate_soundly(model)?;
        let mut rng = Rng::spread(11);
        // some bodies are those of brushes that have one face more in the model
        let mut others = model.tree.brushes().to_vec();
        for brush in &mut others {
            brush.faces.truncate(brush.faces.len() - usize::from(rng.chance(0.5)));
        }
        let ahead = |brushes: &[Brush]| {
            evaluate_built(model, UnboundedBrushes::LeaveOut, &BuiltBodies::of(brushes))
                .map_err(|error| error.to_string())
        };
        same(&ahead(&others)?, &expected, "bodies of some brushes built ahead, and of others")?;
        same(&ahead(model.tree.brushes())?, &expected, "all bodies built ahead")
    });
}

#[test]
fn repeated_brushes_change_nothing() {
    sweep(200, any_scene, |model| {
        let expected = evaluate_soundly(model)?;
        let repeated = with_brushes(model, |brushes| brushes.extend(model.tree.brushes().iter().rev().cloned()));
        same(&evaluate_soundly(&repeated)?, &expected, "repeated")
    });
}

#[test]
fn brushes_inside_others_change_nothing() {
    let generate = |rng: &mut Rng| if rng.chance(0.5) { general_scene(rng) } else { sloped_scene(rng) };
    sweep(200, generate, |model| {
        let expected = evaluate_soundly(model)?;
        let mut rng = Rng::spread(7);
        let mut nested = model.tree.brushes().to_vec();
        for outer in model.tree.brushes() {
            // Some of its planes stay, so that faces coincide; others move inward.
            let mut inner = outer.clone();
            for face in &mut inner.faces {
                let (normal, offset) = (face.half_space.normal(), face.half_space.offset());
                if rng.chance(0.5) {
                    face.half_space = half_space(normal, offset - normal.length() * rng.float(0.01, 0.2));
                }
            }
            nested.push(inner);
        }
        same(&evaluate_soundly(&with_brushes(model, |brushes| *brushes = nested))?, &expected, "nested")
    });
}

#[test]
fn walls_between_the_parts_of_a_split_body_dissolve() {
    // One body; cut along planes through its own lattice points, so that cuts pass through corners and edges.
    sweep(
        400,
        |rng| model(vec![sloped_brush(rng)]),
        |scene| {
            let expected = evaluate_soundly(scene)?;
            let mut rng = Rng::spread(scene.tree.brushes().iter().flat_map(|b| &b.faces).count() as u64);
            let mut parts = scene.tree.brushes().to_vec();
            if parts.is_empty() {
                return Ok(());
            }
            let corners: Vec<DVec3> = expected.mesh.positions.iter().map(|p| p.round()).collect();
            split(&mut parts, 6, || {
                let through = if corners.is_empty() { DVec3::ZERO } else { rng.pick(&corners) };
                let normal = loop {
                    let normal = rng.point(-2.0, 2.0).round();
                    if normal != DVec3::ZERO {
                        break normal;
                    }
                };
                half_space(normal, normal.dot(through) + rng.whole(-1, 1))
            });
            same(&evaluate_soundly(&model(parts))?, &expected, "split")
        },
    );
}

#[test]
fn walls_between_the_parts_of_split_scenes_dissolve() {
    let generate = |rng: &mut Rng| if rng.chance(0.5) { general_scene(rng) } else { kindred_scene(rng) };
    sweep(200, generate, |scene| {
        let expected = evaluate_soundly(scene)?;
        if scene.tree.brushes().is_empty() {
            return Ok(());
        }
        let mut rng = Rng::spread(3);
        let mut parts = scene.tree.brushes().to_vec();
        split(&mut parts, 5, || {
            let normal = rng.unit();
            half_space(normal, normal.dot(rng.point(-1.0, 1.0)))
        });
        same(&evaluate_soundly(&model(parts))?, &expected, "split")
    });
}

#[test]
fn a_block_of_touching_cubes_is_one_box() {
    let cells = (0..27).map(|k| DVec3::new((k % 3).into(), (k / 3 % 3).into(), (k / 9).into()));
    let block = evaluate_soundly(&model(cells.map(|at| cuboid(at, at + 1.0)).collect())).expect("a sound mesh");
    let whole = evaluate_soundly(&model(vec![cuboid(DVec3::ZERO, DVec3::splat(3.0))])).expect("a sound mesh");
    same(&block, &whole, "block").unwrap();
    assert_eq!((block.mesh.faces.len(), block.mesh.triangles.len(), block.mesh.positions.len()), (6, 12, 8));
}

#[test]
fn a_box_cut_along_a_slope_is_one_box() {
    let whole = cuboid(DVec3::ZERO, DVec3::new(3.0, 2.0, 1.0));
    let slope = half_space(DVec3::new(1.0, 2.0, 3.0), 5.0);
    let parts = [slope, slope.flipped()].map(|plane| {
        let mut part = whole.clone();
        part.faces.extend(brush([plane]).faces);
        part
    });
    let parts = evaluate_soundly(&model(parts.to_vec())).expect("a sound mesh");
    let whole = evaluate_soundly(&model(vec![whole])).expect("a sound mesh");
    same(&parts, &whole, "cut").unwrap();
}

/// A union is worked out in a way of its own; within an intersection with a box that holds everything it is a tree like others.
#[test]
fn a_box_around_a_union_changes_nothing() {
    let scene = |rng: &mut Rng| {
        let scene = any_scene(rng);
        with_materials(rng, scene, 3)
    };
    sweep(300, scene, |model| {
        let expected = evaluate_soundly(model)?;
        let reach = 8.0 * expected.solid.min.abs().max(expected.solid.max.abs()).max_element() + 1.0;
        let around = Brush::cuboid(DVec3::splat(-reach), DVec3::splat(reach), MaterialId(0));
        let within = Model { tree: model.tree.clone() & around.into(), ..model.clone() };
        same(&evaluate_soundly(&within)?, &expected, "within a box")
    });
}
