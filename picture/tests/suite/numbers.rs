//! Pictures of depth and of numbers of faces, decoded again.

use std::io::Cursor;

use glam::DVec3;
use image::DynamicImage;
use planecut_csg::Mesh;
use planecut_picture::{Buffers, PictureError, PreviewOptions, render_buffers};

use crate::support::{CAMERAS, SMALL, painted};
use planecut_testkit::meshes;

fn buffers(mesh: &Mesh, options: &PreviewOptions) -> Buffers {
    render_buffers(&painted(mesh), options).expect("drawn")
}

/// The texts `near` and `far` of a picture of depth, and its greys.
fn decoded(png: &[u8]) -> ([f64; 2], Vec<u16>) {
    let reader = png::Decoder::new(Cursor::new(png)).read_info().expect("a PNG");
    let info = reader.info();
    assert_eq!((info.color_type, info.bit_depth), (png::ColorType::Grayscale, png::BitDepth::Sixteen));
    let text = |key: &str| {
        let chunk = info.uncompressed_latin1_text.iter().find(|chunk| chunk.keyword == key).expect("a text");
        chunk.text.parse::<f64>().expect("a number")
    };
    let range = [text("near"), text("far")];
    let DynamicImage::ImageLuma16(greys) = image::load_from_memory(png).expect("a PNG") else {
        panic!("not 16-bit greys")
    };
    (range, greys.into_raw())
}

#[test]
fn pictures_of_depth_hold_the_depths() {
    for camera in CAMERAS {
        for (seed, scale) in [(1, 1.0), (2, 1e-3), (3, 1e6)] {
            let mut mesh = meshes::random_boxes(20, seed);
            mesh.positions.iter_mut().for_each(|point| *point *= scale);
            let found = buffers(&mesh, &PreviewOptions { camera, ..SMALL });
            let ([near, far], greys) = decoded(&found.depth_png().expect("encoded"));
            assert_eq!(found.depth_range(), Some([near, far]), "seed {seed}");
            let range = far - near;
            assert!(range > 0.0 && greys.contains(&0) && greys.contains(&65_534) && greys.contains(&65_535));
            for (&depth, &grey) in found.depth.iter().zip(&greys) {
                if depth == f64::INFINITY {
                    assert_eq!(grey, 65_535);
                } else {
                    let told = near + range * f64::from(grey) / 65_534.0;
                    let off = (told - depth).abs() / range * 65_534.0;
                    assert!(grey < 65_535 && off < 0.51, "seed {seed}: {depth} is told as {told}");
                }
            }
        }
    }
}

#[test]
fn depths_without_range_are_the_nearest_grey() {
    let options = PreviewOptions { azimuth: 0.0, elevation: 0.0, ..SMALL };
    for camera in CAMERAS {
        let mesh = meshes::box_mesh(DVec3::splat(-1.0), DVec3::splat(1.0), "stone");
        let found = buffers(&mesh, &PreviewOptions { camera, ..options });
        let ([near, far], greys) = decoded(&found.depth_png().expect("encoded"));
        assert!(far - near < 1e-5 * far, "{near} to {far}");
        assert!(near != far || greys.iter().all(|&grey| grey == 0 || grey == 65_535));
        let empty = buffers(&Mesh::default(), &PreviewOptions { camera, ..options });
        assert_eq!(empty.depth_range(), None);
        let (_, greys) = decoded(&empty.depth_png().expect("encoded"));
        assert_eq!(greys, vec![65_535; 320 * 240]);
    }
}

#[test]
fn pictures_of_numbers_hold_the_numbers() {
    let mesh = meshes::random_boxes(60, 4);
    for camera in CAMERAS {
        let found = buffers(&mesh, &PreviewOptions { camera, ..SMALL });
        let numbers: [fn(u32) -> u32; 3] = [|face| face, |face| face * 40_007 + 5, |_| (1 << 24) - 2];
        for number in numbers {
            let png = found.id_png(number).expect("encoded");
            let DynamicImage::ImageRgb8(colors) = image::load_from_memory(&png).expect("a PNG") else {
                panic!("not colours")
            };
            assert_eq!((colors.width(), colors.height()), (found.width, found.height));
            let mut shown = 0;
            for (color, face) in colors.pixels().zip(&found.faces) {
                let value = color.0.iter().fold(0, |value, &byte| value << 8 | u32::from(byte));
                assert_eq!(value, face.map_or(0, |face| number(face) + 1));
                shown += u32::from(face.is_some());
            }
            assert!(shown > 320 * 240 / 10 && shown < 320 * 240);
        }
        for number in [(1 << 24) - 1, 1 << 24, u32::MAX] {
            let error = found.id_png(|_| number).expect_err("refused");
            assert!(matches!(error, PictureError::TooLarge { .. }), "{number}: {error}");
        }
    }
    // What is not seen is not asked for.
    let empty = buffers(&Mesh::default(), &SMALL);
    let black = image::load_from_memory(&empty.id_png(|_| u32::MAX).expect("encoded")).expect("a PNG").to_rgb8();
    assert!(black.into_raw().iter().all(|&byte| byte == 0));
}
