//! What every result must fulfil.

use dashu_ratio::RBig;
use glam::DVec3;
use planecut_cells::Solid;
use planecut_cells::coarsen::Coarsened;
use planecut_csg::{Brush, Material, MaterialId, Model, Tree, evaluate};
use planecut_kernel::HalfSpace;

fn rational(v: f64) -> RBig {
    RBig::try_from(v).expect("a finite number")
}

/// Whether a brush holds a point, in exact rationals.
pub(crate) fn holds(brush: &Brush, point: DVec3) -> bool {
    brush.faces.iter().all(|face| is_within(&face.half_space, point))
}

fn is_within(half_space: &HalfSpace, point: DVec3) -> bool {
    let terms = half_space.normal().to_array().into_iter().zip(point.to_array());
    let sum = terms.fold(RBig::ZERO, |sum, (n, x)| sum + rational(n) * rational(x));
    sum <= rational(half_space.offset())
}

/// Fails where a point lies outside of all cells, exactly.
#[track_caller]
pub(crate) fn assert_holds_points(cells: &[Brush], points: &[DVec3]) {
    for point in points {
        assert!(cells.iter().any(|cell| holds(cell, *point)), "{point:?} is in no cell");
    }
}

/// The mesh volume of a brush: of its own triangles alone.
pub(crate) fn volume(brush: &Brush) -> f64 {
    let materials = vec![Material::named("any")];
    let tree = Tree::from(brush.clone()).with_material(MaterialId(0));
    evaluate(&Model { materials, tree }).expect("a bounded cell").solid.volume
}

/// The volume of a difference, by disjoint cells.
pub(crate) fn volume_outside(of: &Tree, cells: &[Brush]) -> f64 {
    let cells = Tree::union_of(cells.to_vec());
    Solid::from_tree(&(of.clone() - cells)).volume().expect("a bounded solid")
}

/// Fails where the cells leave out some of the solid, or the volumes that are told are not those of the cells.
#[track_caller]
pub(crate) fn assert_sound(tree: &Tree, coarsened: &Coarsened) {
    let whole = Solid::from_tree(tree).volume().expect("a bounded solid");
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-11 * whole;
    assert!(near(coarsened.volume_in, whole), "volume {} of {whole}", coarsened.volume_in);
    let left = volume_outside(tree, &coarsened.cells);
    assert!(left <= 1e-13 * whole, "{left} of {whole} is in no cell");
    let union = Solid::from_tree(&Tree::union_of(coarsened.cells.clone())).volume().expect("bounded cells");
    assert!(near(coarsened.volume_out, union), "union {} is {union}", coarsened.volume_out);
    let sum: f64 = coarsened.cells.iter().map(volume).sum();
    assert!(near(coarsened.volume_sum_out, sum), "sum {} is {sum}", coarsened.volume_sum_out);
}
