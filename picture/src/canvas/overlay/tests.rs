//! Shapes against areas and places computed by hand.

use super::super::text::{shortened, text_width};
use super::*;

const WHITE: Color = [255; 4];
const BLACK: Color = [0, 0, 0, 255];

fn style(size: f32) -> TextStyle {
    TextStyle { size, color: BLACK, halo: None }
}

/// How much of each pixel of a white picture is black after drawing, 0 to 1, row by row.
fn drawn(width: u32, height: u32, draw: impl Fn(&mut Overlay)) -> Vec<f64> {
    let mut overlay = Overlay::new(width, height).expect("a size");
    draw(&mut overlay);
    let mut picture = Picture::filled(width, height, WHITE);
    overlay.draw_onto(&mut picture);
    assert!(picture.is_opaque());
    picture.pixels.chunks_exact(4).map(|pixel| 1.0 - f64::from(pixel[0]) / 255.0).collect()
}

/// First and end of the columns and of the rows in which at least `least` of a pixel is drawn.
fn bounds(drawn: &[f64], width: usize, least: f64) -> [usize; 4] {
    let mut bounds = [usize::MAX, 0, usize::MAX, 0];
    for (i, _) in drawn.iter().enumerate().filter(|(_, part)| **part >= least) {
        let (x, y) = (i % width, i / width);
        bounds = [bounds[0].min(x), bounds[1].max(x + 1), bounds[2].min(y), bounds[3].max(y + 1)];
    }
    bounds
}

/// Draws something.
type Draw<'a> = &'a dyn Fn(&mut Overlay);

#[test]
fn shapes_cover_their_area() {
    let sum = |draw: Draw<'_>| drawn(60, 50, draw).iter().sum::<f64>();
    let cases: [(f64, Draw<'_>); 7] = [
        (20.0 * 10.0, &|o| o.rectangle([5.0, 6.0], [25.0, 16.0], 0.0, BLACK)),
        (20.0 * 10.0 - (4.0 - std::f64::consts::PI) * 9.0, &|o| o.rectangle([5.0, 6.0], [25.0, 16.0], 3.0, BLACK)),
        // a radius too large makes a disc
        (std::f64::consts::PI * 100.0, &|o| o.rectangle([5.0, 6.0], [25.0, 26.0], 99.0, BLACK)),
        (0.5 * 30.0 * 20.0, &|o| o.polygon(&[[10.0, 10.0], [40.0, 10.0], [10.0, 30.0]], BLACK)),
        // 3, 4, 5
        (50.0 * 2.5, &|o| o.line([10.0, 5.0], [40.0, 45.0], 2.5, BLACK)),
        // thinner than a pixel
        (40.0 * 0.5, &|o| o.line([10.0, 20.0], [50.0, 20.0], 0.5, BLACK)),
        // half of it beyond the edge
        (10.0 * 20.0, &|o| o.rectangle([-10.0, 6.0], [10.0, 26.0], 0.0, BLACK)),
    ];
    for (i, (area, draw)) in cases.iter().enumerate() {
        let found = sum(draw);
        assert!((found - area).abs() < 0.02 * area, "case {i}: {found}, expected {area}");
    }
}

#[test]
fn drawing_mixes_with_what_is_below() {
    let mut overlay = Overlay::new(4, 1).expect("a size");
    overlay.rectangle([1.0, 0.0], [3.0, 1.0], 0.0, [200, 100, 0, 128]);
    let mut picture = Picture::filled(4, 1, [0, 50, 100, 255]);
    picture.pixels[8..12].fill(0);
    overlay.draw_onto(&mut picture);
    let pixels = picture.pixels.as_chunks::<4>().0;
    assert_eq!([pixels[0], pixels[3]], [[0, 50, 100, 255]; 2]);
    // halfway, and the colour itself on a transparent ground
    for (found, expected) in [(pixels[1], [100, 75, 50, 255]), (pixels[2], [200, 100, 0, 128])] {
        assert!(found.iter().zip(expected).all(|(a, b)| a.abs_diff(b) <= 1), "{found:?}, expected {expected:?}");
    }
    let mut other = Picture::filled(5, 1, WHITE);
    overlay.draw_onto(&mut other);
    assert_eq!(other, Picture::filled(5, 1, WHITE), "another size is left alone");
}

#[test]
fn text_stands_where_it_is_asked_to() {
    let (width, height) = (300, 80);
    for (align, first) in [(Align::Left, 150.0), (Align::Center, 0.0), (Align::Right, 0.0)] {
        let long = text_width("HEIGHT", 24.0);
        let first = match align {
            Align::Left => first,
            Align::Center => 150.0 - long / 2.0,
            Align::Right => 150.0 - long,
        };
        let found = bounds(&drawn(width, height, |o| o.text("HEIGHT", [150.0, 40.0], align, &style(24.0))), 300, 0.3);
        // An H has a little room on both sides.
        assert!((found[0] as f32 - first).abs() < 4.0 && (found[1] as f32 - first - long).abs() < 4.0, "{found:?}");
        // Capitals of 0.73 em around the middle.
        assert!(found[2].abs_diff(31) <= 1 && found[3].abs_diff(49) <= 1, "{found:?}");
    }
}

/// Turning the picture by quarters turns the text with it, apart from the fit to whole rows.
#[test]
fn turned_text_is_never_upside_down() {
    let along = |direction: [f32; 2], align: Align| {
        drawn(160, 160, |o| o.text_along("Lj", [80.0, 80.0], direction, align, &style(30.0)))
    };
    let level = along([1.0, 0.0], Align::Left);
    assert_eq!(along([-5.0, 0.0], Align::Right), level, "the same place, read the other way");
    assert_eq!(along([0.0, 3.0], Align::Left), along([0.0, -1.0], Align::Right));
    // Upwards: what was at (x, y) is at (y, -x), seen from the middle.
    let upright = along([0.0, -1.0], Align::Left);
    let difference: f64 = (0..160 * 160).map(|i| (level[i] - upright[(159 - i % 160) * 160 + i / 160]).abs()).sum();
    let ink: f64 = level.iter().sum();
    assert!(difference < 0.35 * ink, "{difference} of {ink}");
    // Slightly off level: next to the same.
    let tilted = along([1.0, 1e-4], Align::Left);
    assert!(level.iter().zip(&tilted).map(|(a, b)| (a - b).abs()).sum::<f64>() < 0.35 * ink);
}

#[test]
fn halos_surround_letters() {
    let halo = TextStyle { halo: Some((3.0, WHITE)), ..style(20.0) };
    let mut overlay = Overlay::new(60, 40).expect("a size");
    overlay.text("I", [30.0, 20.0], Align::Center, &halo);
    let mut picture = Picture::filled(60, 40, [128, 128, 128, 255]);
    overlay.draw_onto(&mut picture);
    let count = |value: u8| picture.pixels.chunks_exact(4).filter(|pixel| pixel[0] == value).count();
    // Strokes of an I of 15 rows, and a rim of 3 pixels around it.
    assert!((15..60).contains(&count(0)), "{}", count(0));
    assert!((80..200).contains(&count(255)), "{}", count(255));
}

#[test]
fn widths_scale_and_add_up() {
    let width = |text: &str, size: f32| text_width(text, size);
    assert!((width("AB", 20.0) - width("A", 10.0) * 2.0 - width("B", 20.0)).abs() < 1e-3);
    assert_eq!(width("\u{0}\n\t\u{7f}\u{9b}", 20.0), 0.0, "control characters are left out");
    // The box of what the font lacks.
    assert!(width("\u{10_3456}", 20.0) > 5.0);
    assert_eq!(width("", 20.0), 0.0);
}

#[test]
fn long_texts_keep_their_ends() {
    let short = |text: &str, width: f32| shortened(text, width, 14.0);
    assert_eq!(short("bracket.stl", 400.0), "bracket.stl");
    let name = "a very long name of a part with many words, revision 17.step";
    let cut = short(name, 150.0);
    let (start, end) = cut.split_once('…').expect("an ellipsis");
    assert!(name.starts_with(start) && name.ends_with(end) && end.len() > start.len(), "{cut}");
    assert!(end.ends_with("revision 17.step") || end.ends_with("17.step"), "{cut}");
    let width = text_width(&cut, 14.0);
    assert!((120.0..=150.0).contains(&width), "{width}");
    assert_eq!((short(name, 15.0), short(name, 5.0)), ("…".to_owned(), String::new()));
    assert_eq!(short(name, f32::NAN), "");
    assert_eq!(shortened(name, 100.0, 0.0), name);
}

#[test]
fn absurd_input_is_left_out() {
    let long = "Ωlong\u{202e}".repeat(100_000);
    for value in [f32::NAN, f32::INFINITY, -1e30, 1e30, 3e5, -3e5, 0.0] {
        drawn(50, 50, |o| {
            o.line([value, 3.0], [20.0, value], 2.0, BLACK);
            o.line([1.0, 3.0], [20.0, 20.0], value, BLACK);
            o.polygon(&[[value, 3.0], [20.0, value], [9.0, 9.0]], BLACK);
            o.polygon(&[[value, value]], BLACK);
            o.polygon(&[], BLACK);
            o.rectangle([value, 3.0], [20.0, value], value, BLACK);
            o.rectangle([3.0, 3.0], [20.0, 9.0], value, BLACK);
            o.rectangle([-4e5, -4e5], [4e5, 4e5], value, BLACK);
            let halo = Some((value, WHITE));
            for size in [value, 12.0, 1e4] {
                o.text("text", [value, 3.0], Align::Right, &TextStyle { halo, ..style(size) });
                o.text_along("text", [3.0, 3.0], [value, 1.0], Align::Center, &TextStyle { halo, ..style(size) });
            }
        });
    }
    let ink: f64 = drawn(50, 50, |o| o.text(&long, [25.0, 25.0], Align::Center, &style(12.0))).iter().sum();
    assert!(ink > 50.0, "the middle of a long text is seen");
    assert!(Overlay::new(0, 5).is_err() && Overlay::new(u32::MAX, u32::MAX).is_err());
}
