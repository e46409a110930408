//! The image of a surface whose vertices go to their representatives, and bodies in place of what has no area.

use planecut_kernel::DVec3;
use rustc_hash::FxHashSet;

use super::bodies::{Body, Sizes};
use super::cluster::Lattice;
use super::surface::{Numbers, Surface};

/// A simplified surface.
#[derive(Debug)]
pub(super) struct Coarse {
    pub(super) surface: Surface,
    /// The farthest that a vertex moved.
    pub(super) moved: f64,
    /// The largest radius of a body.
    pub(super) radius: f64,
}

/// A triangle, segment or point of the image, of which triangle, and how much area of the input it stands for. The numbers of its corners rise.
#[derive(Debug, Clone, Copy)]
struct Piece<const N: usize> {
    corners: [u32; N],
    /// Whether the triangle's corners, in this order, go around as those of the input do.
    is_even: bool,
    material: u32,
    area: f64,
}

/// Maps a surface to its image.
pub(super) fn image(surface: &Surface, representatives: &[DVec3], lattice: &Lattice) -> Coarse {
    let (mut positions, mut known) = (Vec::new(), Numbers::default());
    let moved = surface.positions.iter().zip(representatives).map(|(from, to)| from.distance(*to)).fold(0.0, f64::max);
    let vertices: Vec<u32> = representatives.iter().map(|at| known.of(*at, &mut positions)).collect();
    let (mut triangles, mut segments, mut points) = (Vec::new(), Vec::new(), Vec::new());
    for (triangle, material) in surface.triangles.iter().zip(&surface.materials) {
        let [a, b, c] = surface.corners(*triangle);
        let (area, material) = ((b - a).cross(c - a).length() / 2.0, *material);
        let (corners, is_even) = sorted(triangle.map(|corner| vertices[corner as usize]));
        match corners {
            [a, b, c] if a == c => points.push(Piece { corners: [b], is_even, material, area }),
            [a, b, c] if a == b || b == c => segments.push(Piece { corners: [a, c], is_even, material, area }),
            _ => triangles.push(Piece { corners, is_even, material, area }),
        }
    }
    let mut made = Made { surface: Surface { positions, ..Surface::default() }, ..Made::default() };
    made.add_triangles(triangles, &mut segments);
    made.add_bodies(segments, points, Sizes::new(lattice.cell, lattice.step));
    let surface = without_unused(made.surface);
    Coarse { surface, moved, radius: made.radius }
}

/// What was made by now.
#[derive(Default)]
struct Made {
    surface: Surface,
    radius: f64,
    /// The edges of triangles that have an area.
    edges: FxHashSet<[u32; 2]>,
    /// Vertices of these, and those that bodies are around.
    covered: FxHashSet<u32>,
}

impl Made {
    /// Adds triangles. Those without area are segments, and stay where the surface is not closed without them.
    fn add_triangles(&mut self, mut triangles: Vec<Piece<3>>, segments: &mut Vec<Piece<2>>) {
        triangles.sort_by_key(|piece| piece.corners);
        let mut thin = Vec::new();
        for same in triangles.chunk_by(|a, b| a.corners == b.corners) {
            let piece = &same[0];
            let [a, b, c] = piece.corners;
            let corners = self.surface.corners(piece.corners);
            // multiples of a step that are few enough for this to be exact
            let is_thin = (corners[1] - corners[0]).cross(corners[2] - corners[0]) == DVec3::ZERO;
            if is_thin {
                let area = same.iter().map(|piece| piece.area).sum();
                thin.push(Piece { area, ..*piece });
            } else {
                self.edges.extend([[a, b], [b, c], [a, c]]);
                self.covered.extend(piece.corners);
            }
            let even = same.iter().filter(|piece| piece.is_even).count();
            let odd = same.len() - even;
            // what cancels entirely stays with either side, unless it has no area
            let counts =
                if even == odd && !is_thin { [1, 1] } else { [even.saturating_sub(odd), odd.saturating_sub(even)] };
            for (way, count) in [true, false].into_iter().zip(counts) {
                let material = heaviest(same.iter().filter(|piece| piece.is_even == way));
                for _ in 0..count {
                    self.surface.triangles.push(if way { [a, b, c] } else { [a, c, b] });
                    self.surface.materials.push(material);
                }
            }
        }
        segments.extend(thin.iter().filter_map(|piece| self.uncovered(piece)));
    }

    /// The segment that a triangle without area is, unless edges of others cover it.
    fn uncovered(&self, piece: &Piece<3>) -> Option<Piece<2>> {
        let [a, b, c] = piece.corners;
        let at = |corner: u32| self.surface.positions[corner as usize];
        let long = |edge: [u32; 2]| at(edge[0]).distance_squared(at(edge[1]));
        let mut edges = [[a, b], [b, c], [a, c]];
        edges.sort_by(|p, q| long(*p).total_cmp(&long(*q)));
        let is_edge = |edge| self.edges.contains(edge);
        let is_covered = is_edge(&edges[2]) || is_edge(&edges[0]) && is_edge(&edges[1]);
        (!is_covered).then_some(Piece { corners: edges[2], is_even: true, material: piece.material, area: piece.area })
    }

    /// Adds bodies for segments and points that no triangle covers.
    fn add_bodies(&mut self, mut segments: Vec<Piece<2>>, mut points: Vec<Piece<1>>, sizes: Sizes) {
        segments.sort_by_key(|piece| piece.corners);
        for same in segments.chunk_by(|a, b| a.corners == b.corners) {
            let corners = same[0].corners;
            if self.edges.contains(&corners) {
                continue;
            }
            self.covered.extend(corners);
            let ends = corners.map(|corner| self.surface.positions[corner as usize]);
            let (body, radius) = sizes.prism(ends, same.iter().map(|piece| piece.area).sum());
            self.add_body(&body, radius, heaviest(same));
        }
        points.sort_by_key(|piece| piece.corners);
        for same in points.chunk_by(|a, b| a.corners == b.corners) {
            let [corner] = same[0].corners;
            if self.covered.contains(&corner) {
                continue;
            }
            let at = self.surface.positions[corner as usize];
            let (body, radius) = sizes.octahedron(at, same.iter().map(|piece| piece.area).sum());
            self.add_body(&body, radius, heaviest(same));
        }
    }

    fn add_body(&mut self, (positions, triangles): &Body, radius: f64, material: u32) {
        let first = self.surface.positions.len() as u32;
        self.surface.positions.extend(positions);
        self.surface.triangles.extend(triangles.iter().map(|corners| corners.map(|corner| first + corner)));
        self.surface.materials.extend(triangles.iter().map(|_| material));
        self.radius = self.radius.max(radius);
    }
}

/// The corners by their numbers, and whether that is an even permutation.
fn sorted([a, b, c]: [u32; 3]) -> ([u32; 3], bool) {
    let mut corners = [a, b, c];
    corners.sort_unstable();
    (corners, [[a, b, c], [b, c, a], [c, a, b]].contains(&corners))
}

/// The material of most of the area; the least of several, and 0 of none.
fn heaviest<'a, const N: usize>(pieces: impl IntoIterator<Item = &'a Piece<N>>) -> u32 {
    let mut areas: Vec<(u32, f64)> = pieces.into_iter().map(|piece| (piece.material, piece.area)).collect();
    areas.sort_by_key(|(material, _)| *material);
    let sums =
        areas.chunk_by(|a, b| a.0 == b.0).map(|same| (same[0].0, same.iter().map(|(_, area)| area).sum::<f64>()));
    sums.rev().max_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(material, _)| material)
}

/// The surface without vertices that no triangle has.
fn without_unused(surface: Surface) -> Surface {
    let mut numbers = vec![u32::MAX; surface.positions.len()];
    let mut positions = Vec::new();
    let mut triangles = surface.triangles;
    for corner in triangles.iter_mut().flatten() {
        let number = &mut numbers[*corner as usize];
        if *number == u32::MAX {
            *number = positions.len() as u32;
            positions.push(surface.positions[*corner as usize]);
        }
        *corner = *number;
    }
    Surface { positions, triangles, materials: surface.materials }
}
