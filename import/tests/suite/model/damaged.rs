//! Damaged model files: a model or an error with a line, never a panic.

use planecut_import::model::{ModelError, ModelOptions, read_model};
use planecut_testkit::random::Rng;

/// Every kind of value, in a few lines.
const WHOLE: &str = r#"{
  "planecut": 1,
  "materials": {"steel": {"color": [0.5, 0.5, 0.5], "metallic": 1, "roughness": 0.4}},
  "parameters": {"width": 4, "half": "=width / 2", "n": "=max(3, round(half * 2.2))"},
  "outlines": {"ring": {"difference": [{"circle": {"radius": 2, "segments": 8}}, {"circle": {"radius": 1}}]}},
  "parts": {"hole": {"cylinder": {"height": 3, "radius": "=half / 4", "segments": 8}}},
  "model": {
    "material": "steel", "name": "plate \"é\"", "matrix": [[1, 0, 0, 5], [0, 1, 0, 0], [0, 0, 1, 0]],
    "difference": [
      {"box": {"min": [0, 0, 0], "max": ["=width", 4, 1]}},
      {"use": "hole", "with": {"width": 2}, "transform": [{"translate": [1, 1, -1]}, {"rotate": [0, 0, 90]}]},
      {"halfspaces": [[1, 1, 1, 1.5e0]], "transform": [{"mirror": [1, 0, 0]}, {"scale": [1, 2, -1]}]},
      {"instances": {"of": {"points": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]}, "at": [[1, 2, 3], {"matrix": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]}]}},
      {"ring": {"of": {"sphere": {"radius": 1, "segments": 6}}, "count": "=n"}},
      {"halfspaces": [[1, 0, 0, 1], [0, 1, 0, 1]], "materials": ["steel", null]},
      {"mesh": {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], "triangles": [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], "materials": ["steel", null, null, "steel"], "rule": "odd"}},
      {"xor": [{"complement": {"wedge": {"size": [1, 1, 1]}}}, {"intersection": [{"use": "hole"}]}]}
    ]
  }
}
"#;

/// Reads; the error, if there is one, must be in one line and within the text.
#[track_caller]
fn survives(text: &[u8], what: &str) -> bool {
    match read_model(text, "m.json", &ModelOptions::default()) {
        Ok(_) => true,
        Err(error) => {
            let lines = 1 + text.iter().filter(|byte| **byte == b'\n' || **byte == b'\r').count() as u32;
            let line = error.line().unwrap_or_else(|| panic!("{what}: {error}"));
            assert!((1..=lines).contains(&line), "{what}: {error}");
            let message = error.to_string();
            assert!(message.contains(": found ") && message.contains(", expected "), "{what}: {message}");
            assert!(!message.contains(['\n', '\r', '\x1b']) && message.len() < 2000, "{what}: {message:?}");
            assert!(!matches!(error, ModelError::Parameter { .. }), "{what}: {message}");
            false
        }
    }
}

#[test]
fn the_whole_file_is_read() {
    assert!(survives(WHOLE.as_bytes(), "whole"), "{:?}", super::support::read(WHOLE));
}

#[test]
fn a_file_cut_anywhere_is_refused() {
    let end = WHOLE.trim_end().len();
    for length in 0..end {
        assert!(!survives(&WHOLE.as_bytes()[..length], &format!("cut at {length}")), "cut at {length}");
    }
}

#[test]
fn changed_bytes_do_no_harm() {
    const BYTES: &[u8] = b"{}[]\",:=-+.eE019 \n\\\0\xff\xc3()^*/%abmnx";
    let mut random = Rng::new(1);
    let (mut read, rounds) = (0, 30_000);
    for round in 0..rounds {
        let mut text = WHOLE.as_bytes().to_vec();
        for _ in 0..=random.below(3) {
            let at = random.below(text.len());
            match random.below(4) {
                0 => text[at] = BYTES[random.below(BYTES.len())],
                1 => drop(text.remove(at)),
                2 => text.insert(at, BYTES[random.below(BYTES.len())]),
                _ => {
                    let end = (at + random.below(40)).min(text.len());
                    let piece = text[at..end].to_vec();
                    let to = random.below(text.len());
                    text.splice(to..to, piece);
                }
            }
        }
        read += usize::from(survives(&text, &format!("seed 1, round {round}")));
    }
    assert!(read > 0 && read < rounds, "{read} of {rounds} were read");
}

#[test]
fn changed_words_do_no_harm() {
    const WORDS: [&str; 46] = [
        "planecut",
        "model",
        "union",
        "difference",
        "hull",
        "complement",
        "box",
        "sphere",
        "points",
        "halfspaces",
        "use",
        "with",
        "material",
        "matrix",
        "transform",
        "instances",
        "ring",
        "array",
        "count",
        "of",
        "at",
        "min",
        "max",
        "radius",
        "segments",
        "null",
        "true",
        "0",
        "-1",
        "1e300",
        "1e-300",
        "\"=width\"",
        "\"=1/0\"",
        "[]",
        "{}",
        "[1, 2, 3]",
        "1e9",
        "extrude",
        "outline",
        "slice",
        "mesh",
        "\"l.obj\"",
        "materials",
        "vertices",
        "triangles",
        "rule",
    ];
    let mut random = Rng::new(2);
    for round in 0..10_000 {
        let mut words: Vec<&str> = WHOLE.split_inclusive([' ', ',', ':', '[', ']', '{', '}', '"']).collect();
        for _ in 0..=random.below(2) {
            let at = random.below(words.len());
            words[at] = WORDS[random.below(WORDS.len())];
        }
        survives(words.concat().as_bytes(), &format!("seed 2, round {round}"));
    }
}

#[test]
fn random_text_does_no_harm() {
    const TOKENS: [&str; 16] = [
        "{",
        "}",
        "[",
        "]",
        ",",
        ":",
        "\"planecut\"",
        "1",
        "\"model\"",
        "\"union\"",
        "-2.5e1",
        "null",
        "\"=a\"",
        "\n",
        "\"",
        "\\",
    ];
    let mut random = Rng::new(3);
    for round in 0..30_000 {
        let length = random.below(30);
        let text: String = (0..length).map(|_| TOKENS[random.below(TOKENS.len())]).collect();
        survives(text.as_bytes(), &format!("seed 3, round {round}"));
    }
}
