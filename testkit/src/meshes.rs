//! Meshes made by hand, so that tests of what takes meshes need no other part of the product to be right.

use glam::{DMat3, DVec3};
use planecut_csg::{Material, MaterialId, Mesh, MeshFace};

use crate::random::Rng;

/// The volume inside closed triangles that are counter-clockwise seen from outside.
pub fn volume(triangles: impl Iterator<Item = [DVec3; 3]>) -> f64 {
    triangles.map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum()
}

/// The volume of a mesh, measured from its first vertex.
///
/// # Panics
///
/// Panics if the mesh has no vertex.
#[must_use]
pub fn mesh_volume(mesh: &Mesh) -> f64 {
    let base = mesh.positions[0];
    volume(mesh.triangles.iter().map(|t| t.map(|corner| mesh.positions[corner as usize] - base)))
}

/// Every directed edge occurs once, and so does its opposite.
///
/// # Panics
///
/// Panics if that is not so; `what` is said of the mesh.
pub fn assert_closed(mesh: &Mesh, what: &str) {
    let sides = |[a, b, c]: &[u32; 3]| [[*a, *b], [*b, *c], [*c, *a]];
    let mut edges: Vec<[u32; 2]> = mesh.triangles.iter().flat_map(sides).collect();
    edges.sort_unstable();
    assert!(edges.windows(2).all(|pair| pair[0] != pair[1]), "{what}: an edge occurs twice");
    assert!(edges.iter().all(|[a, b]| edges.binary_search(&[*b, *a]).is_ok()), "{what}: an edge is open");
}

/// An axis-aligned box of one material.
#[must_use]
pub fn box_mesh(min: DVec3, max: DVec3, material: &str) -> Mesh {
    let mut mesh = Mesh::default();
    push_box(&mut mesh, (min + max) / 2.0, (max - min) / 2.0, DMat3::IDENTITY, material);
    mesh
}

/// Adds a closed box as a component of its own.
pub fn push_box(mesh: &mut Mesh, center: DVec3, half: DVec3, rotation: DMat3, material: &str) {
    let base = mesh.positions.len() as u32;
    // Bit i of the corner number is its side along axis i.
    for corner in 0..8_u32 {
        let sides = DVec3::from([0, 1, 2].map(|axis| if corner >> axis & 1 == 1 { 1.0 } else { -1.0 }));
        mesh.positions.push(center + rotation * (half * sides));
    }
    for axis in 0..3 {
        let (u, v) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
        for side in 0..2_u32 {
            let at = base + (side << axis);
            let ring = [at, at + u, at + u + v, at + v];
            let normal = DVec3::AXES[axis] * if side == 1 { 1.0 } else { -1.0 };
            let ring = if side == 1 { ring } else { [ring[3], ring[2], ring[1], ring[0]] };
            push_quad(mesh, ring, rotation * normal, material);
        }
    }
}

/// A cube of side 4 around the origin with a square hole of side 2 through it along z: genus 1.
#[must_use]
pub fn cube_with_hole() -> Mesh {
    let mut mesh = Mesh::default();
    for half in [2.0, 1.0] {
        for z in [-2.0, 2.0] {
            let corners = [(-half, -half), (half, -half), (half, half), (-half, half)];
            mesh.positions.extend(corners.map(|(x, y)| DVec3::new(x, y, z)));
        }
    }
    let (outer_low, outer_high, inner_low, inner_high) = (0, 4, 8, 12);
    for i in 0..4 {
        let j = (i + 1) % 4;
        let outward = [DVec3::NEG_Y, DVec3::X, DVec3::Y, DVec3::NEG_X][i as usize];
        push_quad(&mut mesh, [outer_low + i, outer_low + j, outer_high + j, outer_high + i], outward, "outside");
        push_quad(&mut mesh, [inner_low + j, inner_low + i, inner_high + i, inner_high + j], -outward, "hole");
    }
    let (top, bottom) = (push_face(&mut mesh, DVec3::Z, "outside"), push_face(&mut mesh, DVec3::NEG_Z, "outside"));
    for (face, outer, inner) in [(top, outer_high, inner_high), (bottom, outer_low, inner_low)] {
        for i in 0..4 {
            let j = (i + 1) % 4;
            for [a, b, c] in [[outer + i, outer + j, inner + j], [outer + i, inner + j, inner + i]] {
                mesh.triangles.push(if face == top { [a, b, c] } else { [a, c, b] });
                mesh.triangle_faces.push(face);
            }
        }
    }
    mesh
}

/// `count` closed boxes of random place, size, rotation and material over a square, reproducible from `seed`.
#[must_use]
pub fn random_boxes(count: usize, seed: u64) -> Mesh {
    let mut random = Rng::new(seed);
    let mut mesh = Mesh::default();
    let side = (count as f64).sqrt() * 1.5;
    for _ in 0..count {
        let half = DVec3::new(random.float(0.2, 1.6), random.float(0.2, 1.6), random.float(0.2, 3.0));
        let center = DVec3::new(random.float(0.0, side), random.float(0.0, side), half.z);
        let turned = random.float(0.0, 1.0) < 0.3;
        let rotation = if turned { DMat3::from_rotation_z(random.float(0.0, 1.5)) } else { DMat3::IDENTITY };
        let material = format!("material{}", random.float(0.0, 8.0) as u32);
        push_box(&mut mesh, center, half, rotation, &material);
    }
    mesh
}

fn push_quad(mesh: &mut Mesh, [a, b, c, d]: [u32; 4], normal: DVec3, material: &str) {
    let face = push_face(mesh, normal, material);
    mesh.triangles.extend([[a, b, c], [a, c, d]]);
    mesh.triangle_faces.extend([face, face]);
}

fn push_face(mesh: &mut Mesh, normal: DVec3, material: &str) -> u32 {
    let known = mesh.materials.iter().position(|m| m.name == material);
    let material = known.unwrap_or_else(|| {
        mesh.materials.push(Material::named(material));
        mesh.materials.len() - 1
    });
    mesh.faces.push(MeshFace { normal, material: MaterialId(material as u32) });
    mesh.faces.len() as u32 - 1
}
