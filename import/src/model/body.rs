//! Bodies that a NODE makes by itself, from its numbers.

use glam::DVec3;
use planecut_csg::{Brush, MaterialId, Tree};
use planecut_kernel::{HalfSpaceError, HullError};
use planecut_shapes::outline::{Join, Outline};
use planecut_shapes::primitives::{self, Extrusion, MAX_SEGMENTS, RegularSolid, ShapeError};

use super::error::{Checked, Fault};
use super::json::{Document, Entry, Kind};
use super::values::Values;
use crate::source::shorten;

/// Segments of a circle where the file does not say.
const SEGMENTS: u32 = 32;

/// A NODE's one key and its value, about to become a body.
#[derive(Debug, Clone, Copy)]
pub(super) struct Maker<'v, 'a> {
    pub(super) values: Values<'v, 'a>,
    /// The value of the key.
    pub(super) value: Entry,
    pub(super) material: MaterialId,
}

impl Maker<'_, '_> {
    /// The convex body, or the torus, that the key names; `None` where it names none. A tree without brushes is a hull of
    /// points without an interior.
    ///
    /// # Errors
    /// [`Fault`] of the number that has no shape.
    pub(super) fn body(&self, key: &str) -> Checked<Option<Tree>> {
        if key == "points" {
            return self.hull_of_points().map(Some);
        }
        let brush = match key {
            "halfspaces" => self.half_spaces()?,
            "box" => primitives::cuboid(self.vector("min")?, self.vector("max")?, self.material),
            "sphere" => primitives::sphere(self.number("radius")?, self.segments("segments")?, self.material),
            "cylinder" => {
                let radius = self.number("radius")?;
                let top = self.optional("top_radius")?.unwrap_or(radius);
                primitives::cylinder(self.number("height")?, radius, top, self.segments("segments")?, self.material)
            }
            "cone" => self.standing(primitives::cone, "segments")?,
            "prism" => self.standing(primitives::prism, "sides")?,
            "pyramid" => self.standing(primitives::pyramid, "sides")?,
            "capsule" => self.standing(primitives::capsule, "segments")?,
            "wedge" => primitives::wedge(self.vector("size")?, self.material),
            "regular" => self.regular()?,
            "torus" => return self.torus().map(Some),
            _ => return Ok(None),
        };
        self.accept(brush).map(|brush| Some(Tree::from(brush)))
    }

    /// How many planes the body will have, where that grows faster than its text.
    ///
    /// # Errors
    /// [`Fault`] of a number of segments that is none.
    pub(super) fn planes(&self, key: &str) -> Checked<usize> {
        Ok(match key {
            "sphere" | "capsule" => {
                let segments = self.segments("segments")? as usize;
                segments * segments.div_ceil(2) + 2
            }
            "torus" => 6 * self.segments("segments")? as usize * self.segments("tube_segments")? as usize,
            _ => 0,
        })
    }

    fn half_spaces(&self) -> Checked<Result<Brush, ShapeError>> {
        let row = |entry| self.values.array::<4>(entry).map(|[x, y, z, d]| (DVec3::new(x, y, z), d));
        let rows = self.values.document.items(self.value).map(row).collect::<Checked<Vec<_>>>()?;
        Ok(primitives::body_of_half_spaces(&rows, self.material))
    }

    fn hull_of_points(&self) -> Checked<Tree> {
        let points = self.values.document.items(self.value).map(|point| self.values.vector(point));
        match primitives::hull_of_points(&points.collect::<Checked<Vec<_>>>()?, self.material) {
            Err(ShapeError::Hull(HullError::NoInterior { .. })) => Ok(Tree::empty()),
            brush => self.accept(brush).map(Tree::from),
        }
    }

    fn standing(
        &self,
        make: impl Fn(f64, f64, u32, MaterialId) -> Result<Brush, ShapeError>,
        sides: &str,
    ) -> Checked<Result<Brush, ShapeError>> {
        Ok(make(self.number("height")?, self.number("radius")?, self.segments(sides)?, self.material))
    }

    fn regular(&self) -> Checked<Result<Brush, ShapeError>> {
        let name = self.member("solid").map(|name| self.values.document.text(name)).unwrap_or_default();
        match RegularSolid::named(&name) {
            Some(solid) => Ok(primitives::regular(solid, self.number("radius")?, self.material)),
            None => self.values.document.refuse(self.value, "the name of a regular solid"),
        }
    }

    fn torus(&self) -> Checked<Tree> {
        let (segments, tube_segments) = (self.segments("segments")?, self.segments("tube_segments")?);
        let (radius, tube) = (self.number("radius")?, self.number("tube")?);
        self.accept(primitives::torus(radius, tube, segments, tube_segments, self.material))
    }

    /// The outline, drawn out along z.
    ///
    /// # Errors
    /// [`Fault`] of the number that has no shape.
    pub(super) fn extrude(&self, outline: &Outline) -> Checked<Tree> {
        let scale = self.member("scale").map_or(Ok([1.0; 2]), |scale| self.values.scale(scale))?;
        let slices = self.member("slices").map(|slices| self.values.whole(slices, 1, MAX_SEGMENTS)).transpose()?;
        let center = self.member("center").map(|center| self.values.document.kind(center));
        let extrusion = Extrusion {
            height: self.number("height")?,
            twist: self.optional("twist")?.unwrap_or(0.0),
            scale: scale.into(),
            slices,
            center: center == Some(Kind::Bool(true)),
            ..Extrusion::straight(1.0)
        };
        self.accept(primitives::extrude(outline, &extrusion, self.material))
    }

    /// The outline, turned about z.
    ///
    /// # Errors
    /// [`Fault`] of the number that has no shape.
    pub(super) fn revolve(&self, outline: &Outline) -> Checked<Tree> {
        let angle = self.optional("angle")?.unwrap_or(360.0);
        self.accept(primitives::revolve(outline, angle, self.segments("segments")?, self.material))
    }

    /// The outline that the key of an OUTLINE names; `None` where it is made from others.
    ///
    /// # Errors
    /// [`Fault`] of the number that has no shape.
    pub(super) fn outline(&self, key: &str) -> Checked<Option<Outline>> {
        let outline = match key {
            "polygon" => Outline::from_loops(&self.values.loops(self.value)?),
            "rectangle" => {
                let corner = |key| self.member(key).map_or(Ok(glam::DVec2::ZERO), |corner| self.values.point(corner));
                Outline::rectangle(corner("min")?, corner("max")?)
            }
            "circle" => Outline::circle(self.number("radius")?, self.segments("segments")?),
            _ => return Ok(None),
        };
        self.accept(outline).map(Some)
    }

    /// The outline, grown or shrunk.
    ///
    /// # Errors
    /// [`Fault`] of the number that has no shape.
    pub(super) fn offset(&self, outline: &Outline) -> Checked<Outline> {
        let join = self.member("join").map(|join| self.values.document.text(join));
        let join = match join.as_deref() {
            Some("miter") => Join::Miter,
            Some("bevel") => Join::Bevel,
            _ => Join::Round,
        };
        self.accept(outline.offset(self.number("by")?, join, self.segments("segments")?))
    }

    /// The result, or a fault of the number that is to blame.
    ///
    /// # Errors
    /// [`Fault`].
    pub(super) fn accept<T>(&self, result: Result<T, ShapeError>) -> Checked<T> {
        result.map_err(|error| self.fault(error))
    }

    fn fault(&self, error: ShapeError) -> Fault {
        let item = |index| self.values.document.items(self.value).nth(index).unwrap_or(self.value);
        match error {
            ShapeError::Parameter { parameter, found, expected } => {
                let entry = self.member(parameter).unwrap_or(self.value);
                Fault::new(entry, with_source(self.values.document, entry, found), expected)
            }
            ShapeError::HalfSpace { index, error: HalfSpaceError::ZeroNormal } => {
                Fault::new(item(index), "a normal of zero", "[nx, ny, nz, d] with a normal that is not zero")
            }
            ShapeError::HalfSpace { index, error } => {
                Fault::new(item(index), error.to_string(), "[nx, ny, nz, d] of magnitudes that are less apart")
            }
            ShapeError::Hull(error @ (HullError::NotFinite { index, .. } | HullError::OutOfRange { index, .. })) => {
                Fault::new(item(index), error.to_string(), "coordinates of a magnitude below 1e45")
            }
            ShapeError::CrossingSides { slices, .. } => {
                let entry = self.member("slices").unwrap_or(self.value);
                let found = format!("{slices} slices, between which the sides cross");
                Fault::new(entry, found, "more slices, or less of a twist")
            }
            ShapeError::TooLarge { found, limit } => {
                Fault::new(self.value, format!("a shape of {found} convex pieces"), format!("at most {limit}"))
            }
            ShapeError::Crossings { found, limit } => {
                Fault::new(self.value, format!("sides that cross {found} times"), format!("at most {limit}"))
            }
            ShapeError::Unbounded => Fault::new(self.value, "an unbounded body", "a bounded one"),
            error => Fault::new(self.value, error.to_string(), "a shape that can be made"),
        }
    }

    /// The value of a key of the key's object.
    pub(super) fn member(&self, key: &str) -> Option<Entry> {
        self.values.document.member(self.value, key)
    }

    /// The number of a key, if it is there.
    pub(super) fn optional(&self, key: &str) -> Checked<Option<f64>> {
        self.member(key).map(|number| self.values.number(number)).transpose()
    }

    /// The number of a key that is required.
    pub(super) fn number(&self, key: &str) -> Checked<f64> {
        // That it is there was checked; the fault is never seen.
        self.optional(key)?.map_or_else(|| self.values.document.refuse(self.value, format!("the key `{key}`")), Ok)
    }

    fn vector(&self, key: &str) -> Checked<DVec3> {
        let refuse = || self.values.document.refuse(self.value, format!("the key `{key}`"));
        self.member(key).map_or_else(refuse, |vector| self.values.vector(vector))
    }

    fn segments(&self, key: &str) -> Checked<u32> {
        self.member(key).map_or(Ok(SEGMENTS), |segments| self.values.whole(segments, 3, MAX_SEGMENTS))
    }
}

/// What was found, with the expression that it came from.
fn with_source(document: &Document<'_>, entry: Entry, found: String) -> String {
    match document.kind(entry) {
        Kind::Text => format!("{found} from \"{}\"", shorten(&document.text(entry))),
        _ => found,
    }
}
