//! Coarsening of what a mesh bounds, without its exact cells.

use planecut_csg::MaterialId;

use super::clear::Clear;
use super::gaps::Gaps;
use super::input::parts_of;
use super::part::{Part, boxes_of};
use super::probes::Probes;
use super::search::Hulls;
use super::surface::{Bounded, Pieces, Points, Surface, pieces};
use super::{CoarsenError, CoarsenOptions, Coarsener, PROBES, Side, part};

/// Fewest and most pieces that a surface is taken apart into, triangles for each, and pieces for each cell that is asked for.
const PIECES: (usize, usize, usize, usize) = (128, 400, 16, 6);

impl Coarsener {
    /// Takes what a surface bounds apart from the top down, into some hundred convex pieces that may overlap and exceed it a little, instead of its
    /// exact cells, of which there may be millions: for few cells around a mesh. `volume` is that of the solid, where it is known better than by [`Surface::volume`]; excess is
    /// relative to it.
    ///
    /// Nothing is merged because it adds nothing, and cells are on the outer side.
    ///
    /// # Errors
    /// As [`Coarsener::new`]; [`CoarsenError::Option`] for cells within the solid.
    ///
    /// ```
    /// use planecut_cells::coarsen::{Bounded, CoarsenOptions, Coarsener, Surface};
    /// use planecut_kernel::DVec3;
    ///
    /// # fn main() -> Result<(), planecut_cells::coarsen::CoarsenError> {
    /// let positions = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    /// let triangles = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    /// let surface =
    ///     Surface { positions: &positions, triangles: &triangles, materials: &[], bounded: Bounded::Solid };
    /// let cells = Coarsener::of_surface(&surface, None, &CoarsenOptions::default())?.to_cells(1)?;
    /// assert!(cells.excess() < 1e-10);
    /// # Ok(())
    /// # }
    /// ```
    pub fn of_surface(
        surface: &Surface<'_>,
        volume: Option<f64>,
        options: &CoarsenOptions,
    ) -> Result<Self, CoarsenError> {
        options.check()?;
        if options.side == Side::Inner {
            let (option, found) = ("side", "inner".to_owned());
            return Err(CoarsenError::Option { option, found, expected: "outer, for cells of a surface" });
        }
        let (least, most, each, of_cell) = PIECES;
        let of_cells = options.max_cells.unwrap_or(0).saturating_mul(of_cell);
        let wanted = (surface.triangles.len() / each).clamp(least, most).max(of_cells);
        // the hull of all of it is the only cell that there can be
        let is_one = options.max_cells == Some(1)
            && options.max_excess.is_none()
            && options.keep_clear.is_none()
            && options.clear_radius.is_none()
            && options.max_gap.is_none()
            && !options.by_material
            && !matches!(surface.bounded, Bounded::Filled);
        let reachable = options.clear_radius.map(|radius| surface.reachable(radius)).transpose()?;
        let (parts, pieces) = pieces(surface, if is_one { 1 } else { wanted }, reachable.as_ref())?;
        if parts.is_empty() {
            return Err(CoarsenError::Empty);
        }
        let boxes = boxes_of(&parts);
        let regions = options.keep_clear.as_ref().map_or(Ok(Vec::new()), parts_of)?;
        let clear = Clear::around(&parts, &boxes, &regions, reachable)?;
        if let Some(radius) = options.clear_radius.filter(|_| !parts.iter().all(|part| clear.allows(&part.polytope))) {
            return Err(CoarsenError::NotClear { radius });
        }
        let (least, most, each) = PROBES;
        let probes = if parts.len() == 1 {
            Probes::default()
        } else {
            Probes::around(&parts, (each * parts.len()).clamp(least, most))
        };
        let mut coarsener = Self {
            options: options.clone(),
            // what must stay clear stays so of whole hulls alone
            hulls: if clear.is_empty() { Hulls::of_few(&parts, &probes) } else { Hulls::of(&parts, &probes) },
            gaps: Gaps::new(&parts, &boxes, options),
            // cells that must keep out of regions are made of the exact bodies of pieces, beside which regions may lie
            pieces: (!clear.has_regions()).then_some(pieces),
            free: parts.clone(),
            parts,
            free_boxes: boxes,
            clear,
            probes,
            merges: Vec::new(),
            volume: volume.unwrap_or_else(|| surface.volume()),
        };
        coarsener.descend();
        Ok(coarsener)
    }
}

impl Pieces {
    /// The body around some of the pieces, of the material of most of them.
    ///
    /// # Errors
    /// [`CoarsenError::OutOfRange`] for coordinates that no plane can have.
    pub(super) fn body_around(&self, parts: &[Part], members: &[u32]) -> Result<Part, CoarsenError> {
        let points = Points::joined(members.iter().map(|member| &self.points[*member as usize]));
        let material = part::material_of_most(members.iter().map(|member| &parts[*member as usize]));
        self.body_of(&points, material)
    }

    /// The body around points.
    ///
    /// # Errors
    /// [`CoarsenError::OutOfRange`] for coordinates that no plane can have.
    pub(super) fn body_of(&self, points: &Points, material: MaterialId) -> Result<Part, CoarsenError> {
        points.body(&self.growth, material)?.ok_or(CoarsenError::OutOfRange)
    }
}
