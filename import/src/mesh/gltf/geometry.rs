//! The triangles of one glTF mesh, in its own coordinates.

use glam::DVec3;
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;

use super::super::colors::{Color, mean};
use super::super::error::{Fault, Place};
use super::super::merge::PositionMerger;
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
}

/// What a primitive states; colours of its triangles.
#[derive(Default)]
struct Stated {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    colors: Vec<Option<Color>>,
}

/// Reads a mesh: its manifold primitive as it stands, or else its primitives with equal positions merged.
pub(super) fn read(document: &Document, buffers: &Buffers<'_>, mesh: usize) -> Result<Geometry, Fault> {
    let source = &document.meshes[mesh];
    if let Some(manifold) = &source.extensions.manifold {
        let place = format!("meshes/{mesh}/extensions/EXT_mesh_manifold/manifoldPrimitive");
        let Stated { positions, triangles, colors } = read_primitive(&manifold.manifold_primitive, buffers, &place)?;
        let (material_of, in_order) = materials_in_order(document, buffers, mesh, triangles.len())?;
        let colors = if colors.iter().all(Option::is_none) { in_order } else { colors };
        return Ok(without_unused(&positions, triangles, material_of, colors));
    }
    let mut merger = PositionMerger::default();
    let (mut merged, mut material_of, mut all_colors) = (Vec::new(), Vec::new(), Vec::new());
    for (number, primitive) in source.primitives.iter().enumerate() {
        let place = format!("meshes/{mesh}/primitives/{number}");
        let Stated { positions, triangles, colors } = read_primitive(primitive, buffers, &place)?;
        all_colors.extend(colors);
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
    Ok(Geometry { positions: merger.into_positions(), triangles: merged, material_of, colors: all_colors })
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
        let stated = read_primitive(primitive, buffers, &format!("meshes/{mesh}/primitives/{number}"))?;
        material_of.resize(material_of.len() + stated.triangles.len(), material(document, primitive));
        all_colors.extend(stated.colors);
    }
    Ok(if material_of.len() == count { (material_of, all_colors) } else { none() })
}

/// Keeps the vertices that triangles use, in their order.
fn without_unused(
    positions: &[DVec3],
    mut triangles: Vec<[u32; 3]>,
    material_of: Vec<Option<u32>>,
    colors: Vec<Option<Color>>,
) -> Geometry {
    let mut used = vec![false; positions.len()];
    triangles.as_flattened().iter().for_each(|&v| used[v as usize] = true);
    let kept: Vec<u32> = (0..positions.len() as u32).filter(|&v| used[v as usize]).collect();
    let mut new_index = vec![0u32; positions.len()];
    kept.iter().enumerate().for_each(|(new, &old)| new_index[old as usize] = new as u32);
    triangles.iter_mut().flatten().for_each(|v| *v = new_index[*v as usize]);
    let positions = kept.into_iter().map(|v| positions[v as usize]).collect();
    Geometry { positions, triangles, material_of, colors }
}

/// The accessor of a primitive's colours.
fn color_of(primitive: &Primitive) -> Option<usize> {
    primitive.attributes.get(&Checked::Valid(Semantic::Colors(0))).map(|accessor| accessor.value())
}

/// The positions and triangles of a primitive; none for points and lines.
fn read_primitive(primitive: &Primitive, buffers: &Buffers<'_>, place: &str) -> Result<Stated, Fault> {
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
    Ok(Stated { positions, triangles, colors })
}
