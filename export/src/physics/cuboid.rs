//! Convex meshes that are boxes.

use glam::{DMat3, DQuat, DVec3};
use planecut_csg::Mesh;

/// Vertices of a mesh that is taken as a box are at most this share of its diagonal away from the corners of the box, and as far as rounding moves them.
const CUBOID_TOLERANCE: f64 = 1.0 / (1_u64 << 18) as f64;

/// Rounding outward to single precision moves vertices by this share of their largest coordinate, in most cases.
const CUBOID_ROUNDING: f64 = 1.0 / (1_u64 << 21) as f64;

/// However far from the origin it is, a box differs from its mesh by no more than this share of its diagonal.
const CUBOID_MOST: f64 = 1.0 / (1_u64 << 12) as f64;

/// A turned box grows by this share of its diagonal: its rotation is rounded again by readers, to angles or to single precision.
const TURNED_MARGIN: f64 = 1.0 / (1_u64 << 21) as f64;

/// A face stands on another one, about, where the cosine between their normals is smaller.
const ABOUT_PERPENDICULAR: f64 = 0.5;

/// A box that need not be along the axes. Its numbers are values of single precision, as most engines hold them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cuboid {
    /// Its middle, in the units of the mesh.
    pub center: DVec3,
    /// Half of its length along each of its own axes.
    pub half_sizes: DVec3,
    /// Unit quaternion, w first, up to the rounding of single precision: turns x, y and z to the axes of the box.
    pub rotation: [f64; 4],
}

impl Cuboid {
    /// The box that a convex mesh is, where it is one: it has eight vertices, and each is near another corner of the box, within 2⁻¹⁸ of the diagonal and 2⁻²¹ of the
    /// largest coordinate together.
    ///
    /// The box encloses all vertices: half sizes are rounded up, and turned boxes grow by 2⁻²¹ of their diagonal. Boxes along the axes whose
    /// middle and half sizes are values of single precision are exact.
    #[must_use]
    pub fn of_mesh(mesh: &Mesh) -> Option<Self> {
        let corners: &[DVec3; 8] = mesh.positions.as_slice().try_into().ok()?;
        Self::along(corners, DQuat::IDENTITY).or_else(|| Self::along(corners, turned_to_faces(mesh)?))
    }

    /// Its corners.
    #[must_use]
    pub fn corners(&self) -> [DVec3; 8] {
        let rotation = self.turn();
        std::array::from_fn(|k| self.center + rotation * (sign_of(k) * self.half_sizes))
    }

    /// Whether it lies along the axes.
    #[must_use]
    pub fn is_along_axes(&self) -> bool {
        self.rotation == [1.0, 0.0, 0.0, 0.0]
    }

    /// The rotation, of unit length.
    pub(super) fn turn(&self) -> DQuat {
        let [w, x, y, z] = self.rotation;
        DQuat::from_xyzw(x, y, z, w).normalize()
    }

    /// The box around eight points along the axes of a rotation, where each is at a corner.
    fn along(points: &[DVec3; 8], rotation: DQuat) -> Option<Self> {
        let is_turned = rotation != DQuat::IDENTITY;
        // of the rotation as it will be read
        let back = rotation.normalize().inverse();
        let local = points.map(|point| if is_turned { back * point } else { point });
        let low = local.iter().fold(DVec3::INFINITY, |low, point| low.min(*point));
        let high = local.iter().fold(DVec3::NEG_INFINITY, |high, point| high.max(*point));
        let (middle, half) = (low.midpoint(high), (high - low) / 2.0);
        let diagonal = (high - low).length();
        let largest = points.iter().map(|point| point.abs().max_element()).fold(0.0, f64::max);
        let tolerance = (CUBOID_TOLERANCE * diagonal + CUBOID_ROUNDING * largest).min(CUBOID_MOST * diagonal);
        let mut taken = 0_u8;
        for point in local {
            let corner = usize::from(point.x > middle.x)
                | usize::from(point.y > middle.y) << 1
                | usize::from(point.z > middle.z) << 2;
            let off = point.distance(middle + sign_of(corner) * half);
            if off > tolerance {
                return None;
            }
            taken |= 1 << corner;
        }
        if taken != u8::MAX {
            return None;
        }
        let center = if is_turned { rotation.normalize() * middle } else { middle };
        let center = center.as_vec3().as_dvec3();
        let margin = if is_turned { TURNED_MARGIN * diagonal } else { 0.0 };
        let reach = points.iter().fold(DVec3::ZERO, |reach, point| {
            let away = if is_turned { back * (*point - center) } else { difference_up(*point, center) };
            reach.max(away.abs())
        });
        let half_sizes = (reach + margin).map(single_up);
        let rotation = [rotation.w, rotation.x, rotation.y, rotation.z];
        half_sizes.is_finite().then_some(Self { center, half_sizes, rotation })
    }
}

/// The signs of a corner's coordinates.
fn sign_of(corner: usize) -> DVec3 {
    let sign = |bit: usize| if corner >> bit & 1 == 1 { 1.0 } else { -1.0 };
    DVec3::new(sign(0), sign(1), sign(2))
}

/// `a − b` without a sign, rounded up where it is not exact.
fn difference_up(a: DVec3, b: DVec3) -> DVec3 {
    let difference = a - b;
    // what rounding left out (Knuth's two-sum)
    let virtual_b = a - difference;
    let lost = (a - (difference + virtual_b)) + (virtual_b - b);
    let pick = |difference: f64, lost: f64| if lost == 0.0 { difference.abs() } else { difference.abs().next_up() };
    DVec3::new(pick(difference.x, lost.x), pick(difference.y, lost.y), pick(difference.z, lost.z))
}

/// The least value of single precision that is not below.
fn single_up(value: f64) -> f64 {
    let single = value as f32;
    f64::from(if f64::from(single) < value { single.next_up() } else { single })
}

/// A rotation to the largest face of a mesh and the largest one that stands on it, in single precision.
fn turned_to_faces(mesh: &Mesh) -> Option<DQuat> {
    let mut areas = vec![0.0; mesh.faces.len()];
    for (corners, face) in mesh.triangles.iter().zip(&mesh.triangle_faces) {
        let [a, b, c] = corners.map(|corner| mesh.positions[corner as usize]);
        areas[*face as usize] += (b - a).cross(c - a).length();
    }
    let largest = |is_meant: &dyn Fn(DVec3) -> bool| {
        let faces = (0..areas.len()).filter(|face| is_meant(mesh.faces[*face].normal));
        // of equal ones the first
        faces.rev().max_by(|a, b| areas[*a].total_cmp(&areas[*b])).map(|face| mesh.faces[face].normal)
    };
    let first = largest(&|_| true)?.try_normalize()?;
    let second = largest(&|normal| normal.dot(first).abs() < ABOUT_PERPENDICULAR)?;
    let second = second.reject_from_normalized(first).try_normalize()?;
    let rotation = DQuat::from_mat3(&DMat3::from_cols(first, second, first.cross(second)));
    Some(DQuat::from_array(rotation.to_array().map(|part| f64::from(part as f32))))
}

#[cfg(test)]
mod tests {
    use planecut_csg::{Brush, MaterialId, Model, Tree, evaluate};
    use planecut_kernel::HalfSpace;
    use planecut_testkit::random::Rng;

    use super::*;

    fn mesh_of(half_spaces: &[(DVec3, f64)]) -> Mesh {
        let half_spaces = half_spaces.iter().map(|(normal, d)| HalfSpace::new(*normal, *d).expect("a plane"));
        let brush = Brush::from_half_spaces(half_spaces, MaterialId(0));
        let materials = vec![planecut_csg::Material::named("any")];
        evaluate(&Model { materials, tree: Tree::from(brush) }).expect("a mesh").mesh
    }

    fn turned_box(center: DVec3, half: DVec3, turn: DQuat, lean: f64) -> Mesh {
        let axes = [(DVec3::X, half.x), (DVec3::Y, half.y), (DVec3::Z, half.z)];
        let half_spaces: Vec<(DVec3, f64)> = axes
            .into_iter()
            .flat_map(|(axis, half)| {
                [1.0, -1.0].map(|side| {
                    let leaning = if side > 0.0 { axis + DVec3::new(0.0, lean * axis.x, 0.0) } else { axis };
                    let normal = (turn * leaning.normalize()) * side;
                    (normal, normal.dot(center) + half)
                })
            })
            .collect();
        mesh_of(&half_spaces)
    }

    fn encloses(cuboid: &Cuboid, points: &[DVec3]) -> bool {
        let back = cuboid.turn().inverse();
        points.iter().all(|point| (back * (*point - cuboid.center)).abs().cmple(cuboid.half_sizes).all())
    }

    #[test]
    fn a_box_on_a_grid_is_exact() {
        let mesh = turned_box(DVec3::new(0.5, -1.0, 2.25), DVec3::new(0.5, 3.0, 0.25), DQuat::IDENTITY, 0.0);
        let expected = Cuboid {
            center: DVec3::new(0.5, -1.0, 2.25),
            half_sizes: DVec3::new(0.5, 3.0, 0.25),
            rotation: [1.0, 0.0, 0.0, 0.0],
        };
        assert_eq!(Cuboid::of_mesh(&mesh), Some(expected));
    }

    #[test]
    fn turned_boxes_are_found_and_enclosed_and_others_are_not() {
        let mut rng = Rng::new(5);
        for round in 0..300 {
            let mut random = || rng.integer(1, 1 << 30) as f64 / (1 << 30) as f64;
            let turn = DQuat::from_xyzw(random(), random() - 0.5, random() - 0.5, random()).normalize();
            let half = DVec3::new(random() + 0.01, random() + 0.01, (random() + 0.01) / 50.0);
            let center = DVec3::new(random(), random(), random()) * 10.0;
            let mut mesh = turned_box(center, half, turn, 0.0);
            // as files of single precision have it
            mesh.positions.iter_mut().for_each(|position| *position = position.as_vec3().as_dvec3());
            let found = Cuboid::of_mesh(&mesh).unwrap_or_else(|| panic!("seed 5, round {round}: {mesh:?}"));
            assert!(encloses(&found, &mesh.positions), "seed 5, round {round}");
            let volume = 8.0 * half.element_product();
            let added = 8.0 * found.half_sizes.element_product() / volume - 1.0;
            // the thinnest is 1/7000 of the diagonal
            assert!((-1e-3..2e-2).contains(&added), "seed 5, round {round}: {added}");
            let leaning = turned_box(center, half, turn, 0.01);
            assert_eq!(Cuboid::of_mesh(&leaning), None, "seed 5, round {round}");
        }
    }

    #[test]
    fn other_bodies_with_eight_corners_are_no_boxes() {
        // a pyramid's stump; a wedge has six corners, a cube without one ten
        let mut mesh = turned_box(DVec3::ZERO, DVec3::ONE, DQuat::IDENTITY, 0.0);
        mesh.positions.iter_mut().filter(|position| position.z > 0.0).for_each(|position| position.x *= 0.9);
        assert_eq!(Cuboid::of_mesh(&mesh), None);
        assert_eq!(Cuboid::of_mesh(&Mesh::default()), None);
    }

    #[test]
    fn numbers_are_rounded_up_only_where_they_must() {
        assert_eq!(single_up(0.5), 0.5);
        assert!(single_up(0.1) >= 0.1 && single_up(0.1) < 0.1 + 1e-8);
        assert_eq!(difference_up(DVec3::splat(3.0), DVec3::splat(1.0)), DVec3::splat(2.0));
        assert!(difference_up(DVec3::splat(1.0), DVec3::splat(-1e-30)).x > 1.0);
    }
}
