//! [`IncrementalPolytope`]: a convex polyhedron to which planes are added and from which they are removed.
//!
//! **Stored** is the dual triangulation: for each vertex its three planes, counter-clockwise seen from outside, and the
//! neighbour across each edge; for each plane one vertex of its face. Ties are broken symbolically: plane `i` is moved
//! inward by `εᵢ`, with `ε₀ ≫ ε₁ ≫ …` in the order of the stamps, so that exactly three planes and three edges meet at
//! every vertex. The structure is a function of the planes and their stamps alone.
//!
//! **Unbounded** polyhedra need no special case: four hidden infinity planes, offset `M → ∞`, close every one of them.
//!
//! **Local.** A plane without a face keeps a certificate: three planes that make it redundant for as long as they are
//! there. When planes are removed, a face can only grow across an edge that it had with one of theirs, and a plane
//! can only show itself whose certificate named one of them (the removal lemma, proved in `docs/kernel.md`). So a
//! removal looks at the ring around the hole and at the certificates that the removed planes carried, and at nothing
//! else.
//!
//! One module for each stage:
//! - [`store`] holds planes and vertices, [`side`] decides where a vertex lies, [`infinity`] closes what is unbounded;
//! - [`climb`] finds the extreme vertex, [`add`] cuts, [`redundant`] keeps the certificates, [`empty`] remembers why a
//!   set has no interior;
//! - [`remove`] removes a plane, [`remove_many`] several; [`fill`] closes the hole from its ring, [`remove_large`] by
//!   a cap; [`move_plane`] and [`rebuild`] are made of these, and [`beyond`] tells what a removal would add;
//! - [`view`] reports with coincident vertices merged, [`query`] answers questions, [`measure`] sums up, [`validate`]
//!   checks all of it.

mod add;
mod beyond;
mod climb;
mod cut;
mod empty;
mod fill;
mod infinity;
mod measure;
mod move_plane;
mod query;
mod rebuild;
mod redundant;
mod remove;
mod remove_large;
mod remove_many;
#[cfg(feature = "serde")]
mod saved;
mod side;
mod starts;
mod store;
mod validate;
mod view;

pub use measure::Measures;
pub use query::{
    BoundaryLine, BoundingBox, ClippedLine, ClosestFeature, ClosestPoint, FacePolygon, InscribedBall, InteriorPoint,
    Location, RecessionCone, Support,
};
pub use validate::{InvariantError, TopologyError, Validation, ValidationError};
pub use view::{Edge, EdgeIdx, EdgeKind, Face, FacetEdge, Vertex};

use crate::half_space::HalfSpace;
use crate::sign::Corner;
use redundant::Certificates;
use store::{Change, Link, NONE, PlaneState, PlaneStore, VertexStore};

/// Handle of a plane of one [`IncrementalPolytope`], counted from zero; a removed plane's handle is given to a later one. Planes of
/// brushes of a live model have such handles, too; there none is given to another plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PlaneIdx(pub usize);

/// Handle of a vertex of the simple structure; a removed vertex's handle is given to a later one.
///
/// Several vertices of the simple structure can coincide and are then seen as one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct VertexIdx(pub u32);

/// What [`IncrementalPolytope::add_plane`] did. The lists live until the next operation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AddPlaneResult<'a> {
    /// The plane cut the polyhedron and has a face.
    Added {
        /// The new plane.
        plane: PlaneIdx,
        /// The vertices that were cut away.
        removed_vertices: &'a [VertexIdx],
        /// The vertices of the new face.
        new_vertices: &'a [VertexIdx],
    },
    /// The plane changed nothing; it is kept and shows itself when the planes that hide it are removed.
    Redundant {
        /// The new plane.
        plane: PlaneIdx,
    },
    /// With this plane the set has no interior; it is kept, and removing planes can bring the polyhedron back.
    Empty {
        /// The new plane.
        plane: PlaneIdx,
    },
}

impl AddPlaneResult<'_> {
    /// The handle of the plane that was added.
    #[inline]
    #[must_use]
    pub fn plane(&self) -> PlaneIdx {
        match *self {
            Self::Added { plane, .. } | Self::Redundant { plane } | Self::Empty { plane } => plane,
        }
    }
}

/// What [`IncrementalPolytope::remove_plane`] did. The lists live until the next operation.
///
/// A handle can stand in both lists: the place of a vertex that was removed is given to a new one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RemovePlaneResult<'a> {
    /// The half-space that was removed.
    pub half_space: HalfSpace,
    /// Whether it had a face, so that the polyhedron changed.
    pub had_face: bool,
    /// The vertices that are no longer there; none where the set was empty before.
    pub removed_vertices: &'a [VertexIdx],
    /// The vertices that were not there before; all of them where an empty set came back.
    pub new_vertices: &'a [VertexIdx],
}

/// What [`IncrementalPolytope::remove_planes`] did. The lists live until the next operation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RemovePlanesResult<'a> {
    /// How many planes were removed.
    pub count: usize,
    /// The vertices that are no longer there; none where the set was empty before.
    pub removed_vertices: &'a [VertexIdx],
    /// The vertices that were not there before; all of them where an empty set came back.
    pub new_vertices: &'a [VertexIdx],
}

/// What [`IncrementalPolytope::move_plane`] did. The lists live until the next operation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MovePlaneResult<'a> {
    /// The half-space that was there before.
    pub previous: HalfSpace,
    /// Whether the plane has a face now.
    pub has_face: bool,
    /// The vertices that are no longer there; none where the set was or became empty.
    pub removed_vertices: &'a [VertexIdx],
    /// The vertices that were not there before; all of them where an empty set came back.
    pub new_vertices: &'a [VertexIdx],
    /// The vertices that kept their planes and have another position.
    pub moved_vertices: &'a [VertexIdx],
}

/// The default of [`IncrementalPolytope::with_epsilon`].
pub const DEFAULT_EPSILON: f64 = 1e-7;

/// A dynamic convex polyhedron: the intersection of half-spaces, with its vertices, edges and faces kept up to date.
///
/// # Guarantees
/// Every decision is exact. After any history of additions and removals the structure equals that of a fresh polytope
/// to which the same planes are added in the same order. Of two equal planes the older stays, the younger is
/// redundant; a set without interior is empty.
///
/// # Example
/// ```
/// use planecut_kernel::{DVec3, HalfSpace, IncrementalPolytope};
///
/// # fn main() -> Result<(), planecut_kernel::HalfSpaceError> {
/// let mut cube = IncrementalPolytope::new();
/// for axis in DVec3::AXES {
///     cube.add_plane(HalfSpace::new(axis, 1.0)?);
///     cube.add_plane(HalfSpace::new(-axis, 1.0)?);
/// }
/// let corner = cube.add_plane(HalfSpace::new(DVec3::ONE, 2.0)?).plane();
/// assert_eq!((cube.vertex_count(), cube.edge_count()), (10, 15));
/// cube.remove_plane(corner);
/// assert_eq!((cube.vertex_count(), cube.edge_count()), (8, 12));
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct IncrementalPolytope {
    planes: PlaneStore,
    vertices: VertexStore,
    certificates: Certificates,
    /// Planes that are not part of the structure because with the first of them the set has no interior, by stamp.
    pending: Vec<u32>,
    /// The planes whose intersection has no interior, while `pending` is not empty.
    witness: [u32; 4],
    /// Vertices from which climbs start.
    starts: starts::Starts,
    epsilon: f64,
    /// What the last operation changed.
    change: Change,
    /// How often a failed validation rebuilt the structure.
    rebuilds: u64,
    scratch: Scratch,
}

/// Buffers that operations reuse.
#[derive(Debug, Default)]
struct Scratch {
    /// Vertices to be cut away, in breadth-first order.
    cut: Vec<u32>,
    /// The ring around them.
    horizon: Vec<remove::RingEdge>,
    /// The vertices on the border of a patch, each as the end off its one leaving plane.
    border: Vec<Link>,
    /// Edges along which the search for such vertices has still to go.
    waiting: Vec<Link>,
    /// The ring of a face that is being removed.
    ring: Vec<remove::RingEdge>,
    /// The planes of a patch that is being removed.
    patch: Vec<u32>,
    /// Parts of a ring that are not closed yet.
    open_parts: Vec<fill::OpenPart>,
    /// New positions of the vertices of a face that moves.
    points: Vec<Corner>,
    /// Planes whose certificate a removed plane carried.
    to_examine: Vec<u32>,
    /// Planes that are being removed together.
    leaving: Vec<u32>,
    /// How many climbs in a row found that nothing is to be cut; negative while the places of the vertices are not to be found.
    climbs: i32,
    /// How many planes waited to be examined when the infinity planes were last found to need nothing.
    waited: usize,
}

/// `clone_from` keeps the memory: the fast way to begin again and again with the same polytope, such as a box.
impl Clone for IncrementalPolytope {
    fn clone(&self) -> Self {
        Self {
            planes: self.planes.clone(),
            vertices: self.vertices.clone(),
            certificates: self.certificates.clone(),
            pending: self.pending.clone(),
            witness: self.witness,
            starts: self.starts.clone(),
            epsilon: self.epsilon,
            change: Change::default(),
            rebuilds: self.rebuilds,
            scratch: Scratch::default(),
        }
    }

    fn clone_from(&mut self, source: &Self) {
        self.planes.clone_from(&source.planes);
        self.vertices.clone_from(&source.vertices);
        self.certificates.clone_from(&source.certificates);
        self.pending.clone_from(&source.pending);
        self.witness = source.witness;
        self.starts.clone_from(&source.starts);
        self.epsilon = source.epsilon;
        self.rebuilds = source.rebuilds;
    }
}

impl Default for IncrementalPolytope {
    fn default() -> Self {
        Self::new()
    }
}

impl IncrementalPolytope {
    /// All of space, with the default tolerance ([`DEFAULT_EPSILON`]) for what is reported.
    #[must_use]
    pub fn new() -> Self {
        Self::with_epsilon(DEFAULT_EPSILON)
    }

    /// All of space; edges shorter than `epsilon` (a length, in the units of the planes) are contracted in what is
    /// reported, but where that would not leave the topology of a polyhedron, as with a needle thinner than `epsilon`. The
    /// tolerance decides nothing inside.
    #[must_use]
    pub fn with_epsilon(epsilon: f64) -> Self {
        let mut polytope = Self {
            planes: PlaneStore::with_capacity(16),
            vertices: VertexStore::with_capacity(32),
            certificates: Certificates::default(),
            pending: Vec::new(),
            witness: [NONE; 4],
            starts: starts::Starts::default(),
            epsilon,
            change: Change::default(),
            rebuilds: 0,
            scratch: Scratch::default(),
        };
        polytope.close_by_infinity_planes();
        polytope
    }

    /// The tolerance of what is reported, a length in the units of the planes.
    #[inline]
    #[must_use]
    pub fn epsilon(&self) -> f64 {
        self.epsilon
    }

    /// Changes the tolerance of what is reported ([`with_epsilon`](Self::with_epsilon)); the structure does not depend on it.
    #[inline]
    pub fn set_epsilon(&mut self, epsilon: f64) {
        self.epsilon = epsilon;
    }

    /// Back to all of space, keeping the memory; stamps and handles start again.
    pub fn clear(&mut self) {
        self.planes.clear();
        self.vertices.clear();
        self.certificates.clear();
        self.pending.clear();
        self.close_by_infinity_planes();
    }

    /// Whether the set has no interior.
    #[inline]
    #[must_use]
    pub fn is_empty(&self) -> bool {
        !self.pending.is_empty()
    }

    /// Whether the set is bounded, in constant time; an empty set is.
    ///
    /// The paper's §4 asks a hull of the normals; here no infinity plane may have a face.
    #[inline]
    #[must_use]
    pub fn is_bounded(&self) -> bool {
        self.is_empty() || !(0..infinity::COUNT).any(|plane| self.planes.has_face(plane))
    }

    /// The half-space of a plane, `None` where there is no such plane.
    #[inline]
    #[must_use]
    pub fn plane(&self, idx: PlaneIdx) -> Option<&HalfSpace> {
        self.live(idx).map(|plane| self.planes.half_space(plane))
    }

    /// All planes, redundant ones included, by handle.
    pub fn planes(&self) -> impl Iterator<Item = (PlaneIdx, &HalfSpace)> {
        self.planes.slots().map(|plane| (external(plane), self.planes.half_space(plane)))
    }

    /// When a plane was added: larger is younger, and no stamp is given twice.
    #[inline]
    #[must_use]
    pub fn stamp(&self, idx: PlaneIdx) -> Option<u64> {
        self.live(idx).map(|plane| self.planes.stamp(plane))
    }

    /// Whether a plane is present without a face in the structure; where the set is empty, no plane has one.
    #[inline]
    #[must_use]
    pub fn is_redundant(&self, idx: PlaneIdx) -> bool {
        self.live(idx).is_some_and(|plane| self.is_empty() || !self.planes.has_face(plane))
    }

    /// The handles of all vertices of the simple structure.
    fn simple_handles(&self) -> impl Iterator<Item = VertexIdx> + '_ {
        self.vertices.slots().map(VertexIdx)
    }

    /// The slot behind a handle, where it holds a plane.
    fn live(&self, idx: PlaneIdx) -> Option<u32> {
        let slot = idx.0.checked_add(infinity::COUNT as usize)?;
        let slot = u32::try_from(slot).ok().filter(|slot| *slot < self.planes.slot_count())?;
        (self.planes.state(slot) != PlaneState::Free).then_some(slot)
    }
}

/// The handle of a slot.
fn external(slot: u32) -> PlaneIdx {
    PlaneIdx((slot - infinity::COUNT) as usize)
}
