//! The constants of this crate that decide something by size instead of by sign.
//!
//! `docs/tolerances.md` lists those of all crates, and says of each whether it can change topology or volume and why that is safe.
//! Error bounds of floating-point filters are not here: they may only say "not certain", after which exact
//! arithmetic decides, and stand where they are derived.

/// A point on a face of a cell is on a face of the solid's tree where it is outside of that by less than this share of its
/// distance from the origin plus 1.
///
/// Decides: the material and source of a cell's face. Not its place.
pub const SOURCE_DISTANCE: f64 = 1e-9;

/// Facets of a trial hull whose normals have a larger cosine are one.
///
/// Decides: how a trial hull is costed; the hulls that leave are built exactly.
pub const COPLANAR_COSINE: f64 = 1.0 - 1e-12;

/// Points outside of a plane of a trial hull by less than this share of the size lie on it.
///
/// Decides: how a trial hull is costed; the hulls that leave are built exactly.
pub const HULL_TOUCHING: f64 = 1e-11;

/// A trial cell may seem to reach this far, relative to its size, into a region that is kept clear.
///
/// Decides: which trials are looked at; the cell that is taken is tested exactly.
pub const CLEAR_TOUCHING: f64 = 1e-9;

/// Sample points between two bodies may lie outside of the cells that fill the gap by this share of the size.
///
/// Decides: whether an exact hull is built and tested at all.
pub const FILLED_TOUCHING: f64 = 1e-9;

/// What two cells lack to be convex together is rounding where it is smaller than this share of their hull's volume.
///
/// Decides: whether they merge as if nothing were added; the volume reported is measured afterwards.
pub const NO_VOLUME: f64 = 1e-13;

/// A cell is cut back only if that leaves less than this share of its volume.
///
/// Decides: which of two enclosing cells is taken.
pub const WORTH_SHRINKING: f64 = 1.0 - 1e-6;

/// A corner that lies outside of a part by less than this share of its size may lie within.
///
/// Decides: which corners are looked at; each is enclosed exactly afterwards.
pub const CORNER_WITHIN: f64 = 1e-9;

/// A hull that keeps more than this share of its volume without a part is not made smaller by moving that part.
///
/// Decides: which groups are tried.
pub const SAME_HULL: f64 = 1.0 - 1e-9;

/// A body within a solid has grown if it was smaller than this share of what it is now.
///
/// Decides: when growing ends.
pub const GROWN: f64 = 1.0 - 1e-12;

/// Corners of planes whose unit normals have a smaller determinant are left to exact arithmetic.
///
/// Decides: which trials floating point answers.
pub const SINGULAR_CORNER: f64 = 1e-6;

/// How far off other corners may be, relative to the size.
///
/// Decides: which trials floating point answers.
pub const CORNER_ROOM: f64 = 1e-8;

/// Vertices of a cell nearer to each other than this share of its size count as one.
///
/// Decides: what counts against the limit of vertices, and what the cell's view reports.
pub const ONE_VERTEX: f64 = 1.0 / (1u64 << 32) as f64;

/// A box around points without extent is larger than they are by this share of their largest coordinate.
///
/// Decides: the thickness of what would have none.
pub const FLAT_PADDING: f64 = 1.0 / (1u64 << 40) as f64;

/// A cell that lacks less than this share of the least thickness has it.
///
/// Decides: whether a cell is thickened once more.
pub const THICK_ENOUGH: f64 = 1e-9;

/// Edges whose directions have a smaller sine span no direction in which a cell may be thinnest.
///
/// Decides: in which directions the thickness is measured.
pub const PARALLEL_EDGES: f64 = 1e-6;

/// Vertices of a written cell are farther from each other than this share of its size.
///
/// Decides: which corners become one vertex; the cell grows until it holds them all, exactly.
pub const WRITTEN_SEPARATION: f64 = 1.0 / (1u64 << 21) as f64;

/// The same as a share of the size of all cells together, as far as [`MOST_WRITTEN_SEPARATION`] allows.
///
/// Decides: which corners become one vertex in cells that are small among others; the cell grows until it holds them all, exactly.
pub const WRITTEN_SEPARATION_OF_ALL: f64 = 1.0 / (1u64 << 22) as f64;

/// No separation that follows from the size of all cells is more than this share of a cell's own size.
///
/// Decides: how far a small cell among large ones may grow; it holds its corners, exactly.
pub const MOST_WRITTEN_SEPARATION: f64 = 1.0 / (1u64 << 16) as f64;

/// A corner whose faces all have a larger cosine to one direction is moved outward as it is written; a sharper one becomes several vertices.
///
/// Decides: the shape of written cells at knife edges, by their growth.
pub const SHARP_CORNER: f64 = 0.125;

/// A triangle of a written cell whose normal has a smaller cosine to all faces of the cell is a face of its own.
///
/// Decides: which face of a written cell a triangle belongs to.
pub const SAME_FACE: f64 = 0.9;

/// The boxes that a surface is cut into overlap by twice this, where half of the size is between one half and one.
///
/// Decides: what of a surface belongs to two boxes; each piece is larger by more.
pub const CLIP_MARGIN: f64 = 1.0 / (1u64 << 44) as f64;

/// A piece of a surface is larger than what it holds by this share of the size, and some units in the last place of the largest coordinate.
///
/// Decides: how much cells of a surface exceed its hull.
pub const GROWTH: f64 = 1.0 / (1u64 << 43) as f64;

/// The halves of a piece that is cut between two cells overlap by twice this, where half of the size is between one half and one.
///
/// Decides: what of a surface belongs to both of two cells, and which pieces are not worth a cut; pieces are off by less.
pub const RECUT_MARGIN: f64 = 1.0 / (1u64 << 40) as f64;

/// Cuts that go beside a face are this far from it, where half of the size is between one half and one.
///
/// Decides: how thin a slice of other faces such a cut leaves on the wrong side.
pub const FACE_OFFSET: f64 = 1.0 / (1u64 << 40) as f64;

/// Faces across an axis whose heights differ by no more than this, where half of the size is between one half and one, are one face to cut beside.
///
/// Decides: where a surface is cut.
pub const SAME_HEIGHT: f64 = 1.0 / (1u64 << 20) as f64;

/// A face whose normal has at least this cosine to an axis lies across it.
///
/// Decides: where a surface is cut.
pub const FACE_ACROSS: f64 = 1.0 - 1e-6;

/// A box whose hull exceeds what it holds by less than this share of what the first one's does is not cut.
///
/// Decides: when cutting a surface ends.
pub const WORTH_CUTTING: f64 = 1e-7;

/// Thickness of a surface that bounds nothing where none is asked for, relative to the diagonal of its box.
///
/// Decides: what is enclosed.
pub const SHELL_THICKNESS: f64 = 1.0 / 512.0;

/// No ball enters the openings of a surface that is filled where it goes around more than this. The surface is filled where it goes around more than half; what is between leaves room for
/// the blocks of voxels by which it is found.
///
/// Decides: how near to the opening of a mesh that is filled space stays clear.
pub const FILLED_FOR_BALLS: f64 = 0.3;

/// Parts farther from each other than this share of the diagonal of all become one cell only where nothing else is left to merge.
///
/// Decides: which parts become one cell.
pub const DEFAULT_MAX_GAP: f64 = 0.05;
