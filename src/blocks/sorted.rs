//! Pairs of numbers in ascending order, more of them than memory holds: runs that are sorted in memory go to files and are merged.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::fs::{self, File};
use std::io::{BufReader, BufWriter, Write};
use std::path::{Path, PathBuf};

use planecut_parallel::prelude::*;

use super::bytes;
use super::error::BlocksError;
use super::plan::SORTED;

/// Pairs of a run: 32 MB.
const RUN: usize = 1 << 21;

/// Collects pairs.
pub(super) struct Sorter {
    folder: PathBuf,
    pairs: Vec<(u64, u64)>,
    runs: Vec<PathBuf>,
    of_run: usize,
}

impl Sorter {
    /// A sorter that puts its files into a folder.
    pub(super) fn new(folder: &Path) -> Self {
        Self::with_runs(folder, RUN)
    }

    fn with_runs(folder: &Path, of_run: usize) -> Self {
        Self { folder: folder.to_owned(), pairs: Vec::new(), runs: Vec::new(), of_run }
    }

    pub(super) fn push(&mut self, pair: (u64, u64)) -> Result<(), BlocksError> {
        self.pairs.push(pair);
        if self.pairs.len() >= self.of_run { self.spill() } else { Ok(()) }
    }

    fn spill(&mut self) -> Result<(), BlocksError> {
        self.pairs.par_sort_unstable();
        self.pairs.dedup();
        let path = self.folder.join(format!("{SORTED}{}", self.runs.len()));
        let write = || {
            let mut file = BufWriter::with_capacity(1 << 20, File::create(&path)?);
            for (first, second) in &self.pairs {
                file.write_all(&first.to_le_bytes())?;
                file.write_all(&second.to_le_bytes())?;
            }
            file.flush()
        };
        write().map_err(BlocksError::io(&path))?;
        self.pairs.clear();
        self.runs.push(path);
        Ok(())
    }

    /// Gives all pairs in ascending order, equal ones at least once.
    pub(super) fn merge(mut self, mut take: impl FnMut((u64, u64))) -> Result<(), BlocksError> {
        if self.runs.is_empty() {
            self.pairs.par_sort_unstable();
            self.pairs.into_iter().for_each(take);
            return Ok(());
        }
        self.spill()?;
        self.pairs = Vec::new();
        let mut files = Vec::with_capacity(self.runs.len());
        for path in &self.runs {
            files.push(BufReader::with_capacity(1 << 16, File::open(path).map_err(BlocksError::io(path))?));
        }
        let mut next = |run: usize| -> Result<Option<(u64, u64)>, BlocksError> {
            let pair = bytes::u64(&mut files[run]).and_then(|first| Ok((first, bytes::u64(&mut files[run])?)));
            match pair {
                Ok(pair) => Ok(Some(pair)),
                Err(error) if error.kind() == std::io::ErrorKind::UnexpectedEof => Ok(None),
                Err(error) => Err(BlocksError::io(&self.runs[run])(error)),
            }
        };
        let mut heap = BinaryHeap::new();
        for run in 0..self.runs.len() {
            heap.extend(next(run)?.map(|pair| Reverse((pair, run))));
        }
        while let Some(Reverse((pair, run))) = heap.pop() {
            take(pair);
            heap.extend(next(run)?.map(|pair| Reverse((pair, run))));
        }
        for path in &self.runs {
            fs::remove_file(path).map_err(BlocksError::io(path))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_come_out_sorted_however_many_runs_there_are() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut state = 1_u64;
        let pairs: Vec<(u64, u64)> = (0..10_000)
            .map(|_| {
                state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                (state >> 54, state >> 20 & 3)
            })
            .collect();
        let mut expected = pairs.clone();
        expected.sort_unstable();
        expected.dedup();
        for of_run in [7, 1000, 20_000] {
            let mut sorter = Sorter::with_runs(folder.path(), of_run);
            pairs.iter().for_each(|pair| sorter.push(*pair).expect("written"));
            let mut merged = Vec::new();
            sorter.merge(|pair| merged.push(pair)).expect("read");
            assert!(merged.is_sorted());
            merged.dedup();
            assert_eq!(merged, expected, "runs of {of_run}");
            assert_eq!(folder.path().read_dir().expect("a folder").count(), 0);
        }
    }
}
