//! Models cut open, against counts of unit cubes.

use glam::DVec3;
use planecut_csg::{Brush, CutMaterial, Material, MaterialId, Mesh, Model, Operation, Tree, evaluate};
use planecut_kernel::HalfSpace;

use planecut_testkit::random::Rng;

/// Unit cubes along each axis.
const SIDE: usize = 6;

/// A box with whole corners, as its two corners.
type Block = [[usize; 3]; 2];

fn random_block(rng: &mut Rng) -> Block {
    let spans = [0; 3].map(|_: i32| {
        let (a, b) = (rng.below(SIDE), rng.below(SIDE));
        [a.min(b), a.max(b) + 1]
    });
    [spans.map(|span| span[0]), spans.map(|span| span[1])]
}

/// A chain of operations on blocks, and the material of each.
struct Chain(Vec<(Operation, Block)>);

impl Chain {
    fn random(rng: &mut Rng) -> Self {
        let kinds =
            [Operation::Union, Operation::Union, Operation::Difference, Operation::Intersection, Operation::Xor];
        let count = 2 + rng.below(5);
        Self((0..count).map(|_| (kinds[rng.below(kinds.len())], random_block(rng))).collect())
    }

    fn model(&self) -> Model {
        let corner = |point: [usize; 3]| DVec3::from(point.map(|value| value as f64));
        let mut tree = Tree::empty();
        for (number, (kind, [low, high])) in self.0.iter().enumerate() {
            let brush = Brush::cuboid(corner(*low), corner(*high), MaterialId(number as u32));
            // The first operand of an intersection would be nothing.
            let kind = if number == 0 { Operation::Union } else { *kind };
            tree = Tree::combine(kind, [tree, brush.into()]);
        }
        let materials = (0..self.0.len()).map(|number| Material::named(format!("m{number}"))).collect();
        Model { materials, tree }
    }

    /// Whether a unit cube is solid.
    fn holds(&self, cube: [usize; 3]) -> bool {
        let mut value = false;
        for (number, (kind, [low, high])) in self.0.iter().enumerate() {
            let inside = (0..3).all(|axis| low[axis] <= cube[axis] && cube[axis] < high[axis]);
            value = match kind {
                _ if number == 0 => inside,
                Operation::Union => value || inside,
                Operation::Difference => value && !inside,
                Operation::Intersection => value && inside,
                Operation::Xor => value != inside,
                Operation::Complement => unreachable!("not drawn"),
            };
        }
        value
    }
}

fn cubes() -> impl Iterator<Item = [usize; 3]> {
    (0..SIDE.pow(3)).map(|number| [number % SIDE, number / SIDE % SIDE, number / SIDE / SIDE])
}

/// The area of the faces of some materials, from their triangles.
fn area(mesh: &Mesh, cuts: &[CutMaterial]) -> f64 {
    let of = |triangle: usize| {
        let [a, b, c] = mesh.triangles[triangle].map(|corner| mesh.positions[corner as usize]);
        let face = mesh.faces[mesh.triangle_faces[triangle] as usize];
        if cuts.iter().any(|cut| cut.id == face.material) { (b - a).cross(c - a).length() / 2.0 } else { 0.0 }
    };
    (0..mesh.triangles.len()).map(of).sum()
}

/// Half of each model is left, and its cut is as large as the layer of cubes that the plane goes through.
#[test]
fn what_is_left_and_what_is_cut_have_the_right_size() {
    let seed = 11;
    let mut rng = Rng::spread(seed);
    let mut cut_through = 0;
    for round in 0..300 {
        let chain = Chain::random(&mut rng);
        let (axis, doubled, upwards) = (rng.below(3), 1 + rng.below(2 * SIDE - 1), rng.below(2) == 1);
        let place = doubled as f64 / 2.0;
        let sign = if upwards { 1.0 } else { -1.0 };
        let case = format!("round {round} of seed {seed}: axis {axis} at {place}, {upwards}: {:?}", chain.0);
        let half_space = HalfSpace::new(DVec3::AXES[axis] * sign, place * sign).expect("a plane");
        let cut = chain.model().cut_open(&half_space);
        let evaluation = evaluate(&cut.model).unwrap_or_else(|error| panic!("{case}: {error}"));

        let part_below = |cube: [usize; 3]| (place - cube[axis] as f64).clamp(0.0, 1.0);
        let part = |cube| if upwards { part_below(cube) } else { 1.0 - part_below(cube) };
        let solid: Vec<[usize; 3]> = cubes().filter(|&cube| chain.holds(cube)).collect();
        let volume: f64 = solid.iter().map(|&cube| part(cube)).sum();
        assert!((evaluation.solid.volume - volume).abs() < 1e-9, "{case}: {} not {volume}", evaluation.solid.volume);

        let found = area(&evaluation.mesh, &cut.cuts);
        let on_plane = |layer: usize| solid.iter().filter(|cube| cube[axis] == layer).copied().collect::<Vec<_>>();
        if doubled % 2 == 1 {
            let cubes = on_plane(doubled / 2).len();
            cut_through += cubes;
            assert!((found - cubes as f64).abs() < 1e-9, "{case}: {found} not {cubes}");
        } else {
            // On a plane of the blocks faces of brushes may have been there before, and they stay.
            let near = on_plane(if upwards { doubled / 2 - 1 } else { doubled / 2 }).len();
            assert!(found < near as f64 + 1e-9, "{case}: {found} of {near}");
        }
    }
    assert!(cut_through > 300, "hardly anything was cut: {cut_through}");
}

/// What is outside of everything is cut as well, and numbers of brushes stay what they are.
#[test]
fn complements_are_cut_and_numbers_stay() {
    let hole = Brush::cuboid(DVec3::splat(-1.0), DVec3::splat(1.0), MaterialId(0));
    let room = Brush::cuboid(DVec3::splat(-2.0), DVec3::splat(2.0), MaterialId(1));
    let materials = vec![Material::named("air"), Material::named("stone")];
    // Everything but the hole, within the room.
    let tree = Tree::intersection([Tree::from(hole).complement(), room.into()]);
    let cut = Model { materials, tree }.cut_open(&HalfSpace::new(DVec3::Z, 0.5).expect("a plane"));
    let evaluation = evaluate(&cut.model).expect("closed");
    assert!((evaluation.solid.volume - (16.0 * 2.5 - 4.0 * 1.5)).abs() < 1e-12);
    assert!((area(&evaluation.mesh, &cut.cuts) - (16.0 - 4.0)).abs() < 1e-12);
    let names: Vec<&str> = cut.cuts.iter().map(|made| cut.model.materials[made.id.0 as usize].name.as_str()).collect();
    assert!(names.contains(&"stone (cut)"), "{names:?}");
    let stone = CutMaterial { id: MaterialId(3), of: Some(MaterialId(1)) };
    assert!(cut.cuts.contains(&stone), "{:?}", cut.cuts);
    assert_eq!(cut.model.tree.brushes()[1].faces.len(), 7);
}

/// A brush whose faces are of several materials has a cut without a name, and shares it with others of the kind.
#[test]
fn brushes_of_several_materials_share_a_cut() {
    let painted = |x: f64| {
        let mut brush = Brush::cuboid(DVec3::new(x, 0.0, 0.0), DVec3::new(x + 1.0, 1.0, 1.0), MaterialId(0));
        brush.faces[0].material = MaterialId(1);
        brush
    };
    let materials = vec![Material::named("a"), Material::named("b")];
    let model = Model { materials, tree: Tree::union_of(vec![painted(0.0), painted(5.0)]) };
    let cut = model.cut_open(&HalfSpace::new(DVec3::Z, 0.5).expect("a plane"));
    assert_eq!(cut.cuts, [CutMaterial { id: MaterialId(2), of: None }]);
    assert_eq!(cut.model.materials[2].name, "(cut)");
    let evaluation = evaluate(&cut.model).expect("closed");
    assert!((area(&evaluation.mesh, &cut.cuts) - 2.0).abs() < 1e-12);
}
