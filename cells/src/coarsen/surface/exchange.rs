//! Cells of pieces that go where they save more: one is divided by a plane, and two neighbours elsewhere become one where that costs less.
//!
//! Where neighbours are cut apart, each region of a solid keeps the number of cells that greedy merging gave to it.

use std::collections::BTreeSet;

use planecut_csg::stages::Bounds;
use planecut_parallel::prelude::*;

use super::super::search::Search;
use super::Pieces;
use super::dividing_plane::Dividing;
use super::recut::{Cell, gain, near_each_other};

/// Least number of cells that are divided at a time, and for how many cells there is one more.
const DIVIDED: (usize, usize) = (8, 4);

/// What becomes of a cell that is divided, or of two that become one.
struct Change {
    /// What it costs less, or more where negative.
    gain: f64,
    /// Twice the same where one is divided.
    places: [usize; 2],
    /// What all of them lie in.
    bounds: Bounds,
    new: Vec<Cell>,
}

impl Change {
    fn new(search: &Search, cells: &[Cell], places: [usize; 2], new: Vec<Cell>) -> Self {
        let old = places.iter().map(|place| &cells[*place]);
        let bounds = old.chain(&new).fold(Bounds::EMPTY, |all, cell| all.union(&cell.hull.bounds));
        Self { gain: gain(search, cells, places, &new), places, bounds, new }
    }
}

impl Pieces {
    /// Divides cells that exceed what they hold by more than `worth_it`, and makes one of as many pairs of neighbours, where both together pay. Returns which cells changed.
    pub(super) fn exchange(
        &self,
        search: &Search,
        cells: &mut [Cell],
        worth_it: f64,
        work: &mut usize,
    ) -> BTreeSet<usize> {
        let divided = self.divided_cells(search, cells, worth_it, work);
        let Some(most) = divided.first().map(|change| change.gain) else { return BTreeSet::new() };
        let mut united = self.united_pairs(search, cells, most);
        let (mut changed, mut done) = (BTreeSet::new(), Vec::<Bounds>::new());
        for one in divided {
            // what a change gains is known beside the cells as they were
            let is_apart = |bounds: &Bounds, done: &[Bounds]| !done.iter().any(|other| other.touches(bounds));
            if !is_apart(&one.bounds, &done) {
                continue;
            }
            let beside = |two: &&mut Change| {
                !two.new.is_empty() && !two.bounds.touches(&one.bounds) && is_apart(&two.bounds, &done)
            };
            let Some(two) = united.iter_mut().find(beside) else { continue };
            if one.gain + two.gain <= search.least_gain() {
                continue;
            }
            let places = [two.places[0], two.places[1], one.places[0]];
            for (place, cell) in places.into_iter().zip(two.new.drain(..).chain(one.new)) {
                cells[place] = cell;
                changed.insert(place);
            }
            done.extend([one.bounds, two.bounds]);
        }
        changed
    }

    /// Cells that gain by being divided, the one that gains most first.
    fn divided_cells(&self, search: &Search, cells: &[Cell], worth_it: f64, work: &mut usize) -> Vec<Change> {
        let mut places: Vec<usize> = (0..cells.len()).filter(|place| cells[*place].empty > worth_it).collect();
        places.sort_by(|a, b| cells[*b].empty.total_cmp(&cells[*a].empty).then(a.cmp(b)));
        let (least, each) = DIVIDED;
        places.truncate(least + cells.len() / each);
        let divided = |place: &usize| {
            let chunks = &cells[*place].chunks;
            let mut dividing = Dividing::new(chunks, [chunks; 2]);
            let new = dividing.best().and_then(|plane| self.divided(chunks, plane));
            (new.map(|new| Change::new(search, cells, [*place; 2], new.into())), dividing.work)
        };
        let found: Vec<(Option<Change>, usize)> = places.par_iter().with_max_len(1).map(divided).collect();
        *work = work.saturating_sub(found.iter().map(|(_, work)| work).sum());
        let mut changes: Vec<Change> = found.into_iter().filter_map(|(change, _)| change).collect();
        changes.retain(|change| change.gain > search.least_gain());
        sort_by_gain(&mut changes);
        changes
    }

    /// Pairs of neighbours that cost less than `most` more as one cell, the one that costs least first.
    fn united_pairs(&self, search: &Search, cells: &[Cell], most: f64) -> Vec<Change> {
        let united = |pair: &[usize; 2]| {
            let [a, b] = pair.map(|place| &cells[place]);
            let pieces = |cell: &Cell| cell.chunks.iter().map(|chunk| chunk.piece).collect::<Vec<_>>();
            if !search.are_near(&pieces(a), &pieces(b)) {
                return None;
            }
            let cell = self.united(a, b);
            // however much of it others cover
            let least = search.cost(0, cell.hull.volume - a.hull.volume - b.hull.volume);
            (least < most).then(|| Change::new(search, cells, *pair, vec![cell])).filter(|change| change.gain > -most)
        };
        let pairs = near_each_other(search, cells);
        let mut changes: Vec<Change> = pairs.par_iter().with_max_len(4).filter_map(united).collect();
        sort_by_gain(&mut changes);
        changes
    }
}

/// Puts the change that gains most first.
fn sort_by_gain(changes: &mut [Change]) {
    changes.sort_by(|a, b| b.gain.total_cmp(&a.gain).then(a.places.cmp(&b.places)));
}

#[cfg(test)]
mod tests {
    use planecut_csg::{Brush, Material, MaterialId, Model, Tree, evaluate};

    use super::super::super::input::sum_of_volumes;
    use super::super::super::part::Part;
    use super::super::super::{CoarsenOptions, Coarsener};
    use super::super::{Bounded, Surface};

    /// Of three cells a bar has two and an angle one, and cuts between neighbours cannot change that.
    #[test]
    fn a_cell_goes_from_a_bar_to_an_angle() {
        let block = |min: [f64; 3], max: [f64; 3]| Tree::from(Brush::cuboid(min, max, MaterialId(0)));
        // with a notch, so that there are pieces of it
        let bar = block([0.0; 3], [4.0, 1.0, 1.0]) - block([1.9, -1.0, 0.9], [2.1, 2.0, 2.0]);
        let angle = block([10.0, 0.0, 0.0], [13.0, 1.0, 1.0]) | block([10.0, 0.0, 0.0], [11.0, 3.0, 1.0]);
        let model = Model { materials: vec![Material::named("any")], tree: bar | angle };
        let mesh = evaluate(&model).expect("a solid").mesh;
        let (positions, triangles) = (&mesh.positions, &mesh.triangles);
        let surface = Surface { positions, triangles, materials: &[], bounded: Bounded::Solid };
        let options = CoarsenOptions { max_cells: Some(3), ..CoarsenOptions::default() };
        let coarsener = Coarsener::of_surface(&surface, None, &options).expect("a surface");
        let search = coarsener.search();
        let of = |from: f64, to: f64| {
            let middle = |part: &Part| 0.5 * (part.bounds.min.x + part.bounds.max.x);
            let is_here = |number: &u32| (from..to).contains(&middle(&search.parts[*number as usize]));
            search.group((0..search.parts.len() as u32).filter(is_here).collect())
        };
        let groups = [of(0.0, 2.0), of(2.0, 5.0), of(5.0, 15.0)];
        let before: f64 = groups.iter().map(|group| group.hull.volume).sum();
        assert!(before > 10.9, "the angle should be one cell at first: {before}");

        let pieces = coarsener.pieces.as_ref().expect("pieces");
        let recut = pieces.recut(&search, &groups).expect("better cells");
        let bodies = recut.groups.iter().zip(&groups).map(|(new, group)| match new {
            Some((points, material)) => pieces.body_of(points, *material).expect("a body"),
            None => coarsener.body_around(group).expect("a body"),
        });
        let bodies: Vec<Part> = bodies.collect();
        assert_eq!(bodies.len(), 3);
        let after = sum_of_volumes(&bodies);
        assert!((8.98..9.1).contains(&after), "a bar of 4 and an angle of 5 have {after}");
    }
}
