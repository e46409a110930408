//! The faces that a brush really has.

use glam::DVec3;
use planecut_csg::{Brush, MaterialId};
use planecut_kernel::{HalfSpace, IncrementalPolytope};

use crate::ExportError;

/// Largest coordinate that is written: within it, products of coordinates stay far inside the range of `f64`, and those who
/// read the file can square them in peace.
const MAX_COORDINATE: f64 = 1e30;

/// A body thinner than this share of its largest coordinate, four roundings of that, is left out: its corners, rounded, may
/// span nothing or any other body as thin.
const LEAST_THICKNESS: f64 = 4.0 * f64::EPSILON;

/// A bounded convex body with interior.
pub(super) struct Body {
    /// In the order of the brush.
    pub(super) faces: Vec<BodyFace>,
    /// The length of the diagonal of its box.
    pub(super) size: f64,
    /// Its largest coordinate, by magnitude.
    pub(super) reach: f64,
}

/// A face with an area.
pub(super) struct BodyFace {
    /// The outward normal, of any length.
    pub(super) normal: DVec3,
    /// The plane is `normal · x = offset`, scaled.
    pub(super) offset: f64,
    pub(super) material: MaterialId,
    /// Counter-clockwise seen from outside, each coordinate the nearest `f64`; two may be the same where the exact ones are not.
    pub(super) corners: Vec<DVec3>,
}

impl Body {
    /// The body of a brush, scaled; `None` where it has no interior, or none but for rounding.
    pub(super) fn of(number: usize, brush: &Brush, materials: usize, scale: f64) -> Result<Option<Self>, ExportError> {
        if brush.is_mesh() {
            return Err(ExportError::MeshBrush { brush: number });
        }
        // Without a tolerance: an edge is left out where its length is exactly zero, and nowhere else.
        let mut polytope = IncrementalPolytope::with_epsilon(0.0);
        for face in &brush.faces {
            polytope.add_plane(face.half_space);
        }
        if polytope.is_empty() {
            return Ok(None);
        }
        if !polytope.is_bounded() {
            return Err(ExportError::Unbounded { brush: number });
        }
        let mut faces = Vec::new();
        let mut widest: f64 = 0.0;
        for ((plane, half_space), face) in polytope.planes().zip(&brush.faces) {
            let Some(polygon) = polytope.face_polygon(plane) else { continue };
            let MaterialId(material) = face.material;
            if material as usize >= materials {
                return Err(ExportError::UnknownMaterial { brush: number, material, count: materials });
            }
            faces.push(BodyFace::new(half_space, face.material, polygon.corners, scale));
            widest = widest.max(polytope.face_area(plane).unwrap_or(0.0));
        }
        let all = || faces.iter().flat_map(|face| &face.corners);
        let far =
            all().flat_map(|corner| corner.to_array()).find(|value| value.is_nan() || value.abs() > MAX_COORDINATE);
        if let Some(value) = far {
            return Err(ExportError::BrushRange { brush: number, value });
        }
        let (min, max) = all().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), p| (min.min(*p), max.max(*p)));
        let reach = min.abs().max(max.abs()).max_element();
        let size = (max - min).length();
        // a cone on the widest face would have this height, and no body with that face and volume is as thick
        let thickness = 3.0 * polytope.measures().map_or(0.0, |measures| measures.volume) / widest * scale;
        Ok((thickness > LEAST_THICKNESS * reach).then_some(Self { faces, size, reach }))
    }

    /// The material of most of its surface; of several the one with the lowest number.
    pub(super) fn material(&self) -> MaterialId {
        let mut shares: Vec<(MaterialId, f64)> = Vec::new();
        for face in &self.faces {
            match shares.iter_mut().find(|(material, _)| *material == face.material) {
                Some((_, share)) => *share += face.area(),
                None => shares.push((face.material, face.area())),
            }
        }
        shares.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        shares[0].0
    }
}

impl BodyFace {
    fn new(half_space: &HalfSpace, material: MaterialId, mut corners: Vec<DVec3>, scale: f64) -> Self {
        corners.iter_mut().for_each(|corner| *corner *= scale);
        Self { normal: half_space.normal(), offset: half_space.offset() * scale, material, corners }
    }

    fn area(&self) -> f64 {
        let base = self.corners[0];
        let twice: DVec3 = self.corners.windows(2).map(|pair| (pair[0] - base).cross(pair[1] - base)).sum();
        0.5 * twice.length()
    }
}
