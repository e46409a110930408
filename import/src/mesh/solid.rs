//! Closed meshes as models: a leaf of the tree for each object.

use std::num::NonZeroU32;

use glam::DVec3;
use planecut_csg::{Brush, Material, MaterialId, MeshBody, Model, Tree, WindingRule};
use planecut_kernel::hull;
use planecut_shapes::polyhedron::{
    PolyhedronError, SurfaceBody, SurfaceOptions, join_near, surface_body, surface_mesh,
};
use rustc_hash::FxHashMap;
use thiserror::Error;

use super::error::{MeshError, Place};
use super::textures::Surfaces;
use super::{IndexedMesh, MeshFormat, MeshObject, read_mesh, read_textured_mesh};
use crate::Warning;

/// How closed meshes are taken.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SolidOptions {
    /// What of a mesh is inside.
    pub rule: WindingRule,
    /// Vertices that differ by no more than this in each coordinate are joined before anything else, where it is above zero.
    pub close: f64,
    /// Whether texture coordinates of the file are kept. An object that has some is a closed mesh then, also where it is a convex body: each triangle has
    /// a surface of its own, or one with its neighbours, whose texture lies as the file says it ([`MeshBody::textures`]).
    pub textures: bool,
}

/// A mesh file as a model, and what was noticed.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshImport {
    /// The union of the file's objects, each one leaf that bears its name: a convex body where it is one, a closed mesh otherwise.
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

impl SolidError {
    /// Whether an object is not closed.
    #[must_use]
    pub fn is_open(&self) -> bool {
        matches!(self, Self::Surface { source, .. } if matches!(**source, PolyhedronError::Open { .. }))
    }
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

/// Reads a mesh whose objects are closed, as a model. An object that is a convex body becomes one, with a face for each plane; any other becomes a
/// leaf that is a closed mesh, which may cross itself, lie upon itself and be nested in itself. Overlapping objects are united.
///
/// Where an object for itself is not closed, the file is taken as one surface. Faces have the materials of the file, or one named
/// `default`. The brush of an object bears its name, and the line of its first facet. glTF, in which y points up, is turned so
/// that z does. `name` is what errors call the file.
///
/// # Errors
/// [`SolidError`] where the file cannot be read, or an object's surface is not closed or encloses nothing.
pub fn read_solid(
    bytes: &[u8],
    format: MeshFormat,
    name: &str,
    options: &SolidOptions,
) -> Result<MeshImport, SolidError> {
    let read = if options.textures { read_textured_mesh } else { read_mesh };
    solid_of_mesh(read(bytes, format, name)?, format, name, options)
}

/// The same for a mesh that was read already; textures are kept where it has some.
///
/// # Errors
/// [`SolidError::Surface`] where an object's surface is not closed or encloses nothing.
pub fn solid_of_mesh(
    mesh: IndexedMesh,
    format: MeshFormat,
    name: &str,
    options: &SolidOptions,
) -> Result<MeshImport, SolidError> {
    let (mesh, notes) = prepared(mesh, format, options);
    import(&mesh, name, ConvexObjects::AsStated, options.rule, &notes)
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
/// have left some of them outside of the facets of others, or bent facets that were meant to be planar. An object among convex ones that
/// encloses no volume, as rounding makes of slivers, is no part, but its points are among the points.
///
/// # Errors
/// As [`read_solid`].
pub fn read_parts(
    bytes: &[u8],
    format: MeshFormat,
    name: &str,
    options: &SolidOptions,
) -> Result<PartsImport, SolidError> {
    parts_of_mesh(read_mesh(bytes, format, name)?, format, name, options)
}

/// The same for a mesh that was read already.
///
/// # Errors
/// [`SolidError::Surface`] where an object's surface is not closed or encloses nothing.
pub fn parts_of_mesh(
    mesh: IndexedMesh,
    format: MeshFormat,
    name: &str,
    options: &SolidOptions,
) -> Result<PartsImport, SolidError> {
    let (mesh, notes) = prepared(mesh, format, options);
    let import = import(&mesh, name, ConvexObjects::AsHulls, options.rule, &notes)?;
    let mut used: Vec<u32> = mesh.triangles.iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    let points = used.into_iter().map(|point| mesh.positions[point as usize]).collect();
    Ok(PartsImport { import, points })
}

/// The triangles of a mesh, whatever they bound.
#[derive(Debug, Clone, PartialEq)]
pub struct TrianglesImport {
    /// Vertices, turned so that z is up.
    pub positions: Vec<DVec3>,
    /// Three numbers of vertices each.
    pub triangles: Vec<[u32; 3]>,
    /// The materials of the file, or one named `default`.
    pub materials: Vec<Material>,
    /// The material of each triangle.
    pub material_of: Vec<MaterialId>,
    /// What was done to them.
    pub warnings: Vec<Warning>,
}

/// Reads the triangles of a mesh that need not bound anything. Of the options only `close` says something of them.
///
/// # Errors
/// [`MeshError`] where the file cannot be read.
pub fn read_triangles(
    bytes: &[u8],
    format: MeshFormat,
    name: &str,
    options: &SolidOptions,
) -> Result<TrianglesImport, MeshError> {
    let (mesh, notes) = prepared(read_mesh(bytes, format, name)?, format, options);
    let (materials, material_of) = materials(&mesh);
    let warnings = notes.into_iter().map(|note| Warning::note(0, note)).collect();
    let IndexedMesh { positions, triangles, .. } = mesh;
    Ok(TrianglesImport { positions, triangles, materials, material_of, warnings })
}

/// A mesh with z up, with materials for colours, and with vertices joined as the options say; and what is to be said of that.
fn prepared(mesh: IndexedMesh, format: MeshFormat, options: &SolidOptions) -> (IndexedMesh, Vec<String>) {
    let (mut mesh, rounded) = mesh.painted();
    let mut notes: Vec<String> = rounded.into_iter().collect();
    if format == MeshFormat::Gltf {
        mesh.positions.iter_mut().for_each(|p| *p = DVec3::new(p.x, 0.0 - p.z, p.y));
    }
    if options.close > 0.0 {
        let (positions, joined) = join_near(&mesh.positions, options.close);
        mesh.positions = positions;
        let vertices = if joined == 1 { "vertex" } else { "vertices" };
        if joined > 0 {
            notes.push(format!("joined {joined} {vertices} with others that are no farther than {}", options.close));
        }
    }
    (mesh, notes)
}

/// What becomes of objects that are convex bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ConvexObjects {
    /// Bodies with the planes of their facets.
    AsStated,
    /// The hulls of their points.
    AsHulls,
}

fn import(
    mesh: &IndexedMesh,
    name: &str,
    convex: ConvexObjects,
    rule: WindingRule,
    notes: &[String],
) -> Result<MeshImport, SolidError> {
    let reader = Reader { mesh, rule, convex };
    let mut import = reader.solid().map_err(|(object, source)| {
        let triangle = source.facet().map(|facet| object.triangles.start + facet);
        let place = triangle.and_then(|triangle| mesh.places.get(triangle)).cloned().unwrap_or(Place::End);
        SolidError::Surface { name: name.to_owned(), place, object: object.name.clone(), source: Box::new(source) }
    })?;
    import.warnings.splice(0..0, notes.iter().map(|note| Warning::note(0, note.as_str())));
    Ok(import)
}

/// An object's surface is wrong.
type Fault = (MeshObject, PolyhedronError);

/// Makes the solid of a mesh.
struct Reader<'m> {
    mesh: &'m IndexedMesh,
    rule: WindingRule,
    convex: ConvexObjects,
}

impl Reader<'_> {
    fn solid(&self) -> Result<MeshImport, Fault> {
        match self.united(&self.mesh.objects) {
            Err((object, error @ PolyhedronError::Open { .. })) if self.mesh.objects.len() > 1 => {
                let whole = MeshObject { name: None, triangles: 0..self.mesh.triangles.len() };
                // what is wrong with the object says more than what is wrong with all
                self.united(&[whole]).map_err(|_| (object, error))
            }
            result => result,
        }
    }

    /// The union of objects.
    fn united(&self, objects: &[MeshObject]) -> Result<MeshImport, Fault> {
        let (materials, material_of) = materials(self.mesh);
        let (mut brushes, mut lines, mut warnings) = (Vec::new(), Vec::new(), Vec::new());
        let mut numbers = vec![u32::MAX; self.mesh.positions.len()];
        let mut flat: Option<Fault> = None;
        for object in objects {
            let (points, triangles) = own_points(self.mesh, object, &mut numbers);
            let options = SurfaceOptions { precision: self.mesh.precision, rule: self.rule };
            let materials = &material_of[object.triangles.clone()];
            let textures = self.mesh.textures.get(object.triangles.clone()).unwrap_or_default();
            let body = if textures.iter().any(Option::is_some) {
                textured_body(&points, &triangles, &Surfaces::of(&points, &triangles, materials, textures), &options)
            } else {
                surface_body(&points, &triangles, materials, &options)
            };
            let line = match self.mesh.places.get(object.triangles.start) {
                Some(Place::Line(line)) => u32::try_from(*line).ok().and_then(NonZeroU32::new),
                _ => None,
            };
            let mut warn = |message: &str| {
                let message = format!("{}{message}", of_object(object.name.as_deref()));
                warnings.push(Warning::note(line.map_or(0, NonZeroU32::get), message));
            };
            let body = match body {
                Ok(body) => body,
                Err(error @ PolyhedronError::NoVolume) if self.convex == ConvexObjects::AsHulls => {
                    warn("found a surface that encloses no volume: other objects must hold its points");
                    flat.get_or_insert((object.clone(), error));
                    continue;
                }
                Err(error) => return Err((object.clone(), error)),
            };
            if body.is_turned {
                warn("found facets that are clockwise seen from outside, turned them over");
            }
            if body.joined_corners > 0 {
                warn(&joined_message(body.joined_corners));
            }
            let is_hull = self.convex == ConvexObjects::AsHulls && !body.brush.is_mesh();
            let brush = if is_hull { hull_of(&points, &body.brush) } else { body.brush };
            brushes.push(Brush { name: object.name.clone(), ..brush });
            lines.push(line);
        }
        // only convex parts are made to hold points beside their own
        if let Some(fault) = flat
            && (brushes.is_empty() || brushes.iter().any(Brush::is_mesh))
        {
            return Err(fault);
        }
        let tree = Tree::union_of(brushes).with_source_lines(lines);
        Ok(MeshImport { model: Model { materials, tree }, warnings })
    }
}

/// A closed mesh whose surfaces have textures.
fn textured_body(
    points: &[DVec3],
    triangles: &[[u32; 3]],
    surfaces: &Surfaces,
    options: &SurfaceOptions,
) -> Result<SurfaceBody, PolyhedronError> {
    let numbers: Vec<MaterialId> = surfaces.of_triangle.iter().copied().map(MaterialId).collect();
    let mut body = surface_mesh(points, triangles, &numbers, options)?;
    body.brush.mesh = body.brush.mesh.map(|leaf| {
        // numbers of surfaces stand for their materials so far
        let places = || leaf.materials().iter().map(|surface| surface.0 as usize);
        let materials = places().map(|surface| surfaces.materials[surface]).collect();
        let textures: Vec<_> = places().map(|surface| surfaces.textures[surface]).collect();
        MeshBody::new(leaf.mesh().clone(), materials).with_rule(leaf.rule()).with_textures(textures)
    });
    Ok(body)
}

/// The hull of points with the material of a body that is the same but for rounding; that body where there is no hull.
fn hull_of(points: &[DVec3], body: &Brush) -> Brush {
    let (Ok(hull), Some(face)) = (hull(points), body.faces.first()) else { return body.clone() };
    let facets = hull.facets();
    Brush::from_half_spaces(facets.iter().filter_map(|(plane, _)| hull.plane(*plane).copied()), face.material)
}

/// The points that an object uses, and its triangles by their numbers. `numbers` has room for each point of the mesh, and is left as it was.
fn own_points(mesh: &IndexedMesh, object: &MeshObject, numbers: &mut [u32]) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let (mut points, mut used) = (Vec::new(), Vec::new());
    let mut own = |point: u32| {
        let number = &mut numbers[point as usize];
        if *number == u32::MAX {
            *number = used.len() as u32;
            used.push(point);
            points.push(mesh.positions[point as usize]);
        }
        *number
    };
    let triangles = mesh.triangles[object.triangles.clone()].iter().map(|t| t.map(&mut own)).collect();
    used.into_iter().for_each(|point| numbers[point as usize] = u32::MAX);
    (points, triangles)
}

/// The materials, each name once, and that of each triangle.
fn materials(mesh: &IndexedMesh) -> (Vec<Material>, Vec<MaterialId>) {
    let mut materials: Vec<Material> = Vec::new();
    let mut by_name: FxHashMap<String, MaterialId> = FxHashMap::default();
    let mut number = |material: &Material| {
        *by_name.entry(material.name.clone()).or_insert_with(|| {
            materials.push(material.clone());
            MaterialId(materials.len() as u32 - 1)
        })
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
