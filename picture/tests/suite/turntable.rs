//! A turn of a model: every picture the same view of it, turned.

use glam::{DMat3, DVec3};
use planecut_csg::Mesh;
use planecut_picture::{Background, CameraKind, Picture, PreviewOptions, PreviewStyle, Turntable};

use crate::support::{BACKGROUNDS, CAMERAS, SMALL, STYLES, around, draw, largest_difference, painted, pixel, places};
use planecut_testkit::meshes;

fn frames(mesh: &Mesh, options: &PreviewOptions, count: u32) -> Vec<Picture> {
    let subject = painted(mesh);
    let turn = Turntable::new(&subject, options, count).expect("a turn");
    assert_eq!(turn.frames(), count);
    (0..count).map(|number| turn.frame(number).expect("drawn")).collect()
}

/// A step later is a turn that begins a step later, and all steps are a whole turn.
#[test]
fn each_frame_is_the_first_of_a_turn_that_begins_there() {
    let mesh = meshes::random_boxes(8, 2);
    for style in STYLES {
        for camera in CAMERAS {
            let options = PreviewOptions { style, camera, azimuth: 30.0, width: 160, height: 120, ..SMALL };
            let turn = frames(&mesh, &options, 8);
            for (number, frame) in (0..).zip(&turn) {
                let later = PreviewOptions { azimuth: 30.0 - 45.0 * f64::from(number), ..options };
                assert!(frames(&mesh, &later, 1)[0] == *frame, "{style:?} {camera:?} {number}");
                assert!(number == 0 || turn[0] != *frame, "frame {number} is the first");
            }
            let dimensions = PreviewOptions { dimensions: true, ..options };
            assert!(frames(&mesh, &dimensions, 2)[1] == turn[4], "dimensions");
        }
    }
}

/// Nothing of the model is at the rim of any picture, and it is large on some.
#[test]
fn the_model_stays_on_the_picture() {
    for (seed, mesh) in (1..5).map(|seed| (seed, meshes::random_boxes(5, seed))) {
        for camera in CAMERAS {
            for (elevation, [width, height]) in [(32.0, [160, 120]), (0.0, [120, 160]), (-70.0, [200, 100])] {
                let (style, background) = (PreviewStyle::Technical, Background::Transparent);
                let options = PreviewOptions { style, background, camera, elevation, width, height, ..SMALL };
                let mut largest = 0.0_f64;
                for (number, frame) in frames(&mesh, &options, 12).iter().enumerate() {
                    let shown: Vec<_> = places(width, height).filter(|&[x, y]| pixel(frame, x, y)[3] > 0).collect();
                    let [min, max] = around(&shown);
                    let margin = [width, height].map(|side| side * 4 / 100);
                    let is_within = min[0] >= margin[0] && min[1] >= margin[1];
                    let what = format!("seed {seed}, {camera:?}, {elevation}, frame {number}: {min:?} to {max:?}");
                    assert!(is_within && max[0] < width - margin[0] && max[1] < height - margin[1], "{what}");
                    let fill =
                        [(max[0] - min[0]) as f64 / f64::from(width), (max[1] - min[1]) as f64 / f64::from(height)];
                    largest = largest.max(fill[0]).max(fill[1]);
                }
                assert!(largest > 0.75, "seed {seed}, {camera:?}, {elevation}: the model fills {largest} at most");
            }
        }
    }
}

/// From the side an upright model is as high on all pictures: the camera keeps its distance, and does not nod.
#[test]
fn nothing_but_the_turning_moves() {
    let mesh = meshes::box_mesh(DVec3::ZERO, DVec3::new(3.0, 1.0, 2.0), "stone");
    let options = PreviewOptions {
        style: PreviewStyle::Technical,
        background: Background::Transparent,
        camera: CameraKind::Orthographic,
        elevation: 0.0,
        ..SMALL
    };
    let rows: Vec<[u32; 2]> = frames(&mesh, &options, 10)
        .iter()
        .map(|frame| {
            let shown: Vec<_> = places(320, 240).filter(|&[x, y]| pixel(frame, x, y)[3] > 127).collect();
            around(&shown).map(|end| end[1])
        })
        .collect();
    assert!(rows.iter().all(|ends| *ends == rows[0]), "{rows:?}");
}

/// A model that looks the same after a quarter of a turn has pictures that do.
#[test]
fn a_fourfold_model_repeats_itself() {
    let mut cross = meshes::cube_with_hole();
    for direction in [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y] {
        meshes::push_box(&mut cross, direction * 2.6, DVec3::splat(0.5), DMat3::IDENTITY, "arm");
    }
    // Not where dashes and diagonals, which have no such symmetry, are drawn.
    for style in [PreviewStyle::Shaded, PreviewStyle::XRay] {
        for camera in CAMERAS {
            for background in BACKGROUNDS {
                let options = PreviewOptions { style, camera, background, ..SMALL };
                let turn = frames(&cross, &options, 12);
                for (number, [early, late]) in (0..9).map(|number| (number, [&turn[number], &turn[number + 3]])) {
                    let changed = early.pixels.iter().zip(&late.pixels).filter(|(a, b)| a.abs_diff(**b) > 2).count();
                    let what = format!("{style:?} {camera:?} {background:?}, frame {number}: {changed} bytes");
                    assert!(changed < 4 * 320 * 240 / 500, "{what}");
                }
                assert!(largest_difference(&turn[0], &turn[1]) > 100);
            }
        }
    }
}

/// What is in front goes to the right: counter-clockwise as seen from above.
#[test]
fn the_model_turns_counter_clockwise() {
    let mut mesh = meshes::box_mesh(DVec3::new(-1.0, -1.0, 0.0), DVec3::new(1.0, 1.0, 1.0), "stone");
    meshes::push_box(&mut mesh, DVec3::new(0.0, -1.5, 0.5), DVec3::splat(0.4), DMat3::IDENTITY, "mark");
    mesh.materials[1].color = Some([1.0, 0.0, 0.0]);
    for camera in CAMERAS {
        let options = PreviewOptions { azimuth: -90.0, camera, ..SMALL };
        let middles: Vec<f64> = frames(&mesh, &options, 12)[..3]
            .iter()
            .map(|frame| {
                let is_red = |[red, green, _, _]: [u8; 4]| red > 90 && u32::from(green) * 2 < red.into();
                let red: Vec<_> = places(320, 240).filter(|&[x, y]| is_red(pixel(frame, x, y))).collect();
                assert!(red.len() > 50, "{} pixels", red.len());
                red.iter().map(|at| f64::from(at[0])).sum::<f64>() / red.len() as f64
            })
            .collect();
        assert!((middles[0] - 160.0).abs() < 2.0, "{middles:?}");
        assert!(middles[1] > middles[0] + 10.0 && middles[2] > middles[1] + 10.0, "{middles:?}");
    }
}

#[test]
fn a_turn_of_nothing_is_the_background() {
    for background in BACKGROUNDS {
        let options = PreviewOptions { background, scale_bar: true, ..SMALL };
        let empty = draw(&Mesh::default(), &options);
        assert!(frames(&Mesh::default(), &options, 3).iter().all(|frame| *frame == empty));
    }
    let mesh = meshes::cube_with_hole();
    assert!(frames(&mesh, &SMALL, 0).is_empty());
}
