//! Bodies with planes that touch them without a face of their own: through an edge, or through a corner alone.

use glam::DVec3;
use planecut_cells::Solid;
use planecut_check::check_topology;
use planecut_csg::Operation::{Difference, Intersection, Union, Xor};
use planecut_csg::{
    Brush, BrushFace, Evaluation, Material, MaterialId, Model, Transform, Tree, UnboundedBrushes, evaluate_with,
};
use planecut_kernel::{HalfSpace, hull};
use planecut_shapes::primitives::{cone, cylinder, prism, sphere};

use super::random::Shape;
use super::volume::{check_membership, check_volume};
use planecut_testkit::random::Rng;
use planecut_testkit::scene::{Scene, brush, ensure, half_space, sweep};
use planecut_testkit::soundness::evaluate_soundly_with;

/// A part of a cone, halved along a plane through its axis, less a wedge that is cut by the same plane: the halving plane
/// passes through an edge between two planes of the cone.
#[test]
fn a_cone_halved_through_its_edge_less_a_wedge() {
    let of = |planes: &[([f64; 3], f64)]| {
        let face = |(normal, offset): &([f64; 3], f64)| BrushFace {
            half_space: half_space(DVec3::from_array(*normal), *offset),
            material: MaterialId(if *normal == [1.0, 0.0, 0.0] { 1 } else { 0 }),
        };
        Brush { faces: planes.iter().map(face).collect(), ..Brush::default() }
    };
    let cone = of(&[
        ([0.0, 0.0, -1.0], 0.0),
        ([0.03273661041297249, 1.0, 0.2], 50.0),
        ([-0.03273661041297249, 1.0, 0.2], 50.0),
        ([-0.9871718762704136, 0.16298273639278982, 0.2], 50.0),
        ([-0.995717846477207, 0.09806964804731377, 0.2], 50.0),
        ([-1.0, 0.03273661041297249, 0.2], 50.0),
        ([-0.936407290948122, -0.3524387480407487, 0.2], 50.0),
        ([-0.9113517740744514, -0.41292811668943097, 0.2], 50.0),
        ([-0.8823937089909251, -0.47164926374857163, 0.2], 50.0),
        ([-0.8496570985779526, -0.5283507362514284, 0.2], 50.0),
        ([-0.8132821260271381, -0.582789729787776, 0.2], 50.0),
        ([-0.7734245545553322, -0.6347331282296653, 0.2], 50.0),
        ([-0.7302550604026226, -0.6839585019704724, 0.2], 50.0),
        ([-0.3524387480407487, -0.936407290948122, 0.2], 50.0),
        ([1.0, 0.0, 0.0], 0.0),
    ]);
    let wedge = of(&[
        ([-1.0, 0.03273661041297249, 1.0], 94.0),
        ([0.995717846477207, -0.09806964804731377, 1.0], 94.0),
        ([0.0, 0.0, 1.0], 16.0),
        ([1.0, 0.0, 0.0], 0.0),
    ]);
    let materials = vec![Material::named("body"), Material::named("cut")];
    let model = Model { materials, tree: Tree::from(cone) - Tree::from(wedge) };
    let evaluation = evaluate_soundly_with(&model, UnboundedBrushes::Keep).expect("a sound mesh");
    let volume = Solid::from_tree(&model.tree).volume().expect("a bounded solid");
    assert!((evaluation.solid.volume - volume).abs() < 1e-12 * volume, "{} {volume}", evaluation.solid.volume);
}

/// The corners of a lattice body, or of a pyramid: convex bodies of which many faces meet in a point, given by their planes,
/// with some more that touch them in an edge or in a corner, in any order.
fn lattice_body(rng: &mut Rng) -> (Brush, Vec<DVec3>) {
    let integral = |rng: &mut Rng, reach: i64| DVec3::from_array([0; 3].map(|_| rng.whole(-reach, reach)));
    let shift = integral(rng, 2);
    let mut points: Vec<DVec3> = if rng.chance(0.4) {
        let base =
            [[3, 1], [1, 3], [-1, 3], [-3, 1], [-3, -1], [-1, -3], [1, -3], [3, -1], [4, 0], [0, 4], [-4, 0], [0, -4]];
        let mut points: Vec<DVec3> = base.map(|[x, y]| DVec3::new(x.into(), y.into(), -2.0)).to_vec();
        points.retain(|_| rng.chance(0.9));
        points.extend([DVec3::new(0.0, 0.0, 4.0), DVec3::new(0.0, 0.0, -4.0)]);
        points
    } else {
        (0..rng.integer(8, 30)).map(|_| integral(rng, 3)).collect()
    };
    points.iter_mut().for_each(|point| *point += shift);
    points.extend([shift - 1.0, shift + DVec3::X, shift + DVec3::Y, shift + DVec3::Z]);
    let body = hull(&points).expect("a body with an inside");
    let plane = |idx| *body.plane(idx).expect("a plane of the body");
    let mut planes: Vec<HalfSpace> = body.facets().into_iter().map(|(idx, _)| plane(idx)).collect();
    let edges: Vec<[HalfSpace; 2]> =
        body.edges().map(|(_, edge)| [plane(edge.planes.0), plane(edge.planes.1)]).collect();
    let corners: Vec<Vec<HalfSpace>> =
        body.vertices().map(|(_, vertex)| vertex.planes.iter().map(|idx| plane(*idx)).collect()).collect();
    for _ in 0..rng.integer(0, 8) {
        let through =
            if rng.chance(0.7) { rng.pick(&edges).to_vec() } else { corners[rng.below(corners.len())].clone() };
        planes.push(sum(through.iter().map(|plane| (plane, rng.whole(1, 2)))));
    }
    rng.shuffle(&mut planes);
    (brush(planes), points)
}

/// A positive combination of half-spaces: it touches what lies in all of them at most where they meet.
fn sum<'a>(planes: impl Iterator<Item = (&'a HalfSpace, f64)>) -> HalfSpace {
    let zero = (DVec3::ZERO, 0.0);
    let (normal, offset) =
        planes.fold(zero, |(n, d), (plane, weight)| (n + weight * plane.normal(), d + weight * plane.offset()));
    half_space(normal, offset)
}

/// A tree, and a half-space to which all its leaves are cut.
struct Cut {
    shape: Shape,
    by: HalfSpace,
}

impl Cut {
    /// The tree of the leaves cut.
    fn pushed(&self) -> Shape {
        fn push(shape: &Shape, by: HalfSpace) -> Shape {
            match shape {
                Shape::Leaf(brush) => {
                    let mut brush = brush.clone();
                    brush.faces.push(BrushFace { half_space: by, material: MaterialId(1) });
                    Shape::Leaf(brush)
                }
                Shape::Node(operation, operands) => {
                    Shape::Node(*operation, operands.iter().map(|operand| push(operand, by)).collect())
                }
            }
        }
        push(&self.shape, self.by)
    }

    fn judge(&self) -> Result<(), String> {
        let evaluation = evaluate_soundly_with(&self.model(), UnboundedBrushes::Keep)?;
        self.compare(&evaluation)
    }

    /// The same where a speck of the size of a rounding may be left: it counts for the box of the solid and is not in the mesh.
    fn judge_rounded(&self) -> Result<(), String> {
        let evaluation = evaluate_with(&self.model(), UnboundedBrushes::Keep).map_err(|error| error.to_string())?;
        let report = check_topology(&evaluation.mesh.positions, &evaluation.mesh.triangles);
        let is_closed = report.watertight && report.manifold || evaluation.mesh.triangles.is_empty();
        ensure!(is_closed, "not a manifold: {:?}", report.first_defect);
        self.compare(&evaluation)
    }

    /// Compares with inclusion and exclusion, with points, and with the tree cut as a whole.
    fn compare(&self, evaluation: &Evaluation) -> Result<(), String> {
        let pushed = self.pushed();
        check_volume(&pushed, evaluation)?;
        check_membership(&pushed, evaluation, 40)?;
        let whole = Shape::Node(Intersection, vec![self.shape.clone(), Shape::Leaf(brush([self.by]))]);
        let expected = evaluate_with(&whole.model(), UnboundedBrushes::Keep).map_err(|error| error.to_string())?;
        let expected = expected.solid.volume;
        let found = evaluation.solid.volume;
        ensure!((found - expected).abs() <= 1e-11 * expected.max(1.0), "volume {found}, cut as a whole {expected}");
        Ok(())
    }
}

impl Scene for Cut {
    fn model(&self) -> Model {
        self.pushed().model()
    }

    fn smaller(&self) -> Vec<Self> {
        self.shape.smaller().into_iter().map(|shape| Self { shape, by: self.by }).collect()
    }

    fn as_rust(&self) -> String {
        let (normal, offset) = (self.by.normal().to_array(), self.by.offset());
        format!("{}let by = half_space(DVec3::from_array({normal:?}), {offset:?});", self.shape.as_rust())
    }
}

/// A tree over some bodies, without a complement: where no body is, there is nothing.
fn tree_over(rng: &mut Rng, mut bodies: Vec<Brush>) -> Shape {
    let Some(last) = bodies.pop() else { return Shape::Node(Union, vec![]) };
    bodies.into_iter().fold(Shape::Leaf(last), |shape, body| {
        let operation = rng.pick(&[Union, Difference, Difference, Intersection, Xor]);
        let mut operands = vec![shape, Shape::Leaf(body)];
        rng.shuffle(&mut operands);
        Shape::Node(operation, operands)
    })
}

#[test]
fn lattice_bodies_cut_through_their_corners() {
    let generate = |rng: &mut Rng| {
        let (bodies, points): (Vec<Brush>, Vec<Vec<DVec3>>) = (0..rng.integer(2, 4)).map(|_| lattice_body(rng)).unzip();
        let points = points.concat();
        let by = loop {
            let [a, b, c] = [0; 3].map(|_| rng.pick(&points));
            let normal = (b - a).cross(c - a);
            if normal != DVec3::ZERO {
                break half_space(normal, normal.dot(a));
            }
        };
        Cut { shape: tree_over(rng, bodies), by }
    };
    sweep(400, generate, Cut::judge);
}

/// Cylinders, cones, prisms and spheres about one axis or parallel ones, cut along planes through the axis: through corners, edges,
/// and the middle of faces, some turned by so much that a component of the normal is mere noise.
#[test]
fn round_bodies_cut_through_their_axis() {
    let generate = |rng: &mut Rng| {
        let segments = rng.pick(&[8, 16, 24, 32, 48]);
        let material = MaterialId(0);
        let body = |rng: &mut Rng| {
            let (height, radius) = (rng.whole(2, 12), rng.whole(2, 9));
            let brush = match rng.integer(0, 4) {
                0 => cylinder(height, radius, 0.5 * radius, segments, material),
                1 | 2 => cone(height, radius, segments, material),
                3 => prism(height, radius, segments, material),
                _ => sphere(radius, segments / 2, material),
            };
            let across = if rng.chance(0.6) { [0.0; 2] } else { [0; 2].map(|_| rng.whole(-3, 3)) };
            let at = DVec3::new(across[0], across[1], rng.whole(-3, 3));
            let shift = Transform::translation(at).expect("a shift");
            let mut tree = Tree::from(brush.expect("a body")).transformed(&shift).expect("in range");
            tree.brushes_mut()[0].clone()
        };
        let bodies = (0..rng.integer(2, 4)).map(|_| body(rng)).collect();
        let by = if rng.chance(0.7) {
            let normal = rng.pick(&[DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::new(1.0, 1.0, 0.0)]);
            half_space(normal, 0.0)
        } else {
            let angle = rng.whole(0, 2 * i64::from(segments)) * std::f64::consts::PI / f64::from(segments);
            half_space(DVec3::new(angle.cos(), angle.sin(), 0.0), 0.0)
        };
        Cut { shape: tree_over(rng, bodies), by }
    };
    sweep(200, generate, Cut::judge_rounded);
}
