//! The functions of expressions; angles are degrees.

use planecut_csg::sine_and_cosine;

/// A function by its place in [`FUNCTIONS`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::model) enum Function {
    Sqrt,
    Abs,
    Floor,
    Ceil,
    Round,
    Min,
    Max,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Atan2,
}

/// All functions by name.
pub(in crate::model) const FUNCTIONS: [(&str, Function); 14] = [
    ("sqrt", Function::Sqrt),
    ("abs", Function::Abs),
    ("floor", Function::Floor),
    ("ceil", Function::Ceil),
    ("round", Function::Round),
    ("min", Function::Min),
    ("max", Function::Max),
    ("sin", Function::Sin),
    ("cos", Function::Cos),
    ("tan", Function::Tan),
    ("asin", Function::Asin),
    ("acos", Function::Acos),
    ("atan", Function::Atan),
    ("atan2", Function::Atan2),
];

impl Function {
    /// The function called `name`.
    pub(super) fn by_name(name: &str) -> Option<Self> {
        FUNCTIONS.iter().find(|(called, _)| *called == name).map(|(_, function)| *function)
    }

    /// How many arguments it takes; `None` for one or more.
    pub(super) fn arguments(self) -> Option<usize> {
        match self {
            Self::Min | Self::Max => None,
            Self::Atan2 => Some(2),
            _ => Some(1),
        }
    }

    /// The value; NaN where there is none.
    pub(super) fn apply(self, arguments: &[f64]) -> f64 {
        let [first, rest @ ..] = arguments else { return f64::NAN };
        let (first, second) = (*first, rest.first().copied().unwrap_or(f64::NAN));
        match self {
            Self::Sqrt => first.sqrt(),
            Self::Abs => first.abs(),
            Self::Floor => first.floor(),
            Self::Ceil => first.ceil(),
            Self::Round => first.round(),
            Self::Min => rest.iter().copied().fold(first, f64::min),
            Self::Max => rest.iter().copied().fold(first, f64::max),
            Self::Sin => sine_and_cosine(first).0,
            Self::Cos => sine_and_cosine(first).1,
            Self::Tan => {
                let (sine, cosine) = sine_and_cosine(first);
                sine / cosine
            }
            Self::Asin => first.asin().to_degrees(),
            Self::Acos => first.acos().to_degrees(),
            Self::Atan => first.atan().to_degrees(),
            Self::Atan2 => first.atan2(second).to_degrees(),
        }
    }
}
