//! Cutting and taking cuts back.

use std::collections::HashMap;

use planecut_cells::{Cell, CutId, Solid};
use planecut_kernel::{HalfSpace, PlaneIdx};

use planecut_testkit::random::Rng;
use planecut_testkit::scene::{ensure, ensure_eq, half_space, sweep};
use planecut_testkit::shape::{Kind, bounded, ensure_close, ensure_membership, ensure_sound, random_shape};

/// Facets with their edges, by the coefficients of the planes.
type Facets = Vec<Vec<[u64; 4]>>;

fn bits(half_space: &HalfSpace) -> [u64; 4] {
    let n = half_space.normal();
    [n.x, n.y, n.z, half_space.offset()].map(|v| (v + 0.0).to_bits())
}

/// The cells as they are seen: the planes of each facet and of its edges.
fn seen(solid: &Solid) -> Vec<Facets> {
    let of_cell = |cell: &Cell| {
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
        let normal = rng.unit();
        return half_space(normal, rng.float(-3.0, 3.0));
    }
    let axis = rng.pick(&glam::DVec3::AXES) * rng.pick(&[1.0, -1.0]);
    half_space(axis, rng.whole(-4, 4))
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
            let mut rng = Rng::spread(solid.cells().count() as u64);
            let mut cuts: Vec<(CutId, HalfSpace)> = Vec::new();
            for _ in 0..30 {
                if cuts.is_empty() || rng.chance(0.55) {
                    let half_space = random_cut(&mut rng);
                    cuts.push((solid.add_plane(half_space), half_space));
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
                ensure_eq!(solid.remove_plane(cut), None, "a cut that was removed");
            }
            ensure_eq!(solid.volume(), volume, "volume after all is undone");
            ensure!(seen(&solid) == before, "cells differ after all is undone");
            ensure_membership(shape, &solid, 100)
        });
    }
}

/// What is done to a solid, to be undone one by one.
type Operation = (bool, HalfSpace);

fn apply(solid: &mut Solid, (divides, half_space): &Operation) -> CutId {
    if *divides { solid.divide(half_space) } else { solid.add_plane(*half_space) }
}

/// The cell that holds a point, where it is strictly inside of one.
fn cell_at(solid: &Solid, point: glam::DVec3) -> Result<Option<usize>, String> {
    let holds = |cell: &Cell| {
        cell.planes().all(|(_, plane)| solid.table().half_space(plane.plane).signed_distance(point) < -1e-9)
    };
    let mut found = solid.cells().enumerate().filter(|(_, cell)| holds(cell)).map(|(place, _)| place);
    let first = found.next();
    ensure_eq!(found.next(), None, "two cells overlap");
    Ok(first)
}

#[test]
fn divided_cells_grow_back_together() {
    for kind in [Kind::Boxes, Kind::Sloped, Kind::Mixed] {
        let generate = |rng: &mut Rng| {
            let leaves = 1 + rng.below(5);
            bounded(random_shape(rng, kind, leaves))
        };
        sweep(30, generate, |shape| {
            let base = Solid::from_tree(&shape.tree());
            let mut solid = base.clone();
            let mut rng = Rng::spread(solid.cells().count() as u64 + 5);
            let mut done: Vec<(CutId, Operation)> = Vec::new();
            for _ in 0..16 {
                if done.is_empty() || rng.chance(0.6) {
                    let operation = (rng.chance(0.7), random_cut(&mut rng));
                    done.push((apply(&mut solid, &operation), operation));
                } else {
                    let (cut, _) = done.remove(rng.below(done.len()));
                    solid.remove_plane(cut).ok_or("no such cut")?;
                }
                ensure_sound(&solid)?;
                // what all that is left makes of a new one
                let mut fresh = base.clone();
                for (_, operation) in &done {
                    apply(&mut fresh, operation);
                }
                let volumes = |solid: &Solid| {
                    let volume = |cell: &Cell| cell.polytope().measures().map(|measures| measures.volume);
                    let mut all: Vec<f64> = solid.cells().filter_map(volume).collect();
                    all.sort_by(f64::total_cmp);
                    all
                };
                let (found, expected) = (volumes(&solid), volumes(&fresh));
                ensure_eq!(found.len(), expected.len(), "cells");
                found.iter().zip(&expected).try_for_each(|(a, b)| ensure_close("a cell", *a, *b, 1e-3))?;
                // two points share a cell where they did before and no plane is between them
                let mut cells: HashMap<(usize, Vec<bool>), usize> = HashMap::new();
                let mut sides: HashMap<usize, (usize, Vec<bool>)> = HashMap::new();
                for _ in 0..60 {
                    let point = rng.point(-4.0, 4.0);
                    let (Some(before), Some(now)) = (cell_at(&base, point)?, cell_at(&solid, point)?) else { continue };
                    let dividing = done.iter().filter(|(_, operation)| operation.0);
                    let side = dividing.map(|(_, (_, plane))| plane.signed_distance(point) > 0.0).collect();
                    let name: (usize, Vec<bool>) = (before, side);
                    ensure_eq!(*cells.entry(name.clone()).or_insert(now), now, "one part in two cells");
                    ensure_eq!(sides.entry(now).or_insert(name.clone()), &name, "two parts in one cell");
                }
            }
            for (cut, _) in done {
                solid.remove_plane(cut).ok_or("no such cut")?;
            }
            ensure!(seen(&solid) == seen(&base), "cells differ after all is undone");
            ensure_eq!(solid.volume(), base.volume(), "volume after all is undone");
            ensure_membership(shape, &solid, 50)
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
            let cut = random_cut(&mut Rng::spread(solid.cells().count() as u64));
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
    let mut solid = Solid::from(planecut_testkit::scene::cuboid(glam::DVec3::ZERO, glam::DVec3::ONE));
    let away = solid.add_plane(half_space(glam::DVec3::X, -1.0));
    assert!(solid.is_empty() && solid.cells().next().is_none());
    let half = solid.add_plane(half_space(glam::DVec3::Y, 0.5));
    assert_eq!(solid.volume(), Some(0.0));
    solid.remove_plane(away);
    assert_eq!(solid.volume(), Some(0.5));
    // what a Boolean operation makes of it cannot be undone there
    let mut joined = &solid | &Solid::empty();
    assert_eq!((joined.volume(), joined.remove_plane(half)), (Some(0.5), None));
    solid.remove_plane(half);
    assert_eq!(solid.volume(), Some(1.0));
}
