//! Solids as disjoint convex cells.
//!
//! - [`cell`]: a polytope of the kernel that knows the plane and the brush face behind each of its planes; [`convex`]: a body
//!   that cells are held against.
//! - [`normal_form`] finds for each leaf of a tree the [`formula`] that its part of the solid fulfils, [`carve`] cuts the cells,
//!   [`order`] chooses along which planes first, [`merge`] joins neighbours, for bodies that are given, too ([`join`]). [`from_tree`] and [`boolean`] are made of these;
//!   [`boxes`] tells what comes near what.
//! - [`cuts`], [`divide`] and [`motion`] change a solid; [`measure`], [`query`], [`ray`] and [`components`] ask it; [`boundary`] gives its meshes
//!   and [`sources`] the brush behind a place on them.

mod boolean;
mod boundary;
mod carve;
mod cell;
mod components;
mod convex;
mod cuts;
mod divide;
mod formula;
mod from_tree;
mod join;
mod measure;
mod merge;
mod motion;
mod normal_form;
mod order;
mod query;
mod ray;
mod sources;

use planecut_csg::stages::{Bounds, Boxes};
use planecut_csg::{Brush, BrushFace, PlaneTable, Tree};

use std::sync::{Arc, OnceLock};

pub use cell::{Cell, CellPlane};
pub use cuts::CutId;
use cuts::PlaneCut;
pub use from_tree::convex_union;
pub use join::joined;
pub use ray::RayHit;
use sources::Sources;

/// A solid as convex cells whose interiors are disjoint.
///
/// The cells are exact: each is a set of half-spaces of one [`PlaneTable`], and every decision on the way was an exact sign.
/// They may be unbounded.
///
/// Solids are combined by `&a | &b` (union), `&a & &b` (intersection), `&a - &b` (difference), `&a ^ &b` (symmetric
/// difference) and `!&a` (complement); `|=`, `&=`, `-=` and `^=` change only the cells that the other solid reaches. The
/// brushes of the second solid are numbered on from those of the first. Many operands at once are better a
/// [`Tree`]: [`Solid::from_tree`] knows what will be cut by what, and makes fewer cells.
///
/// ```
/// use planecut_cells::Solid;
/// use planecut_csg::{Brush, MaterialId};
/// use planecut_kernel::DVec3;
///
/// let block = |min: [f64; 3], max: [f64; 3]| Solid::from(Brush::cuboid(min, max, MaterialId(0)));
/// let mut wall = block([0.0, 0.0, 0.0], [4.0, 1.0, 3.0]);
/// wall -= &block([1.0, -1.0, 1.0], [2.0, 2.0, 2.0]);
/// wall |= &block([4.0, 0.0, 0.0], [5.0, 1.0, 1.0]);
/// assert_eq!((wall.volume(), wall.cells().count()), (Some(12.0), 5));
/// assert!(wall.contains(DVec3::new(4.5, 0.5, 0.5)) && !wall.contains(DVec3::new(1.5, 0.5, 1.5)));
/// ```
///
/// # Guarantees
/// No two cells have interior in common, and none is empty unless a plane that was added cuts it away.
#[derive(Debug, Clone)]
pub struct Solid {
    table: Arc<PlaneTable>,
    cells: Vec<Cell>,
    /// Convex bodies, possibly overlapping, whose union the solid is, where it is known to be one of fewer than the cells.
    cover: Option<Vec<Arc<Cell>>>,
    /// The planes with which it was cut and that can be removed.
    cuts: Vec<PlaneCut>,
    next_cut: u32,
    /// Where cells were divided, the place of each among the cells as they were before; else empty.
    families: Vec<u32>,
    sources: Sources,
    /// Finds cells by their boxes; made when first asked. Cuts leave it as it is.
    index: OnceLock<Boxes>,
}

impl Default for Solid {
    /// Nothing.
    fn default() -> Self {
        Self::empty()
    }
}

impl From<Brush> for Solid {
    fn from(brush: Brush) -> Self {
        Self::from_tree(&Tree::from(brush))
    }
}

impl From<&Tree> for Solid {
    fn from(tree: &Tree) -> Self {
        Self::from_tree(tree)
    }
}

impl Solid {
    fn of_cells(table: Arc<PlaneTable>, cells: Vec<Cell>, sources: Sources) -> Self {
        Self {
            table,
            cells,
            cover: None,
            cuts: Vec::new(),
            next_cut: 0,
            families: Vec::new(),
            sources,
            index: OnceLock::new(),
        }
    }

    /// Nothing.
    #[must_use]
    pub fn empty() -> Self {
        Self::of_cells(Arc::default(), Vec::new(), Sources::default())
    }

    /// All of space.
    #[must_use]
    pub fn everything() -> Self {
        Self::of_cells(Arc::default(), vec![Cell::everything()], Sources::default())
    }

    /// The cells. One that a plane which was added cuts away is left out.
    pub fn cells(&self) -> impl Iterator<Item = &Cell> + Clone {
        self.cells.iter().filter(|cell| !cell.is_empty())
    }

    /// A cell as a brush: its planes with their materials.
    #[must_use]
    pub fn brush_of(&self, cell: &Cell) -> Brush {
        let face =
            |plane: &CellPlane| BrushFace { half_space: *self.table.half_space(plane.plane), material: plane.material };
        Brush { faces: cell.planes().map(|(_, plane)| face(plane)).collect(), ..Brush::default() }
    }

    /// The cells whose boxes fulfil a condition which holds for a box wherever it holds for one within.
    fn cells_where(&self, condition: impl Fn(&Bounds) -> bool) -> impl Iterator<Item = &Cell> {
        let boxes = || Boxes::new(self.cells.iter().map(|cell| *cell.bounds()).collect());
        let mut found = Vec::new();
        self.index.get_or_init(boxes).find(condition, &mut found);
        found.into_iter().map(|place| &self.cells[place as usize]).filter(|cell| !cell.is_empty())
    }

    /// The table that the planes of the cells are numbered in.
    #[must_use]
    pub fn table(&self) -> &PlaneTable {
        &self.table
    }
}
