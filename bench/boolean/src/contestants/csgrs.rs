//! csgrs: polygons in binary space partitions, two solids at a time.

use std::time::Instant;

use csgrs::mesh::Mesh;
use csgrs::traits::CSG;

use super::{Binary, Contestant, Outcome, begun, fold, halves, outcome};
use crate::scene::{Body, Plan, Scene};

pub(super) struct Csgrs {
    bodies: Vec<Mesh<()>>,
    plan: Plan,
}

impl Csgrs {
    pub(super) fn new(scene: Scene) -> Result<Self, String> {
        let bodies = scene.bodies.iter().map(mesh).collect::<Result<_, _>>()?;
        let (plan, bodies) = begun(scene.plan, bodies, |model| halves(model, &Mesh::new(), Binary::Union, &combine))?;
        Ok(Self { bodies, plan })
    }
}

fn mesh(body: &Body) -> Result<Mesh<()>, String> {
    let corners: Vec<[usize; 3]> =
        body.triangles.iter().map(|triangle| triangle.map(|corner| corner as usize)).collect();
    let faces: Vec<&[usize]> = corners.iter().map(<[usize; 3]>::as_slice).collect();
    Mesh::polyhedron(&body.positions, &faces, None).map_err(|error| format!("{error:?}"))
}

fn combine(a: &Mesh<()>, b: &Mesh<()>, operation: Binary) -> Result<Mesh<()>, String> {
    Ok(match operation {
        Binary::Union => a.union(b),
        Binary::Difference => a.difference(b),
        Binary::Intersection => a.intersection(b),
    })
}

impl Contestant for Csgrs {
    fn run(&mut self) -> Result<Outcome, String> {
        let begin = Instant::now();
        let result = fold(&self.plan, &self.bodies, &Mesh::new(), &combine)?.triangulate();
        let time = begin.elapsed();
        let triangles: Vec<[[f64; 3]; 3]> = result
            .polygons
            .iter()
            .filter(|polygon| polygon.vertices.len() == 3)
            .map(|polygon| [0, 1, 2].map(|k| polygon.vertices[k].pos.coords.into()))
            .collect();
        Ok(outcome(time, &triangles))
    }
}
