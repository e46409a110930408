//! Results that are kept by the content of what they follow from, in a folder that several processes and machines may share.
//!
//! `results/ab/KEY/` holds the files of a result as `0`, `1`, …, and `entry.json`, which says what they are called and what their sums are. It is made under `tmp/` and
//! moved to its place as a whole, so that it is there complete or not at all. What a job reads beside the files that it names is known only after it was done: `jobs/ab/JOB/`
//! holds a list of such files for each set that was found, and the key of a result follows from the job and the files of a list.

use std::fs::{self, File};
use std::hash::{BuildHasher, RandomState};
use std::io;
use std::path::{Path, PathBuf};
use std::process;
use std::time::{Duration, SystemTime};

use serde::{Deserialize, Serialize};

use super::key::{Sum, sum_of_file, with_files};

/// What is known of a result.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Entry {
    pub(super) status: u8,
    pub(super) seconds: f64,
    pub(super) warnings: Vec<String>,
    /// Files that were read beside those that the job names.
    pub(super) read: Vec<String>,
    pub(super) files: Vec<Kept>,
    /// The sum of the job.
    job: String,
}

/// A file of a result.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Kept {
    pub(super) name: String,
    sum: String,
}

/// What is to be kept.
pub(super) struct Made<'a> {
    pub(super) status: u8,
    pub(super) seconds: f64,
    pub(super) warnings: &'a [String],
    pub(super) read: &'a [String],
    pub(super) files: &'a [String],
}

/// A result that was found.
pub(super) struct Found {
    pub(super) key: Sum,
    pub(super) entry: Entry,
    folder: PathBuf,
}

/// The name of what says what an entry holds.
const ENTRY: &str = "entry.json";
/// How old something unfinished is before it is taken for forgotten.
const FORGOTTEN: Duration = Duration::from_secs(24 * 3600);

/// A folder of results.
pub(super) struct Cache {
    root: PathBuf,
}

impl Cache {
    /// The cache in a folder, which is made where it is missing.
    ///
    /// # Errors
    /// What the system says.
    pub(super) fn open(root: &Path) -> io::Result<Self> {
        for name in ["results", "jobs", "tmp"] {
            fs::create_dir_all(root.join(name))?;
        }
        // programs for backups leave such folders out
        let tag = root.join("CACHEDIR.TAG");
        if !tag.exists() {
            fs::write(
                tag,
                "Signature: 8a477f597d28d172789f06886806bc55\n# Results of planecut batch. See https://bford.info/cachedir/\n",
            )?;
        }
        Ok(Self { root: root.to_owned() })
    }

    /// The result of a job; nothing where none is known for the files as they are now.
    pub(super) fn find(&self, job: Sum) -> Option<Found> {
        let lists = fs::read_dir(self.place("jobs", &job.to_string())).into_iter().flatten().flatten();
        let known = lists.filter_map(|list| serde_json::from_slice::<Vec<String>>(&fs::read(list.path()).ok()?).ok());
        std::iter::once(Vec::new()).chain(known).find_map(|read| {
            let key = with_files(job, &read);
            let folder = self.place("results", &key.to_string());
            let entry = serde_json::from_slice(&fs::read(folder.join(ENTRY)).ok()?).ok()?;
            Some(Found { key, entry, folder })
        })
    }

    /// Copies the files of a result into a folder; whether they are what they were. An entry that is damaged is removed.
    ///
    /// # Errors
    /// What the system says of the folder they are copied into.
    pub(super) fn copy(&self, found: &Found, into: &Path) -> io::Result<bool> {
        for (number, Kept { name, sum }) in found.entry.files.iter().enumerate() {
            let to = into.join(name);
            if let Some(parent) = to.parent() {
                fs::create_dir_all(parent)?;
            }
            let from = found.folder.join(number.to_string());
            if !from.is_file() || fs::copy(&from, &to).is_err() || sum_of_file(&to)?.to_string() != *sum {
                self.remove(found);
                return Ok(false);
            }
        }
        // what was used last goes last
        let _ = File::options()
            .append(true)
            .open(found.folder.join(ENTRY))
            .and_then(|file| file.set_modified(SystemTime::now()));
        Ok(true)
    }

    /// Keeps a result, whose files lie in a folder. Where another process has just done the same, its result stays.
    ///
    /// # Errors
    /// What the system says.
    pub(super) fn keep(&self, job: Sum, key: Sum, made: &Made<'_>, from: &Path) -> io::Result<()> {
        let unfinished = self.unfinished();
        fs::create_dir_all(&unfinished)?;
        let kept = self.fill(&unfinished, (job, key), made, from);
        if kept.is_err() {
            let _ = fs::remove_dir_all(&unfinished);
        }
        kept
    }

    fn fill(&self, unfinished: &Path, (job, key): (Sum, Sum), made: &Made<'_>, from: &Path) -> io::Result<()> {
        let mut files = Vec::with_capacity(made.files.len());
        for (number, name) in made.files.iter().enumerate() {
            let to = unfinished.join(number.to_string());
            fs::copy(from.join(name), &to)?;
            files.push(Kept { name: name.clone(), sum: sum_of_file(&to)?.to_string() });
        }
        let Made { status, seconds, warnings, read, .. } = *made;
        let (warnings, read) = (warnings.to_vec(), read.to_vec());
        let entry = Entry { status, seconds, warnings, read, files, job: job.to_string() };
        fs::write(unfinished.join(ENTRY), serde_json::to_vec(&entry)?)?;
        let place = self.place("results", &key.to_string());
        if let Some(parent) = place.parent() {
            fs::create_dir_all(parent)?;
        }
        if fs::rename(unfinished, &place).is_err() {
            fs::remove_dir_all(unfinished)?;
            if !place.join(ENTRY).is_file() {
                return Err(io::Error::other(format!("{} cannot be named", place.display())));
            }
        }
        if made.read.is_empty() { Ok(()) } else { self.keep_list(&job.to_string(), made.read) }
    }

    fn keep_list(&self, job: &str, read: &[String]) -> io::Result<()> {
        let text = serde_json::to_vec(read)?;
        let unfinished = self.unfinished();
        fs::write(&unfinished, &text)?;
        fs::create_dir_all(self.place("jobs", job))?;
        fs::rename(&unfinished, self.list_place(job, &text))
    }

    /// Removes what was not used for longest until at most a given number of bytes is left.
    ///
    /// # Errors
    /// What the system says of the folder.
    pub(super) fn cut_down(&self, bytes: u64) -> io::Result<()> {
        let mut entries = Vec::new();
        for folder in fs::read_dir(self.root.join("results"))?.flatten() {
            for entry in fs::read_dir(folder.path()).into_iter().flatten().flatten() {
                let used = entry.path().join(ENTRY).metadata().and_then(|entry| entry.modified());
                let files = fs::read_dir(entry.path()).into_iter().flatten().flatten();
                let size: u64 = files.filter_map(|file| Some(file.metadata().ok()?.len())).sum();
                entries.push((used.unwrap_or(SystemTime::UNIX_EPOCH), entry.path(), size));
            }
        }
        entries.sort();
        let mut total: u64 = entries.iter().map(|(_, _, size)| size).sum();
        for (_, folder, size) in entries {
            if total <= bytes {
                break;
            }
            self.remove_entry(&folder);
            total -= size;
        }
        for forgotten in fs::read_dir(self.root.join("tmp"))?.flatten() {
            let age = forgotten.metadata().and_then(|made| made.modified()).ok().and_then(|made| made.elapsed().ok());
            if age.is_some_and(|age| age > FORGOTTEN) {
                let _ = fs::remove_dir_all(forgotten.path()).or_else(|_| fs::remove_file(forgotten.path()));
            }
        }
        Ok(())
    }

    /// Removes a result that was found.
    pub(super) fn remove(&self, found: &Found) {
        self.remove_entry(&found.folder);
    }

    /// Removes an entry: it is gone for others before its files are. What fails is left for the next time.
    fn remove_entry(&self, folder: &Path) {
        let list = fs::read(folder.join(ENTRY)).ok().and_then(|bytes| {
            let entry: Entry = serde_json::from_slice(&bytes).ok()?;
            (!entry.read.is_empty()).then_some(())?;
            Some(self.list_place(&entry.job, &serde_json::to_vec(&entry.read).ok()?))
        });
        let gone = self.unfinished();
        if fs::rename(folder, &gone).is_ok() {
            let _ = fs::remove_dir_all(gone);
        }
        if let Some(list) = list {
            let _ = fs::remove_file(&list);
            let _ = list.parent().map(fs::remove_dir);
        }
    }

    /// Where a sum has its folder.
    fn place(&self, kind: &str, sum: &str) -> PathBuf {
        self.root.join(kind).join(&sum[..2]).join(sum)
    }

    /// Where a job has a list of files, by its text.
    fn list_place(&self, job: &str, text: &[u8]) -> PathBuf {
        self.place("jobs", job).join(format!("{}.json", Sum::of(text)))
    }

    /// A name that no process on any machine takes as well.
    fn unfinished(&self) -> PathBuf {
        let random = RandomState::new().hash_one(SystemTime::now());
        self.root.join("tmp").join(format!("{}-{random:016x}", process::id()))
    }
}
