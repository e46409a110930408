//! Connected parts of operands that nothing touches: they pass through as they are, or go.

use planecut_parallel::prelude::*;

use super::input::Input;
use super::surface::Surface;
use crate::closed_mesh::connectivity::NO_TWIN;
use crate::ids::{Id, InputTriangleId, PatchId, number32};

/// A connected part of an operand.
#[derive(Debug, Clone, Copy)]
pub(super) struct Patch {
    pub(super) operand: u32,
    /// One of its triangles, by its number in the operand.
    pub(super) first: u32,
}

/// Connected parts of operands that nothing touches.
#[derive(Debug, Default)]
pub(super) struct Patches {
    pub(super) all: Vec<Patch>,
    /// For each operand and each of its triangles the patch, less the first of the operand; [`NO_PATCH`] for those that are touched or hidden.
    of_triangle: Vec<Vec<u32>>,
    /// The first patch of each operand.
    starts: Vec<u32>,
}

const NO_PATCH: u32 = u32::MAX;

impl Patches {
    /// The parts of operands that are not in the surface of those that touch, and are not hidden.
    pub(super) fn new(surface: &Surface<'_>) -> Self {
        let input = surface.input;
        let of_operand = |operand: usize| flood(input, surface, operand);
        let found: Vec<(Vec<u32>, Vec<u32>)> = (0..input.operands.len()).into_par_iter().map(of_operand).collect();
        let mut patches = Self::default();
        for (operand, (of_triangle, firsts)) in (0..).zip(found) {
            patches.starts.push(number32(patches.all.len()));
            patches.all.extend(firsts.into_iter().map(|first| Patch { operand, first }));
            patches.of_triangle.push(of_triangle);
        }
        patches
    }

    /// The patch of a triangle of an operand; none for one that is touched or hidden.
    #[inline]
    pub(super) fn of(&self, operand: usize, triangle: u32) -> Option<PatchId> {
        match self.of_triangle[operand].get(triangle as usize) {
            None | Some(&NO_PATCH) => None,
            Some(patch) => Some(PatchId::from_index((self.starts[operand] + patch) as usize)),
        }
    }
}

/// For each triangle of an operand its patch, and for each patch its first triangle.
fn flood(input: &Input<'_>, surface: &Surface<'_>, operand: usize) -> (Vec<u32>, Vec<u32>) {
    let own = &input.operands[operand];
    let count = number32(own.triangles().len());
    let first = input.number(operand, 0).index();
    let is_touched = |triangle: u32| {
        let triangle = InputTriangleId::from_index(first + triangle as usize);
        surface.has(triangle) || surface.hidden.has(triangle)
    };
    let mut patch_of = vec![NO_PATCH; count as usize];
    let mut firsts = Vec::new();
    let mut waiting = Vec::new();
    for start in 0..count {
        if patch_of[start as usize] != NO_PATCH || is_touched(start) {
            continue;
        }
        let patch = number32(firsts.len());
        firsts.push(start);
        patch_of[start as usize] = patch;
        waiting.push(start);
        while let Some(triangle) = waiting.pop() {
            for &twin in &own.twins()[3 * triangle as usize..3 * triangle as usize + 3] {
                let other = twin / 3;
                if twin != NO_TWIN && patch_of[other as usize] == NO_PATCH && !is_touched(other) {
                    patch_of[other as usize] = patch;
                    waiting.push(other);
                }
            }
        }
    }
    (patch_of, firsts)
}
