//! The results as JSON.

use crate::plan::{ADD, ADD_FAR, BUILD, CLONE_REMOVE, PYRAMID_BASE, PYRAMID_SIDES, REMOVE, REMOVE_ADD, REMOVE_NEAR};
use crate::queries::BESIDE_PARRY;
use crate::report::{Line, Report};
use crate::robustness::{Fault, Tally};
use crate::voronoi::{FACES, NEAREST};
use planecut_bench::library::{Library, Planecut, PolySurge};
use serde_json::{Map, Value, json};

/// The medians by operation and size, the ratios of the two libraries, and every line with its spread.
pub(crate) fn json(report: &Report) -> Value {
    let mut value = operations(report, Planecut::NAME);
    value["vs_poly_surge"] = versus(report);
    value["poly_surge"] = operations(report, PolySurge::NAME);
    value["voronoi_cell_us"] = json!({"faces": voronoi(report, FACES), "nearest_60": voronoi(report, NEAREST)});
    let query = |name: &str| -> Map<String, Value> {
        let of = report.lines_of(name);
        of.map(|line| (format!("{} {}", line.library, line.size), json!(line.median()))).collect()
    };
    value["query_us"] = BESIDE_PARRY.iter().map(|name| (name.to_string(), Value::Object(query(name)))).collect();
    let memory = |m: &crate::memory::Memory| {
        json!({
            "library": m.library, "planes": m.planes, "vertices": m.vertices,
            "bytes": m.built, "bytes_a_vertex": m.built / m.vertices, "clone_bytes_a_vertex": m.cloned / m.vertices,
        })
    };
    value["memory"] = report.memory.iter().map(memory).collect();
    value["robustness"] = report.robustness.iter().map(tally).collect();
    value["rounds"] = json!(report.rounds);
    value["quick"] = json!(report.quick);
    value["spread"] = report.lines.iter().map(spread).collect();
    value
}

fn operations(report: &Report, library: &str) -> Value {
    let medians = |operation: &str| -> Map<String, Value> {
        let of = report.lines_of(operation).filter(|line| line.library == library);
        of.map(|line| (line.size.to_string(), json!(line.median()))).collect()
    };
    json!({
        "remove_in_place_us": medians(REMOVE),
        "add_us": medians(ADD),
        "remove_near_us": medians(REMOVE_NEAR),
        "add_far_us": medians(ADD_FAR),
        "remove_and_add_us": medians(REMOVE_ADD),
        "clone_remove_us": medians(CLONE_REMOVE),
        "build_us": medians(BUILD),
        "pyramid_base_us": medians(PYRAMID_BASE),
    })
}

fn versus(report: &Report) -> Value {
    let [ours, theirs] = report.failures();
    json!({
        "remove_30": report.ratio(CLONE_REMOVE, 30),
        "remove_200": report.ratio(CLONE_REMOVE, 200),
        "build_30": report.ratio(BUILD, 30),
        "build_200": report.ratio(BUILD, 200),
        "pyramid_200": report.ratio(PYRAMID_BASE, PYRAMID_SIDES),
        "robustness_failures": {"ours": ours, "poly_surge": theirs},
        "robustness_cases": report.robustness.iter().map(|tally| tally.cases).sum::<usize>(),
        "in_place_30": report.ratio(REMOVE_ADD, 30),
        "in_place_200": report.ratio(REMOVE_ADD, 200),
        "in_place_remove_30": report.ratio(REMOVE, 30),
        "in_place_remove_200": report.ratio(REMOVE, 200),
    })
}

fn voronoi(report: &Report, operation: &str) -> Map<String, Value> {
    report.lines_of(operation).map(|line| (line.library.to_owned(), json!(line.median()))).collect()
}

fn tally(tally: &Tally) -> Value {
    let faults = |library: usize| -> Map<String, Value> {
        let of = Fault::ALL.iter().zip(tally.faults[library]);
        of.map(|(fault, count)| (format!("{fault:?}").to_lowercase(), json!(count))).collect()
    };
    json!({
        "category": tally.category, "cases": tally.cases, "compared": tally.compared, "too_close": tally.too_close,
        "ours": faults(0), "poly_surge": faults(1), "our_first_seed": tally.our_first,
    })
}

fn spread(line: &Line) -> Value {
    let [min, median, max] = line.spread();
    let (operation, size, library) = (&line.operation, line.size, line.library);
    json!({"operation": operation, "planes": size, "library": library, "min_us": min, "median_us": median, "max_us": max})
}
