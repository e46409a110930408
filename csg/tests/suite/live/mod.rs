//! Live models against models built anew, edit by edit.
//!
//! - [`edits`]: sequences of edits, what they must come to, shrinking and printing them as Rust.
//! - [`random`]: random sequences; [`cases`]: edits that once went wrong or easily could.

mod cases;
mod edits;
mod random;
