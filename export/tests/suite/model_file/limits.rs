//! What is deep is written as long as it can be read.

use planecut_csg::{Brush, Material, MaterialId, Model, Tree};
use planecut_export::{ExportError, write_model};
use planecut_import::model::MAX_DEPTH;
use planecut_kernel::DVec3;

use super::support::{back, read, written};

/// Runs on a stack as small as threads commonly get.
fn on_a_small_stack(work: impl FnOnce() + Send + 'static) {
    let thread = std::thread::Builder::new().stack_size(256 * 1024).spawn(work).expect("a thread");
    thread.join().expect("no panic");
}

fn leaf(at: usize) -> Tree {
    let corner = DVec3::splat(at as f64);
    Brush::cuboid(corner, corner + 1.0, MaterialId(0)).into()
}

fn model(tree: Tree) -> Model {
    Model { materials: vec![Material::named("stone")], tree }
}

#[test]
fn chains_are_written_flat_however_long_they_are() {
    on_a_small_stack(|| {
        let count = 50_000;
        let chain = |join: fn(Tree, Tree) -> Tree| (1..count).map(leaf).fold(leaf(0), join);
        for join in [|a: Tree, b| a | b, |a, b| a & b, |a, b| a - b, |a, b| a ^ b] {
            let model = model(chain(join));
            assert_eq!(back(&model), model);
        }
        // from the right, where the reader does not join them
        let tree = (1..2000).rev().map(leaf).fold(leaf(2000), |all, leaf| leaf | all);
        let after = back(&model(tree.clone()));
        assert_eq!((after.tree.brushes(), after.tree.nodes().len()), (tree.brushes(), tree.brushes().len() + 1));
    });
}

/// What puts a tree one level deeper.
type Step = fn(Tree) -> Tree;

/// Trees whose leaves are as deep as the reader takes, and one level deeper.
#[test]
fn trees_that_are_too_deep_are_refused_and_no_others() {
    on_a_small_stack(|| {
        let most = MAX_DEPTH as usize;
        // differences of differences do not join; nothing is a node with others within
        let steps: [(Step, Tree, usize); 4] = [
            (|tree| leaf(0) - tree, leaf(1), 0),
            (|tree| !tree, leaf(1), 0),
            (|tree| !tree, Tree::empty(), 2),
            (|tree| !tree, Brush::default().into(), 3),
        ];
        for (step, innermost, own) in steps {
            // quadratic, as trees are appended to what is before them
            let deep = |levels: usize| model((0..levels).fold(innermost.clone(), |tree, _| step(tree)));
            let deepest = deep(most - own);
            let after = read(&written(&deepest, 1.0));
            assert!(after.tree.nodes().len() >= most - own);
            let mut text = Vec::new();
            let error = write_model(&deep(most - own + 1), 1.0, &mut text).expect_err("too deep");
            assert!(matches!(error, ExportError::ModelLimit { .. }), "{error}");
            let expected = "found operations within one another in 10001 levels, expected at most 10000";
            assert!(error.to_string().starts_with(expected), "{error}");
            assert!(text.is_empty(), "refused before the first byte");
        }
    });
}

/// Ten thousand levels are no ten thousand times ten thousand spaces.
#[test]
fn deep_trees_are_not_mostly_spaces() {
    let tree = (0..9000).fold(leaf(0), |tree, at| leaf(at) - tree);
    let text = written(&model(tree), 1.0);
    assert!(text.len() < 9000 * 400, "{}", text.len());
}
