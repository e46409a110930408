//! Each variant of the syntax of a map.

use std::num::NonZeroU32;

use glam::{DVec2, DVec3};
use planecut_csg::{Model, TextureUnit, Tree};
use planecut_import::map::{MapImport, MapOptions, read_map};

const POINTS: &str = "( 0 0 0 ) ( 0 1 0 ) ( 0 0 1 )";

fn read(text: impl AsRef<[u8]>) -> MapImport {
    read_with(text, &MapOptions::default())
}

fn read_with(text: impl AsRef<[u8]>, options: &MapOptions) -> MapImport {
    read_map(text.as_ref(), "m", options).unwrap_or_else(|error| panic!("{error}"))
}

/// A world of one brush with these faces.
fn world(faces: &[String]) -> String {
    format!("{{\n\"classname\" \"worldspawn\"\n{{\n{}\n}}\n}}\n", faces.join("\n"))
}

/// The material name of each face, brush by brush.
fn textures(model: &Model) -> Vec<Vec<&str>> {
    let name = |id: planecut_csg::MaterialId| model.materials[id.0 as usize].name.as_str();
    model.tree.brushes().iter().map(|brush| brush.faces.iter().map(|face| name(face.material)).collect()).collect()
}

fn warnings(import: &MapImport) -> Vec<String> {
    import.warnings.iter().map(ToString::to_string).collect()
}

#[test]
fn every_dialect_of_a_face() {
    let axes = "[ 1 0 0 -12.5 ] [ 0 -1 0 8 ]";
    let dialects = [
        ("Quake", format!("{POINTS} a 1 2 3 4 5")),
        ("Hexen II", format!("{POINTS} a 1 2 3 4 5 -1")),
        ("Quake 2", format!("{POINTS} a 1 2 3 4 5 134217728 16384 700")),
        ("Daikatana", format!("{POINTS} a 1 2 3 4 5 0 0 0 255 128 0")),
        ("Valve 220", format!("{POINTS} a {axes} 0 1 1")),
        ("Valve 220 in Hexen II", format!("{POINTS} a {axes} 0 1 1 0")),
        ("Valve 220 in Quake 2", format!("{POINTS} a {axes} 30.5 0.25 0.25 1 2 3")),
        ("Valve 220 in Daikatana", format!("{POINTS} a {axes} 30.5 0.25 0.25 1 2 3 4 5 6")),
        ("no spaces", "(0 0 0)(0 1 0)(0 0 1) a [1 0 0 0][0 1 0 0]0 1 1".to_owned()),
        ("one token a line", format!("{POINTS} a 1 2 3 4 5").replace(' ', "\n")),
        ("tabs", format!("{POINTS} a 1 2 3 4 5").replace(' ', "\t")),
        ("CR alone", format!("{POINTS} a 1 2 3 4 5").replace(' ', "\r")),
        ("exponents and signs", "( 0e5 -0 +0 ) ( 0 1e0 0. ) ( .0 -0.00 10E-1 ) a 1e-5 -2. +.3 4 5".to_owned()),
    ];
    let reference = read(world(&[dialects[0].1.clone()])).model.tree.brushes()[0].faces[0];
    for (dialect, face) in &dialects {
        let import = read(world(std::slice::from_ref(face)));
        assert_eq!(import.model.tree.brushes().len(), 1, "{dialect}");
        assert_eq!(import.model.tree.brushes()[0].faces, [reference], "{dialect}");
        assert!(import.warnings.is_empty(), "{dialect}");
    }
    // All of them one after the other in the same brush.
    let faces: Vec<String> = dialects.iter().map(|(_, face)| face.clone()).collect();
    assert_eq!(read(world(&faces)).model.tree.brushes()[0].faces, vec![reference; dialects.len()]);
}

#[test]
fn the_normal_points_outward() {
    // The left side of a body that extends to positive x.
    let model = read(world(&[format!("{POINTS} a 0 0 0 1 1")])).model;
    let plane = model.tree.brushes()[0].faces[0].half_space;
    assert_eq!((plane.normal().to_array(), plane.offset()), ([-1.0, 0.0, 0.0], 0.0));
}

#[test]
fn texture_names_of_all_kinds() {
    let names = [
        "+0slip",
        "*water1",
        "{fence",
        "{0}",
        "}",
        "(x)",
        "[",
        "sky,4",
        "gothic_block/blocks18c_3",
        "__TB_empty",
        "a//b",
        "12",
        "-1",
        "tex\\path",
        "#clip",
        ";",
        "~light",
        "!lava",
        "\u{e9}t\u{e9}",
    ];
    let faces: Vec<String> = names.iter().map(|name| format!("{POINTS} {name} 0 0 0 1 1")).collect();
    assert_eq!(textures(&read(world(&faces)).model), [names]);
}

#[test]
fn quoted_texture_names() {
    for (written, name) in [
        (r#""plain""#, "plain"),
        (r#""with space""#, "with space"),
        (r#""say \"hi\" now""#, r#"say "hi" now"#),
        (r#""back\\slash \ and {brace""#, r"back\slash \ and {brace"),
        (r#""""#, ""),
        (r#""// no comment""#, "// no comment"),
    ] {
        let face = format!("{POINTS} {written} 0 0 0 1 1");
        assert_eq!(textures(&read(world(&[face])).model), [[name]], "{written}");
    }
}

#[test]
fn bytes_outside_utf8_are_latin_1() {
    let text = world(&[format!("{POINTS} caf? 0 0 0 1 1"), format!("{POINTS} caf\u{e9} 0 0 0 1 1")]);
    let bytes: Vec<u8> = text.bytes().map(|b| if b == b'?' { 0xe9 } else { b }).collect();
    let model = read(bytes).model;
    assert_eq!(textures(&model), [["caf\u{e9}", "caf\u{e9}"]]);
    assert_eq!(model.materials.len(), 1);
}

#[test]
fn materials_in_order_of_appearance_each_once() {
    let face = |name| format!("{POINTS} {name} 0 0 0 1 1");
    let text = world(&[face("b"), face("a"), face("b")]) + &world(&[face("A"), face("a"), face("c")]);
    let model = read(text).model;
    assert_eq!(textures(&model), [["b", "a", "b"], ["A", "a", "c"]]);
    let names: Vec<&str> = model.materials.iter().map(|material| material.name.as_str()).collect();
    assert_eq!(names, ["b", "a", "A", "c"]);
}

#[test]
fn comments_and_line_ends() {
    let text = format!(
        "// \"quoted\" {{ (\n{{ // world\n\"classname\"// key\n\"worldspawn\"\n// brush 0\n{{\n// face\n{POINTS} a 0 0 0 1 1 // end\n}}//\n}}\n//"
    );
    for end in ["\n", "\r\n", "\r"] {
        let import = read(text.replace('\n', end));
        assert_eq!((import.entities, import.model.tree.brushes().len()), (1, 1));
        assert_eq!(import.model.tree.source_line(0), NonZeroU32::new(6), "line ends {end:?}");
    }
}

#[test]
fn byte_order_mark_and_the_end_of_dos_files() {
    let text = world(&[format!("{POINTS} a 0 0 0 1 1")]);
    assert_eq!(read(format!("\u{feff}{text}\u{1a}\0\0")), read(text));
}

#[test]
fn keys_and_values() {
    for pairs in [
        r#""wad" "c:\quake\id1\gfx.wad""#,
        "\"path\" \"c:\\maps\\\"",
        "\"path\" \"c:\\maps\\\"\r",
        r#""message" "he said \"go\" {now}""#,
        "\"message\" \"two\nlines\"",
        r#""" """#,
        r#""a""b"   "c" "d""#,
        "\"bronze\" \"\u{81}\u{ff}\"",
    ] {
        let text = format!("{{\n{pairs}\n\"classname\" \"func_wall\"\n{{\n{POINTS} a 0 0 0 1 1\n}}\n}}");
        let name = read(text).model.tree.brushes()[0].name.clone();
        assert_eq!(name.as_deref(), Some("func_wall #0"), "{pairs}");
    }
}

/// The names of the brushes and the lines on which they begin; 0 for none.
fn names_and_lines(tree: &Tree) -> Vec<(Option<&str>, u32)> {
    let lines = tree.source_lines().map(|line| line.map_or(0, NonZeroU32::get));
    tree.brushes().iter().map(|brush| brush.name.as_deref()).zip(lines).collect()
}

#[test]
fn names_and_lines_of_brushes() {
    let brush = format!("{{\n{POINTS} a 0 0 0 1 1\n}}\n");
    let text = format!(
        "{{\n\"classname\" \"worldspawn\"\n{brush}{brush}}}\n{{\n\"classname\" \"light\"\n}}\n{{\n{brush}\"classname\" \"func_door\"\n{brush}}}\n{{\n{brush}}}\n"
    );
    let import = read(&text);
    let found = names_and_lines(&import.model.tree);
    let door = Some("func_door #2");
    assert_eq!(found, [(None, 3), (None, 6), (door, 14), (door, 18), (Some("entity #3"), 23)]);
    assert_eq!((import.entities, import.brushes_read), (4, 5));
    for (_, line) in found {
        assert_eq!(text.lines().nth(line as usize - 1), Some("{"), "line {line}");
    }
}

#[test]
fn brushes_outside_any_entity_belong_to_the_world() {
    let brush = format!("{{ {POINTS} a 0 0 0 1 1 }}\n");
    let options = MapOptions { world_only: true, ..MapOptions::default() };
    let import = read_with(format!("{brush}{brush}{{ \"classname\" \"func_wall\" {brush} }} {brush}"), &options);
    assert_eq!((import.entities, import.brushes_read, import.brushes_skipped), (1, 4, 1));
    assert_eq!(names_and_lines(&import.model.tree), [(None, 1), (None, 2), (None, 4)]);
}

#[test]
fn brush_primitives_with_points_are_brushes() {
    let matrix = "( ( 0.03 0 1 ) ( 0 0.03 -2 ) )";
    let faces = format!("{POINTS} {matrix} common/caulk 0 0 0\n{POINTS} {matrix} (x)");
    let import = read(format!("{{\n\"classname\" \"worldspawn\"\n{{\nbrushDef\n{{\n{faces}\n}}\n}}\n}}"));
    assert_eq!(textures(&import.model), [["common/caulk", "(x)"]]);
    assert_eq!((import.model.tree.source_line(0), import.primitives_left_out), (NonZeroU32::new(3), 0));
    assert!(import.warnings.is_empty());
    let plain = read(world(&[format!("{POINTS} a 0 0 0 1 1")])).model.tree.brushes()[0].faces[0].half_space;
    assert!(import.model.tree.brushes()[0].faces.iter().all(|face| face.half_space == plain));
    // the face looks to -x: on it, pictures go to -y and down
    for axes in &import.textures[0] {
        let axes = axes.expect("axes");
        assert_eq!(axes.unit, TextureUnit::Pictures);
        assert_eq!(axes.at(DVec3::new(0.0, 10.0, 20.0)), DVec2::new(0.03 * -10.0 + 1.0, 0.03 * -20.0 - 2.0));
    }
}

#[test]
fn other_primitives_are_left_out_with_a_warning() {
    let patch =
        |keyword| format!("{{\n{keyword}\n{{\n\"my tex}}\"\n( 3 3 0 0 0 )\n(\n((-64 -64 4 0   0 ))\n)\n}}\n}}\n");
    let other = "{\nmeshDef\n{\n( 0 0 1 -64 ) ( ( 0.03 0 0 ) ( 0 0.03 0 ) ) \"textures/a\" 0 0 0\n}\n}\n";
    let brush = format!("{{\n{POINTS} a 0 0 0 1 1\n}}\n");
    let text = format!(
        "Version 2\n{{\n\"classname\" \"worldspawn\"\n{brush}{}{other}{}{}{}{brush}}}\n",
        patch("patchDef2"),
        patch("patchDef3"),
        patch("terrainDef"),
        patch("patchDefNew"),
    );
    let import = read(&text);
    assert_eq!((import.model.tree.brushes().len(), import.patches_left_out, import.primitives_left_out), (2, 3, 2));
    let line = |keyword| 1 + text.lines().position(|line| line == keyword).expect("in the text");
    let expected = [
        format!(
            "line {0}: left out 3 patches, the first of them here (lines {0}, {1}, {2})",
            line("patchDef2"),
            line("patchDef3"),
            line("patchDefNew")
        ),
        format!(
            "line {0}: left out 2 primitives that are not supported, the first of them here (lines {0}, {1})",
            line("meshDef"),
            line("terrainDef")
        ),
    ];
    assert_eq!(warnings(&import), expected);
    assert_eq!(import.warnings.iter().map(|warning| warning.left_out).collect::<Vec<_>>(), [3, 2]);
}

/// A brush of Doom 3: planes by four numbers, each with `a x + b y + c z + d <= 0` inside.
fn doom_brush(planes: &[&str]) -> String {
    let face = |plane: &&str| format!("( {plane} ) ( ( 0.25 0 0.5 ) ( 0 0.125 0 ) ) \"textures/a\" 0 0 0\n");
    format!("{{\nbrushDef3\n{{\n{}}}\n}}\n", planes.iter().map(face).collect::<String>())
}

/// 2 x 3 x 4, from (1, 2, 3) to (3, 5, 7).
const DOOM_BOX: [&str; 6] = ["-1 0 0 1", "1 0 0 -3", "0 -1 0 2", "0 1 0 -5", "0 0 -1 3", "0 0 1 -7"];

fn volume_of(import: &MapImport) -> f64 {
    planecut_csg::evaluate(&import.model).expect("a mesh").solid.volume
}

#[test]
fn planes_by_four_numbers_bound_brushes() {
    let read_brush = |planes: &[&str]| {
        let import = read(format!("Version 2\n{{\n\"classname\" \"worldspawn\"\n{}}}\n", doom_brush(planes)));
        assert_eq!((import.brushes_read, import.primitives_left_out), (1, 0));
        import
    };
    assert_eq!(volume_of(&read_brush(&DOOM_BOX)), 24.0);
    // x + y + z <= 13 cuts off the tetrahedron with edges of 2 along the axes at (3, 5, 7)
    let cut = [&DOOM_BOX[..], &["0.5 0.5 0.5 -6.5"]].concat();
    let volume = volume_of(&read_brush(&cut));
    assert!((volume - (24.0 - 8.0 / 6.0)).abs() < 1e-12, "{volume}");
    // decimals are taken as such: -0.1 and 0.3 are no doubles, and their planes are those of x = 3
    let faces = &read_brush(&["0.1 0 0 -0.3", "1 0 0 -3"]).model.tree.brushes()[0].faces.clone();
    assert_eq!(faces[0].half_space, faces[1].half_space);
    let long = volume_of(&read_brush(&[
        "-1.0000000 0 0 1.00000001",
        "1 0 0 -3",
        "0 -1 0 2",
        "0 1 0 -5",
        "0 0 -1 3",
        "0 0 1 -7",
    ]));
    assert!((long - (2.0 - 1e-8) * 12.0).abs() < 1e-12, "{long}");
    let nothing = read_brush(&["0 0 0 1", "1 0 0 -3"]);
    assert_eq!(nothing.faces_left_out, 1, "a face without a normal");
}

#[test]
fn planes_by_four_numbers_are_relative_to_the_origin_of_their_entity() {
    let entity = |class: &str, origin: &str| {
        let text = format!("{{\n{}\"classname\" \"{class}\"\n\"origin\" \"{origin}\"\n}}\n", doom_brush(&DOOM_BOX));
        read(format!("Version 2\n{text}"))
    };
    let centroid = |import: &MapImport| planecut_csg::evaluate(&import.model).expect("a mesh").solid.centroid;
    let at_rest = DVec3::new(2.0, 3.5, 5.0);
    let near = |a: DVec3, b: DVec3| assert!(a.abs_diff_eq(b, 1e-12), "{a} {b}");
    near(centroid(&entity("worldspawn", "10 20 30")), at_rest);
    let moved = entity("func_static", "10 -20.5 30");
    near(centroid(&moved), at_rest + DVec3::new(10.0, -20.5, 30.0));
    near(centroid(&entity("func_static", "10 20")), at_rest);
    // textures go with the brush
    let [at, there] = [entity("worldspawn", "0 0 0"), moved].map(|import| import.textures[0][0].expect("axes"));
    let point = DVec3::new(1.0, 4.0, 6.0);
    let (a, b) = (at.at(point), there.at(point + DVec3::new(10.0, -20.5, 30.0)));
    assert!(a.abs_diff_eq(b, 1e-12), "{a} {b}");
}

#[test]
fn comments_begin_with_two_slashes_or_a_semicolon() {
    let faces = [format!("; a face (\n{POINTS} a 0 0 0 1 1 ; its end {{"), format!("{POINTS} a;b 0 0 0 1 1 // \"")];
    let import = read(format!("; QuArK\r\n;{{\r{}", world(&faces)));
    assert_eq!(textures(&import.model), [["a", "a;b"]]);
}

#[test]
fn a_map_without_brushes_is_no_error() {
    let import = read("{ \"classname\" \"worldspawn\" }");
    assert_eq!((import.entities, import.model.tree.brushes().len()), (1, 0));
    assert_eq!(warnings(&import), ["the map holds no brushes"]);
}

/// One brush for each class and texture given; the second face has the second texture.
fn classes_and_textures() -> String {
    let brush = |a: &str, b: &str| format!("{{\n{POINTS} {a} 0 0 0 1 1\n{POINTS} {b} 0 0 0 1 1\n}}\n");
    let entity = |class: &str, brushes: &str| format!("{{\n\"classname\" \"{class}\"\n{brushes}}}\n");
    [
        entity("worldspawn", &(brush("wall", "wall") + &brush("CLIP", "clip") + &brush("wall", "clip"))),
        entity("func_group", &brush("hint", "hintskip")),
        entity("func_detail_wall", &brush("wall", "trim")),
        entity("trigger_once", &brush("trigger", "trigger")),
        entity("func_door", &brush("door", "door")),
    ]
    .concat()
}

fn kept(options: &MapOptions) -> (Vec<Vec<String>>, usize) {
    let import = read_with(classes_and_textures(), options);
    assert_eq!(import.brushes_read, import.model.tree.brushes().len() + import.brushes_skipped);
    let textures = textures(&import.model);
    (textures.iter().map(|brush| brush.iter().map(ToString::to_string).collect()).collect(), import.brushes_skipped)
}

#[test]
fn world_only_takes_what_compilers_merge_into_the_world() {
    let (textures, skipped) = kept(&MapOptions { world_only: true, ..MapOptions::default() });
    assert_eq!(
        textures,
        [["wall", "wall"], ["CLIP", "clip"], ["wall", "clip"], ["hint", "hintskip"], ["wall", "trim"]]
    );
    assert_eq!(skipped, 2);
}

#[test]
fn brushes_are_skipped_when_all_textures_match() {
    let skip_textures = ["clip", "hint*", "TRIGGE?"].map(str::to_owned).to_vec();
    let (textures, skipped) = kept(&MapOptions { skip_textures, ..MapOptions::default() });
    assert_eq!(textures, [["wall", "wall"], ["wall", "clip"], ["wall", "trim"], ["door", "door"]]);
    assert_eq!(skipped, 3);
}

#[test]
fn entities_are_skipped_by_class() {
    let skip_classes = ["trigger_*", "FUNC_door"].map(str::to_owned).to_vec();
    let (textures, skipped) = kept(&MapOptions { skip_classes, ..MapOptions::default() });
    assert_eq!((textures.len(), skipped), (5, 2));
}

#[test]
fn skipped_brushes_leave_no_trace() {
    let options = MapOptions { skip_textures: vec!["clip".to_owned()], ..MapOptions::default() };
    let faces =
        [format!("{POINTS} clip 0 0 0 1 1"), "( 1e300 0 0 ) ( 1e300 1 0 ) ( 1e300 0 1 ) clip 0 0 0 1 1".to_owned()];
    let import = read_with(world(&faces), &options);
    assert!(import.model.materials.is_empty());
    assert_eq!(warnings(&import), ["no brush is left: 1 read, 1 of them skipped by option"]);
    assert!(read_map(world(&faces).as_bytes(), "m", &MapOptions::default()).is_err(), "it counts when it is kept");
}
