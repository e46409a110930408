//! Models in groups against the same models at once.

use super::*;
use crate::evaluate::evaluate_with;
use crate::model::{Brush, Material, MaterialId, Tree};
use crate::plane_table::smallest_size;
use planecut_kernel::{DVec3, HalfSpace};

fn scattered(model: &Model, at_a_time: usize) -> Option<Evaluation> {
    let size = smallest_size(model.tree.brushes().iter().map(Brush::half_spaces));
    let (unbounded, others) = (UnboundedBrushes::Keep, OtherBrushes::alone(size));
    evaluate_some_at_a_time(model, unbounded, &BuiltBodies::default(), others, at_a_time).expect("a solid")
}

/// Its triangles by what they are, whatever their order and the numbers of their vertices.
fn area_by_normal(mesh: &Mesh) -> Vec<(String, f64)> {
    let mut areas: std::collections::BTreeMap<String, f64> = std::collections::BTreeMap::new();
    for (triangle, face) in mesh.triangles.iter().zip(&mesh.triangle_faces) {
        let [a, b, c] = triangle.map(|v| mesh.positions[v as usize]);
        let face = &mesh.faces[*face as usize];
        let key = format!("{:.6} {:?}", face.normal + DVec3::ZERO, face.material);
        *areas.entry(key).or_default() += 0.5 * (b - a).cross(c - a).dot(face.normal);
    }
    areas.into_iter().collect()
}

fn compare(model: &Model) -> Evaluation {
    let at_once = evaluate_with(model, UnboundedBrushes::Keep).expect("a solid");
    for at_a_time in [1, 9] {
        compare_with(model, &at_once, at_a_time);
    }
    compare_with(model, &at_once, BODIES_AT_A_TIME)
}

fn compare_with(model: &Model, at_once: &Evaluation, at_a_time: usize) -> Evaluation {
    let in_groups = scattered(model, at_a_time).expect("a bounded model");
    assert_eq!(in_groups.model.planes, at_once.model.planes);
    assert_eq!(in_groups.model.empty, at_once.model.empty);
    assert_eq!(in_groups.model.redundant_planes, at_once.model.redundant_planes);
    assert_eq!(in_groups.mesh.positions.len(), at_once.mesh.positions.len());
    assert_eq!(in_groups.mesh.triangles.len(), at_once.mesh.triangles.len());
    assert_eq!(in_groups.mesh.faces.len(), at_once.mesh.faces.len());
    let (p, q) = (&in_groups.solid, &at_once.solid);
    assert_eq!((p.min, p.max), (q.min, q.max));
    assert!((p.volume - q.volume).abs() <= 1e-12 * q.volume, "{p:?} {q:?}");
    assert!((p.area - q.area).abs() <= 1e-12 * q.area, "{p:?} {q:?}");
    assert!(p.centroid.distance(q.centroid) <= 1e-12 * q.max.abs().max(q.min.abs()).max_element(), "{p:?} {q:?}");
    for (p, q) in area_by_normal(&in_groups.mesh).iter().zip(&area_by_normal(&at_once.mesh)) {
        assert!(p.0 == q.0 && (p.1 - q.1).abs() <= 1e-9 * q.1, "{p:?} {q:?}");
    }
    let topology = planecut_check::check_topology(&in_groups.mesh.positions, &in_groups.mesh.triangles);
    assert!(topology.manifold, "{topology:?}");
    in_groups
}

fn random(mut state: u64) -> impl FnMut() -> f64 {
    move || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 40) as f64 / f64::from(1 << 24)
    }
}

fn model(tree: Tree) -> Model {
    Model { materials: vec![Material::named("a"), Material::named("b")], tree }
}

/// Boxes, some of them with corners cut off, some pointed ones whose tips have more than three faces, some empty.
fn brush(at: DVec3, random: &mut impl FnMut() -> f64) -> Brush {
    let size = DVec3::new(0.2 + random(), 0.2 + random(), 0.2 + random());
    let material = MaterialId(u32::from(random() < 0.5));
    let mut brush = Brush::cuboid(at, at + size, material);
    let mut cut = |normal: DVec3, beyond: f64| {
        let middle = normal.dot(at + 0.5 * size);
        let half_space = HalfSpace::new(normal, middle + beyond).expect("a plane");
        brush.faces.push(BrushFace { half_space, material });
    };
    match (random() * 5.0) as u32 {
        0 => cut(DVec3::ONE, 0.3),
        1 => DVec3::AXES[..2].iter().for_each(|axis| {
            cut(DVec3::Z + *axis, 0.25);
            cut(DVec3::Z - *axis, 0.25);
        }),
        2 if random() < 0.1 => cut(DVec3::Z, -10.0),
        _ => {}
    }
    brush
}

#[test]
fn groups_make_the_same_solid_as_all_at_once() {
    for seed in 1..60 {
        let mut random = random(seed);
        let spread = [2.0, 6.0, 20.0][seed as usize % 3];
        let place = |random: &mut dyn FnMut() -> f64| spread * DVec3::new(random(), random(), random());
        let mut part = || {
            let at = place(&mut random);
            let whole = Tree::from(brush(at, &mut random));
            match (random() * 6.0) as u32 {
                0 => whole - Tree::from(brush(at + 0.1, &mut random)),
                1 => whole & Tree::from(brush(at + 0.1, &mut random)),
                2 => whole ^ Tree::from(brush(at + 0.4, &mut random)),
                3 => whole.clone() | whole,
                _ => whole,
            }
        };
        let parts: Vec<Tree> = (0..60).map(|_| part()).collect();
        println!("seed {seed}");
        compare(&model(Tree::union(parts.clone())));
        compare(&model(Tree::union(parts[..40].iter().cloned()) - Tree::union(parts[40..].iter().cloned())));
    }
}

#[test]
fn separate_boxes_are_their_own_boundary() {
    let boxes = (0..1000_u32).map(|k| {
        let at = DVec3::new(f64::from(k % 10), f64::from(k / 10 % 10), f64::from(k / 100));
        Brush::cuboid(at * 1.5, at * 1.5 + 1.0, MaterialId(k % 2))
    });
    let made = compare(&model(Tree::union_of(boxes.collect())));
    assert_eq!((made.mesh.positions.len(), made.mesh.triangles.len(), made.mesh.faces.len()), (8000, 12000, 6000));
    assert_eq!((made.solid.volume, made.solid.area), (1000.0, 6000.0));
}

#[test]
fn the_order_of_brushes_does_not_matter() {
    let mut random = random(5);
    let brushes: Vec<Brush> =
        (0..200).map(|_| brush(8.0 * DVec3::new(random(), random(), random()), &mut random)).collect();
    let mut turned = brushes.clone();
    turned.rotate_left(77);
    turned.swap(3, 150);
    let mesh = |brushes: &[Brush], at_a_time| {
        scattered(&model(Tree::union_of(brushes.to_vec())), at_a_time).expect("a bounded model").mesh
    };
    for at_a_time in [20, BODIES_AT_A_TIME] {
        let (mesh, other) = (mesh(&brushes, at_a_time), mesh(&turned, at_a_time));
        assert_eq!(mesh.positions, other.positions);
        assert_eq!(mesh.triangles, other.triangles);
    }
}

#[test]
fn what_reaches_infinity_is_evaluated_at_once() {
    let block = Tree::from(Brush::cuboid(DVec3::ZERO, DVec3::ONE, MaterialId(0)));
    let half = Brush::from_half_spaces([HalfSpace::new(DVec3::X, 0.5).expect("a plane")], MaterialId(0));
    assert!(scattered(&model(block.clone() & half.into()), BODIES_AT_A_TIME).is_none());
    assert!(scattered(&model(!block), BODIES_AT_A_TIME).is_none());
}
