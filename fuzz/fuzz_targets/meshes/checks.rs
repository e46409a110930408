//! What must hold of a scene.

use planecut_check::{CheckOptions, check_mesh};
use planecut_csg::{Evaluation, Material, MeshBody, Model, Tree, combine_meshes, evaluate, unite_meshes};

use super::decode::Scene;

/// How far volumes may be off: they are of order 1, and sums of products of rounded corners.
const TOLERANCE: f64 = 1e-9;

/// Evaluates the tree, each of two operands, what set algebra says of these, and the union of all meshes in two ways.
pub(crate) fn check(scene: &Scene) -> Result<(), String> {
    sound("the tree", scene.tree(), scene.is_on_grid)?;
    let [a, b] = [0, 1].map(|k| Tree::from(scene.operands[k].clone()));
    let sound = |what: &str, tree: Tree| sound(what, tree, scene.is_on_grid);
    let of_a = sound("A", a.clone())?.solid.volume;
    let of_b = sound("B", b.clone())?.solid.volume;
    let union = sound("A ∪ B", a.clone() | b.clone())?.solid.volume;
    let common = sound("A ∩ B", a.clone() & b.clone())?.solid.volume;
    let rest = sound("A − B", a.clone() - b.clone())?.solid.volume;
    let either = sound("A xor B", a.clone() ^ b)?.solid.volume;
    equal("|A ∪ B| + |A ∩ B| and |A| + |B|", union + common, of_a + of_b)?;
    equal("|A − B| + |A ∩ B| and |A|", rest + common, of_a)?;
    equal("|A xor B| + |A ∩ B| and |A ∪ B|", either + common, union)?;
    match sound("A − A", a.clone() - a)?.mesh.triangles.len() {
        0 => same_union(scene),
        count => Err(format!("found {count} triangles in A − A, expected none")),
    }
}

/// What leaves out early what lies inside of others must find the union that is found without.
fn same_union(scene: &Scene) -> Result<(), String> {
    let meshes: Vec<MeshBody> = scene.operands.iter().filter_map(|operand| operand.mesh.clone()).collect();
    let materials = || vec![Material::named("any")];
    let [early, whole] = [
        unite_meshes(&meshes, materials()),
        combine_meshes(&meshes, materials(), |inside| inside.all().next().is_some()),
    ]
    .map(|united| united.map_err(|error| format!("the union of all meshes: {error}")));
    equal("the union of all meshes, found in two ways", early?.solid.volume, whole?.solid.volume)
}

fn equal(what: &str, found: f64, expected: f64) -> Result<(), String> {
    if (found - expected).abs() <= TOLERANCE { Ok(()) } else { Err(format!("{what}: found {found} and {expected}")) }
}

/// Evaluates a tree; its mesh must be closed, manifold and, where coordinates are exact, free of crossings, and have the volume that is stated.
fn sound(what: &str, tree: Tree, is_on_grid: bool) -> Result<Evaluation, String> {
    let materials = vec![Material::named("any")];
    let evaluation = evaluate(&Model { materials, tree }).map_err(|error| format!("{what}: {error}"))?;
    let options = CheckOptions { crossings: is_on_grid, ..CheckOptions::default() };
    let report = check_mesh(&evaluation.mesh.positions, &evaluation.mesh.triangles, &options);
    if !report.is_sound() {
        return Err(format!("{what}: {report}"));
    }
    equal(
        &format!("{what}: the volume of the mesh and the one stated"),
        report.topology.measures.volume,
        evaluation.solid.volume,
    )?;
    Ok(evaluation)
}
