//! Whether a mesh passes through itself along a line, by the exact order of its faces around it.
//!
//! For meshes of planes with small integer normals: each face gets the exact normal that it must have, and all that is asked is the sign of
//! determinants of integers. Shares no code with the weld.

use std::cmp::Ordering;
use std::collections::HashMap;

use glam::DVec3;
use planecut_csg::{Mesh, Model};

use crate::scene::ensure;

/// A direction in integers.
type Direction = [i128; 3];

/// Two half-planes around a line that the surface joins: the direction into each.
type Chord = [Direction; 2];

/// How near to each other two places are one: such planes meet in points that are either equal or far apart.
const SAME: f64 = 1e-9;

fn dot(a: Direction, b: Direction) -> i128 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Direction, b: Direction) -> Direction {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn negated(a: Direction) -> Direction {
    a.map(|x| -x)
}

fn float(a: Direction) -> DVec3 {
    DVec3::from_array(a.map(|x| x as f64))
}

/// The shortest integer vector of the same direction.
fn reduced(a: Direction) -> Direction {
    let divisor = a.iter().fold(0, |divisor, component| gcd(divisor, component.abs()));
    a.map(|component| component / divisor.max(1))
}

fn gcd(a: i128, b: i128) -> i128 {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// Where a direction lies counter-clockwise around `axis`, seen from `first`: both are perpendicular to the axis.
fn quarter(axis: Direction, first: Direction, other: Direction) -> u8 {
    match dot(cross(first, other), axis).cmp(&0) {
        Ordering::Equal if dot(first, other) > 0 => 0,
        Ordering::Greater => 1,
        Ordering::Equal => 2,
        Ordering::Less => 3,
    }
}

/// The order of two directions counter-clockwise around `axis`, seen from `first`.
fn order(axis: Direction, first: Direction, a: Direction, b: Direction) -> Ordering {
    let quarters = quarter(axis, first, a).cmp(&quarter(axis, first, b));
    quarters.then_with(|| 0.cmp(&dot(cross(a, b), axis)))
}

/// How two chords lie to each other.
fn fault(axis: Direction, [a, b]: Chord, other: Chord) -> Option<&'static str> {
    let of_first = |direction: Direction| order(axis, a, direction, b);
    let is_end = |direction: &Direction| {
        of_first(*direction) == Ordering::Equal || order(axis, b, *direction, a) == Ordering::Equal
    };
    if other.iter().any(is_end) {
        return Some("two faces lie on each other");
    }
    (of_first(other[0]) != of_first(other[1])).then_some("the surface passes through itself")
}

/// A side of a triangle.
struct Side {
    triangle: usize,
    from: u32,
    to: u32,
}

/// A mesh with the exact normals of its faces.
struct Exact<'a> {
    mesh: &'a Mesh,
    /// Of each face, outward.
    normals: Vec<Direction>,
    /// The two sides of each edge.
    edges: HashMap<(u32, u32), Vec<Side>>,
}

/// What the surface does along one piece of a line.
struct Bend {
    ends: [f64; 2],
    chord: Chord,
}

/// `Err` names a line along which the surface of a mesh passes through itself, or lies on itself.
///
/// # Errors
/// Also where a face has none of the normals of the model.
pub fn check_around_lines(model: &Model, mesh: &Mesh) -> Result<(), String> {
    let exact = Exact::new(model, mesh)?;
    // by the direction of the line and the place where it passes the origin
    let mut lines: HashMap<(Direction, [i64; 3]), Vec<Bend>> = HashMap::new();
    for sides in exact.edges.values() {
        let [a, b] = &sides[..] else { return Err("an edge of other than two triangles".to_owned()) };
        let normals = [exact.normal(a.triangle), exact.normal(b.triangle)];
        let axis = cross(normals[0], normals[1]);
        if axis == [0; 3] {
            ensure!(normals[0] == normals[1], "a face is folded back on itself");
            continue;
        }
        let axis = reduced(axis);
        let axis = if axis.iter().find(|x| **x != 0) < Some(&0) { negated(axis) } else { axis };
        let unit = float(axis).normalize();
        let ends = [a.from, a.to].map(|v| mesh.positions[v as usize]);
        let foot = ends[0] - unit * unit.dot(ends[0]);
        // no such point lies half way between two of this grid
        let place = foot.to_array().map(|x| (x * 1e6 + 0.3567).floor() as i64);
        let chord = [exact.toward_face(a, axis), exact.toward_face(b, axis)];
        let mut ends = ends.map(|end| end.dot(unit));
        ends.sort_by(f64::total_cmp);
        lines.entry((axis, place)).or_default().push(Bend { ends, chord });
    }
    for ((axis, place), bends) in &lines {
        exact.check_line(*axis, DVec3::from_array(place.map(|x| (x as f64 + 0.1433) * 1e-6)), bends)?;
    }
    Ok(())
}

impl<'a> Exact<'a> {
    fn new(model: &Model, mesh: &'a Mesh) -> Result<Self, String> {
        let integers = |normal: DVec3| reduced(normal.to_array().map(|x| x as i128));
        let planes = model.tree.brushes().iter().flat_map(|brush| &brush.faces);
        let mut known: Vec<Direction> = planes.map(|face| integers(face.half_space.normal())).collect();
        known.extend(known.clone().into_iter().map(negated));
        known.sort_unstable();
        known.dedup();
        let exact = |normal: DVec3| {
            let nearest = |direction: &&Direction| (float(**direction).normalize() - normal).length() < SAME;
            known.iter().find(nearest).copied().ok_or_else(|| format!("no plane has the normal {normal}"))
        };
        let normals = mesh.faces.iter().map(|face| exact(face.normal)).collect::<Result<_, _>>()?;
        let mut edges: HashMap<(u32, u32), Vec<Side>> = HashMap::new();
        for (triangle, corners) in mesh.triangles.iter().enumerate() {
            for k in 0..3 {
                let (from, to) = (corners[k], corners[(k + 1) % 3]);
                edges.entry((from.min(to), from.max(to))).or_default().push(Side { triangle, from, to });
            }
        }
        Ok(Self { mesh, normals, edges })
    }

    fn normal(&self, triangle: usize) -> Direction {
        self.normals[self.mesh.triangle_faces[triangle] as usize]
    }

    /// The direction from a side into its triangle, perpendicular to the axis along which the side runs.
    fn toward_face(&self, side: &Side, axis: Direction) -> Direction {
        let [from, to] = [side.from, side.to].map(|v| self.mesh.positions[v as usize]);
        let along = if (to - from).dot(float(axis)) > 0.0 { axis } else { negated(axis) };
        reduced(cross(self.normal(side.triangle), along))
    }

    /// Compares all that lies along a line near `foot`, on each interval between ends.
    fn check_line(&self, axis: Direction, foot: DVec3, bends: &[Bend]) -> Result<(), String> {
        let unit = float(axis).normalize();
        let mut stops: Vec<f64> = bends.iter().flat_map(|bend| bend.ends).collect();
        stops.sort_by(f64::total_cmp);
        stops.dedup_by(|a, b| (*a - *b).abs() < SAME);
        for ends in stops.windows(2) {
            // a vertex within an interval is not likely to lie just there
            let at = 0.4871 * ends[0] + 0.5129 * ends[1];
            let mut chords: Vec<Chord> = Vec::new();
            chords.extend(bends.iter().filter(|bend| bend.ends[0] < at && at < bend.ends[1]).map(|bend| bend.chord));
            if chords.is_empty() {
                continue;
            }
            chords.extend(self.passing(axis, foot - unit * unit.dot(foot) + at * unit));
            for (k, chord) in chords.iter().enumerate() {
                if let Some(fault) = chords[..k].iter().find_map(|other| fault(axis, *chord, *other)) {
                    return Err(format!("{fault} along {axis:?} near {}: {chords:?}", foot + at * unit));
                }
            }
        }
        Ok(())
    }

    /// The faces on both sides of a line at a place on it.
    fn passing(&self, axis: Direction, at: DVec3) -> Vec<Chord> {
        let mut chords = Vec::new();
        for (triangle, corners) in self.mesh.triangles.iter().enumerate() {
            let normal = self.normal(triangle);
            if dot(normal, axis) != 0 || !self.holds(triangle, *corners, at) {
                continue;
            }
            let into = reduced(cross(normal, axis));
            chords.push([into, negated(into)]);
        }
        chords.sort_unstable();
        chords.dedup();
        chords
    }

    /// Whether a place lies in a triangle, or on a side beyond which the same plane goes on.
    fn holds(&self, triangle: usize, corners: [u32; 3], at: DVec3) -> bool {
        // the place of the line is known to within the grid of feet
        let near = 4e-6;
        let normal = float(self.normal(triangle)).normalize();
        let positions = corners.map(|v| self.mesh.positions[v as usize]);
        if normal.dot(at - positions[0]).abs() > near {
            return false;
        }
        (0..3).all(|k| {
            let (from, to) = (positions[k], positions[(k + 1) % 3]);
            let inward = normal.cross(to - from).normalize_or_zero().dot(at - from);
            let is_flat = || {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                let sides = &self.edges[&(a.min(b), a.max(b))];
                sides.iter().all(|side| self.normal(side.triangle) == self.normal(triangle))
            };
            inward > near || inward > -near && is_flat()
        })
    }
}
