//! The outline against [`Truth`](crate::truth::Truth), [`Solid`](crate::solid::Solid) and
//! [`Edges`](crate::edges::Edges), which share no decision with it.

use super::Outline;
use crate::category::Category;
use crate::edges::Edges;
use crate::exact::Coefficients;
use crate::random::Rng;
use crate::script::{Op, as_adds_and_removes};
use crate::solid::Solid;
use crate::truth::Truth;

const OCTANT: [Coefficients; 3] = [[-1.0, 0.0, 0.0, 0.0], [0.0, -1.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.0]];

fn counts(planes: &[Coefficients]) -> (bool, bool, usize, usize, usize) {
    let outline = Outline::of(planes);
    (outline.empty, outline.bounded, outline.vertices.len(), outline.edges, outline.faces)
}

#[test]
fn open_sets() {
    assert_eq!(counts(&[]), (false, false, 0, 0, 0));
    assert_eq!(counts(&OCTANT[..1]), (false, false, 0, 0, 1));
    assert_eq!(counts(&OCTANT[..2]), (false, false, 0, 1, 2));
    assert_eq!(counts(&OCTANT), (false, false, 1, 3, 3));
    assert_eq!(counts(&[OCTANT[0], [1.0, 0.0, 0.0, 2.0]]), (false, false, 0, 0, 2));
    assert_eq!(counts(&[OCTANT[0], [1.0, 0.0, 0.0, 2.0], OCTANT[1]]), (false, false, 0, 2, 3));
}

#[test]
fn flat_and_contradicting_sets_are_empty() {
    assert_eq!(counts(&[OCTANT[0], [1.0, 0.0, 0.0, 0.0]]), (true, true, 0, 0, 0));
    assert_eq!(counts(&[OCTANT[0], [1.0, 0.0, 0.0, -1.0]]), (true, true, 0, 0, 0));
    assert_eq!(counts(&[OCTANT[0], OCTANT[1], OCTANT[2], [1.0, 1.0, 1.0, 0.0]]), (true, true, 0, 0, 0));
}

#[test]
fn agrees_with_the_slow_oracle() {
    let mut rng = Rng::new(7);
    let mut compared = 0;
    for category in Category::ALL {
        for _ in 0..4 {
            let mut live: Vec<(usize, Coefficients)> = Vec::new();
            for op in as_adds_and_removes(&category.script(&mut rng, 8)) {
                match op {
                    Op::Add { name, plane } => live.push((name, plane)),
                    Op::Remove { name } => live.retain(|(n, _)| *n != name),
                    other => panic!("{other:?}"),
                }
                let planes: Vec<Coefficients> = live.iter().map(|(_, plane)| *plane).collect();
                compare(&planes);
                compared += 1;
            }
        }
    }
    assert!(compared > 1_000, "only {compared}");
}

fn compare(planes: &[Coefficients]) {
    let (outline, truth) = (Outline::of(planes), Truth::of(planes));
    assert_eq!((outline.empty, outline.bounded), (truth.empty, truth.bounded), "{planes:?}");
    if truth.empty {
        return;
    }
    let edges = Edges::of(planes);
    assert_eq!(outline.edges, edges.count, "{planes:?}");
    assert_eq!(outline.vertices.len(), edges.finite_ends.len(), "{planes:?}");
    if truth.bounded {
        let solid = Solid::of(planes);
        assert_eq!(outline.faces, solid.facets.len(), "{planes:?}");
        for vertex in &solid.vertices {
            let corner = outline.vertices.iter().find(|c| c.planes == vertex.planes).expect("the same vertices");
            assert_eq!(corner.position, vertex.position.each_ref().map(|c| c.to_f64().value()));
        }
    }
}
