//! Trees whose leaves are all convex, for whatever is made of convex bodies alone.

use std::borrow::Cow;
use std::collections::hash_map::Entry;
use std::sync::Arc;

use planecut_csg::{
    Brush, ClosedMesh, EvaluateError, Material, MaterialId, MeshBody, Model, Transform, TransformError, Tree,
    WindingRule, evaluate,
};
use planecut_kernel::DVec3;
use rustc_hash::FxHashMap;
use thiserror::Error;

use super::surface::six_volumes;
use super::{PolyhedronError, PolyhedronOptions, Precision, polyhedron, polyhedron_by_winding};

/// Why a closed mesh in a tree is not cut into convex cells.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ConvexTreeError {
    /// Its surface bounds no solid, or falls into too many cells.
    #[error("a mesh of {triangles} triangles that is needed as convex cells: {source}")]
    Surface {
        /// The number of its triangles.
        triangles: usize,
        /// Why.
        source: Box<PolyhedronError>,
    },
    /// It crosses itself, and could not be evaluated.
    #[error(transparent)]
    Evaluate(#[from] EvaluateError),
    /// Its cells leave the accepted range where they belong.
    #[error(transparent)]
    Transform(#[from] TransformError),
}

/// The same tree with the union of convex cells in place of each leaf that is a closed mesh; that very tree where there is none. Cells have the name
/// and the source line of the mesh. Copies of a mesh are cut once.
///
/// A mesh that crosses itself, lies upon itself or is nested in itself is evaluated first; how exactly its corners are known is told by their looks
/// ([`Precision::of_coordinates`]).
///
/// # Errors
/// [`ConvexTreeError`] where a mesh falls into more cells than are accepted.
///
/// ```
/// use planecut_csg::{ClosedMesh, MaterialId, MeshBody, Tree};
/// use planecut_kernel::DVec3;
/// use planecut_shapes::polyhedron::convex_tree;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let mesh = ClosedMesh::new(&corners, &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], |_| 0)?;
/// let tree = Tree::from(MeshBody::new(mesh, vec![MaterialId(0)]));
/// assert_eq!(convex_tree(&tree)?.brushes()[0].faces.len(), 4);
/// # Ok(())
/// # }
/// ```
pub fn convex_tree(tree: &Tree) -> Result<Cow<'_, Tree>, ConvexTreeError> {
    if !tree.has_meshes() {
        return Ok(Cow::Borrowed(tree));
    }
    // meshes are alive as long as the tree is, so places tell them apart
    let mut known: FxHashMap<(*const ClosedMesh, WindingRule), Vec<Brush>> = FxHashMap::default();
    let replaced = tree.clone().try_replace_leaves(|brush| {
        let Some(mesh) = &brush.mesh else { return Ok(vec![brush]) };
        let cells = match known.entry((Arc::as_ptr(mesh.mesh()), mesh.rule())) {
            Entry::Occupied(entry) => entry.into_mut(),
            Entry::Vacant(entry) => entry.insert(cells_of(mesh)?),
        };
        cells.iter().map(|cell| placed(cell.clone(), mesh)).collect()
    });
    replaced.map(Cow::Owned)
}

/// A cell where its mesh is, with the materials that this has for its surfaces.
fn placed(mut cell: Brush, mesh: &MeshBody) -> Result<Brush, ConvexTreeError> {
    cell.materials_mut().for_each(|surface| *surface = mesh.materials()[surface.0 as usize]);
    Ok(if *mesh.transform() == Transform::identity() { cell } else { cell.transformed(mesh.transform())? })
}

/// The cells of a mesh where it was before it was moved, with surfaces for materials.
fn cells_of(body: &MeshBody) -> Result<Vec<Brush>, ConvexTreeError> {
    let mesh = body.mesh();
    let surfaces: Vec<MaterialId> = mesh.surfaces().iter().copied().map(MaterialId).collect();
    let options = PolyhedronOptions { precision: Precision::of_coordinates(mesh.positions()) };
    // one that is inside out has nothing within, whatever its cells are
    let is_turned = six_volumes(mesh.positions(), mesh.triangles()) < 0.0 && body.rule() == WindingRule::Positive;
    let as_it_is =
        if is_turned { None } else { Some(polyhedron(mesh.positions(), mesh.triangles(), &surfaces, &options)) };
    match as_it_is {
        Some(Ok(solid)) => return Ok(solid.cells),
        None | Some(Err(PolyhedronError::Crossing { .. } | PolyhedronError::Inconsistent { .. })) => {}
        Some(Err(source)) => return Err(of_surface(mesh.triangles().len(), source)),
    }
    let (positions, triangles, surfaces) = boundary(body)?;
    if triangles.is_empty() {
        return Ok(Vec::new());
    }
    let solid = match polyhedron(&positions, &triangles, &surfaces, &options) {
        Err(PolyhedronError::Crossing { .. } | PolyhedronError::Inconsistent { .. }) => {
            polyhedron_by_winding(&positions, &triangles, &surfaces, &options)
        }
        solid => solid,
    };
    solid.map(|solid| solid.cells).map_err(|source| of_surface(triangles.len(), source))
}

fn of_surface(triangles: usize, source: PolyhedronError) -> ConvexTreeError {
    ConvexTreeError::Surface { triangles, source: Box::new(source) }
}

/// Points, triangles, and the surface of each.
type Boundary = (Vec<DVec3>, Vec<[u32; 3]>, Vec<MaterialId>);

/// The boundary of what is inside a mesh before it was moved: it does not cross itself.
fn boundary(body: &MeshBody) -> Result<Boundary, ConvexTreeError> {
    let surfaces: Vec<MaterialId> = (0..body.materials().len() as u32).map(MaterialId).collect();
    let materials = surfaces.iter().map(|surface| Material::named(format!("{:09}", surface.0))).collect();
    let alone = MeshBody::new(body.mesh().clone(), surfaces).with_rule(body.rule());
    let mesh = evaluate(&Model { materials, tree: alone.into() })?.mesh;
    let of_triangles = mesh.triangle_faces.iter().map(|face| mesh.faces[*face as usize].material).collect();
    Ok((mesh.positions, mesh.triangles, of_triangles))
}

#[cfg(test)]
mod tests {
    use super::*;
    use planecut_cells::Solid;

    fn cube(min: f64, max: f64, is_turned: bool) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let corner = |k: u32| DVec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2));
        let points = (0..8).map(|k| DVec3::splat(min) + corner(k) * (max - min)).collect();
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let turned = |[a, b, c]: [u32; 3]| if is_turned { [a, c, b] } else { [a, b, c] };
        (points, quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]].map(turned)).collect())
    }

    /// Several cubes as one mesh.
    fn leaf(cubes: &[(f64, f64, bool)], rule: WindingRule) -> MeshBody {
        let (mut points, mut triangles) = (Vec::new(), Vec::new());
        for &(min, max, is_turned) in cubes {
            let (more, corners) = cube(min, max, is_turned);
            triangles.extend(corners.into_iter().map(|t| t.map(|v: u32| v + points.len() as u32)));
            points.extend(more);
        }
        let mesh = ClosedMesh::new(&points, &triangles, |triangle| u32::from(triangle >= 12)).expect("closed");
        MeshBody::new(mesh, vec![MaterialId(3), MaterialId(4)]).with_rule(rule)
    }

    fn volume(tree: &Tree) -> f64 {
        let convex = convex_tree(tree).unwrap_or_else(|error| panic!("{error}"));
        assert!(!convex.has_meshes());
        Solid::from_tree(&convex).volume().expect("bounded")
    }

    #[test]
    fn the_rule_says_what_cells_there_are() {
        use WindingRule::{NonZero, Odd, Positive};
        let crossing = [(0.0, 2.0, false), (1.0, 3.0, false)];
        let nested = [(0.0, 3.0, false), (1.0, 2.0, false)];
        let hollow = [(0.0, 3.0, false), (1.0, 2.0, true)];
        let turned = [(0.0, 3.0, true)];
        for (cubes, expected) in [
            (&crossing[..], [15.0, 15.0, 14.0]),
            (&nested, [27.0, 27.0, 26.0]),
            (&hollow, [26.0, 26.0, 26.0]),
            (&turned, [0.0, 27.0, 27.0]),
        ] {
            for (rule, expected) in [Positive, NonZero, Odd].into_iter().zip(expected) {
                let found = volume(&leaf(cubes, rule).into());
                assert!((found - expected).abs() < 1e-9, "{cubes:?} {rule:?}: {found}, not {expected}");
            }
        }
    }

    #[test]
    fn cells_are_where_the_mesh_is_and_bear_its_name_and_materials() {
        let moved = Transform::translation(DVec3::new(10.0, 0.0, 0.0)).expect("a map");
        let mirrored = Transform::scale(DVec3::new(-1.0, 1.0, 2.0)).expect("a map");
        let hollow = Tree::from(leaf(&[(0.0, 3.0, false), (1.0, 2.0, true)], WindingRule::Positive)).with_name("box");
        let placed = [moved, mirrored].map(|map| hollow.clone().transformed(&map).expect("in range"));
        let tree = Tree::union(placed) - Brush::cuboid([10.0, 0.0, 0.0], [13.0, 3.0, 1.5], MaterialId(1)).into();
        assert!((volume(&tree) - (26.0 / 2.0 + 2.0 * 26.0)).abs() < 1e-9);
        let convex = convex_tree(&tree).expect("cells");
        let cells = convex.brushes().iter().filter(|brush| brush.name.as_deref() == Some("box"));
        let mut used: Vec<u32> = cells.flat_map(Brush::materials).map(|material| material.0).collect();
        used.sort_unstable();
        used.dedup();
        assert_eq!(used, [3, 4]);
    }
}
