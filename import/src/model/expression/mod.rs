//! Numbers that are worked out: `=width / 2`.
//!
//! [`parse`] turns a text into steps in postfix order (shunting yard, Dijkstra 1961: no recursion, so no depth is too deep);
//! [`Expression::value`] takes them one by one.

mod function;
mod parse;
mod token;

pub(super) use function::{FUNCTIONS, Function};
pub(super) use parse::parse;
pub(super) use token::is_name;

/// The name that is no parameter but 3.14159….
pub(super) const PI: &str = "pi";

/// Steps in postfix order.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Expression {
    steps: Vec<Step>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Step {
    Number(f64),
    /// The value of a parameter, by its number.
    Parameter(u32),
    Negate,
    Binary(Binary),
    /// A function and how many of the last values it takes.
    Call(Function, usize),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    Remainder,
    Power,
}

impl Expression {
    /// The numbers of the parameters that it needs.
    pub(super) fn parameters(&self) -> impl Iterator<Item = u32> {
        self.steps.iter().filter_map(|step| match step {
            Step::Parameter(number) => Some(*number),
            _ => None,
        })
    }

    /// The value, with those of the parameters by their numbers; `None` where any step gives no finite number.
    pub(super) fn value(&self, parameters: &[f64]) -> Option<f64> {
        let mut values: Vec<f64> = Vec::new();
        for step in &self.steps {
            let value = match step {
                Step::Number(value) => *value,
                Step::Parameter(number) => *parameters.get(*number as usize)?,
                Step::Negate => -values.pop()?,
                Step::Binary(operator) => {
                    let (right, left) = (values.pop()?, values.pop()?);
                    operator.apply(left, right)
                }
                Step::Call(function, count) => {
                    let arguments = values.split_off(values.len().checked_sub(*count)?);
                    function.apply(&arguments)
                }
            };
            values.push(Some(value).filter(|value| value.is_finite())?);
        }
        values.pop()
    }
}

impl Binary {
    fn apply(self, left: f64, right: f64) -> f64 {
        match self {
            Self::Add => left + right,
            Self::Subtract => left - right,
            Self::Multiply => left * right,
            Self::Divide => left / right,
            Self::Remainder => {
                let rest = left % right;
                if rest != 0.0 && (rest < 0.0) != (right < 0.0) { rest + right } else { rest }
            }
            Self::Power => left.powf(right),
        }
    }
}

#[cfg(test)]
mod tests {
    use rustc_hash::FxHashMap;

    use super::parse::ExpressionFault;
    use super::*;

    fn value(text: &str) -> Option<f64> {
        let names = FxHashMap::from_iter([("width".to_owned(), 0), ("n_2".to_owned(), 1)]);
        parse(text, &names).unwrap_or_else(|fault| panic!("{text}: {fault:?}")).value(&[40.0, 7.0])
    }

    fn fault(text: &str) -> ExpressionFault {
        parse(text, &FxHashMap::default()).expect_err(text)
    }

    #[test]
    fn operators_bind_as_in_mathematics() {
        for (text, expected) in [
            ("1 + 2 * 3", 7.0),
            ("(1 + 2) * 3", 9.0),
            ("10 - 4 - 3", 3.0),
            ("16 / 4 / 2", 2.0),
            ("2 ^ 3 ^ 2", 512.0),
            ("-2 ^ 2", -4.0),
            ("(-2) ^ 2", 4.0),
            ("2 ^ -1", 0.5),
            ("2 ^ -1 ^ 2", 0.5),
            ("-2 * -3", 6.0),
            ("--3 + +1", 4.0),
            ("-7 % 3", 2.0),
            ("7 % -3", -2.0),
            ("-6 % 3", 0.0),
            ("7.5 % 2", 1.5),
            ("2 * 7 % 4", 2.0),
            ("1e3 + .5 + 2.", 1002.5),
            ("width / 8 + n_2", 12.0),
            (" pi ", std::f64::consts::PI),
        ] {
            assert_eq!(value(text), Some(expected), "{text}");
        }
    }

    #[test]
    fn functions_take_degrees_and_are_exact_where_they_can_be() {
        for (text, expected) in [
            ("sqrt(16)", 4.0),
            ("abs(-3)", 3.0),
            ("floor(-1.5)", -2.0),
            ("ceil(-1.5)", -1.0),
            ("round(2.5) + round(-2.5) + round(1.4)", 1.0),
            ("min(3, 1, 2) + max(3)", 4.0),
            ("sin(30) + cos(60) + cos(-90)", 1.0),
            ("tan(45) + tan(-45)", 0.0),
            ("asin(1) + acos(1)", 90.0),
            ("atan(1)", 45.0),
            ("atan2(-1, -1)", -135.0),
            ("max(min(1, 2), -(3))", 1.0),
        ] {
            assert_eq!(value(text), Some(expected), "{text}");
        }
    }

    #[test]
    fn what_is_no_finite_number_has_no_value() {
        for text in
            ["1 / 0", "0 / 0", "1 / (1 / 0)", "5 % 0", "sqrt(-1)", "acos(2)", "tan(90)", "9 ^ 999", "(-8) ^ 0.5"]
        {
            assert_eq!(value(text), None, "{text}");
        }
    }

    #[test]
    fn what_is_no_expression_is_refused_with_what_stands_there() {
        for (text, found, expected) in [
            ("", "its end", "a number, a name or `(`"),
            ("1 +", "its end", "a number, a name or `(`"),
            ("1 2", "`2`", "an operator"),
            ("(1", "its end", "`)`"),
            ("1)", "`)`", "an operator"),
            ("1, 2", "`,`", "an operator"),
            ("min(1,)", "`)`", "a number, a name or `(`"),
            ("min()", "`)`", "a number, a name or `(`"),
            ("atan2(1)", "1 argument", "2 arguments"),
            ("sqrt(1, 2)", "2 arguments", "1 argument"),
            ("sinh(1)", "`sinh`", "one of the functions sqrt, abs"),
            ("sqrt", "`sqrt`", "`sqrt(…)`"),
            ("width", "`width`", "a parameter"),
            ("2 $ 3", "`$`", "an operator"),
            ("2 ** 3", "`*`", "a number, a name or `(`"),
            ("1e999", "`1e999`", "a number below 1.8e308"),
            ("é", "`é`", "a number, a name or `(`"),
        ] {
            let fault = fault(text);
            assert!(fault.found.contains(found) && fault.expected.contains(expected), "{text}: {fault:?}");
        }
    }

    #[test]
    fn depth_needs_no_stack() {
        let depth = 1_000_000;
        assert_eq!(value(&format!("{}1{}", "(".repeat(depth), ")".repeat(depth))), Some(1.0));
        assert_eq!(value(&format!("{}1", "-".repeat(depth))), Some(1.0));
        assert_eq!(value(&format!("1{}", "^1".repeat(depth))), Some(1.0));
    }
}
