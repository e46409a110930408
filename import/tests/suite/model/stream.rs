//! Model files brush by brush: the same leaves as of the tree in memory, and more of them than memory holds.

use std::io;
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use planecut_csg::{Brush, Operation, Tree, TreeBuilder, TreeNode, TreeSink};
use planecut_import::model::{
    MAX_BRUSHES, MAX_DEPTH, ModelError, ModelOptions, ModelSummary, read_model, stream_model,
};
use planecut_import::stream::StreamError;
use planecut_testkit::random::Rng;

use super::support::file;

const CUBE: &str = r#"{"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}"#;

fn options() -> ModelOptions {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/files");
    ModelOptions { folder, ..ModelOptions::default() }
}

/// The value of a tree where its leaves have these values.
fn value(tree: &Tree, leaves: &[bool]) -> bool {
    let (mut values, mut leaves) = (Vec::new(), leaves.iter());
    for node in tree.nodes() {
        let value = match node {
            TreeNode::Leaf => *leaves.next().expect("a value for each leaf"),
            TreeNode::Operation { operation, operands } => {
                let operands = values.split_off(values.len() - *operands as usize);
                let count = operands.iter().filter(|value| **value).count();
                match operation {
                    Operation::Union => count > 0,
                    Operation::Intersection => count == operands.len(),
                    Operation::Difference => count == 1 && operands[0],
                    Operation::Xor => count % 2 == 1,
                    Operation::Complement => count == 0,
                }
            }
        };
        values.push(value);
    }
    assert_eq!(values.len(), 1, "one root");
    values[0]
}

/// Fails unless a file is the same in memory and as a stream. How many brushes it has; `None` where it is refused.
#[track_caller]
fn compare(text: &str, options: &ModelOptions) -> Option<usize> {
    let mut builder = TreeBuilder::default();
    let streamed = stream_model(text.as_bytes(), "m.json", options, &mut builder).map_err(StreamError::into_input);
    let (summary, import) = match (streamed, read_model(text.as_bytes(), "m.json", options)) {
        (Ok(summary), Ok(import)) => (summary, import),
        (Err(error), Err(expected)) => {
            assert_eq!(error, expected, "{text}");
            return None;
        }
        (streamed, expected) => panic!("{text}\n{streamed:?}\nexpected {expected:?}"),
    };
    let (tree, expected) = (builder.finish(), import.model.tree);
    assert!(tree.brushes() == expected.brushes(), "{text}: {:?}, expected {:?}", tree.brushes(), expected.brushes());
    assert!(tree.source_lines().eq(expected.source_lines()), "{text}");
    let (materials, parameters, warnings) = (import.model.materials, import.parameters, import.warnings);
    let brushes = tree.brushes().len();
    assert_eq!(summary, ModelSummary { brushes: brushes as u64, materials, parameters, warnings }, "{text}");
    let mut random = Rng::new(brushes as u64);
    for round in 0..40 {
        // most leaves of unions must be outside for the others to count
        let share = [0.5, 0.1, 0.9, 1.0 / (brushes + 1) as f64][round % 4];
        let leaves: Vec<bool> = (0..brushes).map(|_| random.chance(share)).collect();
        assert_eq!(value(&tree, &leaves), value(&expected, &leaves), "{text}\n{leaves:?}");
    }
    Some(brushes)
}

#[test]
fn examples_are_the_same() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let folders: [PathBuf; 2] = [root.join("examples"), root.join("tests/files")];
    let (mut compared, mut brushes) = (0, 0);
    for folder in folders.iter().filter(|folder| folder.exists()) {
        for path in std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()) {
            if path.extension().is_none_or(|ending| ending != "json") {
                continue;
            }
            let text = std::fs::read_to_string(&path).expect("a text");
            if !text.contains("\"planecut\"") {
                continue;
            }
            let options = ModelOptions { folder: folder.clone(), ..ModelOptions::default() };
            brushes += compare(&text, &options).unwrap_or(0);
            compared += 1;
        }
    }
    assert!(compared >= 10 && brushes > 500, "{compared} files, {brushes} brushes");
}

/// A transform, a name and a material, each now and then.
fn attributes(random: &mut Rng) -> String {
    let mut text = String::new();
    if random.below(3) == 0 {
        text +=
            &format!(", \"transform\": [{{\"rotate\": [{}, 0, 90]}}, {{\"translate\": [1, 2, 3]}}]", random.below(90));
    }
    if random.below(4) == 0 {
        text += &format!(", \"name\": \"n{}\"", random.below(9));
    }
    if random.below(4) == 0 {
        text += &format!(", \"material\": \"m{}\"", random.below(3));
    }
    text
}

/// A node of at most this number of levels, in a file whose parts below `parts` may be used.
fn random_node(random: &mut Rng, levels: usize, parts: usize) -> String {
    let inner = |random: &mut Rng| random_node(random, levels - 1, parts);
    let several = |random: &mut Rng| {
        let count = 1 + random.below(3);
        (0..count).map(|_| random_node(random, levels - 1, parts)).collect::<Vec<_>>().join(", ")
    };
    let kind = if levels == 0 { random.below(4) } else { random.below(15) };
    let node = match kind {
        0 => format!("{{\"box\": {{\"min\": [0, 0, 0], \"max\": [\"=w\", 1, {}]}}", 1 + random.below(3)),
        1 => "{\n\"sphere\": {\"radius\": 1, \"segments\": 4}".to_owned(),
        2 => "{\"points\": [[0, 0, 0], [1, 0, 0], [0, 1, 0]]".to_owned(),
        3 => "{\"torus\": {\"radius\": 3, \"tube\": 1, \"segments\": 3, \"tube_segments\": 3}".to_owned(),
        4 | 5 if parts > 0 => {
            let with = if random.below(3) == 0 { ", \"with\": {\"w\": \"=w + 1\"}" } else { "" };
            format!("{{\"use\": \"p{}\"{with}", random.below(parts))
        }
        4 | 6 => format!("{{\"union\": [{}]", several(random)),
        5 | 7 => format!("{{\"difference\": [{}]", several(random)),
        8 => format!("{{\"intersection\": [{}]", several(random)),
        9 => format!("{{\"xor\": [{}]", several(random)),
        10 => format!("{{\"complement\": {}", inner(random)),
        11 => format!("{{\"ring\": {{\"of\": {}, \"count\": {}}}", inner(random), 1 + random.below(3)),
        12 => format!("{{\"array\": {{\"of\": {}, \"count\": [2, \"=n\", 2], \"step\": [3, 4, 5.1]}}", inner(random)),
        13 => {
            let places =
                "[[1, 2, 3], [{\"mirror\": [1, 0, 0]}], {\"matrix\": [[1, 0, 0, 0], [0, 2, 0, 0], [0, 0, 1, 0]]}]";
            format!("{{\"instances\": {{\"of\": {}, \"at\": {places}}}", inner(random))
        }
        _ => "{\"hull\": [{\"box\": {\"min\": [0, 0, 0], \"max\": [1, 1, 1]}}, {\"points\": [[2, 2, 2]]}]".to_owned(),
    };
    node + &attributes(random) + "}"
}

fn random_file(random: &mut Rng) -> String {
    let parts: Vec<String> = (0..3).map(|k| format!("\"p{k}\": {}", random_node(random, 2, k))).collect();
    let materials = ["", "\"materials\": {\"m1\": {}}, ", "\"materials\": {\"m0\": {}, \"default\": {}}, "];
    format!(
        "{{\"planecut\": 1, {}\"parameters\": {{\"w\": 2, \"n\": 1}}, \"parts\": {{{}}},\n\"model\": {}}}",
        materials[random.below(3)],
        parts.join(",\n"),
        random_node(random, 4, 3)
    )
}

#[test]
fn random_models_are_the_same() {
    let mut random = Rng::new(90_125);
    let (mut most, mut all) = (0, 0);
    for _ in 0..1500 {
        if let Some(brushes) = compare(&random_file(&mut random), &options()) {
            most = most.max(brushes);
            all += usize::from(brushes > 0);
        }
    }
    assert!(most > 150 && all > 1000, "{most} brushes at most, {all} models of some");
}

#[test]
fn a_part_that_is_sent_and_taken_for_a_hull_is_warned_of_once() {
    let flat = "{\"points\": [[0, 0, 0], [1, 0, 0], [0, 1, 0]]}";
    let text = format!(
        "{{\"planecut\": 1, \"parts\": {{\"a\": {{\"union\": [{flat}, {CUBE}]}}}},
          \"model\": {{\"union\": [{{\"use\": \"a\"}}, {{\"hull\": [{{\"use\": \"a\"}}, {flat}]}}, {{\"use\": \"a\"}}]}}}}"
    );
    assert_eq!(compare(&text, &options()), Some(3));
}

#[test]
fn files_of_meshes_number_their_materials_alike() {
    let folder = tempfile::tempdir().expect("a folder");
    let mesh = |material: &str| {
        let faces = "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
        format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n{material}{faces}")
    };
    for (name, material) in [("plain", ""), ("red", "usemtl red\n"), ("default", "usemtl default\n")] {
        std::fs::write(folder.path().join(format!("{name}.obj")), mesh(material)).expect("written");
    }
    let options = ModelOptions { folder: folder.path().to_owned(), ..ModelOptions::default() };
    for materials in ["", r#""materials": {"blue": {}}, "#, r#""materials": {"default": {}, "red": {}}, "#] {
        for files in [&["plain"][..], &["red"], &["plain", "red"], &["red", "default"], &["default", "plain", "red"]] {
            let meshes: Vec<String> = files.iter().map(|name| format!("{{\"mesh\": \"{name}.obj\"}}")).collect();
            let list = meshes.join(", ");
            for model in [
                format!("{{\"union\": [{CUBE}, {list}]}}"),
                format!(
                    "{{\"array\": {{\"of\": {{\"xor\": [{list}, {CUBE}]}}, \"count\": [2, 2, 2], \"step\": [2, 2, 2]}}}}"
                ),
                format!("{{\"difference\": [{list}], \"material\": \"blue\"}}"),
            ] {
                let text = format!("{{\"planecut\": 1, {materials}\"model\": {model}}}");
                assert!(compare(&text, &options).is_some_and(|brushes| brushes >= files.len()), "{text}");
            }
        }
    }
}

#[test]
fn errors_are_those_of_the_tree_in_memory() {
    for text in [
        "",
        "{\"planecut\": 1}",
        &file("{\"bax\": {}}"),
        &file("{\"use\": \"nothing\"}"),
        &file(&format!("{{\"union\": [{CUBE}, {{\"sphere\": {{\"radius\": -1}}}}]}}")),
        &file(&format!("{{\"ring\": {{\"of\": {CUBE}, \"count\": 1.5}}}}")),
        &file(&format!("{{\"array\": {{\"of\": {CUBE}, \"count\": [1e300, 1e300, 1e300], \"step\": [2, 2, 2]}}}}")),
        &file(&format!("{{\"array\": {{\"of\": {CUBE}, \"count\": [3, 1, 1], \"step\": [1e300, 0, 0]}}}}")),
        &file("{\"mesh\": \"missing.obj\"}"),
    ] {
        assert_eq!(compare(text, &options()), None, "{text}");
    }
}

/// Counts, and takes at most this number of brushes.
struct Count {
    brushes: u64,
    most: u64,
    open: u64,
}

impl Count {
    fn up_to(most: u64) -> Self {
        Self { brushes: 0, most, open: 0 }
    }
}

impl TreeSink for Count {
    type Error = io::Error;

    fn begin(&mut self, _: Operation) -> io::Result<()> {
        self.open += 1;
        Ok(())
    }

    fn leaf(&mut self, _: Brush, line: Option<NonZeroU32>) -> io::Result<()> {
        assert!(line.is_some());
        if self.brushes == self.most {
            return Err(io::Error::other("no room"));
        }
        self.brushes += 1;
        Ok(())
    }

    fn end(&mut self) -> io::Result<()> {
        self.open -= 1;
        Ok(())
    }
}

fn count(text: &str, max_pieces: u64, most: u64) -> (Count, Result<ModelSummary, StreamError<ModelError, io::Error>>) {
    let mut count = Count::up_to(most);
    let options = ModelOptions { max_pieces: max_pieces as usize, ..ModelOptions::default() };
    let result = stream_model(text.as_bytes(), "m.json", &options, &mut count);
    (count, result)
}

/// So many copies along x.
fn row(of: &str, count: &str) -> String {
    format!(r#"{{"array": {{"of": {of}, "count": [{count}, 1, 1], "step": [2, 2, 2]}}}}"#)
}

#[test]
fn more_brushes_than_a_tree_may_have_are_sent() {
    let (places, brushes) = (MAX_BRUSHES / 3 + 1, 3 * (MAX_BRUSHES / 3 + 1));
    let text = file(&row(&row(CUBE, "3"), &places.to_string()));
    let (count, result) = count(&text, 1 << 40, u64::MAX);
    assert_eq!((count.brushes, count.open), (brushes as u64, 0));
    assert_eq!(result.expect("sent").brushes, brushes as u64);
}

#[test]
fn a_trillion_copies_begin_at_once() {
    let begin = Instant::now();
    let nested = row(&row(&row(&format!("{{\"difference\": [{CUBE}, {CUBE}]}}"), "1000"), "10000"), "10000");
    let part = format!(
        "{{\"planecut\": 1, \"parts\": {{\"a\": {nested}}}, \"model\": {{\"xor\": [{{\"use\": \"a\"}}, {{\"use\": \"a\"}}]}}}}"
    );
    for text in [
        file(&row(CUBE, "1e12")),
        file(&format!("{{\"ring\": {{\"of\": {CUBE}, \"count\": 1e12}}}}")),
        file(&nested),
        part,
    ] {
        let (count, result) = count(&text, u64::MAX >> 1, 100_000);
        assert_eq!((count.brushes, result.expect_err("no room").to_string()), (100_000, "no room".to_owned()));
    }
    assert!(begin.elapsed() < Duration::from_secs(20), "{:?}", begin.elapsed());
}

#[test]
fn what_is_too_much_is_refused_before_it_is_made() {
    let begin = Instant::now();
    let error = |text: &str, limit| match count(text, limit, 0) {
        (_, Err(StreamError::Input(error))) => error.to_string(),
        (_, result) => panic!("{text}: {result:?}"),
    };
    // of what is sent
    let sent = error(&file(&row(&row(CUBE, "1e6"), "1e7")), 1 << 40);
    assert!(sent.contains("found 10000000000000 or more brushes in all, expected at most 1099511627776"), "{sent}");
    let sent = error(&file(&row(CUBE, "101")), 100);
    assert!(sent.contains("found 101 or more brushes in all, expected at most 100 (--max-pieces)"), "{sent}");
    // of what is sent, as only evaluation tells
    let expression = format!(
        "{{\"planecut\": 1, \"parameters\": {{\"n\": 1000000}}, \"model\": {}}}",
        row(&row(&row(CUBE, "\"=n\""), "\"=n\""), "2")
    );
    let sent = error(&expression, 1 << 40);
    assert!(sent.contains("found 2000000000000 brushes in all, expected at most 1099511627776"), "{sent}");
    // of what is held
    let held = error(&file(&format!("{{\"hull\": [{}]}}", row(CUBE, "5e6"))), 1 << 40);
    assert!(held.contains("found 5000000 brushes in all, expected at most 4194304 (--max-pieces)"), "{held}");
    // parts that double, of something and of nothing
    let doubling = |leaf: &str| {
        let parts: Vec<String> = (1..=60)
            .map(|k| format!("\"p{k}\": {{\"union\": [{{\"use\": \"p{0}\"}}, {{\"use\": \"p{0}\"}}]}}", k - 1))
            .collect();
        format!(
            "{{\"planecut\": 1, \"parts\": {{\"p0\": {leaf}, {}}}, \"model\": {{\"use\": \"p60\"}}}}",
            parts.join(", ")
        )
    };
    let sent = error(&doubling(CUBE), 1 << 40);
    assert!(sent.contains("or more brushes in all, expected at most 1099511627776"), "{sent}");
    let sent = error(&doubling("{\"complement\": {\"points\": [[0, 0, 0], [1, 0, 0], [0, 1, 0]]}}"), 1 << 20);
    assert!(sent.contains("operations in all, expected at most 134217728 for this number of brushes"), "{sent}");
    assert!(begin.elapsed() < Duration::from_secs(20), "{:?}", begin.elapsed());
}

#[test]
fn ten_thousand_nodes_within_one_another_are_sent_from_a_small_stack() {
    let work = || {
        for (open, close) in [
            (format!("{{\"difference\": [{CUBE}, "), "]}".to_owned()),
            ("{\"union\": [".to_owned(), format!(", {CUBE}]}}")),
            ("{\"complement\": ".to_owned(), "}".to_owned()),
            ("{\"instances\": {\"at\": [[1, 0, 0]], \"of\": ".to_owned(), "}}".to_owned()),
        ] {
            let text = |depth: usize| file(&format!("{}{CUBE}{}", open.repeat(depth), close.repeat(depth)));
            let (sent, result) = count(&text(MAX_DEPTH as usize), 1 << 40, u64::MAX);
            assert!(sent.brushes > 0 && sent.open == 0 && result.is_ok(), "{open}");
            let (_, result) = count(&text(MAX_DEPTH as usize + 1), 1 << 40, u64::MAX);
            let error = result.expect_err("too deep").to_string();
            assert!(error.contains("found more than 10000 nodes within one another"), "{error}");
        }
    };
    let thread = std::thread::Builder::new().stack_size(256 * 1024).spawn(work).expect("a thread");
    thread.join().expect("no panic");
}
