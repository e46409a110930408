//! Identities of set algebra: two ways to one solid give one mesh.

use planecut_csg::{Evaluation, Model, Tree, UnboundedBrushes};

use super::random::{Kind, Shape, bounded, random_shape};
use planecut_testkit::random::Rng;
use planecut_testkit::scene::{Scene, ensure, ensure_eq, sweep};
use planecut_testkit::soundness::evaluate_soundly_with;

/// Three solids.
#[derive(Debug, Clone)]
struct Three([Shape; 3]);

impl Scene for Three {
    fn model(&self) -> Model {
        self.0[0].model()
    }

    fn smaller(&self) -> Vec<Self> {
        (0..3)
            .flat_map(|k| {
                self.0[k].smaller().into_iter().map(move |smaller| {
                    let mut all = self.0.clone();
                    all[k] = smaller;
                    Self(all)
                })
            })
            .collect()
    }

    fn as_rust(&self) -> String {
        self.0.iter().map(Scene::as_rust).collect()
    }
}

fn three(rng: &mut Rng) -> Three {
    let kind = if rng.chance(0.6) { Kind::Lattice } else { Kind::Mixed };
    Three([0; 3].map(|_| {
        let leaves = 1 + rng.below(3);
        let shape = random_shape(rng, kind, leaves);
        bounded(shape, rng)
    }))
}

fn solve(scene: &Three, tree: Tree) -> Result<Evaluation, String> {
    evaluate_soundly_with(&Model { materials: scene.model().materials, tree }, UnboundedBrushes::Keep)
}

/// The same positions, triangles and faces.
fn ensure_same(scene: &Three, what: &str, [left, right]: [Tree; 2]) -> Result<(), String> {
    let (left, right) = (solve(scene, left)?, solve(scene, right)?);
    ensure_eq!(left.solid, right.solid, format!("{what}: solid"));
    ensure!(left.mesh.positions == right.mesh.positions, "{what}: positions differ");
    ensure!(left.mesh.triangles == right.mesh.triangles, "{what}: triangles differ");
    ensure!(left.mesh.faces == right.mesh.faces, "{what}: faces differ");
    Ok(())
}

fn ensure_empty(scene: &Three, what: &str, tree: Tree) -> Result<(), String> {
    let evaluation = solve(scene, tree)?;
    ensure!(evaluation.mesh.triangles.is_empty(), "{what}: {} triangles", evaluation.mesh.triangles.len());
    Ok(())
}

#[test]
fn identities_of_set_algebra_hold_bit_for_bit() {
    sweep(150, three, |scene| {
        let trees = || scene.0.clone().map(|shape| shape.tree());
        let pair = |f: fn([Tree; 3]) -> Tree, g: fn([Tree; 3]) -> Tree| [f(trees()), g(trees())];
        let twice = |tree: Tree| (tree.clone(), tree);
        let [a, b, _] = trees();
        ensure_same(scene, "A ∪ A = A", [a.clone() | a.clone(), a.clone()])?;
        ensure_same(scene, "A ∩ A = A", [a.clone() & a.clone(), a.clone()])?;
        ensure_same(scene, "A − B − B = A − B", [a.clone() - b.clone() - b.clone(), a.clone() - b.clone()])?;
        ensure_same(scene, "¬¬A = A", [!!a.clone(), a.clone()])?;
        ensure_same(scene, "(A ∩ B) ∪ (A − B) = A", [(a.clone() & b.clone()) | (a.clone() - b.clone()), a.clone()])?;
        ensure_same(scene, "A ∪ (A ∩ B) = A", [a.clone() | (a.clone() & b), a.clone()])?;
        ensure_empty(scene, "A − A", a.clone() - a.clone())?;
        ensure_empty(scene, "A ^ A", a.clone() ^ a.clone())?;
        ensure_empty(scene, "A ∩ ¬A", a.clone() & !a)?;
        ensure_same(scene, "commuted", pair(|[a, b, c]| a | b | c, |[a, b, c]| c | b | a))?;
        ensure_same(scene, "A − B = A ∩ ¬B", pair(|[a, b, _]| a - b, |[a, b, _]| a & !b))?;
        ensure_same(scene, "De Morgan", pair(|[a, b, c]| a - (b | c), |[a, b, c]| a & !b & !c))?;
        ensure_same(scene, "A ∪ B by complements", pair(|[a, b, _]| a | b, |[a, b, _]| !(!a & !b)))?;
        ensure_same(scene, "distributed", pair(|[a, b, c]| a & (b | c), |[a, b, c]| (a.clone() & b) | (a & c)))?;
        let xor = twice(Tree::empty());
        ensure_eq!(xor.0.nodes().len(), 1, "nothing is one node");
        ensure_same(
            scene,
            "A ^ B = (A − B) ∪ (B − A)",
            pair(|[a, b, _]| a ^ b, |[a, b, _]| (a.clone() - b.clone()) | (b - a)),
        )?;
        ensure_same(scene, "A ^ B ^ C", pair(|[a, b, c]| a ^ b ^ c, |[a, b, c]| c ^ (b ^ a)))
    });
}
