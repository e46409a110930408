//! What a reader noticed and went on.

use std::fmt;

/// Something that a reader left out or repaired, for the report.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Warning {
    /// Line of the input, counted from 1; 0 where no single line is meant.
    pub line: u32,
    /// What happened, in one line of text.
    pub message: String,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.line > 0 {
            write!(f, "line {}: ", self.line)?;
        }
        f.write_str(&self.message)
    }
}
