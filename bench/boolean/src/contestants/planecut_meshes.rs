//! planecut on closed meshes: from arrays to a triangulated mesh.

use std::time::Instant;

use planecut_csg::{Brush, ClosedMesh, Material, MaterialId, MeshBody, Model, Transform, evaluate};
use planecut_kernel::{DMat3, DVec3};

use super::{Contestant, Outcome};
use crate::scene::{Body, Entry, Matrix, Plan, Scene};

pub(super) struct PlanecutMeshes {
    operands: Vec<Operand>,
    entries: Vec<Entry>,
}

/// A mesh as arrays.
struct Operand {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    transform: Option<Transform>,
}

impl PlanecutMeshes {
    pub(super) fn new(scene: &Scene) -> Result<Self, String> {
        let Plan::Tree(entries) = &scene.plan else { return Err("meshes are not combined step by step".to_owned()) };
        let operands = scene.bodies.iter().map(Operand::new).collect::<Result<_, String>>()?;
        Ok(Self { operands, entries: entries.clone() })
    }
}

impl Operand {
    fn new(body: &Body) -> Result<Self, String> {
        Ok(Self {
            positions: body.positions.iter().copied().map(DVec3::from_array).collect(),
            triangles: body.triangles.clone(),
            transform: body.matrix.as_ref().map(transform).transpose()?,
        })
    }

    fn leaf(&self) -> Result<Brush, String> {
        let mesh = ClosedMesh::new(&self.positions, &self.triangles, |_| 0).map_err(|error| error.to_string())?;
        let body = MeshBody::new(mesh, vec![MaterialId(0)]);
        let moved = match &self.transform {
            Some(transform) => body.transformed(transform).map_err(|error| error.to_string())?,
            None => body,
        };
        Ok(Brush::of_mesh(moved))
    }
}

fn transform(rows: &Matrix) -> Result<Transform, String> {
    let column = |k: usize| DVec3::from_array(rows.map(|row| row[k]));
    let linear = DMat3::from_cols(column(0), column(1), column(2));
    Transform::new(linear, column(3)).map_err(|error| error.to_string())
}

impl Contestant for PlanecutMeshes {
    fn run(&mut self) -> Result<Outcome, String> {
        let begin = Instant::now();
        let leaves = self.operands.iter().map(Operand::leaf).collect::<Result<Vec<Brush>, String>>()?;
        let tree = Scene::tree_of(&self.entries, leaves.into_iter());
        let model = Model { materials: vec![Material::named("all")], tree };
        let evaluation = evaluate(&model).map_err(|error| error.to_string())?;
        Ok(Outcome {
            seconds: begin.elapsed().as_secs_f64(),
            volume: evaluation.solid.volume,
            area: evaluation.solid.area,
            triangles: evaluation.mesh.triangles.len(),
        })
    }
}
