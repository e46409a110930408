//! Quake-family maps in the Valve 220 format.
//!
//! Sources: the formats' description at Quakewiki, and what TrenchBroom writes.

use std::collections::BTreeMap;
use std::io::Write;

use glam::DVec3;

use super::Source;
use super::body::{Body, BodyFace};
use super::points::three_points;
use crate::ExportError;
use crate::decimal::push_decimal;
use crate::material::unique_names;

/// Class of the entity that holds the level itself.
const WORLD: &str = "worldspawn";
/// What TrenchBroom writes where a face has no texture.
const NO_TEXTURE: &str = "__TB_empty";

/// Writes the world first, then an entity for each `classname #n` that brushes are named after, by `n`.
pub(super) fn write(source: &Source<'_>, out: &mut dyn Write) -> Result<(), ExportError> {
    let textures = unique_names(source.materials, texture);
    let mut world = Vec::new();
    let mut entities: BTreeMap<(u32, &str), Vec<usize>> = BTreeMap::new();
    for (number, brush) in source.brushes.iter().enumerate() {
        match brush.name.as_deref().and_then(entity_of) {
            Some(entity) => entities.entry(entity).or_default().push(number),
            None => world.push(number),
        }
    }
    write!(out, "// Game: Generic\n// Format: Valve\n")?;
    write_entity(source, 0, WORLD, &world, &textures, out)?;
    for (place, ((_, class), numbers)) in (1..).zip(&entities) {
        write_entity(source, place, class, numbers, &textures, out)?;
    }
    Ok(())
}

fn write_entity(
    source: &Source<'_>,
    place: usize,
    class: &str,
    numbers: &[usize],
    textures: &[String],
    out: &mut dyn Write,
) -> Result<(), ExportError> {
    writeln!(out, "// entity {place}\n{{\n\"classname\" \"{class}\"")?;
    if class == WORLD {
        // the version tells editors how textures are laid on
        writeln!(out, "\"mapversion\" \"220\"")?;
    }
    let mut brush = 0;
    source.for_each(
        numbers,
        |body| encode(body, textures),
        |text| {
            write!(out, "// brush {brush}\n{{\n")?;
            out.write_all(&text)?;
            writeln!(out, "}}")?;
            brush += 1;
            Ok(())
        },
    )?;
    Ok(writeln!(out, "}}")?)
}

/// Class and number of an entity in a name of the form `classname #n`, which the reader of maps gives. Those of the world, and
/// what cannot stand between quotes, are none.
fn entity_of(name: &str) -> Option<(u32, &str)> {
    let (class, number) = name.rsplit_once(" #")?;
    let is_plain = |c: char| !c.is_control() && !matches!(c, '"' | '\\');
    let is_class = !class.is_empty() && class != WORLD && class.chars().all(is_plain);
    let number = number.parse().ok()?;
    is_class.then_some((number, class))
}

/// The lines of a brush's faces.
fn encode(body: &Body, textures: &[String]) -> Vec<u8> {
    let mut text = Vec::with_capacity(128 * body.faces.len());
    for face in &body.faces {
        push_face(&mut text, body, face, &textures[face.material.0 as usize]);
    }
    text
}

fn push_face(text: &mut Vec<u8>, body: &Body, face: &BodyFace, texture: &str) {
    // The format has them clockwise seen from outside.
    let [a, b, c] = three_points(body, face);
    for point in [c, b, a] {
        text.extend_from_slice(b"( ");
        for value in point.to_array() {
            push_decimal(text, value);
            text.push(b' ');
        }
        text.extend_from_slice(b") ");
    }
    text.extend_from_slice(texture.as_bytes());
    text.extend_from_slice(axes(face.normal).as_bytes());
    text.extend_from_slice(b" 0 1 1\n");
}

/// The directions in which a texture runs, as Quake's compilers choose them: from the axis that the normal is nearest to.
fn axes(normal: DVec3) -> &'static str {
    let [x, y, z] = normal.abs().to_array();
    if z >= x && z >= y {
        " [ 1 0 0 0 ] [ 0 -1 0 0 ]"
    } else if x >= y {
        " [ 0 1 0 0 ] [ 0 0 -1 0 ]"
    } else {
        " [ 1 0 0 0 ] [ 0 0 -1 0 ]"
    }
}

/// A texture's name without what ends a word, groups or quotes for one reader or another. At the start, an opening brace stays,
/// by which masked textures are told, and what begins a comment goes.
fn texture(name: &str) -> String {
    let is_bad =
        |c: char| c.is_whitespace() || c.is_control() || matches!(c, '"' | '(' | ')' | '[' | ']' | '{' | '}' | '\\');
    let safe: String = name.chars().map(|c| if is_bad(c) { '_' } else { c }).collect();
    let rest: String = safe.chars().skip(1).collect();
    if safe.is_empty() {
        NO_TEXTURE.to_owned()
    } else if name.starts_with('{') && !rest.is_empty() {
        format!("{{{rest}")
    } else if ["//", "/*", "#", ";"].iter().any(|comment| safe.starts_with(comment)) {
        format!("_{rest}")
    } else {
        safe
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn textures_are_single_words_that_no_reader_takes_for_anything_else() {
        for (name, expected) in [
            ("", NO_TEXTURE),
            ("city/wall 2", "city/wall_2"),
            ("*lava", "*lava"),
            ("{fence", "{fence"),
            ("{", "_"),
            ("a{b}(c)[d]\"e\"\n\\f", "a_b__c__d__e___f"),
            ("//", "_/"),
            ("#ff0000", "_ff0000"),
            ("größe", "größe"),
            ("é", "é"),
        ] {
            assert_eq!(texture(name), expected, "{name:?}");
        }
    }

    #[test]
    fn entities_are_told_by_names_of_the_readers_form() {
        assert_eq!(entity_of("func_door #12"), Some((12, "func_door")));
        for name in ["pillar", "worldspawn #0", " #1", "a\"b #1", "a\\ #1", "door #", "door #-1", "door #1x"] {
            assert_eq!(entity_of(name), None, "{name}");
        }
    }
}
