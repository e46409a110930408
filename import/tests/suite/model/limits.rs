//! Deep, long and huge model files: done, or refused before anything is copied.

use std::num::NonZeroU32;
use std::time::{Duration, Instant};

use planecut_csg::TreeNode;
use planecut_import::DEFAULT_MAX_PIECES;
use planecut_import::model::{MAX_DEPTH, ModelOptions, read_model};

use super::support::{file, model, read};

const CUBE: &str = r#"{"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}"#;

/// Runs on a stack as small as threads commonly get.
fn on_a_small_stack(work: impl FnOnce() + Send + 'static) {
    let thread = std::thread::Builder::new().stack_size(256 * 1024).spawn(work).expect("a thread");
    thread.join().expect("no panic");
}

/// A node within that number of others.
fn nested(levels: usize, open: &str, close: &str) -> String {
    format!("{}{CUBE}{}", open.repeat(levels), close.repeat(levels))
}

#[test]
fn ten_thousand_nodes_within_one_another_are_read() {
    on_a_small_stack(|| {
        let depth = MAX_DEPTH as usize;
        for (open, close) in [
            (format!("{{\"difference\": [{CUBE}, "), "]}".to_owned()),
            ("{\"union\": [".to_owned(), format!(", {CUBE}]}}")),
            ("{\"complement\": ".to_owned(), "}".to_owned()),
            ("{\"instances\": {\"at\": [[1, 0, 0]], \"of\": ".to_owned(), "}}".to_owned()),
        ] {
            let import = model(&nested(depth, &open, &close));
            assert!(!import.model.tree.brushes().is_empty(), "{open}");
            let error = read(&file(&nested(depth + 1, &open, &close))).expect_err("too deep").to_string();
            assert!(
                error.contains("found more than 10000 nodes within one another, expected at most 10000"),
                "{error}"
            );
            assert!(error.len() < 1000, "{error}");
        }
    });
}

#[test]
fn parts_within_parts_count_as_depth() {
    on_a_small_stack(|| {
        let chain = |length: usize| {
            let parts: Vec<String> = (1..length).map(|k| format!("\"p{k}\": {{\"use\": \"p{}\"}}", k - 1)).collect();
            format!(
                "{{\"planecut\": 1, \"parts\": {{\"p0\": {CUBE}, {}}}, \"model\": {{\"use\": \"p{}\"}}}}",
                parts.join(", "),
                length - 1
            )
        };
        assert_eq!(read(&chain(MAX_DEPTH as usize)).expect("read").model.tree.brushes().len(), 1);
        let error = read(&chain(MAX_DEPTH as usize + 2)).expect_err("too deep").to_string();
        assert!(error.contains("more than 10000 nodes within one another, parts included"), "{error}");
    });
}

#[test]
fn brackets_without_end_are_an_error() {
    on_a_small_stack(|| {
        for bracket in ["[", "{\"a\": ", "[{\"a\": "] {
            let error = read(&bracket.repeat(1_000_000)).expect_err("no end").to_string();
            assert!(error.contains("found the end of the file, expected a") && error.len() < 1000, "{error}");
        }
        let closed = format!("{}{}", "[".repeat(1_000_000), "]".repeat(1_000_000));
        let error = read(&file(&closed)).expect_err("no node").to_string();
        assert!(error.contains("$.model: found a list of 1 value, expected a NODE"), "{error}");
    });
}

#[track_caller]
fn refused_at_once(text: &str, words: &str) {
    let begin = Instant::now();
    let error = read(text).expect_err("too much").to_string();
    assert!(error.contains(words), "{error}");
    assert!(begin.elapsed() < Duration::from_secs(5), "{:?}", begin.elapsed());
}

#[test]
fn a_billion_copies_are_refused_before_any_is_made() {
    let limit = format!("expected at most {DEFAULT_MAX_PIECES} (--max-pieces)");
    for text in [
        format!(r#"{{"array": {{"of": {CUBE}, "count": [1000, 1000, 1000], "step": [2, 2, 2]}}}}"#),
        format!(r#"{{"array": {{"of": {CUBE}, "count": [1e300, 1e300, 1e300], "step": [2, 2, 2]}}}}"#),
        format!(r#"{{"ring": {{"of": {CUBE}, "count": 1e9}}}}"#),
    ] {
        refused_at_once(&file(&text), &limit);
    }
    let mut nested = CUBE.to_owned();
    for _ in 0..9 {
        nested = format!(r#"{{"array": {{"of": {nested}, "count": [10, 1, 1], "step": [1, 1, 1]}}}}"#);
    }
    refused_at_once(&file(&nested), &limit);
}

#[test]
fn parts_that_double_are_refused_before_they_are_copied() {
    let doubling = |leaf: &str, levels: usize| {
        let parts: Vec<String> = (1..=levels)
            .map(|k| format!("\"p{k}\": {{\"union\": [{{\"use\": \"p{0}\"}}, {{\"use\": \"p{0}\"}}]}}", k - 1))
            .collect();
        format!(
            "{{\"planecut\": 1, \"parts\": {{\"p0\": {leaf}, {}}}, \"model\": {{\"use\": \"p{levels}\"}}}}",
            parts.join(", ")
        )
    };
    assert_eq!(read(&doubling(CUBE, 10)).expect("read").model.tree.brushes().len(), 1024);
    refused_at_once(&doubling(CUBE, 40), "brushes in all, expected at most 1048576 (--max-pieces)");
    // A million nodes that make nothing would do no harm, but a billion take time.
    let nothing = r#"{"points": [[0, 0, 0], [1, 0, 0], [0, 1, 0]]}"#;
    let import = read(&doubling(nothing, 16)).expect("read");
    assert_eq!(import.model.tree.brushes().len(), 0);
}

#[test]
fn a_hundred_thousand_copies_are_made() {
    let text = format!(r#"{{"array": {{"of": {CUBE}, "count": [100, 100, 10], "step": [2, 2, 2]}}}}"#);
    let import = model(&text);
    assert_eq!(import.model.tree.brushes().len(), 100_000);
    assert_eq!(import.model.tree.nodes().len(), 100_001, "one union of all");
}

#[test]
fn a_chain_of_ten_thousand_differences_keeps_its_order() {
    let mut text = CUBE.to_owned();
    for k in 0..9_000 {
        text = format!(r#"{{"difference": [{{"box": {{"min": [{k}, 0, 0], "max": [{}, 1, 1]}}}}, {text}]}}"#, k + 1);
    }
    let import = model(&text);
    let nodes = import.model.tree.nodes();
    assert_eq!(nodes.len(), 18_001);
    assert!(nodes[..9_001].iter().all(|node| *node == TreeNode::Leaf), "all first operands, then the operations");
    assert!(nodes[9_001..].iter().all(|node| matches!(node, TreeNode::Operation { operands: 2, .. })));
}

#[test]
fn a_long_chain_of_parameters_is_read() {
    let parameters: Vec<String> = (1..100_000).map(|k| format!("\"a{k}\": \"=a{} + 1\"", k - 1)).collect();
    let text =
        format!("{{\"planecut\": 1, \"parameters\": {{{}, \"a0\": 0}}, \"model\": {CUBE}}}", parameters.join(", "));
    let import = read(&text).expect("read");
    assert_eq!(import.parameters[99_998], ("a99999".to_owned(), 99_999.0));
}

#[test]
fn a_list_of_many_bodies_is_read_in_linear_time() {
    let bodies: Vec<String> = (0..200_000)
        .map(|k| format!(r#"{{"box": {{"min": [{k}, 0, 0], "max": [{}, 1, 1]}}, "name": "b{k}"}}"#, k + 1))
        .collect();
    let begin = Instant::now();
    let import = model(&format!("{{\"union\": [\n{}]}}", bodies.join(",\n")));
    assert!(begin.elapsed() < Duration::from_secs(20), "{:?}", begin.elapsed());
    let tree = &import.model.tree;
    assert_eq!(tree.brushes()[199_999].name.as_deref(), Some("b199999"));
    assert_eq!(tree.source_line(199_999), NonZeroU32::new(200_001));
}

/// A file of outlines, each made of the one before by what `step` says of its name; the last one is extruded.
fn outlines_on_outlines(levels: usize, step: impl Fn(&str) -> String) -> String {
    let outlines: Vec<String> =
        (1..=levels).map(|k| format!("\"o{k}\": {}", step(&format!("{{\"use\": \"o{}\"", k - 1)))).collect();
    format!(
        r#"{{"planecut": 1, "outlines": {{"o0": {{"rectangle": {{"min": [0, 0], "max": [1, 1]}}}}, {}}},
             "model": {{"extrude": {{"outline": {{"use": "o{levels}"}}, "height": 1}}}}}}"#,
        outlines.join(", ")
    )
}

#[test]
fn an_outline_that_is_used_twice_is_made_once() {
    // 2^40 squares, of which only 41 differ
    let text = outlines_on_outlines(40, |name| {
        format!(r#"{{"union": [{name}}}, {name}, "matrix": [[1, 0, 1], [0, 1, 0]]}}]}}"#)
    });
    let begin = Instant::now();
    let import = read(&text).expect("read");
    assert!(begin.elapsed() < Duration::from_secs(5), "{:?}", begin.elapsed());
    let extent = |axis: usize| {
        let faces = import.model.tree.brushes().iter().flat_map(|brush| &brush.faces);
        let offsets = faces.filter(|face| face.half_space.normal()[axis] > 0.0).map(|face| face.half_space.offset());
        offsets.fold(0.0, f64::max)
    };
    assert_eq!([extent(0), extent(1), extent(2)], [41.0, 1.0, 1.0]);
}

#[test]
fn offsets_of_offsets_are_refused_with_count_and_limit() {
    // a corner of an offset with round joins has at least two corners in the next one
    let text = outlines_on_outlines(60, |name| format!(r#"{{"offset": {{"of": {name}}}, "by": 1, "segments": 64}}}}"#));
    refused_at_once(&text, "corners in all, each step counted, expected at most 1048576 (--max-pieces)");
}

#[test]
fn the_limit_of_pieces_is_an_option() {
    let text = file(&format!(r#"{{"array": {{"of": {CUBE}, "count": [10, 10, 1], "step": [2, 2, 2]}}}}"#));
    let with = |max_pieces| {
        let options = ModelOptions { max_pieces, ..ModelOptions::default() };
        read_model(text.as_bytes(), "model.json", &options)
    };
    assert_eq!(with(100).expect("read").model.tree.brushes().len(), 100);
    let error = with(99).expect_err("refused").to_string();
    assert!(error.contains("found 100 or more brushes in all, expected at most 99 (--max-pieces)"), "{error}");
}

#[test]
fn sums_of_many_bodies_are_refused_before_they_are_made() {
    let row = |count: usize| format!(r#"{{"array": {{"of": {CUBE}, "count": [{count}, 1, 1], "step": [3, 3, 3]}}}}"#);
    let sum = |a, b| file(&format!(r#"{{"minkowski": [{}, {}]}}"#, row(a), row(b)));
    assert_eq!(read(&sum(20, 30)).expect("read").model.tree.brushes().len(), 600);
    refused_at_once(&sum(20_000, 30_000), "600000000 brushes in all, expected at most 1048576 (--max-pieces)");
}
