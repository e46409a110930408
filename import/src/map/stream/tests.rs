//! Maps through small windows against the same maps in memory.

mod random;

use std::io::{self, Read};

use planecut_csg::{Brush, TreeBuilder};
use planecut_testkit::data::data;
use planecut_testkit::random::Rng;

use random::random_map;

use super::*;
use crate::map::read_map;

planecut_testkit::tests_on_data!(maps_of_others_are_read_alike_in_any_window);

/// Gives at most this number of bytes at once.
struct Slow<'a>(&'a [u8], usize);

impl Read for Slow<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let length = self.1.min(buffer.len());
        self.0.read(&mut buffer[..length])
    }
}

/// Fails unless a window of this size gives the map, or the error, that the whole text gives. What it gave; `None` where a late key is refused.
#[track_caller]
fn compare(text: &[u8], options: &MapOptions, size: usize, what: &str) -> Option<Result<MapSummary, MapError>> {
    let mut builder = TreeBuilder::default();
    let mut window = Window::new(Slow(text, 1 + size % 7), size);
    let streamed = match stream_window(&mut window, "m", options, &mut builder) {
        Err(StreamError::Input(MapError::LateKey { .. })) => return None,
        streamed => streamed.map_err(StreamError::into_input),
    };
    match (&streamed, read_map(text, "m", options)) {
        (Ok(summary), Ok(import)) => {
            assert!(builder.finish() == import.model.tree, "{what}, {size}: other brushes");
            let expected = MapSummary {
                brushes: import.model.tree.brushes().len(),
                materials: import.model.materials,
                entities: import.entities,
                brushes_read: import.brushes_read,
                brushes_skipped: import.brushes_skipped,
                brushes_left_out: import.brushes_left_out,
                faces_left_out: import.faces_left_out,
                patches_left_out: import.patches_left_out,
                primitives_left_out: import.primitives_left_out,
                warnings: import.warnings,
            };
            assert_eq!(*summary, expected, "{what}, {size}");
        }
        (Err(error), Err(expected)) => assert_eq!(*error, expected, "{what}, {size}"),
        (streamed, expected) => {
            let (streamed, expected) = (streamed.as_ref().map(|s| s.brushes), expected.map(|i| i.brushes_read));
            panic!("{what}, {size}: {streamed:?}, expected {expected:?}")
        }
    }
    Some(streamed)
}

/// Options that leave some of the brushes of these tests aside.
fn some_options() -> [MapOptions; 2] {
    let skip = MapOptions {
        skip_textures: vec!["clip*".to_owned()],
        skip_classes: vec!["trigger_*".to_owned()],
        ..MapOptions::default()
    };
    [MapOptions::default(), skip]
}

fn maps_of_others_are_read_alike_in_any_window() {
    let mut compared = 0;
    for folder in std::fs::read_dir(data("map")).expect("a folder").map(|entry| entry.expect("an entry").path()) {
        let Ok(files) = std::fs::read_dir(&folder) else { continue };
        for path in files.map(|entry| entry.expect("an entry").path()) {
            if path.extension().is_none_or(|ending| ending != "map") {
                continue;
            }
            let text = std::fs::read(&path).expect("a readable file");
            for size in [16, 100, 5000, WINDOW] {
                let what = path.display().to_string();
                assert!(compare(&text, &MapOptions::default(), size, &what).is_some(), "{what}: a late key");
                compared += 1;
            }
        }
    }
    assert!(compared > 40, "{compared}");
}

#[test]
fn random_maps_are_read_alike_in_any_window() {
    let (mut random, mut brushes, mut waited) = (Rng::new(20_061), 0, 0);
    for _ in 0..300 {
        let text = random_map(&mut random);
        for size in [16, 17, 40 + random.below(200), 1 << 16] {
            for options in some_options() {
                let summary = compare(text.as_bytes(), &options, size, &text).expect("no late key");
                brushes += summary.map_or(0, |summary| summary.brushes);
            }
        }
        let class = text.rfind("\"classname\"").unwrap_or(0);
        waited += usize::from(text[..class].trim_ascii_end().ends_with('}'));
    }
    assert!(brushes > 3000 && waited > 10, "{brushes} brushes, {waited} maps in which some waited");
}

#[test]
fn damaged_maps_give_the_same_errors_in_any_window() {
    let mut random = Rng::new(7_411);
    let (mut read, mut refused, mut late) = (0, 0, 0);
    for round in 0..3000 {
        let mut text = random_map(&mut random).into_bytes();
        if text.is_empty() {
            continue;
        }
        for _ in 0..=random.below(2) {
            let at = random.below(text.len());
            match random.below(5) {
                0 => text.truncate(at.max(1)),
                1 => text[at] ^= 1 << random.below(8),
                2 => text[at] = b"(){}[]\"\\/;-.e09 \n\rV"[random.below(19)],
                3 => text.insert(at, b"(){}[]\"\\/;-.e09 \n\rV"[random.below(19)]),
                _ => drop(text.drain(at..(at + random.below(60)).min(text.len()))),
            }
            if text.is_empty() {
                text.push(b'{');
            }
        }
        let size = [16, 30, 64 + random.below(300)][random.below(3)];
        let what = format!("round {round}: {}", String::from_utf8_lossy(&text));
        match compare(&text, &some_options()[round % 2], size, &what) {
            None => late += 1,
            Some(Ok(_)) => read += 1,
            Some(Err(_)) => refused += 1,
        }
    }
    assert!(read > 100 && refused > 1000 && late < 30, "{read} read, {refused} refused, {late} late keys");
}

#[test]
fn a_map_cut_anywhere_gives_the_same_error() {
    let text = random_map(&mut Rng::new(5)) + &random_map(&mut Rng::new(8)).replace('\u{feff}', "");
    assert!(text.len() > 2000);
    for length in 0..text.len() {
        compare(&text.as_bytes()[..length], &MapOptions::default(), 16 + length % 50, &format!("cut at {length}"));
    }
}

const SLAB: &str = "{\n( 0 0 0 ) ( 0 1 0 ) ( 0 0 1 ) stone 0 0 0 1 1\n( 8 0 0 ) ( 8 0 1 ) ( 8 1 0 ) s 0 0 0 1 1\n}\n";
const SLAB3: &str = "{ brushDef3 { ( 1 0 0 -8 ) ( ( 1 0 0 ) ( 0 1 0 ) ) \"s\" 0 0 0 } }\n";

fn stream(text: &str) -> Result<MapSummary, MapError> {
    let mut builder = TreeBuilder::default();
    let result = stream_map(text.as_bytes(), "m", &MapOptions::default(), &mut builder);
    result.map_err(StreamError::into_input)
}

#[test]
fn keys_that_come_too_late_are_one_clear_error() {
    let error = |text: &str| stream(text).expect_err("late").to_string();
    assert_eq!(
        error(&format!("{{\n\"classname\" \"a\"\n{SLAB}\"classname\" \"b\"\n}}")),
        "m:7: found the key `classname` with the value `b`, \
         expected it before the brushes of its entity, which were taken for those of `a`"
    );
    assert_eq!(
        error(&format!("{{\n\"classname\" \"a\"\n{SLAB3}\"origin\" \"1 2 3\"\n}}")),
        "m:4: found the key `origin` with the value `1 2 3`, \
         expected it before the brushes of its entity, which were taken for those of the origin `0 0 0`"
    );
    // what changes nothing is no error
    for text in [
        format!("{{ \"classname\" \"a\" {SLAB} \"classname\" \"a\" }}"),
        format!("{{ \"classname\" \"a\" \"classname\" \"b\" {SLAB} }}"),
        format!("{{ \"classname\" \"a\" {SLAB} \"origin\" \"1 2 3\" }}"),
        format!("{{ \"classname\" \"worldspawn\" {SLAB3} \"origin\" \"1 2 3\" }}"),
        format!("{{ \"classname\" \"a\" {SLAB3} \"origin\" \"0 0 0\" \"origin\" \"here\" }}"),
        format!("{{ {SLAB3} \"origin\" \"1 2 3\" {SLAB} \"classname\" \"a\" }}"),
    ] {
        assert!(compare(text.as_bytes(), &MapOptions::default(), 16, &text).is_some_and(|map| map.is_ok()), "{text}");
    }
}

#[test]
fn the_first_of_two_errors_is_told() {
    let far = "{ ( 1e300 0 0 ) ( 0 0 0 ) ( 0 1e300 1e-300 ) s 0 0 0 1 1 }\n";
    for (text, line) in [
        (format!("{{ \"classname\" \"a\"\n{far}{{ ( x"), 2),
        (format!("{{ \"classname\" \"a\"\n{far}"), 2),
        // its class, which might be one to skip, is not known
        (format!("{{ \n{far}{{ ( x"), 3),
    ] {
        let error = compare(text.as_bytes(), &MapOptions::default(), 16, &text).expect("no late key");
        assert_eq!(error.expect_err("two errors").line(), Some(line), "{text}");
    }
}

#[test]
fn warnings_name_a_thousand_lines() {
    let mut text = "{ \"classname\" \"worldspawn\"\n".to_owned();
    for _ in 0..1234 {
        text += "{ patchDef2 { } }\n";
    }
    text += "}";
    for count in [1000, 1234] {
        let text = text.replacen("{ patchDef2 { } }\n", "", 1234 - count);
        let summary = compare(text.as_bytes(), &MapOptions::default(), 100, "patches").expect("taken").expect("a map");
        let message = &summary.warnings[0].message;
        let end = if count == 1000 { "1000, 1001)" } else { "1000, 1001 and 234 more)" };
        assert!(message.starts_with(&format!("left out {count} patches")) && message.ends_with(end), "{message}");
        assert_eq!((summary.warnings[0].left_out, summary.patches_left_out), (count, count));
    }
}

/// A map of the same brush a number of times, made as it is read; then what follows it.
struct Endless {
    brushes: usize,
    piece: Vec<u8>,
    at: usize,
    read: u64,
    end: Option<&'static [u8]>,
}

impl Endless {
    fn new(brushes: usize, end: &'static [u8]) -> Self {
        Self { brushes, piece: b"{ \"classname\" \"worldspawn\"\r\n".to_vec(), at: 0, read: 0, end: Some(end) }
    }
}

impl Read for Endless {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.at == self.piece.len() {
            self.at = 0;
            if self.brushes > 0 {
                self.brushes -= 1;
                self.piece = SLAB.as_bytes().to_vec();
            } else {
                self.piece = self.end.take().unwrap_or_default().to_vec();
            }
        }
        let count = (&self.piece[self.at..]).read(buffer)?;
        self.at += count;
        self.read += count as u64;
        Ok(count)
    }
}

/// Counts.
#[derive(Default)]
struct Count {
    brushes: usize,
    last_line: u32,
}

impl TreeSink for Count {
    type Error = String;

    fn begin(&mut self, operation: Operation) -> Result<(), String> {
        assert_eq!((operation, self.brushes), (Operation::Union, 0));
        Ok(())
    }

    fn leaf(&mut self, _: Brush, line: Option<std::num::NonZeroU32>) -> Result<(), String> {
        self.brushes += 1;
        self.last_line = line.map_or(0, std::num::NonZeroU32::get);
        if self.brushes == 5_000_000 { Err("enough".to_owned()) } else { Ok(()) }
    }

    fn end(&mut self) -> Result<(), String> {
        Ok(())
    }
}

#[test]
fn a_long_map_needs_a_window_alone() {
    let brushes = 1_100_000;
    let mut window = Window::new(Endless::new(brushes, b"}\r\n"), WINDOW);
    let mut count = Count::default();
    let summary = stream_window(&mut window, "m", &MapOptions::default(), &mut count).expect("a map");
    assert_eq!((summary.brushes, count.brushes, count.last_line as usize), (brushes, brushes, 2 + 4 * (brushes - 1)));
    assert!(window.bytes_read() > 100_000_000 && window.sizes().0 == WINDOW, "{}", window.sizes().0);
}

#[test]
fn a_window_grows_to_the_longest_brush_and_is_small_again() {
    let long = format!("{{\n{}}}\n", "( 0 0 0 ) ( 0 1 0 ) ( 0 0 1 ) stone 0 0 0 1 1\n".repeat(1000));
    let comment = format!("//{}\n{}", "long".repeat(100_000), " \n".repeat(100_000));
    for text in
        [format!("{{ {SLAB}{long}{SLAB} }}"), format!("{comment}{{ \"a\" \"b\" {comment}{SLAB}{comment}}}{comment}")]
    {
        let mut window = Window::new(text.as_bytes(), 1000);
        let mut builder = TreeBuilder::default();
        stream_window(&mut window, "m", &MapOptions::default(), &mut builder).expect("a map");
        assert!(builder.finish() == read_map(text.as_bytes(), "m", &MapOptions::default()).expect("a map").model.tree);
        let least = if text.contains("//") { 1000 } else { long.len() };
        assert!((least..=2 * least).contains(&window.sizes().0), "{} {least}", window.sizes().0);
        assert!(window.sizes().1 <= 2 * least, "{}", window.sizes().1);
    }
}

#[test]
fn an_error_ends_the_reading() {
    // of syntax: the rest of the map is not read
    let mut map = Endless::new(0, b"( stone");
    map.brushes = usize::MAX;
    map.piece = b"{ \"classname\" \"worldspawn\"\n{ ( 0 0 zero ) ".to_vec();
    let error = stream_map(&mut map, "m", &MapOptions::default(), &mut Count::default()).expect_err("no number");
    assert_eq!(error.to_string(), "m:2: found `zero`, expected a finite decimal number");
    assert!(map.read <= WINDOW as u64, "{}", map.read);
    // of the sink
    let mut map = Endless::new(usize::MAX, b"");
    let error = stream_map(&mut map, "m", &MapOptions::default(), &mut Full).expect_err("no room");
    assert_eq!(error.to_string(), "no room");
    assert!(map.read <= WINDOW as u64, "{}", map.read);
}

/// Takes nothing.
struct Full;

impl TreeSink for Full {
    type Error = io::Error;

    fn begin(&mut self, _: Operation) -> io::Result<()> {
        Ok(())
    }

    fn leaf(&mut self, _: Brush, _: Option<std::num::NonZeroU32>) -> io::Result<()> {
        Err(io::Error::other("no room"))
    }

    fn end(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_reader_that_fails_is_named() {
    struct Broken;
    impl Read for Broken {
        fn read(&mut self, _: &mut [u8]) -> io::Result<usize> {
            Err(io::Error::new(ErrorKind::ConnectionReset, "the line went dead"))
        }
    }
    let begin = format!("{{ \"classname\" \"a\" {SLAB}");
    let map = begin.as_bytes().chain(Broken);
    let mut builder = TreeBuilder::default();
    let error = stream_map(map, "far.map", &MapOptions::default(), &mut builder).expect_err("broken").into_input();
    let bytes = begin.len();
    assert_eq!(
        error.to_string(),
        format!(
            "far.map: found an error after {bytes} bytes (the line went dead), \
             expected a text that can be read to its end"
        )
    );
    assert_eq!(error.line(), None);
}
