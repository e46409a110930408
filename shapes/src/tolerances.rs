//! The constants of this crate that decide something by size instead of by sign.
//!
//! `docs/tolerances.md` lists those of all crates, and says of each whether it can change topology or volume and why that is safe.
//! Error bounds of floating-point filters are not here: they may only say "not certain", after which exact
//! arithmetic decides, and stand where they are derived.

/// How far corners of a closed mesh computed in `f64` may be off, relative to the largest coordinate: some thousand roundings.
///
/// Decides: with [`PLANE_MARGIN`] and the file's precision, which corners count as on the plane of a face.
pub const CORNER_NOISE: f64 = 1e-12;

/// Corners of a surface that is not closed are joined where they are no farther from each other, relative to the largest coordinate; or, where that
/// does not close it, no farther than neighbouring numbers of the file.
///
/// Decides: which corners are one, only where the surface has open edges without that and none with it.
pub const JOINED_CORNERS: f64 = 1e-9;

/// Corners may be off the plane that several of them have by this many times what each is off its place, as the plane is off,
/// too.
pub const PLANE_MARGIN: f64 = 4.0;

/// A plane is that of its corners where none is farther from it than this share of the largest coordinate.
///
/// Decides: whether a face keeps the plane of its own corners.
pub const PLANE_ROUNDING: f64 = 16.0 * f64::EPSILON;

/// What is off a plane by more than this times what a corner may be off is not meant to be on it, however the plane leans.
pub const LEANING: f64 = 64.0;

/// Angles of faces around an edge that are nearer than this, in radians, count as one.
///
/// Decides: how faces are paired where more than two share an edge.
pub const SAME_ANGLE: f64 = 1e-7;

/// Where details are finer than corners are exact, planes are sought again with this share of the tolerance.
pub const LESS_SLACK: f64 = 1.0 / 16.0;

/// Cells whose volume is off the mesh's by no more than this share of what is allowed are taken without another trial.
pub const GOOD_VOLUME: f64 = 1.0 / 6.0;

/// Corners nearer than this share of the loop's size to a lid of its hull lie on it.
pub const LID_NOISE: f64 = 1e-12;

/// How far the hull of a loop reaches beyond its lids, and which lids are too short, as a share of the loop's size.
pub const LID_REACH: f64 = 1.0 / (1u64 << 30) as f64;

/// Sides of a loop shorter than this share of its size are rounding noise: they may point anywhere.
pub const SHORT_SIDE: f64 = 1.0 / (1u64 << 46) as f64;

/// Loops narrower than this share of an outline's size are left over by rounding, and dropped.
pub const SLIVER: f64 = 1e-13;

/// Corners of a planar hull nearer than this share of the size to the line of their neighbours are on it.
pub const COLLINEAR_CORNER: f64 = 1e-13;

/// The grid to which OpenSCAD's outlines are rounded where they are offset. Where the two ends of sides at a corner are nearer, there is
/// only the first.
pub const CLIPPER_GRID: f64 = 1.0 / (1u64 << 16) as f64;

/// Vertices of an operand of a Minkowski sum nearer to each other than this share of its size are one: where many planes were
/// meant to meet.
pub const MERGED_VERTICES: f64 = 1.0 / (1u64 << 36) as f64;

/// Components of a normal below this share of its largest one are rounding noise and become zero, so that they stay within the
/// range that a half-space accepts.
pub const NEGLIGIBLE_COMPONENT: f64 = 1e-60;

/// Coordinates of a transformed corner below this share of the largest before and after become zero.
pub const NEGLIGIBLE_COORDINATE: f64 = 1e-40;

/// A planar transform whose determinant is below this share of the product of the lengths of its columns is refused.
pub const SINGULAR_DETERMINANT: f64 = 1e-14;

/// The areas of a loop's convex cells add up where they miss the loop's area by no more than this, times its corners and the square
/// of its size.
///
/// Decides: whether the partition is taken or another way is gone.
pub const PARTITION_AREA: f64 = 1e-12;

/// A cell of a loop counts as convex where corners turn the wrong way by no more than this share of its size.
pub const PARTITION_CONVEX: f64 = 1e-9;
