//! Sequences of operations, made before they are run so that they can be shrunk, printed and run on other kernels.

mod simple;
mod writer;

use std::fmt::Write;

use crate::exact::Coefficients;
pub use simple::as_adds_and_removes;
pub use writer::Writer;

/// One operation. A plane is named by the number its `Add` carries, unique within a script.
#[derive(Debug, Clone, PartialEq)]
pub enum Op {
    /// Adds a plane, which is the youngest.
    Add {
        /// The name later operations use.
        name: usize,
        /// The half-space.
        plane: Coefficients,
    },
    /// Removes a plane.
    Remove {
        /// The name of its `Add`.
        name: usize,
    },
    /// Removes several planes at once.
    RemoveMany {
        /// The names of their `Add`s.
        names: Vec<usize>,
    },
    /// Replaces the half-space of a plane, which keeps its age.
    Move {
        /// The name of its `Add`.
        name: usize,
        /// The new half-space.
        plane: Coefficients,
    },
    /// Goes on with a clone; the original must not change with it.
    Clone,
    /// Back to all of space.
    Clear,
}

/// Applies `change` to every plane of a script.
pub fn map_planes(ops: &mut [Op], mut change: impl FnMut(Coefficients) -> Coefficients) {
    for op in ops {
        if let Op::Add { plane, .. } | Op::Move { plane, .. } = op {
            *plane = change(*plane);
        }
    }
}

/// The script as Rust, to be pasted into the kernel's `tests/oracle/regressions.rs`.
#[must_use]
pub fn as_rust(ops: &[Op]) -> String {
    let mut text = String::from("&[\n");
    for op in ops {
        let _ = match op {
            Op::Add { name, plane } => writeln!(text, "    add({name}, {plane:?}),"),
            Op::Remove { name } => writeln!(text, "    remove({name}),"),
            Op::RemoveMany { names } => writeln!(text, "    Op::RemoveMany {{ names: vec!{names:?} }},"),
            Op::Move { name, plane } => writeln!(text, "    Op::Move {{ name: {name}, plane: {plane:?} }},"),
            Op::Clone => writeln!(text, "    Op::Clone,"),
            Op::Clear => writeln!(text, "    Op::Clear,"),
        };
    }
    text + "]"
}
