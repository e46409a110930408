//! Triangles of a tile: what children are joined to, simplified, and written as.

use std::fs::File;
use std::io::{self, BufReader, BufWriter, Read, Write};
use std::path::Path;

use planecut_csg::{Material, MaterialId, Mesh, MeshFace};
use planecut_kernel::DVec3;
use rustc_hash::FxHashMap;

/// Triangles whose vertices are told apart by their positions, with the numbers of their materials among those of all blocks.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Surface {
    pub(super) positions: Vec<DVec3>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) materials: Vec<u32>,
}

/// Numbers of positions; equal ones have one.
#[derive(Debug, Default)]
pub(super) struct Numbers {
    known: FxHashMap<[u64; 3], u32>,
}

impl Numbers {
    /// The number of a position, which is added to the list where it is new.
    pub(super) fn of(&mut self, position: DVec3, positions: &mut Vec<DVec3>) -> u32 {
        // adding zero makes 0 of -0
        let position = position + 0.0;
        *self.known.entry(position.to_array().map(f64::to_bits)).or_insert_with(|| {
            positions.push(position);
            (positions.len() - 1) as u32
        })
    }
}

impl Surface {
    /// The triangles of a mesh; `numbers` are those of its materials.
    pub(super) fn of_mesh(mesh: &Mesh, numbers: &[u32]) -> Self {
        let mut surface = Self::default();
        let mut known = Numbers::default();
        let vertices: Vec<u32> = mesh.positions.iter().map(|at| known.of(*at, &mut surface.positions)).collect();
        surface.triangles =
            mesh.triangles.iter().map(|corners| corners.map(|corner| vertices[corner as usize])).collect();
        let material = |face: &u32| numbers[mesh.faces[*face as usize].material.0 as usize];
        surface.materials = mesh.triangle_faces.iter().map(material).collect();
        surface
    }

    /// All triangles of several.
    pub(super) fn joined(parts: Vec<Self>) -> Self {
        let mut joined = Self::default();
        let mut known = Numbers::default();
        for part in parts {
            let vertices: Vec<u32> = part.positions.iter().map(|at| known.of(*at, &mut joined.positions)).collect();
            joined
                .triangles
                .extend(part.triangles.iter().map(|corners| corners.map(|corner| vertices[corner as usize])));
            joined.materials.extend(part.materials);
        }
        joined
    }

    /// The positions of a triangle's corners.
    pub(super) fn corners(&self, triangle: [u32; 3]) -> [DVec3; 3] {
        triangle.map(|corner| self.positions[corner as usize])
    }

    /// The edges of the boundary of all triangles as a chain, whichever way they go: both ends, the lesser number first.
    pub(super) fn open_edges(&self) -> Vec<[u32; 2]> {
        let mut edges: Vec<([u32; 2], i32)> = Vec::with_capacity(3 * self.triangles.len());
        for [a, b, c] in &self.triangles {
            for (from, to) in [(*a, *b), (*b, *c), (*c, *a)] {
                edges.push(if from < to { ([from, to], 1) } else { ([to, from], -1) });
            }
        }
        edges.sort_unstable();
        let same = edges.chunk_by(|a, b| a.0 == b.0);
        let open =
            same.filter(|same| same[0].0[0] != same[0].0[1] && same.iter().map(|(_, way)| way).sum::<i32>() != 0);
        open.map(|same| same[0].0).collect()
    }

    /// As a mesh to be written, with the materials that it uses. Triangles of one normal and material are one face.
    pub(super) fn into_mesh(self, materials: &[Material]) -> Mesh {
        let mut used = self.materials.clone();
        used.sort_unstable();
        used.dedup();
        let normal = |triangle: usize| {
            let [a, b, c] = self.corners(self.triangles[triangle]);
            // triangles without area have no normal, and are not seen
            (b - a).cross(c - a).try_normalize().unwrap_or(DVec3::Z)
        };
        let key = |triangle: usize| (self.materials[triangle], normal(triangle).as_vec3().to_array().map(f32::to_bits));
        let mut order: Vec<((u32, [u32; 3]), usize)> =
            (0..self.triangles.len()).map(|triangle| (key(triangle), triangle)).collect();
        order.sort_unstable();
        let mut mesh = Mesh {
            materials: used.iter().map(|number| materials[*number as usize].clone()).collect(),
            ..Mesh::default()
        };
        for face in order.chunk_by(|a, b| a.0 == b.0) {
            let place = used.partition_point(|number| *number < face[0].0.0);
            mesh.faces.push(MeshFace { normal: normal(face[0].1), material: MaterialId(place as u32) });
            let number = mesh.faces.len() as u32 - 1;
            for (_, triangle) in face {
                mesh.triangles.push(self.triangles[*triangle]);
                mesh.triangle_faces.push(number);
            }
        }
        mesh.positions = self.positions;
        mesh
    }

    /// Writes it to a temporary file, little-endian.
    pub(super) fn save(&self, path: &Path) -> io::Result<()> {
        let mut out = BufWriter::new(File::create(path)?);
        for count in [self.positions.len(), self.triangles.len()] {
            out.write_all(&(count as u64).to_le_bytes())?;
        }
        for value in self.positions.iter().flat_map(|at| at.to_array()) {
            out.write_all(&value.to_le_bytes())?;
        }
        for value in self.triangles.iter().flatten().chain(&self.materials) {
            out.write_all(&value.to_le_bytes())?;
        }
        out.flush()
    }

    /// Reads what was saved.
    pub(super) fn load(path: &Path) -> io::Result<Self> {
        let mut input = BufReader::new(File::open(path)?);
        let [positions, triangles] = [u64::from_le_bytes(eight(&mut input)?), u64::from_le_bytes(eight(&mut input)?)];
        let mut at = || Ok(DVec3::new(float(&mut input)?, float(&mut input)?, float(&mut input)?));
        let positions = (0..positions).map(|_| at()).collect::<io::Result<_>>()?;
        let mut three = || Ok([number(&mut input)?, number(&mut input)?, number(&mut input)?]);
        let triangles: Vec<[u32; 3]> = (0..triangles).map(|_| three()).collect::<io::Result<_>>()?;
        let materials = triangles.iter().map(|_| number(&mut input)).collect::<io::Result<_>>()?;
        Ok(Self { positions, triangles, materials })
    }
}

fn eight(input: &mut impl Read) -> io::Result<[u8; 8]> {
    let mut bytes = [0; 8];
    input.read_exact(&mut bytes)?;
    Ok(bytes)
}

fn float(input: &mut impl Read) -> io::Result<f64> {
    eight(input).map(f64::from_le_bytes)
}

fn number(input: &mut impl Read) -> io::Result<u32> {
    let mut bytes = [0; 4];
    input.read_exact(&mut bytes)?;
    Ok(u32::from_le_bytes(bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn two_triangles() -> Surface {
        let positions = vec![DVec3::ZERO, DVec3::X, DVec3::ONE, DVec3::Y];
        Surface { positions, triangles: vec![[0, 1, 2], [0, 2, 3]], materials: vec![5, 2] }
    }

    #[test]
    fn the_boundary_of_two_triangles_is_the_edges_of_one_each() {
        let surface = two_triangles();
        assert_eq!(surface.open_edges(), [[0, 1], [0, 3], [1, 2], [2, 3]]);
        let turned = Surface { triangles: vec![[0, 1, 2], [0, 3, 2]], ..surface };
        assert_eq!(turned.open_edges().len(), 5);
    }

    #[test]
    fn parts_meet_in_equal_positions() {
        let part = |triangle: [DVec3; 3]| Surface {
            positions: triangle.to_vec(),
            triangles: vec![[0, 1, 2]],
            materials: vec![0],
        };
        let joined = Surface::joined(vec![
            part([DVec3::ZERO, DVec3::X, DVec3::Y]),
            part([DVec3::X, DVec3::new(-0.0, 0.0, -0.0), -DVec3::Y]),
        ]);
        assert_eq!((joined.positions.len(), joined.open_edges().len()), (4, 4));
    }

    #[test]
    fn what_is_saved_is_read_again() {
        let folder = tempfile::tempdir().expect("folder");
        let path = folder.path().join("tile");
        two_triangles().save(&path).expect("saved");
        assert_eq!(Surface::load(&path).expect("read"), two_triangles());
        std::fs::write(&path, [1; 20]).expect("written");
        assert!(Surface::load(&path).is_err());
    }

    #[test]
    fn a_mesh_has_the_materials_that_are_used() {
        let materials: Vec<Material> = ["a", "b", "c", "d", "e", "f"].map(Material::named).to_vec();
        let mesh = two_triangles().into_mesh(&materials);
        assert_eq!(mesh.materials.iter().map(|material| material.name.as_str()).collect::<Vec<_>>(), ["c", "f"]);
        assert_eq!((mesh.faces.len(), mesh.triangles.as_slice()), (2, &[[0, 2, 3], [0, 1, 2]][..]));
    }
}
