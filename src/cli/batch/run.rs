//! All jobs, on several threads.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, IsTerminal};
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;
use std::{env, thread};

use indicatif::{ProgressBar, ProgressDrawTarget};
use rustc_hash::{FxHashMap, FxHashSet};

use super::args::BatchArgs;
use super::cache::{Cache, Made};
use super::job::{Job, RESULTS, UNFINISHED};
use super::key::{self, Sum, with_files};
use super::process::{How, Launch, Outcome, Process};
use super::results::{JobResult, Results, is_done};
use super::verify::difference;
use super::worker::Request;
use crate::cli::error::{CliError, Done, FAILED};
use crate::cli::terminal;

/// A batch that runs.
pub(super) struct Batch<'a> {
    jobs: Vec<Job>,
    out: &'a Path,
    /// Where outputs lie until their job is done.
    unfinished: PathBuf,
    /// Held while the batch runs, so that no other one writes into the same folder.
    _lock: File,
    cache: Option<Cache>,
    cache_size: Option<u64>,
    /// Numbers of the jobs whose results are made again where they are in the cache.
    verified: FxHashSet<usize>,
    launch: Launch,
    count: usize,
    threads: u16,
    /// What an earlier batch has left, by the ids of jobs.
    before: FxHashMap<String, JobResult>,
    state: Mutex<State>,
    next: AtomicUsize,
    has_ended: AtomicBool,
    bar: ProgressBar,
}

/// What all threads write.
struct State {
    results: Option<Results>,
    done: FxHashMap<String, JobResult>,
    /// Which job has written a file.
    writers: FxHashMap<String, String>,
}

/// What has been made, before it has its place.
struct Fresh {
    status: u8,
    seconds: f64,
    error: Option<String>,
    warnings: Vec<String>,
    read: Vec<String>,
    files: Vec<String>,
}

impl Fresh {
    fn failed(seconds: f64, error: String) -> Self {
        let (warnings, read, files) = (Vec::new(), Vec::new(), Vec::new());
        Self { status: FAILED, seconds, error: Some(error), warnings, read, files }
    }
}

impl<'a> Batch<'a> {
    /// Prepares the folder of outputs and the cache.
    ///
    /// # Errors
    /// [`CliError`] where the system refuses, or another batch is at work there.
    pub(super) fn begin(args: &BatchArgs, jobs: Vec<Job>, out: &'a Path) -> Result<Self, CliError> {
        let failed = |path: &Path| {
            let path = path.to_owned();
            move |source| CliError::Write { path, source }
        };
        if out.to_str().is_none() {
            return Err(CliError::Usage(format!(
                "{}: found a name that is no UTF-8, expected one that is",
                out.display()
            )));
        }
        let unfinished = out.join(UNFINISHED);
        fs::create_dir_all(&unfinished).map_err(failed(out))?;
        let lock = unfinished.join("lock");
        let file = File::create(&lock).map_err(failed(&lock))?;
        if file.try_lock().is_err() {
            let (found, expected) = ("a folder that another batch writes into", "one of its own");
            return Err(CliError::Output { path: out.to_owned(), found, expected });
        }
        // what a batch that was killed has left
        for entry in fs::read_dir(&unfinished).map_err(failed(&unfinished))?.flatten() {
            if entry.path() != lock {
                let _ = fs::remove_dir_all(entry.path());
            }
        }
        let (results, before) = Results::open(out)?;
        let cache = args.cache.as_deref().map(|folder| Cache::open(folder).map_err(failed(folder))).transpose()?;
        let cores = thread::available_parallelism().map_or(1, NonZero::get);
        let count = args.jobs.map_or(cores, usize::from).clamp(1, jobs.len().max(1));
        let threads = args.threads.unwrap_or_else(|| (cores / count).clamp(1, 1024) as u16);
        let mut by_chance: Vec<(Sum, usize)> =
            jobs.iter().enumerate().map(|(number, job)| (Sum::of(job.id.as_bytes()), number)).collect();
        by_chance.sort_unstable();
        let bar = ProgressBar::with_draw_target(Some(jobs.len() as u64), ProgressDrawTarget::hidden());
        if !args.quiet && io::stderr().is_terminal() {
            bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        Ok(Self {
            out,
            unfinished,
            _lock: file,
            cache,
            cache_size: args.cache_size,
            verified: by_chance.into_iter().take(args.verify_cache).map(|(_, number)| number).collect(),
            launch: Launch { how: how(args)?, timeout: args.timeout, is_limited: args.memory.is_some() },
            count,
            threads,
            before,
            state: Mutex::new(State {
                results: Some(results),
                done: FxHashMap::default(),
                writers: FxHashMap::default(),
            }),
            next: AtomicUsize::new(0),
            has_ended: AtomicBool::new(false),
            bar,
            jobs,
        })
    }

    /// Does all jobs.
    ///
    /// # Errors
    /// [`CliError::Batch`] where one failed; what keeps results from being told.
    pub(super) fn run(self) -> Result<Done, CliError> {
        let outcome = thread::scope(|scope| {
            let threads: Vec<_> = (0..self.count).map(|_| scope.spawn(|| self.work())).collect();
            threads
                .into_iter()
                .try_for_each(|thread| thread.join().unwrap_or_else(|fault| std::panic::resume_unwind(fault)))
        });
        self.bar.finish_and_clear();
        outcome?;
        let mut state = self.state();
        if let Some(results) = state.results.take() {
            results.end(&self.jobs, &state.done)?;
        }
        if let (Some(cache), Some(megabytes)) = (&self.cache, self.cache_size) {
            cache.cut_down(megabytes.saturating_mul(1_000_000)).unwrap_or_else(|error| warn_of_cache(&error));
        }
        let _ = fs::remove_dir_all(&self.unfinished);
        let failed = state.done.values().filter(|result| !result.is_done()).count();
        if failed > 0 {
            return Err(CliError::Batch { path: self.out.join(RESULTS), failed, jobs: self.jobs.len() });
        }
        let is_complete = state.done.values().all(|result| result.status == 0);
        Ok(if is_complete { Done::Complete } else { Done::Incomplete })
    }

    fn state(&self) -> std::sync::MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// One job after another, with a process of its own.
    fn work(&self) -> Result<(), CliError> {
        let mut process = None;
        while !self.has_ended.load(Ordering::Relaxed) {
            let number = self.next.fetch_add(1, Ordering::Relaxed);
            let Some(job) = self.jobs.get(number) else { break };
            let told = self.result_of(number, job, &mut process).and_then(|result| self.tell(result));
            if told.is_err() {
                self.has_ended.store(true, Ordering::Relaxed);
                return told;
            }
        }
        Ok(())
    }

    fn tell(&self, result: JobResult) -> Result<(), CliError> {
        let mut state = self.state();
        let is_known = self.before.get(&result.id) == Some(&result);
        if let Some(results) = state.results.as_mut().filter(|_| !is_known) {
            results.add(&result)?;
        }
        state.done.insert(result.id.clone(), result);
        self.bar.inc(1);
        Ok(())
    }

    /// What becomes of a job.
    fn result_of(&self, number: usize, job: &Job, process: &mut Option<Process>) -> Result<JobResult, CliError> {
        // a file that cannot be read has no sum; the command says what is wrong with it
        let sum = key::of_job(job).ok();
        if let Some(known) = self.before.get(&job.id).filter(|known| self.is_up_to_date(known, sum)) {
            let mut state = self.state();
            let names = known.files.iter().map(|name| (name.clone(), job.id.clone()));
            state.writers.extend(names);
            return Ok(known.clone());
        }
        let folder = self.unfinished.join(number.to_string());
        let prepared =
            job.named_outputs().try_for_each(|name| folder.join(name).parent().map_or(Ok(()), fs::create_dir_all));
        prepared
            .and_then(|()| fs::create_dir_all(&folder))
            .map_err(|source| CliError::Write { path: folder.clone(), source })?;
        let result = self.made(number, job, sum, &folder, process);
        let _ = fs::remove_dir_all(&folder);
        result
    }

    fn is_up_to_date(&self, known: &JobResult, sum: Option<Sum>) -> bool {
        let key = sum.map(|sum| with_files(sum, &known.read).to_string());
        known.is_done()
            && key.is_some()
            && key == known.key
            && known.files.iter().all(|name| self.out.join(name).is_file())
    }

    /// The result, taken from the cache or made.
    fn made(
        &self,
        number: usize,
        job: &Job,
        sum: Option<Sum>,
        folder: &Path,
        process: &mut Option<Process>,
    ) -> Result<JobResult, CliError> {
        let found = self.cache.as_ref().zip(sum).and_then(|(cache, sum)| Some((cache, cache.find(sum)?)));
        if let Some((cache, found)) = found {
            if self.verified.contains(&number) {
                let fresh = self.execute(job, folder, process)?;
                let difference = difference(job, folder, fresh.status, &fresh.files, cache, &found);
                let key = key_of(sum, &fresh);
                let mut result = self.place(job, folder, fresh, key, true);
                if let Some(error) = difference {
                    cache.remove(&found);
                    (result.status, result.error) = (FAILED, Some(error));
                }
                return Ok(result);
            }
            let copied =
                cache.copy(&found, folder).map_err(|source| CliError::Write { path: folder.to_owned(), source })?;
            if copied {
                let entry = found.entry;
                let files = entry.files.into_iter().map(|kept| kept.name).collect();
                let (status, seconds, warnings, read) = (entry.status, entry.seconds, entry.warnings, entry.read);
                let fresh = Fresh { status, seconds, error: None, warnings, read, files };
                return Ok(self.place(job, folder, fresh, Some(found.key), true));
            }
        }
        let fresh = self.execute(job, folder, process)?;
        // an input that was written to meanwhile: nobody knows what the result follows from
        let sum = sum.filter(|sum| key::of_job(job).is_ok_and(|now| now == *sum));
        let key = key_of(sum, &fresh);
        if let (Some(cache), Some(sum), Some(key)) = (&self.cache, sum, key) {
            let Fresh { status, seconds, warnings, read, files, .. } = &fresh;
            let made = Made { status: *status, seconds: *seconds, warnings, read, files };
            // the job is done, whether others profit or not
            cache.keep(sum, key, &made, folder).unwrap_or_else(|error| warn_of_cache(&error));
        }
        Ok(self.place(job, folder, fresh, key, false))
    }

    /// Has the command carried out, its outputs in a folder.
    fn execute(&self, job: &Job, folder: &Path, process: &mut Option<Process>) -> Result<Fresh, CliError> {
        let arguments =
            job.arguments(folder, self.threads).into_iter().map(|argument| argument.to_string_lossy().into_owned());
        let request = Request { arguments: arguments.collect(), folder: folder.display().to_string() };
        let running = match process {
            Some(running) => running,
            None => process.insert(Process::start(&self.launch)?),
        };
        let begin = Instant::now();
        let answer = match running.ask(&request) {
            Outcome::Answered(answer) => answer,
            Outcome::Lost(message) => {
                *process = None;
                return Ok(Fresh::failed(begin.elapsed().as_secs_f64(), message));
            }
        };
        if answer.is_last {
            *process = None;
        }
        // outputs are called as they will be
        let told = |message: String| {
            let place = format!("{}{}", folder.display(), std::path::MAIN_SEPARATOR);
            message.replace(&place, &format!("{}{}", self.out.display(), std::path::MAIN_SEPARATOR))
        };
        let named: FxHashSet<&str> = job.named_inputs().collect();
        let mut fresh = Fresh {
            status: answer.status,
            seconds: answer.seconds,
            error: answer.error.map(told),
            warnings: answer.warnings.into_iter().map(told).collect(),
            read: answer.read.into_iter().filter(|name| !named.contains(name.as_str())).collect(),
            files: Vec::new(),
        };
        if is_done(fresh.status) {
            let written = match job.outputs.first().filter(|_| job.command.prints()) {
                Some(output) => fs::write(folder.join(output), answer.text),
                None => Ok(()),
            };
            match written.and_then(|()| files_in(folder)) {
                Ok(files) => fresh.files = files,
                Err(error) => {
                    let message =
                        format!("{}: found `{error}`, expected a place that can be written", self.out.display());
                    return Ok(Fresh::failed(answer.seconds, message));
                }
            }
        }
        Ok(fresh)
    }

    /// Gives files their names.
    fn place(&self, job: &Job, folder: &Path, fresh: Fresh, key: Option<Sum>, cached: bool) -> JobResult {
        let Fresh { mut status, seconds, mut error, warnings, read, mut files } = fresh;
        if let Err(message) = files.iter().try_for_each(|name| self.place_file(job, folder, name)) {
            (status, error) = (FAILED, Some(message));
            files.clear();
        }
        let key = key.filter(|_| is_done(status)).map(|key| key.to_string());
        JobResult { id: job.id.clone(), status, seconds, cached, error, warnings, files, read, key }
    }

    fn place_file(&self, job: &Job, folder: &Path, name: &str) -> Result<(), String> {
        let writer = self.state().writers.entry(name.to_owned()).or_insert_with(|| job.id.clone()).clone();
        let to = self.out.join(name);
        if writer != job.id {
            return Err(format!("{}: found a file of the job {writer:?}, expected another name", to.display()));
        }
        let parent = to.parent().map_or(Ok(()), fs::create_dir_all);
        parent
            .and_then(|()| fs::rename(folder.join(name), &to))
            .map_err(|error| format!("{}: found `{error}`, expected a place that can be written", to.display()))
    }
}

/// The key of what was made; nothing where it was not, or nobody knows what it follows from.
fn key_of(job: Option<Sum>, fresh: &Fresh) -> Option<Sum> {
    job.filter(|_| is_done(fresh.status)).map(|job| with_files(job, &fresh.read))
}

/// How jobs are done: by processes of this program, where nothing else is said.
fn how(args: &BatchArgs) -> Result<How, CliError> {
    if let Some(address) = &args.worker_address {
        return Ok(How::Address(address.clone(), env::var("PLANECUT_BATCH_TOKEN").unwrap_or_default()));
    }
    let mut command = args.worker_command.clone();
    if command.is_empty() {
        let program = env::current_exe();
        command
            .push(program.map_err(|error| CliError::Usage(format!("found no name of this program: {error}")))?.into());
    }
    command.extend(["batch", "--worker"].map(OsString::from));
    if let Some(megabytes) = args.memory {
        command.push(format!("--memory={megabytes}").into());
    }
    Ok(How::Command(command))
}

/// The files below a folder, by their names within it.
fn files_in(folder: &Path) -> io::Result<Vec<String>> {
    let (mut files, mut folders) = (Vec::new(), vec![folder.to_owned()]);
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next)? {
            let path = entry?.path();
            if path.is_dir() {
                folders.push(path);
            } else if let Ok(name) = path.strip_prefix(folder) {
                files.push(name.to_string_lossy().into_owned());
            }
        }
    }
    files.sort_unstable();
    Ok(files)
}

fn warn_of_cache(error: &io::Error) {
    terminal::print_warning(&format!(
        "the cache: found `{error}`, expected a place that can be written; results are not kept"
    ));
}
