//! The edges in which the meshes of neighbouring blocks meet.

use rustc_hash::FxHashMap;

use crate::base::sortable;
use crate::mesh::Mesh;
use crate::model::MaterialId;

/// Both ends of an edge, the lesser one first.
type Edge = [[u64; 3]; 2];

/// The edges on walls that have not yet been met from the other side, and how many more times in their direction than back.
#[derive(Default)]
pub(super) struct Seams {
    edges: FxHashMap<Edge, i32>,
}

impl Seams {
    /// Drops the faces on walls from a mesh and notes the edges in which what is left ends there.
    pub(super) fn part(&mut self, mesh: &mut Mesh, wall: MaterialId) {
        let is_wall: Vec<bool> = mesh.faces.iter().map(|face| face.material == wall).collect();
        if !is_wall.contains(&true) {
            return;
        }
        let (on_wall, kept): (Vec<usize>, Vec<usize>) =
            (0..mesh.triangles.len()).partition(|triangle| is_wall[mesh.triangle_faces[*triangle] as usize]);
        // edges between two triangles on walls cancel as those on seams do
        for triangle in on_wall {
            let [a, b, c] = mesh.triangles[triangle].map(|vertex| mesh.positions[vertex as usize]);
            for (from, to) in [(a, b), (b, c), (c, a)] {
                let ends = [from, to].map(|end| (end + 0.0).to_array().map(sortable));
                let is_forward = ends[0] <= ends[1];
                let edge = if is_forward { ends } else { [ends[1], ends[0]] };
                let met = self.edges.entry(edge).or_default();
                *met += if is_forward { 1 } else { -1 };
                if *met == 0 {
                    self.edges.remove(&edge);
                }
            }
        }
        mesh.triangle_faces = kept.iter().map(|triangle| mesh.triangle_faces[*triangle]).collect();
        mesh.triangles = kept.iter().map(|triangle| mesh.triangles[*triangle]).collect();
        mesh.drop_empty_faces();
    }

    /// How many edges have not been met from the other side.
    pub(super) fn open(&self) -> usize {
        self.edges.len()
    }
}
