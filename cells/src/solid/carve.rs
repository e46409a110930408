//! The part of a convex cell in which a formula holds, as convex cells.
//!
//! A cell is cut only along planes that carry a face of what it has in common with a body that does not decide it
//! otherwise, one piece for each such plane:
//! - bodies that must hold the point are intersected with the cell, which makes no pieces;
//! - of several of which one must hold it, each takes its part of the cell in turn, less those before it;
//! - bodies that must not hold the point are carved out, in the order that [`order`](super::order) chooses.

use planecut_csg::{PlaneId, PlaneTable};
use planecut_parallel::job;
use planecut_parallel::prelude::*;
use rustc_hash::FxHashSet;

use super::cell::{Cell, CellPlane};
use super::convex::{BodySide, Convex, box_side};
use super::formula::{Formula, Kind, Parts};
use super::order::{self, Direction, Rule};

/// A cell and what has yet to be decided within it.
struct Task {
    cell: Cell,
    formula: Formula,
}

/// A cell and the bodies that have yet to be carved out of it.
type Pending = (Cell, Vec<u32>);

/// With more bodies than this to be carved out, a cell is a task of its own.
const MANY: usize = 32;

/// Carves cells.
pub(super) struct Carver<'a> {
    pub(super) table: &'a PlaneTable,
    pub(super) bodies: Vec<&'a Convex>,
    pub(super) rule: Rule,
    /// The directions across which many bodies have faces.
    common: FxHashSet<Direction>,
}

impl<'a> Carver<'a> {
    pub(super) fn new(table: &'a PlaneTable, bodies: Vec<&'a Convex>, rule: Rule) -> Self {
        let common = order::common_directions(table, &bodies);
        Self { table, bodies, rule, common }
    }

    pub(super) fn is_common(&self, plane: PlaneId) -> bool {
        self.common.contains(&order::direction(self.table, plane))
    }

    /// The part of `cell` in which `formula` holds, appended to `cells`.
    pub(super) fn carve(&self, cell: Cell, formula: Formula, cells: &mut Vec<Cell>) {
        let mut tasks = vec![Task { cell, formula }];
        while let Some(Task { cell, formula }) = tasks.pop() {
            let formula = formula.restricted(|body| !self.body(body).is_parted_from(self.table, &cell));
            match formula.value() {
                Some(true) => cells.push(cell),
                Some(false) => {}
                None => self.step(cell, &formula, &mut tasks, cells),
            }
        }
    }

    fn body(&self, body: u32) -> &Convex {
        self.bodies[body as usize]
    }

    fn step(&self, cell: Cell, formula: &Formula, tasks: &mut Vec<Task>, cells: &mut Vec<Cell>) {
        let Parts { kind, operands } = formula.parts();
        match kind {
            Kind::Body { body, negated: false } => cells.extend(self.intersected(&cell, body)),
            Kind::Body { body, .. } => self.carve_out(cell, vec![body], cells),
            Kind::And => self.step_all(cell, operands, tasks, cells),
            Kind::Or => self.step_any(&cell, operands, &Formula::constant(true), tasks),
            Kind::Parity { odd } => self.step_parity(&cell, odd, operands, &Formula::constant(true), tasks),
        }
    }

    /// All of the operands: bodies first, then alternatives, which make the cell small before anything is carved out.
    fn step_all(&self, cell: Cell, operands: Vec<Formula>, tasks: &mut Vec<Task>, cells: &mut Vec<Cell>) {
        let held = |formula: &Formula| formula.single().filter(|(_, negated)| !negated);
        let (within, rest): (Vec<Formula>, Vec<Formula>) = operands.into_iter().partition(|o| held(o).is_some());
        if !within.is_empty() {
            let bodies = within.iter().filter_map(|formula| formula.single());
            let cell = bodies.into_iter().try_fold(cell, |cell, (body, _)| self.intersected(&cell, body));
            let formula = Formula::combine(Kind::And, rest);
            tasks.extend(cell.map(|cell| Task { cell, formula }));
            return;
        }
        let mut rest = rest;
        let Some(place) = rest.iter().position(|formula| formula.single().is_none()) else {
            let bodies = rest.iter().filter_map(|formula| formula.single()).map(|(body, _)| body).collect();
            self.carve_out(cell, bodies, cells);
            return;
        };
        let Parts { kind, operands } = rest.swap_remove(place).parts();
        let rest = Formula::combine(Kind::And, rest);
        match kind {
            Kind::Parity { odd } => self.step_parity(&cell, odd, operands, &rest, tasks),
            _ => self.step_any(&cell, operands, &rest, tasks),
        }
    }

    /// Any of the operands, and `rest`: in each the part that is in none before it.
    fn step_any(&self, cell: &Cell, mut operands: Vec<Formula>, rest: &Formula, tasks: &mut Vec<Task>) {
        self.sort(&mut operands);
        for (k, operand) in operands.iter().enumerate() {
            let behind = Formula::constant(true);
            self.push(cell, operand, &operands[..k], [&behind, rest], tasks);
        }
    }

    /// An odd number of the operands (or an even one), and `rest`: in each the part that is in none before it and in an even
    /// number of those behind it.
    fn step_parity(&self, cell: &Cell, odd: bool, mut operands: Vec<Formula>, rest: &Formula, tasks: &mut Vec<Task>) {
        self.sort(&mut operands);
        for (k, operand) in operands.iter().enumerate() {
            let behind = Formula::combine(Kind::Parity { odd: !odd }, operands[k + 1..].iter().cloned());
            self.push(cell, operand, &operands[..k], [&behind, rest], tasks);
        }
        if !odd {
            self.push(cell, &Formula::constant(true), &operands, [&Formula::constant(true), rest], tasks);
        }
    }

    /// Makes a task of a cell, a formula that must hold, some that must not, and others that must. Where the first is a body,
    /// it cuts the cell at once, so that what does not reach it need not be copied.
    fn push(&self, cell: &Cell, first: &Formula, none_of: &[Formula], all_of: [&Formula; 2], tasks: &mut Vec<Task>) {
        let single = first.single().filter(|(_, negated)| !negated);
        let cell = match single {
            Some((body, _)) => self.intersected(cell, body),
            None => Some(cell.clone()),
        };
        let Some(cell) = cell else { return };
        let reaches = |body: u32| self.body(body).bounds().touches(cell.bounds());
        // a body that is not reached does not hold the point: nothing to be said of it
        let matters = |formula: &&Formula| formula.single().is_none_or(|(body, negated)| negated || reaches(body));
        let none_of = none_of.iter().filter(matters).map(|formula| formula.restricted(reaches).negated());
        let first = if single.is_some() { Formula::constant(true) } else { first.restricted(reaches) };
        let all_of = all_of.into_iter().map(|formula| formula.restricted(reaches));
        let formula = Formula::combine(Kind::And, none_of.chain([first]).chain(all_of));
        tasks.push(Task { cell, formula });
    }

    /// What is taken away first, then large bodies before small ones, what is composed last.
    fn sort(&self, operands: &mut [Formula]) {
        let size = |formula: &Formula| match formula.single() {
            Some((_, true)) => f64::INFINITY,
            Some((body, false)) => self.body(body).size,
            None => f64::NEG_INFINITY,
        };
        operands.sort_by(|a, b| size(b).total_cmp(&size(a)));
    }

    fn intersected(&self, cell: &Cell, body: u32) -> Option<Cell> {
        let (mut common, carrying) = self.body(body).common(self.table, cell)?;
        if carrying.is_empty() {
            return Some(cell.clone());
        }
        common.settle(self.table);
        Some(common)
    }

    /// What is left of a cell without some bodies: one after the other while there are many, the parts side by side.
    fn carve_out(&self, cell: Cell, bodies: Vec<u32>, cells: &mut Vec<Cell>) {
        let mut wave = vec![(cell, bodies)];
        while wave.iter().any(|(_, bodies)| bodies.len() > MANY) {
            let advance = |task: Pending| {
                let (mut done, mut rest) = (Vec::new(), vec![task]);
                self.advance(&mut rest, &mut done, |bodies| bodies <= MANY);
                (done, rest)
            };
            let parts: Vec<(Vec<Cell>, Vec<Pending>)> = wave.into_par_iter().map(advance).collect();
            wave = Vec::new();
            for (done, rest) in parts {
                cells.extend(done);
                wave.extend(rest);
            }
        }
        self.advance(&mut wave, cells, |_| true);
    }

    /// Takes one step with the last task, and goes on to the end with those whose number of bodies `goes_on`.
    fn advance(&self, tasks: &mut Vec<Pending>, cells: &mut Vec<Cell>, goes_on: impl Fn(usize) -> bool) {
        while let Some((cell, mut bodies)) = tasks.pop() {
            job::check();
            let count = bodies.len();
            let Some(body) = order::next_body(self, &cell, &bodies) else {
                cells.push(cell);
                continue;
            };
            let body = bodies.swap_remove(body);
            let convex = self.body(body);
            let common = if convex.is_parted_from(self.table, &cell) { None } else { convex.common(self.table, &cell) };
            match common {
                None => tasks.push((cell, bodies)),
                Some((_, carrying)) => self.peel(cell, bodies, carrying, tasks),
            }
            if !goes_on(count) {
                return;
            }
        }
    }

    /// Cuts a piece off the cell along each plane; what is left in the end is not wanted.
    fn peel(&self, mut cell: Cell, mut bodies: Vec<u32>, mut planes: Vec<CellPlane>, tasks: &mut Vec<Pending>) {
        while let Some(next) = order::next_plane(self, &bodies, &planes) {
            let plane = planes.swap_remove(next);
            let mut piece = if planes.is_empty() {
                let mut piece = std::mem::replace(&mut cell, Cell::everything());
                piece.add(self.table, plane.flipped());
                piece
            } else {
                let piece = cell.split_off(self.table, plane);
                cell.settle(self.table);
                piece
            };
            piece.settle(self.table);
            let is_beyond = |body: &u32| self.reaches(*body, plane.plane, BodySide::Outside, &piece);
            let beyond = bodies.iter().copied().filter(is_beyond).collect();
            tasks.push((piece, beyond));
            bodies.retain(|body| self.reaches(*body, plane.plane, BodySide::Inside, &cell));
        }
    }

    /// Whether a body may reach what a cell has on one side of a plane.
    fn reaches(&self, body: u32, plane: PlaneId, side: BodySide, piece: &Cell) -> bool {
        let body = self.body(body);
        let found = body.side(self.table, plane);
        (found == side || found == BodySide::Both) && body.bounds().touches(piece.bounds())
    }

    /// On which sides of a plane a body lies, as far as its box tells.
    pub(super) fn box_side(&self, body: u32, plane: PlaneId) -> BodySide {
        box_side(self.table, self.body(body).bounds(), plane)
    }
}
