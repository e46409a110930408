//! Who takes part, on how many cores, and for how long.

use std::time::Duration;

use crate::machine;

pub(crate) const PLANECUT: &str = "planecut";
/// The same from lists of half-spaces: the bodies are built while the clock runs.
pub(crate) const PLANECUT_PLANES: &str = "planecut from planes";
pub(crate) const PLANECUT_BLOCKS: &str = "planecut in blocks";
/// Ours: they work on half-spaces.
pub(crate) const OURS: [&str; 3] = [PLANECUT, PLANECUT_PLANES, PLANECUT_BLOCKS];
pub(crate) const MANIFOLD3D: &str = "manifold3d";
pub(crate) const OPENSCAD: &str = "openscad";

/// How many cores the comparison is about.
pub(crate) const CORES: usize = 2;

/// What a run may take that is made for the sake of [`Limits::warm`].
const WARM_RUN: Duration = Duration::from_secs(5);

/// A kernel on some cores.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Entrant {
    pub(crate) name: &'static str,
    pub(crate) cores: usize,
}

/// When an entrant has had enough.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Limits {
    /// No further run begins that would probably end after the time limit, but for [`Self::warm`].
    pub(crate) total: Duration,
    /// As many runs follow the first, which warms up, whatever they take in all, where each takes no more than [`WARM_RUN`].
    pub(crate) warm: usize,
    /// A run that takes longer is ended, and its process with it.
    pub(crate) single: Duration,
}

impl Limits {
    /// Whether there is time for another run after some, the last of which took `last` of all `used` seconds.
    pub(crate) fn has_time(&self, runs: usize, used: f64, last: f64) -> bool {
        let is_warming = runs <= self.warm && last <= WARM_RUN.as_secs_f64();
        runs == 0 || is_warming || used + last <= self.total.as_secs_f64()
    }
}

impl Entrant {
    /// All that are here. A quick run leaves out those that are far behind.
    pub(crate) fn all(is_quick: bool) -> Vec<Self> {
        let both = |name| Self { name, cores: CORES };
        let one = |name| Self { name, cores: 1 };
        let mut all = vec![both(PLANECUT), one(PLANECUT), both(PLANECUT_PLANES), both(MANIFOLD3D)];
        if is_quick {
            all.push(both("manifold-rust"));
            return all;
        }
        all.extend([one(MANIFOLD3D), both("manifold-rust"), both("boolmesh"), both("csgrs")]);
        if machine::has(OPENSCAD) {
            all.push(both(OPENSCAD));
        }
        all
    }

    /// planecut, block by block.
    pub(crate) const IN_BLOCKS: Self = Self { name: PLANECUT_BLOCKS, cores: CORES };

    pub(crate) fn is_ours(self) -> bool {
        OURS.contains(&self.name)
    }

    /// Whether it takes part where bodies are meshes that are made of arrays on the clock.
    pub(crate) fn does_meshes(self) -> bool {
        [PLANECUT, MANIFOLD3D].contains(&self.name)
    }

    /// The key in the JSON file.
    pub(crate) fn key(self) -> String {
        format!("{} ({} core{})", self.name, self.cores, if self.cores == 1 { "" } else { "s" })
    }

    /// The two that the comparison is about have the most time; the others show no more than where they stand.
    pub(crate) fn limits(self, is_quick: bool) -> Limits {
        let (total, single, warm) = match (self.name, self.cores, is_quick) {
            (PLANECUT | PLANECUT_PLANES | PLANECUT_BLOCKS | MANIFOLD3D, CORES, false) => (4.0, 120.0, 3),
            (PLANECUT | MANIFOLD3D, _, false) => (2.0, 25.0, 0),
            ("manifold-rust", _, false) => (2.0, 15.0, 0),
            (OPENSCAD, _, false) => (2.0, 40.0, 0),
            (_, _, false) => (1.5, 5.0, 0),
            (PLANECUT | MANIFOLD3D, CORES, true) => (2.0, 12.0, 0),
            (PLANECUT | PLANECUT_PLANES | MANIFOLD3D, _, true) => (0.8, 12.0, 0),
            (_, _, true) => (0.8, 1.6, 0),
        };
        Limits { total: Duration::from_secs_f64(total), single: Duration::from_secs_f64(single), warm }
    }

    /// How far a volume may be off, relative. OpenSCAD writes six digits of each coordinate; manifold3d moves the vertices of meshes.
    pub(crate) fn tolerance(self, is_of_meshes: bool) -> f64 {
        match self.name {
            OPENSCAD => 1e-4,
            _ if is_of_meshes => 1e-6,
            _ => 1e-9,
        }
    }
}
