//! Names of a body's parts, as documents accept them.

use rustc_hash::FxHashSet;

use super::RigidBody;
use crate::material::unique;

/// What the mesh is called that is seen.
pub(super) const VISUAL: &str = "visual";

/// The name of a collider's mesh.
pub(super) fn collision(number: usize) -> String {
    format!("collision_{number}")
}

/// The names of a body's colliders, each once, and none that of what is seen.
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
    let legal = |c: char| if c.is_control() || "/\\:*?\"<>|\u{fffd}".contains(c) { '_' } else { c };
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
    fn path_names_have_no_separators() {
        assert_eq!(path_name("a/b\\c\n:d e.f-ä"), "a_b_c__d e.f-ä");
    }
}
