//! Fonts of the system, found by the names that OpenSCAD takes: `Family:style=Bold Italic`.
//!
//! `fontdb` knows where systems keep their fonts and what is in them. Where a font is not there, another one takes its place
//! much as fontconfig would choose it: one of the same widths, else one of the same kind.

use std::rc::Rc;

use fontdb::{Database, FaceInfo, Style};
use rustc_hash::FxHashMap;

use super::TextError;
use crate::file;

/// The font that OpenSCAD takes where none is named.
const DEFAULT: &str = "Liberation Sans";

/// Fonts that are drawn alike and as wide as each other.
const ALIKE: [&[&str]; 3] = [
    &["Liberation Sans", "Arial", "Helvetica", "Arimo", "Nimbus Sans", "Nimbus Sans L", "FreeSans"],
    &["Liberation Serif", "Times New Roman", "Times", "Tinos", "Nimbus Roman", "Nimbus Roman No9 L", "FreeSerif"],
    &["Liberation Mono", "Courier New", "Courier", "Cousine", "Nimbus Mono PS", "Nimbus Mono L", "FreeMono"],
];

/// The fonts of each kind (sans serif, serif, of one width), best first, and parts of names that tell the kind.
const KINDS: [(&[&str], &[&str]); 3] = [
    (
        &["DejaVu Sans Mono", "Liberation Mono", "Noto Sans Mono", "Courier New"],
        &["mono", "courier", "consol", "typewriter"],
    ),
    (&["DejaVu Serif", "Liberation Serif", "Noto Serif", "Times New Roman"], &["times", "roman", "georgia", "serif"]),
    (&["DejaVu Sans", "Verdana", "Arial", "Liberation Sans", "Noto Sans"], &[]),
];

/// A font in memory.
pub(super) struct Font {
    pub(super) data: Vec<u8>,
    /// Which one of a collection.
    pub(super) index: u32,
}

/// The fonts of the system; nothing is read before the first one is asked for.
#[derive(Default)]
pub(in crate::scad) struct Fonts {
    database: Option<Database>,
    found: FxHashMap<String, Rc<Font>>,
}

impl Fonts {
    /// The font of a name, or the one that takes its place, which is told when the name comes up first.
    ///
    /// # Errors
    /// [`TextError::NoFont`] where the system has none, [`TextError::Unreadable`].
    pub(super) fn find(&mut self, name: &str) -> Result<(Rc<Font>, Option<String>), TextError> {
        if let Some(font) = self.found.get(name) {
            return Ok((Rc::clone(font), None));
        }
        let database = self.database.get_or_insert_with(system_fonts);
        let request = Request::parse(name);
        let (face, is_other) = request.best(database).ok_or_else(|| TextError::NoFont(request.family().to_owned()))?;
        let family = || face.families.first().map_or(face.post_script_name.as_str(), |(name, _)| name);
        let warning =
            is_other.then(|| format!("the font `{}` is not there, `{}` takes its place", request.family(), family()));
        let unreadable = || TextError::Unreadable(family().to_owned());
        if let fontdb::Source::File(path) | fontdb::Source::SharedFile(path, _) = &face.source {
            file::record(path);
        }
        let data = database.with_face_data(face.id, |data, _| data.to_vec()).ok_or_else(unreadable)?;
        let font = Rc::new(Font { data, index: face.index });
        self.found.insert(name.to_owned(), Rc::clone(&font));
        Ok((font, warning))
    }
}

fn system_fonts() -> Database {
    let mut database = Database::new();
    database.load_system_fonts();
    for folder in std::env::var_os("OPENSCAD_FONT_PATH").iter().flat_map(std::env::split_paths) {
        database.load_fonts_dir(folder);
    }
    database
}

/// What a name asks for.
#[derive(Debug, PartialEq)]
struct Request {
    families: Vec<String>,
    weight: u16,
    is_slanted: bool,
    is_condensed: bool,
}

impl Request {
    /// A name as fontconfig writes it: families, and behind colons properties, of which style, weight and slant matter.
    fn parse(name: &str) -> Self {
        let mut parts = name.trim().split(':');
        let families: Vec<String> =
            parts.next().unwrap_or_default().split(',').map(|family| family.trim().to_owned()).collect();
        let families = families.into_iter().filter(|family| !family.is_empty()).collect();
        let style = parts.map(plain).collect::<String>();
        let has = |words: &[&str]| words.iter().any(|word| style.contains(word));
        let weight = match () {
            () if has(&["extralight", "ultralight", "thin"]) => 200,
            () if has(&["semibold", "demibold", "demi"]) => 600,
            () if has(&["extrabold", "ultrabold"]) => 800,
            () if has(&["black", "heavy"]) => 900,
            () if has(&["bold"]) => 700,
            () if has(&["light"]) => 300,
            () if has(&["medium"]) => 500,
            () => 400,
        };
        Self { families, weight, is_slanted: has(&["italic", "oblique"]), is_condensed: has(&["condensed", "narrow"]) }
    }

    fn family(&self) -> &str {
        self.families.first().map_or(DEFAULT, String::as_str)
    }

    /// The face that fits best, and whether it is of another family than was asked for.
    fn best<'d>(&self, database: &'d Database) -> Option<(&'d FaceInfo, bool)> {
        let own = self.families.iter().map(String::as_str);
        let own: Vec<&str> = if self.families.is_empty() { vec![DEFAULT] } else { own.collect() };
        if let Some(face) = own.iter().find_map(|family| self.of_family(database, family)) {
            return Some((face, false));
        }
        let alike = own.iter().filter_map(|family| ALIKE.iter().find(|group| group.iter().any(|f| is_same(f, family))));
        let same_kind = own.iter().flat_map(|family| kind_of(family));
        let others = alike.flat_map(|group| group.iter()).chain(same_kind).chain(KINDS[2].0);
        let other = others.copied().find_map(|family| self.of_family(database, family));
        Some((other.or_else(|| self.closest(database.faces()))?, true))
    }

    fn of_family<'d>(&self, database: &'d Database, family: &str) -> Option<&'d FaceInfo> {
        self.closest(database.faces().filter(|face| face.families.iter().any(|(name, _)| is_same(name, family))))
    }

    /// The face whose style is nearest; the first name where several are.
    fn closest<'d>(&self, faces: impl Iterator<Item = &'d FaceInfo>) -> Option<&'d FaceInfo> {
        let distance = |face: &&FaceInfo| {
            let is_slanted = face.style != Style::Normal;
            let is_condensed = face.stretch.to_number() < fontdb::Stretch::Normal.to_number();
            let weight = face.weight.0.abs_diff(self.weight);
            (is_condensed != self.is_condensed, is_slanted != self.is_slanted, weight, face.post_script_name.clone())
        };
        faces.min_by_key(distance)
    }
}

/// The fonts of the kind that a name tells.
fn kind_of(family: &str) -> &'static [&'static str] {
    let family = plain(family);
    let is_kind = |words: &[&str]| words.iter().any(|word| family.contains(word)) && !family.contains("sansserif");
    KINDS.iter().find(|(_, words)| is_kind(words)).map_or(KINDS[2].0, |(fonts, _)| fonts)
}

/// Names are the same whatever their case and blanks.
fn is_same(a: &str, b: &str) -> bool {
    plain(a) == plain(b)
}

fn plain(name: &str) -> String {
    name.chars().filter(|c| !c.is_whitespace()).flat_map(char::to_lowercase).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_styles() {
        let request = Request::parse(" Liberation Sans : style=Bold Italic ");
        assert_eq!(request.families, ["Liberation Sans"]);
        assert_eq!((request.weight, request.is_slanted, request.is_condensed), (700, true, false));
        let request = Request::parse("A,B:style=Semi Bold Condensed");
        assert_eq!(request.families, ["A", "B"]);
        assert_eq!((request.weight, request.is_slanted, request.is_condensed), (600, false, true));
        assert_eq!((Request::parse("").family(), Request::parse("").weight), (DEFAULT, 400));
    }

    #[test]
    fn kinds_by_name() {
        for (family, first) in [
            ("helvetica", "DejaVu Sans"),
            ("Courier 10 Pitch", "DejaVu Sans Mono"),
            ("Georgia", "DejaVu Serif"),
            ("MS Sans Serif", "DejaVu Sans"),
            ("PT Serif", "DejaVu Serif"),
        ] {
            assert_eq!(kind_of(family)[0], first, "{family}");
        }
    }

    #[test]
    fn nothing_is_found_where_there_is_nothing() {
        assert!(Request::parse("Arial").best(&Database::new()).is_none());
    }
}
