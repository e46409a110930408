//! What more cores would give: how much of the work is serial, told by the times on one core and on some, and from it the times on
//! more of them by Amdahl's law.

use std::fmt::Write as _;

use crate::entrant::{CORES, PLANECUT};
use crate::markdown::significant;
use crate::report::Report;

/// The numbers of cores for which times are worked out.
const MORE: [f64; 2] = [8.0, 32.0];

/// Work that takes less is mostly waiting for threads.
const LEAST_SECONDS: f64 = 3e-3;

/// Work of which a larger share is serial does not use other cores; what is done one by one, mostly.
const MOST_SERIAL: f64 = 0.7;

/// The serial share of work that takes some time on one core and some on several.
fn serial_share(one: f64, several: f64, cores: f64) -> f64 {
    ((cores * several / one - 1.0) / (cores - 1.0)).clamp(0.0, 1.0)
}

/// The time on some cores of work that takes `one` on one, by Amdahl's law.
fn time_on(cores: f64, one: f64, serial: f64) -> f64 {
    one * (serial + (1.0 - serial) / cores)
}

/// A row for each workload that other cores help; nothing where there is none.
pub(crate) fn table(report: &Report) -> String {
    let mut rows = String::new();
    for line in &report.lines {
        let [Some(one), Some(several)] = [1, CORES].map(|cores| line.median(PLANECUT, cores)) else { continue };
        let serial = serial_share(one, several, CORES as f64);
        if one < LEAST_SECONDS || serial > MOST_SERIAL {
            continue;
        }
        let [eight, more] = MORE.map(|cores| significant(1e3 * time_on(cores, one, serial)));
        let [one, several] = [one, several].map(|seconds| significant(1e3 * seconds));
        let _ = writeln!(rows, "| {} | {one} | {several} | {:.0} % | {eight} | {more} |", line.name, 100.0 * serial);
    }
    if rows.is_empty() {
        return rows;
    }
    let head =
        format!("| workload | 1 core ms | {CORES} cores ms | serial | {} cores ms | {} cores ms |", MORE[0], MORE[1]);
    format!("{head}\n|---|---:|---:|---:|---:|---:|\n{rows}")
}

#[cfg(test)]
mod tests {
    use super::{serial_share, time_on};

    #[test]
    fn the_serial_share_is_what_amdahl_took() {
        for serial in [0.0, 0.03, 0.25, 1.0] {
            for cores in [2.0, 4.0] {
                assert!((serial_share(10.0, time_on(cores, 10.0, serial), cores) - serial).abs() < 1e-12);
            }
        }
        // faster than it can be, and slower than on one core
        assert_eq!([4.0, 12.0].map(|several| serial_share(10.0, several, 2.0)), [0.0, 1.0]);
    }
}
