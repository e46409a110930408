//! Triangles of a surface, clipped to boxes.

use planecut_kernel::DVec3;

use crate::tolerances::CLIP_MARGIN;

/// Convex polygons, each what a box leaves of a triangle.
#[derive(Debug, Clone, Default)]
pub(super) struct Polygons {
    corners: Vec<DVec3>,
    /// For each polygon the end of its corners, and its triangle.
    ends: Vec<(u32, u32)>,
}

impl Polygons {
    /// Whole triangles.
    pub(super) fn of_triangles(positions: &[DVec3], triangles: &[[u32; 3]]) -> Self {
        let mut polygons = Self::default();
        for (number, triangle) in (0..).zip(triangles) {
            polygons.push(triangle.map(|corner| positions[corner as usize]), number);
        }
        polygons
    }

    fn push(&mut self, corners: impl IntoIterator<Item = DVec3>, triangle: u32) {
        self.corners.extend(corners);
        self.ends.push((self.corners.len() as u32, triangle));
    }

    /// Every polygon of which the number is a multiple of another.
    pub(super) fn every(&self, step: usize) -> Self {
        let mut some = Self::default();
        self.iter().step_by(step.max(1)).for_each(|(corners, triangle)| some.push(corners.iter().copied(), triangle));
        some
    }

    /// The number of polygons.
    pub(super) fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there are none.
    pub(super) fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The corners of all polygons, those that several have more than once.
    pub(super) fn corners(&self) -> &[DVec3] {
        &self.corners
    }

    /// The corners of each polygon, counter-clockwise as those of its triangle, and the number of that.
    pub(super) fn iter(&self) -> impl Iterator<Item = (&[DVec3], u32)> {
        let starts = std::iter::once(0).chain(self.ends.iter().map(|(end, _)| *end));
        starts.zip(&self.ends).map(|(start, (end, triangle))| (&self.corners[start as usize..*end as usize], *triangle))
    }

    /// What lies below a plane across an axis, and what above. Both reach beyond it by [`CLIP_MARGIN`].
    pub(super) fn split(&self, axis: usize, at: f64) -> [Self; 2] {
        let mut parts = [Self::default(), Self::default()];
        let mut kept = Vec::new();
        for (corners, triangle) in self.iter() {
            let (low, high) = corners
                .iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p[axis]), high.max(p[axis])));
            for (part, sign) in parts.iter_mut().zip([1.0, -1.0]) {
                let limit = at + sign * CLIP_MARGIN;
                let (least, most) = if sign > 0.0 { (low, high) } else { (-high, -low) };
                if most <= sign * limit {
                    part.push(corners.iter().copied(), triangle);
                } else if least <= sign * limit {
                    clip(corners, axis, limit, sign, &mut kept);
                    if kept.len() >= 3 {
                        part.push(kept.iter().copied(), triangle);
                    }
                }
            }
        }
        parts
    }
}

/// The corners of what lies below a plane across an axis, or above where the sign is negative. New corners have exactly its coordinate.
fn clip(corners: &[DVec3], axis: usize, limit: f64, sign: f64, kept: &mut Vec<DVec3>) {
    kept.clear();
    let height = |p: DVec3| sign * (p[axis] - limit);
    clip_by(corners, height, |a, b| crossing(a, b, axis, limit), kept, &mut Vec::new());
}

/// The corners of what of a convex polygon has no height above zero. Those where its edges cross that height are the rim, too.
pub(super) fn clip_by(
    corners: &[DVec3],
    height: impl Fn(DVec3) -> f64,
    crossing: impl Fn(DVec3, DVec3) -> DVec3,
    kept: &mut Vec<DVec3>,
    rim: &mut Vec<DVec3>,
) {
    for (k, a) in corners.iter().enumerate() {
        let b = &corners[(k + 1) % corners.len()];
        let (is_within, is_next_within) = (height(*a) <= 0.0, height(*b) <= 0.0);
        if is_within {
            kept.push(*a);
        }
        if is_within != is_next_within {
            let point = crossing(*a, *b);
            kept.push(point);
            rim.push(point);
        }
    }
}

/// The point between two at which a coordinate has a value, the same from both sides.
pub(super) fn crossing(a: DVec3, b: DVec3, axis: usize, at: f64) -> DVec3 {
    let (low, high) = if a[axis] <= b[axis] { (a, b) } else { (b, a) };
    let share = (at - low[axis]) / (high[axis] - low[axis]);
    let mut point = low + share * (high - low);
    point[axis] = at;
    point
}
