//! Dimensions and scale bars, measured on the picture.

use glam::DVec3;
use planecut_csg::Mesh;
use planecut_picture::{Background, CameraKind, Picture, PreviewOptions, PreviewStyle, render_buffers};

use planecut_testkit::random::Rng;

use crate::oracle::{axes, eye_of, orthographic};
use crate::support::{BACKGROUNDS, CAMERAS, SMALL, STYLES, around, block, differences, draw, painted, pixel, places};

const SIDES: DVec3 = DVec3::new(60.0, 44.0, 54.0);

/// From the front, at the size that lengths of labels are stated for.
const FRONT: PreviewOptions = PreviewOptions {
    width: 1280,
    height: 960,
    style: PreviewStyle::Wireframe,
    camera: CameraKind::Orthographic,
    background: Background::Transparent,
    azimuth: -90.0,
    elevation: 0.0,
    dimensions: true,
    ..SMALL
};

/// The columns and rows that the model covers: first and last.
fn model_on(options: &PreviewOptions) -> [[u32; 2]; 2] {
    let faces = render_buffers(&painted(&block(SIDES)), options).expect("drawn").faces;
    let covered: Vec<_> = places(options.width, options.height)
        .zip(&faces)
        .filter(|(_, face)| face.is_some())
        .map(|(at, _)| at)
        .collect();
    around(&covered)
}

/// The first and the last inked pixel of a line of pixels, and how many are.
fn ink(pixels: impl Iterator<Item = [u8; 4]>) -> (usize, usize, usize) {
    let inked: Vec<usize> =
        pixels.enumerate().filter(|(_, [red, _, _, alpha])| *alpha > 127 && *red < 128).map(|(at, _)| at).collect();
    (inked.first().copied().unwrap_or(0), inked.last().copied().unwrap_or(0), inked.len())
}

/// Of some lines of pixels the one with the most ink: which it is, and where its ink begins and ends.
fn longest(lines: impl Iterator<Item = (u32, (usize, usize, usize))>) -> (u32, usize, usize) {
    let (at, (first, last, _)) = lines.max_by_key(|(_, ink)| ink.2).expect("lines");
    (at, first, last)
}

/// The lines of the dimensions below and to the left of the model: their row and column, and where they begin and end.
fn dimension_lines(picture: &Picture, [min, max]: [[u32; 2]; 2]) -> [(u32, usize, usize); 2] {
    let row = |y: u32| ink((0..picture.width).map(move |x| pixel(picture, x, y)));
    let column = |x: u32| ink((0..picture.height).map(move |y| pixel(picture, x, y)));
    let below = longest((max[1] + 12..picture.height).map(|y| (y, row(y))));
    let left = longest((0..min[0] - 12).map(|x| (x, column(x))));
    [below, left]
}

#[test]
fn arrows_are_as_far_apart_as_the_extents() {
    for background in [Background::Transparent, Background::Light] {
        let options = PreviewOptions { background, ..FRONT };
        let picture = draw(&block(SIDES), &options);
        let model = model_on(&options);
        // The model's own extents say how many pixels a unit has.
        let per_unit = f64::from(model[1][0] - model[0][0] + 1) / SIDES.x;
        assert!((f64::from(model[1][1] - model[0][1] + 1) - per_unit * SIDES.z).abs() < 2.0);
        let [below, left] = dimension_lines(&picture, model);
        for ((at, first, last), extent, axis) in [(below, SIDES.x, 0), (left, SIDES.z, 1)] {
            // Extension lines are as wide as a pixel, half of it beyond each tip.
            let length = (last - first) as f64;
            let what = format!("{background:?}: {length} pixels for {extent} at {per_unit} a unit");
            assert!((length / per_unit - extent).abs() * per_unit < 2.0, "{what}");
            assert!(
                first.abs_diff(model[0][axis] as usize) < 2 && last.abs_diff(model[1][axis] as usize) < 2,
                "{what}"
            );
            // Arrows point outwards: thin at the tips, wider farther in, and no arrows in between.
            let thickness = |along: usize| {
                let across = (0..24).map(|step| [along as u32, at - 12 + step]);
                ink(across.map(|[u, v]| if axis == 0 { pixel(&picture, u, v) } else { pixel(&picture, v, u) })).2
            };
            for inwards in [[first + 4, first + 12, first + 30], [last - 4, last - 12, last - 30]] {
                let [tip, base, line] = inwards.map(thickness);
                assert!(tip >= 1 && base >= tip + 3 && base <= 10 && line <= 3, "{what}: {tip}, {base}, {line}");
            }
        }
    }
}

/// The extents alone decide: the unit changes nothing but the text, which stands on the middle of the line.
#[test]
fn units_are_in_the_text_only() {
    let bare = draw(&block(SIDES), &FRONT);
    let model = model_on(&FRONT);
    let [below, left] = dimension_lines(&bare, model);
    let middle = [(below.1 + below.2) / 2, (left.1 + left.2) / 2].map(|at| at as i64);
    for unit in ["mm", "in", "µm"] {
        let labelled = draw(&block(SIDES), &PreviewOptions { unit: Some(unit), ..FRONT });
        let changed = differences(&bare, &labelled);
        assert!(changed.len() > 40, "{unit}: {} pixels", changed.len());
        for at in changed {
            let [x, y] = at.map(i64::from);
            let on_below = (x - middle[0]).abs() < 90 && (y - i64::from(below.0)).abs() < 30;
            let on_left = (x - i64::from(left.0)).abs() < 30 && (y - middle[1]).abs() < 90;
            assert!(on_below || on_left, "{unit}: pixel {x}, {y}");
        }
    }
}

/// Labels are written in all styles, and nothing of the model is moved by a scale bar.
#[test]
fn scale_bars_are_written_at_the_lower_left() {
    for style in STYLES {
        for background in BACKGROUNDS {
            let options = PreviewOptions { style, background, dimensions: false, ..FRONT };
            let [plain, barred] = [false, true]
                .map(|scale_bar| draw(&block(SIDES), &PreviewOptions { scale_bar, unit: Some("mm"), ..options }));
            let [min, max] = around(&differences(&plain, &barred));
            assert!(min[0] > 10 && max[0] < 1280 * 3 / 10, "{style:?} {background:?}: {min:?}, {max:?}");
            assert!(min[1] > 960 * 8 / 10 && max[1] < 950, "{style:?} {background:?}: {min:?}, {max:?}");
        }
    }
}

/// How many pixels long the scale bar is, and how many pixels a unit has in the middle of the model.
fn scale_bar_on(mesh: &Mesh, options: &PreviewOptions) -> (f64, f64) {
    let [plain, barred] = [false, true].map(|scale_bar| draw(mesh, &PreviewOptions { scale_bar, ..*options }));
    let changed = differences(&plain, &barred);
    let lowest = around(&changed)[1][1];
    // Through the bar, which is 7 pixels high with a rim of 1.2 around it: below any text.
    let bar: Vec<_> = changed.iter().copied().filter(|at| at[1] == lowest - 4).collect();
    let [min, max] = around(&bar);
    let per_unit = match options.camera {
        CameraKind::Orthographic => orthographic(mesh, options).pixels_per_unit,
        CameraKind::Perspective => {
            let found = render_buffers(&painted(mesh), options).expect("drawn");
            let (eye, pixel, _) = eye_of(mesh, options, &found);
            let middle = mesh.positions.iter().sum::<DVec3>() / mesh.positions.len() as f64;
            let depth = axes(options).z_axis.dot(middle - eye);
            1.0 / (pixel * depth)
        }
    };
    (f64::from(max[0] - min[0] + 1), per_unit)
}

/// A scale bar is 1, 2 or 5 times a power of ten units long, and takes up about a fifth of the picture.
#[test]
fn scale_bars_have_round_lengths() {
    let mut random = Rng::new(21);
    for (round, camera) in (0..30).zip(CAMERAS.into_iter().cycle()) {
        let scale = 10_f64.powf(random.float(-5.0, 5.0));
        let mesh = block(SIDES * scale);
        // Three sides are seen, as many as tell where the eye is.
        let azimuth = random.float(20.0, 70.0) + 90.0 * f64::from(round % 4);
        let options = PreviewOptions { azimuth, elevation: 20.0, dimensions: false, width: 960, camera, ..FRONT };
        let options = PreviewOptions { background: Background::Light, ..options };
        let (pixels, per_unit) = scale_bar_on(&mesh, &options);
        let units = pixels / per_unit;
        let power = 10_f64.powf(units.log10().floor());
        let nearest = [1.0, 2.0, 5.0, 10.0].map(|digit| (digit * power / units - 1.0).abs() * pixels);
        let off = nearest.into_iter().fold(f64::INFINITY, f64::min);
        let what = format!("round {round} of seed 21: {pixels} pixels, {units} units, off by {off} pixels");
        println!("{what}");
        assert!(off < 2.0, "{what}");
        assert!(pixels > 960.0 * 0.2 / 2.5 - 2.0 && pixels < 960.0 * 0.2 + 2.0, "{what}");
    }
}
