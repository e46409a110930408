//! Volume, area, centroid and extent of a live model, kept up from face to face.
//!
//! What each face gives to the sums is kept, so that a face that is gone is taken out again. The sums are exact, so that neither how many edits there were nor in which order
//! they came makes a difference: after any edits the measures are, bit for bit, those of a new live model of the same brushes.
//!
//! Areas are those of faces of each material. What a place inside the solid is made of is another question, which [`Model::part_of_material`] answers; volumes of materials are those of these parts, each
//! evaluated when it is asked for.

use planecut_kernel::{DVec3, DoubleDouble};

use super::{LiveFace, LiveModel};
use crate::base::{Bounds, ExactSum, map_chunks};
use crate::evaluate::{EvaluateError, evaluate_with};
use crate::ids::{FaceId, Id};
use crate::mesh::SolidMeasures;
#[cfg(doc)]
use crate::model::Model;
use crate::model::{Brush, MaterialId};

/// Number of faces that a thread measures in a row.
const FACES_OF_CHUNK: usize = 256;

/// What the measures are made of; nothing is kept before they are first asked for.
#[derive(Default)]
pub(super) struct KeptMeasures {
    /// Whether they were asked for.
    are_kept: bool,
    /// The faces that came or went since they were last asked for.
    changed: Vec<FaceId>,
    of_faces: Vec<Option<FaceMeasures>>,
    six_volume: ExactSum,
    moment: [ExactSum; 3],
    /// For each material.
    areas: Vec<ExactSum>,
    bounds: Bounds,
    /// Whether a face that reached to the sides of the box is gone.
    may_be_smaller: bool,
}

/// The part of a face.
#[derive(Debug, Clone, Copy)]
struct FaceMeasures {
    six_volume: DoubleDouble,
    moment: [DoubleDouble; 3],
    area: f64,
    material: MaterialId,
    bounds: Bounds,
}

impl FaceMeasures {
    /// By the divergence theorem, of the pyramids from the origin over triangles from one corner to each edge. In twice the precision, as the pyramids of a small solid far from the origin
    /// nearly cancel.
    fn of(face: LiveFace<'_>) -> Self {
        let mut first = None;
        let mut twice_area = [DoubleDouble::default(); 3];
        let mut moment = [DoubleDouble::default(); 3];
        let mut bounds = Bounds::EMPTY;
        for [from, to] in face.edges() {
            let corner: DVec3 = *first.get_or_insert(from);
            bounds = bounds.union(&Bounds { min: from, max: from });
            let [u, v] = [from, to].map(|at| [0, 1, 2].map(|k| DoubleDouble::sum(at[k], -corner[k])));
            let across = cross(u, v);
            let weight = dot(across, corner);
            for k in 0..3 {
                twice_area[k] = twice_area[k].plus(across[k]);
                moment[k] = moment[k].plus(weight.times_sum(u[k].plus(v[k])));
            }
        }
        let corner = first.unwrap_or(DVec3::ZERO);
        let six_volume = dot(twice_area, corner);
        for k in 0..3 {
            moment[k] = moment[k].plus(six_volume.times(corner[k]).times(3.0));
        }
        let area = 0.5 * DVec3::from_array(twice_area.map(|component| component.high)).length();
        Self { six_volume, moment, area, material: face.material(), bounds }
    }
}

fn cross(u: [DoubleDouble; 3], v: [DoubleDouble; 3]) -> [DoubleDouble; 3] {
    [0, 1, 2].map(|k| {
        let (l, m) = ((k + 1) % 3, (k + 2) % 3);
        u[l].times_sum(v[m]).plus(u[m].times_sum(v[l]).negated())
    })
}

fn dot(u: [DoubleDouble; 3], v: DVec3) -> DoubleDouble {
    u[0].times(v.x).plus(u[1].times(v.y)).plus(u[2].times(v.z))
}

impl KeptMeasures {
    /// Notes the faces that an edit took away and made.
    pub(super) fn note(&mut self, removed: &[FaceId], added: &[FaceId]) {
        if self.are_kept {
            self.changed.extend(removed.iter().chain(added));
            // nobody has asked for long
            if self.changed.len() > 2 * self.of_faces.len() {
                *self = Self::default();
            }
        }
    }

    fn replace(&mut self, face: FaceId, measures: Option<FaceMeasures>) {
        if face.index() >= self.of_faces.len() {
            self.of_faces.resize(face.index() + 1, None);
        }
        if let Some(old) = std::mem::replace(&mut self.of_faces[face.index()], measures) {
            self.sum(&old, ExactSum::remove);
            self.may_be_smaller |=
                old.bounds.min.cmple(self.bounds.min).any() || old.bounds.max.cmpge(self.bounds.max).any();
        }
        if let Some(new) = measures {
            self.sum(&new, ExactSum::add);
            self.bounds = self.bounds.union(&new.bounds);
        }
    }

    fn sum(&mut self, face: &FaceMeasures, put: fn(&mut ExactSum, f64)) {
        let material = face.material.0 as usize;
        if material >= self.areas.len() {
            self.areas.resize(material + 1, ExactSum::default());
        }
        put(&mut self.areas[material], face.area);
        let sums =
            std::iter::once((&mut self.six_volume, face.six_volume)).chain(self.moment.iter_mut().zip(face.moment));
        for (sum, DoubleDouble { high, low }) in sums {
            put(sum, high);
            put(sum, low);
        }
    }

    fn solid(&self) -> SolidMeasures {
        if self.bounds == Bounds::EMPTY {
            return SolidMeasures::default();
        }
        let mut area = ExactSum::default();
        self.areas.iter().for_each(|of_material| area.add_sum(of_material));
        let six_volume = self.six_volume.value();
        let moment = DVec3::from_array(self.moment.each_ref().map(ExactSum::value));
        let Bounds { min, max } = self.bounds;
        SolidMeasures { volume: six_volume / 6.0, area: area.value(), centroid: moment / (4.0 * six_volume), min, max }
    }
}

impl LiveModel {
    /// Volume, area, centroid and extent of the solid. Only faces that changed since they were last asked for are looked at, and after any edits the numbers are, bit for
    /// bit, those of a new live model of the same brushes: exact sums over the faces, of which the rounding of vertices, and the last digits, are all that is lost.
    ///
    /// ```
    /// use planecut_csg::{Brush, LiveModel, Material, MaterialId, Role};
    /// use planecut_kernel::DVec3;
    ///
    /// # fn main() -> Result<(), planecut_csg::EditError> {
    /// let cube = |min: f64, max: f64| Brush::cuboid(DVec3::splat(min), DVec3::splat(max), MaterialId(0));
    /// let mut model = LiveModel::new(vec![Material::named("stone")]);
    /// model.add_brush(cube(0.0, 3.0), Role::Add)?;
    /// model.add_brush(cube(1.0, 2.0), Role::Subtract)?;
    /// assert_eq!((model.measures().volume, model.measures().area), (26.0, 60.0));
    /// model.undo()?;
    /// assert_eq!(model.measures().volume, 27.0);
    /// # Ok(())
    /// # }
    /// ```
    pub fn measures(&mut self) -> SolidMeasures {
        self.measure().solid()
    }

    /// The area of the boundary of each material, as these are listed: what there is of paint or plating, say.
    pub fn areas_of_materials(&mut self) -> Vec<f64> {
        let count = self.materials.len();
        let areas = &self.measure().areas;
        (0..count).map(|material| areas.get(material).map_or(0.0, ExactSum::value)).collect()
    }

    /// The volume of what is made of each material, as these are listed: times its density a mass. [`Model::part_of_material`] says what is made of which; together they are the
    /// volume of the solid, but for rounding. Where brushes are of one material alone, the volume is kept up as all measures are; otherwise a part for each is evaluated.
    ///
    /// # Errors
    /// [`EvaluateError::Weld`]: a bug in this crate.
    pub fn volumes_of_materials(&mut self) -> Result<Vec<f64>, EvaluateError> {
        let model = self.to_model();
        let mut volumes = vec![0.0; self.materials.len()];
        let mut used: Vec<MaterialId> = model.tree.brushes().iter().flat_map(Brush::materials).collect();
        used.sort_unstable();
        used.dedup();
        if let [only] = used[..] {
            volumes[only.0 as usize] = self.measures().volume;
            return Ok(volumes);
        }
        for material in used {
            let part = model.part_of_material(material);
            if !part.tree.brushes().is_empty() {
                volumes[material.0 as usize] = evaluate_with(&part, self.unbounded)?.solid.volume;
            }
        }
        Ok(volumes)
    }

    /// Measures what has changed.
    fn measure(&mut self) -> &KeptMeasures {
        let mut kept = std::mem::take(&mut self.measured);
        let mut changed = std::mem::take(&mut kept.changed);
        if !kept.are_kept {
            changed = self.faces().map(|(id, _)| id).collect();
        }
        changed.sort_unstable();
        changed.dedup();
        let measured =
            |faces: &[FaceId]| faces.iter().map(|id| (*id, self.face(*id).map(FaceMeasures::of))).collect::<Vec<_>>();
        let found = match changed.len() {
            ..FACES_OF_CHUNK => vec![measured(&changed)],
            _ => map_chunks(&changed, FACES_OF_CHUNK, measured).0,
        };
        found.into_iter().flatten().for_each(|(face, measures)| kept.replace(face, measures));
        if std::mem::take(&mut kept.may_be_smaller) {
            let all = kept.of_faces.iter().flatten();
            kept.bounds = all.fold(Bounds::EMPTY, |all, face| all.union(&face.bounds));
        }
        kept.are_kept = true;
        self.measured = kept;
        &self.measured
    }
}
