//! What an object is, by its keys.

use super::error::{Checked, Fault};
use super::json::{Document, Entry, Kind};
use super::keys::{COMPANIONS, Field, INLINE_MESH, MESH};
use crate::source::shorten;

/// How a place of an instance is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PlaceForm {
    Point,
    Steps,
    Matrix,
}

/// How a place is written, by its looks alone.
pub(super) fn place_of(document: &Document<'_>, place: Entry) -> Option<PlaceForm> {
    match (document.kind(place), document.items(place).next().map(|first| document.kind(first))) {
        (Kind::List, None | Some(Kind::Object)) => Some(PlaceForm::Steps),
        (Kind::List, _) => Some(PlaceForm::Point),
        (Kind::Object, _) => Some(PlaceForm::Matrix),
        _ => None,
    }
}

/// The keys of a mesh that is an object, by its looks alone: those of one in a file unless it lists vertices or triangles.
pub(super) fn mesh_fields(document: &Document<'_>, mesh: Entry) -> &'static [Field] {
    let has = |key| document.member(mesh, key).is_some();
    if !has("file") && (has("vertices") || has("triangles")) { INLINE_MESH } else { MESH }
}

/// The one key of an object that says what it is, and its value.
///
/// # Errors
/// [`Fault`] where there is none, or two of them; `what` is what the object should be.
pub(super) fn kind_of(
    document: &Document<'_>,
    entry: Entry,
    kinds: &'static [Field],
    extras: &'static [Field],
    what: &str,
) -> Checked<(&'static Field, Entry)> {
    let known = || format!("{what}: an object with one of the keys {}", list(kinds.iter()));
    if document.kind(entry) != Kind::Object {
        return document.refuse(entry, known());
    }
    let mut found: Option<(&'static Field, Entry)> = None;
    for (key, value) in document.members(entry) {
        let Some(field) = find(kinds, &document.text(key)) else { continue };
        match found {
            None => found = Some((field, value)),
            Some((first, _)) => {
                let found = format!("both `{}` and `{}`", first.key, field.key);
                return Err(Fault::new(entry, found, "only one of the keys that say what it is"));
            }
        }
    }
    let is_companion = |key: &str| COMPANIONS.iter().any(|(_, field)| field.key == key);
    let is_extra = |key: &str| find(extras, key).is_some() || is_companion(key);
    let mut members = document.members(entry).map(|(key, value)| (document.text(key), value));
    match (found, members.find(|(key, _)| !is_extra(key))) {
        (Some(found), _) => Ok(found),
        // The one key that is not known is what should say it.
        (None, Some((key, value))) => Err(unknown_key(value, &key, kinds.iter().chain(extras))),
        (None, None) => document.refuse(entry, known()),
    }
}

/// The field of a key.
pub(super) fn find(fields: &'static [Field], key: &str) -> Option<&'static Field> {
    fields.iter().find(|field| field.key == key)
}

/// The fault of a key that is none of the known ones.
pub(super) fn unknown_key<'f>(value: Entry, key: &str, known: impl Iterator<Item = &'f Field>) -> Fault {
    Fault::new(value, format!("the key `{}`", shorten(key)), format!("one of {}", list(known)))
}

/// The keys, in a list for people.
pub(super) fn list<'f>(fields: impl Iterator<Item = &'f Field>) -> String {
    fields.map(|field| field.key).collect::<Vec<_>>().join(", ")
}
