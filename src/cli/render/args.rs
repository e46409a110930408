//! What may stand on the command line of `render`. The doc comments here are the help texts.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use planecut::kernel::{DVec3, HalfSpace};
use planecut::picture::{Background, CameraKind, PreviewOptions, PreviewStyle};

use crate::cli::args::{CommonArgs, Size, parse_size};
use crate::cli::asset_args::UnitName;
use crate::cli::reading_args::ReadingArgs;

/// Arguments of `render`.
#[derive(Debug, Args)]
pub(crate) struct RenderArgs {
    /// The model, map, tree or mesh to read (.json, .map, .csg, .obj, .stl, .ply, .glb, .gltf); `-` is standard input. Of several
    /// a contact sheet is made
    #[arg(value_name = "INPUT", required = true)]
    pub(crate) inputs: Vec<PathBuf>,
    /// Picture to write: .png, or a turntable as .gif or .apng; `-` is standard output, as PNG
    #[arg(short, long, value_name = "PICTURE")]
    pub(crate) output: PathBuf,
    /// How to draw
    #[arg(long, value_enum, default_value_t = Style::Shaded)]
    pub(crate) style: Style,
    /// Size of the picture in pixels; by default 1280x960, of turntables 640x480
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    size: Option<Size>,
    #[command(flatten)]
    view: ViewArgs,
    #[command(flatten)]
    pub(crate) cut: CutArgs,
    #[command(flatten)]
    labels: LabelArgs,
    #[command(flatten)]
    pub(crate) buffers: BufferArgs,
    #[command(flatten)]
    pub(crate) sequence: SequenceArgs,
    #[command(flatten)]
    pub(crate) reading: ReadingArgs,
    #[command(flatten)]
    pub(crate) common: CommonArgs,
}

impl RenderArgs {
    /// The same as the library wants it; `is_animation` says whether the picture is a turntable.
    pub(crate) fn options(&self, is_animation: bool) -> PreviewOptions {
        let size = self.size.unwrap_or(if is_animation { Size::TURNTABLE } else { Size::DEFAULT });
        let style = match self.style {
            Style::Shaded | Style::Exploded | Style::Section => PreviewStyle::Shaded,
            Style::Technical => PreviewStyle::Technical,
            Style::Xray => PreviewStyle::XRay,
            Style::Wireframe => PreviewStyle::Wireframe,
        };
        let View { azimuth, elevation } = self.view.view.unwrap_or_default();
        let default_camera = match self.style {
            // Lengths can be taken from a drawing.
            Style::Technical => Camera::Orthographic,
            _ => Camera::Perspective,
        };
        PreviewOptions {
            style,
            azimuth,
            elevation,
            camera: match self.view.camera.unwrap_or(default_camera) {
                Camera::Perspective => CameraKind::Perspective,
                Camera::Orthographic => CameraKind::Orthographic,
            },
            background: match self.view.background {
                Ground::Light => Background::Light,
                Ground::Dark => Background::Dark,
                Ground::Transparent => Background::Transparent,
            },
            dimensions: self.labels.dimensions,
            scale_bar: self.labels.scale_bar,
            unit: self.labels.unit.map(|name| name.unit().symbol()),
            ..size.preview()
        }
    }

    /// Where the model is cut open, if it is.
    pub(crate) fn section(&self) -> Option<Section> {
        self.cut.section.or((self.style == Style::Section).then_some(Section::Facing))
    }

    /// How far its cells are moved apart, if they are what is drawn.
    pub(crate) fn spread(&self) -> Option<f64> {
        match self.style {
            Style::Exploded => Some(self.cut.spread.unwrap_or(DEFAULT_SPREAD)),
            Style::Xray => Some(self.cut.spread.unwrap_or(0.0)),
            _ => self.cut.spread,
        }
    }
}

/// How far `exploded` moves cells: their distances from the middle grow by this factor of what they are.
const DEFAULT_SPREAD: f64 = 0.5;

/// Where from and on what ground.
#[derive(Debug, Args)]
#[command(next_help_heading = "View")]
struct ViewArgs {
    /// Where to look from: front, back, left, right, top, bottom, iso, or AZIMUTH,ELEVATION in degrees, the azimuth from the x axis towards the
    /// y axis [default: -62,32]
    #[arg(long, value_name = "VIEW", value_parser = parse_view, allow_hyphen_values = true)]
    view: Option<View>,
    /// How depth is shown; by default in perspective, drawings (technical) without
    #[arg(long, value_enum)]
    camera: Option<Camera>,
    /// What is behind the model
    #[arg(long, value_enum, default_value_t = Ground::Light)]
    background: Ground,
}

/// What is taken away or moved.
#[derive(Debug, Args)]
#[command(next_help_heading = "Inside")]
pub(crate) struct CutArgs {
    /// Cut the model open, whatever the style: x, y or z through its middle, x=1.5 elsewhere (the part towards the camera goes), or
    /// NX,NY,NZ,D to keep what is in the half-space n·x <= d
    #[arg(long, value_name = "PLANE", value_parser = parse_section, allow_hyphen_values = true)]
    section: Option<Section>,
    /// Draw the cells, each in a colour of its own, moved from the middle by R times their distance from it; 0 leaves them in
    /// place [default of exploded: 0.5]
    #[arg(long, value_name = "R", value_parser = parse_spread)]
    spread: Option<f64>,
}

/// What is written into the picture.
#[derive(Debug, Args)]
#[command(next_help_heading = "Labels")]
struct LabelArgs {
    /// Draw the extents of the model along the axes
    #[arg(long)]
    dimensions: bool,
    /// Draw a bar that tells how long something is; in perspective, at the depth of the model's middle
    #[arg(long)]
    scale_bar: bool,
    /// What the lengths are in, for labels
    #[arg(long, value_enum)]
    unit: Option<UnitName>,
}

/// What else is known of each pixel.
#[derive(Debug, Args)]
#[command(next_help_heading = "Buffers")]
pub(crate) struct BufferArgs {
    /// Also write how far away the surface is, as 16-bit greys: 0 nearest, 65534 farthest, 65535 nothing; `near` and `far` stand in the file
    #[arg(long, value_name = "PNG")]
    pub(crate) depth: Option<PathBuf>,
    /// Also write what each pixel shows, its number plus one as a 24-bit colour, 0 for nothing
    #[arg(long, value_name = "PNG")]
    pub(crate) ids: Option<PathBuf>,
    /// What --ids numbers
    #[arg(long, value_enum, default_value_t = IdKind::Face, requires = "ids")]
    pub(crate) id_of: IdKind,
}

/// Several pictures.
#[derive(Debug, Args)]
#[command(next_help_heading = "Turntables and contact sheets")]
pub(crate) struct SequenceArgs {
    /// Pictures of one turn
    #[arg(long, value_name = "N", default_value_t = 72, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) frames: u32,
    /// Milliseconds for each
    #[arg(long, value_name = "MS", default_value_t = 50, value_parser = clap::value_parser!(u16).range(10..=10_000))]
    pub(crate) frame_time: u16,
    /// Columns of a contact sheet; by default as many as suit its size
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) columns: Option<u32>,
}

/// Looks of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Style {
    /// Tinted clay in soft light with shadows
    Shaded,
    /// A line drawing, hidden edges dashed
    Technical,
    /// Cells that are seen through
    Xray,
    /// Cells apart from each other, each in a colour of its own
    Exploded,
    /// Cut open, the faces of the cut hatched
    Section,
    /// The edges of all triangles
    Wireframe,
}

/// How depth is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Camera {
    /// What is far away is small
    Perspective,
    /// Lengths across the view are the same everywhere
    Orthographic,
}

/// What is behind the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Ground {
    /// A light studio, or paper
    Light,
    /// A dark studio
    Dark,
    /// Nothing but the shadow on the floor
    Transparent,
}

/// What numbers of pixels count.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum IdKind {
    /// The flat regions of the mesh
    Face,
    /// The materials, in the input's order; with cells, these
    Material,
    /// The brushes, as the input counts them
    Brush,
}

/// Where the camera stands, in degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
struct View {
    azimuth: f64,
    elevation: f64,
}

impl Default for View {
    fn default() -> Self {
        let PreviewOptions { azimuth, elevation, .. } = PreviewOptions::default();
        Self { azimuth, elevation }
    }
}

/// Where a model is cut open.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Section {
    /// Through the middle, across the horizontal axis that the camera looks along most.
    Facing,
    /// Across an axis, at a place or through the middle; what is nearer to the camera goes.
    Axis(usize, Option<f64>),
    /// What is in this half-space stays.
    Plane(HalfSpace),
}

impl Section {
    /// The half-space to keep of a model between two corners, as the camera sees it.
    pub(crate) fn half_space(self, [min, max]: [DVec3; 2], options: &PreviewOptions) -> Option<HalfSpace> {
        let towards_eye = DVec3::from(options.towards_camera());
        let middle = round_middle(min, max);
        let (axis, place) = match self {
            Self::Plane(half_space) => return Some(half_space),
            Self::Axis(axis, place) => (axis, place.unwrap_or(middle[axis])),
            Self::Facing => {
                let axis = usize::from(towards_eye.y.abs() > towards_eye.x.abs());
                (axis, middle[axis])
            }
        };
        let side = if towards_eye[axis] < 0.0 { -1.0 } else { 1.0 };
        HalfSpace::new(DVec3::AXES[axis] * side, place * side).ok()
    }
}

/// The middle of a box, in few digits: what is symmetric is cut in its plane of symmetry, not a rounding error beside it.
fn round_middle(min: DVec3, max: DVec3) -> DVec3 {
    let middle = min * 0.5 + max * 0.5;
    let step = ((max - min).max_element() * 1e-6).max(f64::MIN_POSITIVE).log2().floor().exp2();
    let rounded = (middle / step).round() * step;
    if rounded.is_finite() { rounded } else { middle }
}

fn parse_view(text: &str) -> Result<View, String> {
    let view = |azimuth, elevation| Ok(View { azimuth, elevation });
    match text {
        "front" => view(-90.0, 0.0),
        "back" => view(90.0, 0.0),
        "left" => view(180.0, 0.0),
        "right" => view(0.0, 0.0),
        "top" => view(-90.0, 90.0),
        "bottom" => view(-90.0, -90.0),
        // The three axes are equally long: the elevation has the sine 1/√3.
        "iso" => view(-45.0, (1.0_f64 / 3.0).sqrt().asin().to_degrees()),
        _ => match numbers(text).as_deref() {
            Some(&[azimuth, elevation]) if elevation.abs() <= 90.0 => view(azimuth, elevation),
            _ => Err(
                "expected front, back, left, right, top, bottom, iso, or AZIMUTH,ELEVATION in degrees, the elevation \
                      from -90 to 90"
                    .to_owned(),
            ),
        },
    }
}

fn parse_section(text: &str) -> Result<Section, String> {
    let axis = |name: &str| ["x", "y", "z"].iter().position(|axis| *axis == name);
    let expected = || "expected x, y or z, as x=1.5, or NX,NY,NZ,D with a normal that is not zero".to_owned();
    if let Some(axis) = axis(text) {
        return Ok(Section::Axis(axis, None));
    }
    if let Some((name, place)) = text.split_once('=') {
        let place = place.trim().parse().ok().filter(|place: &f64| place.abs() <= 1e30);
        let axis = axis(name.trim()).zip(place).map(|(axis, place)| Section::Axis(axis, Some(place)));
        return axis.ok_or_else(expected);
    }
    match numbers(text).as_deref() {
        Some(&[x, y, z, d]) => HalfSpace::new(DVec3::new(x, y, z), d).map(Section::Plane).map_err(|_| expected()),
        _ => Err(expected()),
    }
}

/// Finite numbers with commas between them.
fn numbers(text: &str) -> Option<Vec<f64>> {
    text.split(',').map(|part| part.trim().parse().ok().filter(|number: &f64| number.is_finite())).collect()
}

fn parse_spread(text: &str) -> Result<f64, String> {
    let spread = text.parse().ok().filter(|spread| (0.0..=100.0).contains(spread));
    spread.ok_or_else(|| "expected a number between 0 and 100".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn views_have_names_or_angles() {
        assert_eq!(parse_view("-62.5, 10"), Ok(View { azimuth: -62.5, elevation: 10.0 }));
        let iso = parse_view("iso").expect("a view");
        assert!((iso.elevation - 35.264_39).abs() < 1e-4);
        for text in ["", "up", "1", "1,91", "nan,0", "1,2,3", "1,inf"] {
            assert!(parse_view(text).is_err(), "{text}");
        }
    }

    #[test]
    fn sections_are_axes_or_planes() {
        assert_eq!(parse_section("y"), Ok(Section::Axis(1, None)));
        assert_eq!(parse_section("z=-2.5"), Ok(Section::Axis(2, Some(-2.5))));
        let plane = HalfSpace::new(DVec3::new(0.0, 3.0, 4.0), 5.0).expect("a plane");
        assert_eq!(parse_section("0,3,4,5"), Ok(Section::Plane(plane)));
        for text in ["", "w", "x=", "x=nan", "x=1e31", "0,0,0,1", "1,2,3", "=1", "1,2,3,4,5", "nan,0,0,1"] {
            assert!(parse_section(text).is_err(), "{text}");
        }
    }

    /// What the camera is nearer to goes, so that it sees the cut.
    #[test]
    fn sections_open_towards_the_camera() {
        let bounds = [DVec3::ZERO, DVec3::new(2.0, 4.0, 6.0)];
        let kept = |section: Section, azimuth, elevation| {
            let options = PreviewOptions { azimuth, elevation, ..PreviewOptions::default() };
            let half_space = section.half_space(bounds, &options).expect("a plane");
            (half_space.normal(), half_space.offset())
        };
        assert_eq!(kept(Section::Axis(0, None), 0.0, 30.0), (DVec3::X, 1.0));
        assert_eq!(kept(Section::Axis(0, Some(0.5)), 180.0, 30.0), (-DVec3::X, -0.5));
        assert_eq!(kept(Section::Facing, -62.0, 32.0), (-DVec3::Y, -2.0));
        assert_eq!(kept(Section::Facing, 20.0, 32.0), (DVec3::X, 1.0));
        assert_eq!(kept(Section::Axis(2, None), -90.0, -90.0), (-DVec3::Z, -3.0));
    }
}
