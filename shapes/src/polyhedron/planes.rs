//! One plane for facets that were meant to lie on one.
//!
//! From the largest facet that has no plane yet, neighbours are gathered whose corners lie on its plane, as exactly as corners
//! are known; patches elsewhere on the same plane join it, too.

use planecut_kernel::{DVec3, HalfSpace};
use rustc_hash::FxHashMap;

use super::error::PolyhedronError;
use super::exact::{Grid, Plane};
use super::polygon::area_vector;
use super::surface::Surface;
use crate::tolerances::{LEANING, NEGLIGIBLE_COMPONENT, PLANE_ROUNDING};

/// Side of the cells in which the directions of planes are hashed.
const DIRECTION_CELL: f64 = 1.0 / 64.0;
/// A plane in floating point, its normal of unit length.
#[derive(Debug, Clone, Copy)]
pub(super) struct FloatPlane {
    normal: DVec3,
    offset: f64,
}

impl FloatPlane {
    pub(super) fn of(half_space: &HalfSpace) -> Self {
        // no component leaves the range of numbers
        let scale = half_space.normal().abs().max_element();
        let normal = half_space.normal() / scale;
        let length = normal.length();
        Self { normal: normal / length, offset: half_space.offset() / scale / length }
    }

    /// In a direction, amid points.
    fn amid(direction: DVec3, points: impl Iterator<Item = DVec3>) -> Self {
        let normal = (direction / direction.abs().max_element()).normalize();
        let heights = points.map(|p| normal.dot(p));
        let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        Self { normal, offset: 0.5 * low + 0.5 * high }
    }

    /// How far above the plane a point lies.
    pub(super) fn height(&self, point: DVec3) -> f64 {
        self.normal.dot(point) - self.offset
    }

    pub(super) fn normal(&self) -> DVec3 {
        self.normal
    }
}

/// The planes of a surface.
#[derive(Debug)]
pub(super) struct Planes {
    pub(super) float_planes: Vec<FloatPlane>,
    pub(super) half_spaces: Vec<HalfSpace>,
    /// The plane of each triangle.
    pub(super) of_triangle: Vec<u32>,
    /// Whether each triangle's solid lies above its plane.
    pub(super) is_reversed: Vec<bool>,
    /// Facets whose corners lie on no plane.
    pub(super) bent_facets: usize,
}

impl Planes {
    pub(super) fn of(surface: &Surface) -> Result<Self, PolyhedronError> {
        let mut gathering = Gathering::new(surface);
        gathering.gather();
        gathering.finish()
    }

    /// How far each point may lie from a plane that it is on: at least as far as it lies from those of its triangles.
    pub(super) fn slack(&self, surface: &Surface) -> Vec<f64> {
        let mut slack = surface.slack.clone();
        for (corners, plane) in surface.triangles.iter().zip(&self.of_triangle) {
            for vertex in corners.map(|v| v as usize) {
                let height = self.float_planes[*plane as usize].height(surface.points[vertex]).abs();
                slack[vertex] = slack[vertex].max(height * (1.0 + PLANE_ROUNDING));
            }
        }
        slack
    }
}

/// Triangles that share a plane because they are one facet, or a single triangle.
#[derive(Debug)]
struct Unit {
    triangles: std::ops::Range<usize>,
    /// Twice the area, along the normal.
    area: DVec3,
    /// Whether the corners tell a normal: whether they lie on more than a line.
    is_wide: bool,
}

struct Gathering<'a> {
    surface: &'a Surface,
    units: Vec<Unit>,
    unit_of: Vec<u32>,
    bent_facets: usize,
    /// The plane of each unit.
    plane: Vec<Option<u32>>,
    /// The neighbour on the same plane through which a unit was found.
    like: Vec<Option<u32>>,
    /// The first idea of each plane, and its units.
    patches: Vec<(FloatPlane, Vec<u32>)>,
    directions: FxHashMap<[i32; 3], Vec<u32>>,
}

impl<'a> Gathering<'a> {
    fn new(surface: &'a Surface) -> Self {
        let mut gathering = Self {
            surface,
            units: Vec::new(),
            unit_of: vec![0; surface.triangles.len()],
            bent_facets: 0,
            plane: Vec::new(),
            like: Vec::new(),
            patches: Vec::new(),
            directions: FxHashMap::default(),
        };
        let mut start = 0;
        for facet in surface.facet_of.chunk_by(|a, b| a == b) {
            gathering.add_facet(start..start + facet.len());
            start += facet.len();
        }
        gathering.plane = vec![None; gathering.units.len()];
        gathering.like = vec![None; gathering.units.len()];
        gathering
    }

    /// One unit where the corners lie on a plane, else a unit for each triangle.
    fn add_facet(&mut self, triangles: std::ops::Range<usize>) {
        let area = |t: usize| area_vector(&self.surface.corners(t));
        let areas: Vec<DVec3> = triangles.clone().map(area).collect();
        let whole = self.unit(triangles.clone(), areas.iter().sum());
        if triangles.len() == 1 || whole.area != DVec3::ZERO && self.fits(&whole, &self.flat_of(&whole)) {
            self.push(whole);
        } else {
            self.bent_facets += 1;
            for (t, area) in triangles.zip(areas) {
                let unit = self.unit(t..t + 1, area);
                self.push(unit);
            }
        }
    }

    fn unit(&self, triangles: std::ops::Range<usize>, area: DVec3) -> Unit {
        let vertices = || self.surface.triangles[triangles.clone()].as_flattened().iter().map(|v| *v as usize);
        let slack = vertices().map(|v| self.surface.slack[v]).fold(0.0, f64::max);
        let first = vertices().next().map_or(DVec3::ZERO, |v| self.surface.points[v]);
        let extent = vertices().map(|v| self.surface.points[v].distance(first)).fold(0.0, f64::max);
        Unit { is_wide: area.length() > 2.0 * slack * extent, triangles, area }
    }

    fn push(&mut self, unit: Unit) {
        self.unit_of[unit.triangles.clone()].fill(self.units.len() as u32);
        self.units.push(unit);
    }

    fn vertices(&self, unit: &Unit) -> impl Iterator<Item = u32> + 'a {
        self.surface.triangles[unit.triangles.clone()].as_flattened().iter().copied()
    }

    fn flat_of(&self, unit: &Unit) -> FloatPlane {
        FloatPlane::amid(unit.area, self.vertices(unit).map(|v| self.surface.points[v as usize]))
    }

    fn fits(&self, unit: &Unit, flat: &FloatPlane) -> bool {
        self.vertices(unit).all(|v| self.is_on(v, flat))
    }

    fn is_on(&self, vertex: u32, flat: &FloatPlane) -> bool {
        flat.height(self.surface.points[vertex as usize]).abs() <= self.surface.slack[vertex as usize]
    }

    /// Gives every unit a plane.
    fn gather(&mut self) {
        let mut order: Vec<u32> = (0..self.units.len() as u32).collect();
        let area = |unit: &u32| self.units[*unit as usize].area.length_squared();
        order.sort_by(|a, b| area(b).total_cmp(&area(a)).then(a.cmp(b)));
        let (wide, narrow): (Vec<u32>, Vec<u32>) =
            order.into_iter().partition(|unit| self.units[*unit as usize].is_wide);
        for unit in wide {
            if self.plane[unit as usize].is_none() {
                self.grow(unit);
            }
        }
        self.fill(narrow);
    }

    /// Gathers what lies about a unit on its plane; the patch joins a plane that is there, or is one.
    fn grow(&mut self, seed: u32) {
        let mut flat = self.flat_of(&self.units[seed as usize]);
        let number = self.patches.len() as u32;
        self.plane[seed as usize] = Some(number);
        let mut patch = vec![seed];
        let mut next = 0;
        while let Some(unit) = patch.get(next).copied() {
            next += 1;
            for neighbour in self.neighbours(unit) {
                if self.plane[neighbour as usize].is_some() {
                    continue;
                }
                let flat_for_both = || self.common_flat(&flat, &patch, neighbour);
                let fits = self.fits(&self.units[neighbour as usize], &flat);
                if let Some(both) = if fits { Some(flat) } else { flat_for_both() } {
                    flat = both;
                    self.plane[neighbour as usize] = Some(number);
                    self.like[neighbour as usize] = Some(unit);
                    patch.push(neighbour);
                }
            }
        }
        match self.known_plane(&flat, &patch) {
            Some(known) => {
                patch.iter().for_each(|unit| self.plane[*unit as usize] = Some(known));
                self.patches[known as usize].1.extend(patch);
            }
            None => {
                self.directions.entry(direction_cell(flat.normal)).or_default().push(number);
                self.patches.push((flat, patch));
            }
        }
    }

    /// The plane amid a patch and one more unit, where all lie on it: that of the first units alone, which may be narrow,
    /// leans.
    fn common_flat(&self, flat: &FloatPlane, patch: &[u32], more: u32) -> Option<FloatPlane> {
        let is_near = |v: u32| {
            let off = flat.height(self.surface.points[v as usize]).abs();
            off <= LEANING * self.surface.slack[v as usize]
        };
        if !self.vertices(&self.units[more as usize]).all(is_near) {
            return None;
        }
        let units = || patch.iter().chain([&more]).map(|unit| &self.units[*unit as usize]);
        let first = self.units[patch[0] as usize].area;
        let area: DVec3 = units().map(|unit| if unit.area.dot(first) < 0.0 { -unit.area } else { unit.area }).sum();
        let corners = units().flat_map(|unit| self.vertices(unit)).map(|v| self.surface.points[v as usize]);
        let flat = FloatPlane::amid(area, corners);
        units().all(|unit| self.fits(unit, &flat)).then_some(flat)
    }

    fn neighbours(&self, unit: u32) -> Vec<u32> {
        let sides = self.units[unit as usize].triangles.clone().flat_map(|t| [(t, 0), (t, 1), (t, 2)]);
        sides.map(|(t, k)| self.unit_of[self.surface.neighbour(t, k)]).collect()
    }

    /// A plane that is there and on which the patch lies.
    fn known_plane(&self, flat: &FloatPlane, patch: &[u32]) -> Option<u32> {
        let fits = |plane: &u32| {
            let known = &self.patches[*plane as usize].0;
            patch.iter().all(|unit| self.fits(&self.units[*unit as usize], known))
        };
        let near = |normal: DVec3| {
            let [x, y, z] = direction_cell(normal);
            (0..27).filter_map(move |k| self.directions.get(&[x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1]))
        };
        near(flat.normal).chain(near(-flat.normal)).flatten().copied().filter(fits).min()
    }

    /// Units that are no wider than corners are exact lie on a neighbour's plane.
    fn fill(&mut self, mut narrow: Vec<u32>) {
        loop {
            let before = narrow.len();
            narrow.retain(|unit| match self.plane_beside(*unit) {
                Some((plane, neighbour)) => {
                    self.plane[*unit as usize] = Some(plane);
                    self.like[*unit as usize] = Some(neighbour);
                    self.patches[plane as usize].1.push(*unit);
                    false
                }
                None => true,
            });
            if narrow.is_empty() {
                return;
            }
            if narrow.len() == before {
                // none has a neighbour: any plane through it will do
                let unit = narrow.remove(0);
                let triangle = self.units[unit as usize].triangles.start;
                let [a, b, c] = self.surface.corners(triangle);
                let across = [b - a, c - a, c - b].into_iter().map(DVec3::normalize_or_zero).sum::<DVec3>();
                let normal = across.normalize_or(DVec3::X).any_orthonormal_vector();
                self.plane[unit as usize] = Some(self.patches.len() as u32);
                self.patches.push((FloatPlane::amid(normal, [a, b, c].into_iter()), vec![unit]));
            }
        }
    }

    /// The plane of a neighbour to which a unit lies nearest, and that neighbour.
    fn plane_beside(&self, unit: u32) -> Option<(u32, u32)> {
        let off = |plane: u32| {
            let flat = &self.patches[plane as usize].0;
            let heights = self.vertices(&self.units[unit as usize]).map(|v| {
                let (point, slack) = (self.surface.points[v as usize], self.surface.slack[v as usize]);
                flat.height(point).abs() / slack
            });
            heights.fold(0.0, f64::max)
        };
        let planes = self.neighbours(unit).into_iter().filter_map(|n| Some((self.plane[n as usize]?, n)));
        let nearest = planes.map(|(plane, n)| (off(plane), plane, n)).min_by(|a, b| a.0.total_cmp(&b.0));
        nearest.map(|(_, plane, neighbour)| (plane, neighbour))
    }

    fn finish(&self) -> Result<Planes, PolyhedronError> {
        let grid = Grid::of(&self.surface.points);
        let mut planes = Planes {
            float_planes: Vec::new(),
            half_spaces: Vec::new(),
            of_triangle: vec![0; self.surface.triangles.len()],
            is_reversed: vec![false; self.surface.triangles.len()],
            bent_facets: self.bent_facets,
        };
        for (number, (seed, units)) in self.patches.iter().enumerate() {
            let half_space = self.half_space(grid, seed, units)?;
            let flat = FloatPlane::of(&half_space);
            for number_of_unit in units {
                let unit = &self.units[*number_of_unit as usize];
                // the corners of small facets can be off so far that these are folded over
                let is_reversed = match self.like[*number_of_unit as usize] {
                    Some(other) => planes.is_reversed[self.units[other as usize].triangles.start],
                    None => unit.area.dot(flat.normal) < 0.0,
                };
                planes.of_triangle[unit.triangles.clone()].fill(number as u32);
                planes.is_reversed[unit.triangles.clone()].fill(is_reversed);
            }
            planes.float_planes.push(flat);
            planes.half_spaces.push(half_space);
        }
        Ok(planes)
    }

    /// The plane of a patch: that of its corners where it is one, else one amid them.
    fn half_space(&self, grid: Grid, seed: &FloatPlane, units: &[u32]) -> Result<HalfSpace, PolyhedronError> {
        let mut vertices: Vec<u32> = units.iter().flat_map(|u| self.vertices(&self.units[*u as usize])).collect();
        vertices.sort_unstable();
        vertices.dedup();
        let points = || vertices.iter().map(|v| self.surface.points[*v as usize]);
        let first = self.units[units[0] as usize].triangles.start;
        if let Some(exact) = Plane::through(grid, self.surface.corners(first)) {
            let (normal, offset) = exact.half_space(grid, points());
            let half_space = accepted(normal, offset)?;
            let flat = FloatPlane::of(&half_space);
            let size = points().map(|p| p.abs().max_element()).fold(0.0, f64::max);
            if points().all(|p| flat.height(p).abs() <= PLANE_ROUNDING * size) {
                return Ok(half_space);
            }
        }
        let side = |unit: &Unit| if unit.area.dot(seed.normal) < 0.0 { -unit.area } else { unit.area };
        let area: DVec3 = units.iter().map(|u| side(&self.units[*u as usize])).sum();
        let flat = if area == DVec3::ZERO { *seed } else { FloatPlane::amid(area, points()) };
        let flat = if vertices.iter().all(|v| self.is_on(*v, &flat)) { flat } else { *seed };
        accepted(flat.normal, flat.offset)
    }
}

/// A half-space; what is mere rounding noise beside the rest becomes zero.
fn accepted(normal: DVec3, offset: f64) -> Result<HalfSpace, PolyhedronError> {
    let noise = normal.abs().max_element() * NEGLIGIBLE_COMPONENT;
    let normal = DVec3::from_array(normal.to_array().map(|v| if v.abs() < noise { 0.0 } else { v }));
    let offset = if offset.abs() < noise { 0.0 } else { offset };
    Ok(HalfSpace::new(normal, offset)?)
}

fn direction_cell(normal: DVec3) -> [i32; 3] {
    normal.to_array().map(|v| (v / DIRECTION_CELL).floor() as i32)
}
