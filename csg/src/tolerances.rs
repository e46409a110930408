//! The constants of this crate that decide something by size instead of by sign.
//!
//! `docs/tolerances.md` lists those of all crates, and says of each whether it can change topology or volume and why that is safe.
//! Error bounds of floating-point filters are not here: they may only say "not certain", after which exact
//! arithmetic decides, and stand where they are derived.

/// Planes whose unit normals and relative offsets differ by at most this are taken to be one plane that went through
/// rotations or decimal text. Offsets are relative to the larger distance of the two planes from the origin, or to the size of the smallest
/// body where that is larger ([`smallest_size`](crate::stages::smallest_size)).
///
/// Decides: which plane a body gets, before anything else is decided; what was snapped is counted
/// ([`ModelSummary::snapped_planes`](crate::ModelSummary::snapped_planes)). Of the topology: all of it follows from the planes. Any set of
/// half-spaces is a valid convex body, so the mesh is closed whatever is snapped.
pub const SNAP_TOLERANCE: f64 = 1e-12;

/// Edges of the finished mesh that are shorter than this share of the coordinates of the faces at their ends, and triangles that are lower
/// than this share of their own, come from planes that were meant to meet in a point: noise of decimal text or rotations is some `1e-15`, what anybody models is far longer.
///
/// Decides: which edges are contracted, which triangles without height are flipped away, and which tunnels, gaps and bubbles
/// collapse. Of the topology: contraction and flips leave it; the collapse changes it, and the mesh stays a closed, oriented
/// 2-manifold. The measures are taken before ([`SolidMeasures`](crate::SolidMeasures)), so they do not see it.
pub const CONTRACTION: f64 = 1e-12;

/// How far volume and area of a finished mesh may be from those of the exact boundary, as a share of the area, beyond what rounding of the
/// vertices explains; and how far a vertex may have moved as noise, as a share of the largest coordinate.
///
/// Decides: whether a mesh leaves. Where removing noise breaks this, the noise stays; otherwise it is a
/// [`WeldError`](crate::WeldError).
pub const PROOF: f64 = 1e-9;

/// How far the coordinates of a mesh may have been rounded, as a share of the largest one of a triangle and its neighbour: by whoever turned
/// or moved it.
///
/// Decides: which neighbouring triangles, once they were cut by others, are one face in the finished mesh, and which points on the edges of such faces are left out. Of the
/// topology of the solid: nothing. Where volume, area or folds tell otherwise ([`PROOF`]), only what lies in one plane exactly is one face.
pub const FLATNESS: f64 = 16.0 * f64::EPSILON;

/// How deep a corner may lie in an ear that is cut where no ear is free of corners, relative to the largest coordinate of the face.
///
/// Decides: how a face that noise has folded is triangulated. Of the topology: nothing, no vertex and no boundary edge comes or
/// goes.
pub const EAR_NOISE: f64 = 1e-11;

/// A diagonal of a face is flipped only where its new triangles have an area above this share of the square of their longest
/// side.
///
/// Decides: which of two triangulations a face gets. Of the topology: nothing.
pub const FLAT_TRIANGLE: f64 = 1e-9;

/// A transform whose determinant is below this share of the product of the lengths of its columns is refused
/// ([`TransformError`](crate::TransformError)).
///
/// Decides: what is accepted. Of the topology: nothing.
pub const SINGULAR_DETERMINANT: f64 = 1e-14;

/// Components of a transformed normal below this share of its largest one are rounding noise and become zero, so that they stay
/// within the range that a half-space accepts.
///
/// Decides: the plane of a transformed face, by far less than a rounding.
pub const NEGLIGIBLE_COMPONENT: f64 = 1e-40;

/// A diagonal is flipped where the sine of the sum of the opposite angles is below zero by more than this, times the fourth
/// power of the longest side.
///
/// Decides: which of two triangulations a face gets. Of the topology: nothing.
pub const DELAUNAY_MARGIN: f64 = 1e-12;

/// A point of a face of a live model is on the brushes that hold it, up to this share of its coordinates and the size of the triangle that it is taken of; where a ray meets a triangle is in its box,
/// up to this share of the coordinates; a corner is in a plane that is about to move, up to this share of its coordinates.
///
/// Decides: which brush a face is said to come from, whether a ray meets a triangle that has no area but for rounding, and which corners a plane does not snap to. Of the topology: nothing.
pub const ON_FACE: f64 = 1e-9;

/// Where a ray enters and leaves a convex body is clear where all other planes of it, and the ends of all other bodies, are farther away than this share of the coordinates, and the ray
/// is no more parallel to a plane than that.
///
/// Decides: which of two ways the first face that a ray meets is found in, by bodies, or by the triangles near the ray. Of the topology: nothing.
pub const RAY_MARGIN: f64 = 1e-12;

#[cfg(test)]
mod tests {
    use std::path::Path;

    /// A constant without a row in the table, or a row of a constant that is gone, would make the page untrue.
    #[test]
    fn the_page_lists_the_constants_of_each_crate() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let read = |path: &str| std::fs::read_to_string(root.join(path)).expect("a file of the project");
        let page = read("docs/tolerances.md");
        for name in ["csg", "cells", "shapes"] {
            let source = read(&format!("{name}/src/tolerances.rs"));
            let declared = source.lines().filter_map(|line| line.strip_prefix("pub const ")?.split(':').next());
            let section = page.split("\n## ").find(|section| section.contains(&format!("(`{name}`)\n")));
            let rows = section.expect("a section of the crate").lines().filter_map(|line| line.strip_prefix("| `"));
            let listed = rows.filter_map(|row| row.split('`').next());
            let sorted = |names: Vec<&str>| {
                let mut names: Vec<String> = names.into_iter().map(str::to_owned).collect();
                names.sort_unstable();
                names
            };
            assert_eq!(sorted(declared.collect()), sorted(listed.collect()), "constants of {name}");
        }
    }
}
