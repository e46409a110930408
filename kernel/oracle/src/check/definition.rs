//! Small polytopes against the definition: all triples of planes, in exact arithmetic, with the
//! symbolic perturbation for the structure and without it for the mesh.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use dashu_int::IBig;
use planecut_kernel::{DVec3, IncrementalPolytope, PlaneIdx};

use super::facets::{check_ideal_vertices, compare_facets, compare_vertices};
use super::measures::compare_measures;
use crate::edges::Edges;
use crate::exact::{integer_row, normal};
use crate::replay::Replay;
use crate::solid::Solid;
use crate::structure::{Structure, agree};
use crate::truth::Truth;

/// Compares everything the kernel says with [`Truth`], [`Edges`] and [`Solid`], for any number of planes that brute
/// force can bear (about 12). The polytope must have the tolerance 0.
///
/// # Errors
/// The first difference.
pub fn compare_with_truth(replay: &Replay) -> Result<(), String> {
    let (polytope, order, planes) = (&replay.polytope, replay.order(), replay.planes());
    let truth = Truth::of(&planes);
    Structure::of(polytope, &order)?.compare(&truth)?;
    polytope.check_invariants().map_err(|e| format!("invariant broken: {e}"))?;
    polytope.validate_topology().map_err(|e| format!("topology broken: {e}"))?;
    if truth.empty {
        let counts =
            (polytope.vertex_count(), polytope.edge_count(), polytope.to_mesh().0.len(), polytope.faces().len());
        return agree("vertices, edges, mesh and faces of the empty set", &counts, &(0, 0, 0, 0));
    }
    let rank: HashMap<PlaneIdx, usize> = order.iter().enumerate().map(|(k, &p)| (p, k)).collect();
    let edges = Edges::of(&planes);
    compare_edges(polytope, &edges)?;
    check_ideal_vertices(polytope, &rank, &planes, edges.ideal_ends)?;
    if !truth.bounded {
        return agree("measures of an unbounded set", &polytope.measures(), &None);
    }
    let solid = Solid::of(&planes);
    assert_eq!(edges.count, solid.edges.len(), "the oracle contradicts itself");
    let normals: Vec<_> = planes.iter().map(|&p| normal(&integer_row(p))).collect();
    let view = View::of(polytope, &rank)?;
    view.compare_counts(&solid)?;
    let names = view.match_vertices(&solid)?;
    let loops = view.compare_loops(&solid, &names, &normals)?;
    view.compare_positions(&solid, &names)?;
    compare_facets(polytope, &rank, &solid, &normals)?;
    compare_vertices(polytope, &rank, &solid)?;
    compare_measures(polytope, &solid, &loops)
}

/// Counts that are defined for unbounded sets, too: an ideal vertex is the end of one ray or line.
fn compare_edges(polytope: &IncrementalPolytope, edges: &Edges) -> Result<(), String> {
    agree("edge_count", &polytope.edge_count(), &edges.count)?;
    agree("finite vertices", &polytope.to_mesh().0.len(), &edges.finite_ends.len())?;
    agree("vertex_count", &polytope.vertex_count(), &(edges.finite_ends.len() + edges.ideal_ends))
}

/// The kernel's view from outside: positions and, per face, its plane's place in the order and its loop.
struct View {
    positions: Vec<DVec3>,
    loops: BTreeMap<usize, Vec<usize>>,
}

impl View {
    fn of(polytope: &IncrementalPolytope, rank: &HashMap<PlaneIdx, usize>) -> Result<Self, String> {
        let (positions, mesh_faces) = polytope.to_mesh();
        let faces = polytope.faces();
        let loops: BTreeMap<usize, Vec<usize>> = faces.iter().map(|f| (rank[&f.plane], f.vertices.clone())).collect();
        agree("planes with faces", &faces.len(), &loops.len())?;
        if loops.values().flatten().any(|&v| v >= positions.len()) {
            return Err(format!("a face names a vertex that is not there: {loops:?}"));
        }
        let mut from_faces: Vec<Vec<usize>> = loops.values().map(|l| least_rotation(l)).collect();
        let mut from_mesh: Vec<Vec<usize>> = mesh_faces.iter().map(|l| least_rotation(l)).collect();
        from_faces.sort();
        from_mesh.sort();
        agree("loops of faces() and to_mesh()", &from_faces, &from_mesh)?;
        Ok(Self { positions, loops })
    }

    fn compare_counts(&self, solid: &Solid) -> Result<(), String> {
        let owners: Vec<usize> = solid.facets.iter().map(|f| f.plane).collect();
        agree("planes of the faces", &self.loops.keys().copied().collect(), &owners)?;
        agree("vertices of the mesh", &self.positions.len(), &solid.vertices.len())
    }

    /// The exact vertex of each mesh vertex: the one on the same faces. No coordinate is compared.
    fn match_vertices(&self, solid: &Solid) -> Result<Vec<usize>, String> {
        let mut exact: BTreeMap<BTreeSet<usize>, usize> = BTreeMap::new();
        for v in 0..solid.vertices.len() {
            let faces = solid.facets.iter().filter(|f| f.vertices.contains(&v)).map(|f| f.plane).collect();
            assert!(exact.insert(faces, v).is_none(), "two vertices on the same faces");
        }
        let name = |v: usize| {
            let faces: BTreeSet<usize> = self.loops.iter().filter(|(_, l)| l.contains(&v)).map(|(&p, _)| p).collect();
            exact.get(&faces).copied().ok_or_else(|| format!("no vertex has the faces {faces:?} of mesh vertex {v}"))
        };
        (0..self.positions.len()).map(name).collect()
    }

    /// The faces' loops in terms of exact vertices, each found to be a cycle of edges that turns left.
    fn compare_loops(
        &self,
        solid: &Solid,
        names: &[usize],
        normals: &[[IBig; 3]],
    ) -> Result<BTreeMap<usize, Vec<usize>>, String> {
        let mut loops = BTreeMap::new();
        for facet in &solid.facets {
            let corners: Vec<usize> = self.loops[&facet.plane].iter().map(|&v| names[v]).collect();
            agree("corners of a face", &corners.len(), &facet.vertices.len())?;
            for (k, &p) in corners.iter().enumerate() {
                let q = corners[(k + 1) % corners.len()];
                if !solid.edges.contains(&[p.min(q), p.max(q)]) {
                    return Err(format!("face {}: {p} to {q} is no edge", facet.plane));
                }
            }
            agree("turn of a face", &solid.turn(&normals[facet.plane], [corners[0], corners[1], corners[2]]), &1)?;
            loops.insert(facet.plane, corners);
        }
        Ok(loops)
    }

    /// The kernel promises correctly rounded coordinates.
    fn compare_positions(&self, solid: &Solid, names: &[usize]) -> Result<(), String> {
        for (position, &name) in self.positions.iter().zip(names) {
            let vertex = &solid.vertices[name];
            let exact: Vec<f64> = vertex.position.iter().map(|c| c.to_f64().value()).collect();
            if position.as_ref().as_slice() != exact {
                let on = &vertex.planes;
                return Err(format!("vertex on planes {on:?} is at {position:?}, correctly rounded at {exact:?}"));
            }
        }
        Ok(())
    }
}

fn least_rotation(vertices: &[usize]) -> Vec<usize> {
    let start = vertices.iter().enumerate().min_by_key(|&(_, v)| v).map_or(0, |(k, _)| k);
    vertices[start..].iter().chain(&vertices[..start]).copied().collect()
}
