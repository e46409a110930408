//! The results as tables.

use std::fmt::Write as _;

use super::bodies::BodyTimes;
use super::dragging::Dragged;
use super::endurance::Stand;
use super::grid::GridTimes;
use super::maps::{MapTimes, Times};
use super::questions::QuestionTimes;

pub(crate) fn of_map(map: &MapTimes) -> String {
    let mut table = format!(
        "`{}`: {} brushes, {} triangles; fresh build in {:.1} ms, made live in {:.1} ms{}.\n\n",
        map.name,
        map.brushes,
        map.triangles,
        map.fresh_ms,
        map.first_ms,
        compared(map.compared),
    );
    table += "| edit | how many | median ms | 99 % ms | slowest ms | fresh build / median |\n|---|---:|---:|---:|---:|---:|\n";
    for kind in &map.kinds {
        let _ = writeln!(
            table,
            "| {} | {} | {:.3} | {:.2} | {:.2} | {:.0}× |",
            kind.name, kind.edits, kind.median_ms, kind.p99_ms, kind.max_ms, kind.fresh_ratio
        );
    }
    table
}

pub(crate) fn of_bodies(bodies: &[BodyTimes]) -> String {
    let mut table = String::from(
        "| planes | built from all | one added | moved | removed | facets listed | edit: add | move | remove | replace |\n\
         |---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n",
    );
    for BodyTimes { planes, rebuild_us, kernel_us: kernel, facets_us, edit_us: edit, replace_us } in bodies {
        let _ = writeln!(
            table,
            "| {planes} | {rebuild_us:.1} | {:.2} | {:.2} | {:.2} | {facets_us:.1} | {:.0} | {:.0} | {:.0} | {replace_us:.0} |",
            kernel[0], kernel[1], kernel[2], edit[0], edit[1], edit[2]
        );
    }
    table
}

pub(crate) fn of_grids(grids: &[GridTimes]) -> String {
    let mut table = String::from(
        "| side | capsules | triangles | fresh build ms | made live ms | made live / fresh | one moved: median ms | 99 % ms | signs |\n\
         |---:|---:|---:|---:|---:|---:|---:|---:|---:|\n",
    );
    for GridTimes { side, capsules, triangles, fresh_ms, first_ms, median_ms, p99_ms, signs } in grids {
        let ratio = first_ms / fresh_ms;
        let _ = writeln!(
            table,
            "| {side} | {capsules} | {triangles} | {fresh_ms:.0} | {first_ms:.0} | {ratio:.2}× | {median_ms:.3} | {p99_ms:.2} | {signs:.0} |"
        );
    }
    table
}

pub(crate) fn of_dragged(dragged: &Dragged) -> String {
    let mut table = format!(
        "{}: {} triangles; fresh build in {:.1} ms{}.\n\n",
        dragged.name,
        dragged.triangles,
        dragged.fresh_ms,
        compared(dragged.compared)
    );
    table += "| dragged | small steps | median ms | 99 % ms | slowest ms | fresh build / median | jumps | median ms | 99 % ms | slowest ms | fresh build / median |\n";
    table += "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n";
    for drag in &dragged.drags {
        let _ = write!(table, "| {}", drag.name);
        for times in [&drag.smooth, &drag.jumps] {
            let Times { edits, median_ms, p99_ms, max_ms, fresh_ratio, .. } = times;
            let _ = write!(table, " | {edits} | {median_ms:.3} | {p99_ms:.2} | {max_ms:.2} | {fresh_ratio:.1}×");
        }
        table += " |\n";
    }
    table
}

pub(crate) fn of_questions(questions: &[QuestionTimes]) -> String {
    let mut table = String::from(
        "| model | triangles | a ray: median µs | 99 % µs | measures: first ms | after an edit µs | buffers of added faces µs |\n\
         |---|---:|---:|---:|---:|---:|---:|\n",
    );
    for times in questions {
        let QuestionTimes { name, triangles, first_measures_ms, measures_us, buffers_us, pick_us, pick_p99_us, .. } =
            times;
        let _ = writeln!(
            table,
            "| {name} | {triangles} | {pick_us:.1} | {pick_p99_us:.0} | {first_measures_ms:.2} | {measures_us:.1} | {buffers_us:.1} |"
        );
    }
    table
}

/// How many meshes were compared with those of models built from scratch, if any.
fn compared(count: usize) -> String {
    if count > 0 { format!("; {count} meshes compared, all the same") } else { String::new() }
}

pub(crate) fn of_endurance(stands: &[Stand]) -> String {
    let mut table = String::from("| edits | MB | median ms | brushes | triangles |\n|---:|---:|---:|---:|---:|\n");
    for Stand { edits, megabytes, median_ms, brushes, triangles } in stands {
        let _ = writeln!(table, "| {edits} | {megabytes:.1} | {median_ms:.3} | {brushes} | {triangles} |");
    }
    table
}
