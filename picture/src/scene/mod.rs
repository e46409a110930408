//! The model as the camera sees it, computed once for all later steps.

mod lights;
pub(crate) mod look;

use glam::{DVec3, Vec3};

use self::lights::Lights;
use self::look::{Fill, Look};
use crate::input::mesh::{Face, PaintedMesh};
use crate::raster::Triangles;
use crate::view::camera::Camera;
use crate::view::lens::ScreenPoint;

/// Model, camera and light in view coordinates.
pub(crate) struct Scene<'a> {
    pub(crate) mesh: &'a PaintedMesh<'a>,
    pub(crate) camera: Camera,
    pub(crate) look: Look,
    /// Vertices in view coordinates.
    pub(crate) view: Vec<Vec3>,
    /// Vertices on the picture, in pixels.
    pub(crate) screen: Vec<ScreenPoint>,
    /// Unit face normals in view coordinates.
    pub(crate) normals: Vec<Vec3>,
    /// Light that each face gives off.
    pub(crate) shades: Vec<Shade>,
    /// Unit direction to the key light, in view coordinates.
    pub(crate) light: Vec3,
    /// The floor under the model, where the camera looks down on it.
    pub(crate) floor: Option<Floor>,
}

/// Colour of a face in each kind of light, linear RGB.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Shade {
    /// From all around; crevices lose it.
    pub(crate) ambient: Vec3,
    /// From the key light; shadows lose it.
    pub(crate) direct: Vec3,
}

/// A horizontal plane in view coordinates.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Floor {
    /// Unit normal, up.
    pub(crate) normal: Vec3,
    /// The point under the middle of the model.
    pub(crate) center: Vec3,
}

impl<'a> Scene<'a> {
    pub(crate) fn new(mesh: &'a PaintedMesh<'_>, camera: Camera, look: Look) -> Self {
        let in_view: Vec<DVec3> = mesh.positions.iter().map(|&p| camera.to_view(p)).collect();
        let screen = in_view.iter().map(|&p| camera.lens.project(p)).collect();
        let to_view = |direction: DVec3| camera.direction_to_view(direction).normalize().as_vec3();
        let normals: Vec<Vec3> = mesh.faces.iter().map(|face| to_view(DVec3::from(face.normal))).collect();
        let up = to_view(DVec3::Z);
        let lights = Lights::new(up);
        let shade = |(face, &normal): (&Face, &Vec3)| {
            let paint = mesh.paints[face.paint as usize];
            // Both sides of what is seen through are lit as if they faced the eye.
            let normal = if look.fill == Fill::Translucent && normal.z > 0.0 { -normal } else { normal };
            let color = look.tinted(paint.tint);
            // Where a body is cut, its inside is paler than its skin.
            let color = if paint.hatching.is_some() { color.lerp(look.clay, 0.35) } else { color };
            lights.shade(&look, color, normal)
        };
        let shades = mesh.faces.iter().zip(&normals).map(shade).collect();
        let view: Vec<Vec3> = in_view.iter().map(|p| p.as_vec3()).collect();
        let floor = (look.floor > 0.0).then(|| floor_under(&view, up, &camera)).flatten();
        Self { mesh, camera, view, screen, normals, shades, light: lights.key, floor, look }
    }

    /// The mesh on a picture of `size` samples, with its vertices at `points` of it.
    pub(crate) fn triangles<'b>(&'b self, size: [usize; 2], points: &'b [ScreenPoint]) -> Triangles<'b> {
        Triangles { size, points, corners: &self.mesh.triangles, faces: &self.mesh.triangle_faces }
    }

    /// The number of a face's hatching, where it has one.
    pub(crate) fn hatch(&self, face: u32) -> Option<u32> {
        let face = self.mesh.faces.get(face as usize)?;
        self.mesh.paints[face.paint as usize].hatching
    }
}

fn floor_under(view: &[Vec3], up: Vec3, camera: &Camera) -> Option<Floor> {
    let lowest = view.iter().map(|p| p.dot(up)).fold(f32::INFINITY, f32::min);
    let (min, max) = view.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(l, h), &p| (l.min(p), h.max(p)));
    let middle = (min + max) * 0.5;
    let center = middle + up * (lowest - middle.dot(up));
    // A floor above the eye would be seen from below.
    (camera.lens.sight(center).dot(up) < 0.0).then_some(Floor { normal: up, center })
}
