//! Whether the cache holds what would be made.

use std::fs;
use std::path::Path;

use serde_json::Value;

use super::cache::{Cache, Found};
use super::job::Job;
use super::key::sum_of_file;

/// How the files that were made in a folder, and the exit status, differ from what the cache holds; nothing where they are the same.
pub(super) fn difference(
    job: &Job,
    folder: &Path,
    status: u8,
    files: &[String],
    cache: &Cache,
    found: &Found,
) -> Option<String> {
    let known = folder.join(".cached");
    let is_there = fs::create_dir(&known).and_then(|()| cache.copy(found, &known)).unwrap_or(false);
    let expected = "what is made of the same inputs";
    let kept: Vec<&String> = found.entry.files.iter().map(|kept| &kept.name).collect();
    let difference = if !is_there || status != found.entry.status || !kept.iter().copied().eq(files) {
        Some(format!("found other files or another exit status in the cache under {}, expected {expected}", found.key))
    } else {
        let differs = |name: &&String| !is_same(job, name, &folder.join(name), &known.join(name));
        let name = files.iter().find(differs);
        name.map(|name| format!("found other bytes of {name} in the cache under {}, expected {expected}", found.key))
    };
    let _ = fs::remove_dir_all(known);
    difference
}

/// Whether two files are the same; of reports all but the times.
fn is_same(job: &Job, name: &str, one: &Path, other: &Path) -> bool {
    let is_report = job.reports().any(|report| report == name);
    if !is_report {
        return matches!((sum_of_file(one), sum_of_file(other)), (Ok(one), Ok(other)) if one == other);
    }
    let timeless = |path: &Path| -> Option<Value> {
        let mut report: Value = serde_json::from_slice(&fs::read(path).ok()?).ok()?;
        report.as_object_mut()?.remove("time_ms");
        Some(report)
    };
    timeless(one).is_some_and(|report| timeless(other) == Some(report))
}
