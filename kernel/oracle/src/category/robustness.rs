//! Kinds of scripts that lists of hard cases ask for by name: each keeps to one situation.

use super::free;
use crate::exact::Coefficients;
use crate::generators::{Ring, cube, dot, generic, grid, plane, simplex, solids::Platonic};
use crate::random::Rng;
use crate::script::Writer;

/// Tangent to the unit sphere in a random point.
pub(super) fn tangent(rng: &mut Rng) -> Coefficients {
    plane(rng.direction(), 1.0)
}

/// Tangent planes, and planes that lie outside, repeat or only just miss them.
pub(super) fn tangent_with_redundant(writer: &mut Writer, steps: usize) {
    let pool: Vec<Coefficients> = (0..writer.capacity).map(|_| tangent(writer.rng)).collect();
    free(writer, steps, 0.3, |rng| {
        let c = rng.pick(&pool);
        match rng.below(6) {
            0 => plane([c[0], c[1], c[2]], rng.float(1.0, 4.0)),
            1 => c.map(|v| v * rng.pick(&[1.0, 2.0, 3.0, 0.1])),
            2 => plane([c[0], c[1], c[2]], rng.nudge(1.0, 2)),
            3 => plane(rng.direction(), rng.float(2.0, 9.0)),
            _ => c,
        }
    });
}

/// Fifty single additions and removals, where asked inside a box.
pub(super) fn random(writer: &mut Writer, boxed: bool) {
    if boxed {
        let planes = cube(writer.rng, 2.0);
        writer.add_all(&planes);
    }
    let kept = writer.live();
    for _ in 0..50 {
        let inner = writer.live() - kept;
        if inner > 0 && (writer.live() >= writer.capacity || writer.rng.chance(0.4)) {
            let k = kept + writer.rng.below(inner);
            writer.remove(k);
        } else {
            let plane = plane(writer.rng.direction(), writer.rng.float(0.5, 1.5));
            writer.add(plane);
        }
    }
}

/// Planes inside a box that is added first or last; the inner ones are taken away in random order, then the box.
pub(super) fn box_peel(writer: &mut Writer, box_first: bool) {
    let outer = cube(writer.rng, 8.0);
    let room = writer.capacity.saturating_sub(outer.len()).max(2);
    let count = writer.rng.integer(1, room as i64) as usize;
    let whole = writer.rng.chance(0.3);
    let inner: Vec<Coefficients> = (0..count)
        .map(|_| {
            let d = writer.rng.pick(&[1.0, 2.0, 4.0]);
            plane(if whole { writer.rng.lattice(1) } else { writer.rng.direction() }, d)
        })
        .collect();
    writer.add_all(if box_first { &outer } else { &inner });
    writer.add_all(if box_first { &inner } else { &outer });
    let first = if box_first { outer.len() } else { 0 };
    for left in (1..=count.min(writer.live())).rev() {
        let k = (first + writer.rng.below(left)).min(writer.live() - 1);
        writer.remove(k);
    }
    while writer.live() > 0 {
        writer.remove_any();
    }
}

/// A Platonic solid and its dual that swallows, touches, cuts or is cut by it; either is taken away and put back.
pub(super) fn platonic(writer: &mut Writer, steps: usize) {
    let fits = |solid: &&Platonic| solid.normals().len() <= writer.capacity;
    let solids: Vec<Platonic> = Platonic::ALL.iter().filter(fits).copied().collect();
    let solid = writer.rng.pick(&solids);
    let mut planes = solid.planes(1.0);
    let touching = solid.touching_offset();
    let factor = writer.rng.pick(&[1.0, 1.0, 0.5, 0.75, 0.9, 2.0]);
    let mut others = solid.dual().planes(touching * factor);
    if solid == Platonic::Tetrahedron {
        others = others.iter().map(|c| plane([-c[0], -c[1], -c[2]], c[3])).collect();
    }
    if writer.rng.chance(0.7) {
        writer.rng.shuffle(&mut planes);
    }
    writer.add_all(&planes);
    writer.add_all(&others);
    if writer.rng.chance(0.5) {
        let half = writer.live() / 2;
        writer.remove_many(half);
    }
    planes.append(&mut others);
    writer.churn(steps, |rng| rng.pick(&planes));
}

/// Prisms, pyramids and frusta of 3 to 300 sides, built and taken apart.
pub(super) fn sides(writer: &mut Writer) {
    let most = if writer.capacity < 12 { writer.capacity as f64 - 2.0 } else { 300.0 };
    let sides = 3.0 * (most / 3.0).powf(writer.rng.float(0.0, 1.0));
    let ring = Ring {
        sides: sides.round() as usize,
        slope: writer.rng.pick(&[0.0, 0.5, 1.0]),
        jitter: 0.0,
        whole: writer.rng.chance(0.2),
    };
    writer.capacity = writer.capacity.max(ring.sides + 2);
    let caps = [plane([0.0, 0.0, -1.0], 1.0), plane([0.0, 0.0, 1.0], writer.rng.pick(&[0.5, 1.0, 2.0]))];
    let mut planes = ring.planes(writer.rng);
    if writer.rng.chance(0.5) {
        planes.extend(caps);
    } else {
        planes.splice(0..0, caps);
    }
    writer.add_all(&planes);
    for _ in 0..writer.rng.integer(2, 5) {
        let caps_too = [0, 1, writer.live() - 1, writer.rng.below(writer.live())];
        let k = writer.rng.pick(&caps_too);
        writer.remove_and_re_add(k);
    }
    let batch = writer.rng.integer(1, 1 + writer.live() as i64 / 2) as usize;
    writer.remove_many(batch);
    for _ in 0..writer.rng.below(12) {
        writer.remove_any();
    }
}

/// Planes that all lean one way, then lids that bound the set, then the lids go; several times.
pub(super) fn bounded_and_back(writer: &mut Writer) {
    let up = writer.rng.lattice(1);
    let whole = writer.rng.chance(0.5);
    let lean = |rng: &mut Rng, sign: f64| {
        let c = if whole { grid(rng, 2) } else { generic(rng) };
        let n = [c[0], c[1], c[2]];
        plane(if dot(n, up) * sign < 0.0 { n.map(|v| -v) } else { n }, c[3].abs() + 0.5)
    };
    let lids = writer.rng.integer(1, 3) as usize;
    let below = writer.capacity.saturating_sub(lids).max(3);
    let container = simplex(writer.rng, 4.0);
    let mut from_container = container[..3].iter().copied().filter(|_| whole);
    for _ in 0..writer.rng.integer(2, below as i64) {
        let plane = from_container.next().unwrap_or_else(|| lean(writer.rng, -1.0));
        writer.add(plane);
    }
    for _ in 0..writer.rng.integer(2, 6) {
        let open = writer.live();
        for _ in 0..lids {
            let plane = if writer.rng.chance(0.3) { container[3] } else { lean(writer.rng, 1.0) };
            writer.add(plane);
        }
        if writer.rng.chance(0.5) {
            let k = writer.rng.below(writer.live());
            writer.remove_and_re_add(k);
        }
        while writer.live() > open.saturating_sub(1).max(1) {
            let k = writer.live() - 1;
            writer.remove(k);
        }
        let plane = lean(writer.rng, -1.0);
        writer.add(plane);
    }
}

/// Another kind at one scale from 1e-6 to 1e6, or each plane at a scale of its own.
pub(super) fn scales(writer: &mut Writer, steps: usize) {
    let mixed = writer.rng.chance(0.5);
    let whole = writer.rng.chance(0.5);
    let one = 10f64.powi(writer.rng.integer(-6, 6) as i32);
    free(writer, steps, 0.5, |rng| {
        let c = if whole { grid(rng, 2) } else { generic(rng) };
        let size = if mixed { 10f64.powi(rng.integer(-6, 6) as i32) } else { one };
        let row = if mixed { 10f64.powi(rng.integer(-6, 6) as i32) } else { 1.0 };
        plane([c[0], c[1], c[2]], c[3] * size).map(|v| v * row)
    });
}
