//! Closed meshes whose triangles the model lists itself.

use glam::DVec3;
use planecut_csg::{Brush, ClosedMesh, ClosedMeshError, MaterialId, MeshBody};
use rustc_hash::FxHashMap;

use super::error::{Checked, Fault};
use super::json::{Document, Entry};
use super::materials::NO_MATERIAL;
use super::meshes::rule_of;
use super::names::Names;
use super::values::Values;

/// Largest magnitude of a coordinate, that of mesh files.
const MAX_COORDINATE: f64 = f64::from_bits((1023 + 100) << 52);

/// How many triangles a mesh lists; `None` where it is in a file.
pub(super) fn count_of_triangles(document: &Document<'_>, mesh: Entry) -> Option<usize> {
    document.member(mesh, "triangles").map(|triangles| document.items(triangles).count())
}

/// The mesh of an object that lists its vertices and triangles, as it stands: no vertex is rounded, turned or moved. Triangles without a material of
/// their own have none yet.
///
/// # Errors
/// [`Fault`] of the coordinate that is out of range, of the number that is no vertex, or of the triangle at the first edge that is open.
pub(super) fn inline_mesh(values: &Values<'_, '_>, names: &Names, mesh: Entry) -> Checked<Brush> {
    let document = values.document;
    let items = |key| document.member(mesh, key).into_iter().flat_map(|list| document.items(list));
    let positions = items("vertices").map(|vertex| position(values, vertex)).collect::<Checked<Vec<DVec3>>>()?;
    let last = positions.len().saturating_sub(1) as u32;
    let corners = |triangle: Entry| {
        let mut corners = [0; 3];
        for (corner, item) in corners.iter_mut().zip(document.items(triangle)) {
            *corner = values.whole(item, 0, last)?;
        }
        Ok(corners)
    };
    let triangles = items("triangles").map(corners).collect::<Checked<Vec<[u32; 3]>>>()?;
    let Surfaces { materials, of_triangle } = Surfaces::of(document, names, mesh);
    let surface = |triangle: usize| of_triangle.get(triangle).copied().unwrap_or(0);
    match ClosedMesh::new(&positions, &triangles, surface) {
        Ok(closed) => Ok(Brush::of_mesh(MeshBody::new(closed, materials).with_rule(rule_of(values, mesh)))),
        Err(ClosedMeshError::Open { triangle, from, to, count }) => {
            let edges = if count == 1 { "edge" } else { "edges" };
            let found = format!("{count} open {edges}, the first one from {from} to {to}");
            Err(Fault::new(items("triangles").nth(triangle).unwrap_or(mesh), found, "a closed mesh"))
        }
        Err(error) => Err(Fault::new(mesh, error.to_string(), "a closed mesh")),
    }
}

/// A vertex whose coordinates leave room for products of them.
fn position(values: &Values<'_, '_>, vertex: Entry) -> Checked<DVec3> {
    let position = values.vector(vertex)?;
    let is_accepted = |value: f64| value == 0.0 || (f64::MIN_POSITIVE..=MAX_COORDINATE).contains(&value.abs());
    let wrong =
        position.to_array().into_iter().zip(values.document.items(vertex)).find(|(value, _)| !is_accepted(*value));
    match wrong {
        Some((_, item)) => Err(Fault::new(
            item,
            values.describe_number(item),
            "0, or a magnitude of at least 2^-1022 and at most 2^100",
        )),
        None => Ok(position),
    }
}

/// What the triangles of a mesh are made of, each material once.
struct Surfaces {
    materials: Vec<MaterialId>,
    /// The place among the materials, for each triangle; empty where all are of the first one.
    of_triangle: Vec<u32>,
}

impl Surfaces {
    fn of(document: &Document<'_>, names: &Names, mesh: Entry) -> Self {
        let Some(list) = document.member(mesh, "materials") else {
            return Self { materials: vec![NO_MATERIAL], of_triangle: Vec::new() };
        };
        let mut materials = Vec::new();
        let mut places: FxHashMap<MaterialId, u32> = FxHashMap::default();
        let mut place = |material: MaterialId| {
            *places.entry(material).or_insert_with(|| {
                materials.push(material);
                materials.len() as u32 - 1
            })
        };
        let of_triangle = names.numbers_of_materials(document, list, NO_MATERIAL).map(&mut place).collect();
        Self { materials, of_triangle }
    }
}
