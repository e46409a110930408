//! Pictures without a background: what is opaque, what is clear, and what comes of it on a ground.

use planecut_csg::Mesh;
use planecut_picture::{Background, CameraKind, Picture, PreviewOptions, PreviewStyle, render_buffers};

use crate::support::{CAMERAS, SMALL, STYLES, draw, linear, painted, pixel, places, unit_box};
use planecut_testkit::meshes;

fn clear(style: PreviewStyle, camera: CameraKind) -> PreviewOptions {
    PreviewOptions { style, camera, background: Background::Transparent, ..SMALL }
}

fn display(linear: f64) -> f64 {
    255.0 * if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

#[test]
fn corners_are_clear_and_surfaces_are_not() {
    for style in STYLES {
        for camera in CAMERAS {
            let options = clear(style, camera);
            let picture = draw(&unit_box(), &options);
            let alphas = |[x, y]: [u32; 2]| pixel(&picture, x, y)[3];
            for corner in [[0, 0], [319, 0], [0, 239], [319, 239]] {
                assert_eq!(pixel(&picture, corner[0], corner[1]), [0; 4], "{style:?} {camera:?}");
            }
            let faces = render_buffers(&painted(&unit_box()), &options).expect("drawn").faces;
            let shown: Vec<u8> =
                places(320, 240).zip(&faces).filter(|(_, face)| face.is_some()).map(|(at, _)| alphas(at)).collect();
            // All but the pixels at the rim are covered altogether.
            let opaque = shown.iter().filter(|&&alpha| alpha == 255).count();
            let clear = shown.iter().filter(|&&alpha| alpha == 0).count();
            let what = format!("{style:?} {camera:?}: {opaque} and {clear} of {}", shown.len());
            match style {
                PreviewStyle::Shaded | PreviewStyle::Technical => {
                    assert!(alphas([160, 120]) == 255 && opaque > 9 * shown.len() / 10 && clear == 0, "{what}");
                }
                PreviewStyle::XRay => assert!(opaque < shown.len() / 10 && clear == 0, "{what}"),
                _ => assert!(opaque < shown.len() / 10 && clear > shown.len() / 2, "{what}"),
            }
        }
    }
}

/// The shadow is black and neither clear nor opaque; only a model that is looked down on and shaded has one.
#[test]
fn the_shadow_is_in_the_alpha_channel() {
    for camera in CAMERAS {
        // Where neither a face nor a line can be.
        let beside = |options: &PreviewOptions| -> Vec<[u8; 4]> {
            let picture = draw(&unit_box(), options);
            let faces = render_buffers(&painted(&unit_box()), options).expect("drawn").faces;
            let is_beside = |[x, y]: [u32; 2]| {
                let (columns, rows) = (x.saturating_sub(3)..(x + 4).min(320), y.saturating_sub(3)..(y + 4).min(240));
                rows.flat_map(|y| columns.clone().map(move |x| y * 320 + x)).all(|i| faces[i as usize].is_none())
            };
            places(320, 240).filter(|&at| is_beside(at)).map(|[x, y]| pixel(&picture, x, y)).collect()
        };
        let shadow = beside(&clear(PreviewStyle::Shaded, camera));
        let dark: Vec<_> = shadow.iter().filter(|pixel| pixel[3] > 20).collect();
        assert!(dark.len() > 500 && dark.len() < shadow.len() / 2, "{camera:?}: {} pixels", dark.len());
        assert!(dark.iter().all(|pixel| pixel[3] < 200 && pixel[..3].iter().all(|&byte| byte <= 1)), "{camera:?}");
        let from_below = PreviewOptions { elevation: -20.0, ..clear(PreviewStyle::Shaded, camera) };
        assert!(beside(&from_below).iter().all(|pixel| *pixel == [0; 4]), "a shadow seen from below the floor");
        for style in &STYLES[1..] {
            assert!(beside(&clear(*style, camera)).iter().all(|pixel| *pixel == [0; 4]), "{style:?}: a shadow");
        }
    }
}

/// Put over the light background, in linear light, a clear picture is the light one: nothing but the background is missing from it.
#[test]
fn over_the_light_background_it_is_the_light_picture() {
    for style in STYLES {
        for camera in CAMERAS {
            let options = clear(style, camera);
            let light = PreviewOptions { background: Background::Light, ..options };
            let mesh = meshes::random_boxes(12, 5);
            let [top, ground, expected]: [Picture; 3] =
                [(&mesh, &options), (&Mesh::default(), &light), (&mesh, &light)]
                    .map(|(mesh, options)| draw(mesh, options));
            let (mut worst, mut mixed) = (0.0_f64, 0);
            for [x, y] in places(320, 240) {
                let [top, ground, expected] = [&top, &ground, &expected].map(|picture| pixel(picture, x, y));
                let alpha = f64::from(top[3]) / 255.0;
                mixed += u32::from(top[3] > 0 && top[3] < 255);
                for channel in 0..3 {
                    if top[3] == 255 || top[3] == 0 {
                        let whole = if top[3] == 255 { top } else { ground };
                        // An alpha that is nearly nothing, or nearly all, is rounded to that.
                        let is_near = whole[channel].abs_diff(expected[channel]) <= 1;
                        assert!(is_near, "{style:?} {camera:?}: pixel {x}, {y} is {expected:?}, not {whole:?}");
                        continue;
                    }
                    let sum = linear(top[channel]) * alpha + linear(ground[channel]) * (1.0 - alpha);
                    worst = worst.max((display(sum) - f64::from(expected[channel])).abs());
                }
            }
            assert!(mixed > 100, "{style:?} {camera:?}: {mixed} pixels");
            assert!(worst < 4.0, "{style:?} {camera:?}: off by {worst}");
        }
    }
}
