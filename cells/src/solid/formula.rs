//! What decides within a cell whether a point belongs to the solid: a formula over the few bodies that reach the cell.

/// An entry of a [`Formula`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// Whether the point lies in a body; or, negated, whether it does not.
    Body { body: u32, negated: bool },
    /// All of the operands.
    And,
    /// Any of the operands.
    Or,
    /// An odd number of the operands; or an even one.
    Parity { odd: bool },
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Token {
    kind: Kind,
    operands: u32,
    /// How many tokens the operation and all below it take.
    size: u32,
}

/// A formula in postfix order. No operation stands in one of its own kind, none has fewer than two operands (but for the
/// constants: all of nothing is true, any of nothing is false), and constants stand nowhere within.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Formula(Vec<Token>);

/// A formula as its operation and operands.
pub(super) struct Parts {
    pub(super) kind: Kind,
    pub(super) operands: Vec<Formula>,
}

impl Formula {
    pub(super) fn body(body: u32, negated: bool) -> Self {
        Self(vec![Token { kind: Kind::Body { body, negated }, operands: 0, size: 1 }])
    }

    pub(super) fn constant(value: bool) -> Self {
        let kind = if value { Kind::And } else { Kind::Or };
        Self(vec![Token { kind, operands: 0, size: 1 }])
    }

    /// The value where it is constant.
    pub(super) fn value(&self) -> Option<bool> {
        match self.root() {
            Token { kind: Kind::And, operands: 0, .. } => Some(true),
            Token { kind: Kind::Or, operands: 0, .. } => Some(false),
            _ => None,
        }
    }

    fn root(&self) -> Token {
        self.0[self.0.len() - 1]
    }

    /// An operation on formulas, simplified.
    pub(super) fn combine(kind: Kind, operands: impl IntoIterator<Item = Self>) -> Self {
        match kind {
            Kind::And => Self::join(kind, operands, false),
            Kind::Or => Self::join(kind, operands, true),
            Kind::Parity { odd } => Self::parity(odd, operands),
            Kind::Body { body, negated } => Self::body(body, negated),
        }
    }

    /// And, or: `decisive` is the value of an operand that decides.
    fn join(kind: Kind, operands: impl IntoIterator<Item = Self>, decisive: bool) -> Self {
        let (mut tokens, mut count) = (Vec::new(), 0);
        for Self(mut operand) in operands {
            let root = operand[operand.len() - 1];
            match Self::value_of(root) {
                Some(value) if value == decisive => return Self::constant(decisive),
                Some(_) => continue,
                None => {}
            }
            if root.kind == kind {
                operand.pop();
                count += root.operands;
            } else {
                count += 1;
            }
            append(&mut tokens, operand);
        }
        match count {
            0 => Self::constant(!decisive),
            1 => Self(tokens),
            _ => Self::closed(tokens, kind, count),
        }
    }

    fn value_of(root: Token) -> Option<bool> {
        (root.operands == 0).then_some(root.kind).and_then(|kind| match kind {
            Kind::And => Some(true),
            Kind::Or => Some(false),
            _ => None,
        })
    }

    fn parity(mut odd: bool, operands: impl IntoIterator<Item = Self>) -> Self {
        let (mut tokens, mut count) = (Vec::new(), 0);
        for operand in operands {
            let root = operand.root();
            if let Some(value) = operand.value() {
                odd ^= value;
                continue;
            }
            let Self(mut operand) = operand;
            if let Kind::Parity { odd: inner } = root.kind {
                operand.pop();
                odd ^= !inner;
                count += root.operands;
            } else {
                count += 1;
            }
            append(&mut tokens, operand);
        }
        match count {
            0 => Self::constant(!odd),
            1 if odd => Self(tokens),
            1 => Self(tokens).negated(),
            _ => Self::closed(tokens, Kind::Parity { odd }, count),
        }
    }

    fn closed(mut tokens: Vec<Token>, kind: Kind, operands: u32) -> Self {
        let size = tokens.len() as u32 + 1;
        tokens.push(Token { kind, operands, size });
        Self(tokens)
    }

    /// The opposite. Negation goes down to the bodies (De Morgan), but not into a parity.
    pub(super) fn negated(mut self) -> Self {
        let mut at = self.0.len();
        while at > 0 {
            at -= 1;
            let token = &mut self.0[at];
            match &mut token.kind {
                Kind::Body { negated, .. } => *negated = !*negated,
                Kind::And => token.kind = Kind::Or,
                Kind::Or => token.kind = Kind::And,
                Kind::Parity { odd } => {
                    *odd = !*odd;
                    at -= token.size as usize - 1;
                }
            }
        }
        self
    }

    /// The operation and the operands.
    pub(super) fn parts(&self) -> Parts {
        let root = self.root();
        let mut operands = Vec::with_capacity(root.operands as usize);
        let mut end = self.0.len() - 1;
        for _ in 0..root.operands {
            let start = end - self.0[end - 1].size as usize;
            operands.push(Self(self.0[start..end].to_vec()));
            end = start;
        }
        operands.reverse();
        Parts { kind: root.kind, operands }
    }

    /// The one body and whether it is negated, where there is nothing else.
    pub(super) fn single(&self) -> Option<(u32, bool)> {
        match self.0.as_slice() {
            [Token { kind: Kind::Body { body, negated }, .. }] => Some((*body, *negated)),
            _ => None,
        }
    }

    /// The bodies.
    pub(super) fn bodies(&self) -> impl Iterator<Item = u32> + '_ {
        self.0.iter().filter_map(|token| match token.kind {
            Kind::Body { body, .. } => Some(body),
            _ => None,
        })
    }

    /// The formula within a cell that only some of the bodies reach.
    pub(super) fn restricted(&self, reaches: impl Fn(u32) -> bool) -> Self {
        let away: Vec<bool> = self.bodies().map(|body| !reaches(body)).collect();
        if !away.contains(&true) {
            return self.clone();
        }
        let mut away = away.into_iter();
        let mut stack: Vec<Self> = Vec::new();
        for token in &self.0 {
            let next = match token.kind {
                Kind::Body { body, negated } => {
                    let is_away = away.next().unwrap_or_default();
                    if is_away { Self::constant(negated) } else { Self::body(body, negated) }
                }
                kind => {
                    let operands = stack.split_off(stack.len() - token.operands as usize);
                    Self::combine(kind, operands)
                }
            };
            stack.push(next);
        }
        stack.pop().unwrap_or_else(|| Self::constant(false))
    }
}

/// Puts operands together, the longer list first: a deep formula is not copied at each level.
fn append(tokens: &mut Vec<Token>, mut operand: Vec<Token>) {
    if operand.len() > tokens.len() {
        std::mem::swap(tokens, &mut operand);
    }
    tokens.append(&mut operand);
}
