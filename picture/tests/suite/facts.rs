//! Facts that need no second opinion: corners are empty, what is behind is hidden, wrong options are refused.

use std::time::Instant;

use glam::{DMat3, DVec3};
use planecut_csg::Mesh;
use planecut_picture::{CameraKind, PictureError, PreviewOptions, PreviewStyle, Turntable, render, render_buffers};

use planecut_testkit::random::Rng;

use crate::support::{BACKGROUNDS, CAMERAS, SMALL, STYLES, brightness, draw, painted, pixel, unit_box};
use planecut_testkit::meshes;

#[test]
fn the_model_is_in_the_middle_and_the_background_in_the_corners() {
    for style in STYLES {
        for camera in CAMERAS {
            for background in BACKGROUNDS {
                let options = PreviewOptions { style, camera, background, ..SMALL };
                let (empty, image) = (draw(&Mesh::default(), &options), draw(&unit_box(), &options));
                for (x, y) in [(0, 0), (319, 0), (0, 239)] {
                    assert_eq!(pixel(&image, x, y), pixel(&empty, x, y), "{style:?}, corner {x}, {y}");
                }
                let middle: Vec<_> = (120..200).map(|x| (pixel(&image, x, 120), pixel(&empty, x, 120))).collect();
                assert!(middle.iter().any(|(image, empty)| image != empty), "{style:?} {camera:?} {background:?}");
                assert_eq!(empty.pixels.len(), 4 * 320 * 240);
            }
        }
    }
}

/// The PNG holds exactly the pixels, as a decoder sees them.
#[test]
fn the_png_decodes_to_the_same_pixels() {
    for style in STYLES {
        for background in BACKGROUNDS {
            let picture = draw(&meshes::cube_with_hole(), &PreviewOptions { style, background, ..SMALL });
            let decoded = image::load_from_memory(&picture.to_png().expect("encoded")).expect("a PNG").to_rgba8();
            assert_eq!((decoded.width(), decoded.height()), (picture.width, picture.height));
            assert!(decoded.into_raw() == picture.pixels, "{style:?} {background:?}");
        }
    }
}

/// Light comes from above and from the left: the three visible sides of a box differ in that order.
#[test]
fn the_top_is_brightest_and_the_right_side_darkest() {
    for background in BACKGROUNDS {
        let image = draw(&unit_box(), &PreviewOptions { background, ..SMALL });
        let [top, left, right] = [(160, 60), (120, 150), (215, 140)].map(|(x, y)| brightness(pixel(&image, x, y)));
        assert!(top > left + 20 && left > right + 20, "{background:?}: {top}, {left}, {right}");
    }
}

/// A wall in front of a box hides it, and the box behind a wall shows from the other side.
#[test]
fn what_is_behind_is_hidden() {
    let wall = || meshes::box_mesh(DVec3::new(4.0, -3.0, -3.0), DVec3::new(4.5, 3.0, 3.0), "stone");
    let mut both = wall();
    meshes::push_box(&mut both, DVec3::X * 3.0, DVec3::splat(0.5), DMat3::IDENTITY, "stone");
    for camera in CAMERAS {
        let options = PreviewOptions { azimuth: 0.0, elevation: 0.0, camera, ..SMALL };
        let faces =
            |mesh: &Mesh, options: &PreviewOptions| render_buffers(&painted(mesh), options).expect("drawn").faces;
        let walled = faces(&wall(), &options);
        assert!(walled == faces(&both, &options) && walled.contains(&Some(1)), "the box shows");
        let from_behind = faces(&both, &PreviewOptions { azimuth: 180.0, ..options });
        assert!(from_behind.contains(&Some(6)), "the box is missing");
        let drawing = PreviewOptions { style: PreviewStyle::Technical, ..options };
        assert!(draw(&wall(), &drawing) != draw(&both, &drawing), "its hidden edges are missing");
    }
}

/// A dark line runs where two visible faces meet, and none where the triangles of one face do.
#[test]
fn edges_are_drawn_between_faces_but_not_within() {
    let options = PreviewOptions { azimuth: 0.0, elevation: 0.0, ..SMALL };
    let mut slab = unit_box();
    let outline = draw(&slab, &options);
    let row: Vec<u32> = (0..320).map(|x| brightness(pixel(&outline, x, 110))).collect();
    let dark = |row: &[u32]| row.windows(3).filter(|w| w[1] + 60 < w[0].min(w[2]) || w[1] + 60 < w[0]).count();
    assert!(dark(&row[..120]) >= 1, "no outline on the left");
    assert_eq!(dark(&row[120..200]), 0, "a line within the face, along its diagonal");

    // The same box from a corner: now an edge runs down the middle.
    let corner = PreviewOptions { azimuth: 45.0, ..options };
    slab.materials[0].color = Some([0.5; 3]);
    let image = draw(&slab, &PreviewOptions { style: PreviewStyle::Technical, ..corner });
    let middle = (158..162).map(|x| brightness(pixel(&image, x, 120))).min().expect("pixels");
    let beside = brightness(pixel(&image, 140, 120));
    assert!(middle + 100 < beside, "{middle} against {beside}");
}

#[test]
fn every_size_within_bounds_works_and_others_are_errors() {
    let mesh = meshes::cube_with_hole();
    let subject = painted(&mesh);
    for (width, height) in [(1, 1), (1, 300), (300, 1), (2, 3), (16_384, 2), (3, 16_384)] {
        for (style, camera) in STYLES.into_iter().zip(CAMERAS.into_iter().cycle()) {
            let labels = PreviewOptions { dimensions: true, scale_bar: true, ..SMALL };
            for options in [SMALL, labels] {
                let options = PreviewOptions { width, height, style, camera, ..options };
                assert_eq!(draw(&mesh, &options).pixels.len() as u32, 4 * width * height);
            }
        }
    }
    let refused = |options: PreviewOptions| {
        let errors = [
            render(&subject, &options).expect_err("refused"),
            render_buffers(&subject, &options).expect_err("refused"),
            Turntable::new(&subject, &options, 3).expect_err("refused"),
        ];
        move |is_right: fn(&PictureError) -> bool| assert!(errors.iter().all(is_right), "{errors:?}")
    };
    for (width, height) in [(0, 10), (10, 0), (16_385, 10), (10, u32::MAX)] {
        let is_size = |error: &PictureError| matches!(error, PictureError::ImageSize { .. });
        refused(PreviewOptions { width, height, ..SMALL })(is_size);
    }
    for angle in [f64::NAN, f64::INFINITY] {
        let is_angle = |error: &PictureError| matches!(error, PictureError::CameraAngle(_));
        refused(PreviewOptions { azimuth: angle, ..SMALL })(is_angle);
        refused(PreviewOptions { elevation: angle, ..SMALL })(is_angle);
    }
}

/// Meshes without volume, of extreme size or with slivers are drawn without complaint.
#[test]
fn extreme_meshes_are_drawn() {
    let scaled = |factor: DVec3, shift: f64| {
        let mut mesh = meshes::random_boxes(30, 6);
        mesh.positions.iter_mut().for_each(|p| *p = *p * factor + shift);
        mesh
    };
    let factors =
        [DVec3::splat(1e-200), DVec3::splat(1e150), DVec3::new(1.0, 1.0, 0.0), DVec3::new(1e9, 1.0, 1e-9), DVec3::ZERO];
    let options = PreviewOptions { width: 120, height: 90, dimensions: true, scale_bar: true, ..SMALL };
    for factor in factors {
        for shift in [0.0, 1e6] {
            let mesh = scaled(factor, shift);
            for elevation in [32.0, 0.0, -90.0, 1e9] {
                for style in STYLES {
                    for camera in CAMERAS {
                        let options = PreviewOptions { elevation, style, camera, ..options };
                        assert_eq!(draw(&mesh, &options).pixels.len(), 4 * 120 * 90);
                        let buffers = render_buffers(&painted(&mesh), &options).expect("drawn");
                        buffers.depth_png().expect("a picture of depth");
                        buffers.id_png(|face| face).expect("a picture of numbers");
                        let subject = painted(&mesh);
                        let turn = Turntable::new(&subject, &options, 5).expect("a turn");
                        assert_eq!(turn.frame(1).expect("drawn").pixels.len(), 4 * 120 * 90);
                    }
                }
            }
        }
    }
    let mut broken = meshes::cube_with_hole();
    broken.triangles[0][0] = 1_000;
    assert!(matches!(render(&painted(&broken), &SMALL), Err(PictureError::InvalidMesh(_))));
}

/// Beyond the poles there is nothing new to see, and whole turns change next to nothing.
#[test]
fn angles_wrap_and_end() {
    let mesh = meshes::random_boxes(10, 3);
    for (a, b) in [(90.0, 1e9), (-90.0, -300.0)] {
        let [a, b] = [a, b].map(|elevation| draw(&mesh, &PreviewOptions { elevation, ..SMALL }));
        assert!(a == b);
    }
    let mut random = Rng::new(11);
    for _ in 0..4 {
        let azimuth = random.float(-180.0, 180.0);
        let [a, b] = [azimuth, azimuth + 720.0].map(|azimuth| {
            let options = PreviewOptions { azimuth, camera: CameraKind::Orthographic, ..SMALL };
            render_buffers(&painted(&mesh), &options).expect("drawn")
        });
        let changed = a.faces.iter().zip(&b.faces).filter(|(a, b)| a != b).count();
        assert!(changed < 20, "{changed} pixels differ after two turns from {azimuth}, of seed 11");
    }
}

/// Not a check: prints how long a picture of 30,000 triangles takes.
#[test]
fn report_the_time_of_a_large_picture() {
    let mesh = meshes::random_boxes(2_500, 1);
    for style in STYLES {
        let start = Instant::now();
        let picture = draw(&mesh, &PreviewOptions { style, ..PreviewOptions::default() });
        println!(
            "{style:?}, {} triangles, {} bytes: {:?}",
            mesh.triangles.len(),
            picture.pixels.len(),
            start.elapsed()
        );
    }
}

/// A model in other units has the same pictures, and depths in those units: powers of two change no digit of any number.
#[test]
fn units_do_not_matter() {
    let mesh = meshes::random_boxes(10, 3);
    // Beyond these, squares of lengths leave the range of numbers.
    for exponent in [-500, -40, 40, 500] {
        let factor = 2.0_f64.powi(exponent);
        let mut scaled = mesh.clone();
        scaled.positions.iter_mut().for_each(|point| *point *= factor);
        for (style, camera) in STYLES.into_iter().zip(CAMERAS.into_iter().cycle()) {
            let options = PreviewOptions { style, camera, ..SMALL };
            let [plain, same] = [&mesh, &scaled].map(|mesh| {
                let subject = painted(mesh);
                let turn = Turntable::new(&subject, &options, 3).expect("a turn").frame(1).expect("drawn");
                (draw(mesh, &options), turn, render_buffers(&subject, &options).expect("drawn"))
            });
            assert!(plain.0 == same.0 && plain.1 == same.1, "{style:?} {camera:?}: 2^{exponent}");
            assert_eq!(plain.2.faces, same.2.faces, "{camera:?}: 2^{exponent}");
            // Single precision does not hold the others.
            if exponent < 100 && exponent > -100 {
                let depths = plain.2.depth.iter().map(|&depth| depth * factor);
                assert!(depths.eq(same.2.depth.iter().copied()), "{camera:?}: 2^{exponent}");
            }
        }
    }
}
