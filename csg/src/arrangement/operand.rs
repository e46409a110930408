//! Closed meshes made ready for the arrangement.

use planecut_parallel::prelude::*;
use rustc_hash::FxHashMap;

use super::predicates::best_axis;
use super::surface::{Surface, are_safe};
use super::triangle_tree::TriangleTree;
use crate::closed_mesh::WindingRule;
use crate::closed_mesh::connectivity::NO_TWIN;
use crate::ids::{Id, PointId, TriangleId, number32};
use crate::model::{MaterialId, MeshBody};
use glam::DVec3;

/// A closed mesh where it lies, made ready for the arrangement.
#[derive(Debug, Default)]
pub(super) struct Operand {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    materials: Vec<MaterialId>,
    twins: Vec<u32>,
    tree: TriangleTree,
    is_flat: Vec<bool>,
    is_safe: bool,
    pub(super) rule: WindingRule,
}

impl Operand {
    pub(super) fn new(body: &MeshBody) -> Self {
        let materials = (0..body.mesh().triangles().len()).map(|triangle| body.material(triangle)).collect();
        let positions = body.positions().into_owned();
        let is_safe = are_safe(&positions);
        let twins = if body.is_mirrored() { mirrored_twins(body.mesh().twins()) } else { body.mesh().twins().to_vec() };
        let triangles = body.triangles().into_owned();
        let mut mesh = Self { positions, triangles, materials, twins, is_safe, rule: body.rule(), ..Self::default() };
        mesh.find_flat();
        let with_area: Vec<u32> = (0..number32(mesh.triangles.len())).filter(|t| !mesh.is_flat[*t as usize]).collect();
        mesh.tree = TriangleTree::new(&with_area, |t| mesh.triangles[t as usize].map(|v| mesh.positions[v as usize]));
        mesh
    }

    fn find_flat(&mut self) {
        let surface = surface(&[&*self]).0;
        let is_flat = |k: usize| best_axis(&surface, TriangleId::from_index(k)).is_none();
        self.is_flat = (0..self.triangles.len()).into_par_iter().with_min_len(1 << 12).map(is_flat).collect();
    }
}

/// The twins of half-edges where the second and third corner of each triangle have changed places.
fn mirrored_twins(twins: &[u32]) -> Vec<u32> {
    // half-edges 0, 1, 2 run between corners 0-1, 1-2, 2-0; afterwards these are 2, 1, 0
    let moved = |half_edge: u32| 3 * (half_edge / 3) + 2 - half_edge % 3;
    let of = |half_edge: u32| {
        let twin = twins[moved(half_edge) as usize];
        if twin == NO_TWIN { NO_TWIN } else { moved(twin) }
    };
    (0..number32(twins.len())).map(of).collect()
}

/// All triangles of operands, with vertices joined between operands whose boxes touch; and which of them have no area.
pub(super) fn surface(meshes: &[&Operand]) -> (Surface, Vec<bool>) {
    let mut all = Surface { is_safe: meshes.iter().all(|mesh| mesh.is_safe), ..Surface::default() };
    let mut is_flat = Vec::new();
    let boxes: Vec<crate::base::Bounds> = meshes.iter().map(|mesh| mesh.tree.all_bounds()).collect();
    let tree = crate::base::Boxes::new(boxes);
    let mut near = Vec::new();
    let mut known: FxHashMap<[u64; 3], PointId> = FxHashMap::default();
    for (operand, mesh) in (0..).zip(meshes) {
        let mut number: Vec<PointId> = Vec::with_capacity(mesh.positions.len());
        let bounds = mesh.tree.all_bounds();
        tree.touching(&bounds, &mut near);
        let common: Vec<crate::base::Bounds> =
            near.iter().filter(|k| **k != operand).map(|k| tree.get(*k).intersection(&bounds)).collect();
        let is_common = |p: &DVec3| common.iter().any(|b| b.min.cmple(*p).all() && p.cmple(b.max).all());
        for position in &mesh.positions {
            let fresh = PointId::from_index(all.positions.len());
            let joined = if is_common(position) {
                *known.entry(position.to_array().map(f64::to_bits)).or_insert(fresh)
            } else {
                fresh
            };
            if joined == fresh {
                all.positions.push(*position);
            }
            number.push(joined);
        }
        let sides = 3 * number32(all.corners.len());
        all.corners.extend(mesh.triangles.iter().map(|triangle| triangle.map(|v| number[v as usize])));
        all.twins.extend(mesh.twins.iter().map(|twin| if *twin == NO_TWIN { NO_TWIN } else { twin + sides }));
        all.operands.extend(std::iter::repeat_n(operand, mesh.triangles.len()));
        all.materials.extend(&mesh.materials);
        is_flat.extend(&mesh.is_flat);
    }
    (all, is_flat)
}

/// The hierarchies of boxes of operands, with triangles numbered as in their common surface.
pub(super) fn trees(meshes: &[&Operand]) -> Vec<TriangleTree> {
    let mut first = 0;
    let of = |mesh: &&Operand| {
        let tree = mesh.tree.renumbered(first);
        first += number32(mesh.triangles.len());
        tree
    };
    meshes.iter().map(of).collect()
}
