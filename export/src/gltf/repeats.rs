//! Parts that are alike but for where they are: their nodes share one mesh.

use std::hash::{Hash, Hasher};

use glam::DVec3;
use planecut_csg::Mesh;
use planecut_parallel::prelude::*;
use rustc_hash::{FxHashMap, FxHasher};

use super::origin::choose_origin;
use crate::material::Looks;
use crate::{ExportOptions, Part};

/// Corners of parts that are alike lie no farther apart than this part of the size, which is below single precision.
const SAME: f64 = 1.0 / (1u64 << 26) as f64;

/// A part as the copy of another.
#[derive(Debug, Clone, Copy)]
pub(super) struct Repeat {
    /// Which of those that are no copies.
    pub(super) first: usize,
    /// From the one to the other.
    pub(super) moved: DVec3,
}

/// Which parts are copies of which.
#[derive(Debug)]
pub(super) struct Repeats {
    firsts: Vec<usize>,
    repeats: Vec<Repeat>,
}

impl Repeats {
    /// No part is a copy.
    fn none(parts: usize) -> Self {
        let repeats = (0..parts).map(|first| Repeat { first, moved: DVec3::ZERO }).collect();
        Self { firsts: (0..parts).collect(), repeats }
    }

    /// Those among some parts whose faces are alike, in the same order; none where faces are to say where they come from.
    pub(super) fn of(parts: &[Part<'_>], options: &ExportOptions) -> Self {
        if parts.len() < 2 || options.source_ids {
            return Self::none(parts.len());
        }
        let looks: Vec<Looks> = parts.iter().map(|part| Looks::of(&part.mesh.materials)).collect();
        let numbers: Vec<u64> = (0..parts.len()).into_par_iter().map(|part| number_of(&parts[part])).collect();
        let mut known: FxHashMap<u64, Vec<usize>> = FxHashMap::default();
        let (mut firsts, mut repeats): (Vec<usize>, Vec<Repeat>) = (Vec::new(), Vec::with_capacity(parts.len()));
        for (place, part) in parts.iter().enumerate() {
            let alike = known.entry(numbers[place]).or_default();
            let moved = alike.iter().find_map(|first: &usize| {
                let other = firsts[*first];
                let moved = moved(&parts[other], part, (&looks[other], &looks[place]))?;
                let is_exact = || is_moved_exactly(parts[other].mesh, part.mesh, moved);
                // a collider is around something: it stays where it is to the last bit
                if options.convex_colliders && !is_exact() {
                    return None;
                }
                Some(Repeat { first: *first, moved })
            });
            repeats.push(moved.unwrap_or_else(|| {
                alike.push(firsts.len());
                firsts.push(place);
                Repeat { first: firsts.len() - 1, moved: DVec3::ZERO }
            }));
        }
        Self { firsts, repeats }
    }

    /// The parts that are no copies.
    pub(super) fn firsts(&self) -> &[usize] {
        &self.firsts
    }

    /// For each part what it is a copy of; the first is one of itself.
    pub(super) fn iter(&self) -> impl Iterator<Item = &Repeat> {
        self.repeats.iter()
    }
}

/// A number that is the same for parts that are alike.
fn number_of(part: &Part<'_>) -> u64 {
    let mut hasher = FxHasher::default();
    part.mesh.triangles.hash(&mut hasher);
    part.mesh.positions.len().hash(&mut hasher);
    hasher.finish()
}

/// Whether readers in single precision find a mesh in its place if it is written as another one that is moved.
fn is_moved_exactly(one: &Mesh, other: &Mesh, moved: DVec3) -> bool {
    let origin = choose_origin(&one.positions) + moved;
    origin.as_vec3().as_dvec3() == origin
        && origin - moved == choose_origin(&one.positions)
        && one.positions.iter().zip(&other.positions).all(|(a, b)| *a + moved == *b && *b - moved == *a)
}

/// How far a part is moved against another; `None` where it is not the same otherwise.
fn moved(one: &Part<'_>, other: &Part<'_>, looks: (&Looks, &Looks)) -> Option<DVec3> {
    let (a, b) = (one.mesh, other.mesh);
    if a.triangles != b.triangles || a.triangle_faces != b.triangle_faces || a.faces.len() != b.faces.len() {
        return None;
    }
    let (from, to) = (a.positions.first()?, b.positions.first()?);
    if a.positions.len() != b.positions.len() {
        return None;
    }
    let moved = *to - *from;
    let size = a.positions.iter().map(|position| (*position - *from).abs().max_element()).fold(0.0, f64::max);
    let is_near = |(a, b): (&DVec3, &DVec3)| (*a + moved).abs_diff_eq(*b, SAME * size);
    let is_same_face = |face: u32| {
        let (of_a, of_b) = (looks.0.of_face(a, face), looks.1.of_face(b, face));
        let (same_a, same_b) = (&a.materials[of_a as usize], &b.materials[of_b as usize]);
        let texture = |part: &Part<'_>| part.sources.get(part.mesh.faces[face as usize].material.0 as usize)?.texture;
        // a texture that lies in space lies differently on what is moved
        same_a == same_b
            && a.faces[face as usize].normal.abs_diff_eq(b.faces[face as usize].normal, SAME)
            && texture(one).is_none()
            && texture(other).is_none()
    };
    let is_same = a.positions.iter().zip(&b.positions).all(is_near) && (0..a.faces.len() as u32).all(is_same_face);
    is_same.then_some(moved)
}
