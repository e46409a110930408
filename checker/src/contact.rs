//! Two triangles of a mesh that are in each other's way.

/// How two triangles of a mesh are in each other's way.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ContactKind {
    /// Their interiors cross, or an edge of one pierces the interior of the other.
    Crossing,
    /// They lie in one plane and share area: a doubled wall, or a fold.
    Overlap,
    /// The surface passes through itself along an edge of the mesh, although no two triangle interiors meet.
    EdgeCrossing,
}

/// Two triangles that cross or overlap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// What they do.
    pub kind: ContactKind,
    /// The two triangles, the lower index first.
    pub triangles: [usize; 2],
    /// How far one of them must move until they only touch; in the units of the positions. Of an edge crossing, how far the
    /// surfaces reach past each other there.
    pub depth: f64,
}

impl std::fmt::Display for Contact {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [a, b] = self.triangles;
        let depth = self.depth;
        match self.kind {
            ContactKind::Crossing => write!(f, "triangles {a} and {b} cross, {depth:.3e} deep"),
            ContactKind::Overlap => write!(f, "triangles {a} and {b} overlap in one plane, {depth:.3e} deep"),
            ContactKind::EdgeCrossing => {
                write!(f, "the surfaces of triangles {a} and {b} cross along an edge, {depth:.3e} deep")
            }
        }
    }
}
