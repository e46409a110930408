//! No time counts before the results are right.

use planecut_csg::{Material, Model, evaluate};

use crate::conductor::Record;
use crate::contestants::Outcome;
use crate::entrant::Entrant;
use crate::scene::{Plan, Scene};

/// The volume that all must have: the known one, else planecut's. For a plan of steps or moves that is what planecut finds
/// for all of them at once, so that its own steps are checked too.
pub(crate) fn expected(known: Option<f64>, scene: &Scene, records: &[(Entrant, Record)]) -> Option<f64> {
    if known.is_some() {
        return known;
    }
    if let Plan::Steps(_) | Plan::Moves(_) | Plan::Cuts(_) = scene.plan {
        let model = Model { materials: vec![Material::named("all")], tree: scene.at_once() };
        return evaluate(&model).ok().map(|evaluation| evaluation.solid.volume);
    }
    let ours = records.iter().filter(|(entrant, _)| entrant.is_ours());
    ours.flat_map(|(_, record)| &record.runs).map(|run| run.volume).next()
}

/// Marks the records whose results are not right.
pub(crate) fn mark(records: &mut [(Entrant, Record)], expected: Option<f64>, is_of_meshes: bool) {
    for (entrant, record) in records {
        let tolerance = entrant.tolerance(is_of_meshes);
        record.wrong = record.runs.iter().find_map(|run| fault(run, expected, tolerance));
    }
}

/// What is wrong with a result.
fn fault(outcome: &Outcome, expected: Option<f64>, tolerance: f64) -> Option<String> {
    let Outcome { volume, triangles, .. } = *outcome;
    match expected {
        None => Some(format!("volume {volume} with nothing to compare it with")),
        Some(0.0) => (triangles != 0).then(|| format!("{triangles} triangles of volume {volume} instead of none")),
        Some(right) => {
            let is_right = (volume - right).abs() <= tolerance * right.abs();
            (!is_right).then(|| format!("volume {volume} instead of {right}"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{expected, fault, mark};
    use crate::conductor::Record;
    use crate::contestants::Outcome;
    use crate::entrant::{CORES, Entrant, OPENSCAD, PLANECUT};
    use crate::workloads;

    fn outcome(volume: f64, triangles: usize) -> Outcome {
        Outcome { seconds: 1.0, volume, area: 1.0, triangles }
    }

    #[test]
    fn volumes_are_compared_relatively() {
        assert_eq!(fault(&outcome(2.0 + 1e-9, 12), Some(2.0), 1e-9), None);
        let text = fault(&outcome(2.5, 12), Some(2.0), 1e-9);
        assert_eq!(text.as_deref(), Some("volume 2.5 instead of 2"));
        assert!(fault(&outcome(f64::NAN, 12), Some(2.0), 1e-9).is_some());
        assert!(fault(&outcome(2.0, 12), None, 1e-9).is_some());
    }

    #[test]
    fn nothing_is_no_triangle_at_all() {
        assert_eq!(fault(&outcome(0.0, 0), Some(0.0), 1e-9), None);
        let text = fault(&outcome(0.0, 4), Some(0.0), 1e-9);
        assert_eq!(text.as_deref(), Some("4 triangles of volume 0 instead of none"));
    }

    #[test]
    fn one_wrong_run_spoils_an_entrant() {
        let entrant = |name| Entrant { name, cores: CORES };
        let record = |volumes: [f64; 2]| Record {
            runs: volumes.map(|volume| outcome(volume, 12)).to_vec(),
            ..Record::default()
        };
        let mut records = vec![
            (entrant(PLANECUT), record([1.0, 1.0])),
            (entrant("boolmesh"), record([1.0, 1.001])),
            (entrant(OPENSCAD), record([1.00001, 1.0])),
        ];
        mark(&mut records, Some(1.0), false);
        assert!(records[0].1.median().is_some() && records[1].1.median().is_none() && records[2].1.median().is_some());
    }

    #[test]
    fn steps_are_expected_to_give_what_they_give_at_once() {
        let task = workloads::carve_one_by_one(3);
        let at_once = expected(None, &task.scene, &[]);
        let batch = expected(None, &workloads::carve(3).scene, &[]);
        assert!(at_once.is_some_and(|volume| volume > 0.9 && volume < 1.0));
        assert_eq!(batch, None, "nobody has run it");
        assert_eq!(expected(Some(0.0), &workloads::grid_iterated(2).scene, &[]), Some(0.0));
    }
}
