//! Trees of all bodies: membership of points, and the skin of the same tree.

use planecut_cells::Solid;
use planecut_csg::{Model, evaluate};

use planecut_testkit::random::Rng;
use planecut_testkit::scene::{Scene, ensure, scaled, sweep};
use planecut_testkit::shape::{Kind, Shape, bounded, ensure_close, ensure_membership, ensure_sound, random_shape};

/// The solid agrees with points, and its cells with both skins: that of the tree and their own.
fn judge(shape: &Shape, solid: &Solid) -> Result<(), String> {
    ensure_membership(shape, solid, 300)?;
    let Model { materials, tree } = shape.model();
    let skin = evaluate(&Model { materials: materials.clone(), tree }).map_err(|error| error.to_string())?.solid;
    let volume = solid.volume().ok_or("unbounded")?;
    ensure_close("volume of cells and of the skin", volume, skin.volume, 1e-3)?;
    let (mesh, measures) = solid.mesh(&materials).map_err(|error| error.to_string())?;
    ensure_close("volume of cells and of their skin", measures.volume, skin.volume, 1e-3)?;
    ensure_close("area of both skins", measures.area, skin.area, 1.0)?;
    ensure!(mesh.triangles.is_empty() == solid.is_empty(), "a mesh of {} triangles", mesh.triangles.len());
    let meshes = solid.cell_meshes(&materials).map_err(|error| error.to_string())?;
    ensure!(meshes.len() == solid.cells().count(), "{} meshes of cells", meshes.len());
    Ok(())
}

fn sweep_kind(kind: Kind, count: u64, leaves: usize, solid: impl Fn(&Shape) -> Solid) {
    let generate = |rng: &mut Rng| {
        let leaves = 1 + rng.below(leaves);
        bounded(random_shape(rng, kind, leaves))
    };
    sweep(count, generate, |shape| {
        let solid = solid(shape);
        ensure_sound(&solid)?;
        judge(shape, &solid)
    });
}

#[test]
fn trees_of_sloped_bodies() {
    sweep_kind(Kind::Sloped, 200, 8, |shape| Solid::from_tree(&shape.tree()));
}

#[test]
fn trees_of_turned_bodies() {
    sweep_kind(Kind::Turned, 120, 6, |shape| Solid::from_tree(&shape.tree()));
}

#[test]
fn trees_of_mixed_bodies() {
    sweep_kind(Kind::Mixed, 120, 10, |shape| Solid::from_tree(&shape.tree()));
}

#[test]
fn operators_on_sloped_bodies() {
    sweep_kind(Kind::Sloped, 100, 6, Shape::by_operators);
}

#[test]
fn operators_on_mixed_bodies() {
    sweep_kind(Kind::Mixed, 80, 6, Shape::by_operators);
}

/// Trees of up to 60 leaves; soundness of all pairs of cells would take too long.
#[test]
fn large_trees() {
    for (kind, count) in [(Kind::Boxes, 30), (Kind::Sloped, 15), (Kind::Mixed, 12)] {
        let generate = |rng: &mut Rng| {
            let leaves = 10 + rng.below(51);
            bounded(random_shape(rng, kind, leaves))
        };
        sweep(count, generate, |shape| judge(shape, &Solid::from_tree(&shape.tree())));
    }
}

#[test]
fn unbounded_results_hold_the_right_points() {
    let mut unbounded = 0;
    for seed in 0..scaled(200) {
        let mut rng = Rng::spread(seed);
        let leaves = 1 + rng.below(6);
        let shape = random_shape(&mut rng, Kind::Mixed, leaves);
        let solid = Solid::from_tree(&shape.tree());
        let verdict = ensure_sound(&solid).and_then(|()| ensure_membership(&shape, &solid, 200));
        assert_eq!(verdict, Ok(()), "seed {seed}: {}", shape.as_rust());
        unbounded += usize::from(!solid.is_bounded());
        assert_eq!(solid.volume().is_some(), solid.is_bounded());
        assert!(solid.is_bounded() || solid.mesh(&shape.model().materials).is_err());
    }
    assert!(unbounded > 20, "only {unbounded} unbounded results");
}
