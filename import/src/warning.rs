//! What a reader noticed and went on.

use std::fmt;

/// Something that a reader left out or repaired, for the report.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Warning {
    /// Line of the input, counted from 1; 0 where no single line is meant.
    pub line: u32,
    /// What happened, in one line of text.
    pub message: String,
    /// How many solids that the input states are left out of the model by this; 0 where it only says what is doubtful.
    pub left_out: usize,
}

impl Warning {
    /// Something that is doubtful, or was repaired; no solid is missing for it.
    #[must_use]
    pub fn note(line: u32, message: impl Into<String>) -> Self {
        Self { line, message: message.into(), left_out: 0 }
    }

    /// Solids that the input states and the model lacks.
    #[must_use]
    pub fn loss(line: u32, message: impl Into<String>, left_out: usize) -> Self {
        Self { line, message: message.into(), left_out }
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.line > 0 {
            write!(f, "line {}: ", self.line)?;
        }
        f.write_str(&self.message)
    }
}
