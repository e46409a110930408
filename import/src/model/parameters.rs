//! The values of parameters: those of the file, those that the caller sets, those that a `use` replaces.

use std::rc::Rc;

use rustc_hash::FxHashMap;

use super::error::{Checked, Fault, ModelError};
use super::expression::Expression;
use super::json::{Document, Entry};
use super::names::Names;
use super::order::{describe_circle, order};
use super::values::Values;
use crate::source::shorten;

/// How parameters depend on one another.
#[derive(Debug)]
pub(super) struct Definitions<'v, 'a> {
    pub(super) document: &'v Document<'a>,
    pub(super) expressions: &'v FxHashMap<Entry, Expression>,
    entries: &'v [Entry],
    by_name: &'v FxHashMap<String, u32>,
    /// Each after all that it needs.
    order: Vec<usize>,
}

/// Values of all parameters in some part of the model.
#[derive(Debug, Clone)]
pub(super) struct Environment {
    /// Tells this environment from others; the outermost is 0.
    pub(super) number: u32,
    pub(super) values: Rc<[f64]>,
    /// Values that replace those of the file.
    replaced: Rc<[Option<f64>]>,
}

impl<'v, 'a> Definitions<'v, 'a> {
    /// The parameters of a file.
    ///
    /// # Errors
    /// [`Fault`] for a circle.
    pub(super) fn new(
        document: &'v Document<'a>,
        expressions: &'v FxHashMap<Entry, Expression>,
        names: &'v Names,
    ) -> Checked<Self> {
        let entries = &names.parameters.entries[..];
        let needs = |entry: &Entry| match expressions.get(entry) {
            Some(expression) => expression.parameters().map(|number| number as usize).collect(),
            None => Vec::new(),
        };
        let needs: Vec<Vec<usize>> = entries.iter().map(needs).collect();
        let order = order(&needs).map_err(|circle| {
            let found = format!("a circle: {}", describe_circle(&circle, |number| &names.parameters.names[number]));
            Fault::new(entries[circle[0]], found, "parameters that do not need themselves")
        })?;
        Ok(Self { document, expressions, entries, by_name: &names.parameters.by_name, order })
    }

    /// The values, some of them set by the caller.
    ///
    /// # Errors
    /// [`Fault`] where an expression has no finite value.
    pub(super) fn environment(&self, set: &[(usize, f64)]) -> Checked<Environment> {
        let mut replaced = vec![None; self.entries.len()];
        for (number, value) in set {
            replaced[*number] = Some(*value);
        }
        self.evaluate(0, replaced)
    }

    /// The values within a part that `with` replaces some for. Its own numbers are those of the outside.
    ///
    /// # Errors
    /// [`Fault`] where an expression has no finite value.
    pub(super) fn within(&self, outside: &Environment, with: Entry, number: u32) -> Checked<Environment> {
        let values = self.values(outside);
        let mut replaced = outside.replaced.to_vec();
        for (key, value) in self.document.members(with) {
            if let Some(number) = self.by_name.get(&*self.document.text(key)) {
                replaced[*number as usize] = Some(values.number(value)?);
            }
        }
        self.evaluate(number, replaced)
    }

    /// A reader of values in an environment.
    pub(super) fn values<'e>(&'e self, environment: &'e Environment) -> Values<'e, 'a> {
        Values { document: self.document, expressions: self.expressions, parameters: &environment.values }
    }

    fn evaluate(&self, number: u32, replaced: Vec<Option<f64>>) -> Checked<Environment> {
        let mut values = vec![0.0; self.entries.len()];
        for parameter in &self.order {
            values[*parameter] = match replaced[*parameter] {
                Some(value) => value,
                None => Values { document: self.document, expressions: self.expressions, parameters: &values }
                    .number(self.entries[*parameter])?,
            };
        }
        Ok(Environment { number, values: values.into(), replaced: replaced.into() })
    }
}

/// The numbers of the parameters that the caller sets; the last one of a name counts.
///
/// # Errors
/// [`ModelError::Parameter`] where the file has none of this name, or the value is not finite.
pub(super) fn numbers_of(set: &[(String, f64)], names: &Names, file: &str) -> Result<Vec<(usize, f64)>, ModelError> {
    let refuse = |found: String, expected: String| ModelError::Parameter { name: file.to_owned(), found, expected };
    set.iter()
        .map(|(name, value)| {
            let shown = shorten(name);
            if !value.is_finite() {
                return Err(refuse(
                    format!("the value {value} for the parameter `{shown}`"),
                    "a finite number".to_owned(),
                ));
            }
            match names.parameters.by_name.get(name) {
                Some(number) => Ok((*number as usize, *value)),
                None => Err(refuse(
                    format!("a value for the parameter `{shown}`"),
                    format!("one of its parameters: {}", names.parameters.known()),
                )),
            }
        })
        .collect()
}
