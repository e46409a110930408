//! Closed meshes as models of convex cells.

use std::num::NonZeroU32;

use glam::DVec3;
use planecut_csg::{Brush, Material, MaterialId, Model, Tree};
use planecut_kernel::hull;
use planecut_shapes::polyhedron::{PolyhedronError, PolyhedronOptions, polyhedron};
use rustc_hash::FxHashMap;
use thiserror::Error;

use super::error::{MeshError, Place};
use super::{IndexedMesh, MeshFormat, MeshObject, read_mesh};
use crate::Warning;

/// A mesh file as a model, and what was noticed.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshImport {
    /// The union of the file's objects, each as convex cells that bear its name.
    pub model: Model,
    /// What was repaired.
    pub warnings: Vec<Warning>,
}

/// Why a mesh file gives no solid. Displays as one line that begins with the file's name.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum SolidError {
    /// It could not be read.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The surface of an object bounds no solid.
    #[error("{name}:{place} {}{source}", of_object(.object.as_deref()))]
    Surface {
        /// The file's name as given to the reader.
        name: String,
        /// Where in the file.
        place: Place,
        /// The object, where it has a name.
        object: Option<String>,
        /// What is wrong with it.
        source: Box<PolyhedronError>,
    },
}

/// What is said of corners that were joined.
pub(crate) fn joined_message(count: usize) -> String {
    match count {
        1 => "a corner that differs from another by rounding is joined with it: the surface is not closed otherwise"
            .to_owned(),
        _ => format!(
            "{count} corners that differ from others by rounding are joined with them: the surface is not closed otherwise"
        ),
    }
}

fn of_object(object: Option<&str>) -> String {
    object.map_or_else(String::new, |name| format!("object `{}`: ", name.escape_debug()))
}

/// Reads a mesh whose objects are closed, as a model: each object becomes convex cells, and overlapping ones are united.
///
/// Where an object for itself is not closed, the file is taken as one surface. Faces have the materials of the file, or one named
/// `default`. The brushes of an object bear its name, and the line of its first facet. glTF, in which y points up, is turned so
/// that z does. `name` is what errors call the file.
///
/// # Errors
/// [`SolidError`] where the file cannot be read, or an object's surface is not closed, crosses itself, or encloses nothing.
pub fn read_solid(bytes: &[u8], format: MeshFormat, name: &str) -> Result<MeshImport, SolidError> {
    solid_of_mesh(read_mesh(bytes, format, name)?, format, name)
}

/// The same for a mesh that was read already.
///
/// # Errors
/// [`SolidError::Surface`] where an object's surface is not closed, crosses itself, or encloses nothing.
pub fn solid_of_mesh(mut mesh: IndexedMesh, format: MeshFormat, name: &str) -> Result<MeshImport, SolidError> {
    if format == MeshFormat::Gltf {
        turn_up(&mut mesh);
    }
    import(&mesh, name, ConvexObjects::AsStated)
}

/// The convex parts of a mesh, as they are to be coarsened, and its points.
#[derive(Debug, Clone, PartialEq)]
pub struct PartsImport {
    /// The model, in which an object that is a convex body is the hull of its points, and holds each of them exactly; other objects are
    /// as in [`read_solid`].
    pub import: MeshImport,
    /// The points of all triangles, turned as the model is.
    pub points: Vec<DVec3>,
}

/// Reads a mesh whose objects are closed, as [`read_solid`], but so that convex objects hold all of their points: rounding in the file may
/// have left some of them outside of the facets of others, or bent facets that were meant to be planar.
///
/// # Errors
/// As [`read_solid`].
pub fn read_parts(bytes: &[u8], format: MeshFormat, name: &str) -> Result<PartsImport, SolidError> {
    let mut mesh = read_mesh(bytes, format, name)?;
    if format == MeshFormat::Gltf {
        turn_up(&mut mesh);
    }
    let mut used: Vec<u32> = mesh.triangles.iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    let points = used.into_iter().map(|point| mesh.positions[point as usize]).collect();
    Ok(PartsImport { import: import(&mesh, name, ConvexObjects::AsHulls)?, points })
}

/// From glTF's axes, in which y points up, to those in which z does.
fn turn_up(mesh: &mut IndexedMesh) {
    mesh.positions.iter_mut().for_each(|p| *p = DVec3::new(p.x, 0.0 - p.z, p.y));
}

/// What becomes of objects that are convex bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ConvexObjects {
    /// Bodies with the planes of their facets.
    AsStated,
    /// The hulls of their points.
    AsHulls,
}

fn import(mesh: &IndexedMesh, name: &str, convex: ConvexObjects) -> Result<MeshImport, SolidError> {
    solid_of(mesh, convex).map_err(|(object, source)| {
        let triangle = source.facet().map(|facet| object.triangles.start + facet);
        let place = triangle.and_then(|triangle| mesh.places.get(triangle)).cloned().unwrap_or(Place::End);
        SolidError::Surface { name: name.to_owned(), place, object: object.name.clone(), source: Box::new(source) }
    })
}

/// An object's surface is wrong.
type Fault = (MeshObject, PolyhedronError);

fn solid_of(mesh: &IndexedMesh, convex: ConvexObjects) -> Result<MeshImport, Fault> {
    match united(mesh, &mesh.objects, convex) {
        Err((object, error @ PolyhedronError::Open { .. })) if mesh.objects.len() > 1 => {
            let whole = MeshObject { name: None, triangles: 0..mesh.triangles.len() };
            // what is wrong with the object says more than what is wrong with all
            united(mesh, &[whole], convex).map_err(|_| (object, error))
        }
        result => result,
    }
}

fn united(mesh: &IndexedMesh, objects: &[MeshObject], convex: ConvexObjects) -> Result<MeshImport, Fault> {
    let (materials, material_of) = materials(mesh);
    let mut import = MeshImport { model: Model { materials, tree: Tree::empty() }, warnings: Vec::new() };
    let (mut brushes, mut lines) = (Vec::new(), Vec::new());
    for object in objects {
        let (points, triangles) = own_points(mesh, object);
        let options = PolyhedronOptions { precision: mesh.precision };
        let mut solid = polyhedron(&points, &triangles, &material_of[object.triangles.clone()], &options)
            .map_err(|error| (object.clone(), error))?;
        if let (ConvexObjects::AsHulls, [cell]) = (convex, &mut solid.cells[..]) {
            *cell = hull_of(&points, cell);
        }
        let line = match mesh.places.get(object.triangles.start) {
            Some(Place::Line(line)) => u32::try_from(*line).ok().and_then(NonZeroU32::new),
            _ => None,
        };
        if solid.is_turned {
            let message = "found facets that are clockwise seen from outside, turned them over";
            let message = format!("{}{message}", of_object(object.name.as_deref()));
            import.warnings.push(Warning::note(line.map_or(0, NonZeroU32::get), message));
        }
        if solid.joined_corners > 0 {
            let message = format!("{}{}", of_object(object.name.as_deref()), joined_message(solid.joined_corners));
            import.warnings.push(Warning::note(line.map_or(0, NonZeroU32::get), message));
        }
        brushes.extend(solid.cells.into_iter().map(|mut brush| {
            brush.name = object.name.clone();
            brush
        }));
        lines.resize(brushes.len(), line);
    }
    import.model.tree = Tree::union_of(brushes).with_source_lines(lines);
    Ok(import)
}

/// The hull of points with the material of a body that is the same but for rounding; that body where there is no hull.
fn hull_of(points: &[DVec3], body: &Brush) -> Brush {
    let (Ok(hull), Some(face)) = (hull(points), body.faces.first()) else { return body.clone() };
    let facets = hull.facets();
    Brush::from_half_spaces(facets.iter().filter_map(|(plane, _)| hull.plane(*plane).copied()), face.material)
}

/// The points that an object uses, and its triangles by their numbers.
fn own_points(mesh: &IndexedMesh, object: &MeshObject) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let mut numbers: FxHashMap<u32, u32> = FxHashMap::default();
    let mut points = Vec::new();
    let mut own = |point: u32| {
        *numbers.entry(point).or_insert_with(|| {
            points.push(mesh.positions[point as usize]);
            points.len() as u32 - 1
        })
    };
    let triangles = mesh.triangles[object.triangles.clone()].iter().map(|t| t.map(&mut own)).collect();
    (points, triangles)
}

/// The materials, each name once, and that of each triangle.
fn materials(mesh: &IndexedMesh) -> (Vec<Material>, Vec<MaterialId>) {
    let mut materials: Vec<Material> = Vec::new();
    let mut number = |material: &Material| {
        let known = materials.iter().position(|other| other.name == material.name);
        MaterialId(known.unwrap_or_else(|| {
            materials.push(material.clone());
            materials.len() - 1
        }) as u32)
    };
    let of_file: Vec<MaterialId> = mesh.materials.iter().map(&mut number).collect();
    let mut default = None;
    let mut of_triangle = |triangle: usize| match mesh.material_of.get(triangle).copied().flatten() {
        Some(material) => of_file[material as usize],
        None => *default.get_or_insert_with(|| number(&Material::named(DEFAULT))),
    };
    let material_of = (0..mesh.triangles.len()).map(&mut of_triangle).collect();
    (materials, material_of)
}

/// The material of what has none.
const DEFAULT: &str = "default";
