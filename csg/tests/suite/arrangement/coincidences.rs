//! Meshes that touch, lie upon one another, are doubled, flat, or nested; and the identities of set algebra.

use std::f64::consts::TAU;

use glam::DVec3;
use planecut_check::{CheckOptions, check_mesh};
use planecut_csg::{Brush, Transform, Tree, WindingRule, evaluate};
use planecut_csg::{ClosedMesh, ClosedMeshError, Evaluation, Material, MaterialId, MeshBody, Model};

use super::integers::Convex;
use planecut_testkit::random::Rng;

fn body(corners: &[DVec3], triangles: &[[u32; 3]]) -> MeshBody {
    let mesh = ClosedMesh::new(corners, triangles, |_| 0).unwrap_or_else(|error| panic!("{error}"));
    MeshBody::new(mesh, vec![MaterialId(0)])
}

/// On a grid, so that turned and mirrored copies coincide exactly.
fn on_grid(corners: impl IntoIterator<Item = DVec3>) -> Vec<DVec3> {
    corners.into_iter().map(|corner| (corner * 1024.0).round() / 1024.0 + 0.0).collect()
}

/// A ring whose section is a regular polygon; none of its quadrangles is flat.
fn torus(around: u32, section: u32) -> MeshBody {
    let corner = |k: u32| {
        let (u, v) = (f64::from(k / section) / f64::from(around), f64::from(k % section) / f64::from(section));
        let ((s, c), (sv, cv)) = ((TAU * u).sin_cos(), (TAU * v).sin_cos());
        DVec3::new((3.0 + cv) * c, (3.0 + cv) * s, sv)
    };
    let corners = on_grid((0..around * section).map(corner));
    let at = |i: u32, j: u32| (i % around) * section + j % section;
    let quads =
        (0..around).flat_map(|i| (0..section).map(move |j| [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]));
    let triangles: Vec<[u32; 3]> = quads.flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    body(&corners, &triangles)
}

/// An outline, star-shaped around its first corner, between two heights.
fn prism(outline: &[(f64, f64)], low: f64, high: f64) -> MeshBody {
    let count = u32::try_from(outline.len()).expect("few corners");
    let corners: Vec<DVec3> =
        [low, high].iter().flat_map(|z| outline.iter().map(|(x, y)| DVec3::new(*x, *y, *z))).collect();
    let lid = (1..count - 1).map(|k| [0, k, k + 1]);
    let mut triangles: Vec<[u32; 3]> = lid.clone().map(|[a, b, c]| [c, b, a]).collect();
    triangles.extend(lid.map(|triangle| triangle.map(|corner| corner + count)));
    for k in 0..count {
        let next = (k + 1) % count;
        triangles.extend([[k, next, next + count], [k, next + count, k + count]]);
    }
    body(&corners, &triangles)
}

/// A gear whose lids are fans around its axis.
fn gear(teeth: u32) -> MeshBody {
    let count = 4 * teeth;
    let corner = |k: u32, z: f64| {
        let (s, c) = (TAU * f64::from(k) / f64::from(count)).sin_cos();
        let radius = if k % 4 < 2 { 3.5 } else { 2.75 };
        DVec3::new(radius * c, radius * s, z)
    };
    let mut corners = on_grid([-0.5, 0.5].into_iter().flat_map(|z| (0..count).map(move |k| corner(k, z))));
    corners.extend([DVec3::Z * -0.5, DVec3::Z * 0.5]);
    let mut triangles = Vec::new();
    for k in 0..count {
        let next = (k + 1) % count;
        triangles.extend([[k, next, next + count], [k, next + count, k + count]]);
        triangles.extend([[next, k, 2 * count], [k + count, next + count, 2 * count + 1]]);
    }
    body(&corners, &triangles)
}

fn l_shape() -> MeshBody {
    prism(&[(1.0, 1.0), (1.0, 2.0), (0.0, 2.0), (0.0, 0.0), (2.0, 0.0), (2.0, 1.0)], 0.0, 1.0)
}

fn moved(body: &MeshBody, transform: &Transform) -> MeshBody {
    body.clone().transformed(transform).expect("it stays in range")
}

fn shifted(body: &MeshBody, by: DVec3) -> MeshBody {
    moved(body, &Transform::translation(by).expect("finite"))
}

#[track_caller]
fn outcome(tree: Tree) -> Evaluation {
    let materials = vec![Material::named("stone"), Material::named("brass")];
    let found = evaluate(&Model { materials, tree }).unwrap_or_else(|error| panic!("{error}"));
    if !found.mesh.triangles.is_empty() {
        let report = check_mesh(&found.mesh.positions, &found.mesh.triangles, &CheckOptions::default());
        assert!(report.is_sound(), "{report}");
    }
    found
}

fn close(what: &str, found: f64, expected: f64, size: f64) {
    assert!((found - expected).abs() <= 1e-12 * size, "{what}: found {found:?}, expected {expected:?}");
}

/// The identities of two bodies.
#[track_caller]
fn identities(what: &str, a: &MeshBody, b: &MeshBody) {
    let [p, q] = [a, b].map(|body| Tree::from(body.clone()));
    let alone = [&p, &q].map(|tree| outcome(tree.clone()).solid);
    let size = alone[0].volume + alone[1].volume + alone[0].area + alone[1].area;
    let both = outcome(p.clone() & q.clone()).solid;
    let either = outcome(p.clone() | q.clone()).solid;
    let less = outcome(p.clone() - q.clone()).solid;
    let apart = outcome(p.clone() ^ q.clone()).solid;
    close(what, both.volume + either.volume, alone[0].volume + alone[1].volume, size);
    close(what, less.volume + both.volume, alone[0].volume, size);
    close(what, apart.volume + both.volume, either.volume, size);
    let whole = outcome((p.clone() - q.clone()) | (p.clone() & q.clone())).solid;
    close(what, whole.volume, alone[0].volume, size);
    close(what, whole.area, alone[0].area, size);
    let back = outcome((p.clone() ^ q.clone()) ^ q).solid;
    close(what, back.volume, alone[0].volume, size);
    close(what, back.area, alone[0].area, size);
}

#[test]
fn identities_of_bodies_that_coincide() {
    let quarter = Transform::rotation(DVec3::Z, 90.0).expect("an axis");
    let tilted = Transform::rotation(DVec3::X, 90.0).expect("an axis");
    let odd = Transform::rotation(DVec3::new(1.0, 2.0, 3.0), 37.0).expect("an axis");
    for (name, a) in [("torus", torus(16, 8)), ("gear", gear(9)), ("L", l_shape())] {
        identities(name, &a, &a);
        for (turn, name_of_turn) in [(&quarter, "quarter"), (&tilted, "tilted"), (&odd, "odd")] {
            identities(&format!("{name}, {name_of_turn}"), &a, &moved(&a, turn));
        }
        for axis in DVec3::AXES {
            let mirror = Transform::scale(DVec3::ONE - 2.0 * axis).expect("no factor is zero");
            identities(&format!("{name}, mirrored along {axis}"), &a, &moved(&a, &mirror));
            identities(&format!("{name}, moved along {axis}"), &a, &shifted(&a, axis));
            identities(&format!("{name}, moved a bit along {axis}"), &a, &shifted(&a, axis * 1e-6));
        }
        identities(name, &a, &gear(8));
        identities(name, &a, &torus(12, 6));
    }
}

#[test]
fn mirror_images_are_mirrored_solids() {
    let materials = || vec![Material::named("stone")];
    for a in [torus(16, 8), gear(9), l_shape()] {
        let plain = outcome(a.clone().into()).solid;
        let mirror = Transform::scale(DVec3::new(-1.0, 1.0, 1.0)).expect("no factor is zero");
        let once = moved(&a, &mirror);
        assert!(once.is_mirrored() && !moved(&once, &mirror).is_mirrored());
        let image = outcome(once.clone().into()).solid;
        close("volume", image.volume, plain.volume, plain.volume);
        close("area", image.area, plain.area, plain.area);
        assert_eq!((image.min.x, image.max.x), (-plain.max.x, -plain.min.x));
        let twice = Model { materials: materials(), tree: moved(&once, &mirror).into() };
        assert_eq!(evaluate(&twice).expect("a solid").mesh, outcome_of(a, materials()).mesh);
    }
}

fn outcome_of(body: MeshBody, materials: Vec<Material>) -> Evaluation {
    evaluate(&Model { materials, tree: body.into() }).expect("a solid")
}

#[test]
fn l_shapes_that_touch() {
    let l = l_shape();
    let (volume, area) = (3.0, 14.0);
    // over a face, along an edge, in a corner; and what is hidden of the surfaces
    for (by, hidden) in [
        (DVec3::new(2.0, 0.0, 0.0), 2.0),
        (DVec3::new(0.0, 0.0, 1.0), 6.0),
        (DVec3::new(1.0, 1.0, 0.0), 4.0),
        (DVec3::new(2.0, 1.0, 0.0), 0.0),
        (DVec3::new(2.0, 2.0, 0.0), 0.0),
        (DVec3::new(2.0, 1.0, 1.0), 0.0),
        (DVec3::new(1.0, 0.0, 1.0), 2.0),
    ] {
        let other = shifted(&l, by);
        let both = outcome(Tree::from(l.clone()) | other.clone().into());
        assert_eq!(both.solid.volume, 2.0 * volume, "{by}");
        assert_eq!(both.solid.area, 2.0 * area - hidden, "{by}");
        assert_eq!(outcome(Tree::from(l.clone()) & other.clone().into()).mesh.triangles.len(), 0, "{by}");
        assert_eq!(outcome(Tree::from(l.clone()) - other.into()).solid.volume, volume, "{by}");
    }
}

/// A box one of whose edges is divided on one side alone: closed by a triangle without an area.
#[test]
fn triangles_without_an_area_and_corners_on_edges() {
    let cube = Convex::cuboid(DVec3::ZERO, DVec3::splat(2.0));
    let mut corners = cube.corners.clone();
    let mut triangles: Vec<[u32; 3]> =
        cube.faces.iter().flat_map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]]).collect();
    // corner 8 on the edge of corners 0 and 1, in the triangle from 1 to 0; the gap is a sliver of no area
    corners.push(DVec3::X);
    let at = triangles.iter().position(|t| (0..3).any(|k| t[k] == 0 && t[(k + 1) % 3] == 1)).expect("an edge");
    let k = (0..3).find(|k| triangles[at][*k] == 0).expect("a corner");
    let top = triangles[at][(k + 2) % 3];
    triangles[at] = [0, 8, top];
    triangles.push([8, 1, top]);
    let error = ClosedMesh::new(&corners, &triangles, |_| 0).expect_err("a corner on an edge");
    assert!(matches!(error, ClosedMeshError::Open { count: 3, .. }), "{error}");
    triangles.push([0, 1, 8]);
    let flat = body(&corners, &triangles);
    let plain = cube.mesh(&mut Rng::new(9));
    assert_eq!(outcome(flat.clone().into()).solid.volume, 8.0);
    assert_eq!(outcome(flat.clone().into()).solid.area, 24.0);
    for tree in [Tree::from(flat.clone()) - plain.clone().into(), Tree::from(plain.clone()) - flat.clone().into()] {
        assert_eq!(outcome(tree).mesh.triangles.len(), 0);
    }
    // the corner on the edge on a corner of another, on its edge, in its face
    for by in [DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::new(0.0, 1.0, 1.0), DVec3::new(0.5, 0.0, 2.0)] {
        identities("flat triangle", &flat, &shifted(&plain, by));
        identities("flat triangle", &shifted(&flat, by), &flat);
    }
}

/// Slivers far longer than wide, in a fan; cut across, and along by a turned copy.
#[test]
fn slivers() {
    let mut outline: Vec<(f64, f64)> =
        (0..40).map(|k| (1e3 * f64::from(k), 1e-6 * f64::from(k) * f64::from(k - 39) - 1.0)).collect();
    outline.extend([(39e3, 0.0), (0.0, 0.0)]);
    let needle = prism(&outline, 0.0, 1e-3);
    for by in [DVec3::new(500.0, 0.0, 0.0), DVec3::new(0.0, 1e-7, 0.0), DVec3::new(1e3, 0.0, 5e-4)] {
        identities("slivers", &needle, &shifted(&needle, by));
    }
}

/// The least and greatest coordinate of a cube, and whether it is inside out.
type Shell = (f64, f64, bool);

/// Nested and doubled shells under each rule: a wall of winding number 1 around a room of 2, and a void.
#[test]
fn shells_and_rules() {
    let shells = |list: &[Shell]| {
        let (mut corners, mut triangles) = (Vec::new(), Vec::new());
        for (low, high, is_turned) in list {
            let first = u32::try_from(corners.len()).expect("few corners");
            let mesh = Convex::cuboid(DVec3::splat(*low), DVec3::splat(*high)).mesh(&mut Rng::new(1));
            corners.extend(mesh.positions().iter());
            let turned = |[a, b, c]: [u32; 3]| if *is_turned { [b, a, c] } else { [a, b, c] };
            triangles.extend(mesh.triangles().iter().map(|t| turned(t.map(|corner| corner + first))));
        }
        body(&corners, &triangles)
    };
    use WindingRule::{NonZero, Odd, Positive};
    let cases: [(&[Shell], [f64; 3]); 5] = [
        (&[(0.0, 4.0, false), (1.0, 3.0, true)], [56.0, 56.0, 56.0]),
        (&[(0.0, 4.0, false), (1.0, 3.0, false)], [64.0, 64.0, 56.0]),
        (&[(0.0, 4.0, false), (0.0, 4.0, false)], [64.0, 64.0, 0.0]),
        (&[(0.0, 4.0, false), (0.0, 4.0, true)], [0.0, 0.0, 0.0]),
        (&[(0.0, 4.0, true), (1.0, 3.0, true)], [0.0, 64.0, 56.0]),
    ];
    for (k, (list, volumes)) in cases.into_iter().enumerate() {
        for (rule, volume) in [Positive, NonZero, Odd].into_iter().zip(volumes) {
            let solid = shells(list).with_rule(rule);
            assert_eq!(outcome(solid.clone().into()).solid.volume, volume, "case {k}, {rule:?}");
            let half: Brush = Convex::cuboid(DVec3::splat(-1.0), DVec3::new(2.0, 5.0, 5.0)).brush();
            let cut = outcome(Tree::from(solid) & half.into()).solid.volume;
            assert_eq!(cut, volume / 2.0, "half of case {k}, {rule:?}");
        }
    }
}
