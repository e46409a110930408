//! What the kernel says about a polytope, with planes named by their place in the order of insertion.

use planecut_kernel::{IncrementalPolytope, PlaneIdx};

use crate::exact::Coefficients;
use crate::kernel_calls::half_space;
use crate::truth::{Triple, Truth};

/// Two polytopes with the same planes in the same order must be equal in this.
#[derive(Debug, PartialEq, Eq)]
pub struct Structure {
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
    pub fn of(polytope: &IncrementalPolytope, order: &[PlaneIdx]) -> Result<Self, String> {
        let mut rank = vec![None; order.iter().map(|plane| plane.0 + 1).max().unwrap_or(0)];
        order.iter().enumerate().for_each(|(k, plane)| rank[plane.0] = Some(k));
        let mut corners = Vec::with_capacity(2 * order.len() + 4);
        for planes in polytope.simple_vertices() {
            let ranks = planes.map(|plane| plane.and_then(|plane| rank.get(plane.0).copied().flatten()));
            if planes.iter().zip(ranks).any(|(plane, rank)| plane.is_some() != rank.is_some()) {
                return Err(format!("simple vertex {planes:?} names a plane that is not there"));
            }
            corners.push(least_rotation(ranks));
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
    pub fn of_fresh_build(polytope: &IncrementalPolytope, order: &[PlaneIdx]) -> Result<Self, String> {
        let mut fresh = IncrementalPolytope::new();
        let mut fresh_order = Vec::with_capacity(order.len());
        for &index in order {
            let plane = polytope.plane(index).ok_or_else(|| format!("{index:?} is gone"))?;
            fresh_order.push(fresh.add_plane(*plane).plane());
        }
        Self::of(&fresh, &fresh_order).map_err(|e| format!("fresh build: {e}"))
    }

    /// That of a new polytope from planes in this order.
    ///
    /// # Panics
    /// Where the kernel's own answers do not fit together.
    #[must_use]
    pub fn of_planes(planes: &[Coefficients]) -> Self {
        let mut polytope = IncrementalPolytope::new();
        let order: Vec<PlaneIdx> = planes.iter().map(|&p| polytope.add_plane(half_space(p)).plane()).collect();
        Self::of(&polytope, &order).unwrap_or_else(|e| panic!("{e}"))
    }

    fn check_consistent(&self) -> Result<(), String> {
        if self.empty {
            let quiet = self.bounded && self.corners.is_empty() && self.redundant.iter().all(|&r| r);
            return if quiet { Ok(()) } else { Err(format!("empty, yet {self:?}")) };
        }
        if self.bounded && self.corners.iter().flatten().any(Option::is_none) {
            return Err("bounded, yet an infinity plane has a vertex".into());
        }
        let mut seen = vec![false; self.redundant.len()];
        self.corners.iter().flatten().flatten().for_each(|&h| seen[h] = true);
        for (h, (&redundant, &has_vertex)) in self.redundant.iter().zip(&seen).enumerate() {
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
    pub fn compare(&self, truth: &Truth) -> Result<(), String> {
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
pub fn agree<T: PartialEq + std::fmt::Debug>(what: &str, kernel: &T, truth: &T) -> Result<(), String> {
    if kernel == truth { Ok(()) } else { Err(format!("{what}: kernel {kernel:?}, truth {truth:?}")) }
}

fn least_rotation([a, b, c]: [Option<usize>; 3]) -> [Option<usize>; 3] {
    [[a, b, c], [b, c, a], [c, a, b]].into_iter().min().expect("three rotations")
}
