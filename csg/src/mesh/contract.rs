//! Topological contraction of edges too short to survive rounding.
//!
//! Planes that went through rotations or decimal text can nearly meet in a point: that leaves true edges of `1e-13`, and a
//! format with 32-bit coordinates rounds far longer ones to nothing. Merging by coordinates would undo the splits that
//! keep the mesh a manifold, so edges are contracted one by one, each only where the surface stays the surface it was
//! (the link condition: Dey, Edelsbrunner, Guha, Nekhayev 1999).

use crate::ids::number32;
use glam::DVec3;
use planecut_parallel::prelude::*;
use smallvec::SmallVec;

use super::noise::{Noise, NoiseEdge};
use super::{CHUNK, Mesh};
use crate::base::by_group;

/// Contracts edges of at most `length` (in the mesh's units) and gives how many went. Edges whose contraction would change
/// the topology stay. Faces that lose all their triangles are dropped.
pub fn contract_short_edges(mesh: &mut Mesh, length: f64) -> usize {
    contract_edges(mesh, |a, b| a.distance(b) <= length)
}

/// Contracts the edges between whose ends `is_short` holds, shortest first; otherwise as [`contract_short_edges`].
///
/// A format with coarser coordinates asks for the edges whose ends it would round to one place.
pub fn contract_edges(mesh: &mut Mesh, is_short: impl Fn(DVec3, DVec3) -> bool) -> usize {
    let short = short_edges(mesh, &is_short);
    if short.is_empty() { 0 } else { contract_listed(mesh, short, |ends| *ends, |_, a, b| is_short(a, b)).gone.len() }
}

/// Contracts edges that are rounding noise, in the order given; otherwise as [`contract_short_edges`]. `before` are the positions of the mesh.
pub(super) fn contract_noise(mesh: &mut Mesh, edges: Vec<NoiseEdge>, before: &[DVec3], noise: &mut Noise) {
    if edges.is_empty() {
        return;
    }
    let contraction = contract_listed(mesh, edges, |edge| edge.ends, |edge, a, b| a.distance(b) <= edge.bound);
    for gone in &contraction.gone {
        noise.add(1, before[*gone as usize].distance(before[contraction.current(*gone) as usize]));
    }
}

/// Contracts edges as often as one goes, each where what is asked of it holds of the places of its ends.
fn contract_listed<E>(
    mesh: &mut Mesh,
    mut edges: Vec<E>,
    ends: impl Fn(&E) -> [u32; 2],
    is_short: impl Fn(&E, DVec3, DVec3) -> bool,
) -> Contraction {
    let mut contraction = Contraction::new(mesh);
    loop {
        let before = edges.len();
        edges.retain(|edge| {
            let [a, b] = ends(edge);
            !contraction.contract(mesh, a, b, |a, b| is_short(edge, a, b))
        });
        if edges.len() == before {
            break;
        }
    }
    if !contraction.gone.is_empty() {
        contraction.compact(mesh);
    }
    contraction
}

/// The short edges, shortest first.
fn short_edges(mesh: &Mesh, is_short: impl Fn(DVec3, DVec3) -> bool) -> Vec<[u32; 2]> {
    let at = |v: u32| mesh.positions[v as usize];
    let mut short: Vec<(f64, [u32; 2])> = Vec::new();
    for triangle in &mesh.triangles {
        for k in 0..3 {
            let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
            if a < b && is_short(at(a), at(b)) {
                short.push((at(a).distance(at(b)), [a, b]));
            }
        }
    }
    short.sort_by(|p, q| p.0.total_cmp(&q.0).then(p.1.cmp(&q.1)));
    short.into_iter().map(|(_, edge)| edge).collect()
}

/// The triangles at a vertex that another was merged into.
type Changed = SmallVec<[u32; 8]>;

/// A vertex that no other was merged into.
const UNCHANGED: u32 = u32::MAX;

/// Edges contracted so far.
struct Contraction {
    /// What each vertex became, itself where it is still there.
    became: Vec<u32>,
    /// The vertices that are gone.
    gone: Vec<u32>,
    /// Where the triangles at each vertex begin, and these, as they were.
    starts: Vec<u32>,
    triangles: Vec<u32>,
    /// For each vertex its place in the next list, or [`UNCHANGED`].
    place: Vec<u32>,
    /// The triangles at vertices that others were merged into.
    changed: Vec<Changed>,
    is_removed: Vec<bool>,
    /// For each vertex which [`Mark`] of which test it got last.
    marks: Vec<u64>,
    /// The number of tests so far.
    tests: u64,
}

/// What a test of an edge found of a vertex; less than [`MARKS`].
#[derive(Clone, Copy)]
enum Mark {
    BesideA = 1,
    BesideB = 2,
    BesideBoth = 3,
}

/// Marks of one test are told from those of others by this times its number.
const MARKS: u64 = 4;

impl Contraction {
    fn new(mesh: &Mesh) -> Self {
        let corners = mesh.triangles.as_flattened();
        let (starts, sides) =
            by_group(mesh.positions.len(), corners.len(), |corner| corners[corner] as usize, number32);
        let triangles = sides.into_iter().map(|side| side / 3).collect();
        Self {
            became: (0..number32(mesh.positions.len())).collect(),
            gone: Vec::new(),
            starts,
            triangles,
            place: vec![UNCHANGED; mesh.positions.len()],
            changed: Vec::new(),
            is_removed: vec![false; mesh.triangles.len()],
            marks: vec![0; mesh.positions.len()],
            tests: 0,
        }
    }

    /// The live triangles at a vertex.
    fn triangles_at(&self, vertex: u32) -> impl Iterator<Item = u32> {
        let before = self.starts[vertex as usize] as usize..self.starts[vertex as usize + 1] as usize;
        let changed = self.changed.get(self.place[vertex as usize] as usize);
        let triangles = changed.map_or_else(|| &self.triangles[before], SmallVec::as_slice);
        triangles.iter().copied().filter(|t| !self.is_removed[*t as usize])
    }

    fn put_triangles_at(&mut self, vertex: u32, triangles: Changed) {
        match self.changed.get_mut(self.place[vertex as usize] as usize) {
            Some(changed) => *changed = triangles,
            None => {
                self.place[vertex as usize] = number32(self.changed.len());
                self.changed.push(triangles);
            }
        }
    }

    fn current(&self, mut vertex: u32) -> u32 {
        while self.became[vertex as usize] != vertex {
            vertex = self.became[vertex as usize];
        }
        vertex
    }

    /// Merges `b` into `a`, where that keeps the surface a manifold of the same topology.
    fn contract(&mut self, mesh: &mut Mesh, a: u32, b: u32, is_short: impl Fn(DVec3, DVec3) -> bool) -> bool {
        let (a, b) = (self.current(a), self.current(b));
        let still_short = is_short(mesh.positions[a as usize], mesh.positions[b as usize]);
        if a == b || !still_short || !self.keeps_topology(mesh, a, b) {
            return false;
        }
        let mut at_b: Changed = self.triangles_at(b).collect();
        at_b.retain(|t| {
            let triangle = &mut mesh.triangles[*t as usize];
            let is_removed = triangle.contains(&a);
            if is_removed {
                self.is_removed[*t as usize] = true;
            } else {
                *triangle = triangle.map(|v| if v == b { a } else { v });
            }
            !is_removed
        });
        let at_a = self.triangles_at(a).chain(at_b).collect();
        self.put_triangles_at(a, at_a);
        self.became[b as usize] = a;
        self.gone.push(b);
        true
    }

    /// The link condition: exactly two triangles share the edge, and their tips are all the neighbours that both ends have.
    fn keeps_topology(&mut self, mesh: &Mesh, a: u32, b: u32) -> bool {
        let shared = self.triangles_at(b).filter(|t| mesh.triangles[*t as usize].contains(&a)).count();
        if shared != 2 {
            return false;
        }
        self.tests += 1;
        let mark = |mark: Mark| MARKS * self.tests + mark as u64;
        let mut marks = std::mem::take(&mut self.marks);
        let around = |v: u32| {
            let corners = self.triangles_at(v).flat_map(|t| mesh.triangles[t as usize]);
            corners.filter(move |other| *other != v).map(|other| other as usize)
        };
        let (mut at_a, mut at_b, mut common) = (0, 0, 0);
        for vertex in around(a) {
            at_a += usize::from(marks[vertex] != mark(Mark::BesideA));
            marks[vertex] = mark(Mark::BesideA);
        }
        for vertex in around(b) {
            let known = marks[vertex];
            if known == mark(Mark::BesideA) {
                (at_b, common) = (at_b + 1, common + 1);
                marks[vertex] = mark(Mark::BesideBoth);
            } else if known < mark(Mark::BesideA) {
                at_b += 1;
                marks[vertex] = mark(Mark::BesideB);
            }
        }
        self.marks = marks;
        // a tetrahedron would fold flat
        common == 2 && at_a + at_b > 6
    }

    /// Drops what is no longer used and renumbers the rest.
    fn compact(&self, mesh: &mut Mesh) {
        let kept: Vec<usize> = (0..mesh.triangles.len()).filter(|t| !self.is_removed[*t]).collect();
        mesh.triangles = kept.par_iter().with_min_len(CHUNK).map(|t| mesh.triangles[*t]).collect();
        mesh.triangle_faces = kept.par_iter().with_min_len(CHUNK).map(|t| mesh.triangle_faces[*t]).collect();
        mesh.drop_unused_positions();
        mesh.drop_empty_faces();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Brush, BrushFace, Material, MaterialId, Model, evaluate};
    use planecut_check::check_topology;
    use planecut_kernel::HalfSpace;

    /// A cube with a corner cut off so slightly that the cut's edges have length `size · √2`.
    fn chamfered_cube(size: f64) -> Mesh {
        let normals = DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]).map(|axis| (axis, 1.0));
        let planes = normals.chain([(DVec3::ONE, 3.0 - size)]);
        let faces = planes.map(|(normal, offset)| BrushFace {
            half_space: HalfSpace::new(normal, offset).expect("a valid plane"),
            material: MaterialId(0),
        });
        let brush = Brush { faces: faces.collect(), ..Brush::default() };
        let materials = vec![Material::named("m")];
        evaluate(&Model { materials, tree: brush.into() }).expect("a closed boundary").mesh
    }

    #[test]
    fn a_tiny_chamfer_contracts_to_a_cube() {
        let mut mesh = chamfered_cube(1e-4);
        assert_eq!(contract_short_edges(&mut mesh, 1e-6), 0);
        assert_eq!(mesh.faces.len(), 7);
        assert_eq!(contract_short_edges(&mut mesh, 1e-3), 2);
        assert_eq!((mesh.positions.len(), mesh.triangles.len(), mesh.faces.len()), (8, 12, 6));
        let topology = check_topology(&mesh.positions, &mesh.triangles);
        assert!(topology.watertight && topology.manifold);
    }

    #[test]
    fn a_whole_body_below_the_length_keeps_its_topology() {
        let mut mesh = chamfered_cube(0.5);
        contract_short_edges(&mut mesh, 100.0);
        let topology = check_topology(&mesh.positions, &mesh.triangles);
        assert!(topology.watertight && topology.manifold);
        assert_eq!(mesh.triangles.len(), 4);
    }
}
