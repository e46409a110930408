//! The page: its files by name, from the program itself or from a folder.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fs;
use std::io::{self, ErrorKind, Read};
use std::path::Path;

use flate2::read::GzDecoder;
use planecut::import::file::read_file;

use crate::cli::error::CliError;

/// The files in the program, as the build script found them: name, bytes, and whether these are compressed.
const BUILT_IN: &[(&str, &[u8], bool)] = include!(concat!(env!("OUT_DIR"), "/page.rs"));

/// The file that is served for `/`.
const INDEX: &str = "index.html";
/// Most files of a page in a folder, and most bytes of all of them: what has more is no page, but a folder named by mistake.
const MAX_FILES: usize = 4096;
const MAX_BYTES: u64 = 1 << 28;

/// A page. All of it is in memory, so that nothing but these files can be asked for.
#[derive(Debug)]
pub(super) struct Page {
    files: BTreeMap<String, PageFile>,
}

/// A file of a page.
#[derive(Debug)]
pub(super) struct PageFile {
    /// What it is.
    pub(super) content_type: &'static str,
    content: Content,
}

#[derive(Debug)]
enum Content {
    Plain(Cow<'static, [u8]>),
    /// As gzip.
    Packed(&'static [u8]),
}

/// The bytes of a file as they are sent.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Encoded<'a> {
    /// The bytes.
    pub(super) bytes: Cow<'a, [u8]>,
    /// Whether they are compressed by gzip.
    pub(super) is_gzip: bool,
}

impl PageFile {
    /// Its bytes, compressed where it is stored so and that is accepted.
    pub(super) fn encoded(&self, accepts_gzip: bool) -> Encoded<'_> {
        match &self.content {
            Content::Plain(bytes) => Encoded { bytes: Cow::Borrowed(bytes), is_gzip: false },
            Content::Packed(bytes) if accepts_gzip => Encoded { bytes: Cow::Borrowed(bytes), is_gzip: true },
            Content::Packed(bytes) => Encoded { bytes: Cow::Owned(unpacked(bytes)), is_gzip: false },
        }
    }
}

impl Page {
    /// The page in a folder, or without one that in the program.
    ///
    /// # Errors
    /// [`CliError::Usage`] where there is none, or where the folder holds too much for one; [`CliError::Read`] where it cannot be read.
    pub(super) fn new(folder: Option<&Path>) -> Result<Self, CliError> {
        match folder {
            Some(folder) => Self::in_folder(folder),
            None => Self::built_in(BUILT_IN),
        }
    }

    fn built_in(table: &[(&'static str, &'static [u8], bool)]) -> Result<Self, CliError> {
        if table.is_empty() {
            let advice = "run \"npm ci && npm run build\" in web/ and build again, or name its folder with --page";
            return Err(CliError::Usage(format!("found no page in this build of planecut, expected one: {advice}")));
        }
        let file = |&(name, bytes, is_packed): &(&str, &'static [u8], bool)| {
            let content = if is_packed { Content::Packed(bytes) } else { Content::Plain(Cow::Borrowed(bytes)) };
            (name.to_owned(), PageFile { content_type: content_type(name), content })
        };
        Ok(Self { files: table.iter().map(file).collect() })
    }

    fn in_folder(root: &Path) -> Result<Self, CliError> {
        // before the folder is looked through: it may be any, and large
        if fs::metadata(root.join(INDEX)).is_err_and(|error| error.kind() == ErrorKind::NotFound) {
            let found = format!("{}: found no {INDEX}, expected a page", root.display());
            return Err(CliError::Usage(format!("{found}, as npm run build in web/ writes it to web/dist")));
        }
        let mut page = Self { files: BTreeMap::new() };
        let (mut folders, mut room) = (vec![String::new()], MAX_BYTES);
        while let Some(folder) = folders.pop() {
            let place = root.join(&folder);
            let failed = |source: io::Error| CliError::Read { path: place.clone(), source };
            for entry in fs::read_dir(&place).map_err(failed)? {
                let entry = entry.map_err(failed)?;
                // The page's own files have names that are text. What is hidden is none of it, and links lead elsewhere.
                let Ok(name) = entry.file_name().into_string() else { continue };
                let kind = entry.file_type().map_err(failed)?;
                if name.starts_with('.') {
                    continue;
                }
                let name = format!("{folder}{name}");
                if kind.is_dir() {
                    folders.push(name + "/");
                } else if kind.is_file() {
                    let bytes =
                        read_file(&entry.path(), room).map_err(|source| of_file(root, &entry.path(), source))?;
                    room -= bytes.len() as u64;
                    let content_type = content_type(&name);
                    page.files.insert(name, PageFile { content_type, content: Content::Plain(bytes.into()) });
                }
                if page.files.len() + folders.len() > MAX_FILES {
                    return Err(too_much(root));
                }
            }
        }
        Ok(page)
    }

    /// The file of a path that begins with `/`.
    pub(super) fn file(&self, path: &[u8]) -> Option<&PageFile> {
        let name = std::str::from_utf8(path.strip_prefix(b"/")?).ok()?;
        self.files.get(if name.is_empty() { INDEX } else { name })
    }
}

fn of_file(root: &Path, path: &Path, source: io::Error) -> CliError {
    match source.kind() {
        ErrorKind::FileTooLarge => too_much(root),
        _ => CliError::Read { path: path.to_owned(), source },
    }
}

fn too_much(root: &Path) -> CliError {
    let limit = format!("{MAX_FILES} files and {MAX_BYTES} bytes");
    CliError::Usage(format!("{}: found more than {limit}, expected the folder of a page", root.display()))
}

fn unpacked(packed: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    GzDecoder::new(packed).read_to_end(&mut bytes).expect("what the build script compressed");
    bytes
}

/// What a file is, by the ending of its name. Browsers are told not to guess.
fn content_type(name: &str) -> &'static str {
    match name.rsplit_once('.').map_or("", |(_, ending)| ending) {
        "html" => "text/html; charset=utf-8",
        "js" | "mjs" => "text/javascript; charset=utf-8",
        "css" => "text/css; charset=utf-8",
        "json" => "application/json",
        "webmanifest" => "application/manifest+json",
        "txt" | "csg" | "map" => "text/plain; charset=utf-8",
        "wasm" => "application/wasm",
        "svg" => "image/svg+xml",
        "png" => "image/png",
        "jpg" | "jpeg" => "image/jpeg",
        "webp" => "image/webp",
        "ico" => "image/x-icon",
        "woff2" => "font/woff2",
        _ => "application/octet-stream",
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use flate2::Compression;
    use flate2::write::GzEncoder;

    use super::*;

    #[test]
    fn files_are_found_by_their_whole_name_alone() {
        let page = Page::built_in(&[("index.html", b"<!doctype html>", false), ("assets/a.js", b"1", false)]);
        let page = page.expect("a page");
        assert_eq!(page.file(b"/").map(|file| file.content_type), Some("text/html; charset=utf-8"));
        assert_eq!(page.file(b"/assets/a.js").map(|file| file.content_type), Some("text/javascript; charset=utf-8"));
        for path in
            ["", "index.html", "//", "/assets", "/assets/", "/assets//a.js", "/./index.html", "/../index.html", "/A"]
        {
            assert!(page.file(path.as_bytes()).is_none(), "{path}");
        }
        assert!(page.file(b"/\xff").is_none());
    }

    #[test]
    fn what_is_stored_compressed_is_sent_so_only_where_that_is_accepted() {
        let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
        encoder.write_all(b"let a = 1;").expect("written to memory");
        let packed: &'static [u8] = encoder.finish().expect("written to memory").leak();
        let page = Page::built_in(&[("a.js", packed, true)]).expect("a page");
        let file = page.file(b"/a.js").expect("there");
        assert_eq!(file.encoded(true), Encoded { bytes: packed.into(), is_gzip: true });
        assert_eq!(file.encoded(false), Encoded { bytes: b"let a = 1;"[..].into(), is_gzip: false });
    }

    #[test]
    fn a_build_without_a_page_says_how_to_get_one() {
        let error = Page::built_in(&[]).expect_err("no page").to_string();
        assert!(error.starts_with("found no page in this build of planecut, expected one: run \"npm ci"), "{error}");
    }

    #[test]
    fn the_page_in_the_program_can_be_read() {
        let Ok(page) = Page::new(None) else { return assert!(BUILT_IN.is_empty()) };
        let index = page.file(b"/").expect("what the build script looks for").encoded(false);
        assert!(index.bytes.starts_with(b"<!") || index.bytes.starts_with(b"<html"));
        for (name, bytes, _) in BUILT_IN {
            let file = page.file(format!("/{name}").as_bytes()).expect("in the table");
            assert_eq!(file.encoded(true).bytes, *bytes, "{name}");
            assert!(file.encoded(false).bytes.len() >= bytes.len() / 2, "{name}");
        }
    }
}
