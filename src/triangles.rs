//! Triangles that a program gives, as a reader of files would give them.

use planecut_csg::{Material, MaterialId, Mesh, MeshFace, Model};
use planecut_import::mesh::{
    IndexedMesh, MeshFormat, MeshImport, MeshObject, Precision, SolidError, SolidOptions, solid_of_mesh,
};
use planecut_kernel::DVec3;

/// What errors call triangles that are of no file.
const NAME: &str = "mesh";

/// Triangles with materials.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Triangles {
    /// The places of vertices.
    pub positions: Vec<DVec3>,
    /// The vertices of each triangle, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// The materials.
    pub materials: Vec<Material>,
    /// Of each triangle its number among the materials; empty where all are of the first one.
    pub material_ids: Vec<u32>,
}

impl Triangles {
    /// Those of a mesh of ours.
    #[must_use]
    pub fn of_mesh(mesh: &Mesh) -> Self {
        let material = |face: &u32| mesh.faces[*face as usize].material.0;
        Self {
            positions: mesh.positions.clone(),
            triangles: mesh.triangles.clone(),
            materials: mesh.materials.clone(),
            material_ids: mesh.triangle_faces.iter().map(material).collect(),
        }
    }

    /// As a mesh of ours, in which each triangle is a face.
    ///
    /// # Panics
    /// If a triangle has a number of no vertex.
    #[must_use]
    pub fn into_mesh(self) -> Mesh {
        let Self { positions, triangles, materials, material_ids } = self;
        let face = |(number, corners): (usize, &[u32; 3])| {
            let [a, b, c] = corners.map(|corner| positions[corner as usize]);
            let material = MaterialId(material_ids.get(number).copied().unwrap_or(0));
            MeshFace { normal: (b - a).cross(c - a).normalize_or_zero(), material }
        };
        let faces = triangles.iter().enumerate().map(face).collect();
        Mesh { triangle_faces: (0..triangles.len() as u32).collect(), faces, positions, triangles, materials }
    }

    /// As a reader of files gives them.
    #[must_use]
    pub fn indexed(self) -> IndexedMesh {
        let Self { positions, triangles, materials, material_ids } = self;
        let material_of = if material_ids.is_empty() {
            vec![Some(0); triangles.len()]
        } else {
            material_ids.into_iter().map(Some).collect()
        };
        let precision = Precision::of_coordinates(&positions);
        let objects = vec![MeshObject { name: None, triangles: 0..triangles.len() }];
        let (colors, textures, places) = (Vec::new(), Vec::new(), Vec::new());
        IndexedMesh { positions, triangles, objects, precision, materials, material_of, colors, textures, places }
    }

    /// The solid that they bound.
    ///
    /// ```
    /// use planecut::csg::{Material, evaluate};
    /// use planecut::import::mesh::SolidOptions;
    /// use planecut::kernel::DVec3;
    /// use planecut::triangles::Triangles;
    ///
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    /// let triangles = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    /// let tetrahedron = Triangles { positions, triangles, materials: vec![Material::named("oak")], ..Triangles::default() };
    /// let solid = tetrahedron.solid(&SolidOptions::default())?;
    /// assert_eq!(evaluate(&solid.model)?.solid.volume, 1.0 / 6.0);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// [`SolidError`] where they bound none; [`said_of_surface`] says it without the name of a file.
    pub fn solid(self, options: &SolidOptions) -> Result<MeshImport, SolidError> {
        if self.triangles.is_empty() {
            return Ok(MeshImport { model: Model::default(), warnings: Vec::new() });
        }
        solid_of_mesh(self.indexed(), MeshFormat::Obj, NAME, options)
    }
}

/// The boundary of a solid as a closed mesh: one body.
///
/// # Errors
/// [`SolidError`], as for a mesh that is not closed.
pub fn one_body(mesh: &Mesh) -> Result<Model, SolidError> {
    Ok(Triangles::of_mesh(mesh).solid(&SolidOptions::default())?.model)
}

/// What is wrong with triangles that are of no file.
#[must_use]
pub fn said_of_surface(error: &SolidError) -> String {
    match error {
        SolidError::Surface { source, .. } => source.to_string(),
        other => other.to_string(),
    }
}
