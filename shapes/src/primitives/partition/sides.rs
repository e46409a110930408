//! The sides of a loop as lines, and exactly on which side of them points lie.

use std::cmp::Ordering;

use dashu_int::IBig;
use planecut_kernel::DVec2;
use robust::{Coord, orient2d};

/// A corner of the loop, counted from 0, or the point in which the lines of two sides meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Vertex {
    Corner(u32),
    Meet(u32, u32),
}

/// A vertex, and what mostly tells on which side of a line it lies.
#[derive(Debug, Clone, Copy)]
pub(super) struct Placed {
    vertex: Vertex,
    /// No number for a point in which lines meet, of which this would be rounded.
    at: DVec2,
    /// The lines that it lies on.
    lines: [u32; 2],
}

/// The sides of a loop; side `k` runs from corner `k` to the next.
pub(super) struct Sides<'a> {
    corners: &'a [DVec2],
    /// Of each side the number of its line; sides on one line have the same.
    lines: &'a [u32],
}

/// The line of a side, beside which many vertices are sought.
pub(super) struct SideLine<'a> {
    sides: &'a Sides<'a>,
    side: u32,
    line: u32,
    ends: [DVec2; 2],
}

/// A determinant and how far it may be off.
#[derive(Clone, Copy)]
struct Rounded {
    value: f64,
    error: f64,
}

/// Two products of two differences each, and their difference, are off by at most `(3 + 16 ε) ε` of their sum of magnitudes
/// (Shewchuk 1997, `ccwerrboundA`), with `ε` as half of this; so this is more than enough.
const ERROR: f64 = 4.0 * f64::EPSILON;

impl<'a> Sides<'a> {
    pub(super) fn new(corners: &'a [DVec2], lines: &'a [u32]) -> Self {
        Self { corners, lines }
    }

    pub(super) fn len(&self) -> u32 {
        self.corners.len() as u32
    }

    pub(super) fn line(&self, side: u32) -> u32 {
        self.lines[side as usize]
    }

    /// What is known of a vertex.
    pub(super) fn placed(&self, vertex: Vertex) -> Placed {
        match vertex {
            Vertex::Corner(k) => {
                let before = (k + self.len() - 1) % self.len();
                Placed { vertex, at: self.corners[k as usize], lines: [before, k].map(|side| self.line(side)) }
            }
            Vertex::Meet(a, b) => Placed { vertex, at: DVec2::NAN, lines: [a, b].map(|side| self.line(side)) },
        }
    }

    fn ends(&self, side: u32) -> [DVec2; 2] {
        let next = (side + 1) % self.len();
        [side, next].map(|k| self.corners[k as usize])
    }

    /// The line of a side.
    pub(super) fn along(&self, side: u32) -> SideLine<'_> {
        SideLine { sides: self, side, line: self.line(side), ends: self.ends(side) }
    }

    /// On which side of the line of a side a vertex lies; as [`SideLine::turn`].
    pub(super) fn turn(&self, side: u32, vertex: &Placed) -> Ordering {
        self.along(side).turn(vertex)
    }

    /// On the line of `a` from `a₀` to `a₁`, the determinant with the line of `b` goes from `d₀` to `d₁`, and is 0 where they
    /// meet; that with the line in question goes from `e₀` to `e₁`, and so is `(d₀ e₁ − d₁ e₀) / (d₀ − d₁)` there.
    fn turn_at_meet(&self, side: u32, a: u32, b: u32) -> Ordering {
        let [a0, a1] = self.ends(a);
        let (other, own) = (self.ends(b), self.ends(side));
        let [d0, d1, e0, e1] = [(other, a0), (other, a1), (own, a0), (own, a1)].map(|(ends, p)| rounded(ends, p));
        let below = Rounded { value: d0.value - d1.value, error: (d0.error + d1.error) * (1.0 + ERROR) };
        let (first, second) = (product(d0, e1), product(d1, e0));
        let above = Rounded { value: first.value - second.value, error: (first.error + second.error) * (1.0 + ERROR) };
        match (below.sign(), above.sign()) {
            (Some(Ordering::Greater), Some(above)) => above,
            (Some(_), Some(above)) => above.reverse(),
            _ => exact_turn_at_meet([a0, a1], other, own),
        }
    }

    /// How far a point is to the left of the line of a side, but for rounding.
    pub(super) fn distance(&self, side: u32, point: DVec2) -> f64 {
        let [p, q] = self.ends(side);
        (q - p).perp_dot(point - p) / (q - p).length()
    }

    /// Where a vertex is, but for rounding.
    pub(super) fn position(&self, vertex: &Placed) -> DVec2 {
        match vertex.vertex {
            Vertex::Corner(k) => self.corners[k as usize],
            Vertex::Meet(a, b) => {
                let ([a0, a1], other) = (self.ends(a), self.ends(b));
                let (d0, d1) = (rounded(other, a0).value, rounded(other, a1).value);
                a0 + (a1 - a0) * (d0 / (d0 - d1))
            }
        }
    }
}

impl SideLine<'_> {
    /// On which side of the line a vertex lies: greater is to the left. A vertex at an end of a side on the same line lies on it.
    #[inline]
    pub(super) fn turn(&self, vertex: &Placed) -> Ordering {
        if vertex.lines.contains(&self.line) {
            return Ordering::Equal;
        }
        rounded(self.ends, vertex.at).sign().unwrap_or_else(|| self.exact_turn(vertex))
    }

    #[cold]
    #[inline(never)]
    fn exact_turn(&self, vertex: &Placed) -> Ordering {
        match vertex.vertex {
            Vertex::Corner(_) => {
                let [p, q] = self.ends;
                sign(orient2d(at(p), at(q), at(vertex.at)))
            }
            Vertex::Meet(a, b) => self.sides.turn_at_meet(self.side, a, b),
        }
    }
}

impl Rounded {
    fn sign(self) -> Option<Ordering> {
        // differences of what was rounded are off by a little more
        (self.value.abs() > self.error + ERROR * self.value.abs()).then(|| sign(self.value))
    }
}

fn rounded([p, q]: [DVec2; 2], r: DVec2) -> Rounded {
    let (left, right) = ((q.x - p.x) * (r.y - p.y), (q.y - p.y) * (r.x - p.x));
    Rounded { value: left - right, error: ERROR * (left.abs() + right.abs()) }
}

fn product(a: Rounded, b: Rounded) -> Rounded {
    let error = a.value.abs() * b.error + a.error * b.value.abs() + a.error * b.error;
    Rounded { value: a.value * b.value, error: error + ERROR * (a.value * b.value).abs() }
}

fn sign(v: f64) -> Ordering {
    v.partial_cmp(&0.0).unwrap_or(Ordering::Equal)
}

fn at(p: DVec2) -> Coord<f64> {
    Coord { x: p.x, y: p.y }
}

/// The same in whole numbers.
fn exact_turn_at_meet([a0, a1]: [DVec2; 2], other: [DVec2; 2], own: [DVec2; 2]) -> Ordering {
    let points = [a0, a1, other[0], other[1], own[0], own[1]];
    let lowest = points.iter().flat_map(|p| p.to_array()).filter(|v| *v != 0.0).map(|v| mantissa(v).1).min();
    let lowest = lowest.unwrap_or(0);
    let [a0, a1, b0, b1, c0, c1] = points.map(|p| p.to_array().map(|v| integer(v, lowest)));
    let (d0, d1) = (determinant(&b0, &b1, &a0), determinant(&b0, &b1, &a1));
    let (e0, e1) = (determinant(&c0, &c1, &a0), determinant(&c0, &c1, &a1));
    let above = (&d0 * e1 - &d1 * e0).cmp(&IBig::ZERO);
    if d0 > d1 { above } else { above.reverse() }
}

fn determinant(p: &[IBig; 2], q: &[IBig; 2], r: &[IBig; 2]) -> IBig {
    (&q[0] - &p[0]) * (&r[1] - &p[1]) - (&q[1] - &p[1]) * (&r[0] - &p[0])
}

fn integer(v: f64, lowest: i32) -> IBig {
    let (mantissa, exponent) = mantissa(v);
    if mantissa == 0 { IBig::ZERO } else { IBig::from(mantissa) << (exponent - lowest) as usize }
}

/// A finite number as a whole one and a power of two.
fn mantissa(v: f64) -> (i64, i32) {
    let (exponent, fraction) = ((v.abs().to_bits() >> 52) as i32, (v.to_bits() & ((1 << 52) - 1)) as i64);
    let (mantissa, exponent) = if exponent == 0 { (fraction, -1074) } else { (fraction | 1 << 52, exponent - 1075) };
    (if v < 0.0 { -mantissa } else { mantissa }, exponent)
}
