//! Arguments of a node, by name or by place.

use super::syntax::Node;
use super::value::Value;

/// The arguments of a node that knows in which order they come without names.
pub(super) struct Arguments<'n, 'a> {
    node: &'n Node<'a>,
    order: &'static [&'static str],
}

impl<'n, 'a> Arguments<'n, 'a> {
    pub(super) fn of(node: &'n Node<'a>, order: &'static [&'static str]) -> Self {
        Self { node, order }
    }

    /// The last value of that name, else the one in its place; `None` where there is none or it is undefined.
    pub(super) fn get(&self, name: &str) -> Option<&'n Value> {
        let arguments = &self.node.arguments;
        let named = arguments.iter().rev().find(|(own, _)| *own == Some(name)).map(|(_, value)| value);
        let in_place = || {
            let place = self.order.iter().position(|own| *own == name)?;
            arguments.iter().filter(|(own, _)| own.is_none()).nth(place).map(|(_, value)| value)
        };
        named.or_else(in_place).filter(|value| **value != Value::Undefined)
    }

    pub(super) fn number(&self, name: &str) -> Option<f64> {
        self.get(name)?.number()
    }

    pub(super) fn number_or(&self, name: &str, other: f64) -> f64 {
        self.number(name).unwrap_or(other)
    }

    /// Whether the value is `true`; anything but a truth value is `false`.
    pub(super) fn is_set(&self, name: &str) -> bool {
        self.get(name) == Some(&Value::Boolean(true))
    }

    /// The text, where the value is one.
    pub(super) fn text(&self, name: &str) -> Option<&'n str> {
        if let Some(Value::Text(text)) = self.get(name) { Some(text) } else { None }
    }

    /// One number for all places, or one for each; 1 where it is neither.
    pub(super) fn size<const N: usize>(&self, name: &str) -> [f64; N] {
        match self.get(name) {
            Some(Value::Number(number)) => [*number; N],
            Some(value) => value.numbers().unwrap_or([1.0; N]),
            None => [1.0; N],
        }
    }
}
