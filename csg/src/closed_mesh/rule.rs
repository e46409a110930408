//! What of a closed mesh is inside.

/// Which winding numbers are inside.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum WindingRule {
    /// Those above zero.
    #[default]
    Positive,
    /// All but zero.
    NonZero,
    /// Odd ones.
    Odd,
}

impl WindingRule {
    /// Whether a winding number is inside.
    #[must_use]
    pub fn is_inside(self, winding: i32) -> bool {
        match self {
            Self::Positive => winding > 0,
            Self::NonZero => winding != 0,
            Self::Odd => winding % 2 != 0,
        }
    }
}
