//! Files and streams as bytes, no more of them than is accepted.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, ErrorKind, Read};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use crate::source::MAX_TEXT;

/// Most bytes of a mesh in a file: 4 GiB. Of anything else, and of what is no regular file, at most [`MAX_TEXT`] are read.
pub const MAX_MESH: u64 = 1 << 32;

/// Bytes of a stream that are read at once; so much more than the stream itself is in memory.
const CHUNK: usize = 1 << 24;

/// The files that were asked for while somebody wants to know.
static RECORD: Mutex<Option<BTreeSet<PathBuf>>> = Mutex::new(None);

/// From now on the names of all files that are read are noted, those that turn out to be missing, too: what a result follows from. In all threads of the process.
pub fn begin_record() {
    *RECORD.lock().unwrap_or_else(PoisonError::into_inner) = Some(BTreeSet::new());
}

/// Ends what [`begin_record`] began, and gives the names, as they were given, in their order.
#[must_use]
pub fn end_record() -> BTreeSet<PathBuf> {
    RECORD.lock().unwrap_or_else(PoisonError::into_inner).take().unwrap_or_default()
}

/// Notes that a file is read.
pub(crate) fn record(path: &Path) {
    if let Some(record) = RECORD.lock().unwrap_or_else(PoisonError::into_inner).as_mut() {
        record.insert(path.to_owned());
    }
}

/// The bytes of a file, `limit` of them at most, or [`MAX_TEXT`] where it is no regular file: devices and pipes may have no end.
///
/// # Errors
/// What the system says; [`ErrorKind::FileTooLarge`] where there are more bytes, [`ErrorKind::OutOfMemory`] where there is no memory for them.
pub fn read_file(path: &Path, limit: u64) -> io::Result<Vec<u8>> {
    record(path);
    let mut file = File::open(path)?;
    let metadata = file.metadata()?;
    if !metadata.is_file() {
        return read_stream(file, limit.min(MAX_TEXT as u64));
    }
    if metadata.len() > limit {
        return Err(too_large(limit));
    }
    let mut bytes = with_room(metadata.len() as usize)?;
    (&mut file).take(metadata.len()).read_to_end(&mut bytes)?;
    // some files say that they are shorter than they are: those of /proc, and those that are being written
    let rest = read_stream(file, limit - bytes.len() as u64)?;
    bytes.extend(rest);
    Ok(bytes)
}

/// A file to be read as a stream, of any length.
///
/// # Errors
/// What the system says.
pub fn open_stream(path: &Path) -> io::Result<File> {
    record(path);
    let file = File::open(path)?;
    if file.metadata()?.is_dir() { Err(ErrorKind::IsADirectory.into()) } else { Ok(file) }
}

/// The bytes of a stream to its end, `limit` of them at most.
///
/// # Errors
/// As [`read_file`].
pub fn read_stream(mut stream: impl Read, limit: u64) -> io::Result<Vec<u8>> {
    let (mut chunks, mut length) = (Vec::new(), 0);
    loop {
        let mut chunk = with_room(CHUNK)?;
        (&mut stream).take(CHUNK as u64).read_to_end(&mut chunk)?;
        length += chunk.len() as u64;
        if length > limit {
            return Err(too_large(limit));
        }
        let is_last = chunk.len() < CHUNK;
        chunks.push(chunk);
        if is_last {
            break;
        }
    }
    if let [_] = chunks[..] {
        return Ok(chunks.swap_remove(0));
    }
    // memory is taken as it is written to, and each chunk is given back before the next is copied
    let mut bytes = with_room(length as usize)?;
    chunks.into_iter().for_each(|chunk| bytes.extend_from_slice(&chunk));
    Ok(bytes)
}

fn with_room(length: usize) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    bytes.try_reserve_exact(length)?;
    Ok(bytes)
}

/// The error of a file that is longer than it may be.
fn too_large(limit: u64) -> io::Error {
    io::Error::new(ErrorKind::FileTooLarge, format!("more than {limit} bytes"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stream_is_read_to_its_end_or_refused_past_the_limit() {
        for length in [0, 1, CHUNK - 1, CHUNK, CHUNK + 1, 2 * CHUNK, 2 * CHUNK + 7] {
            let bytes: Vec<u8> = (0..length).map(|k| (k % 251) as u8).collect();
            assert_eq!(read_stream(&bytes[..], length as u64).expect("read"), bytes);
            if length > 0 {
                let error = read_stream(&bytes[..], length as u64 - 1).expect_err("too long");
                assert_eq!(error.kind(), ErrorKind::FileTooLarge);
                assert_eq!(error.to_string(), format!("more than {} bytes", length - 1));
            }
        }
    }

    #[test]
    fn what_has_no_end_is_left_after_the_limit() {
        struct Endless(u64);
        impl Read for Endless {
            fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
                self.0 += buffer.len() as u64;
                buffer.fill(0);
                Ok(buffer.len())
            }
        }
        let limit = 3 * CHUNK as u64;
        let mut stream = Endless(0);
        assert_eq!(read_stream(&mut stream, limit).expect_err("endless").kind(), ErrorKind::FileTooLarge);
        assert!(stream.0 <= limit + CHUNK as u64, "{}", stream.0);
    }
}
