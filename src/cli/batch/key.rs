//! What a result follows from, as one number: the content of all that is read, what is asked for, and the version of the program.

use std::fmt;
use std::fs::File;
use std::io::{self, ErrorKind, Read};
use std::path::Path;

use sha2::{Digest, Sha256};

use super::job::Job;

/// A SHA-256 sum.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Sum([u8; 32]);

impl Sum {
    /// The sum of some bytes.
    pub(super) fn of(bytes: &[u8]) -> Self {
        Self(Sha256::digest(bytes).into())
    }
}

impl fmt::Display for Sum {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

/// Bytes at a time of a file that is summed.
const CHUNK: usize = 1 << 16;

/// Texts and bytes, each with its length before it, so that none can be taken for two.
#[derive(Default)]
struct Fields(Sha256);

impl Fields {
    fn add(&mut self, bytes: &[u8]) {
        self.0.update((bytes.len() as u64).to_le_bytes());
        self.0.update(bytes);
    }

    fn end(self) -> Sum {
        Sum(self.0.finalize().into())
    }
}

/// The sum of a file's content.
///
/// # Errors
/// What the system says.
pub(super) fn sum_of_file(path: &Path) -> io::Result<Sum> {
    let mut file = File::open(path)?;
    let mut sum = Sha256::new();
    let mut chunk = vec![0; CHUNK];
    loop {
        match file.read(&mut chunk) {
            Ok(0) => return Ok(Sum(sum.finalize().into())),
            Ok(count) => sum.update(&chunk[..count]),
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
}

/// What is known of a job before it is done: its command, options, names and the content of the files that it names.
///
/// # Errors
/// What the system says of a file that cannot be read, or is none: such a job has no key.
pub(super) fn of_job(job: &Job) -> io::Result<Sum> {
    let mut fields = Fields::default();
    fields.add(concat!("planecut ", env!("CARGO_PKG_VERSION")).as_bytes());
    fields.add(job.command.name().as_bytes());
    // names are in reports, and decide on formats
    for output in &job.outputs {
        fields.add(output.as_bytes());
    }
    fields.add(b"options");
    for (name, value) in &job.options {
        fields.add(name.as_bytes());
        fields.add(value.to_string().as_bytes());
    }
    fields.add(b"inputs");
    for input in job.named_inputs() {
        let path = Path::new(input);
        if !path.metadata()?.is_file() {
            return Err(ErrorKind::InvalidInput.into());
        }
        fields.add(input.as_bytes());
        fields.add(&sum_of_file(path)?.0);
    }
    Ok(fields.end())
}

/// The key of a result: that of the job, and the files that it was found to read besides, some of which may be missing.
pub(super) fn with_files(job: Sum, files: &[String]) -> Sum {
    let mut fields = Fields::default();
    fields.add(&job.0);
    for file in files {
        fields.add(file.as_bytes());
        match sum_of_file(Path::new(file)) {
            Ok(sum) => fields.add(&sum.0),
            Err(_) => fields.add(b"missing"),
        }
    }
    fields.end()
}
