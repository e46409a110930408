//! Values of arguments.

/// A value that OpenSCAD wrote.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Value {
    /// `undef`, and ranges, which no node takes.
    Undefined,
    /// `true` or `false`.
    Boolean(bool),
    /// A number, which may be infinite or not a number.
    Number(f64),
    /// A text in quotes.
    Text(String),
    /// Values in brackets.
    Vector(Vec<Value>),
}

impl Value {
    /// The number that this is.
    pub(super) fn number(&self) -> Option<f64> {
        if let Self::Number(number) = self { Some(*number) } else { None }
    }

    /// Whether OpenSCAD takes the value for true: not `false`, not undefined, not 0 and not empty.
    pub(super) fn is_true(&self) -> bool {
        match self {
            Self::Undefined => false,
            Self::Boolean(value) => *value,
            Self::Number(number) => *number != 0.0,
            Self::Text(text) => !text.is_empty(),
            Self::Vector(items) => !items.is_empty(),
        }
    }

    /// The values in brackets; none for anything else.
    pub(super) fn items(&self) -> &[Self] {
        if let Self::Vector(items) = self { items } else { &[] }
    }

    /// The first `N` numbers in brackets; `None` where there are fewer or one of them is no number.
    pub(super) fn numbers<const N: usize>(&self) -> Option<[f64; N]> {
        let mut numbers = [0.0; N];
        for (place, number) in numbers.iter_mut().enumerate() {
            *number = self.items().get(place)?.number()?;
        }
        Some(numbers)
    }

    /// The same, where each number is finite.
    pub(super) fn finite<const N: usize>(&self) -> Option<[f64; N]> {
        self.numbers().filter(|numbers| numbers.iter().all(|number| number.is_finite()))
    }

    /// Red, green, blue and opacity, the last one 1 where it is not given.
    pub(super) fn color(&self) -> Option<[f64; 4]> {
        let opaque = || self.numbers::<3>().map(|[red, green, blue]| [red, green, blue, 1.0]);
        self.numbers::<4>().or_else(opaque)
    }
}
