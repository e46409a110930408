//! From text to steps.

use std::f64::consts;

use rustc_hash::FxHashMap;

use super::token::{Token, next};
use super::{Binary, Expression, FUNCTIONS, Function, PI, Step};

/// Where a text is no expression.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::model) struct ExpressionFault {
    /// What stands there.
    pub(in crate::model) found: String,
    /// What may stand there.
    pub(in crate::model) expected: String,
}

/// What waits for its right side, or for its closing parenthesis.
enum Pending {
    Negate,
    Binary(Binary),
    Parenthesis,
    /// A function and how many arguments have begun.
    Call(Function, usize),
}

struct Parsing<'a> {
    rest: &'a str,
    parameters: &'a FxHashMap<String, u32>,
    steps: Vec<Step>,
    pending: Vec<Pending>,
}

/// Reads an expression, without the `=`; `parameters` are their numbers by name.
///
/// # Errors
/// [`ExpressionFault`] at the first token that does not fit.
pub(in crate::model) fn parse(text: &str, parameters: &FxHashMap<String, u32>) -> Result<Expression, ExpressionFault> {
    let mut parsing = Parsing { rest: text, parameters, steps: Vec::new(), pending: Vec::new() };
    loop {
        while parsing.operand()? {}
        if parsing.operator()? {
            return Ok(Expression { steps: parsing.steps });
        }
    }
}

impl Parsing<'_> {
    /// Takes a token where a value may begin; whether a value may still begin after it.
    fn operand(&mut self) -> Result<bool, ExpressionFault> {
        match next(&mut self.rest) {
            Token::Symbol('(') => self.pending.push(Pending::Parenthesis),
            Token::Symbol('-') => self.pending.push(Pending::Negate),
            Token::Symbol('+') => {}
            Token::Number(text) => return self.number(text).map(|()| false),
            Token::Name(name) => return self.name(name),
            token => return Err(refuse(token, "a number, a name or `(`")),
        }
        Ok(true)
    }

    fn number(&mut self, text: &str) -> Result<(), ExpressionFault> {
        match text.parse() {
            Ok(value) if f64::is_finite(value) => self.steps.push(Step::Number(value)),
            _ => return Err(refuse(Token::Number(text), "a number below 1.8e308")),
        }
        Ok(())
    }

    fn name(&mut self, name: &str) -> Result<bool, ExpressionFault> {
        let mut after = self.rest;
        let is_call = next(&mut after) == Token::Symbol('(');
        let function = Function::by_name(name);
        match (is_call, function) {
            (true, Some(function)) => {
                self.rest = after;
                self.pending.push(Pending::Call(function, 1));
                return Ok(true);
            }
            (true, None) => {
                return Err(refuse(Token::Name(name), &format!("one of the functions {}", function_names())));
            }
            (false, Some(_)) => return Err(refuse(Token::Name(name), &format!("`{name}(…)`"))),
            (false, None) if name == PI => self.steps.push(Step::Number(consts::PI)),
            (false, None) => match self.parameters.get(name) {
                Some(number) => self.steps.push(Step::Parameter(*number)),
                None => return Err(refuse(Token::Name(name), "a parameter of this file")),
            },
        }
        Ok(false)
    }

    /// Takes tokens where a value has ended, up to where the next one begins; whether the text ends instead.
    fn operator(&mut self) -> Result<bool, ExpressionFault> {
        loop {
            let token = next(&mut self.rest);
            if let Some(operator) = binary(token) {
                self.settle(|pending| binds_before(pending, operator));
                self.pending.push(Pending::Binary(operator));
                return Ok(false);
            }
            self.settle(|pending| matches!(pending, Pending::Negate | Pending::Binary(_)));
            match (token, self.pending.pop()) {
                (Token::End, None) => return Ok(true),
                (Token::End, Some(_)) => return Err(refuse(token, "`)`")),
                (Token::Symbol(')'), Some(Pending::Parenthesis)) => {}
                (Token::Symbol(')'), Some(Pending::Call(function, count))) => self.call(function, count)?,
                (Token::Symbol(','), Some(Pending::Call(function, count))) => {
                    self.pending.push(Pending::Call(function, count + 1));
                    return Ok(false);
                }
                _ => return Err(refuse(token, "an operator or the end")),
            }
        }
    }

    /// Moves what waits on top, as long as `is_due`, to the steps.
    fn settle(&mut self, is_due: impl Fn(&Pending) -> bool) {
        while let Some(pending) = self.pending.pop_if(|pending| is_due(pending)) {
            match pending {
                Pending::Negate => self.steps.push(Step::Negate),
                Pending::Binary(operator) => self.steps.push(Step::Binary(operator)),
                Pending::Parenthesis | Pending::Call(..) => {}
            }
        }
    }

    fn call(&mut self, function: Function, count: usize) -> Result<(), ExpressionFault> {
        let arguments = |count| if count == 1 { "1 argument".to_owned() } else { format!("{count} arguments") };
        match function.arguments() {
            Some(expected) if expected != count => {
                Err(ExpressionFault { found: arguments(count), expected: arguments(expected) })
            }
            _ => {
                self.steps.push(Step::Call(function, count));
                Ok(())
            }
        }
    }
}

fn binary(token: Token<'_>) -> Option<Binary> {
    match token {
        Token::Symbol('+') => Some(Binary::Add),
        Token::Symbol('-') => Some(Binary::Subtract),
        Token::Symbol('*') => Some(Binary::Multiply),
        Token::Symbol('/') => Some(Binary::Divide),
        Token::Symbol('%') => Some(Binary::Remainder),
        Token::Symbol('^') => Some(Binary::Power),
        _ => None,
    }
}

/// How tightly an operator binds.
fn rank(operator: Binary) -> u8 {
    match operator {
        Binary::Add | Binary::Subtract => 0,
        Binary::Multiply | Binary::Divide | Binary::Remainder => 1,
        Binary::Power => 3,
    }
}

/// Whether what waits is done before an operator that comes after it.
fn binds_before(pending: &Pending, operator: Binary) -> bool {
    match pending {
        // A sign binds tighter than a product and less than a power.
        Pending::Negate => rank(operator) < 2,
        Pending::Binary(Binary::Power) => operator != Binary::Power,
        Pending::Binary(before) => rank(*before) >= rank(operator),
        Pending::Parenthesis | Pending::Call(..) => false,
    }
}

fn refuse(found: Token<'_>, expected: &str) -> ExpressionFault {
    ExpressionFault { found: found.to_string(), expected: expected.to_owned() }
}

/// All functions, in a list for people.
fn function_names() -> String {
    FUNCTIONS.map(|(name, _)| name).join(", ")
}
