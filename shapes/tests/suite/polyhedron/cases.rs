//! Surfaces that are easily forgotten.

use glam::DVec3;
use planecut_csg::{Brush, Material, MaterialId, Model, PlaneTable, Tree, evaluate};
use planecut_kernel::HalfSpace;
use planecut_shapes::polyhedron::Precision;

use super::judge::{Given, cube, ensure_membership, ensure_skin, evaluated, prism};

fn splat(low: f64, high: f64) -> Given {
    cube(DVec3::splat(low), DVec3::splat(high))
}

#[test]
fn a_cavity_and_a_body_within_it() {
    let given = splat(0.0, 5.0).and(&splat(1.0, 4.0).turned()).and(&splat(2.0, 3.0));
    let solid = given.cells(Precision::Double).expect("closed shells");
    assert_eq!(solid.volume, 125.0 - 27.0 + 1.0);
    ensure_membership(&given, &solid.cells, 500, 1e-9).expect("the membership of the shells");
    assert_eq!(ensure_skin(&solid.cells, solid.volume, 1e-9), Ok((3, Some(0))));
    assert_eq!(solid.cells.len(), 7);
}

#[test]
fn a_surface_that_is_inside_out_is_turned() {
    let solid = splat(-1.0, 1.0).turned().cells(Precision::Double).expect("a closed surface");
    assert!(solid.is_turned);
    assert_eq!((solid.volume, solid.cells.len()), (8.0, 1));
    assert_eq!(evaluated(&solid.cells).solid.volume, 8.0);
}

#[test]
fn facets_that_are_not_convex() {
    // a comb: its ends are polygons with many reflex corners
    let teeth = 12;
    let mut outline = vec![[0.0, -1.0], [2.0 * f64::from(teeth), -1.0]];
    for k in (0..teeth).map(f64::from).map(|k| 2.0 * k).collect::<Vec<_>>().into_iter().rev() {
        outline.extend([[k + 2.0, 3.0], [k + 1.0, 3.0], [k + 1.0, 0.0], [k, 0.0]]);
    }
    let given = prism(&outline, 1.5);
    let solid = given.cells(Precision::Double).expect("a closed surface");
    assert!((solid.volume - given.volume()).abs() < 1e-9);
    assert_eq!((solid.bent_facets, solid.cells.len()), (0, teeth as usize + 1));
    assert_eq!(ensure_skin(&solid.cells, given.volume(), 1e-9), Ok((1, Some(0))));
}

#[test]
fn facets_that_are_not_planar_are_cut() {
    let mut given = splat(0.0, 1.0);
    given.points[7] = DVec3::new(1.0, 1.0, 1.5);
    let solid = given.cells(Precision::Double).expect("a closed surface");
    assert_eq!(solid.bent_facets, 1);
    // the plane through three corners of the top, or two that meet along its other diagonal
    let volumes = [1.0 + 0.5 / 6.0, 1.0 + 2.0 * 0.5 / 6.0];
    assert!(volumes.iter().any(|v| (v - solid.volume).abs() < 1e-12), "{}", solid.volume);
}

#[test]
fn points_given_twice_and_facets_without_area() {
    // every facet has points of its own, and there are facets of a line, of a point, and with a point twice in a row
    let whole = splat(0.0, 2.0);
    let mut given = Given::default();
    for facet in &whole.facets {
        let first = given.points.len() as u32;
        given.points.extend(facet.iter().map(|v| whole.points[*v as usize]));
        given.facets.push(vec![first, first + 1, first + 1, first + 2, first + 3, first]);
    }
    given.facets.extend([vec![0, 0, 0], vec![0, 1, 0], vec![2], vec![]]);
    let solid = given.cells(Precision::Double).expect("a closed surface");
    assert_eq!((solid.volume, solid.cells.len(), solid.cells[0].faces.len()), (8.0, 1, 6));
}

#[test]
fn a_corner_on_an_edge_of_a_neighbour_is_a_corner_of_both() {
    // the top is cut at the middle of an edge: the front has five corners there, three of them on a line
    let mut given = splat(0.0, 2.0);
    given.points.push(DVec3::new(1.0, 0.0, 2.0));
    given.facets[1] = vec![4, 8, 7, 6];
    given.facets.push(vec![8, 5, 7]);
    given.facets[2] = vec![0, 1, 5, 8, 4];
    let solid = given.cells(Precision::Double).expect("a closed surface");
    assert_eq!((solid.volume, solid.cells.len(), solid.cells[0].faces.len()), (8.0, 1, 6));
}

/// The box with a point on an edge, off it by some noise, that only the front has; a sliver on top closes the gap. Where the
/// point lies inward, the sliver is folded over.
fn box_with_a_sliver(noise: f64) -> Given {
    let mut given = splat(0.0, 2.0);
    given.points.push(DVec3::new(1.0, noise, 2.0));
    given.facets[2] = vec![0, 1, 5, 8, 4];
    given.facets.push(vec![4, 8, 5]);
    given
}

#[test]
fn slivers_that_are_folded_over_do_no_harm() {
    let cases = [(1e-17, Precision::Double), (-1e-17, Precision::Double), (3e-8, Precision::Single)];
    for (noise, precision) in cases {
        let solid = box_with_a_sliver(noise).cells(precision).unwrap_or_else(|error| panic!("{noise}: {error}"));
        assert!((solid.volume - 8.0).abs() < 1e-6, "{noise}: {}", solid.volume);
        assert_eq!((solid.cells.len(), solid.cells[0].faces.len()), (1, 6), "{noise}");
    }
}

#[test]
fn frames_have_a_handle() {
    let outer = cube(DVec3::new(0.0, 0.0, 0.0), DVec3::new(4.0, 4.0, 1.0));
    let inner = cube(DVec3::new(1.0, 1.0, 0.0), DVec3::new(3.0, 3.0, 1.0)).turned();
    let mut given = Given::default().and(&outer).and(&inner);
    // the bottom and the top with a hole, as four facets each
    given.facets.retain(|facet| facet.iter().any(|v| v & 4 == 0) && facet.iter().any(|v| v & 4 == 4));
    let ring = [0u32, 1, 3, 2];
    for k in 0..4 {
        let (a, b) = (ring[k], ring[(k + 1) % 4]);
        given.facets.push(vec![b, a, a + 8, b + 8]);
        given.facets.push(vec![a + 4, b + 4, b + 12, a + 12]);
    }
    let solid = given.cells(Precision::Double).expect("a closed surface");
    assert_eq!((solid.volume, solid.cells.len()), (12.0, 4));
    assert_eq!(ensure_skin(&solid.cells, 12.0, 1e-12), Ok((1, Some(1))));
}

#[test]
fn small_far_and_large_surfaces() {
    let outline = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];
    for (scale, shift) in [(1e-9, 0.0), (1e9, 0.0), (1.0, 1e4), (1e-20, 0.0), (1e20, 0.0)] {
        let given = prism(&outline, 1.0).moved(|p| p * scale + shift);
        let solid = given.cells(Precision::Double).unwrap_or_else(|error| panic!("{scale} {shift}: {error}"));
        let volume = 5.0 * f64::powi(scale, 3);
        assert!((solid.volume / volume - 1.0).abs() < 1e-9, "{scale} {shift}: {}", solid.volume);
        assert_eq!(solid.cells.len(), 2, "{scale} {shift}");
    }
}

#[test]
fn planes_along_the_axes_are_exact() {
    // decimals: the plane must be that of a box with the same corner
    let (low, high) = (DVec3::new(0.1, 0.2, 0.3), DVec3::new(0.7, 1.1, 2.3));
    let solid = cube(low, high).cells(Precision::Double).expect("a closed surface");
    let mut planes: Vec<HalfSpace> = solid.cells[0].faces.iter().map(|face| face.half_space).collect();
    assert_eq!(planes.len(), 6);
    planes.extend(Brush::cuboid(low, high, MaterialId(0)).faces.iter().map(|face| face.half_space));
    let (table, _) = PlaneTable::intern(&planes, 0.0);
    assert_eq!((table.len(), table.snapped()), (6, 0));
}

#[test]
fn touching_solids_unite_without_a_wall() {
    let solid = splat(0.0, 1.0).and(&cube(DVec3::new(1.0, 0.0, 0.0), DVec3::new(2.0, 1.0, 1.0)));
    let solid = solid.cells(Precision::Double).expect("two surfaces that touch");
    let model = Model { materials: vec![Material::default()], tree: Tree::from(solid) };
    assert_eq!(evaluate(&model).expect("a solid").mesh.faces.len(), 6);
}

/// The cubes of a part can bar each other from being seen as convex, until one of them is taken.
#[test]
fn a_lump_that_stood_in_the_way_of_others() {
    let is_hole = |mut u: u32, mut v: u32| {
        (0..3).any(|_| {
            let is_middle = u % 3 == 1 && v % 3 == 1;
            (u, v) = (u / 3, v / 3);
            is_middle
        })
    };
    let holes: Vec<[u32; 2]> = (0..27 * 27).map(|k| [k % 27, k / 27]).filter(|[u, v]| is_hole(*u, *v)).collect();
    let bars = (0..3).flat_map(|axis| holes.iter().map(move |hole| (axis, hole))).map(|(axis, [u, v])| {
        let (mut low, mut high) = (DVec3::splat(-1.0), DVec3::splat(28.0));
        for (place, at) in [((axis + 1) % 3, f64::from(*u)), ((axis + 2) % 3, f64::from(*v))] {
            (low[place], high[place]) = (at, at + 1.0);
        }
        Tree::from(Brush::cuboid(low, high, MaterialId(0)))
    });
    let block = Tree::from(Brush::cuboid(DVec3::ZERO, DVec3::splat(27.0), MaterialId(0)));
    let tree = Tree::difference(std::iter::once(block).chain(bars));
    let sponge = evaluate(&Model { materials: vec![Material::default()], tree }).expect("a bounded solid");
    let solid = planecut_shapes::polyhedron::polyhedron(
        &sponge.mesh.positions,
        &sponge.mesh.triangles,
        &[MaterialId(0)],
        &planecut_shapes::polyhedron::PolyhedronOptions::default(),
    );
    assert_eq!(solid.map(|solid| solid.volume), Ok(8000.0));
}
