//! Cutting and taking cuts back.

use planecut_csg::{CutId, Solid};
use planecut_kernel::{HalfSpace, PlaneIdx};

use crate::rng::Rng;
use crate::scene::{ensure, ensure_eq, half_space, sweep};
use crate::shape::{Kind, bounded, ensure_close, ensure_membership, ensure_sound, random_shape};

/// Facets with their edges, by the coefficients of the planes.
type Facets = Vec<Vec<[u64; 4]>>;

fn bits(half_space: &HalfSpace) -> [u64; 4] {
    let n = half_space.normal();
    [n.x, n.y, n.z, half_space.offset()].map(|v| (v + 0.0).to_bits())
}

/// The cells as they are seen: the planes of each facet and of its edges.
fn seen(solid: &Solid) -> Vec<Facets> {
    let of_cell = |cell: &planecut_csg::Cell| {
        let plane = |handle: &PlaneIdx| cell.polytope().plane(*handle).map_or([0; 4], bits);
        let facets = cell.polytope().facets();
        let mut rings: Facets = facets
            .iter()
            .map(|(face, edges)| {
                let mut ring: Vec<[u64; 4]> = edges.iter().map(|e| e.as_ref().map_or([0; 4], plane)).collect();
                let least = (0..ring.len()).min_by_key(|k| ring[*k]).unwrap_or(0);
                ring.rotate_left(least);
                ring.insert(0, plane(face));
                ring
            })
            .collect();
        rings.sort_unstable();
        rings
    };
    solid.cells().map(of_cell).collect()
}

fn random_cut(rng: &mut Rng) -> HalfSpace {
    if rng.chance(0.5) {
        let normal = rng.direction();
        return half_space(normal, rng.real(-3.0, 3.0));
    }
    let axis = *rng.pick(&glam::DVec3::AXES) * *rng.pick(&[1.0, -1.0]);
    half_space(axis, f64::from(rng.integer(-4, 4)))
}

#[test]
fn cuts_that_are_taken_back_leave_nothing_behind() {
    for kind in [Kind::Boxes, Kind::Sloped, Kind::Mixed] {
        let generate = |rng: &mut Rng| {
            let leaves = 1 + rng.below(6);
            bounded(random_shape(rng, kind, leaves))
        };
        sweep(40, generate, |shape| {
            let mut solid = Solid::from_tree(&shape.tree());
            let (before, volume) = (seen(&solid), solid.volume());
            let mut rng = Rng::new(solid.cells().count() as u64);
            let mut cuts: Vec<(CutId, HalfSpace)> = Vec::new();
            for _ in 0..30 {
                if cuts.is_empty() || rng.chance(0.55) {
                    let half_space = random_cut(&mut rng);
                    cuts.push((solid.add_plane(&half_space), half_space));
                } else {
                    let (cut, half_space) = cuts.swap_remove(rng.below(cuts.len()));
                    let back = solid.remove_plane(cut).ok_or("no such cut")?;
                    let distance = |h: &HalfSpace| h.signed_distance(glam::DVec3::ONE);
                    ensure_close("the plane given back", distance(&back), distance(&half_space), 10.0)?;
                }
                let mut fresh = Solid::from_tree(&shape.tree());
                for (_, half_space) in &cuts {
                    fresh = fresh.split(half_space).0;
                }
                ensure_sound(&solid)?;
                let volumes = (solid.volume().ok_or("unbounded")?, fresh.volume().ok_or("unbounded")?);
                ensure_close("volume after cuts", volumes.0, volumes.1, 1e-3)?;
                ensure!((&solid ^ &fresh).is_empty(), "not what splitting gives");
            }
            for (cut, _) in cuts {
                solid.remove_plane(cut);
                ensure_eq!(solid.remove_plane(cut), None, "a cut that was taken back");
            }
            ensure_eq!(solid.volume(), volume, "volume after all is taken back");
            ensure!(seen(&solid) == before, "cells differ after all is taken back");
            ensure_membership(shape, &solid, 100)
        });
    }
}

#[test]
fn halves_add_up() {
    for kind in [Kind::Boxes, Kind::Mixed] {
        let generate = |rng: &mut Rng| {
            let leaves = 1 + rng.below(6);
            bounded(random_shape(rng, kind, leaves))
        };
        sweep(60, generate, |shape| {
            let solid = Solid::from_tree(&shape.tree());
            let cut = random_cut(&mut Rng::new(solid.cells().count() as u64));
            let (inside, outside) = solid.split(&cut);
            ensure_sound(&inside)?;
            ensure_sound(&outside)?;
            ensure!((&inside & &outside).is_empty(), "the halves overlap");
            ensure!((&(&inside | &outside) ^ &solid).is_empty(), "the halves are not the whole");
            let volume = |solid: &Solid| solid.volume().ok_or("unbounded");
            ensure_close("volume", volume(&inside)? + volume(&outside)?, volume(&solid)?, 1e-3)
        });
    }
}

#[test]
fn a_solid_that_is_cut_away_comes_back() {
    let mut solid = Solid::from(crate::scene::cuboid(glam::DVec3::ZERO, glam::DVec3::ONE));
    let away = solid.add_plane(&half_space(glam::DVec3::X, -1.0));
    assert!(solid.is_empty() && solid.cells().next().is_none());
    let half = solid.add_plane(&half_space(glam::DVec3::Y, 0.5));
    assert_eq!(solid.volume(), Some(0.0));
    solid.remove_plane(away);
    assert_eq!(solid.volume(), Some(0.5));
    // what a Boolean operation makes of it cannot be taken back there
    let mut joined = &solid | &Solid::empty();
    assert_eq!((joined.volume(), joined.remove_plane(half)), (Some(0.5), None));
    solid.remove_plane(half);
    assert_eq!(solid.volume(), Some(1.0));
}
