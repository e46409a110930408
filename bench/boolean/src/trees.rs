//! OpenSCAD's trees, by `validate/run --bench-csg`: both sides make their primitives on the clock, so they are a table
//! of their own.

use std::path::Path;
use std::time::{Duration, Instant};

use serde::Deserialize;

use crate::conductor::spread;
use crate::entrant::CORES;
use crate::machine;

/// Numbers in the trees have six digits, and planes may be snapped together.
pub(crate) const TOLERANCE: f64 = 1e-6;

/// All trees together are not worth more.
const LIMIT: Duration = Duration::from_secs(240);

/// What both did with one tree, as the program in Python writes it; times in milliseconds.
#[derive(Debug, Clone, Default, Deserialize)]
pub(crate) struct Tree {
    pub(crate) name: String,
    /// From the text to the triangles, each round.
    pub(crate) planecut_rounds: Vec<f64>,
    /// Primitives and Booleans, each round.
    pub(crate) manifold_rounds: Vec<f64>,
    /// The best round of the whole process.
    pub(crate) wall: Option<f64>,
    /// What OpenSCAD once took on another machine.
    pub(crate) openscad: Option<f64>,
    pub(crate) planecut_volume: Option<f64>,
    pub(crate) manifold_volume: Option<f64>,
    /// What went wrong.
    pub(crate) note: String,
}

impl Tree {
    /// Smallest, median and largest of planecut and of manifold3d.
    pub(crate) fn spreads(&self) -> [Option<[f64; 3]>; 2] {
        [&self.planecut_rounds, &self.manifold_rounds].map(|rounds| spread(rounds.iter().copied()))
    }

    /// Why the times do not count.
    pub(crate) fn wrong(&self) -> Option<String> {
        let (ours, theirs) = (self.planecut_volume?, self.manifold_volume?);
        let is_equal = (ours - theirs).abs() <= TOLERANCE * theirs.abs();
        (!is_equal).then(|| format!("volume {ours} of planecut, {theirs} of manifold3d"))
    }

    /// How many times longer manifold3d takes.
    pub(crate) fn ratio(&self) -> Option<f64> {
        let [Some(ours), Some(theirs)] = self.spreads() else { return None };
        self.wrong().is_none().then_some(theirs[1] / ours[1])
    }
}

/// Times the trees, which prints a line for each.
pub(crate) fn run(trees: &[(impl AsRef<Path>, f64)], planecut: &str, rounds: usize, file: &Path) -> Vec<Tree> {
    let mut command = machine::pinned(concat!(env!("CARGO_MANIFEST_DIR"), "/../../validate/run"), CORES);
    command.args(["--bench-csg", "--planecut", planecut, "--rounds", &rounds.to_string(), "--json"]).arg(file);
    command.args(trees.iter().map(|(path, _)| path.as_ref())).env("RAYON_NUM_THREADS", CORES.to_string());
    match command.spawn() {
        Ok(mut child) => {
            let begin = Instant::now();
            while begin.elapsed() < LIMIT && matches!(child.try_wait(), Ok(None)) {
                std::thread::sleep(Duration::from_millis(50));
            }
            // it may have ended; what it has written by now counts
            let _ = child.kill();
            let _ = child.wait();
        }
        Err(error) => eprintln!("the trees are left out: {error}"),
    }
    serde_json::from_slice(&std::fs::read(file).unwrap_or_default()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::Tree;

    #[test]
    fn a_tree_counts_where_the_volumes_agree() {
        let text = r#"{"name": "a", "planecut_rounds": [2.0, 1.0, 4.0], "manifold_rounds": [6.0, 8.0], "wall": 5.0,
            "openscad": null, "planecut_volume": 3.0, "manifold_volume": 3.000001, "note": "", "stages": "not asked for"}"#;
        let tree: Tree = serde_json::from_str(text).unwrap();
        assert_eq!(tree.ratio(), Some(3.5));
        let wrong = Tree { manifold_volume: Some(3.1), ..tree.clone() };
        assert_eq!((wrong.ratio(), wrong.wrong().is_some()), (None, true));
        assert_eq!(Tree { planecut_rounds: Vec::new(), ..tree }.ratio(), None);
    }
}
