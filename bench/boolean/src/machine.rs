//! Where and on what a run was made, and how processes are kept on some of its cores.

use std::process::{Command, Stdio};

/// The processor's model and how many of its cores are here.
pub(crate) fn processor() -> String {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let field = |name: &str| {
        let line = text.lines().find(|line| line.starts_with(name))?;
        Some(line.split_once(':')?.1.trim().to_owned())
    };
    let model = field("model name").unwrap_or_else(|| std::env::consts::ARCH.to_owned());
    let numbers = match (field("cpu family"), field("model\t")) {
        (Some(family), Some(number)) => format!(" (family {family}, model {number})"),
        _ => String::new(),
    };
    format!("{cores} cores of {model}{numbers}")
}

/// Mean number of running processes in the last minute; those of this run are among them.
pub(crate) fn load() -> Option<String> {
    std::fs::read_to_string("/proc/loadavg").ok()?.split_whitespace().next().map(str::to_owned)
}

/// The compiler's own words.
pub(crate) fn compiler() -> String {
    output("rustc", &["--version"]).unwrap_or_else(|| "unknown compiler".to_owned())
}

/// The commit, with a mark where files differ from it.
pub(crate) fn commit() -> String {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
    let git = |arguments: &[&str]| output("git", &[&["--no-optional-locks", "-C", root], arguments].concat());
    let Some(commit) = git(&["rev-parse", "--short", "HEAD"]) else { return "unknown commit".to_owned() };
    let changed = git(&["status", "--porcelain", "--", "kernel", "csg", "bench/boolean"]);
    format!("commit {commit}{}", if changed.is_none_or(|files| !files.is_empty()) { " with changes" } else { "" })
}

/// The other kernels with their versions, as they are pinned.
pub(crate) fn versions() -> Vec<(&'static str, &'static str)> {
    let wheels = include_str!("../../../validate/requirements.txt").lines();
    let mut all: Vec<(&str, &str)> = wheels.filter_map(|line| line.split_once("==")).collect();
    all.retain(|(name, _)| *name == "manifold3d");
    let crates = include_str!("../Cargo.lock").split("[[package]]");
    for lines in crates.map(|package| package.lines().collect::<Vec<_>>()) {
        let field = |name: &str| {
            lines.iter().find_map(|line| line.strip_prefix(name)?.strip_prefix(" = \"")?.strip_suffix('"'))
        };
        if let (Some(name @ ("manifold-rust" | "boolmesh" | "csgrs")), Some(version)) =
            (field("name"), field("version"))
        {
            all.push((name, version));
        }
    }
    all
}

/// Whether a program can be started.
pub(crate) fn has(program: &str) -> bool {
    let mut command = Command::new(program);
    command.arg("--version").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command.status().is_ok()
}

/// A command that is limited to a number of cores where `taskset` is there, else one that may use all.
pub(crate) fn pinned(program: &str, cores: usize) -> Command {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let list = status.lines().find_map(|line| line.strip_prefix("Cpus_allowed_list:"));
    match list.map(|list| first_of(list, cores)) {
        Some(list) if !list.is_empty() && has("taskset") => {
            let mut command = Command::new("taskset");
            command.args(["--cpu-list", &list, program]);
            command
        }
        _ => Command::new(program),
    }
}

/// The first numbers of a list such as `0-3,8`.
fn first_of(list: &str, count: usize) -> String {
    let range = |part: &str| {
        let (first, last) = part.split_once('-').unwrap_or((part, part));
        Some(first.parse::<usize>().ok()?..=last.parse::<usize>().ok()?)
    };
    let numbers = list.trim().split(',').filter_map(range).flatten();
    numbers.take(count).map(|number| number.to_string()).collect::<Vec<_>>().join(",")
}

fn output(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::{first_of, versions};

    #[test]
    fn all_versions_are_known() {
        let mut names: Vec<&str> = versions().iter().map(|(name, _)| *name).collect();
        names.sort_unstable();
        assert_eq!(names, ["boolmesh", "csgrs", "manifold-rust", "manifold3d"]);
    }

    #[test]
    fn cores_are_taken_from_the_front() {
        assert_eq!(["0-1", "0-7", " 3,5-6,9\n", "2", ""].map(|list| first_of(list, 2)), ["0,1", "0,1", "3,5", "2", ""]);
    }
}
