//! Animations, read back by the decoders of another crate.

use std::io::{self, Cursor};

use image::codecs::gif::GifDecoder;
use image::codecs::png::PngDecoder;
use image::{AnimationDecoder, ImageDecoder};

use super::*;
use crate::MAX_IMAGE_SIDE;

const FORMATS: [AnimationFormat; 2] = AnimationFormat::ALL;

/// A shaded ball that moves sideways over a gradient; on nothing instead where `clear`.
fn ball(width: u32, height: u32, turn: f64, clear: bool) -> Picture {
    let center = [f64::from(width) * (0.5 + 0.2 * turn.cos()), f64::from(height) * 0.5];
    let radius = f64::from(height) * 0.3;
    let pixel = |i: u32| {
        let (x, y) = (f64::from(i % width) + 0.5, f64::from(i / width) + 0.5);
        let [dx, dy] = [(x - center[0]) / radius, (y - center[1]) / radius];
        let rest = 1.0 - dx * dx - dy * dy;
        let ground = 230.0 - 40.0 * y / f64::from(height);
        if rest > 0.0 {
            let light = (0.25 + 0.75 * (0.5 * dx.mul_add(-0.6, -dy * 0.5) + 0.6 * rest.sqrt())).clamp(0.0, 1.0);
            let tint = if (dx * 3.0 + turn).sin() > 0.0 { [230.0, 90.0, 60.0] } else { [220.0, 210.0, 200.0] };
            let [r, g, b] = tint.map(|value: f64| (value * light) as u8);
            [r, g, b, 255]
        } else if clear {
            [0; 4]
        } else {
            [ground as u8, (ground + 4.0) as u8, (ground + 9.0) as u8, 255]
        }
    };
    Picture { width, height, pixels: (0..width * height).flat_map(pixel).collect() }
}

fn turntable(width: u32, height: u32, clear: bool) -> Vec<Picture> {
    (0..8).map(|i| ball(width, height, f64::from(i) * std::f64::consts::TAU / 8.0, clear)).collect()
}

fn encoded(format: AnimationFormat, delay_ms: u16, frames: &[Picture]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let [width, height] = [frames[0].width, frames[0].height];
    let mut writer =
        AnimationWriter::new(format, width, height, frames.len() as u32, delay_ms, &mut bytes).expect("a size");
    for frame in frames {
        writer.frame(frame).expect("memory");
    }
    writer.finish().expect("memory");
    bytes
}

/// Delay in milliseconds and picture of each frame.
fn decoded(format: AnimationFormat, bytes: &[u8]) -> Vec<(f64, Picture)> {
    let frames = match format {
        AnimationFormat::Gif => GifDecoder::new(Cursor::new(bytes)).expect("a GIF").into_frames(),
        AnimationFormat::Apng => {
            let decoder = PngDecoder::new(Cursor::new(bytes)).expect("a PNG");
            assert!(decoder.is_apng().expect("a PNG"));
            decoder.apng().expect("an APNG").into_frames()
        }
    };
    let frames = frames.collect_frames().expect("frames");
    let picture = |frame: image::Frame| {
        let (numerator, denominator) = frame.delay().numer_denom_ms();
        let image = frame.into_buffer();
        let (width, height) = image.dimensions();
        (f64::from(numerator) / f64::from(denominator), Picture { width, height, pixels: image.into_raw() })
    };
    frames.into_iter().map(picture).collect()
}

/// Means of 4 × 4 pixels, which is about what an eye sees of a pattern.
fn blurred(picture: &Picture) -> Vec<f64> {
    let (width, height) = (picture.width as usize, picture.height as usize);
    let mut sums = vec![0.0; (width / 4) * (height / 4) * 3];
    for y in 0..height / 4 * 4 {
        for x in 0..width / 4 * 4 {
            for i in 0..3 {
                let value = f64::from(picture.pixels[4 * (y * width + x) + i]);
                sums[3 * ((y / 4) * (width / 4) + x / 4) + i] += value / 16.0;
            }
        }
    }
    sums
}

#[track_caller]
fn assert_similar(found: &Picture, expected: &Picture, mean_bound: f64, blurred_bound: f64) {
    let differences: Vec<f64> =
        found.pixels.iter().zip(&expected.pixels).map(|(a, b)| f64::from(a.abs_diff(*b))).collect();
    let mean = differences.iter().sum::<f64>() / differences.len() as f64;
    assert!(mean < mean_bound, "off by {mean} on average");
    let (a, b) = (blurred(found), blurred(expected));
    let mean = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).sum::<f64>() / a.len() as f64;
    assert!(mean < blurred_bound, "off by {mean} from a distance");
}

#[test]
fn apng_keeps_every_pixel() {
    for clear in [false, true] {
        let frames = turntable(64, 48, clear);
        let bytes = encoded(AnimationFormat::Apng, 33, &frames);
        let decoder = PngDecoder::new(Cursor::new(&bytes)).expect("a PNG");
        assert_eq!(decoder.color_type().has_alpha(), clear);
        let found = decoded(AnimationFormat::Apng, &bytes);
        assert_eq!(found.len(), frames.len());
        for ((delay, found), expected) in found.iter().zip(&frames) {
            assert_eq!((*delay, found), (33.0, expected));
        }
    }
}

/// 255 colours for some thousands: the nearest are a few steps away, and patterns make up for that from a distance.
#[test]
fn gif_looks_alike() {
    let frames = turntable(160, 120, false);
    let found = decoded(AnimationFormat::Gif, &encoded(AnimationFormat::Gif, 40, &frames));
    assert_eq!(found.len(), frames.len());
    for ((delay, found), expected) in found.iter().zip(&frames) {
        assert_eq!((*delay, found.width, found.height), (40.0, 160, 120));
        assert!(found.is_opaque());
        assert_similar(found, expected, 3.0, 1.0);
    }
}

/// What does not move stays the same to the last bit: nothing shimmers.
#[test]
fn gif_grounds_stand_still() {
    let frames = turntable(160, 120, false);
    let found = decoded(AnimationFormat::Gif, &encoded(AnimationFormat::Gif, 40, &frames));
    let rows = 4 * 160 * 20;
    for (_, picture) in &found {
        assert_eq!(picture.pixels[..rows], found[0].1.pixels[..rows]);
    }
}

#[test]
fn gif_wipes_transparent_frames_away() {
    let [solid, clear] = [false, true].map(|clear| turntable(64, 48, clear));
    // Both kinds in turn, and also two of each kind in a row.
    let mixed: Vec<Picture> =
        (0..8).map(|i| if [0, 3, 4, 6].contains(&i) { &clear } else { &solid }[i].clone()).collect();
    for frames in [clear, mixed] {
        let found = decoded(AnimationFormat::Gif, &encoded(AnimationFormat::Gif, 40, &frames));
        for (i, ((_, found), expected)) in found.iter().zip(&frames).enumerate() {
            let alpha = |picture: &Picture| picture.pixels.iter().skip(3).step_by(4).copied().collect::<Vec<_>>();
            assert_eq!(alpha(found), alpha(expected), "frame {i}");
            let mut visible = found.clone();
            for (pixel, expected) in visible.pixels.chunks_exact_mut(4).zip(expected.pixels.chunks_exact(4)) {
                if expected[3] == 0 {
                    pixel.fill(0);
                }
            }
            assert_similar(&visible, expected, 4.0, 2.0);
        }
    }
}

/// A frame with colours that were not seen before gets a palette of its own.
#[test]
fn gif_takes_new_colours_in() {
    let mut frames = turntable(64, 48, false);
    frames[3] = Picture::filled(64, 48, [20, 200, 30, 255]);
    let found = decoded(AnimationFormat::Gif, &encoded(AnimationFormat::Gif, 40, &frames));
    for ((_, found), expected) in found.iter().zip(&frames) {
        assert_similar(found, expected, 4.0, 2.0);
    }
}

/// No more than 255 colours in the whole, so none is changed.
#[test]
fn gif_keeps_few_colours_exactly() {
    let stripe = |shift: u32| {
        let pixel = |i: u32| [((i % 20 + shift) % 20 * 12) as u8, 40, 200, 255];
        Picture { width: 20, height: 9, pixels: (0..180).flat_map(pixel).collect() }
    };
    let frames = [stripe(0), stripe(3), stripe(3), stripe(1)];
    let found = decoded(AnimationFormat::Gif, &encoded(AnimationFormat::Gif, 100, &frames));
    let pictures: Vec<Picture> = found.into_iter().map(|(_, picture)| picture).collect();
    assert_eq!(pictures, frames);
    for color in [[0, 0, 0, 255], [255; 4], [7, 8, 9, 0]] {
        let found = decoded(AnimationFormat::Gif, &encoded(AnimationFormat::Gif, 100, &[Picture::filled(1, 1, color)]));
        assert_eq!((found.len(), found[0].1.pixels[3]), (1, color[3]));
        assert!(color[3] == 0 || found[0].1.pixels == color);
    }
}

#[test]
fn times_add_up() {
    let frames = vec![Picture::filled(2, 2, [9, 9, 9, 255]); 7];
    for (delay_ms, total) in [(33, 230.0), (100, 700.0), (25, 180.0), (0, 140.0), (60_000, 420_000.0)] {
        let found = decoded(AnimationFormat::Gif, &encoded(AnimationFormat::Gif, delay_ms, &frames));
        let sum: f64 = found.iter().map(|(delay, _)| delay).sum();
        assert_eq!(sum, total, "{delay_ms}");
    }
}

#[test]
fn animations_go_on_for_ever_and_do_not_depend_on_threads() {
    let frames = turntable(32, 24, false);
    for format in FORMATS {
        let bytes = encoded(format, 50, &frames);
        let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
        assert_eq!(bytes, alone.install(|| encoded(format, 50, &frames)));
        let has = |wanted: &[u8]| bytes.windows(wanted.len()).any(|window| window == wanted);
        match format {
            AnimationFormat::Gif => assert!(has(b"NETSCAPE2.0\x03\x01\x00\x00\x00")),
            AnimationFormat::Apng => assert!(has(b"acTL\x00\x00\x00\x08\x00\x00\x00\x00")),
        }
    }
}

#[test]
fn samples_prepare_for_what_comes() {
    let solid = ball(32, 24, 0.0, false);
    let clear = ball(32, 24, 1.0, true);
    let mut bytes = Vec::new();
    let mut writer = AnimationWriter::new(AnimationFormat::Apng, 32, 24, 2, 50, &mut bytes).expect("a size");
    writer.learn(&Picture::filled(5, 5, [0; 4]));
    for frame in [&solid, &clear] {
        writer.frame(frame).expect("memory");
    }
    writer.finish().expect("memory");
    let found = decoded(AnimationFormat::Apng, &bytes);
    assert_eq!([&found[0].1, &found[1].1], [&solid, &clear]);
    // Without, what is transparent turns black.
    let found = decoded(AnimationFormat::Apng, &encoded(AnimationFormat::Apng, 50, &[solid, clear.clone()]));
    assert!(found[1].1.is_opaque());
    for (found, expected) in found[1].1.pixels.chunks_exact(4).zip(clear.pixels.chunks_exact(4)) {
        assert_eq!(found[..3], if expected[3] == 0 { [0; 3] } else { [expected[0], expected[1], expected[2]] });
    }
}

#[test]
fn mistakes_are_told() {
    let frame = Picture::filled(4, 4, [1, 2, 3, 255]);
    for format in FORMATS {
        assert_eq!(AnimationFormat::from_extension(format.extension()).expect("a format"), format);
        for (width, height) in [(0, 4), (4, 0), (MAX_IMAGE_SIDE + 1, 4)] {
            let writer = AnimationWriter::new(format, width, height, 1, 50, io::sink());
            assert!(matches!(writer, Err(PictureError::ImageSize { .. })));
        }
        assert!(AnimationWriter::new(format, 4, 4, 0, 50, io::sink()).is_err());
        let new = || AnimationWriter::new(format, 4, 4, 1, 50, io::sink()).expect("a size");
        assert!(matches!(new().finish(), Err(PictureError::FrameCount { found: 0, expected: 1 })));
        let mut writer = new();
        let other = Picture::filled(4, 5, [0; 4]);
        assert!(matches!(writer.frame(&other), Err(PictureError::FrameSize { found: [4, 5], expected: [4, 4] })));
        let short = Picture { pixels: vec![0; 5], ..frame.clone() };
        assert!(matches!(writer.frame(&short), Err(PictureError::FrameSize { .. })));
        writer.frame(&frame).expect("a sink");
        assert!(matches!(writer.frame(&frame), Err(PictureError::FrameCount { found: 2, expected: 1 })));
        writer.finish().expect("a sink");
        // A disk that is full at some point.
        for room in [0, 5, 40, 60] {
            let mut room = vec![0; room];
            let mut writer = AnimationWriter::new(format, 4, 4, 3, 50, room.as_mut_slice()).expect("a size");
            let frames: Result<(), PictureError> = (0..3).try_for_each(|_| writer.frame(&frame));
            let result = frames.and_then(|()| writer.finish());
            assert!(matches!(result, Err(PictureError::Io(_))), "{result:?}");
        }
    }
    assert!(AnimationFormat::from_extension("mp4").is_err());
    assert_eq!(AnimationFormat::from_path(Path::new("turn.GIF")).expect("a format"), AnimationFormat::Gif);
}

#[test]
fn areas_of_change_are_tight() {
    let size = [10, 6];
    let old = vec![0; 4 * 60];
    let mut new = old.clone();
    assert_eq!(Area::of_change(&old, &new, size, 4), Area { left: 0, top: 0, width: 1, height: 1 });
    for (x, y) in [(7, 2), (3, 4)] {
        new[4 * (10 * y + x) + 2] = 1;
    }
    let area = Area::of_change(&old, &new, size, 4);
    assert_eq!(area, Area { left: 3, top: 2, width: 5, height: 3 });
    assert_eq!(area.rows(&new, 10, 4).flatten().filter(|value| **value == 1).count(), 2);
    assert_eq!(area.rows(&new, 10, 4).flatten().count(), 4 * 15);
}
