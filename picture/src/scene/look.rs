//! What a preview looks like: colours and strengths, in one place.

use glam::Vec3;

use crate::color::srgb_to_linear;
use crate::input::mesh::Tint;
use crate::input::options::{Background, PreviewStyle};

/// How surfaces are filled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Fill {
    /// The nearest one is seen.
    Opaque,
    /// All are seen, each through those before it.
    Translucent,
    /// Only lines are seen.
    Nothing,
}

/// What becomes of the hidden parts of edges.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Hidden {
    /// They are left out.
    Omitted,
    /// They are dashed, at this opacity.
    Dashed(f32),
    /// They are drawn at this part of the opacity that they would have if they were seen.
    Faint(f32),
}

/// How lines are drawn.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LineLook {
    /// Faces that meet at an angle with a larger cosine than this look like one.
    pub(crate) smooth_cosine: f64,
    /// Opacity of edges between two visible faces at a right angle, and of outlines.
    pub(crate) crease: f32,
    pub(crate) outline: f32,
    /// Opacity of edges between triangles of one face.
    pub(crate) inner: f32,
    /// Widths in a picture whose shorter side is 960 pixels, in pixels.
    pub(crate) crease_width: f32,
    pub(crate) outline_width: f32,
    pub(crate) hidden: Hidden,
    /// Colour of all lines.
    pub(crate) ink: Vec3,
}

/// The numbers behind a [`PreviewStyle`]. Colours are linear RGB.
pub(crate) struct Look {
    /// Background at the top and at the bottom edge of the picture; `None` where it is transparent.
    pub(crate) background: Option<[Vec3; 2]>,
    pub(crate) fill: Fill,
    /// Colour of surfaces without tint.
    pub(crate) clay: Vec3,
    /// How far surfaces go from clay to the colour of their material, 0 to 1: one derived from the name, one stated.
    pub(crate) tint: f32,
    pub(crate) stated_tint: f32,
    /// Light from above and from below, from the key light, from the fill light, and from behind.
    pub(crate) sky: Vec3,
    pub(crate) bounce: Vec3,
    pub(crate) key: Vec3,
    pub(crate) fill_light: Vec3,
    pub(crate) rim: Vec3,
    /// How much of the ambient light crevices lose, 0 to 1.
    pub(crate) occlusion: f32,
    /// How dark the shadow and the contact of the model are on the floor, 0 to 1.
    pub(crate) floor: f32,
    pub(crate) lines: LineLook,
}

impl Look {
    /// The colour of a surface: clay, with more or less of a tint.
    pub(crate) fn tinted(&self, tint: Tint) -> Vec3 {
        let clean = |channel: f32| if channel.is_nan() { 0.0 } else { channel.clamp(0.0, 1.0) };
        let (color, part) = match tint {
            Tint::Clay => return self.clay,
            Tint::Derived(color) => (color, self.tint),
            Tint::Stated(color) => (color, self.stated_tint),
        };
        self.clay.lerp(Vec3::from(color.map(clean)), part)
    }

    pub(crate) fn new(style: PreviewStyle, background: Background) -> Self {
        let is_dark = background == Background::Dark;
        let look = match style {
            PreviewStyle::Shaded => Self::shaded(is_dark),
            PreviewStyle::Technical => Self::technical(is_dark),
            PreviewStyle::XRay => Self::x_ray(is_dark),
            PreviewStyle::Wireframe => Self::wireframe(is_dark),
        };
        Self { background: look.background.filter(|_| background != Background::Transparent), ..look }
    }

    fn shaded(is_dark: bool) -> Self {
        let light = [display(0.90, 0.92, 0.945), display(0.76, 0.79, 0.83)];
        let dark = [display(0.17, 0.185, 0.21), display(0.10, 0.11, 0.13)];
        Self {
            background: Some(if is_dark { dark } else { light }),
            fill: Fill::Opaque,
            clay: display(0.80, 0.785, 0.76),
            tint: 0.34,
            stated_tint: 0.8,
            sky: Vec3::new(0.36, 0.40, 0.46),
            bounce: Vec3::new(0.20, 0.18, 0.16),
            key: Vec3::new(1.02, 0.96, 0.86),
            fill_light: Vec3::new(0.13, 0.15, 0.19),
            rim: if is_dark { Vec3::new(0.34, 0.38, 0.44) } else { Vec3::new(0.16, 0.17, 0.19) },
            occlusion: 0.85,
            floor: if is_dark { 0.75 } else { 0.5 },
            lines: LineLook {
                smooth_cosine: ONE_DEGREE,
                crease: 0.62,
                outline: 0.92,
                inner: 0.0,
                crease_width: 1.05,
                outline_width: 1.7,
                hidden: Hidden::Omitted,
                ink: if is_dark { display(0.03, 0.035, 0.045) } else { display(0.10, 0.12, 0.16) },
            },
        }
    }

    fn technical(is_dark: bool) -> Self {
        let paper = if is_dark { display(0.075, 0.125, 0.195) } else { Vec3::ONE };
        let light = if is_dark { 0.9 } else { 1.0 };
        Self {
            background: Some([paper; 2]),
            fill: Fill::Opaque,
            clay: if is_dark { display(0.10, 0.16, 0.24) } else { display(0.985, 0.985, 0.985) },
            tint: 0.0,
            stated_tint: 0.0,
            sky: Vec3::splat(0.80 * light),
            bounce: Vec3::splat(0.66 * light),
            key: Vec3::splat(0.22),
            fill_light: Vec3::ZERO,
            rim: Vec3::ZERO,
            occlusion: 0.2,
            floor: 0.0,
            lines: LineLook {
                smooth_cosine: TANGENT_EDGES,
                crease: 0.95,
                outline: 1.0,
                inner: 0.0,
                crease_width: 1.15,
                outline_width: 2.3,
                hidden: Hidden::Dashed(0.5),
                ink: if is_dark { display(0.86, 0.92, 0.98) } else { display(0.05, 0.06, 0.08) },
            },
        }
    }

    fn x_ray(is_dark: bool) -> Self {
        Self {
            background: Some(if is_dark {
                [display(0.075, 0.09, 0.12), display(0.03, 0.035, 0.05)]
            } else {
                [display(0.97, 0.975, 0.985), display(0.90, 0.915, 0.94)]
            }),
            fill: Fill::Translucent,
            clay: display(0.62, 0.70, 0.80),
            tint: 0.5,
            stated_tint: 0.95,
            sky: Vec3::splat(0.62),
            bounce: Vec3::splat(0.42),
            key: Vec3::splat(0.55),
            fill_light: Vec3::splat(0.06),
            rim: Vec3::ZERO,
            occlusion: 0.0,
            floor: 0.0,
            lines: LineLook {
                smooth_cosine: TANGENT_EDGES,
                crease: 0.62,
                outline: 0.82,
                inner: 0.0,
                crease_width: 1.0,
                outline_width: 1.35,
                hidden: Hidden::Faint(0.42),
                ink: if is_dark { display(0.80, 0.88, 0.97) } else { display(0.10, 0.14, 0.22) },
            },
        }
    }

    fn wireframe(is_dark: bool) -> Self {
        Self {
            fill: Fill::Nothing,
            lines: LineLook {
                smooth_cosine: ONE_DEGREE,
                crease: 0.9,
                outline: 1.0,
                inner: 0.4,
                crease_width: 1.1,
                outline_width: 1.3,
                hidden: Hidden::Faint(0.22),
                ink: if is_dark { display(0.72, 0.86, 0.98) } else { display(0.06, 0.10, 0.17) },
            },
            ..Self::x_ray(is_dark)
        }
    }
}

/// Cosine of one degree: what meets at less looks like one.
const ONE_DEGREE: f64 = 0.999_847_7;

/// Cosine of 19 degrees: drawings leave out the edges between the facets of something round.
const TANGENT_EDGES: f64 = 0.945_5;

/// Linear colour from the numbers a colour picker shows, each divided by 255.
pub(crate) fn display(r: f32, g: f32, b: f32) -> Vec3 {
    Vec3::from([r, g, b].map(srgb_to_linear))
}
