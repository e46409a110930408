//! `edit --serve`: an editor at the other end of two pipes.

use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Stdio};

use planecut_testkit::data::data;
use planecut_testkit::random::Rng;
use planecut_testkit::tests_on_data;
use serde_json::{Value, json};

use crate::support::{command, everything_in, finish, folder, run_with};

/// A block of 10 × 10 × 2 with a hole of 2 × 2.
const PLATE: &str = r#"{"planecut": 1, "materials": {"steel": {"color": [0.5, 0.5, 0.5]}}, "model": {"material": "steel",
  "difference": [{"box": {"min": [0, 0, 0], "max": [10, 10, 2]}}, {"box": {"min": [4, 4, -1], "max": [6, 6, 3]}}]}}"#;

/// A program that serves.
struct Served {
    child: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
}

impl Served {
    fn start(folder: &Path) -> Self {
        let plate = folder.join("plate.json");
        std::fs::write(&plate, PLATE).expect("a folder that can be written");
        Self::of(folder, &plate)
    }

    fn of(folder: &Path, input: &Path) -> Self {
        let mut child = command()
            .current_dir(folder)
            .arg("edit")
            .arg(input)
            .arg("--serve")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program starts");
        let (input, output) = (child.stdin.take().expect("a pipe"), child.stdout.take().expect("a pipe"));
        Self { child, input, output: BufReader::new(output) }
    }

    /// The answer to a line, before another one is written.
    fn ask_bytes(&mut self, line: &[u8]) -> Value {
        self.input.write_all(line).and_then(|()| self.input.write_all(b"\n")).expect("the program reads");
        let mut answer = String::new();
        self.output.read_line(&mut answer).expect("the program answers");
        assert!(answer.ends_with('\n'), "{answer}");
        serde_json::from_str(&answer).expect("JSON")
    }

    fn ask(&mut self, line: &Value) -> Value {
        self.ask_bytes(line.to_string().as_bytes())
    }

    /// The answer to what can be done.
    #[track_caller]
    fn done(&mut self, line: &Value) -> Value {
        let answer = self.ask(line);
        assert_eq!(answer["ok"], json!(true), "{line}: {answer}");
        answer
    }

    /// Ends the input; the program ends without another word.
    fn end(self) {
        let Self { child, input, mut output } = self;
        drop(input);
        let mut rest = String::new();
        output.read_line(&mut rest).expect("standard output");
        assert_eq!(rest, "");
        let ended = child.wait_with_output().expect("it ends");
        assert_eq!((ended.status.code(), String::from_utf8_lossy(&ended.stderr).as_ref()), (Some(0), ""));
    }
}

#[test]
fn edits_and_queries_are_answered_one_by_one() {
    let folder = folder();
    let mut served = Served::start(folder.path());
    let faces = served.done(&json!({"query": "faces", "buffers": true}));
    let all = faces["faces"].as_array().expect("a list");
    assert_eq!(all.len(), 10);
    assert!(all.iter().all(|face| face["material"] == "steel" && face["positions"].as_array().unwrap().len() >= 4));
    let measures = served.done(&json!({"query": "measures"}));
    assert_eq!((&measures["volume"], &measures["area"]), (&json!(192.0), &json!(288.0)));
    assert_eq!(measures["materials"], json!([{"name": "steel", "area": 288.0}]));
    let measures = served.done(&json!({"query": "measures", "volumes": true}));
    assert_eq!(measures["materials"], json!([{"name": "steel", "area": 288.0, "volume": 192.0}]));
    assert_eq!((&measures["min"], &measures["max"]), (&json!([0.0, 0.0, 0.0]), &json!([10.0, 10.0, 2.0])));

    let hit = served.done(&json!({"query": "pick", "origin": [1, 1, 9], "direction": [0, 0, -2]}))["hit"].clone();
    assert_eq!((&hit["distance"], &hit["point"], &hit["brush"]), (&json!(7.0), &json!([1.0, 1.0, 2.0]), &json!(0)));
    let face = served.done(&json!({"query": "face", "face": hit["face"]}));
    assert_eq!((&face["normal"], &face["plane"]), (&json!([0.0, 0.0, 1.0]), &hit["plane"]));
    assert_eq!(
        served.done(&json!({"query": "pick", "origin": [5, 5, 9], "direction": [0, 0, -1]}))["hit"],
        Value::Null
    );

    let preview =
        json!({"query": "preview", "edit": {"op": "move_plane", "brush": 0, "plane": 0, "offset": 12}, "id": 7});
    let preview = served.done(&preview);
    assert_eq!((&preview["volume_change"], &preview["id"]), (&json!(40.0), &json!(7)));
    let removed = served.done(&json!({"query": "preview_remove_plane", "brush": 0, "plane": 0}));
    assert_eq!(removed["gain"], "unbounded");
    let snap = json!({"query": "snap", "brush": 0, "plane": 0, "to": [1, 0, 0, 5.9], "planes": 0.2, "grid": 1});
    let snap = served.done(&snap);
    assert_eq!(
        (&snap["snap"]["to"], &snap["snap"]["target"]),
        (&json!([1.0, 0.0, 0.0, 6.0]), &json!({"brush": 1, "plane": 0}))
    );

    // a drag
    assert_eq!(served.done(&json!({"op": "begin"}))["step"], json!(true));
    for offset in 11..20 {
        let moved =
            served.done(&json!({"op": "move_plane", "brush": 0, "plane": 0, "offset": offset, "buffers": true}));
        assert_eq!(moved["faces"].as_array().map(Vec::len), moved["added"].as_array().map(Vec::len));
        assert_eq!(moved["undo"], json!(0));
    }
    let refused = served.ask(&json!({"op": "undo"}));
    assert_eq!(
        (&refused["ok"], refused["error"].as_str().unwrap().contains("a step that is open")),
        (&json!(false), true)
    );
    assert_eq!(served.done(&json!({"op": "commit"}))["undo"], json!(1));
    assert_eq!(served.done(&json!({"query": "measures"}))["volume"], json!(192.0 + 9.0 * 20.0));
    assert_eq!(served.done(&json!({"op": "undo"}))["redo"], json!(1));
    assert_eq!(served.done(&json!({"query": "measures"}))["volume"], json!(192.0));

    // the tree
    let wrapped = json!({"op": "wrap", "operands": [{"brush": 0}, {"brush": 1}], "operation": "intersection"});
    assert_eq!(served.done(&wrapped)["node"], json!(0));
    assert_eq!(served.done(&json!({"query": "measures"}))["volume"], json!(8.0));
    let copied = json!({"op": "copy_brushes", "brushes": [1], "matrix": [[1, 0, 0, 2], [0, 1, 0, 0], [0, 0, 1, 0]]});
    let copied = served.done(&copied);
    assert_eq!(copied["copies"], json!([2]));
    let tree = served.done(&json!({"query": "tree"}));
    assert_eq!(tree["parts"], json!([{"node": 0, "role": "add"}]));
    let operands = [json!([{"brush": 0}, {"node": 1}]), json!([{"brush": 1}, {"brush": 2}])];
    let nodes = tree["nodes"].as_array().expect("a list");
    assert!(nodes.iter().map(|node| &node["operands"]).eq(&operands), "{tree}");
    served.done(&json!({"op": "rename_brush", "brush": 2, "name": "peg"}));
    served.done(&json!({"op": "set_material", "brush": 2, "plane": 4, "material": "brass"}));
    let brush = served.done(&json!({"query": "brush", "brush": 2}));
    assert_eq!((&brush["name"], &brush["parent"]), (&json!("peg"), &json!(1)));
    assert_eq!(brush["planes"][4], json!({"plane": 4, "half_space": [0.0, 0.0, 1.0, 3.0], "material": "brass"}));
    let materials = served.done(&json!({"query": "materials"}));
    assert_eq!(
        (&materials["materials"][0]["name"], &materials["materials"][1]["name"]),
        (&json!("steel"), &json!("brass"))
    );
    served.end();
}

#[test]
fn what_is_wrong_with_a_line_is_answered_and_the_session_goes_on() {
    let folder = folder();
    let mut served = Served::start(folder.path());
    let before = served.done(&json!({"query": "faces", "buffers": true}));
    let huge = [b"{\"op\": \"".as_slice(), &vec![b'x'; (1 << 26) + 10], b"\"}"].concat();
    let nested = "[".repeat(100_000);
    let lines: [(&[u8], &str); 18] = [
        (b"{", "EOF while parsing"),
        (b"undo", "expected value"),
        (b"[1, 2]", "expected a JSON object"),
        (b"{} {}", "trailing characters"),
        (b"{}", "missing field `op`"),
        (b"\xff\xfe\x00", "expected"),
        (b"{\"op\": \"\xff\"}", "invalid unicode"),
        (b"{\"op\": \"explode\"}", "unknown variant `explode`"),
        (b"{\"query\": \"weather\"}", "unknown variant `weather`"),
        (b"{\"query\": \"face\", \"face\": 77}", "found face 77"),
        (b"{\"query\": \"brush\", \"brush\": 77}", "found brush 77"),
        (b"{\"op\": \"undo\", \"buffers\": 1}", "expected true or false"),
        (b"{\"op\": \"undo\", \"depth\": 1}", "unknown field `depth`"),
        (b"{\"op\": \"undo\"}", "nothing to take back"),
        (b"{\"op\": \"set_material\", \"brush\": 9, \"material\": \"gold\"}", "found brush 9"),
        (
            b"{\"query\": \"preview\", \"edit\": {\"op\": \"remove_plane\", \"brush\": 0, \"plane\": 0}}",
            "reaches infinity",
        ),
        (&huge, "more than 67108864 bytes"),
        (nested.as_bytes(), "expected a JSON object"),
    ];
    for (line, words) in lines {
        let answer = served.ask_bytes(line);
        let error = answer["error"].as_str().unwrap_or_default();
        assert_eq!(answer["ok"], json!(false), "{words}: {answer}");
        assert!(error.starts_with("found ") && error.contains(", expected ") && error.contains(words), "{error}");
    }
    let refused = served.ask(&json!({"op": "remove_brush", "brush": 5, "id": "five"}));
    assert_eq!((&refused["ok"], &refused["id"]), (&json!(false), &json!("five")));
    // empty lines say nothing, and get no answer
    served.input.write_all(b"\n  \r\n").expect("the program reads");
    assert_eq!(served.done(&json!({"query": "faces", "buffers": true})), before);
    assert_eq!(served.done(&json!({"query": "materials"}))["materials"].as_array().map(Vec::len), Some(1));
    served.end();
}

#[test]
fn a_model_is_saved_in_all_formats_or_not_at_all() {
    let folder = folder();
    let mut served = Served::start(folder.path());
    served.done(&json!({"op": "move_plane", "brush": 0, "plane": 0, "offset": 8}));
    for name in ["a.glb", "new/a.obj", "a.stl", "a.3mf", "a.ply", "a.gltf", "a.map", "a.csg", "a.json"] {
        assert_eq!(served.done(&json!({"query": "save", "output": name}))["warnings"], json!([]));
    }
    let saved = everything_in(folder.path());
    for (name, words) in [
        ("a.txt", "found a name that ends in `.txt`"),
        ("a", "found a name without an ending"),
        ("a.urdf", "`.urdf`"),
        ("-", "standard output"),
        ("new", "without an ending"),
        ("plate.json/a.glb", "expected a place that can be written"),
    ] {
        let answer = served.ask(&json!({"query": "save", "output": name}));
        assert!(answer["error"].as_str().is_some_and(|error| error.contains(words)), "{name}: {answer}");
    }
    assert_eq!(everything_in(folder.path()), saved);
    served.end();
    let read = |name: &str| std::fs::read(folder.path().join(name)).expect(name);
    std::fs::write(folder.path().join("e.jsonl"), r#"{"op": "move_plane", "brush": 0, "plane": 0, "offset": 8}"#)
        .unwrap();
    let arguments = "edit plate.json e.jsonl -o b.glb -o b.obj -o b.map -o b.json";
    finish(command().current_dir(folder.path()).args(arguments.split(' '))).expect_quiet_success();
    for (one, other) in [("a.glb", "b.glb"), ("new/a.obj", "b.obj"), ("a.map", "b.map"), ("a.json", "b.json")] {
        assert!(read(one) == read(other), "{one}");
    }
}

/// A random edit; some cannot be done.
fn random_edit(rng: &mut Rng) -> Value {
    let (brush, plane) = (rng.below(8), rng.below(8));
    let low = [0; 3].map(|_| rng.whole(-2, 9));
    let size = [0; 3].map(|_| rng.whole(1, 4));
    let planes: Vec<[f64; 4]> = (0..6)
        .map(|side| {
            let (axis, sign) = (side / 2, if side % 2 == 0 { 1.0 } else { -1.0 });
            let mut plane = [0.0; 4];
            plane[axis] = sign;
            plane[3] = if sign > 0.0 { low[axis] + size[axis] } else { -low[axis] };
            plane
        })
        .collect();
    let shift = json!([[1, 0, 0, low[0]], [0, 1, 0, low[1]], [0, 0, 1, low[2]]]);
    match rng.below(18) {
        0..3 => {
            json!({"op": "add_brush", "planes": planes, "role": rng.pick(&["add", "subtract"]), "material": "brass"})
        }
        3 => json!({"op": "add_plane", "brush": brush, "plane": [0.1 * low[0] + 0.03, 0.7, 0.3, 2.0 + size[1]]}),
        4 => json!({"op": "move_plane", "brush": brush, "plane": plane, "offset": low[0]}),
        5 => json!({"op": "move_plane", "brush": brush, "plane": plane, "to": [1, 0.2, 0.1, 7]}),
        6 => json!({"op": "remove_plane", "brush": brush, "plane": plane}),
        7 => json!({"op": "remove_brush", "brush": brush}),
        8 => json!({"op": "copy_brushes", "brushes": [brush], "matrix": shift}),
        9 => json!({"op": "mirror_brushes", "brushes": [brush], "plane": planes[0]}),
        10 => json!({"op": "array_brushes", "brushes": [brush], "matrix": shift, "count": 2}),
        11 => json!({"op": "wrap", "operands": [{"brush": brush}], "operation": "union"}),
        12 => json!({"op": "move_brush_before", "brush": brush, "before": plane}),
        13 => json!({"op": "set_role", "brush": brush, "role": rng.pick(&["add", "subtract"])}),
        14 => json!({"op": rng.pick(&["begin", "commit", "cancel"])}),
        15 => json!({"op": "set_material", "brush": brush, "material": rng.pick(&["steel", "brass", "glass"])}),
        16 => json!({"op": "undo"}),
        _ => json!({"op": "redo"}),
    }
}

#[test]
fn edits_that_are_served_and_edits_of_a_file_give_the_same_mesh() {
    for seed in 0..6 {
        let rng = &mut Rng::spread(seed);
        let folder = folder();
        let mut served = Served::start(folder.path());
        let mut list = String::new();
        let mut done = 0;
        for _ in 0..80 {
            let edit = random_edit(rng);
            let answer = served.ask(&edit);
            if answer["ok"] == json!(true) {
                done += 1;
                list += &format!("{edit}\n");
            }
        }
        assert!(done > 15, "seed {seed}: {done} edits");
        for name in ["a.glb", "a.obj"] {
            served.done(&json!({"query": "save", "output": name}));
        }
        served.end();
        std::fs::write(folder.path().join("e.jsonl"), list).expect("a folder that can be written");
        let run = "edit plate.json e.jsonl -o b.glb -o b.obj --verify --quiet";
        finish(command().current_dir(folder.path()).args(run.split(' '))).expect_quiet_success();
        let read = |name: &str| std::fs::read(folder.path().join(name)).expect(name);
        assert!(read("a.glb") == read("b.glb") && read("a.obj") == read("b.obj"), "seed {seed}");
    }
}

#[test]
fn arguments_that_do_not_fit_are_refused() {
    let folder = folder();
    std::fs::write(folder.path().join("plate.json"), PLATE).expect("a folder that can be written");
    for arguments in [
        "edit plate.json e.jsonl --serve",
        "edit plate.json --serve -o a.glb",
        "edit plate.json --serve --verify",
        "edit plate.json --serve --report r.json",
        "edit plate.json -o a.glb",
        "edit plate.json e.jsonl",
        "edit - --serve",
    ] {
        let run = run_with(folder.path(), arguments, b"");
        assert_eq!((run.status, run.stdout.len()), (2, 0), "{arguments}: {}", run.stderr);
        assert!(run.stderr.starts_with("error: "), "{arguments}: {}", run.stderr);
    }
    assert_eq!(everything_in(folder.path()), ["plate.json"]);
    let run = run_with(folder.path(), "edit plate.json --serve", b"");
    assert_eq!((run.status, run.stdout.as_slice(), run.stderr.as_str()), (0, &b""[..], ""));
}

tests_on_data!(a_live_map_takes_little_memory);

/// `e2m7` has 1,536 brushes and 17,036 triangles; asked are 60 MB for the program with all of it.
fn a_live_map_takes_little_memory() {
    const MOST_MEGABYTES: f64 = 60.0;
    let folder = folder();
    let mut served = Served::of(folder.path(), &data("map/romero/e2m7.map"));
    let before = served.done(&json!({"query": "measures"}));
    let turned = json!([[0, -1, 0, 16], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]);
    for _ in 0..50 {
        served.done(&json!({"op": "transform_brush", "brush": 7, "matrix": turned}));
        served.done(&json!({"op": "undo"}));
    }
    assert_eq!(served.done(&json!({"query": "measures"})), before);
    // where the system tells it
    if let Ok(status) = std::fs::read_to_string(format!("/proc/{}/status", served.child.id())) {
        let peak =
            status.lines().find_map(|line| line.strip_prefix("VmHWM:")?.trim().strip_suffix(" kB")).expect("the peak");
        let megabytes = peak.parse::<f64>().expect("a number") * 1024.0 / 1e6;
        assert!(megabytes < MOST_MEGABYTES, "{megabytes:.1} MB");
    }
    let Served { mut child, input, .. } = served;
    drop(input);
    assert!(child.wait().expect("it ends").success());
}
