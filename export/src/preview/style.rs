//! What a preview looks like: colours and strengths, in one place.

use glam::Vec3;

use crate::color::srgb_to_linear;

/// How a preview is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum PreviewStyle {
    /// Tinted clay in soft light with shadows, on a studio floor.
    #[default]
    Shaded,
    /// A line drawing on paper with a hint of shading, for print.
    Technical,
}

/// The numbers behind a [`PreviewStyle`]. Colours are linear RGB.
pub(super) struct Look {
    /// Background at the top and at the bottom edge of the picture.
    pub(super) background: [Vec3; 2],
    /// Colour of surfaces without tint.
    pub(super) clay: Vec3,
    /// How far surfaces go from clay to the colour of their material, 0 to 1: one derived from the name, one stated.
    pub(super) tint: f32,
    pub(super) stated_tint: f32,
    /// Light from above and from below, from the key light and from the fill light.
    pub(super) sky: Vec3,
    pub(super) bounce: Vec3,
    pub(super) key: Vec3,
    pub(super) fill: Vec3,
    /// How much of the ambient light crevices lose, 0 to 1.
    pub(super) occlusion: f32,
    /// How dark the shadow and the contact of the model are on the floor, 0 to 1.
    pub(super) floor: f32,
    /// Colour of edges.
    pub(super) ink: Vec3,
    /// Opacity of edges between two visible faces at a right angle, and of outlines.
    pub(super) crease: f32,
    pub(super) outline: f32,
    /// Width of edges in a picture whose shorter side is 960 pixels, in pixels.
    pub(super) line_width: f32,
}

impl Look {
    pub(super) fn new(style: PreviewStyle) -> Self {
        match style {
            PreviewStyle::Shaded => Self {
                background: [display(0.90, 0.92, 0.945), display(0.76, 0.79, 0.83)],
                clay: display(0.80, 0.785, 0.76),
                tint: 0.34,
                stated_tint: 0.8,
                sky: Vec3::new(0.36, 0.40, 0.46),
                bounce: Vec3::new(0.20, 0.18, 0.16),
                key: Vec3::new(1.02, 0.96, 0.86),
                fill: Vec3::new(0.13, 0.15, 0.19),
                occlusion: 0.85,
                floor: 0.5,
                ink: display(0.10, 0.12, 0.16),
                crease: 0.7,
                outline: 0.9,
                line_width: 1.25,
            },
            PreviewStyle::Technical => Self {
                background: [display(1.0, 1.0, 1.0), display(1.0, 1.0, 1.0)],
                clay: display(0.98, 0.98, 0.98),
                tint: 0.0,
                stated_tint: 0.0,
                sky: Vec3::splat(0.80),
                bounce: Vec3::splat(0.60),
                key: Vec3::splat(0.25),
                fill: Vec3::ZERO,
                occlusion: 0.35,
                floor: 0.0,
                ink: display(0.05, 0.06, 0.08),
                crease: 0.95,
                outline: 1.0,
                line_width: 1.3,
            },
        }
    }
}

/// Linear colour from the numbers a colour picker shows, each divided by 255.
fn display(r: f32, g: f32, b: f32) -> Vec3 {
    Vec3::from([r, g, b].map(srgb_to_linear))
}
