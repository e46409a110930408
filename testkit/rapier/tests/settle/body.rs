//! A rigid body that was written, in Rapier.

use std::fs;
use std::path::Path;

use rapier3d::prelude::*;
use roxmltree::Document;

/// How far outside of all colliders a vertex may be, relative to the size: some roundings of single precision.
const SINGLE: f64 = 1e-6;

/// A body as Rapier has it.
pub(crate) struct Body {
    visual: Vec<Vector>,
    shapes: Vec<(Pose, SharedShape)>,
    mass: MassProperties,
}

impl Body {
    /// The body that an MJCF file describes.
    pub(crate) fn read(folder: &Path, name: &str) -> Self {
        let text = fs::read_to_string(folder.join(format!("{name}.xml"))).expect("text");
        let document = Document::parse(&text).expect("XML");
        let meshes = folder.join(format!("{name}_meshes"));
        let mut shapes = Vec::new();
        let class = format!("{name}_collision");
        let collision = |node: &roxmltree::Node<'_, '_>| node.attribute("class") == Some(&class);
        for geom in document.descendants().filter(|node| node.has_tag_name("geom")).filter(collision) {
            shapes.push(match geom.attribute("mesh") {
                Some(mesh) => {
                    let file = mesh.strip_prefix(&format!("{name}_")).expect("the name of the body");
                    let (points, triangles) = read_mesh(&meshes.join(format!("{file}.obj")));
                    let shape = SharedShape::convex_mesh(points, &triangles);
                    (Pose::IDENTITY, shape.unwrap_or_else(|| panic!("{name}: {mesh} is not convex for Parry")))
                }
                None => {
                    let half = vector(&numbers(geom, "size"));
                    let quaternion = geom.attribute("quat").map_or(vec![1.0, 0.0, 0.0, 0.0], |_| numbers(geom, "quat"));
                    let [w, x, y, z] = quaternion.try_into().expect("four numbers");
                    let rotation = Rotation::from_xyzw(x, y, z, w).normalize();
                    let pose = Pose::from_parts(vector(&numbers(geom, "pos")), rotation);
                    (pose, SharedShape::cuboid(half.x, half.y, half.z))
                }
            });
        }
        let inertial = document.descendants().find(|node| node.has_tag_name("inertial")).expect("inertial");
        let i = numbers(inertial, "fullinertia");
        let inertia = Matrix::from_cols_array(&[i[0], i[3], i[4], i[3], i[1], i[5], i[4], i[5], i[2]]);
        let center = vector(&numbers(inertial, "pos"));
        let mass = MassProperties::with_inertia_matrix(center, numbers(inertial, "mass")[0], inertia);
        Self { visual: read_mesh(&meshes.join("visual.obj")).0, shapes, mass }
    }

    /// How many colliders it has.
    pub(crate) fn colliders(&self) -> usize {
        self.shapes.len()
    }

    /// Fails the test unless each vertex that is seen is in one of the colliders, by the faces that Parry has of these.
    pub(crate) fn expect_enclosed(&self) {
        let size = f64::from(self.size());
        for vertex in &self.visual {
            let away = self.shapes.iter().map(|(pose, shape)| outside(shape, pose.inverse_transform_point(*vertex)));
            let away = away.fold(f64::INFINITY, f64::min);
            assert!(away <= SINGLE * size, "{vertex} is {away} away from all colliders");
        }
    }

    /// Fails the test unless the body comes to rest on the ground.
    pub(crate) fn expect_rest(&self) {
        let size = self.size();
        let mut world = PhysicsWorld { gravity: Vector::new(0.0, 0.0, -9.81), ..PhysicsWorld::default() };
        world.integration_parameters.length_unit = size;
        // a fall by its own size takes this long
        let time = (2.0 * size / 9.81).sqrt();
        world.integration_parameters.dt = time / 300.0;
        world.insert(RigidBodyBuilder::fixed(), ColliderBuilder::new(SharedShape::halfspace(Vector::Z)));
        let low = self.visual.iter().map(|vertex| vertex.z).fold(f32::INFINITY, f32::min);
        let body = RigidBodyBuilder::dynamic()
            .additional_mass_properties(self.mass)
            .translation(Vector::new(0.0, 0.0, 0.01 * size - low))
            .can_sleep(false);
        let body = world.insert_body(body);
        for (pose, shape) in &self.shapes {
            let collider = ColliderBuilder::new(shape.clone()).position(*pose).density(0.0);
            world.insert_collider(collider, Some(body));
        }
        for _ in 0..3000 {
            world.step();
        }
        let body = &world.bodies[body];
        let mass = 1.0 / self.mass.inv_mass;
        assert!((body.mass() / mass - 1.0).abs() < 1e-5, "{} kg, expected {mass}", body.mass());
        let speed = body.linvel().length() * time / size;
        assert!(speed < 1e-2, "it moves by {speed} of its size in the time of a fall");
        let seen = self.visual.iter().map(|vertex| body.position().transform_point(*vertex).z);
        let lowest = seen.fold(f32::INFINITY, f32::min) / size;
        assert!((-5e-3..5e-2).contains(&lowest), "what is seen is {lowest} of its size above the ground");
    }

    fn size(&self) -> f32 {
        let low = self.visual.iter().fold(Vector::splat(f32::INFINITY), |low, vertex| low.min(*vertex));
        let high = self.visual.iter().fold(Vector::splat(f32::NEG_INFINITY), |high, vertex| high.max(*vertex));
        (high - low).length()
    }
}

/// How far outside of the farthest face a point is. Parry's own distances are iterated in single precision, and some thousandths off.
fn outside(shape: &SharedShape, point: Vector) -> f64 {
    let exact = |v: Vector| v.to_array().map(f64::from);
    let along = |normal: [f64; 3], v: [f64; 3]| normal[0] * v[0] + normal[1] * v[1] + normal[2] * v[2];
    if let Some(cuboid) = shape.as_cuboid() {
        let (point, half) = (exact(point), exact(cuboid.half_extents));
        return (0..3).map(|k| point[k].abs() - half[k]).fold(f64::NEG_INFINITY, f64::max);
    }
    let polyhedron = shape.as_convex_polyhedron().expect("a box or a polyhedron");
    let corners: Vec<[f64; 3]> = polyhedron.points().iter().map(|corner| exact(*corner)).collect();
    let of_face = polyhedron.faces().iter().map(|face| {
        let normal = exact(face.normal);
        let reach = corners.iter().map(|corner| along(normal, *corner)).fold(f64::NEG_INFINITY, f64::max);
        along(normal, exact(point)) - reach
    });
    of_face.fold(f64::NEG_INFINITY, f64::max)
}

fn numbers(node: roxmltree::Node<'_, '_>, attribute: &str) -> Vec<f32> {
    let text = node.attribute(attribute).unwrap_or_else(|| panic!("no {attribute} in {node:?}"));
    text.split_whitespace().map(|number| number.parse().expect("a number")).collect()
}

fn vector(numbers: &[f32]) -> Vector {
    Vector::new(numbers[0], numbers[1], numbers[2])
}

/// Vertices and triangles of an OBJ file, in single precision.
fn read_mesh(path: &Path) -> (Vec<Vector>, Vec<[u32; 3]>) {
    let text = fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let (mut points, mut triangles) = (Vec::new(), Vec::new());
    for line in text.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words.as_slice() {
            ["v", coordinates @ ..] => {
                let values: Vec<f32> = coordinates.iter().map(|value| value.parse().expect("a number")).collect();
                points.push(vector(&values));
            }
            ["f", corners @ ..] => {
                let corner = |k: usize| corners[k].parse::<u32>().expect("an index") - 1;
                triangles.push([corner(0), corner(1), corner(2)]);
            }
            _ => {}
        }
    }
    (points, triangles)
}
