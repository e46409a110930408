//! Lines by the planes that meet in them, numbered as long as an edge names them.

use super::names::{Names, find_all};
use crate::base::{hash_of, intern};
use crate::boundary::BoundaryEdge;
use crate::ids::{Id, LineId, NameId};
use crate::plane_table::{PlaneId, PlaneTable};
use crate::weld::lines::{self, AxisPlanes, Line};

/// The lines.
#[derive(Clone, Default)]
pub(super) struct NamedLines {
    pub(super) names: Names<u64, LineId>,
    pub(super) lines: Vec<Line>,
    axes: AxisPlanes,
}

/// What equal lines share, in one number.
fn mark_of(table: &PlaneTable, line: &Line) -> u64 {
    hash_of(&lines::key(table, line))
}

impl NamedLines {
    /// Numbers the line of an edge; planes by which a line is known that was not known before go to `gained`.
    pub(super) fn take(&mut self, table: &PlaneTable, edge: &BoundaryEdge, gained: &mut Vec<PlaneId>) -> NameId {
        let name = lines::pair(edge);
        let number = self.names.find(&name).unwrap_or_else(|| {
            let line = Line::of(table, name);
            self.add(table, name, line, mark_of(table, &line), gained)
        });
        self.names.use_all(&[number]);
        number
    }

    /// The same for many edges; what it takes to tell lines apart is worked out by all threads.
    pub(super) fn take_all(
        &mut self,
        table: &PlaneTable,
        edges: &[BoundaryEdge],
        gained: &mut Vec<PlaneId>,
    ) -> Vec<NameId> {
        let (different, of_edge) =
            intern(edges.len(), |edge| lines::pair(&edges[edge]), table.len(), |name| (name >> 32) as usize, |k| k);
        let marked = |name: &u64| {
            let line = Line::of(table, *name);
            (line, mark_of(table, &line))
        };
        let found = find_all(&self.names, &different, marked);
        let new = different.iter().zip(found);
        let numbers: Vec<NameId> = new
            .map(|(name, found)| found.unwrap_or_else(|(line, mark)| self.add(table, *name, line, mark, gained)))
            .collect();
        let of_edge: Vec<NameId> = of_edge.into_iter().map(|place| numbers[place]).collect();
        self.names.use_all(&of_edge);
        of_edge
    }

    /// Makes a name known.
    fn add(&mut self, table: &PlaneTable, name: u64, line: Line, mark: u64, gained: &mut Vec<PlaneId>) -> NameId {
        let is_same = |other: LineId| self.axes.is_same(table, &self.lines[other.index()], &line);
        let (id, is_new) = self.names.add(name, mark, is_same);
        if is_new {
            let number = self.names.thing(id).index();
            if number == self.lines.len() {
                self.lines.push(line);
            } else {
                self.lines[number] = line;
            }
            gained.extend(line.planes);
        }
        id
    }

    /// Marks lines again that have moved, before anything is looked up by marks. Those that are now the same as another are retired; they are given, each with the other.
    pub(super) fn mark(&mut self, table: &PlaneTable, moved: &[LineId]) -> Vec<[LineId; 2]> {
        let mut merged = Vec::new();
        for &line in moved {
            if self.names.count_of(line) == 0 {
                continue;
            }
            let mark = mark_of(table, &self.lines[line.index()]);
            let is_same =
                |other: LineId| self.axes.is_same(table, &self.lines[other.index()], &self.lines[line.index()]);
            match self.names.another(line, mark, is_same) {
                Some(other) => {
                    self.names.retire(line);
                    merged.push([line, other]);
                }
                None => self.names.set_mark(line, mark),
            }
        }
        merged
    }
}
