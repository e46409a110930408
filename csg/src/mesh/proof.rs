//! The last look at a mesh before it leaves: it must be the boundary that was found.
//!
//! The measures of the solid are taken from the exact loops of its faces, before these are triangulated and noise is removed. A mesh that
//! is closed and has the same volume and area, and no triangle that faces the other way, has neither a fold nor a hole.

use glam::DVec3;
use planecut_parallel::prelude::*;

use super::flip_caps::is_flat;
use super::noise::{largest_coordinate, longest_noise};
use super::{Mesh, Noise, SolidMeasures, without_noise};
use crate::closed_mesh::connectivity::are_all_paired;
use crate::model::MaterialId;
use crate::tolerances::PROOF;

/// Triangles that are summed one after the other, so that sums do not depend on the number of threads.
const CHUNK: usize = 1024;

/// What is wrong with a mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Flaw {
    /// An edge is not used once each way.
    Open,
    /// A triangle faces against its face.
    Folded,
    /// Volume or area are not those of the solid, or more was removed as noise than noise can be.
    Measures,
}

/// Sums over triangles.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    six_volume: f64,
    twice_area: f64,
    perimeter: f64,
    /// Products of lengths whose rounding is in the volume. The solid was measured by other triangles than these: of a needle, which has two long
    /// sides, maybe by those, though here by a short one.
    cubes: f64,
    /// The largest amount by which a triangle that faces against its face exceeds what rounding explains; 0 where none does.
    folded: f64,
    /// Whether a triangle may be rounding noise, or have a side that is.
    may_be_noise: bool,
}

impl Sums {
    fn and(self, other: Self) -> Self {
        Self {
            six_volume: self.six_volume + other.six_volume,
            twice_area: self.twice_area + other.twice_area,
            perimeter: self.perimeter + other.perimeter,
            cubes: self.cubes + other.cubes,
            folded: self.folded.max(other.folded),
            may_be_noise: self.may_be_noise || other.may_be_noise,
        }
    }
}

impl Sums {
    /// Makes sure that no triangle faces against its face, and that volume and area are those given, of a part of a solid of some area: `moved`
    /// sums what rounding may have moved, by as much as `off`.
    fn agree_with(&self, [volume, area]: [f64; 2], area_of_all: f64, moved: &Self, off: f64) -> Result<(), Flaw> {
        if self.folded > 0.0 {
            return Err(Flaw::Folded);
        }
        let area_slack = PROOF * area_of_all + 4.0 * off * moved.perimeter;
        let volume_slack = (PROOF * area_of_all.sqrt() + 4.0 * off) * area_of_all + 4.0 * f64::EPSILON * moved.cubes;
        let (found_volume, found_area) = (self.six_volume / 6.0, 0.5 * self.twice_area);
        let is_same = (found_area - area).abs() <= area_slack && (found_volume - volume).abs() <= volume_slack;
        if is_same { Ok(()) } else { Err(Flaw::Measures) }
    }
}

/// A mesh without rounding noise, or, where that would damage it, with it; proven to be the boundary of a solid. Noise stays at faces of the material of
/// walls, where there is one. `is_closed` tells that all edges are known to be used once each way.
pub(crate) fn proven(
    mesh: Mesh,
    solid: &SolidMeasures,
    walls: Option<MaterialId>,
    is_closed: bool,
) -> Result<(Mesh, Noise), Flaw> {
    let (middle, off) = middle_and_rounding(solid);
    let sums = sums_of(&mesh, middle, off);
    // mostly nothing is
    if sums.may_be_noise
        && let Some((cleared, noise)) = without_noise(&mesh, walls)
        && prove_cleared(&cleared, solid, &sums, noise).is_ok()
    {
        return Ok((cleared, noise));
    }
    if !is_closed && !is_each_edge_paired(&mesh) {
        return Err(Flaw::Open);
    }
    sums.agree_with([solid.volume, solid.area], solid.area, &sums, off)?;
    Ok((mesh, Noise::default()))
}

/// Whether every edge of a mesh is used once each way.
fn is_each_edge_paired(mesh: &Mesh) -> bool {
    are_all_paired(mesh.positions.len(), &mesh.triangles)
}

/// The middle of a solid, and how far a vertex of it may be from where it is exactly.
fn middle_and_rounding(solid: &SolidMeasures) -> (DVec3, f64) {
    (0.5 * (solid.min + solid.max), f64::EPSILON * largest_coordinate([solid.min, solid.max].into_iter()))
}

/// Checks a mesh from which noise was removed; `before` are the sums of it as it was, so that they have what is gone, too.
fn prove_cleared(mesh: &Mesh, solid: &SolidMeasures, before: &Sums, noise: Noise) -> Result<(), Flaw> {
    if noise.thickest > PROOF * largest_coordinate([solid.min, solid.max].into_iter()) {
        return Err(Flaw::Measures);
    }
    if !is_each_edge_paired(mesh) {
        return Err(Flaw::Open);
    }
    let (middle, rounding) = middle_and_rounding(solid);
    let off = rounding + noise.thickest;
    let sums = sums_of(mesh, middle, off);
    sums.agree_with([solid.volume, solid.area], solid.area, before, off)
}

/// Checks a part of a mesh against the volume and area of what it was made of, seen from a point near the middle of a solid of some area.
pub(crate) fn prove_part(part: &Mesh, middle: DVec3, measures: [f64; 2], area_of_all: f64) -> Result<(), Flaw> {
    let off = f64::EPSILON * largest_coordinate(part.positions.iter().copied());
    let sums = sums_of(part, middle, off);
    sums.agree_with(measures, area_of_all, &sums, off)
}

fn sums_of(mesh: &Mesh, middle: DVec3, off: f64) -> Sums {
    let chunks = mesh.triangles.par_chunks(CHUNK).zip(mesh.triangle_faces.par_chunks(CHUNK));
    let longest_noise = longest_noise(mesh);
    let of_chunk = |(triangles, faces): (&[[u32; 3]], &[u32])| {
        let of_triangle = |(triangle, face): (&[u32; 3], &u32)| {
            of_triangle(mesh, *triangle, *face as usize, [off, longest_noise], middle)
        };
        triangles.iter().zip(faces).map(of_triangle).fold(Sums::default(), Sums::and)
    };
    chunks.map(of_chunk).collect::<Vec<Sums>>().into_iter().fold(Sums::default(), Sums::and)
}

/// The part of one triangle in the sums, seen from a point near the middle of the solid.
fn of_triangle(mesh: &Mesh, triangle: [u32; 3], face: usize, [off, longest_noise]: [f64; 2], middle: DVec3) -> Sums {
    let corners = triangle.map(|v| mesh.positions[v as usize]);
    let [a, b, c] = corners.map(|corner| corner - middle);
    let (ab, ac) = (b - a, c - a);
    let normal = ab.cross(ac);
    let squares = [ab.length_squared(), ac.length_squared(), (c - b).length_squared()];
    let sides = squares.map(f64::sqrt);
    let perimeter = sides[0] + sides[1] + sides[2];
    let longest = squares[0].max(squares[1]).max(squares[2]);
    let against = -normal.dot(mesh.faces[face].normal);
    let twice_area = normal.length();
    // differences are rounded otherwise where noise is removed: what may be noise there is surely found with twice the length
    let shortest = sides[0].min(sides[1]).min(sides[2]);
    let largest_height = 2.0 * longest_noise;
    let is_flat = || twice_area * twice_area <= largest_height * largest_height * longest && is_flat(corners);
    Sums {
        six_volume: a.dot(normal),
        twice_area,
        perimeter,
        cubes: a.length() * longest,
        folded: against - 8.0 * off * perimeter,
        may_be_noise: shortest <= 2.0 * longest_noise || is_flat(),
    }
}
