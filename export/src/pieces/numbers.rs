//! Which number a vertex has in a file.

use super::piece::Piece;
use super::seams::Joined;

/// The numbers that a mesh's vertices have in a file.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Numbers<'a> {
    /// They follow one another from this one on.
    From(u64),
    /// Each has one that is listed; from the first on they are those that no earlier mesh has.
    Listed {
        /// The first that is not used yet.
        first: u64,
        /// Those of all vertices.
        numbers: &'a [u64],
    },
}

impl Numbers<'_> {
    /// That of a vertex.
    pub(crate) fn of(&self, vertex: u32) -> u64 {
        match self {
            Self::From(first) => first + u64::from(vertex),
            Self::Listed { numbers, .. } => numbers[vertex as usize],
        }
    }

    /// Of that many vertices those which the file does not have yet, in the order of their numbers.
    pub(crate) fn own(&self, vertices: usize) -> impl Iterator<Item = usize> {
        let (mut next, listed) = match self {
            Self::From(first) => (*first, None),
            Self::Listed { first, numbers } => (*first, Some(*numbers)),
        };
        (0..vertices).filter(move |vertex| {
            let is_own = listed.is_none_or(|numbers| numbers[*vertex] == next);
            next += u64::from(is_own);
            is_own
        })
    }
}

/// The numbers of a piece's vertices.
#[derive(Debug)]
pub(crate) struct PieceNumbers {
    first: u64,
    numbers: Vec<u64>,
}

impl PieceNumbers {
    pub(crate) fn as_numbers(&self) -> Numbers<'_> {
        Numbers::Listed { first: self.first, numbers: &self.numbers }
    }
}

/// Numbers the vertices of pieces, one piece after another: what a piece shares with an earlier one has its number from there.
#[derive(Debug)]
pub(crate) struct Numbering<'a> {
    joined: &'a Joined,
    /// The numbers of the ends that stand for others or for themselves, as far as they are known.
    known: Vec<u64>,
    next: u64,
}

impl<'a> Numbering<'a> {
    pub(super) fn new(joined: &'a Joined, first: u64) -> Self {
        Self { joined, known: Vec::new(), next: first }
    }

    /// Numbers the vertices of the next piece.
    pub(crate) fn of_piece(&mut self, piece: &Piece) -> PieceNumbers {
        let first = self.next;
        let mut open = piece.open_vertices.iter().peekable();
        let mut numbers = Vec::with_capacity(piece.mesh.positions.len());
        for vertex in 0..piece.mesh.positions.len() as u32 {
            let mut number = self.next;
            if open.next_if_eq(&&vertex).is_some() {
                let end = self.known.len();
                let stands = self.joined.stands_for(end);
                if stands < end {
                    number = self.known[stands];
                }
                self.known.push(number);
            }
            self.next += u64::from(number == self.next);
            numbers.push(number);
        }
        PieceNumbers { first, numbers }
    }
}
