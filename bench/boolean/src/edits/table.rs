//! The results as tables.

use std::fmt::Write as _;

use super::bodies::BodyTimes;
use super::endurance::Stand;
use super::grid::GridTimes;
use super::maps::MapTimes;

pub(crate) fn of_map(map: &MapTimes) -> String {
    let mut table = format!(
        "`{}`: {} brushes, {} triangles; fresh build in {:.1} ms, made live in {:.1} ms{}.\n\n",
        map.name,
        map.brushes,
        map.triangles,
        map.fresh_ms,
        map.first_ms,
        if map.compared > 0 { format!("; {} meshes compared, all the same", map.compared) } else { String::new() },
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
        "| side | capsules | triangles | made live ms | one moved: median ms | 99 % ms |\n|---:|---:|---:|---:|---:|---:|\n",
    );
    for GridTimes { side, capsules, triangles, first_ms, median_ms, p99_ms } in grids {
        let _ = writeln!(table, "| {side} | {capsules} | {triangles} | {first_ms:.0} | {median_ms:.3} | {p99_ms:.2} |");
    }
    table
}

pub(crate) fn of_endurance(stands: &[Stand]) -> String {
    let mut table = String::from("| edits | MB | median ms | brushes | triangles |\n|---:|---:|---:|---:|---:|\n");
    for Stand { edits, megabytes, median_ms, brushes, triangles } in stands {
        let _ = writeln!(table, "| {edits} | {megabytes:.1} | {median_ms:.3} | {brushes} | {triangles} |");
    }
    table
}
