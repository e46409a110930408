//! Cells of a tree.

use std::borrow::Cow;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use planecut_csg::stages::{Boxes, smallest_size};
use planecut_csg::{Brush, PlaneId, PlaneTable, Tree};
use planecut_kernel::HalfSpace;
use planecut_parallel::job;
use planecut_parallel::prelude::*;

use super::carve::Carver;
use super::cell::{Cell, CellPlane, Cut};
use super::convex::Convex;
use super::formula::Formula;
use super::normal_form::{NormalForm, Owner, Scratch, Start};
use super::order::Rule;
use super::sources::Sources;
use super::{Solid, merge};

/// Convex bodies whose union is the solid of a tree: the brushes of a union as they are, those of any other tree as disjoint cells.
///
/// # Panics
/// Where a leaf is a closed mesh: `convex_tree` of the crate of shapes makes cells of it.
#[must_use]
pub fn convex_union(tree: &Tree) -> Cow<'_, [Brush]> {
    expect_convex(tree);
    if tree.is_union() {
        return Cow::Borrowed(tree.brushes());
    }
    let solid = Solid::from_tree(tree);
    Cow::Owned(solid.cells().map(|cell| solid.brush_of(cell)).collect())
}

/// A closed mesh has no half-spaces, and would be taken for all of space.
fn expect_convex(tree: &Tree) {
    assert!(!tree.has_meshes(), "found a closed mesh as a leaf, expected convex bodies alone");
}

impl Solid {
    /// The solid of a tree, as disjoint convex cells. Any operations, nested to any depth; operands and result may be
    /// unbounded or empty.
    ///
    /// Planes that are nearly the same count as one ([`SNAP_TOLERANCE`](planecut_csg::SNAP_TOLERANCE)), as in
    /// [`evaluate`](planecut_csg::evaluate). With feature `parallel` it runs on rayon's current thread pool; the outcome does
    /// not depend on the number of threads.
    ///
    /// ```
    /// use planecut_cells::Solid;
    /// use planecut_csg::{Brush, MaterialId, Tree};
    /// use planecut_kernel::DVec3;
    ///
    /// let block = |min: f64, max: f64| Tree::from(Brush::cuboid(DVec3::splat(min), DVec3::splat(max), MaterialId(0)));
    /// let shell = Solid::from_tree(&(block(0.0, 3.0) - block(1.0, 2.0)));
    /// assert_eq!((shell.cells().count(), shell.volume()), (6, Some(26.0)));
    /// ```
    ///
    /// # Panics
    /// Where a leaf is a closed mesh: `convex_tree` of the crate of shapes makes cells of it.
    #[must_use]
    pub fn from_tree(tree: &Tree) -> Self {
        Self::from_tree_by(tree, Rule::default())
    }

    pub(super) fn from_tree_by(tree: &Tree, rule: Rule) -> Self {
        expect_convex(tree);
        let brushes = tree.brushes();
        let half_spaces: Vec<HalfSpace> = brushes.iter().flat_map(Brush::half_spaces).copied().collect();
        let (table, ids) = PlaneTable::intern(&half_spaces, smallest_size(brushes.iter().map(Brush::half_spaces)));
        let (of_leaf, bodies) = bodies_of(&table, brushes, &ids);
        let sizes: Vec<f64> = bodies.iter().map(|body| body.size).collect();
        let form = NormalForm::new(tree, &of_leaf, &sizes, rule);
        let carver = Carver::new(&table, bodies.iter().collect(), rule);
        let mut cells = cells_of(&form, &carver);
        if rule.merges {
            merge::merge_neighbours(&table, &mut cells);
        }
        let cover = form.bodies_of_union().filter(|kept| kept.len() < cells.len());
        let cover =
            cover.map(|kept| kept.into_iter().map(|body| Arc::new(bodies[body as usize].cell.clone())).collect());
        let faces = bodies.iter().flat_map(|body| &body.facets).copied().collect();
        Self { cover, ..Self::of_cells(Arc::new(table), cells, Sources::new(brushes.len() as u32, faces)) }
    }
}

/// The body of each brush that has an interior, and the number of each brush's body.
pub(super) fn bodies_of(table: &PlaneTable, brushes: &[Brush], ids: &[PlaneId]) -> (Vec<Option<u32>>, Vec<Convex>) {
    let mut starts = Vec::with_capacity(brushes.len());
    let mut start = 0;
    for brush in brushes {
        starts.push(start);
        start += brush.faces.len();
    }
    let built: Vec<Option<Convex>> = brushes
        .par_iter()
        .zip(starts)
        .enumerate()
        .with_min_len(16)
        .map(|(number, (brush, start))| body_of(table, number as u32, brush, &ids[start..start + brush.faces.len()]))
        .collect();
    let mut count = 0;
    let mut number = || {
        count += 1;
        count - 1
    };
    let of_leaf = built.iter().map(|body| body.as_ref().map(|_| number())).collect();
    (of_leaf, built.into_iter().flatten().collect())
}

fn body_of(table: &PlaneTable, number: u32, brush: &Brush, ids: &[PlaneId]) -> Option<Convex> {
    let mut cell = Cell::everything();
    for (face, (id, brush_face)) in (0..).zip(ids.iter().zip(&brush.faces)) {
        let plane = CellPlane { plane: *id, brush_face: Some((number, face)), material: brush_face.material };
        if cell.add(table, plane) == Cut::Empty {
            return None;
        }
    }
    cell.settle(table);
    Some(Convex::new(table, cell))
}

fn cells_of(form: &NormalForm, carver: &Carver) -> Vec<Cell> {
    let boxes = Boxes::new(carver.bodies.iter().map(|body| *body.bounds()).collect());
    let owners = form.owners();
    let chunk = (owners.len() / (8 * planecut_parallel::current_num_threads()).max(1)).clamp(1, 64);
    let (done, owners_in_all) = (AtomicUsize::new(0), owners.len());
    let parts: Vec<Vec<Cell>> = owners
        .par_chunks(chunk)
        .map(|owners| {
            let (mut cells, mut near, mut scratch) = (Vec::new(), Vec::new(), Scratch::default());
            for owner in owners {
                let (start, formula) = start_of(form, carver, &boxes, owner, &mut near, &mut scratch);
                if formula.value() != Some(false) {
                    carver.carve(start.into_owned(), formula, &mut cells);
                }
                job::progress(done.fetch_add(1, Ordering::Relaxed) + 1, owners_in_all);
            }
            cells
        })
        .collect();
    parts.into_iter().flatten().collect()
}

/// Where an owner's cells begin, and what must hold there.
fn start_of<'a>(
    form: &NormalForm,
    carver: &'a Carver,
    boxes: &Boxes,
    owner: &Owner,
    near: &mut Vec<u32>,
    scratch: &mut Scratch,
) -> (Cow<'a, Cell>, Formula) {
    match owner.start {
        Start::Body(body) => {
            let cell = &carver.bodies[body as usize].cell;
            boxes.touching(cell.bounds(), near);
            (Cow::Borrowed(cell), form.formula(owner, near, scratch))
        }
        Start::Everything => {
            near.clear();
            near.extend(0..carver.bodies.len() as u32);
            (Cow::Owned(Cell::everything()), form.formula(owner, near, scratch))
        }
    }
}
