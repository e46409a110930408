//! The check of any mesh: a sound one, an open one, and two that cross.

use planecut_check::{CheckOptions, CheckReport, TopologyDefect, check_mesh};

const TETRAHEDRON: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

pub(crate) fn check() {
    let apart = tetrahedra(2.0);
    assert!(apart.is_sound() && apart.topology.components == 2);
    let crossing = tetrahedra(0.25).crossings.expect("the data is usable");
    assert!(crossing.triangles > 0);
    let open = check_mesh(&corners(0.0), &TETRAHEDRON[..3], &CheckOptions::default());
    assert_eq!(open.topology.first_defect, Some(TopologyDefect::OpenEdge { a: 0, b: 2 }));
}

fn corners(at: f64) -> [[f64; 3]; 4] {
    [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|corner| corner.map(|x| x + at))
}

/// The report on two tetrahedra, the second one moved along the diagonal.
fn tetrahedra(moved: f64) -> CheckReport {
    let positions = [corners(0.0), corners(moved)].concat();
    let triangles = [TETRAHEDRON, TETRAHEDRON.map(|triangle| triangle.map(|corner| corner + 4))].concat();
    check_mesh(&positions, &triangles, &CheckOptions::default())
}
