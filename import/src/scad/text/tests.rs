//! Text in whatever font the system has.

use super::*;

fn plain(text: &str) -> Text<'_> {
    Text {
        text,
        size: 10.0,
        spacing: 1.0,
        font: "",
        direction: "ltr",
        language: "en",
        script: "Latn",
        halign: "left",
        valign: "baseline",
        segments: 30,
    }
}

/// The outline; `None` on systems without fonts, where there is nothing to test.
fn drawn(text: &Text<'_>) -> Option<Outline> {
    match outline(text, &mut Fonts::default()) {
        Err(TextError::NoFont(_)) => None,
        other => Some(other.expect("an outline").0),
    }
}

fn bounds(outline: &Outline) -> (DVec2, DVec2) {
    let least = outline.loops().flatten().copied().reduce(DVec2::min).expect("points");
    (least, outline.loops().flatten().copied().reduce(DVec2::max).expect("points"))
}

#[track_caller]
fn assert_near(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-9 * expected.abs().max(1.0), "found {found}, expected {expected}");
}

#[test]
fn curves_are_cut_at_equal_parameters() {
    let [a, b, c, d] = [[0.0, 0.0], [4.0, 1.0], [5.0, 6.0], [-1.0, 7.0]].map(DVec2::from);
    let mut drawing = Drawing::default();
    drawing.strokes.extend([Stroke::Move(a), Stroke::Curve([b, c]), Stroke::Cubic([b, a, d]), Stroke::Line(a)]);
    let loops = drawing.loops(3);
    assert_eq!((loops.len(), loops[0].len()), (1, 1 + 3 + 3));
    // de Casteljau's way
    let quadratic = |t: f64| a.lerp(b, t).lerp(b.lerp(c, t), t);
    let cubic = |t: f64| {
        let (p, q, r) = (c.lerp(b, t), b.lerp(a, t), a.lerp(d, t));
        p.lerp(q, t).lerp(q.lerp(r, t), t)
    };
    for k in 1..=3 {
        let t = k as f64 / 3.0;
        assert!(loops[0][k].distance(quadratic(t)) < 1e-14);
        assert!(loops[0][3 + k].distance(cubic(t)) < 1e-14);
    }
}

#[test]
fn sizes_scale_all() {
    let Some(small) = drawn(&plain("Rag")) else { return };
    let large = drawn(&Text { size: 25.0, ..plain("Rag") }).expect("fonts");
    assert_near(large.area(), small.area() * 6.25);
    let ((low, high), (low_large, high_large)) = (bounds(&small), bounds(&large));
    assert!(low_large.distance(low * 2.5) < 1e-12 && high_large.distance(high * 2.5) < 1e-12);
    // letters with one hole each, and capitals about as high as the size says
    assert_eq!(small.shapes().iter().map(|shape| shape.len() - 1).sum::<usize>(), 3);
    let capital = bounds(&drawn(&plain("E")).expect("fonts")).1.y;
    assert!((9.0..11.5).contains(&capital), "{capital}");
    assert!(drawn(&Text { size: 0.0, ..plain("E") }).is_none_or(|nothing| nothing.is_empty()));
}

#[test]
fn alignment_moves_the_whole() {
    let Some(left) = drawn(&plain("moved")) else { return };
    let (low, high) = bounds(&left);
    for (halign, valign) in [("right", "top"), ("center", "center"), ("left", "bottom")] {
        let moved = drawn(&Text { halign, valign, ..plain("moved") }).expect("fonts");
        let by = bounds(&moved).0 - low;
        assert!(bounds(&moved).1.distance(high + by) < 1e-12, "{halign} {valign}");
        assert_near(moved.area(), left.area());
        let share = ["left", "center", "right"].iter().position(|name| *name == halign).expect("known") as f64 / 2.0;
        // a width of about what is drawn, of which a part is subtracted
        assert!((by.x + share * (high.x - low.x)).abs() < 0.15 * (high.x - low.x), "{halign}: {by}");
        assert!(valign != "top" || bounds(&moved).1.y < 0.5, "{by}");
    }
    let mut fonts = Fonts::default();
    let (_, warnings) = outline(&Text { halign: "middle", valign: "up", ..plain("x") }, &mut fonts).expect("fonts");
    let told = |what: &str| warnings.iter().any(|warning| warning.contains(what));
    assert!(told("halign `middle`") && told("valign `up`"), "{warnings:?}");
}

#[test]
fn spacing_and_segments() {
    let Some(once) = drawn(&plain("oo")) else { return };
    let twice = drawn(&Text { spacing: 2.0, ..plain("oo") }).expect("fonts");
    let single = bounds(&drawn(&plain("o")).expect("fonts"));
    let advance = bounds(&once).1.x - single.1.x;
    assert_near(bounds(&twice).1.x - single.1.x, 2.0 * advance);
    // every part of an `o` is a curve
    let corners = |segments: u32| {
        let outline = drawn(&Text { segments, ..plain("o") }).expect("fonts");
        outline.loops().map(Vec::len).sum::<usize>()
    };
    assert_eq!((corners(16) * 2, corners(8) * 2), (corners(40), corners(24)));
    assert_eq!(corners(3), corners(8), "two segments at least");
}

#[test]
fn letters_tell_the_script_that_is_not_named() {
    let Some(named) = drawn(&plain("AVATo")) else { return };
    let unnamed = Text { script: "", direction: "", language: "", ..plain("AVATo") };
    assert_eq!(drawn(&unnamed).expect("fonts"), named);
}

#[test]
fn what_takes_the_place_of_a_font_is_told() {
    let asked = Text { font: "No Such Font:style=Bold", ..plain("x") };
    match outline(&asked, &mut Fonts::default()) {
        Err(error) => assert!(matches!(error, TextError::NoFont(_)), "{error}"),
        Ok((_, warnings)) => assert!(warnings[0].contains("`No Such Font` is not there"), "{warnings:?}"),
    }
}
