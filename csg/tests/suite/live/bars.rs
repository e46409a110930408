//! Bars through a block, one after another: faces with very many brushes near them, and lines on which very many edges lie.

use planecut_csg::{Brush, BrushId, LiveModel, Material, MaterialId, Role, evaluate};
use planecut_kernel::DVec3;

/// The sides of the block, a power of three so that all planes are exact.
const SIDE: f64 = 27.0;

/// The bars of a Menger sponge of some levels, along each axis.
fn bars(levels: u32) -> Vec<Brush> {
    let mut bars = Vec::new();
    for count in (1..=levels).map(|level| 3_u32.pow(level)) {
        let width = SIDE / f64::from(count);
        let middle = |k: &u32| k % 3 == 1;
        for (i, j) in (0..count).filter(middle).flat_map(|i| (0..count).filter(middle).map(move |j| (i, j))) {
            for axis in 0..3 {
                let (mut min, mut max) = (DVec3::splat(-1.0), DVec3::splat(SIDE + 1.0));
                for (k, place) in [(1, i), (2, j)] {
                    min[(axis + k) % 3] = width * f64::from(place);
                    max[(axis + k) % 3] = width * f64::from(place + 1);
                }
                bars.push(Brush::cuboid(min, max, MaterialId(0)));
            }
        }
    }
    bars
}

fn check(live: &LiveModel, step: &str) {
    let fresh = evaluate(&live.to_model()).unwrap().mesh;
    assert_eq!(live.triangle_count(), fresh.triangles.len(), "{step}");
    assert!(live.mesh().unwrap() == fresh, "{step}: the mesh is another than that of a fresh build");
}

#[test]
fn bars_of_a_menger_sponge_come_and_go_one_by_one() {
    let mut live = LiveModel::new(vec![Material::named("stone")]);
    live.add_brush(Brush::cuboid(DVec3::ZERO, DVec3::splat(SIDE), MaterialId(0)), Role::Add).unwrap();
    let bars = bars(2);
    let count = bars.len() as u64;
    for (k, bar) in bars.into_iter().enumerate() {
        live.add_brush(bar, Role::Subtract).unwrap();
        check(&live, &format!("bar {k} added"));
    }
    let of_sponge = (20.0_f64 / 27.0).powi(2) * SIDE.powi(3);
    assert!((live.measures().volume - of_sponge).abs() < 1e-9 * of_sponge);
    // 7 and the number of bars have no divisor in common
    for k in 0..count {
        live.remove_brush(BrushId(1 + k * 7 % count)).unwrap();
        check(&live, &format!("bar {k} removed"));
    }
    assert_eq!(live.faces().count(), 6);
}

#[test]
fn bars_between_others_come_and_go_in_a_row_of_very_many() {
    let mut live = LiveModel::new(vec![Material::named("stone")]);
    live.add_brush(Brush::cuboid(DVec3::ZERO, DVec3::new(101.0, 3.0, 1.0), MaterialId(0)), Role::Add).unwrap();
    let slot = |k: u32, depth: f64| {
        let at = f64::from(2 * k + 1);
        Brush::cuboid(DVec3::new(at, -1.0, -1.0), DVec3::new(at + 1.0, depth, 2.0), MaterialId(0))
    };
    let slots: Vec<(Brush, Role)> = (0..50).map(|k| (slot(k, 1.0), Role::Subtract)).collect();
    let (slots, _) = live.add_brushes(slots).unwrap();
    check(&live, "slots");
    for k in [0, 49, 24, 25, 7] {
        live.remove_brush(slots[k as usize]).unwrap();
        check(&live, &format!("slot {k} closed"));
        let (again, _) = live.add_brush(slot(k, 2.0), Role::Subtract).unwrap();
        check(&live, &format!("slot {k} deeper"));
        live.set_role(again, Role::Add).unwrap();
        check(&live, &format!("slot {k} filled"));
    }
    while live.undo().is_ok() {}
    assert_eq!(live.faces().count(), 0);
}
