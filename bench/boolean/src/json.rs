//! The results as JSON.

use serde_json::{Map, Value, json};

use crate::conductor::Record;
use crate::entrant::MANIFOLD3D;
use crate::growth::growth;
use crate::machine;
use crate::process::Failure;
use crate::report::{Line, Report};
use crate::trees::Tree;

/// The ratios to manifold3d, and all times behind them.
pub(crate) fn json(report: &Report) -> Value {
    let ratios: Map<String, Value> =
        report.ratios(MANIFOLD3D).map(|(name, ratio)| (name.to_owned(), json!(ratio))).collect();
    let mut value = json!({
        "vs_manifold3d": ratios,
        "workloads": report.lines.iter().map(line).collect::<Vec<_>>(),
        "rounds": report.rounds, "quick": report.is_quick, "seconds": report.seconds,
        "versions": machine::versions().into_iter().collect::<std::collections::BTreeMap<_, _>>(),
        "processor": machine::processor(), "compiler": machine::compiler(), "commit": machine::commit(),
    });
    if !report.is_quick {
        value["growth"] = exponents(report);
        value["trees"] = report.trees.iter().map(tree).collect();
        let of_tree = |tree: &Tree| (tree.name.clone(), json!(tree.ratio()));
        value["trees_vs_manifold3d"] = report.trees.iter().map(of_tree).collect::<Map<_, _>>().into();
    }
    value
}

fn line(line: &Line) -> Value {
    let entrants: Map<String, Value> =
        line.records.iter().map(|(entrant, record)| (entrant.key(), self::record(record))).collect();
    json!({
        "name": line.name, "bodies": line.bodies, "triangles": line.triangles, "volume": line.volume,
        "of_meshes": line.is_of_meshes,
        "entrants": entrants,
    })
}

fn record(record: &Record) -> Value {
    let mut value = json!({"before_bytes": record.before, "peak_bytes": record.peak});
    if let (Some([min, median, max]), Some(last)) = (record.spread(), record.runs.last()) {
        value["min_ms"] = json!(1e3 * min);
        value["median_ms"] = json!(1e3 * median);
        value["max_ms"] = json!(1e3 * max);
        value["runs_ms"] = record.runs.iter().map(|run| 1e3 * run.seconds).collect();
        value["volume"] = json!(last.volume);
        value["area"] = json!(last.area);
        value["triangles"] = json!(last.triangles);
    }
    if let Some(error) = &record.failure {
        value["error"] = json!(error.text());
        value["over_limit"] = json!(matches!(error, Failure::OverLimit(_)));
    }
    if let Some(wrong) = &record.wrong {
        value["wrong"] = json!(wrong);
    }
    value
}

/// By series and entrant.
fn exponents(report: &Report) -> Value {
    let mut value = json!({});
    for growth in growth(report) {
        let points: Vec<Value> =
            growth.points.iter().map(|[size, seconds]| json!({"size": size, "ms": 1e3 * seconds})).collect();
        value[growth.series][growth.entrant.key()] = json!({"exponent": growth.exponent, "points": points});
    }
    value
}

fn tree(tree: &Tree) -> Value {
    let spread = |spread: Option<[f64; 3]>| spread.map(|[min, median, max]| json!([min, median, max]));
    let [ours, theirs] = tree.spreads().map(spread);
    json!({
        "name": tree.name, "planecut_min_median_max_ms": ours, "manifold3d_min_median_max_ms": theirs,
        "planecut_rounds_ms": tree.planecut_rounds, "manifold3d_rounds_ms": tree.manifold_rounds,
        "planecut_process_ms": tree.wall, "openscad_ms": tree.openscad, "vs_manifold3d": tree.ratio(),
        "planecut_volume": tree.planecut_volume, "manifold3d_volume": tree.manifold_volume,
        "wrong": tree.wrong(), "note": tree.note,
    })
}
