//! A mesh as glTF stores it: split vertices near an origin, primitives by material, and which vertices are one.

use std::borrow::Cow;
use std::ops::Range;

use glam::DVec3;
use planecut_csg::Mesh;
use planecut_csg::stages::are_all_paired;
use planecut_parallel::prelude::*;

use super::rounding::Rounding;
use super::tangents::tangents;
use crate::material::Looks;
use crate::surface::{Vertices, has_three_corners};
use crate::{ExportError, ExportOptions, Part};

/// Marks a vertex that no triangle has used yet.
const NONE: u32 = u32::MAX;

/// Vertex and index arrays of one mesh, with what is needed to undo the splitting.
pub(super) struct Geometry<'a> {
    /// How its positions are stored.
    pub(super) rounding: Rounding,
    /// Without edges that are lost where positions are rounded.
    pub(super) mesh: Cow<'a, Mesh>,
    pub(super) vertices: Vertices,
    /// Tangents and their handedness; empty unless asked for.
    pub(super) tangents: Vec<[f32; 4]>,
    /// Triangles of one material.
    pub(super) runs: Vec<Run>,
    /// What turns the corners into those of a closed, oriented 2-manifold. `None` for any other mesh.
    merges: Option<Merges>,
}

/// Which vertices stand for others.
struct Merges {
    /// For each position of the mesh the first of its vertices.
    first: Vec<u32>,
    /// At how many corners another vertex stands.
    count: usize,
}

/// A primitive of a mesh.
pub(super) struct Run {
    /// The material; of several that look alike the first.
    pub(super) material: u32,
    /// Its corners.
    pub(super) corners: Range<usize>,
    /// How many of its triangles, in order, come from which face of which brush, where that was asked for.
    pub(super) sources: Vec<[u32; 3]>,
}

impl<'a> Geometry<'a> {
    /// The arrays of a checked part, its positions stored like this. Edges whose ends are rounded to one place are contracted; triangles that name a
    /// vertex twice have no area by construction and are left out.
    pub(super) fn new(part: &Part<'a>, rounding: Rounding, options: &ExportOptions) -> Result<Self, ExportError> {
        let mesh = rounding.reduced(part.mesh);
        check_range(&mesh.positions, rounding.origin)?;
        let looks = Looks::of(&mesh.materials);
        let mut triangles: Vec<u32> = (0..)
            .zip(&mesh.triangles)
            .filter(|(_, corners)| has_three_corners(corners))
            .map(|(triangle, _)| triangle)
            .collect();
        let look = |triangle: &u32| looks.of_face(&mesh, mesh.triangle_faces[*triangle as usize]);
        triangles.sort_by_key(look);
        let mut vertices = Vertices::of(&mesh, part.sources, &triangles, true, options);
        if vertices.corners.len() >= NONE as usize {
            // numbers of vertices and of places among the corners must hold in 32 bits, with one value to spare
            let what = format!("{} triangle corners in a glTF mesh", vertices.corners.len());
            return Err(ExportError::TooLarge { what });
        }
        let mut runs = Vec::new();
        for triangles in triangles.chunk_by(|a, b| look(a) == look(b)) {
            let start = runs.last().map_or(0, |run: &Run| run.corners.end);
            let corners = start..start + 3 * triangles.len();
            let sources = if options.source_ids { sources_of(part, &mesh, triangles) } else { Vec::new() };
            runs.push(Run { material: look(&triangles[0]), corners, sources });
        }
        if !options.source_ids {
            order_for_caches(&mut vertices, &runs);
        }
        let mut geometry = Self { rounding, mesh, vertices, tangents: Vec::new(), runs, merges: None };
        if options.tangents {
            geometry.tangents = tangents(&mut geometry.vertices, &geometry.mesh.positions, rounding.origin);
        }
        Ok(geometry)
    }

    /// A position in single precision, relative to the origin.
    pub(super) fn position(&self, vertex: usize) -> [f32; 3] {
        let position = self.mesh.positions[self.vertices.origins[vertex] as usize];
        // Adding zero turns -0 into 0, which some JSON readers do not tell from it in the bounds.
        (self.rounding.single(position) + glam::Vec3::ZERO).to_array()
    }

    /// A position on the grid.
    pub(super) fn grid_position(&self, vertex: usize, step: f64) -> [i16; 3] {
        let position = self.mesh.positions[self.vertices.origins[vertex] as usize];
        self.rounding.grid(position, step).to_array()
    }

    /// Finds which vertices are one, once the corners have their order.
    pub(super) fn find_merges(&mut self) {
        if !self.is_manifold() {
            return;
        }
        // the first copy of a vertex stands for it
        let mut first = vec![NONE; self.mesh.positions.len()];
        for (copy, origin) in (0..).zip(&self.vertices.origins) {
            let first = &mut first[*origin as usize];
            *first = copy.min(*first);
        }
        self.merges = Some(Merges { first, count: 0 });
        let count = self.merges().count();
        self.merges = self.merges.take().map(|merges| Merges { count, ..merges });
    }

    /// Whether the triangles are a closed, oriented 2-manifold.
    fn is_manifold(&self) -> bool {
        let (vertices, all) = (self.mesh.positions.len(), &self.mesh.triangles);
        let are_paired = |triangles: &[[u32; 3]]| are_all_paired(vertices, triangles);
        if self.vertices.corners.len() == 3 * all.len() {
            return are_paired(all);
        }
        let proper: Vec<[u32; 3]> = all.iter().copied().filter(has_three_corners).collect();
        are_paired(&proper)
    }

    /// How many corners there are where another vertex stands for theirs; nothing for what is no manifold.
    pub(super) fn merge_count(&self) -> Option<usize> {
        self.merges.as_ref().map(|merges| merges.count)
    }

    /// These corners by their places, rising, and the vertices that stand for theirs.
    pub(super) fn merges(&self) -> impl Iterator<Item = (u32, u32)> {
        let Vertices { origins, corners, .. } = &self.vertices;
        let of = move |merges: &'_ Merges, corner: u32| merges.first[origins[corner as usize] as usize];
        self.merges.iter().flat_map(move |merges| {
            let all = (0..).zip(corners).map(move |(place, corner)| (place, *corner, of(merges, *corner)));
            all.filter(|(_, corner, merged)| corner != merged).map(|(place, _, merged)| (place, merged))
        })
    }
}

fn check_range(positions: &[DVec3], origin: DVec3) -> Result<(), ExportError> {
    let relative = |position: &DVec3| *position - origin;
    match positions.iter().position(|position| !relative(position).as_vec3().is_finite()) {
        Some(vertex) => {
            let relative = relative(&positions[vertex]);
            Err(ExportError::CoordinateRange { vertex, value: relative[relative.abs().max_position()] })
        }
        None => Ok(()),
    }
}

/// How many triangles, in their order, come from which face of which brush.
fn sources_of(part: &Part<'_>, mesh: &Mesh, triangles: &[u32]) -> Vec<[u32; 3]> {
    let source = |triangle: &u32| {
        let face = mesh.triangle_faces[*triangle as usize];
        let source = part.sources.get(mesh.faces[face as usize].material.0 as usize)?;
        Some([source.brush, source.plane])
    };
    let runs = triangles.chunk_by(|a, b| source(a) == source(b));
    runs.filter_map(|run| source(&run[0]).map(|[brush, plane]| [run.len() as u32, brush, plane])).collect()
}

/// Puts triangles into an order that suits the caches of graphics cards; `count` is more than any number of a vertex.
#[cfg(feature = "meshopt")]
fn order_for_cache(corners: &mut [u32], count: usize) {
    meshopt::optimize_vertex_cache_in_place(corners, count);
}

/// Without the library that knows a better order triangles keep theirs.
#[cfg(not(feature = "meshopt"))]
fn order_for_cache(_: &mut [u32], _: usize) {}

/// Triangles are put into an order for caches this many at a time: thousands of times what such a cache holds.
const ORDERED_AT_A_TIME: usize = 1 << 17;

/// Puts the triangles of each run into an order that suits the caches of graphics cards, and vertices into that of their use.
fn order_for_caches(vertices: &mut Vertices, runs: &[Run]) {
    let mut rest = vertices.corners.as_mut_slice();
    let mut parts = Vec::with_capacity(runs.len());
    for run in runs {
        let (part, after) = rest.split_at_mut(run.corners.len());
        parts.extend(part.chunks_mut(3 * ORDERED_AT_A_TIME));
        rest = after;
    }
    parts.into_par_iter().for_each(|corners| {
        // numbers of its own, so that a run takes no more room than it needs
        let first = corners.iter().min().copied().unwrap_or(0);
        let count = corners.iter().max().map_or(0, |last| last - first + 1);
        corners.iter_mut().for_each(|corner| *corner -= first);
        order_for_cache(corners, count as usize);
        corners.iter_mut().for_each(|corner| *corner += first);
    });
    vertices.renumber();
}
