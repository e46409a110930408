//! `render`: pictures of every style, turntables, contact sheets and buffers, read back by the `image` crate.

use std::fs;
use std::io::Cursor;
use std::path::Path;

use image::codecs::gif::GifDecoder;
use image::codecs::png::PngDecoder;
use image::{AnimationDecoder, DynamicImage, GenericImageView, Rgba};

use tempfile::TempDir;

use crate::support::{ROOT, Run, block, folder, run_with, write_map};

/// How many brushes the map of [`sample`] has.
const BRUSHES: usize = 3;

/// A folder with the map `m.map`: a slab, a pillar on it and a beam through the pillar.
fn sample() -> TempDir {
    let folder = folder();
    let blocks = [
        block([0, 0, 0], [64, 64, 8], "floor"),
        block([24, 24, 8], [40, 40, 56], "pillar"),
        block([8, 28, 32], [60, 36, 40], "beam"),
    ];
    assert_eq!(blocks.len(), BRUSHES);
    write_map(folder.path(), "m.map", &blocks);
    folder
}

fn run_in(folder: &Path, args: &str) -> Run {
    run_with(folder, args, &[])
}

const STYLES: [&str; 6] = ["shaded", "technical", "xray", "exploded", "section", "wireframe"];

fn picture(path: &Path) -> DynamicImage {
    image::load_from_memory(&fs::read(path).expect("written")).expect("a picture")
}

/// How many colours there are: an empty picture has the few of its background.
fn colors(picture: &DynamicImage) -> usize {
    let mut all: Vec<[u8; 4]> = picture.pixels().map(|(_, _, Rgba(pixel))| pixel).collect();
    all.sort_unstable();
    all.dedup();
    all.len()
}

#[test]
fn every_style_draws_every_kind_of_input() {
    let folder = sample();
    run_in(folder.path(), "build m.map -o m.glb -o m.stl").expect_quiet_success();
    let mut seen = Vec::new();
    for style in STYLES {
        for input in ["m.map", "m.glb", "m.stl"] {
            run_in(folder.path(), &format!("render {input} -o a.png --style {style} --size 120x90"))
                .expect_quiet_success();
            let drawn = picture(&folder.path().join("a.png"));
            assert_eq!((drawn.width(), drawn.height()), (120, 90));
            assert!(colors(&drawn) > 30, "{style} of {input}: {} colours", colors(&drawn));
            if input == "m.map" {
                seen.push(drawn.to_rgba8().into_raw());
            }
        }
    }
    for (first, second) in [(0, 1), (0, 2), (0, 3), (0, 4), (0, 5), (1, 5), (2, 5), (2, 3)] {
        assert!(seen[first] != seen[second], "{} looks like {}", STYLES[first], STYLES[second]);
    }
}

#[test]
fn pictures_do_not_depend_on_threads() {
    let folder = sample();
    let options =
        ["--style xray", "--style technical --section z --dimensions --unit mm", "--spread 1 --background dark"];
    for options in options {
        for threads in [1, 3] {
            let command = format!("render m.map -o {threads}.png --size 200x150 --threads {threads} {options}");
            run_in(folder.path(), &command).expect_quiet_success();
        }
        let read = |threads: u32| fs::read(folder.path().join(format!("{threads}.png"))).expect("written");
        assert!(read(1) == read(3), "{options}");
    }
}

#[test]
fn turntables_have_their_frames() {
    let folder = sample();
    let command = "--size 80x60 --frames 6 --frame-time 90";
    run_in(folder.path(), &format!("render m.map -o t.gif {command}")).expect_quiet_success();
    run_in(folder.path(), &format!("render m.map -o t.apng {command} --background transparent")).expect_quiet_success();
    let read = |name: &str| Cursor::new(fs::read(folder.path().join(name)).expect("written"));
    let gif = GifDecoder::new(read("t.gif")).expect("a GIF").into_frames().collect_frames().expect("frames");
    let apng = PngDecoder::new(read("t.apng")).expect("a PNG").apng().expect("animated").into_frames();
    let apng = apng.collect_frames().expect("frames");
    for frames in [&gif, &apng] {
        assert_eq!(frames.len(), 6);
        assert!(frames.iter().all(|frame| frame.delay().numer_denom_ms() == (90, 1)));
        assert!(frames.iter().all(|frame| frame.buffer().dimensions() == (80, 60)));
        assert!(frames[0].buffer() != frames[1].buffer());
    }
    assert_eq!(apng[0].buffer().get_pixel(0, 0).0[3], 0);
    assert_eq!(gif[0].buffer().get_pixel(0, 0).0[3], 255);
}

#[test]
fn several_inputs_make_a_sheet() {
    let folder = sample();
    run_in(folder.path(), "build m.map -o n.glb").expect_quiet_success();
    run_in(folder.path(), "render m.map n.glb m.map -o s.png --size 300x200 --columns 3").expect_quiet_success();
    let sheet = picture(&folder.path().join("s.png"));
    assert_eq!((sheet.width(), sheet.height()), (300, 200));
    // The ground between tiles is plain.
    assert_eq!(sheet.get_pixel(0, 0), sheet.get_pixel(299, 199));
    run_in(folder.path(), "render m.map n.glb -o s.png --size 20x20").expect_error(1, "2 pictures on a sheet of 20x20");
}

#[test]
fn buffers_tell_depth_and_brush_of_each_pixel() {
    let folder = sample();
    let command =
        "render m.map -o a.png --size 100x80 --view top --camera orthographic --depth d.png --ids i.png --id-of brush";
    run_in(folder.path(), command).expect_quiet_success();
    let depth = picture(&folder.path().join("d.png")).into_luma16();
    let ids = picture(&folder.path().join("i.png")).into_rgb8();
    assert_eq!((depth.dimensions(), ids.dimensions()), ((100, 80), (100, 80)));
    let values: Vec<u16> = depth.pixels().map(|pixel| pixel.0[0]).collect();
    assert!(values.contains(&0) && values.contains(&u16::MAX));
    for (depth, id) in depth.pixels().zip(ids.pixels()) {
        let number = id.0.iter().fold(0, |number, &byte| number << 8 | usize::from(byte));
        assert_eq!(depth.0[0] == u16::MAX, number == 0, "nothing is nothing in both");
        assert!(number <= BRUSHES, "{number} of {BRUSHES}");
    }
    for options in ["--section x", "--style xray"] {
        let command = format!("render m.map -o a.png --ids i.png --id-of brush {options}");
        run_in(folder.path(), &command).expect_error(2, "--id-of brush");
    }
}

#[test]
fn what_does_not_fit_together_is_refused() {
    let folder = sample();
    let refused = |options: &str, words: &str| {
        run_in(folder.path(), &format!("render m.map {options}")).expect_error(2, words);
    };
    refused("m.map -o a.gif", "turntable of several inputs");
    refused("m.map -o a.png --depth d.png", "--depth or --ids");
    refused("-o a.gif --ids i.png", "--depth or --ids");
    refused("-o a.png --columns 2", "--columns with one input");
    refused("-o a.png --depth a.png", "two outputs of this name");
    refused("-o a.jpg", "`.png`, `.gif` or `.apng`");
    refused("-o a.png --section 0,0,0,1", "expected x, y or z");
    refused("-o a.png --view up", "expected front");
    refused("-o a.png --id-of face", "--ids");
    assert!(fs::read_dir(folder.path()).expect("a folder").count() == 1, "something was left");
}

/// Open meshes are drawn, too: a picture is no statement about what is inside.
#[test]
fn a_mesh_need_not_be_closed_to_be_drawn() {
    let folder = folder();
    let mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 2 2\nf 1 2 3\nf 1 1 2\n";
    fs::write(folder.path().join("open.obj"), mesh).expect("written");
    run_in(folder.path(), "render open.obj -o a.png --size 60x40").expect_quiet_success();
    assert!(colors(&picture(&folder.path().join("a.png"))) > 10);
    run_in(folder.path(), "render open.obj -o a.png --size 60x40 --style section").expect_error(2, "open.obj");
}

/// The gallery has a picture of every style, and no picture that is not there or that no command draws.
#[test]
fn the_gallery_is_complete() {
    let page = fs::read_to_string(Path::new(ROOT).join("docs/gallery.md")).expect("the page");
    for style in STYLES {
        let is_shown = style == "shaded" || page.contains(&format!("--style {style}"));
        assert!(is_shown, "no picture of {style}");
    }
    for line in page.lines().filter(|line| line.starts_with("![")) {
        let name = line.split_once("](").and_then(|(_, rest)| rest.strip_suffix(')')).expect("a picture");
        assert!(Path::new(ROOT).join("docs").join(name).is_file(), "{name} is missing: docs/draw-gallery makes it");
        let file = name.strip_prefix("gallery/").expect("a picture of the gallery");
        assert!(page.contains(&format!("-o {file}")), "no command draws {name}");
    }
}
