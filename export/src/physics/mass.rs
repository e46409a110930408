//! Mass, centre of mass and inertia of what a closed mesh encloses.

use glam::{DMat3, DQuat, DVec3};

use super::principal::principal_axes;

/// Mass properties of a rigid body of uniform density, in metres and kilograms.
///
/// They are integrals over the tetrahedra between a point and each triangle (Tonon 2004, [doi:10.3844/jmssp.2005.8.11](https://doi.org/10.3844/jmssp.2005.8.11)):
/// polynomials, exact but for the rounding of `f64`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MassProperties {
    /// In cubic metres.
    pub volume: f64,
    /// In kilograms.
    pub mass: f64,
    /// Centre of mass, in metres.
    pub center: DVec3,
    /// Moments of inertia about axes through the centre of mass that are parallel to x, y and z, in kg·m²: the diagonal of the inertia tensor.
    pub moments: DVec3,
    /// The tensor's entries xy, xz and yz, in kg·m²: each is *minus* the integral of the product of the two coordinates.
    pub products: DVec3,
}

/// Moments of inertia about the axes for which there are no products, and how these axes lie.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PrincipalInertia {
    /// In kg·m².
    pub moments: DVec3,
    /// Unit quaternion, w first: turns x, y and z to the axes of the three moments.
    pub rotation: [f64; 4],
}

impl MassProperties {
    /// Those of what triangles enclose that are closed and counterclockwise from outside; positions are in metres, `density` in
    /// kilograms per cubic metre. `None` where the volume, or the mass, is not a positive number.
    ///
    /// # Panics
    /// Where a triangle names a position that is not there.
    #[must_use]
    pub fn of_triangles(positions: &[DVec3], triangles: &[[u32; 3]], density: f64) -> Option<Self> {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for position in positions {
            (low, high) = (low.min(*position), high.max(*position));
        }
        // integrals about a point far away cancel: the middle first, the centre of mass then
        let middle = low.midpoint(high);
        let about = |origin: DVec3| {
            let tetrahedra = triangles.iter().map(|corners| {
                let [a, b, c] = corners.map(|corner| positions[corner as usize] - origin);
                Integrals::of_tetrahedron(a, b, c)
            });
            tetrahedra.fold(Integrals::ZERO, Integrals::plus)
        };
        let first = about(middle);
        let volume = first.volume;
        let mass = volume * density;
        if !(volume > 0.0 && mass > 0.0 && mass.is_finite()) {
            return None;
        }
        let center = middle + first.first / volume;
        let second = about(center);
        // the centre is rounded: what is left of the first moments says by how much
        let shift = second.first / volume;
        let squares = second.squares - shift * shift * volume;
        let products = second.products - DVec3::new(shift.x * shift.y, shift.x * shift.z, shift.y * shift.z) * volume;
        let moments = DVec3::new(squares.y + squares.z, squares.x + squares.z, squares.x + squares.y);
        let properties =
            Self { volume, mass, center, moments: moments * density, products: products * -density + DVec3::ZERO };
        (properties.moments.min_element() > 0.0 && properties.moments.is_finite()).then_some(properties)
    }

    /// The same inertia about its principal axes.
    #[must_use]
    pub fn principal(&self) -> PrincipalInertia {
        let (m, p) = (self.moments, self.products);
        let tensor = DMat3::from_cols_array_2d(&[[m.x, p.x, p.y], [p.x, m.y, p.z], [p.y, p.z, m.z]]);
        let (moments, axes) = principal_axes(tensor);
        let rotation = DQuat::from_mat3(&axes).normalize();
        PrincipalInertia { moments, rotation: [rotation.w, rotation.x, rotation.y, rotation.z] }
    }
}

/// Integrals of 1, of coordinates, of their squares, and of xy, xz and yz.
#[derive(Clone, Copy)]
struct Integrals {
    volume: f64,
    first: DVec3,
    squares: DVec3,
    products: DVec3,
}

impl Integrals {
    const ZERO: Self = Self { volume: 0.0, first: DVec3::ZERO, squares: DVec3::ZERO, products: DVec3::ZERO };

    /// Over the tetrahedron between the origin and a triangle, with the sign of its orientation.
    fn of_tetrahedron(a: DVec3, b: DVec3, c: DVec3) -> Self {
        let determinant = a.dot(b.cross(c));
        let sum = a + b + c;
        let mixed = |v: DVec3| DVec3::new(v.x * v.y, v.x * v.z, v.y * v.z);
        let share = determinant / 120.0;
        Self {
            volume: determinant / 6.0,
            first: sum * (determinant / 24.0),
            squares: (a * a + b * b + c * c + sum * sum) * share,
            products: (mixed(a) + mixed(b) + mixed(c) + mixed(sum)) * share,
        }
    }

    fn plus(self, other: Self) -> Self {
        Self {
            volume: self.volume + other.volume,
            first: self.first + other.first,
            squares: self.squares + other.squares,
            products: self.products + other.products,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    /// A box by its eight corners, turned and moved.
    fn cuboid(size: DVec3, rotation: DQuat, center: DVec3) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let sign = |k: u32, bit: u32| if k >> bit & 1 == 1 { 0.5 } else { -0.5 };
        let corner = |k| center + rotation * (DVec3::new(sign(k, 0), sign(k, 1), sign(k, 2)) * size);
        let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = sides.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
        ((0..8).map(corner).collect(), triangles)
    }

    fn close(found: DVec3, expected: DVec3, within: f64) {
        assert!((found - expected).abs().max_element() <= within, "found {found}, expected {expected}");
    }

    #[test]
    fn a_box_has_the_inertia_of_textbooks_wherever_it_is() {
        let size = DVec3::new(2.0, 3.0, 5.0);
        for center in [DVec3::ZERO, DVec3::new(1e3, -2e3, 5e2)] {
            let (positions, triangles) = cuboid(size, DQuat::IDENTITY, center);
            let found = MassProperties::of_triangles(&positions, &triangles, 7.0).expect("a solid");
            let mass = 7.0 * 30.0;
            assert!((found.volume - 30.0).abs() < 1e-9 && (found.mass - mass).abs() < 1e-8);
            close(found.center, center, 1e-9);
            close(found.moments, DVec3::new(34.0, 29.0, 13.0) * (mass / 12.0), 1e-6);
            close(found.products, DVec3::ZERO, 1e-6);
        }
    }

    #[test]
    fn principal_axes_are_those_of_a_turned_box() {
        let size = DVec3::new(2.0, 3.0, 5.0);
        let turn = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, -2.0) / 3.0, 0.7);
        let (positions, triangles) = cuboid(size, turn, DVec3::new(4.0, 0.0, -1.0));
        let found = MassProperties::of_triangles(&positions, &triangles, 1.0).expect("a solid");
        let PrincipalInertia { moments, rotation: [w, x, y, z] } = found.principal();
        let axes = DMat3::from_quat(DQuat::from_xyzw(x, y, z, w));
        // the tensor again
        let tensor = axes * DMat3::from_diagonal(moments) * axes.transpose();
        close(DVec3::new(tensor.x_axis.x, tensor.y_axis.y, tensor.z_axis.z), found.moments, 1e-12 * 100.0);
        close(DVec3::new(tensor.y_axis.x, tensor.z_axis.x, tensor.z_axis.y), found.products, 1e-12 * 100.0);
        // each moment belongs to one axis of the box
        for (axis, moment) in [(DVec3::X, 34.0), (DVec3::Y, 29.0), (DVec3::Z, 13.0)] {
            let own = (0..3).find(|k| axes.col(*k).dot(turn * axis).abs() > 1.0 - 1e-12).expect("an axis");
            assert!((moments[own] - moment * 30.0 / 12.0).abs() < 1e-11);
        }
    }

    #[test]
    fn prisms_over_many_sides_tend_to_a_cylinder() {
        let (radius, height, sides) = (1.5, 4.0, 4000_u32);
        let ring = |z: f64| {
            (0..sides).map(move |k| {
                let angle = 2.0 * PI * f64::from(k) / f64::from(sides);
                DVec3::new(radius * angle.cos(), radius * angle.sin(), z)
            })
        };
        let mut positions: Vec<DVec3> = ring(0.0).chain(ring(height)).collect();
        positions.extend([DVec3::ZERO, DVec3::Z * height]);
        let triangles: Vec<[u32; 3]> = (0..sides)
            .flat_map(|k| {
                let next = (k + 1) % sides;
                let (bottom, top) = (2 * sides, 2 * sides + 1);
                [
                    [k, next, next + sides],
                    [k, next + sides, k + sides],
                    [bottom, next, k],
                    [top, k + sides, next + sides],
                ]
            })
            .collect();
        let found = MassProperties::of_triangles(&positions, &triangles, 2.0).expect("a solid");
        let mass = 2.0 * PI * radius * radius * height;
        let across = mass * (3.0 * radius * radius + height * height) / 12.0;
        let expected = DVec3::new(across, across, mass * radius * radius / 2.0);
        assert!((found.mass / mass - 1.0).abs() < 1e-5);
        close(found.center, DVec3::Z * 2.0, 1e-12);
        close(found.moments, expected, 1e-5 * across);
    }

    #[test]
    fn an_octahedron_is_alike_about_all_axes() {
        let positions = [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
        let triangles: Vec<[u32; 3]> = (0..4).flat_map(|k| [[k, (k + 1) % 4, 4], [(k + 1) % 4, k, 5]]).collect();
        let found = MassProperties::of_triangles(&positions, &triangles, 3.0).expect("a solid");
        // volume 4/3, ∫x² = 2/15
        close(found.moments, DVec3::splat(3.0 * 4.0 / 15.0), 1e-15);
        close(found.products, DVec3::ZERO, 1e-16);
        let mut inward = triangles;
        inward.iter_mut().for_each(|corners| corners.swap(0, 1));
        assert_eq!(MassProperties::of_triangles(&positions, &inward, 3.0), None);
        assert_eq!(MassProperties::of_triangles(&[], &[], 3.0), None);
    }
}
