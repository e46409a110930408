//! What all readers of texts do first, and how they show what they found.

use planecut_csg::{MeshBody, Tree};

/// Most bytes of a text that is read: 1 GiB.
pub const MAX_TEXT: usize = 1 << 30;

/// Most pieces of a model unless an option says another number: 1,048,576.
pub const DEFAULT_MAX_PIECES: usize = 1 << 20;

/// What is expected of a number of pieces, for an error.
pub(crate) fn at_most(pieces: usize) -> String {
    format!("at most {pieces} (--max-pieces)")
}

/// The planes of all brushes of a tree; triangles of closed meshes count as planes.
pub(crate) fn planes_of(tree: &Tree) -> usize {
    let triangles = |mesh: &MeshBody| mesh.mesh().triangles().len();
    tree.brushes().iter().map(|brush| brush.faces.len() + brush.mesh.as_ref().map_or(0, triangles)).sum()
}

/// Most characters of a text that an error shows.
const MAX_SHOWN: usize = 40;

/// The UTF-8 mark that some Windows editors put in front of a file.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// A text without the mark of its encoding.
pub(crate) fn without_byte_order_mark(text: &[u8]) -> &[u8] {
    text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text)
}

/// The beginning of a text, on one line.
pub(crate) fn shorten(text: &str) -> String {
    let printable = |c: char| if c.is_control() { char::REPLACEMENT_CHARACTER } else { c };
    let shown: String = text.chars().take(MAX_SHOWN).map(printable).collect();
    if text.chars().nth(MAX_SHOWN).is_some() { shown + "…" } else { shown }
}

/// Most bytes of a token that are looked at to show it: four a character at most, and one more character.
pub(crate) const SHOWN_BYTES: usize = 4 * (MAX_SHOWN + 1);

/// A token of which the first `length` bytes count, for an error.
pub(crate) fn shown_token(text: &[u8], length: usize) -> String {
    let token = String::from_utf8_lossy(&text[..length.min(SHOWN_BYTES).min(text.len())]);
    format!("`{}`", shorten(token.trim_end()))
}
