//! The model as the camera sees it, computed once for all later steps.

use glam::{DVec3, Vec3};
use planecut_csg::Mesh;

use super::camera::{Camera, ScreenPoint};
use super::raster::Triangles;
use super::style::Look;
use crate::color::material_color;

/// Model, camera and light in view coordinates.
pub(super) struct Scene<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) camera: Camera,
    pub(super) look: Look,
    /// Vertices in view coordinates.
    pub(super) view: Vec<Vec3>,
    /// Vertices on the picture, in pixels.
    pub(super) screen: Vec<ScreenPoint>,
    /// Unit face normals in view coordinates.
    pub(super) normals: Vec<Vec3>,
    /// Light that each face gives off.
    pub(super) shades: Vec<Shade>,
    /// Unit direction to the key light, in view coordinates.
    pub(super) light: Vec3,
    /// The floor under the model, where the camera looks down on it.
    pub(super) floor: Option<Floor>,
}

/// Colour of a face in each kind of light, linear RGB.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Shade {
    /// From all around; crevices lose it.
    pub(super) ambient: Vec3,
    /// From the key light; shadows lose it.
    pub(super) direct: Vec3,
}

/// A horizontal plane in view coordinates.
#[derive(Debug, Clone, Copy)]
pub(super) struct Floor {
    /// Unit normal, up.
    pub(super) normal: Vec3,
    /// The point under the middle of the model.
    pub(super) center: Vec3,
}

impl<'a> Scene<'a> {
    pub(super) fn new(mesh: &'a Mesh, camera: Camera, look: Look) -> Self {
        let in_view: Vec<DVec3> = mesh.positions.iter().map(|&p| camera.to_view(p)).collect();
        let screen = in_view.iter().map(|&p| camera.project(p)).collect();
        let to_view = |direction: DVec3| camera.direction_to_view(direction).normalize().as_vec3();
        let normals: Vec<Vec3> = mesh.faces.iter().map(|face| to_view(face.normal)).collect();
        let up = to_view(DVec3::Z);
        let light = key_light(up);
        let shades = mesh
            .faces
            .iter()
            .zip(&normals)
            .map(|(face, &normal)| {
                let material = &mesh.materials[face.material.0 as usize];
                let tint = if material.color.is_some() { look.stated_tint } else { look.tint };
                let color = look.clay.lerp(Vec3::from(material_color(material)), tint);
                shade(&look, color, normal, up, light)
            })
            .collect();
        let view: Vec<Vec3> = in_view.iter().map(|p| p.as_vec3()).collect();
        let floor = (look.floor > 0.0).then(|| floor_under(&view, up)).flatten();
        Self { mesh, camera, look, view, screen, normals, shades, light, floor }
    }

    /// The mesh on a picture of `size` samples, with its vertices at `points` of it.
    pub(super) fn triangles<'b>(&'b self, size: [usize; 2], points: &'b [ScreenPoint]) -> Triangles<'b> {
        Triangles { size, points, corners: &self.mesh.triangles, faces: &self.mesh.triangle_faces }
    }
}

/// The key light stands behind the camera's left shoulder, high up, whatever side the model is seen from.
fn key_light(up: Vec3) -> Vec3 {
    let towards_eye = Vec3::NEG_Z;
    let horizontal = towards_eye - up * towards_eye.dot(up);
    (up * 1.0 + Vec3::NEG_X * 0.62 + horizontal.normalize_or_zero() * 0.42).normalize()
}

fn shade(look: &Look, color: Vec3, normal: Vec3, up: Vec3, light: Vec3) -> Shade {
    let sky_part = 0.5 + 0.5 * normal.dot(up);
    // The fill light comes from the right, where the key light does not reach.
    let fill_part = 0.5 + 0.5 * normal.dot(Vec3::X);
    let ambient = look.bounce.lerp(look.sky, sky_part) + look.fill * fill_part;
    let direct = look.key * normal.dot(light).max(0.0);
    Shade { ambient: color * ambient, direct: color * direct }
}

fn floor_under(view: &[Vec3], up: Vec3) -> Option<Floor> {
    let lowest = view.iter().map(|p| p.dot(up)).fold(f32::INFINITY, f32::min);
    // The eye is the origin: a floor above it would be seen from below.
    if lowest >= 0.0 {
        return None;
    }
    let (min, max) = view.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(l, h), &p| (l.min(p), h.max(p)));
    let middle = (min + max) * 0.5;
    Some(Floor { normal: up, center: middle + up * (lowest - middle.dot(up)) })
}
