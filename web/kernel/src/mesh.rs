//! Meshes.

use std::sync::Arc;

use planecut::check::{CheckOptions, check_mesh, check_topology};
use planecut::csg::{self, Material};
use planecut::export::{ExportOptions, Format, encode};
use planecut::expression::Evaluated;
use planecut::kernel::DVec3;
use planecut::triangles::Triangles;
use wasm_bindgen::prelude::*;

use crate::arguments::{material, numbers_below, points, settings, transform, triangles};
use crate::failure::{Failure, Outcome};

/// Triangles with vertices, faces and materials.
#[wasm_bindgen]
pub struct Mesh {
    data: Data,
}

enum Data {
    /// The boundary of a solid, which the solid has, too.
    Evaluated(Arc<Evaluated>),
    Own(Box<csg::Mesh>),
}

impl Mesh {
    pub(crate) fn of_evaluated(evaluated: Arc<Evaluated>) -> Self {
        Self { data: Data::Evaluated(evaluated) }
    }

    pub(crate) fn of_core(mesh: csg::Mesh) -> Self {
        Self { data: Data::Own(Box::new(mesh)) }
    }

    pub(crate) fn core(&self) -> &csg::Mesh {
        match &self.data {
            Data::Evaluated(evaluated) => &evaluated.evaluation.mesh,
            Data::Own(mesh) => mesh,
        }
    }

    pub(crate) fn triangles_of(&self) -> Triangles {
        Triangles::of_mesh(self.core())
    }

    pub(crate) fn encoded(&self, format: &str, options: &str) -> Outcome<Vec<u8>> {
        let options: ExportOptions = settings(options)?;
        let format = Format::from_extension(format).map_err(Failure::of)?;
        encode(self.core(), format, &options).map_err(Failure::of)
    }
}

#[wasm_bindgen]
impl Mesh {
    /// A mesh of coordinates, numbers of vertices, names of materials and, for more than one of these, the number of each triangle's.
    ///
    /// # Errors
    /// A `PlanecutError` for numbers that stand for nothing.
    #[wasm_bindgen(constructor)]
    pub fn new(positions: &[f64], corners: &[u32], names: Vec<String>, material_ids: &[u32]) -> Result<Self, JsValue> {
        let positions = points(positions, "positions")?;
        let triangles = triangles(corners, positions.len(), "triangles")?;
        numbers_below(material_ids, names.len(), "materialIds")?;
        let is_complete = material_ids.len() == triangles.len() || material_ids.is_empty() && names.len() == 1;
        if !is_complete {
            let (found, expected) = (material_ids.len(), triangles.len());
            return Err(Failure::of(format!("materialIds: found {found} numbers, expected {expected}")).into());
        }
        let materials = names.into_iter().map(|name| material(Some(name))).collect();
        let given = Triangles { positions, triangles, materials, material_ids: material_ids.to_vec() };
        Ok(Self::of_core(given.into_mesh()))
    }

    /// x, y and z of each vertex.
    #[must_use]
    pub fn positions(&self) -> Vec<f64> {
        self.core().positions.iter().flat_map(DVec3::to_array).collect()
    }

    /// Three numbers of vertices of each triangle, counter-clockwise seen from outside.
    #[must_use]
    pub fn triangles(&self) -> Vec<u32> {
        self.core().triangles.as_flattened().to_vec()
    }

    /// The number of the face that each triangle belongs to.
    #[wasm_bindgen(js_name = faceIds)]
    #[must_use]
    pub fn face_ids(&self) -> Vec<u32> {
        self.core().triangle_faces.clone()
    }

    /// The unit outward normal of each face.
    #[wasm_bindgen(js_name = faceNormals)]
    #[must_use]
    pub fn face_normals(&self) -> Vec<f64> {
        self.core().faces.iter().flat_map(|face| face.normal.to_array()).collect()
    }

    /// The number of each triangle's material.
    #[wasm_bindgen(js_name = materialIds)]
    #[must_use]
    pub fn material_ids(&self) -> Vec<u32> {
        let mesh = self.core();
        mesh.triangle_faces.iter().map(|face| mesh.faces[*face as usize].material.0).collect()
    }

    /// The names of the materials.
    #[must_use]
    pub fn materials(&self) -> Vec<String> {
        self.core().materials.iter().map(|material| material.name.clone()).collect()
    }

    /// The colours of the materials, linear red, green and blue; NaN for those that have none of their own.
    #[wasm_bindgen(js_name = materialColors)]
    #[must_use]
    pub fn material_colors(&self) -> Vec<f64> {
        let color = |material: &Material| material.color.map_or([f64::NAN; 3], |color| color.map(f64::from));
        self.core().materials.iter().flat_map(color).collect()
    }

    /// Whether it is a closed, oriented 2-manifold.
    #[wasm_bindgen(js_name = isWatertight)]
    #[must_use]
    pub fn is_watertight(&self) -> bool {
        check_topology(&self.core().positions, &self.core().triangles).manifold
    }

    /// The signed volume by the divergence theorem.
    #[must_use]
    pub fn volume(&self) -> f64 {
        check_topology(&self.core().positions, &self.core().triangles).measures.volume
    }

    /// The area of all triangles.
    #[must_use]
    pub fn area(&self) -> f64 {
        let mesh = self.core();
        let area = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|corner| mesh.positions[corner as usize]);
            0.5 * (b - a).cross(c - a).length()
        };
        mesh.triangles.iter().map(area).sum()
    }

    /// The least and then the greatest coordinates of the vertices, NaN where there are none.
    #[must_use]
    pub fn bounds(&self) -> Vec<f64> {
        let positions = &self.core().positions;
        let low = positions.iter().copied().reduce(DVec3::min).unwrap_or(DVec3::NAN);
        let high = positions.iter().copied().reduce(DVec3::max).unwrap_or(DVec3::NAN);
        [low, high].iter().flat_map(DVec3::to_array).collect()
    }

    /// What is wrong with the mesh, of each kind of problem the first; nothing where it is sound.
    ///
    /// # Errors
    /// A `PlanecutError` for a tolerance below 0.
    pub fn check(&self, tolerance: f64) -> Result<Vec<String>, JsValue> {
        if tolerance.is_nan() || tolerance < 0.0 {
            return Err(
                Failure::of(format!("tolerance: found {tolerance}, expected a number that is not negative")).into()
            );
        }
        let mesh = self.core();
        let report = check_mesh(&mesh.positions, &mesh.triangles, &CheckOptions { tolerance, crossings: true });
        let crossing = report.crossings.and_then(|crossings| crossings.first).map(|contact| contact.to_string());
        Ok(report.topology.first_defect.map(|defect| defect.to_string()).into_iter().chain(crossing).collect())
    }

    /// The mesh moved by an affine map; triangles are turned round where it mirrors.
    ///
    /// # Errors
    /// A `PlanecutError` for a matrix that is singular or not affine.
    pub fn transform(&self, matrix: &[f64]) -> Result<Self, JsValue> {
        let transform = transform(matrix, "matrix")?;
        let mut mesh = self.core().clone();
        mesh.positions.iter_mut().for_each(|position| *position = transform.point(*position));
        if mesh.positions.iter().any(|position| !position.is_finite()) {
            let message = "matrix: found one that moves a vertex beyond the range of doubles, expected another";
            return Err(Failure::of(message).into());
        }
        mesh.faces.iter_mut().for_each(|face| face.normal = transform.gradient(face.normal).normalize_or_zero());
        if transform.linear().determinant() < 0.0 {
            mesh.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        }
        Ok(Self::of_core(mesh))
    }

    /// The mesh as a file of a format, by the ending of such files. `options` are those of the export library, as JSON.
    ///
    /// # Errors
    /// A `PlanecutError` for a format or options that there are not.
    pub fn encode(&self, format: &str, options: &str) -> Result<Vec<u8>, JsValue> {
        Ok(self.encoded(format, options)?)
    }
}
