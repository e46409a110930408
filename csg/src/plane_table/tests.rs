//! Tables of planes: what is one plane, what is snapped, and that the order does not matter.

use super::*;

fn plane(x: f64, y: f64, z: f64, d: f64) -> HalfSpace {
    HalfSpace::new(DVec3::new(x, y, z), d).expect("a valid plane")
}

#[test]
fn equal_planes_share_an_id_whatever_scale_and_side() {
    let third = 1.0 / 3.0;
    let given = [
        plane(1.0, 2.0, -3.0, 4.0),
        plane(3.0, 6.0, -9.0, 12.0),
        plane(-5.0, -10.0, 15.0, -20.0),
        plane(third, 2.0 * third, 0.0, 4.0 * third),
        plane(1.0, 2.0, 0.0, 4.0),
    ];
    let (table, ids) = PlaneTable::intern(&given, 0.0);
    assert_eq!(ids[0], ids[1]);
    assert_eq!(ids[0].flipped(), ids[2]);
    assert_eq!(ids[3], ids[4]);
    assert_eq!((table.len(), table.snapped()), (2, 0));
}

#[test]
fn noise_is_snapped_and_counted_and_integers_are_not() {
    let (s, c) = 0.3_f64.sin_cos();
    let noise = 1.0 + 4.0 * f64::EPSILON;
    let given =
        [plane(s, c, 0.0, 7.0), plane(-s * noise, -c, 0.0, -7.0), plane(1e9, 1.0, 0.0, 0.0), plane(1e9, 2.0, 0.0, 0.0)];
    let (table, ids) = PlaneTable::intern(&given, 0.0);
    assert_eq!(ids[0], ids[1].flipped());
    assert_ne!(ids[2], ids[3]);
    assert_eq!(table.snapped(), 1);
}

#[test]
fn planes_that_are_inserted_join_those_that_are_there() {
    let (s, c) = 0.3_f64.sin_cos();
    let (mut table, ids) = PlaneTable::intern(&[plane(s, c, 0.0, 7.0), plane(1.0, 2.0, 3.0, 4.0)], 0.0);
    let noise = 1.0 + 4.0 * f64::EPSILON;
    assert_eq!(table.insert(&plane(-2.0, -4.0, -6.0, -8.0)), ids[1].flipped());
    assert_eq!(table.insert(&plane(-s * noise, -c, 0.0, -7.0)), ids[0].flipped());
    assert_eq!((table.len(), table.snapped()), (2, 1));
    // the same noise once more is known, and does not count again
    assert_eq!(table.insert(&plane(s * noise, c, 0.0, 7.0)), ids[0]);
    assert_eq!(table.snapped(), 1);
    let third = table.insert(&plane(s, c, 0.0, 9.0));
    assert_eq!((third.index(), table.len()), (2, 3));
    // of planes that were added later, too, noise is taken away
    assert_eq!(table.insert(&plane(s * noise, c, 0.0, 9.0)), third);
    assert_eq!(table.insert(&plane(1e9, 2.0, 0.0, 0.0)), table.insert(&plane(1e9, 2.0, 0.0, 0.0)));
    assert_ne!(table.insert(&plane(1e9, 1.0, 0.0, 0.0)), table.insert(&plane(1e9, 2.0, 0.0, 0.0)));
}

#[test]
fn exactly_inserted_planes_are_not_snapped_and_do_not_widen_the_tolerance() {
    let (s, c) = 0.3_f64.sin_cos();
    let noise = 1.0 + 4.0 * f64::EPSILON;
    let mut table = PlaneTable::default();
    let wall = table.insert(&plane(s, c, 0.0, 7.0));
    let beside = table.insert_exact(&plane(s * noise, c, 0.0, 7.0));
    assert_ne!(wall, beside);
    let noisier = plane(s * noise * noise, c, 0.0, 7.0);
    assert_eq!(table.insert(&noisier), wall);
    assert!(![wall, beside].contains(&table.insert_exact(&noisier)));
    table.insert_exact(&plane(1.0, 0.0, 0.0, 1e12));
    assert_ne!(table.insert(&plane(s, c, 0.0, 7.0 + 1e-6)), wall);
    assert_eq!(table.snapped(), 1);
}

#[test]
fn a_table_that_grows_is_hashed_again() {
    let (s, c) = 0.3_f64.sin_cos();
    let mut table = PlaneTable::default();
    let ids: Vec<PlaneId> = (0..60).map(|k| table.insert(&plane(s, c, 0.0, 1.5_f64.powi(k)))).collect();
    let noisy = |k: i32| plane(s, c, 0.0, 1.5_f64.powi(k) * (1.0 + 2.0 * f64::EPSILON));
    assert_eq!(table.len(), 60);
    assert!((0..60).all(|k| table.insert(&noisy(k)) == ids[k as usize]));
    assert_eq!(table.len(), 60);
}

#[test]
fn ids_do_not_depend_on_the_order() {
    let given: Vec<HalfSpace> =
        (0..50).map(|k| plane(f64::from(k % 7 - 3) + 0.1, f64::from(k % 5 - 2), 1.0, f64::from(k % 11))).collect();
    let (_, ids) = PlaneTable::intern(&given, 0.0);
    let reversed: Vec<HalfSpace> = given.iter().rev().copied().collect();
    let (_, back) = PlaneTable::intern(&reversed, 0.0);
    assert!(ids.iter().eq(back.iter().rev()));
}

#[test]
fn one_plane_far_away_does_not_hide_how_others_differ() {
    let (s, c) = 0.3_f64.sin_cos();
    let noise = 1.0 + 4.0 * f64::EPSILON;
    let planes = (1..=1000).flat_map(|k| [1.0, -noise].map(|scale| plane(s, c, 0.0, f64::from(k) * scale)));
    let given: Vec<HalfSpace> = planes.chain([plane(1.0, 2.0, 3.1, 1e20)]).collect();
    let (table, _) = PlaneTable::intern(&given, 0.0);
    // the planes on both sides of the origin are as many
    assert_eq!((table.len(), table.snapped()), (2001, 0));
    let near: Vec<HalfSpace> =
        given.iter().map(|plane| HalfSpace::new(plane.normal(), plane.offset() * noise).expect("a plane")).collect();
    let (table, again) = PlaneTable::intern(&[&given[..], &near].concat(), 0.0);
    assert_eq!((table.len(), table.snapped()), (2001, 2001));
    assert!(again[..2001] == again[2001..]);
}

#[test]
fn both_sides_are_the_same_to_the_last_bit_whether_planes_are_interned_or_inserted() {
    let (s, c) = 0.3_f64.sin_cos();
    let given =
        [plane(0.0, 0.0, 2.0, 3.0), plane(s, 0.0, -c, 0.0), plane(-3.0, 0.0, 1.0, 0.7), plane(-s, -0.0, c, 5.0)];
    let (interned, ids) = PlaneTable::intern(&given, 0.0);
    let mut inserted = PlaneTable::default();
    for (half_space, id) in given.iter().zip(ids) {
        let other = inserted.insert(half_space);
        for (id, other) in [(id, other), (id.flipped(), other.flipped())] {
            let bits = |half_space: &HalfSpace| half_space.to_array().map(f64::to_bits);
            assert_eq!(bits(interned.half_space(id)), bits(inserted.half_space(other)), "{half_space:?}");
        }
    }
}
