//! The outer box: what stands for infinity while the boundary of a tree with unbounded operands is worked out.
//!
//! Unbounded bodies are cut by a box so large that it holds every point at which planes of the model can meet: with
//! normals of 53-bit numbers of like magnitude, three planes meet within `2^160` times their largest distance from the
//! origin. So a boundary that reaches the box reaches infinity, and one that does not is that of the uncut bodies.

use glam::DVec3;
use planecut_kernel::{HalfSpace, MAX_OFFSET_RATIO};

use super::{BrushBody, ShapeBuilder, build};
use crate::model::MaterialId;
use crate::plane_table::{PlaneId, PlaneTable};

/// How many times farther away the box is than the farthest plane.
const REACH: f64 = f64::from_bits((1023 + 160) << 52);

/// Six planes around everything.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OuterBox {
    planes: [PlaneId; 6],
}

impl OuterBox {
    /// Adds the planes to a table.
    pub(crate) fn new(table: &mut PlaneTable) -> Self {
        let distance = table.reach().max(f64::from(1 << 10));
        Self::at(table, (distance * REACH).log2().ceil().exp2().min(MAX_OFFSET_RATIO))
    }

    /// The largest one, of the first planes of a table that has none yet.
    pub(crate) fn farthest(table: &mut PlaneTable) -> Self {
        Self::at(table, MAX_OFFSET_RATIO)
    }

    fn at(table: &mut PlaneTable, half: f64) -> Self {
        let planes = std::array::from_fn(|k| {
            let axis = DVec3::AXES[k / 2];
            let normal = if k % 2 == 0 { axis } else { -axis };
            table.insert_exact(&HalfSpace::new(normal, half).expect("a power of two within range"))
        });
        Self { planes }
    }

    /// Its planes.
    #[inline]
    pub(crate) fn planes(&self) -> [PlaneId; 6] {
        self.planes
    }

    /// Whether a plane is one of the box.
    #[inline]
    pub(crate) fn holds(&self, plane: PlaneId) -> bool {
        self.planes.iter().any(|own| own.index() == plane.index())
    }

    /// The body of a brush within the box.
    pub(crate) fn cut(&self, table: &PlaneTable, planes: &[PlaneId], materials: &[MaterialId]) -> BrushBody {
        let planes: Vec<PlaneId> = planes.iter().chain(&self.planes).copied().collect();
        let last = materials.last().copied().unwrap_or(MaterialId(0));
        let materials: Vec<MaterialId> = materials.iter().copied().chain([last; 6]).collect();
        build(table, &planes, &materials, &mut ShapeBuilder::default())
    }
}
