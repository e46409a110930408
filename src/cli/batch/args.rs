//! What may stand on the command line of `batch`. The doc comments here are the help texts.

use std::ffi::OsString;
use std::path::PathBuf;
use std::time::Duration;

use clap::Args;

/// Arguments of `batch`.
#[derive(Debug, Args)]
pub(crate) struct BatchArgs {
    /// The jobs, one JSON object a line: {"id", "command", "input", "outputs", "options"}; `-` is standard input
    #[arg(value_name = "MANIFEST.jsonl", required_unless_present = "worker")]
    pub(crate) manifest: Option<PathBuf>,
    /// Folder for the outputs and for results.jsonl; it is made where it is missing. What is there already and up to date is not made again
    #[arg(long, value_name = "DIR", required_unless_present = "worker")]
    pub(crate) out: Option<PathBuf>,
    /// Folder that keeps what was made, by the content of the inputs; several processes and machines may share it
    #[arg(long, value_name = "DIR")]
    pub(crate) cache: Option<PathBuf>,
    /// Size that the cache is cut down to in the end; what was not used for longest goes first
    #[arg(long, value_name = "MB", requires = "cache", value_parser = clap::value_parser!(u64).range(1..=1 << 40))]
    pub(crate) cache_size: Option<u64>,
    /// Make N of the results found in the cache again, and compare the bytes
    #[arg(long, value_name = "N", requires = "cache", default_value_t = 0)]
    pub(crate) verify_cache: usize,
    /// Number of jobs at a time, each in a process; by default as many as there are cores
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) jobs: Option<u16>,
    /// Most seconds that a job may take
    #[arg(long, value_name = "S", value_parser = parse_seconds)]
    pub(crate) timeout: Option<Duration>,
    /// Most memory that a job may take, 64 or more (on Unix)
    #[arg(long, value_name = "MB", value_parser = clap::value_parser!(u64).range(64..=1 << 40))]
    pub(crate) memory: Option<u64>,
    /// Number of threads of each job; by default the cores divided by the number of jobs at a time
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// Print no progress to standard error
    #[arg(short, long)]
    pub(crate) quiet: bool,
    /// Take jobs from standard input, one after another: what the processes of a batch are started with
    #[arg(long, hide = true, conflicts_with_all = ["manifest", "out", "cache", "jobs", "timeout"])]
    pub(crate) worker: bool,
    /// The program and its arguments that such a process is started as, where it is not this program
    #[arg(long, hide = true, value_name = "WORD", allow_hyphen_values = true)]
    pub(crate) worker_command: Vec<OsString>,
    /// The address of a server that does the jobs instead; it is first told the value of PLANECUT_BATCH_TOKEN
    #[arg(long, hide = true, value_name = "HOST:PORT", conflicts_with = "worker_command")]
    pub(crate) worker_address: Option<String>,
}

fn parse_seconds(text: &str) -> Result<Duration, String> {
    let seconds = text.parse().ok().filter(|seconds: &f64| *seconds > 0.0 && *seconds <= 1e9);
    seconds.map(Duration::from_secs_f64).ok_or_else(|| "expected a number of seconds above 0".to_owned())
}
