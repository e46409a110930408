//! The cells that `coarsen` writes, as each format holds them: rounded outward, and without doubled corners.

use planecut::csg::coarsen::{CoarsenError, Writing, written_meshes};
use planecut::csg::{Brush, Material, Mesh};
use planecut::export::{ExportOptions, Format, TextureMapping, Unit, stored_positions};
use planecut::kernel::{DVec3, hull};

use super::output::OutputFormat;
use super::pieces::{Pieces, brush_meshes};
use super::report::MeshPart;

/// What the cells are written with.
pub(crate) struct Request<'a> {
    pub(crate) materials: &'a [Material],
    /// A pattern for their names.
    pub(crate) name: &'a str,
    /// Whether they hold the solid; otherwise they lie within it.
    pub(crate) encloses: bool,
    pub(crate) max_vertices: Option<usize>,
    pub(crate) options: ExportOptions,
    /// Whether they are written as convex bodies, too.
    pub(crate) has_bodies: bool,
    /// Whether vertices are values of single precision in all formats.
    pub(crate) is_single: bool,
}

/// What vertices are rounded to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Numbers {
    /// As a file has them.
    In(Format),
    /// Metres in single precision, for rigid bodies.
    Meters,
}

impl Numbers {
    /// Those of an output; nothing where it holds planes.
    pub(crate) fn of(format: OutputFormat) -> Option<Self> {
        match format {
            OutputFormat::Mesh(format) => Some(Self::In(format)),
            OutputFormat::Physics(_) => Some(Self::Meters),
            OutputFormat::Brushes(_) | OutputFormat::Model => None,
        }
    }

    /// Where a reader finds positions.
    fn stored(self, positions: &[DVec3], is_single: bool, options: &ExportOptions) -> Vec<DVec3> {
        match self {
            Self::In(format @ (Format::Glb | Format::Gltf | Format::Stl)) => {
                stored_positions(positions, format, options)
            }
            Self::In(format) if !is_single => stored_positions(positions, format, options),
            Self::In(_) | Self::Meters => positions.iter().map(|position| position.as_vec3().as_dvec3()).collect(),
        }
    }
}

/// The cells in some formats.
pub(crate) struct WrittenCells {
    /// The first is what the report tells of. Cells have the same numbers in all.
    formats: Vec<Rounded>,
    bodies: Vec<Brush>,
    /// Those to write bodies with.
    options: ExportOptions,
}

struct Rounded {
    numbers: Numbers,
    /// In the units of the file, where these are not left to a node.
    pieces: Pieces,
    /// With what is left of the scale.
    options: ExportOptions,
    measured: MeshPart,
}

impl WrittenCells {
    /// The cells in some formats, double precision among them; of formats that are named twice the first counts.
    ///
    /// # Errors
    /// [`CoarsenError::OutOfRange`] where a format has no numbers for a cell.
    pub(crate) fn of(
        cells: &[Brush],
        formats: impl Iterator<Item = Numbers>,
        request: &Request<'_>,
    ) -> Result<Self, CoarsenError> {
        let mut known: Vec<(Numbers, ExportOptions, f64, Vec<Mesh>)> = Vec::new();
        for numbers in formats {
            if !known.iter().any(|(other, ..)| *other == numbers) {
                let (options, scale) = left_of_scale(numbers, &request.options);
                let stored = |positions: &[DVec3]| numbers.stored(positions, request.is_single, &options);
                let writing = Writing {
                    scale,
                    max_vertices: request.max_vertices.unwrap_or(usize::MAX),
                    encloses: request.encloses,
                    is_separated: true,
                    stored: &stored,
                };
                let meshes = written_meshes(cells, request.materials, &writing)?;
                known.push((numbers, options, scale, meshes));
            }
        }
        // within a solid a cell may be thinner than rounding: it has no number in any format
        let is_kept = |cell: &usize| known.iter().all(|(.., meshes)| !meshes[*cell].triangles.is_empty());
        let kept: Vec<usize> = (0..cells.len()).filter(is_kept).collect();
        let mut bodies: Vec<Brush> = kept.iter().map(|cell| cells[*cell].clone()).collect();
        if request.has_bodies {
            let (_, _, scale, meshes) =
                &known[known.iter().position(|known| known.0 == Numbers::In(Format::Obj)).unwrap_or(0)];
            let own = brush_meshes(&bodies, request.materials)?;
            for ((body, own), cell) in bodies.iter_mut().zip(own).zip(&kept) {
                if own.triangles.is_empty() {
                    *body = thicker(body, &meshes[*cell], 1.0 / scale);
                }
            }
        }
        let rounded = |(numbers, options, scale, mut meshes): (Numbers, ExportOptions, f64, Vec<Mesh>)| {
            let meshes = kept.iter().map(|cell| std::mem::take(&mut meshes[*cell])).collect();
            let pieces = Pieces::named(meshes, request.name);
            Rounded { numbers, measured: pieces.measured_at(1.0 / scale), pieces, options }
        };
        Ok(Self { formats: known.into_iter().map(rounded).collect(), bodies, options: request.options.clone() })
    }

    /// The cells for a format, and the options to write them with.
    pub(crate) fn in_format(&self, format: OutputFormat) -> (&Pieces, &ExportOptions) {
        match Numbers::of(format) {
            Some(numbers) => {
                let known = self.formats.iter().find(|known| known.numbers == numbers).unwrap_or(&self.formats[0]);
                (&known.pieces, &known.options)
            }
            None => (&self.formats[0].pieces, &self.options),
        }
    }

    /// The cells as convex bodies.
    pub(crate) fn bodies(&self) -> &[Brush] {
        &self.bodies
    }

    /// The counts of the first format, in the units of the input.
    pub(crate) fn measured(&self) -> MeshPart {
        self.formats[0].measured.clone()
    }
}

/// The body of a cell as it is written in double precision, where its own is thinner than rounding.
fn thicker(body: &Brush, written: &Mesh, scale: f64) -> Brush {
    let points: Vec<DVec3> = written.positions.iter().map(|position| *position * scale).collect();
    let (Ok(hull), Some(face)) = (hull(&points), body.faces.first()) else { return body.clone() };
    let half_spaces = hull.facets().into_iter().filter_map(|(plane, _)| hull.plane(plane).copied());
    Brush::from_half_spaces(half_spaces, face.material)
}

/// Metres for each unit of what is written with some options.
pub(crate) fn meters(options: &ExportOptions) -> f64 {
    options.scale * options.unit.unwrap_or(Unit::Meter).meters()
}

/// The options of a format without the scale that its positions have already, and that scale: glTF has its scale in a node.
fn left_of_scale(numbers: Numbers, options: &ExportOptions) -> (ExportOptions, f64) {
    let scale = match numbers {
        Numbers::In(Format::Glb | Format::Gltf) => return (options.clone(), 1.0),
        Numbers::In(Format::Obj | Format::Stl | Format::ThreeMf | Format::Ply) => options.scale,
        Numbers::Meters => meters(options),
    };
    let texture = options.texture.map(|texture| TextureMapping { size: texture.size * scale, ..texture });
    (ExportOptions { scale: 1.0, texture, ..options.clone() }, scale)
}
