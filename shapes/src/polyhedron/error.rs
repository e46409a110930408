//! Why a surface bounds no solid.

use planecut_check::ContactKind;
use planecut_kernel::{DVec3, HalfSpaceError};
use thiserror::Error;

/// Why facets bound no solid. Facets and points are numbered as they were given, from 0.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum PolyhedronError {
    /// A coordinate is not finite, or too large.
    #[error("point {point}: found {position}, expected finite coordinates of at most 2^100")]
    Point {
        /// Which point.
        point: usize,
        /// Where it is.
        position: DVec3,
    },
    /// All of it is too small.
    #[error("found a mesh of the size {size:e}, expected at least 2^-240")]
    TooSmall {
        /// The largest difference of two coordinates along an axis.
        size: f64,
    },
    /// A facet names a point that does not exist.
    #[error("facet {facet}: found point {point}, expected a number below {points}")]
    UnknownPoint {
        /// Which facet.
        facet: usize,
        /// The number that it names.
        point: u32,
        /// How many points there are.
        points: usize,
    },
    /// A facet has more corners than are accepted where it is not convex.
    #[error("facet {facet}: found {corners} corners, expected at most {limit} where it is not convex")]
    TooManyCorners {
        /// Which facet.
        facet: usize,
        /// How many corners it has.
        corners: usize,
        /// How many are accepted.
        limit: usize,
    },
    /// There must be one material, or one for each facet.
    #[error("found {found} materials, expected 1 or {facets}")]
    Materials {
        /// How many were given.
        found: usize,
        /// How many facets there are.
        facets: usize,
    },
    /// An edge is used more often in one direction than in the other.
    #[error(
        "the surface is not closed: found {}, expected none",
        open_edges(*.edges, .from, .to)
    )]
    Open {
        /// The facet.
        facet: usize,
        /// Where the edge starts.
        from: DVec3,
        /// Where it ends.
        to: DVec3,
        /// How many such edges there are.
        edges: usize,
    },
    /// Two facets are in each other's way.
    #[error(
        "the surface crosses itself: found facets {} and {} that {} at {}, expected facets that share edges and corners only",
        .facets[0], .facets[1], verb(*.kind), shown(.position)
    )]
    Crossing {
        /// The facets, the lower number first.
        facets: [usize; 2],
        /// What they do.
        kind: ContactKind,
        /// A place near the first such contact.
        position: DVec3,
    },
    /// The surface encloses nothing.
    #[error("found a surface that encloses no volume, expected one that does")]
    NoVolume,
    /// Some part of the surface is wound against the rest, or winds around something several times.
    #[error(
        "found facets that enclose a volume of {enclosed} where convex cells within them have {cells}, expected a surface \
         with the solid on one side of it everywhere"
    )]
    Inconsistent {
        /// The volume by the divergence theorem.
        enclosed: f64,
        /// The sum over the cells.
        cells: f64,
    },
    /// The surface falls into more cells than are accepted.
    #[error("the surface falls into more than {limit} convex cells")]
    TooLarge {
        /// How many are accepted.
        limit: usize,
    },
    /// A plane that is not accepted.
    #[error("coordinates leave the accepted range: {0}")]
    OutOfRange(#[from] HalfSpaceError),
}

impl PolyhedronError {
    /// The facet that is to blame, where there is one.
    #[must_use]
    pub fn facet(&self) -> Option<usize> {
        match self {
            Self::UnknownPoint { facet, .. } | Self::TooManyCorners { facet, .. } | Self::Open { facet, .. } => {
                Some(*facet)
            }
            Self::Crossing { facets, .. } => Some(facets[0]),
            _ => None,
        }
    }
}

fn open_edges(count: usize, from: &DVec3, to: &DVec3) -> String {
    let (from, to) = (shown(from), shown(to));
    match count {
        1 => format!("an open edge from {from} to {to}"),
        _ => format!("{count} open edges, the first one from {from} to {to}"),
    }
}

fn verb(kind: ContactKind) -> &'static str {
    match kind {
        ContactKind::Crossing | ContactKind::EdgeCrossing => "cross",
        ContactKind::Overlap => "overlap",
    }
}

fn shown(point: &DVec3) -> String {
    format!("({}, {}, {})", point.x, point.y, point.z)
}
