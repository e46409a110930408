//! Exact answers by trying all subsets of planes.

use std::array::from_fn;

use dashu_int::{IBig, UBig, ops::SquareRoot};
use dashu_ratio::RBig;

use super::cases::Coefficients;

pub(crate) type Vector = [RBig; 3];

/// A plane `n·x ≤ d`.
#[derive(Debug, Clone)]
pub(crate) struct Plane {
    pub(crate) n: Vector,
    pub(crate) d: RBig,
}

pub(crate) fn rational(v: f64) -> RBig {
    RBig::try_from(v).expect("a finite number")
}

pub(crate) fn vector(v: [f64; 3]) -> Vector {
    v.map(rational)
}

pub(crate) fn planes(coefficients: &[Coefficients]) -> Vec<Plane> {
    coefficients.iter().map(|&[x, y, z, d]| Plane { n: vector([x, y, z]), d: rational(d) }).collect()
}

pub(crate) fn dot(a: &Vector, b: &Vector) -> RBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

pub(crate) fn minus(a: &Vector, b: &Vector) -> Vector {
    from_fn(|k| &a[k] - &b[k])
}

pub(crate) fn cross(a: &Vector, b: &Vector) -> Vector {
    from_fn(|k| {
        let (u, v) = ((k + 1) % 3, (k + 2) % 3);
        &a[u] * &b[v] - &a[v] * &b[u]
    })
}

pub(crate) fn is_zero(v: &Vector) -> bool {
    v.iter().all(|c| *c == RBig::ZERO)
}

/// Whether a number is the rounded value, to within `ulps` units in the last place of 53 bits.
pub(crate) fn is_close(got: f64, exact: &RBig, ulps: u32) -> bool {
    let scale = RBig::from(IBig::ONE << 52usize);
    let off = (rational(got) - exact) * scale;
    let size = if *exact < RBig::ZERO { -exact.clone() } else { exact.clone() };
    let room = size * RBig::from(ulps);
    off <= room && -off <= room
}

/// Solves `Σ xᵢ·columnᵢ = b` for independent columns (1 to `N`); `None` where there is no or no unique solution.
pub(crate) fn solve<const N: usize>(columns: &[[RBig; N]], b: &[RBig; N]) -> Option<Vec<RBig>> {
    let count = columns.len();
    let mut m: Vec<Vec<RBig>> =
        (0..N).map(|row| columns.iter().map(|c| c[row].clone()).chain([b[row].clone()]).collect()).collect();
    for column in 0..count {
        let pivot = (column..N).find(|row| m[*row][column] != RBig::ZERO)?;
        m.swap(column, pivot);
        for row in 0..N {
            if row != column && m[row][column] != RBig::ZERO {
                let factor = &m[row][column] / &m[column][column];
                let pivot_row = m[column].clone();
                for (value, above) in m[row].iter_mut().zip(pivot_row).skip(column) {
                    *value -= &factor * above;
                }
            }
        }
    }
    let consistent = (count..N).all(|row| m[row][count] == RBig::ZERO);
    consistent.then(|| (0..count).map(|i| &m[i][count] / &m[i][i]).collect())
}

/// All subsets of `1..=most` of `n` indices.
pub(crate) fn subsets(n: usize, most: usize) -> Vec<Vec<usize>> {
    let mut all: Vec<Vec<usize>> = (0..n).map(|i| vec![i]).collect();
    let mut begin = 0;
    for _ in 1..most {
        let end = all.len();
        for at in begin..end {
            let last = *all[at].last().expect("subsets are not empty");
            for next in last + 1..n {
                let mut longer = all[at].clone();
                longer.push(next);
                all.push(longer);
            }
        }
        begin = end;
    }
    all
}

/// The largest `direction·x` over the set, which has an interior: the smallest dual value; `None` where unbounded.
pub(crate) fn support(planes: &[Plane], direction: &Vector) -> Option<RBig> {
    let value = |subset: Vec<usize>| {
        let normals: Vec<Vector> = subset.iter().map(|i| planes[*i].n.clone()).collect();
        let weights = solve(&normals, direction)?;
        let feasible = weights.iter().all(|w| *w >= RBig::ZERO);
        feasible.then(|| subset.iter().zip(weights).fold(RBig::ZERO, |sum, (i, w)| sum + w * &planes[*i].d))
    };
    subsets(planes.len(), 3).into_iter().filter_map(value).min()
}

pub(crate) fn contains(planes: &[Plane], point: &Vector) -> bool {
    planes.iter().all(|plane| dot(&plane.n, point) <= plane.d)
}

/// The distinct vertices.
pub(crate) fn vertices(planes: &[Plane]) -> Vec<Vector> {
    let mut found: Vec<Vector> = Vec::new();
    for subset in subsets(planes.len(), 3).into_iter().filter(|s| s.len() == 3) {
        let rows: [&Plane; 3] = from_fn(|k| &planes[subset[k]]);
        let columns: Vec<Vector> = (0..3).map(|k| from_fn(|row| rows[row].n[k].clone())).collect();
        let Some(point) = solve(&columns, &rows.map(|plane| plane.d.clone())) else { continue };
        let point: Vector = from_fn(|k| point[k].clone());
        if contains(planes, &point) && !found.contains(&point) {
            found.push(point);
        }
    }
    found
}

/// The nearest point of a set with an interior: of all projections onto flats the nearest one that belongs to it.
pub(crate) fn closest(planes: &[Plane], point: &Vector) -> (Vector, RBig) {
    let mut best = contains(planes, point).then(|| (point.clone(), RBig::ZERO));
    for subset in subsets(planes.len(), 3) {
        let normals: Vec<&Vector> = subset.iter().map(|i| &planes[*i].n).collect();
        let excess: [RBig; 3] =
            from_fn(|k| subset.get(k).map_or(RBig::ZERO, |i| dot(&planes[*i].n, point) - &planes[*i].d));
        let gram: Vec<[RBig; 3]> =
            normals.iter().map(|p| from_fn(|k| normals.get(k).map_or(RBig::ZERO, |q| dot(p, q)))).collect();
        let Some(weights) = solve(&gram, &excess) else { continue };
        let foot: Vector =
            from_fn(|k| normals.iter().zip(&weights).fold(point[k].clone(), |sum, (n, w)| sum - &n[k] * w));
        let away = minus(&foot, point);
        let squared = dot(&away, &away);
        if best.as_ref().is_none_or(|(_, least)| squared < *least) && contains(planes, &foot) {
            best = Some((foot, squared));
        }
    }
    best.expect("a set with an interior has a nearest point")
}

/// `√value` to about 300 bits.
pub(crate) fn square_root(value: &RBig) -> RBig {
    const BITS: usize = 300;
    let (numerator, denominator) = (value.numerator().clone(), value.denominator().clone());
    let product: UBig = (numerator.into_parts().1 * &denominator) << (2 * BITS);
    // relative precision: tiny values get more bits
    let root = product.sqrt();
    RBig::from_parts(IBig::from(root), denominator << BITS)
}

/// The corners of each face in order, counter-clockwise seen along `−n`; of equal planes the first one has it.
pub(crate) fn faces(planes: &[Plane], vertices: &[Vector]) -> Vec<(usize, Vec<Vector>)> {
    let mut faces: Vec<(usize, Vec<Vector>)> = Vec::new();
    for (i, plane) in planes.iter().enumerate() {
        let on: Vec<Vector> = vertices.iter().filter(|v| dot(&plane.n, v) == plane.d).cloned().collect();
        let spans = on.len() >= 3 && on.iter().any(|v| !is_zero(&cross(&minus(&on[1], &on[0]), &minus(v, &on[0]))));
        let is_copy = |(j, _): &(usize, Vec<Vector>)| {
            let other = &planes[*j];
            is_zero(&cross(&plane.n, &other.n))
                && dot(&plane.n, &other.n) > RBig::ZERO
                && dot(&other.n, &on[0]) == other.d
        };
        if spans && !faces.iter().any(is_copy) {
            faces.push((i, wrap(&plane.n, &on)));
        }
    }
    faces
}

/// Gift wrapping of coplanar points in convex position.
fn wrap(normal: &Vector, points: &[Vector]) -> Vec<Vector> {
    let mut ring = vec![0];
    loop {
        let at = *ring.last().expect("it begins with one");
        let leads = |next: &usize| {
            let along = minus(&points[*next], &points[at]);
            *next != at && points.iter().all(|p| dot(normal, &cross(&along, &minus(p, &points[at]))) >= RBig::ZERO)
        };
        let next = (0..points.len()).find(leads).expect("convex position");
        if next == 0 {
            return ring.into_iter().map(|i| points[i].clone()).collect();
        }
        ring.push(next);
    }
}
