//! Joining bodies that touch each other, as far as they stay convex.

use planecut_csg::stages::smallest_size;
use planecut_csg::{Brush, BrushFace, PlaneTable};
use planecut_kernel::HalfSpace;

use super::cell::{Cell, CellPlane};
use super::from_tree::bodies_of;
use super::merge::merge_neighbours;

/// Bodies without interior in common, of which neighbours that share a whole facet and are convex together become one, unless
/// they have coplanar faces of different materials.
#[must_use]
pub fn joined(brushes: &[Brush]) -> Vec<Brush> {
    let half_spaces: Vec<HalfSpace> = brushes.iter().flat_map(Brush::half_spaces).copied().collect();
    let (table, ids) = PlaneTable::intern(&half_spaces, smallest_size(brushes.iter().map(Brush::half_spaces)));
    let (_, bodies) = bodies_of(&table, brushes, &ids);
    let mut cells: Vec<Cell> = bodies.into_iter().map(|body| body.cell).collect();
    merge_neighbours(&table, &mut cells);
    // the planes as they were given, also where the table took them for others
    let face = |plane: CellPlane| -> Option<BrushFace> {
        let (brush, face) = plane.brush_face?;
        Some(brushes[brush as usize].faces[face as usize])
    };
    let brush = |cell: Cell| {
        let facets = cell.facets();
        let first = facets.first().and_then(|facet| facet.brush_face);
        let like = first.map(|(brush, _)| brushes[brush as usize].clone()).unwrap_or_default();
        Brush { faces: facets.into_iter().filter_map(face).collect(), ..like }
    };
    cells.into_iter().map(brush).collect()
}
