//! The triangles of one glTF mesh, in its own coordinates.

use glam::{DVec2, DVec3};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;

use super::super::colors::{Color, mean};
use super::super::error::{Fault, Place};
use super::super::merge::PositionMerger;
use super::super::textures::{self, Corners};
use super::MAX_TRIANGLES;
use super::accessor::Buffers;
use super::document::Document;

/// A mesh with the vertices that its triangles use.
pub(super) struct Geometry {
    pub(super) positions: Vec<DVec3>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// The material of each triangle.
    pub(super) material_of: Vec<Option<u32>>,
    /// The colour of each triangle.
    pub(super) colors: Vec<Option<Color>>,
    /// The texture coordinates of each triangle; empty where they are not asked for.
    pub(super) textures: Vec<Option<Corners>>,
}

/// What a primitive states; colours and texture coordinates of its triangles.
#[derive(Default)]
struct Stated {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    colors: Vec<Option<Color>>,
    /// Empty where they are not asked for.
    textures: Vec<Option<Corners>>,
}

/// Reads a mesh: its manifold primitive as it stands, or else its primitives with equal positions merged.
pub(super) fn read(
    document: &Document,
    buffers: &Buffers<'_>,
    mesh: usize,
    has_textures: bool,
) -> Result<Geometry, Fault> {
    let source = &document.meshes[mesh];
    if let Some(manifold) = &source.extensions.manifold {
        let place = format!("meshes/{mesh}/extensions/EXT_mesh_manifold/manifoldPrimitive");
        let stated = read_primitive(&manifold.manifold_primitive, buffers, &place, has_textures)?;
        let Stated { positions, triangles, colors, textures } = stated;
        let (material_of, in_order) = materials_in_order(document, buffers, mesh, triangles.len())?;
        let colors = if colors.iter().all(Option::is_none) { in_order } else { colors };
        let textures = if has_textures && textures.iter().all(Option::is_none) {
            textures_in_order(document, buffers, mesh, &positions, &triangles)?
        } else {
            textures
        };
        return Ok(without_unused(&positions, triangles, material_of, colors, textures));
    }
    let mut merger = PositionMerger::default();
    let (mut merged, mut material_of) = (Vec::new(), Vec::new());
    let (mut all_colors, mut all_textures) = (Vec::new(), Vec::new());
    for (number, primitive) in source.primitives.iter().enumerate() {
        let place = format!("meshes/{mesh}/primitives/{number}");
        let Stated { positions, triangles, colors, textures } =
            read_primitive(primitive, buffers, &place, has_textures)?;
        all_colors.extend(colors);
        all_textures.extend(textures);
        if triangles.len() > MAX_TRIANGLES - merged.len() {
            return Err(Fault::new(Place::Json(place), "more triangles", format!("at most {MAX_TRIANGLES}")));
        }
        for triangle in triangles {
            let mut corners = [0; 3];
            for (corner, v) in corners.iter_mut().zip(triangle) {
                *corner = merger
                    .index(positions[v as usize])
                    .ok_or_else(|| Fault::new(Place::Json(place.clone()), "more vertices", "at most 4294967295"))?;
            }
            merged.push(corners);
            material_of.push(material(document, primitive));
        }
    }
    let positions = merger.into_positions();
    Ok(Geometry { positions, triangles: merged, material_of, colors: all_colors, textures: all_textures })
}

/// The number of a primitive's material, where there is such a one.
fn material(document: &Document, primitive: &Primitive) -> Option<u32> {
    let number = primitive.material?.value();
    if number < document.materials.len() { u32::try_from(number).ok() } else { None }
}

/// The material and the colour of each triangle.
type Looks = (Vec<Option<u32>>, Vec<Option<Color>>);

/// The materials and colours of a manifold primitive's triangles, which are those of the mesh's primitives one after another; none where
/// they are not as many.
fn materials_in_order(document: &Document, buffers: &Buffers<'_>, mesh: usize, count: usize) -> Result<Looks, Fault> {
    let primitives = &document.meshes[mesh].primitives;
    let none = || (vec![None; count], vec![None; count]);
    let is_plain = |primitive: &Primitive| material(document, primitive).is_none() && color_of(primitive).is_none();
    if primitives.iter().all(is_plain) {
        return Ok(none());
    }
    let (mut material_of, mut all_colors) = (Vec::with_capacity(count), Vec::with_capacity(count));
    for (number, primitive) in primitives.iter().enumerate() {
        let stated = read_primitive(primitive, buffers, &format!("meshes/{mesh}/primitives/{number}"), false)?;
        material_of.resize(material_of.len() + stated.triangles.len(), material(document, primitive));
        all_colors.extend(stated.colors);
    }
    Ok(if material_of.len() == count { (material_of, all_colors) } else { none() })
}

/// The texture coordinates of a manifold primitive's triangles, which are those of the mesh's primitives one after another; none of a triangle
/// whose corners are not at the places that they have there.
fn textures_in_order(
    document: &Document,
    buffers: &Buffers<'_>,
    mesh: usize,
    positions: &[DVec3],
    triangles: &[[u32; 3]],
) -> Result<Vec<Option<Corners>>, Fault> {
    let primitives = &document.meshes[mesh].primitives;
    if primitives.iter().all(|primitive| coordinates_of(primitive).is_none()) {
        return Ok(Vec::new());
    }
    let mut all: Vec<Option<Corners>> = Vec::with_capacity(triangles.len());
    for (number, primitive) in primitives.iter().enumerate() {
        let stated = read_primitive(primitive, buffers, &format!("meshes/{mesh}/primitives/{number}"), true)?;
        for (triangle, texture) in stated.triangles.iter().zip(stated.textures) {
            let there = triangle.map(|corner| stated.positions[corner as usize]);
            let here = triangles.get(all.len()).map(|triangle| triangle.map(|corner| positions[corner as usize]));
            // the same corner may come first or another one
            let turn = here.and_then(|here| (0..3).find(|turn| (0..3).all(|k| here[k] == there[(k + turn) % 3])));
            all.push(texture.and_then(|texture| turn.map(|turn| [0, 1, 2].map(|k| texture[(k + turn) % 3]))));
        }
    }
    Ok(if all.len() == triangles.len() { all } else { Vec::new() })
}

/// Keeps the vertices that triangles use, in their order.
fn without_unused(
    positions: &[DVec3],
    mut triangles: Vec<[u32; 3]>,
    material_of: Vec<Option<u32>>,
    colors: Vec<Option<Color>>,
    textures: Vec<Option<Corners>>,
) -> Geometry {
    let mut used = vec![false; positions.len()];
    triangles.as_flattened().iter().for_each(|&v| used[v as usize] = true);
    let kept: Vec<u32> = (0..positions.len() as u32).filter(|&v| used[v as usize]).collect();
    let mut new_index = vec![0u32; positions.len()];
    kept.iter().enumerate().for_each(|(new, &old)| new_index[old as usize] = new as u32);
    triangles.iter_mut().flatten().for_each(|v| *v = new_index[*v as usize]);
    let positions = kept.into_iter().map(|v| positions[v as usize]).collect();
    Geometry { positions, triangles, material_of, colors, textures }
}

/// The accessor of a primitive's colours.
fn color_of(primitive: &Primitive) -> Option<usize> {
    primitive.attributes.get(&Checked::Valid(Semantic::Colors(0))).map(|accessor| accessor.value())
}

/// The accessor of a primitive's first texture coordinates.
fn coordinates_of(primitive: &Primitive) -> Option<usize> {
    primitive.attributes.get(&Checked::Valid(Semantic::TexCoords(0))).map(|accessor| accessor.value())
}

/// The positions and triangles of a primitive; none for points and lines.
fn read_primitive(
    primitive: &Primitive,
    buffers: &Buffers<'_>,
    place: &str,
    has_textures: bool,
) -> Result<Stated, Fault> {
    let position = primitive.attributes.get(&Checked::Valid(Semantic::Positions));
    let (Some(position), Checked::Valid(mode @ (Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan))) =
        (position, primitive.mode)
    else {
        return Ok(Stated::default());
    };
    let positions = buffers.positions(position.value())?;
    let indices = match primitive.indices {
        Some(indices) => buffers.indices(indices.value())?,
        None => (0..positions.len() as u32).collect(),
    };
    let fault = |found, expected| Err(Fault::new(Place::Json(place.to_owned()), found, expected));
    if let Some(index) = indices.iter().find(|&&i| i as usize >= positions.len()) {
        return fault(format!("vertex index {index}"), format!("an index below {}", positions.len()));
    }
    let triangles = match mode {
        Mode::Triangles => {
            let (triangles, rest) = indices.as_chunks::<3>();
            if !rest.is_empty() {
                return fault(format!("{} indices", indices.len()), "a multiple of 3".to_owned());
            }
            triangles.to_vec()
        }
        // Every other triangle of a strip is wound the other way.
        Mode::TriangleStrip => {
            let turned = |(k, w): (usize, &[u32])| if k % 2 == 0 { [w[0], w[1], w[2]] } else { [w[1], w[0], w[2]] };
            indices.windows(3).enumerate().map(turned).collect()
        }
        _ => indices.windows(2).skip(1).map(|w| [w[0], w[1], indices[0]]).collect(),
    };
    let of_vertex = color_of(primitive).map_or(Ok(Vec::new()), |accessor| buffers.colors(accessor))?;
    let of_corner = |corner: u32| of_vertex.get(corner as usize).copied();
    let colors = triangles.iter().map(|triangle| mean(triangle.map(of_corner))).collect();
    if !has_textures {
        return Ok(Stated { positions, triangles, colors, textures: Vec::new() });
    }
    let coordinates: Vec<DVec2> =
        coordinates_of(primitive).map_or(Ok(Vec::new()), |accessor| buffers.coordinates(accessor))?;
    if !coordinates.is_empty() && coordinates.len() != positions.len() {
        return fault(
            format!("{} texture coordinates", coordinates.len()),
            format!("{}, as many as positions", positions.len()),
        );
    }
    // of some primitives there may be none: then their triangles have none
    let mut textures = textures::of_vertices(&triangles, &coordinates);
    textures.resize(triangles.len(), None);
    Ok(Stated { positions, triangles, colors, textures })
}
