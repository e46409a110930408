//! Names of a body's parts, as documents accept them.

use rustc_hash::FxHashSet;

use super::RigidBody;
use crate::material::unique;
use crate::xml::escaped;

/// What the visual mesh is called.
pub(super) const VISUAL: &str = "visual";

/// The name of a collider's mesh.
pub(super) fn collision(number: usize) -> String {
    format!("collision_{number}")
}

/// The name of a body in XML. `world` is what all else hangs from: both MuJoCo and readers of URDF give the name a meaning.
pub(super) fn body_name(name: &str) -> String {
    unique(&escaped(name), &mut FxHashSet::from_iter(["world".to_owned()]))
}

/// The names of a body's colliders, each once, and none that of the visual mesh.
pub(super) fn collider_names(body: &RigidBody<'_>, legal: impl Fn(&str) -> String) -> Vec<String> {
    let mut taken = FxHashSet::default();
    taken.insert(VISUAL.to_owned());
    body.colliders.iter().map(|collider| unique(&legal(collider.name), &mut taken)).collect()
}

/// A name for a prim of USD: ASCII letters, digits and underscores, and no digit first.
pub(super) fn prim_name(name: &str) -> String {
    let legal = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    let name: String = name.chars().map(legal).collect();
    if name.starts_with(|c: char| c.is_ascii_digit()) || name.is_empty() { format!("_{name}") } else { name }
}

/// A part of a path that every system and document takes: without separators, and characters that XML has no place for.
pub(super) fn path_name(name: &str) -> String {
    let legal = |c: char| if c.is_control() || "/\\:*?\"<>|\u{fffd}\u{fffe}\u{ffff}".contains(c) { '_' } else { c };
    name.chars().map(legal).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prim_names_are_identifiers() {
        for (name, expected) in [("cell 0", "cell_0"), ("0", "_0"), ("", "_"), ("Wände-1", "W_nde_1"), ("a_b", "a_b")]
        {
            assert_eq!(prim_name(name), expected);
        }
    }

    #[test]
    fn no_body_is_the_world() {
        assert_eq!(["part", "world", "world_2"].map(body_name), ["part", "world_2", "world_2"]);
    }

    #[test]
    fn path_names_have_no_separators_and_stand_in_xml_as_they_are() {
        for name in ["a&b", "\u{fffe}\u{ffff}", "\u{1}\u{7f}\u{85}'ä"] {
            let path = path_name(name);
            assert_eq!(escaped(&path).replace("&amp;", "&"), path);
        }
        assert_eq!(path_name("a/b\\c\n:d e.f-ä"), "a_b_c__d e.f-ä");
    }
}
