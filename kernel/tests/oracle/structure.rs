//! What the kernel says about a polytope, with planes named by their place in the order of insertion.

use std::collections::HashMap;

use planecut_kernel::{IncrementalPolytope, PlaneIdx};

use crate::truth::{Triple, Truth};

/// Two polytopes with the same planes in the same order must be equal in this.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Structure {
    empty: bool,
    bounded: bool,
    /// Per plane; not compared (and left out) if the set is empty.
    redundant: Vec<bool>,
    /// Planes of each simple vertex, rotated so that the least comes first, sorted; `None` is an infinity plane.
    corners: Vec<[Option<usize>; 3]>,
}

impl Structure {
    /// Reads `polytope`, whose planes in the order of insertion are `order`.
    ///
    /// # Errors
    /// Where the kernel's own answers do not fit together.
    pub(crate) fn of(polytope: &IncrementalPolytope, order: &[PlaneIdx]) -> Result<Self, String> {
        let rank: HashMap<PlaneIdx, usize> = order.iter().enumerate().map(|(k, &p)| (p, k)).collect();
        let mut corners = Vec::new();
        for planes in polytope.simple_vertices() {
            if planes.iter().flatten().any(|p| !rank.contains_key(p)) {
                return Err(format!("simple vertex {planes:?} names a plane that is not there"));
            }
            corners.push(least_rotation(planes.map(|p| p.map(|p| rank[&p]))));
        }
        corners.sort_unstable();
        let empty = polytope.is_empty();
        let redundant = order.iter().map(|&p| polytope.is_redundant(p)).collect();
        let structure = Self { empty, bounded: polytope.is_bounded(), redundant, corners };
        structure.check_consistent()?;
        Ok(if empty { Self { redundant: Vec::new(), ..structure } } else { structure })
    }

    /// A fresh polytope from the same half-spaces in the order of insertion.
    ///
    /// # Errors
    /// See [`Structure::of`].
    pub(crate) fn of_fresh_build(polytope: &IncrementalPolytope, order: &[PlaneIdx]) -> Result<Self, String> {
        let mut fresh = IncrementalPolytope::new();
        let mut fresh_order = Vec::with_capacity(order.len());
        for &index in order {
            let plane = polytope.plane(index).ok_or_else(|| format!("{index:?} is gone"))?;
            fresh_order.push(fresh.add_plane(*plane).plane());
        }
        Self::of(&fresh, &fresh_order).map_err(|e| format!("fresh build: {e}"))
    }

    fn check_consistent(&self) -> Result<(), String> {
        if self.empty {
            let quiet = self.bounded && self.corners.is_empty() && self.redundant.iter().all(|&r| r);
            return if quiet { Ok(()) } else { Err(format!("empty, yet {self:?}")) };
        }
        if self.bounded && self.corners.iter().flatten().any(Option::is_none) {
            return Err("bounded, yet an infinity plane has a vertex".into());
        }
        for (h, &redundant) in self.redundant.iter().enumerate() {
            let has_vertex = self.corners.iter().flatten().any(|&p| p == Some(h));
            if has_vertex == redundant {
                return Err(format!("plane {h}: redundant is {redundant}, has a vertex is {has_vertex}"));
            }
        }
        Ok(())
    }

    /// Compares with the definition.
    ///
    /// # Errors
    /// The first difference.
    pub(crate) fn compare(&self, truth: &Truth) -> Result<(), String> {
        agree("is_empty", &self.empty, &truth.empty)?;
        agree("is_bounded", &self.bounded, &truth.bounded)?;
        agree("redundant planes", &self.redundant, &truth.redundant)?;
        let finite: Vec<Triple> = self.corners.iter().filter_map(|&[a, b, c]| Some([a?, b?, c?])).collect();
        agree("finite simple vertices", &finite, &truth.corners)?;
        // The least rotation puts the infinity plane first, which leaves `i, j` in counter-clockwise order.
        let rays: Vec<[usize; 2]> =
            self.corners.iter().filter_map(|&[a, b, c]| a.map_or(Some([b?, c?]), |_| None)).collect();
        agree("ideal vertices of one infinity plane", &rays, &truth.rays)
    }
}

/// Compares two answers to one question.
///
/// # Errors
/// Both answers where they differ.
pub(crate) fn agree<T: PartialEq + std::fmt::Debug>(what: &str, kernel: &T, truth: &T) -> Result<(), String> {
    if kernel == truth { Ok(()) } else { Err(format!("{what}: kernel {kernel:?}, truth {truth:?}")) }
}

fn least_rotation([a, b, c]: [Option<usize>; 3]) -> [Option<usize>; 3] {
    [[a, b, c], [b, c, a], [c, a, b]].into_iter().min().expect("three rotations")
}
