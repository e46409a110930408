//! The topology report against meshes of known shape and against counting by brute force.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;
use planecut_check::{CheckOptions, TopologyDefect, check_mesh, check_topology};
use planecut_testkit::random::Rng;

type Triangles = Vec<[u32; 3]>;

const TETRAHEDRON: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

fn tetrahedron(at: DVec3) -> Vec<DVec3> {
    [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|p| p + at).to_vec()
}

/// A closed grid surface, `columns × rows` quads wrapped around in both directions: a torus.
fn torus(columns: u32, rows: u32) -> (Vec<DVec3>, Triangles) {
    let angle = |i: u32, n: u32| f64::from(i) / f64::from(n) * std::f64::consts::TAU;
    let position = |i, j| {
        let (u, v) = (angle(i, columns), angle(j, rows));
        let ring = 3.0 + v.cos();
        DVec3::new(ring * u.cos(), ring * u.sin(), v.sin())
    };
    let at = |i: u32, j: u32| (i % columns) * rows + j % rows;
    let positions = (0..columns).flat_map(|i| (0..rows).map(move |j| position(i, j))).collect();
    let quads =
        (0..columns).flat_map(|i| (0..rows).map(move |j| [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]));
    (positions, quads.flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect())
}

/// Both meshes as one, without sharing vertices.
fn side_by_side(mut a: (Vec<DVec3>, Triangles), b: (Vec<DVec3>, Triangles)) -> (Vec<DVec3>, Triangles) {
    let shift = a.0.len() as u32;
    a.0.extend(b.0);
    a.1.extend(b.1.iter().map(|t| t.map(|v| v + shift)));
    a
}

#[test]
fn a_tetrahedron_is_sound_and_has_its_measures() {
    // Far away: the volume must not drown in the offset.
    let report = check_topology(&tetrahedron(DVec3::splat(1e6)), &TETRAHEDRON);
    assert!(report.watertight && report.manifold && report.first_defect.is_none());
    assert_eq!((report.vertices, report.edges, report.triangles, report.components), (4, 6, 4, 1));
    assert_eq!((report.euler_characteristic, report.genus), (2, Some(0)));
    assert!((report.measures.volume - 1.0 / 6.0).abs() < 1e-15);
    assert!((report.measures.area - (1.5 + 3f64.sqrt() / 2.0)).abs() < 1e-14);
    assert!(report.measures.centroid.map(|c| (c - 1e6 - 0.25).abs()).into_iter().fold(0.0, f64::max) < 1e-9);
    assert_eq!((report.measures.min, report.measures.max), ([1e6; 3], [1e6 + 1.0; 3]));
}

/// The empty solid has a boundary, too: nothing.
#[test]
fn the_empty_mesh_is_sound() {
    for positions in [vec![], tetrahedron(DVec3::ZERO)] {
        let report = check_mesh(&positions, &[], &CheckOptions::default());
        assert!(report.is_sound() && report.topology.watertight && report.topology.manifold, "{report}");
        assert_eq!((report.topology.components, report.topology.genus), (0, Some(0)));
        assert_eq!((report.topology.measures.volume, report.topology.measures.area), (0.0, 0.0));
    }
}

#[test]
fn turned_inside_out_the_volume_is_negative() {
    let turned = TETRAHEDRON.map(|[a, b, c]| [a, c, b]);
    let report = check_topology(&tetrahedron(DVec3::ZERO), &turned);
    assert!(report.manifold && (report.measures.volume + 1.0 / 6.0).abs() < 1e-15);
}

#[test]
fn genus_is_summed_over_components() {
    let (positions, triangles) =
        side_by_side(side_by_side(torus(7, 5), torus(12, 9)), (tetrahedron(DVec3::splat(9.0)), TETRAHEDRON.to_vec()));
    let report = check_topology(&positions, &triangles);
    assert!(report.manifold);
    assert_eq!((report.components, report.euler_characteristic, report.genus), (3, 2, Some(2)));
}

#[test]
fn each_defect_is_named() {
    let positions = tetrahedron(DVec3::ZERO);
    let defect = |positions: &[DVec3], triangles: &[[u32; 3]]| check_topology(positions, triangles).first_defect;

    assert_eq!(
        defect(&positions, &[[0, 1, 2], [0, 1, 4]]),
        Some(TopologyDefect::IndexOutOfRange { triangle: 1, index: 4, vertices: 4 })
    );
    let mut broken = positions.clone();
    broken[2].y = f64::NAN;
    assert_eq!(defect(&broken, &TETRAHEDRON), Some(TopologyDefect::NotFinite { vertex: 2 }));
    // Without the triangle 1 2 3 its neighbours run along its sides, in the opposite direction.
    assert_eq!(
        defect(&positions, &[TETRAHEDRON[0], TETRAHEDRON[1], TETRAHEDRON[3]]),
        Some(TopologyDefect::OpenEdge { a: 2, b: 1 })
    );
    let mut degenerate = TETRAHEDRON.to_vec();
    degenerate.push([1, 1, 2]);
    let report = check_topology(&positions, &degenerate);
    assert!(report.watertight && !report.manifold);
    assert_eq!(report.first_defect, Some(TopologyDefect::DegenerateTriangle { triangle: 4 }));
}

#[test]
fn solids_that_share_an_edge_or_a_vertex_are_watertight_but_not_manifold() {
    let (positions, triangles) = side_by_side(
        (tetrahedron(DVec3::ZERO), TETRAHEDRON.to_vec()),
        (tetrahedron(DVec3::splat(2.0)), TETRAHEDRON.to_vec()),
    );
    let glued = |map: &[(u32, u32)]| -> Triangles {
        let glue = |v: u32| map.iter().find(|(from, _)| *from == v).map_or(v, |(_, to)| *to);
        triangles.iter().map(|t| t.map(glue)).collect()
    };
    let at_vertex = check_topology(&positions, &glued(&[(4, 3)]));
    assert!(at_vertex.watertight && !at_vertex.manifold);
    assert_eq!(at_vertex.first_defect, Some(TopologyDefect::PinchedVertex { vertex: 3, fans: 2 }));
    assert_eq!((at_vertex.components, at_vertex.pinched_vertices, at_vertex.unused_vertices), (2, 1, 1));

    let at_edge = check_topology(&positions, &glued(&[(4, 3), (5, 2)]));
    assert!(at_edge.watertight && !at_edge.manifold);
    assert_eq!(at_edge.first_defect, Some(TopologyDefect::DuplicateEdge { a: 2, b: 3, uses: 2 }));
    assert_eq!((at_edge.components, at_edge.duplicate_edges), (1, 1));
}

/// Everything counted again with ordered sets, one definition at a time.
fn brute_force(triangles: &[[u32; 3]]) -> (bool, bool, usize, usize) {
    let mut uses: BTreeMap<(u32, u32), Vec<usize>> = BTreeMap::new();
    for (t, &[a, b, c]) in triangles.iter().enumerate() {
        [(a, b), (b, c), (c, a)].into_iter().for_each(|e| uses.entry(e).or_default().push(t));
    }
    let count = |a: u32, b: u32| uses.get(&(a, b)).map_or(0, Vec::len);
    let watertight = uses.keys().all(|&(a, b)| count(a, b) == count(b, a));
    let single = uses.keys().all(|&(a, b)| count(a, b) == 1 && count(b, a) == 1);
    let neighbours = |t: usize| {
        let [a, b, c] = triangles[t];
        [(a, b), (b, a), (b, c), (c, b), (c, a), (a, c)]
            .into_iter()
            .flat_map(|e| uses.get(&e).into_iter().flatten().copied())
            .collect::<BTreeSet<usize>>()
    };
    let flood = |members: &BTreeSet<usize>| {
        let mut left = members.clone();
        let mut parts = 0;
        while let Some(start) = left.pop_first() {
            parts += 1;
            let mut open = vec![start];
            while let Some(t) = open.pop() {
                open.extend(neighbours(t).into_iter().filter(|n| left.remove(n)));
            }
        }
        parts
    };
    // At a vertex every neighbour across an edge of one of its triangles counts, if it holds the vertex too: with single
    // edges and three or more triangles that is a neighbour across an edge at the vertex.
    let vertices: BTreeSet<u32> = triangles.iter().flatten().copied().collect();
    let one_fan = vertices.iter().all(|v| {
        let around: BTreeSet<usize> = (0..triangles.len()).filter(|&t| triangles[t].contains(v)).collect();
        flood(&around) == 1
    });
    let edges = uses.keys().map(|&(a, b)| (a.min(b), a.max(b))).collect::<BTreeSet<_>>().len();
    (watertight, single && one_fan, flood(&(0..triangles.len()).collect()), edges)
}

#[test]
fn random_gluings_agree_with_brute_force() {
    let seed = 0x5eed_1001;
    let mut random = Rng::new(seed);
    let mut below = |n: usize| random.below(n);
    let mut kinds = BTreeSet::new();
    for case in 0..3000 {
        // A torus and a tetrahedron with a few vertices identified and sometimes a triangle dropped or turned.
        let (positions, mut triangles) = side_by_side(torus(4, 4), (tetrahedron(DVec3::ZERO), TETRAHEDRON.to_vec()));
        for _ in 0..below(3) {
            let (from, to) = (below(positions.len()) as u32, below(positions.len()) as u32);
            triangles.iter_mut().flatten().filter(|v| **v == from).for_each(|v| *v = to);
        }
        if below(4) == 0 {
            triangles.swap_remove(below(triangles.len()));
        }
        if below(4) == 0 {
            let turned = below(triangles.len());
            triangles[turned].swap(0, 1);
        }
        triangles.retain(|[a, b, c]| a != b && b != c && c != a);
        let (watertight, manifold, components, edges) = brute_force(&triangles);
        let report = check_topology(&positions, &triangles);
        let found = (report.watertight, report.manifold, report.components, report.edges);
        assert_eq!(found, (watertight, manifold, components, edges), "seed {seed:#x} case {case}: {triangles:?}");
        assert_eq!(report.manifold, report.first_defect.is_none());
        kinds.insert((watertight, manifold));
    }
    assert_eq!(kinds.len(), 3, "all combinations occur: {kinds:?}");
}

#[test]
fn the_report_prints_as_one_line() {
    let options = CheckOptions::default();
    let sound = check_mesh(&tetrahedron(DVec3::ZERO), &TETRAHEDRON, &options);
    assert_eq!(sound.to_string(), "watertight, manifold, not self-crossing");
    assert!(sound.is_sound());
    let open = check_mesh(&tetrahedron(DVec3::ZERO), &TETRAHEDRON[..3], &options);
    assert_eq!(open.to_string(), "open edge from vertex 0 to vertex 2");
    let unusable = check_mesh::<[f64; 3]>(&[], &TETRAHEDRON, &options);
    assert!(!unusable.is_sound() && unusable.crossings.is_none());
}
