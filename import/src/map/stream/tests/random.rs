//! Random maps of all dialects, mixed.

use std::fmt::Write as _;

use planecut_testkit::random::Rng;

/// A number as editors write them.
fn number(random: &mut Rng) -> String {
    let value = random.below(4000) as f64 - 2000.0;
    match random.below(5) {
        0 => format!("{:.6}", value / 7.0),
        1 => format!("{:e}", value / 16.0),
        2 => format!("{}", value / 3.0),
        _ => format!("{value}"),
    }
}

fn numbers(random: &mut Rng, count: usize) -> String {
    (0..count).map(|_| number(random)).collect::<Vec<_>>().join(" ")
}

/// White space, now and then with a comment in it.
fn blank(random: &mut Rng) -> &'static str {
    const BLANKS: [&str; 12] =
        [" ", "\n", "\r\n", "\r", "\t", " \r\n\r\n", "\n\n\r", "// a { \"b\"\n", "; c } d\r\n", " //\r", "  ", "\n"];
    BLANKS[random.below(BLANKS.len())]
}

fn face(random: &mut Rng, form: usize) -> String {
    const TEXTURES: [&str; 7] = ["stone", "{fence", "\"a \\\"b\\\"\"", "clip", "*water", ";odd", "clip2"];
    let texture = TEXTURES[random.below(TEXTURES.len())];
    let points = |random: &mut Rng| {
        if random.below(30) == 0 {
            return "( 0 0 0 ) ( 1 1 1 ) ( 2 2 2 )".to_owned();
        }
        (0..3).map(|_| format!("( {} )", numbers(random, 3))).collect::<Vec<_>>().join(blank(random))
    };
    let matrix = |random: &mut Rng| format!("( ( {} ) ( {} ) )", numbers(random, 3), numbers(random, 3));
    // a texture may begin with a semicolon, so that a comment before it may not
    let between = Some(blank(random)).filter(|blank| !blank.starts_with(';')).unwrap_or(" ");
    match form {
        0 => {
            let count = [5, 6, 8, 11][random.below(4)];
            format!("{}{between}{texture} {}", points(random), numbers(random, count))
        }
        1 => {
            let count = [3, 4, 6, 9][random.below(4)];
            let axes = format!("[ {} ] [ {} ]", numbers(random, 4), numbers(random, 4));
            format!("{}{between}{texture} {axes} {}", points(random), numbers(random, count))
        }
        2 => format!("{} {}{between}{texture} 0 0 0", points(random), matrix(random)),
        _ => format!("( {} ) {}{between}{texture} 0 0 0", numbers(random, 4), matrix(random)),
    }
}

fn brush(random: &mut Rng) -> String {
    let form = random.below(4);
    let mut text = "{".to_owned();
    if random.below(12) == 0 {
        let kind = ["patchDef2", "terrainDef", "PatchDef3"][random.below(3)];
        return format!("{{{kind}{}{{ common/caulk ( 3 3 0 ) \"}}\" {{ }} }}{}}}", blank(random), blank(random));
    }
    if form > 1 {
        text += [" brushDef {", "\nbrushDef3\n{"][form - 2];
    }
    for _ in 0..1 + random.below(7) {
        text += blank(random);
        text += &face(random, form);
        text += "\n";
    }
    text += if form > 1 { "} }" } else { "}" };
    text
}

/// A map of all dialects; the class of an entity comes first, or at its end, or not at all.
pub(super) fn random_map(random: &mut Rng) -> String {
    const CLASSES: [&str; 5] = ["worldspawn", "func_group", "trigger_once", "func_wall", "light"];
    let mut text = ["", "\u{feff}", "Version 2\n"][random.below(3)].to_owned();
    for _ in 0..random.below(6) {
        text += blank(random);
        if random.below(8) == 0 {
            text += &brush(random);
            continue;
        }
        let class = format!("\"classname\" \"{}\"", CLASSES[random.below(CLASSES.len())]);
        let place = random.below(4);
        text += "{\n";
        if random.below(3) == 0 {
            let _ = writeln!(text, "\"origin\" \"{}\"", numbers(random, 3));
        }
        if place > 1 {
            let _ = writeln!(text, "{class}{}\"wad\" \"c:\\q\\\"", blank(random));
        }
        for _ in 0..random.below(5) {
            text += &brush(random);
            text += blank(random);
        }
        if place == 1 {
            text += &class;
        }
        text += "\n}";
    }
    text + blank(random)
}
