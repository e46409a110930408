//! The model as the camera sees it, computed once for all later steps.

use glam::{DVec3, Vec3};
use planecut_csg::{Cutaway, Material, Mesh};

use crate::material::material_color;
use crate::preview::camera::Camera;
use crate::preview::lens::ScreenPoint;
use crate::preview::raster::Triangles;
use crate::preview::style::{Fill, Look};
use crate::preview::subject::Subject;

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
    /// For each material a number where its faces are hatched: materials of different numbers are told apart.
    pub(super) hatches: Vec<Option<u32>>,
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
    pub(super) fn new(subject: &'a Subject<'_>, camera: Camera, look: Look) -> Self {
        let mesh: &Mesh = subject.as_mesh();
        let in_view: Vec<DVec3> = mesh.positions.iter().map(|&p| camera.to_view(p)).collect();
        let screen = in_view.iter().map(|&p| camera.lens.project(p)).collect();
        let to_view = |direction: DVec3| camera.direction_to_view(direction).normalize().as_vec3();
        let normals: Vec<Vec3> = mesh.faces.iter().map(|face| to_view(face.normal)).collect();
        let up = to_view(DVec3::Z);
        let lights = Lights::new(up);
        let hatches = subject.hatches();
        let colors: Vec<Vec3> = mesh
            .materials
            .iter()
            .map(|material| {
                let tint = if material.color.is_some() { look.stated_tint } else { look.tint };
                // A cut looks like what was cut.
                match material.name.strip_suffix(Cutaway::SUFFIX).map(str::trim_end) {
                    Some("") => look.clay,
                    Some(name) => {
                        let whole = Material { name: name.to_owned(), ..material.clone() };
                        look.clay.lerp(Vec3::from(material_color(&whole)), tint)
                    }
                    None => look.clay.lerp(Vec3::from(material_color(material)), tint),
                }
            })
            .collect();
        let shade = |(face, &normal): (&planecut_csg::MeshFace, &Vec3)| {
            let material = face.material.0 as usize;
            // Both sides of what is seen through are lit as if they faced the eye.
            let normal = if look.fill == Fill::Translucent && normal.z > 0.0 { -normal } else { normal };
            // Where a body is cut, its inside is paler than its skin.
            let color =
                if hatches[material].is_some() { colors[material].lerp(look.clay, 0.35) } else { colors[material] };
            lights.shade(&look, color, normal)
        };
        let shades = mesh.faces.iter().zip(&normals).map(shade).collect();
        let view: Vec<Vec3> = in_view.iter().map(|p| p.as_vec3()).collect();
        let floor = (look.floor > 0.0).then(|| floor_under(&view, up, &camera)).flatten();
        Self { mesh, camera, view, screen, normals, shades, hatches, light: lights.key, floor, look }
    }

    /// The mesh on a picture of `size` samples, with its vertices at `points` of it.
    pub(super) fn triangles<'b>(&'b self, size: [usize; 2], points: &'b [ScreenPoint]) -> Triangles<'b> {
        Triangles { size, points, corners: &self.mesh.triangles, faces: &self.mesh.triangle_faces }
    }

    /// The number of a face's hatching, where it has one.
    pub(super) fn hatch(&self, face: u32) -> Option<u32> {
        let face = self.mesh.faces.get(face as usize)?;
        self.hatches[face.material.0 as usize]
    }
}

/// Where light comes from, as unit vectors in view coordinates.
struct Lights {
    up: Vec3,
    key: Vec3,
    rim: Vec3,
}

impl Lights {
    /// The key light stands behind the camera's left shoulder, high up, whatever side the model is seen from; the rim light behind
    /// the model, to the right.
    fn new(up: Vec3) -> Self {
        let towards_eye = Vec3::NEG_Z;
        let horizontal = (towards_eye - up * towards_eye.dot(up)).normalize_or_zero();
        let key = (up * 1.0 + Vec3::NEG_X * 0.62 + horizontal * 0.42).normalize();
        let rim = (up * 0.35 + Vec3::X * 0.75 - horizontal * 0.65).normalize();
        Self { up, key, rim }
    }

    fn shade(&self, look: &Look, color: Vec3, normal: Vec3) -> Shade {
        let sky_part = 0.5 + 0.5 * normal.dot(self.up);
        // The fill light comes from the right, where the key light does not reach.
        let fill_part = 0.5 + 0.5 * normal.dot(Vec3::X);
        let rim_part = normal.dot(self.rim).max(0.0);
        let ambient =
            look.bounce.lerp(look.sky, sky_part) + look.fill_light * fill_part + look.rim * rim_part * rim_part;
        let direct = look.key * normal.dot(self.key).max(0.0);
        Shade { ambient: color * ambient, direct: color * direct }
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
