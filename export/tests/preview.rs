//! Facts about preview pictures: what is where, what is hidden, and that the same input gives the same bytes.

mod common;

use std::time::Instant;

use glam::{DMat3, DVec3};
use planecut_csg::Mesh;
use planecut_export::{ExportError, PreviewOptions, PreviewStyle, RgbImage, render_preview, render_rgb};

const SMALL: PreviewOptions =
    PreviewOptions { width: 320, height: 240, style: PreviewStyle::Shaded, azimuth: -62.0, elevation: 32.0 };

fn draw(mesh: &Mesh, options: &PreviewOptions) -> RgbImage {
    render_rgb(mesh, options).expect("drawn")
}

fn pixel(image: &RgbImage, x: u32, y: u32) -> [u8; 3] {
    let start = 3 * (y * image.width + x) as usize;
    image.pixels[start..start + 3].try_into().expect("three bytes")
}

fn brightness(pixel: [u8; 3]) -> u32 {
    pixel.iter().map(|&channel| u32::from(channel)).sum()
}

fn unit_box() -> Mesh {
    common::box_mesh(DVec3::splat(-1.0), DVec3::splat(1.0), "stone")
}

#[test]
fn the_model_is_in_the_middle_and_the_background_in_the_corners() {
    let empty = draw(&Mesh::default(), &SMALL);
    for style in [PreviewStyle::Shaded, PreviewStyle::Technical] {
        let options = PreviewOptions { style, ..SMALL };
        let (empty, image) = (draw(&Mesh::default(), &options), draw(&unit_box(), &options));
        for (x, y) in [(0, 0), (319, 0), (0, 239)] {
            assert_eq!(pixel(&image, x, y), pixel(&empty, x, y), "corner {x}, {y}");
        }
        assert_ne!(pixel(&image, 160, 120), pixel(&empty, 160, 120));
    }
    assert_eq!(empty.pixels.len(), 3 * 320 * 240);
}

/// The PNG holds exactly the pixels, as an independent decoder sees them.
#[test]
fn the_png_decodes_to_the_same_pixels() {
    let png = render_preview(&common::cube_with_hole(), &SMALL).expect("drawn");
    let decoded = image::load_from_memory(&png).expect("a PNG").to_rgb8();
    let image = draw(&common::cube_with_hole(), &SMALL);
    assert_eq!((decoded.width(), decoded.height()), (image.width, image.height));
    assert!(decoded.into_raw() == image.pixels);
}

/// Light comes from above and from the left: the three visible sides of a box differ in that order.
#[test]
fn the_top_is_brightest_and_the_right_side_darkest() {
    let image = draw(&unit_box(), &SMALL);
    let [top, left, right] = [(160, 60), (120, 150), (215, 140)].map(|(x, y)| brightness(pixel(&image, x, y)));
    assert!(top > left + 20 && left > right + 20, "{top}, {left}, {right}");
}

/// Whatever is inside a closed box leaves no trace, neither its faces nor its edges.
#[test]
fn what_is_inside_is_hidden() {
    let outside = common::random_boxes(1, 4);
    let mut with_inside = unit_box();
    for i in 0..40 {
        let mut random = common::Random(i);
        let center = DVec3::from([0; 3].map(|_: i32| random.between(-0.6, 0.6)));
        let rotation = DMat3::from_euler(glam::EulerRot::XYZ, random.between(0.0, 3.0), random.between(0.0, 3.0), 0.0);
        common::push_box(&mut with_inside, center, DVec3::splat(random.between(0.05, 0.2)), rotation, "stone");
    }
    for style in [PreviewStyle::Shaded, PreviewStyle::Technical] {
        for azimuth in [-62.0, 0.0, 17.0, 135.0] {
            for elevation in [-30.0, 0.0, 32.0, 90.0] {
                let options = PreviewOptions { style, azimuth, elevation, ..SMALL };
                let same = draw(&with_inside, &options) == draw(&unit_box(), &options);
                assert!(same, "seen from {azimuth}, {elevation}");
                assert!(draw(&outside, &options) != draw(&unit_box(), &options));
            }
        }
    }
}

/// A wall in front of a box hides it, and the box behind a wall shows from the other side.
#[test]
fn what_is_behind_is_hidden() {
    let options = PreviewOptions { azimuth: 0.0, elevation: 0.0, style: PreviewStyle::Technical, ..SMALL };
    let wall = || common::box_mesh(DVec3::new(4.0, -3.0, -3.0), DVec3::new(4.5, 3.0, 3.0), "stone");
    let mut both = wall();
    common::push_box(&mut both, DVec3::X * 3.0, DVec3::splat(0.5), DMat3::IDENTITY, "stone");
    assert!(draw(&wall(), &options) == draw(&both, &options), "the box shows");
    let from_behind = PreviewOptions { azimuth: 180.0, ..options };
    assert!(draw(&wall(), &from_behind) != draw(&both, &from_behind), "the box is missing");
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
fn bytes_do_not_depend_on_the_number_of_threads() {
    let mesh = common::random_boxes(150, 17);
    for options in [SMALL, PreviewOptions { width: 1001, height: 777, ..SMALL }] {
        let pictures = [1, 2, 5].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            pool.install(|| render_preview(&mesh, &options).expect("drawn"))
        });
        assert!(pictures[0] == pictures[1] && pictures[1] == pictures[2]);
    }
}

#[test]
fn every_size_within_bounds_works_and_others_are_errors() {
    let mesh = common::cube_with_hole();
    for (width, height) in [(1, 1), (1, 300), (300, 1), (2, 3), (16_384, 2), (3, 16_384)] {
        let image = draw(&mesh, &PreviewOptions { width, height, ..SMALL });
        assert_eq!(image.pixels.len() as u32, 3 * width * height);
    }
    for (width, height) in [(0, 10), (10, 0), (16_385, 10), (10, u32::MAX)] {
        let error = render_rgb(&mesh, &PreviewOptions { width, height, ..SMALL }).expect_err("refused");
        assert!(matches!(error, ExportError::ImageSize { .. }));
    }
    for azimuth in [f64::NAN, f64::INFINITY] {
        let error = render_rgb(&mesh, &PreviewOptions { azimuth, ..SMALL }).expect_err("refused");
        assert!(matches!(error, ExportError::CameraAngle(_)));
    }
}

/// Meshes without volume, of extreme size or with slivers are drawn without complaint.
#[test]
fn extreme_meshes_are_drawn() {
    let scaled = |factor: DVec3, shift: f64| {
        let mut mesh = common::random_boxes(30, 6);
        mesh.positions.iter_mut().for_each(|p| *p = *p * factor + shift);
        mesh
    };
    let factors =
        [DVec3::splat(1e-200), DVec3::splat(1e150), DVec3::new(1.0, 1.0, 0.0), DVec3::new(1e9, 1.0, 1e-9), DVec3::ZERO];
    for factor in factors {
        for shift in [0.0, 1e6] {
            for elevation in [32.0, 0.0, -90.0, 1e9] {
                draw(&scaled(factor, shift), &PreviewOptions { elevation, ..SMALL });
            }
        }
    }
    let mut broken = common::cube_with_hole();
    broken.triangles[0][0] = 1_000;
    assert!(matches!(render_rgb(&broken, &SMALL), Err(ExportError::InvalidMesh(_))));
}

/// Not a check: prints how long a picture of 30,000 triangles takes.
#[test]
fn report_the_time_of_a_large_picture() {
    let mesh = common::random_boxes(2_500, 1);
    let start = Instant::now();
    let png = render_preview(&mesh, &PreviewOptions::default()).expect("drawn");
    println!("{} triangles: {:?}, {} bytes", mesh.triangles.len(), start.elapsed(), png.len());
}
