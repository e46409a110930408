//! What is sent several times: pieces of a tree, evaluated once, in which copies are not made yet.

use std::mem::take;
use std::num::NonZeroU32;
use std::rc::Rc;

use planecut_csg::{Brush, Operation};

use super::Context;
use crate::model::budget::Size;
use crate::model::copies::Places;
use crate::model::json::Entry;

/// The pieces of one operand, in a frame of its own.
#[derive(Debug, Default)]
pub(super) struct Plan {
    pub(super) pieces: Vec<Piece>,
    /// How much they come to.
    pub(super) extent: Extent,
    /// The brushes in memory that are let go of with it.
    pub(super) held: Size,
}

/// A piece of a tree.
#[derive(Debug)]
pub(super) enum Piece {
    Begin(Operation),
    Leaf(Box<Brush>, Option<NonZeroU32>),
    End,
    Placed(Rc<Placed>),
}

/// A plan in its place.
#[derive(Debug)]
pub(super) struct Placed {
    pub(super) plan: Rc<Plan>,
    /// What it inherits.
    pub(super) context: Context,
    /// The places of its copies, and the value that says so; without, it is there once.
    pub(super) copies: Option<(Entry, Places)>,
}

/// How much is sent.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Extent {
    pub(super) brushes: f64,
    pub(super) operations: f64,
}

impl Extent {
    /// That of a number of copies in one union.
    pub(super) fn copied(self, count: f64) -> Self {
        Self { brushes: self.brushes * count, operations: self.operations * count + 1.0 }
    }

    /// Adds another one.
    pub(super) fn add(&mut self, other: Self) {
        self.brushes += other.brushes;
        self.operations += other.operations;
    }
}

impl Piece {
    /// How much it comes to.
    pub(super) fn extent(&self) -> Extent {
        match self {
            Self::Begin(_) => Extent { brushes: 0.0, operations: 1.0 },
            Self::Leaf(..) => Extent { brushes: 1.0, operations: 0.0 },
            Self::End => Extent::default(),
            Self::Placed(placed) => match &placed.copies {
                Some((_, places)) => placed.plan.extent.copied(places.count() as f64),
                None => placed.plan.extent,
            },
        }
    }
}

/// Plans within one another may be as deep as nodes, which is too deep for the stack.
impl Drop for Plan {
    fn drop(&mut self) {
        let mut waiting = take(&mut self.pieces);
        while let Some(piece) = waiting.pop() {
            if let Piece::Placed(placed) = piece
                && let Some(placed) = Rc::into_inner(placed)
                && let Some(mut plan) = Rc::into_inner(placed.plan)
            {
                waiting.append(&mut plan.pieces);
            }
        }
    }
}
