//! Models of very many bodies: in groups that have no point in common.
//!
//! Where two bodies are apart, neither changes what the tree is near the other. So the bodies fall into groups, those within a group touching one
//! another by their boxes, and the boundary of the solid is that of one group after another: of a model of a million bodies only the
//! boxes are kept, and the bodies of some thousand are built again when it is their turn. A group of one body needs no boundary and no weld
//! ([`convex`](super::convex)). Of a group of more than some thousand the boundary is made part by part, so that no more bodies than those of
//! one part, and those that touch them, are there at once.
//!
//! Vertices and faces come group by group, in the order of space, so that their order still depends on the geometry alone.

use planecut_kernel::sign::Counts;
use planecut_parallel::prelude::*;

use super::convex::{ConvexMesh, mesh_of};
use super::totals::Totals;
use super::{EvaluateError, Evaluation, Leaves, ModelSummary, OtherBrushes, StageTimes, UnboundedBrushes, ranks};
use crate::base::{Bounds, Boxes, Clock, DisjointSets, map_chunks, map_fixed_chunks};
use crate::body::{
    Body, BrushExtent, BrushExtents, BrushPlanes, BuiltBodies, ShapeBuilder, brush_extents, built_or_build, kinds,
    mark_of,
};
use crate::boundary::BoundaryEdge;
use crate::expression::{Expression, Polarity};
use crate::ids::{Id, LeafId, number32};
use crate::mesh::{Mesh, Noise, proven};
use crate::model::{BrushFace, MaterialId, Model};
use crate::plane_table::{PlaneId, PlaneTable, curve_number};
use crate::weld::{Welded, weld};

/// Models of fewer brushes are evaluated at once.
pub(super) const LEAST: usize = 1 << 16;

/// Groups are evaluated together until they have this many bodies; of larger ones the boundary of this many is made together.
const BODIES_AT_A_TIME: usize = 1 << 13;

/// Least number of boundary edges that a thread copies in a row.
const EDGES_OF_CHUNK: usize = 1 << 12;

/// Number of bodies whose meshes are proven together.
const PROVEN_AT_A_TIME: usize = 1 << 9;

/// The solid of a model, group by group; nothing where a body that is kept reaches infinity, or the solid does.
pub(super) fn evaluate_scattered(
    model: &Model,
    unbounded: UnboundedBrushes,
    built: &BuiltBodies,
    others: OtherBrushes<'_>,
) -> Result<Option<Evaluation>, EvaluateError> {
    evaluate_some_at_a_time(model, unbounded, built, others, BODIES_AT_A_TIME)
}

/// The same with another number of bodies at a time.
fn evaluate_some_at_a_time(
    model: &Model,
    unbounded: UnboundedBrushes,
    built: &BuiltBodies,
    others: OtherBrushes<'_>,
    at_a_time: usize,
) -> Result<Option<Evaluation>, EvaluateError> {
    let begin = Clock::start();
    let expression = Expression::new(model.tree.nodes());
    if expression.base() {
        return Ok(None);
    }
    let BrushExtents { table, planes, extents, mut signs } = brush_extents(model.tree.brushes(), built, others.size);
    let summary = summary_of(&table, &extents);
    if unbounded == UnboundedBrushes::Keep && !summary.unbounded.is_empty() {
        return Ok(None);
    }
    let kinds = others.kinds(kinds_of(model, &planes, &extents));
    let Groups { boxes, alone, mut several } = Groups::of(&extents, &expression, &expression.repeated_leaves(&kinds));
    let polarities = others.polarities(&expression, &kinds);
    drop(kinds);
    let mut scene = Scattered { model, built, table: &table, planes, boxes, walls: others.walls, at_a_time };
    let evaluated = begin.elapsed();

    let welding = Clock::start();
    let rank = ranks(model);
    let mut solid = Solid::with_room(model, &alone, &extents);
    drop(extents);
    for some in alone.chunks(PROVEN_AT_A_TIME * 64) {
        let (parts, counted) = map_fixed_chunks(some, PROVEN_AT_A_TIME, |leaves| scene.alone(leaves));
        signs += counted;
        for Alone { mesh, noise, rest } in parts {
            solid.add(mesh.mesh, &mesh.totals, noise);
            several.extend(rest.into_iter().map(|leaf| vec![leaf]));
        }
    }
    let mut triangulate = std::time::Duration::ZERO;
    let mut rest = several.as_slice();
    while !rest.is_empty() {
        let (some, after) = rest.split_at(next_groups(rest, at_a_time));
        rest = after;
        let edges = scene.boundary_edges(&some.concat(), (&expression, &polarities), &rank, &mut signs);
        if rest.is_empty() {
            // the weld takes most memory, and no body is built any more
            (scene.planes, scene.boxes) = Default::default();
        }
        let Welded { mesh, solid: measures, noise, signs: counted, triangulation } =
            weld(&table, edges, &rank, &model.materials, scene.walls)?;
        signs += counted;
        triangulate += triangulation;
        solid.add(mesh, &Totals::of(&measures), noise);
    }
    let times = StageTimes { evaluate: evaluated, weld: welding.elapsed().saturating_sub(triangulate), triangulate };
    let Solid { mesh, totals, noise } = solid;
    Ok(Some(Evaluation { mesh, solid: totals.measures(), noise, model: summary, signs, times }))
}

/// How many groups are evaluated together.
fn next_groups(groups: &[Vec<LeafId>], at_a_time: usize) -> usize {
    let bodies = groups.iter().scan(0, |bodies, group| {
        *bodies += group.len();
        Some(*bodies)
    });
    bodies.take_while(|bodies| *bodies <= at_a_time).count().max(1)
}

/// What all groups need.
struct Scattered<'a> {
    model: &'a Model,
    built: &'a BuiltBodies,
    table: &'a PlaneTable,
    /// The planes of the leaves.
    planes: BrushPlanes,
    /// The box of each leaf.
    boxes: Boxes,
    /// The material of walls of a block.
    walls: Option<MaterialId>,
    /// Number of bodies whose boundary is made together.
    at_a_time: usize,
}

/// The mesh of some bodies that touch nothing.
struct Alone {
    mesh: ConvexMesh,
    noise: Noise,
    /// Those that are not in it.
    rest: Vec<LeafId>,
}

impl Scattered<'_> {
    fn body(&self, leaf: LeafId, builder: &mut ShapeBuilder) -> Option<Body> {
        let number = leaf.index();
        let brush = &self.model.tree.brushes()[number];
        built_or_build(self.table, self.built, brush, self.planes.of(number), builder).bounded()
    }

    /// Bodies that touch nothing, of which each is its own boundary.
    fn alone(&self, leaves: &[LeafId]) -> Alone {
        let (mut builder, mut rest) = (ShapeBuilder::default(), Vec::new());
        let bodies = leaves.iter().filter_map(|leaf| self.body(*leaf, &mut builder).map(|body| (*leaf, body)));
        let mut mesh = mesh_of(self.table, bodies, &mut rest);
        match proven(std::mem::take(&mut mesh.mesh), &mesh.totals.measures(), self.walls, false) {
            Ok((proven, noise)) => {
                mesh.mesh = proven;
                Alone { mesh, noise, rest }
            }
            // what is wrong with one of them the weld may do better, or it tells of it
            Err(_) => Alone { mesh: ConvexMesh::default(), noise: Noise::default(), rest: leaves.to_vec() },
        }
    }

    /// The boundary edges of whole groups, given their leaves in the order of space, so that few have neighbours in other parts.
    fn boundary_edges(
        &self,
        leaves: &[LeafId],
        tree: (&Expression, &[Polarity]),
        rank: &[u32],
        signs: &mut Counts,
    ) -> Vec<BoundaryEdge> {
        let mut edges = Vec::new();
        for part in leaves.chunks(self.at_a_time) {
            let own = sorted(part.to_vec());
            let near = if part.len() == leaves.len() { own.clone() } else { with_neighbours(part, &self.boxes) };
            let (of_part, counted) = self
                .leaves(&near, signs)
                .boundary_edges_of(self.table, tree, rank, |leaf| own.binary_search(&leaf).is_ok());
            *signs += counted;
            if edges.is_empty() {
                edges = of_part;
                // the memory is taken when it is written to
                edges.reserve(edges.len() * (leaves.len() - part.len()) / part.len());
            } else {
                edges.par_extend(of_part.par_iter().with_min_len(EDGES_OF_CHUNK).copied());
            }
        }
        edges
    }

    /// The bodies of some leaves.
    fn leaves(&self, leaves: &[LeafId], signs: &mut Counts) -> Leaves {
        let (parts, counted) = map_fixed_chunks(leaves, 16, |chunk| {
            let mut builder = ShapeBuilder::default();
            chunk.iter().map(|leaf| self.body(*leaf, &mut builder)).collect::<Vec<_>>()
        });
        *signs += counted;
        let mut bodies = Leaves::default();
        for (leaf, body) in leaves.iter().zip(parts.into_iter().flatten()) {
            if let Some(body) = body {
                bodies.push(leaf.index(), body);
            }
        }
        bodies
    }
}

fn sorted(mut leaves: Vec<LeafId>) -> Vec<LeafId> {
    leaves.sort_unstable();
    leaves
}

/// Some leaves and those whose boxes touch theirs, ascending.
fn with_neighbours(leaves: &[LeafId], boxes: &Boxes) -> Vec<LeafId> {
    let (parts, _) = map_chunks(leaves, 256, |chunk| {
        let (mut found, mut near) = (Vec::new(), Vec::new());
        for leaf in chunk {
            boxes.touching(boxes.get(number32(leaf.index())), &mut found);
            near.extend(found.iter().map(|other| LeafId::from_index(*other as usize)));
        }
        near.sort_unstable();
        near.dedup();
        near
    });
    let mut near = sorted(parts.concat());
    near.dedup();
    near
}

/// Leaves whose bodies have no point in common with those of other groups, groups and what is in them in the order of space.
struct Groups {
    /// The box of each leaf.
    boxes: Boxes,
    alone: Vec<LeafId>,
    several: Vec<Vec<LeafId>>,
}

impl Groups {
    fn of(extents: &[BrushExtent], expression: &Expression, repeated: &[bool]) -> Self {
        let bounds = |leaf: usize| match extents[leaf].bounds() {
            Some(bounds) if !repeated[leaf] => *bounds,
            _ => Bounds::EMPTY,
        };
        let boxes = Boxes::new((0..extents.len()).map(bounds).collect());
        let in_order: Vec<u32> = boxes.in_order().collect();
        let (pairs, _) = map_chunks(&in_order, 256, |chunk| {
            let (mut found, mut pairs) = (Vec::new(), Vec::new());
            for &body in chunk {
                boxes.touching(boxes.get(body), &mut found);
                pairs.extend(found.iter().filter(|other| **other < body).map(|other| (*other, body)));
            }
            pairs
        });
        let mut sets = DisjointSets::new(extents.len());
        pairs.into_iter().flatten().for_each(|(a, b)| sets.join(a, b));
        let mut members: Vec<(u32, u32)> = in_order.iter().map(|body| (sets.root(*body), *body)).collect();
        members.sort_by_key(|(root, _)| *root);
        // a group is where the first of its bodies is; boxes of different groups have no point in common
        let place = |body: u32| {
            let min = boxes.get(body).min;
            (curve_number(min), min.to_array().map(crate::base::sortable))
        };
        let mut groups: Vec<_> = members
            .chunk_by(|a, b| a.0 == b.0)
            .map(|group| (group.iter().map(|(_, body)| place(*body)).min(), group))
            .collect();
        groups.sort_unstable();
        let mut sorted = Self { boxes: Boxes::default(), alone: Vec::new(), several: Vec::new() };
        for (_, group) in groups {
            match group {
                [(_, body)] => sorted.alone.push(LeafId::from_index(*body as usize)),
                several => {
                    let leaves = several.iter().map(|(_, body)| LeafId::from_index(*body as usize));
                    sorted.several.push(leaves.collect());
                }
            }
        }
        sorted.alone.retain(|leaf| expression.is_solid_alone(*leaf));
        Self { boxes, ..sorted }
    }
}

/// For each leaf a number that equal ones have in common.
fn kinds_of(model: &Model, planes: &BrushPlanes, extents: &[BrushExtent]) -> Vec<LeafId> {
    let faces = |leaf: LeafId| {
        let number = leaf.index();
        let all = planes.of(number).iter().zip(&model.tree.brushes()[number].faces);
        let is_body = extents[number].bounds().is_some();
        all.filter(move |_| is_body).map(|(plane, face): (&PlaneId, &BrushFace)| (*plane, face.material))
    };
    kinds(extents.len(), faces, |leaf| mark_of(faces(leaf)))
}

/// What is there of the solid so far.
struct Solid {
    mesh: Mesh,
    totals: Totals,
    noise: Noise,
}

impl Solid {
    /// With room for bodies of which each is its own boundary, with three planes at every corner.
    fn with_room(model: &Model, alone: &[LeafId], extents: &[BrushExtent]) -> Self {
        let face_count = |leaf: &LeafId| match &extents[leaf.index()] {
            BrushExtent::Bounded { redundant, .. } => {
                model.tree.brushes()[leaf.index()].faces.len().saturating_sub(redundant.len())
            }
            BrushExtent::Empty | BrushExtent::Unbounded => 0,
        };
        let faces: usize = alone.iter().map(face_count).sum();
        // Euler's formula, with three edges at each vertex
        let vertices = (2 * faces).saturating_sub(4 * alone.len());
        let triangles = (2 * vertices).saturating_sub(4 * alone.len());
        let mut mesh = Mesh { materials: model.materials.clone(), ..Mesh::default() };
        mesh.positions.reserve_exact(vertices);
        mesh.triangles.reserve_exact(triangles);
        mesh.triangle_faces.reserve_exact(triangles);
        mesh.faces.reserve_exact(faces);
        Self { mesh, totals: Totals::default(), noise: Noise::default() }
    }

    fn add(&mut self, part: Mesh, totals: &Totals, noise: Noise) {
        self.totals.add(totals);
        self.noise.collapsed += noise.collapsed;
        self.noise.thickest = self.noise.thickest.max(noise.thickest);
        let Mesh { positions, mut triangles, mut triangle_faces, faces, .. } = part;
        let (vertex, face) = (number32(self.mesh.positions.len()), number32(self.mesh.faces.len()));
        // numbers of vertices and faces must fit
        number32(self.mesh.positions.len() + positions.len());
        triangles.iter_mut().flatten().for_each(|corner| *corner += vertex);
        triangle_faces.iter_mut().for_each(|number| *number += face);
        append(&mut self.mesh.positions, positions);
        append(&mut self.mesh.triangles, triangles);
        append(&mut self.mesh.triangle_faces, triangle_faces);
        append(&mut self.mesh.faces, faces);
    }
}

/// Adds a list to another, the shorter of them to the longer one: mostly nearly everything hangs together, and is not to be there twice.
fn append<T: Copy>(list: &mut Vec<T>, mut other: Vec<T>) {
    if list.len() < other.len() {
        other.reserve_exact(list.len());
        other.splice(0..0, list.drain(..));
        *list = other;
    } else {
        list.append(&mut other);
    }
}

fn summary_of(table: &PlaneTable, extents: &[BrushExtent]) -> ModelSummary {
    let mut summary = ModelSummary {
        brushes: extents.len(),
        planes: table.len(),
        snapped_planes: table.snapped(),
        ..ModelSummary::default()
    };
    for (number, extent) in extents.iter().enumerate() {
        match extent {
            BrushExtent::Bounded { volume, redundant, .. } => {
                summary.redundant_planes += redundant.len();
                summary.brush_volume_sum += volume;
            }
            BrushExtent::Empty => summary.empty.push(number),
            BrushExtent::Unbounded => summary.unbounded.push(number),
        }
    }
    summary
}

#[cfg(test)]
#[path = "scattered_tests.rs"]
mod tests;
