//! A list of edits that was written does to a model what the edits did.

use planecut_csg::{
    Brush, BrushId, Edit, EditError, LiveModel, Material, MaterialId, NodeId, Operation, Role, Transform,
};
use planecut_import::edits::{read_edits, write_edits};
use planecut_kernel::{DVec3, HalfSpace, PlaneIdx};
use planecut_testkit::random::Rng;

fn model() -> LiveModel {
    let mut model = LiveModel::new(vec![Material::named("stone"), Material::named("wood")]);
    let block = Brush::cuboid(DVec3::ZERO, DVec3::splat(4.0), MaterialId(0));
    model.add_brushes(vec![(block, Role::Add)]).expect("a block");
    model
}

/// Edits of all kinds, at random; some cannot be done.
fn edits(seed: u64) -> Vec<Edit> {
    let mut random = Rng::new(seed);
    let mut below = |bound: usize| random.below(bound) as u64;
    let mut edit = || {
        let mut place = || DVec3::new(below(40) as f64, below(40) as f64, below(40) as f64) / 9.7;
        let (at, size) = (place(), 0.3 + place() / 3.0);
        let (brush, plane) = (BrushId(below(7)), PlaneIdx(below(8) as usize));
        let material = MaterialId(below(2) as u32);
        let role = match below(24) {
            0 => Role::Intersect,
            1..8 => Role::Subtract,
            _ => Role::Add,
        };
        let cut = HalfSpace::new(at - 2.05, 0.7).expect("no normal is zero");
        match below(24) {
            0..3 => Edit::AddBrush { brush: Brush::cuboid(at, at + size, material), role },
            3 => Edit::AddPlane { brush, half_space: cut, material: Some(material) },
            4 => Edit::AddPlane { brush, half_space: cut, material: None },
            5 => Edit::RemovePlane { brush, plane },
            6 => Edit::MovePlane { brush, plane, offset: at.x },
            7 => Edit::RemoveBrush { brush },
            8 => Edit::TransformBrush {
                brush,
                transform: Transform::rotation(at + 0.1, 10.0 * size.x).expect("an axis"),
            },
            9 => Edit::SetRole { operand: brush.into(), role },
            10 => Edit::TurnPlane { brush, plane, half_space: cut },
            11 => Edit::SetMaterial { brush, plane: (material.0 == 0).then_some(plane), material },
            12 => Edit::RenameBrush { brush, name: (material.0 == 0).then(|| format!("brush {}", brush.0)) },
            13 => {
                Edit::CopyBrushes { brushes: vec![brush], transform: Transform::translation(size).expect("it is near") }
            }
            14 => Edit::MirrorBrushes { brushes: vec![brush], plane: cut },
            15 => Edit::Wrap {
                operands: vec![brush.into(), BrushId(below(9)).into()],
                operation: [Operation::Union, Operation::Difference, Operation::Xor][material.0 as usize],
            },
            16 => Edit::MoveBrushBefore { brush, before: (material.0 == 0).then(|| BrushId(below(9))) },
            17 => Edit::Dissolve { node: NodeId(below(3)) },
            18 => Edit::SetOperation { node: NodeId(below(3)), operation: Operation::Intersection },
            19 => Edit::MoveOperand { operand: brush.into(), to: Some(NodeId(below(3))), before: None },
            20 => Edit::BeginStep,
            21 => [Edit::CommitStep, Edit::CancelStep][material.0 as usize].clone(),
            _ => [Edit::Undo, Edit::Redo][material.0 as usize].clone(),
        }
    };
    (0..150).map(|_| edit()).collect()
}

#[test]
fn a_log_that_is_replayed_gives_the_same_model() {
    let mut triangles = 0;
    for seed in 0..40 {
        let mut model = model();
        let materials = model.materials().to_vec();
        let mut outcomes: Vec<Result<(), EditError>> = Vec::new();
        let mut log: Vec<Edit> = Vec::new();
        for edit in edits(seed) {
            let outcome = model.apply(edit.clone()).map(drop);
            if outcome.is_ok() {
                log.push(edit);
            }
            outcomes.push(outcome);
        }
        assert!(outcomes.iter().any(Result::is_err) && log.len() > 20, "seed {seed}: {outcomes:?}");
        let text = write_edits(&log, &materials);
        let again = read_edits(text.as_bytes(), "log", &materials).expect("what was written can be read");
        assert_eq!((again.edits.len(), again.materials.len()), (log.len(), 0), "seed {seed}");
        let mut replayed = self::model();
        for (line, edit) in again.edits {
            replayed.apply(edit).unwrap_or_else(|error| panic!("seed {seed}, line {line}: {error}"));
        }
        let mesh = model.mesh().expect("a closed boundary");
        triangles += mesh.triangles.len();
        assert_eq!(replayed.mesh().expect("a closed boundary"), mesh, "seed {seed}");
        assert!(replayed.brushes().eq(model.brushes()) && replayed.nodes().eq(model.nodes()), "seed {seed}");
        assert_eq!(replayed.to_model(), model.to_model(), "seed {seed}");
    }
    assert!(triangles > 2000, "{triangles}");
}
