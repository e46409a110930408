//! What an edit would change, without doing it.

use planecut_kernel::DVec3;

use super::measures::KeptMeasures;
use super::polytopes::KeptPolytopes;
use super::{BrushId, Buffers, Edit, EditError, FaceId, LiveFace, LiveModel};
use crate::model::{Material, MaterialId};

/// What an edit would change.
#[derive(Debug, Clone, PartialEq)]
pub struct Preview {
    /// By how much the volume would grow; negative where it would shrink. It is that between the faces that would go and come.
    pub volume_change: f64,
    /// The brushes that would come, go, or be others.
    pub brushes: Vec<BrushId>,
    /// The faces that would be no more.
    pub removed: Vec<FaceId>,
    /// Those that would be new, which have no numbers.
    pub added: Vec<PreviewFace>,
}

/// A face that an edit would make.
#[derive(Debug, Clone, PartialEq)]
pub struct PreviewFace {
    /// What it would be made of.
    pub material: MaterialId,
    /// Its unit outward normal.
    pub normal: DVec3,
    /// Its corners, each once.
    pub positions: Vec<DVec3>,
    /// Its triangles, counter-clockwise seen from outside, by places among the corners.
    pub triangles: Vec<[u32; 3]>,
}

impl PreviewFace {
    fn of(face: LiveFace<'_>) -> Self {
        let (positions, triangles) = face.indexed();
        Self { material: face.material(), normal: face.normal(), positions, triangles }
    }
}

impl LiveModel {
    /// What an edit would change. The model stays as it is, to the last number: it is done to a copy, which takes time and memory with the size of the model.
    ///
    /// ```
    /// use planecut_csg::{Brush, Edit, LiveModel, Material, MaterialId, Role};
    /// use planecut_kernel::{DVec3, PlaneIdx};
    ///
    /// # fn main() -> Result<(), planecut_csg::EditError> {
    /// let mut model = LiveModel::new(vec![Material::named("stone")]);
    /// let block = Brush::cuboid(DVec3::ZERO, DVec3::splat(2.0), MaterialId(0));
    /// let (brush, _) = model.add_brush(block, Role::Add)?;
    /// let preview = model.preview(Edit::MovePlane { brush, plane: PlaneIdx(0), offset: 3.0 })?;
    /// assert_eq!((preview.volume_change, preview.removed.len(), preview.added.len()), (4.0, 5, 5));
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// As of [`apply`](Self::apply).
    pub fn preview(&self, edit: Edit) -> Result<Preview, EditError> {
        self.preview_with(edit, Vec::new())
    }

    /// The same for an edit that names materials which are new, as of [`apply_with`](Self::apply_with).
    ///
    /// # Errors
    /// As of [`apply`](Self::apply).
    pub fn preview_with(&self, edit: Edit, materials: Vec<Material>) -> Result<Preview, EditError> {
        let mut copy = self.copy();
        let change = copy.apply_with(edit, materials)?.change;
        let removed = || change.removed.iter().filter_map(|face| self.face(*face));
        let added = || change.added.iter().filter_map(|face| copy.face(*face));
        // near the faces, so that little is lost to rounding
        let origin = removed().chain(added()).find_map(|face| face.triangles().next()).map_or(DVec3::ZERO, |c| c[0].1);
        let volume = |face: LiveFace<'_>| -> f64 {
            let cone = |corners: [(u32, DVec3); 3]| {
                let [a, b, c] = corners.map(|corner| corner.1 - origin);
                a.dot(b.cross(c))
            };
            face.triangles().map(cone).sum()
        };
        let volume_change = (added().map(volume).sum::<f64>() - removed().map(volume).sum::<f64>()) / 6.0;
        let added = added().map(PreviewFace::of).collect();
        Ok(Preview { volume_change, brushes: change.brushes, removed: change.removed, added })
    }

    /// The same model again, without what is kept to save time alone.
    fn copy(&self) -> Self {
        Self {
            materials: self.materials.clone(),
            rank: self.rank.clone(),
            planes: self.planes.clone(),
            outer: self.outer,
            waiting: self.waiting.clone(),
            operands: self.operands.clone(),
            free: self.free.clone(),
            by_id: self.by_id.clone(),
            next_id: self.next_id,
            built: self.built.clone(),
            unbounded: self.unbounded,
            tree: self.tree.clone(),
            places: self.places.clone(),
            marks: self.marks.clone(),
            polytopes: KeptPolytopes::default(),
            bodies_on_plane: self.bodies_on_plane.clone(),
            welded: self.welded.clone(),
            meshes: self.meshes,
            evaluated: self.evaluated.clone(),
            measured: KeptMeasures::default(),
            history: self.history.clone(),
            buffers: Buffers::default(),
        }
    }
}
