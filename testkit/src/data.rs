//! Files that others made, for tests: the folder `shared/data` beside the project, or the one that `PLANECUT_DATA` names.
//!
//! Whether it is there is seen when this crate is built; after the folder has appeared, `touch testkit/build.rs`.

use std::path::{Path, PathBuf};

/// A file or folder among the data, by its path there.
///
/// # Panics
/// Where it does not exist: tests that need it are made with [`tests_on_data`](crate::tests_on_data), and ignored where all of it is absent.
#[must_use]
pub fn data(path: &str) -> PathBuf {
    let place = Path::new(env!("PLANECUT_DATA_FOLDER")).join(path);
    assert!(place.exists(), "{} is absent; PLANECUT_DATA names another folder than ../shared/data", place.display());
    place
}

/// Makes tests of functions that need the [data folder](crate::data), in a module `on_data`. Where the folder is absent they are ignored, which
/// `cargo test` lists and counts.
#[cfg(has_data)]
#[macro_export]
macro_rules! tests_on_data {
    ($($name:ident),+ $(,)?) => {
        mod on_data {
            $(#[test]
            fn $name() {
                super::$name();
            })+
        }
    };
}

/// Makes tests of functions that need the [data folder](crate::data), in a module `on_data`. It is absent here, so they are ignored.
#[cfg(not(has_data))]
#[macro_export]
macro_rules! tests_on_data {
    ($($name:ident),+ $(,)?) => {
        mod on_data {
            $(#[test]
            #[ignore = "2026-11-23: needs ../shared/data"]
            fn $name() {
                super::$name();
            })+
        }
    };
}
