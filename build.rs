//! Builds the page that `planecut view` serves into the program, where `npm run build` in `web/` has made one.
//!
//! It writes a table of the page's files for `src/cli/view/page.rs`: the name of each, its bytes, and whether these are compressed. The table is empty where
//! there is no page, as in a library without the feature `cli`.

use std::io;

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=build.rs");
    #[cfg(feature = "cli")]
    page::build()?;
    Ok(())
}

#[cfg(feature = "cli")]
mod page {
    use std::fmt::Write as _;
    use std::io::{self, Write as _};
    use std::path::{Path, PathBuf};
    use std::{env, fs};

    use flate2::{Compression, GzBuilder};

    /// Writes the table and what it names into the folder that is there for it.
    pub(super) fn build() -> io::Result<()> {
        let root = PathBuf::from(variable("CARGO_MANIFEST_DIR")?);
        let out = PathBuf::from(variable("OUT_DIR")?);
        let (sources, page) = (root.join("web"), root.join("web/dist"));
        let names = if page.join("index.html").is_file() { names_below(&page)? } else { Vec::new() };
        // A path that is not there would count as changed in every build: until there is a page, the folder is watched in which it appears.
        if !names.is_empty() {
            println!("cargo::rerun-if-changed=web/dist");
        } else if sources.is_dir() {
            println!("cargo::rerun-if-changed=web");
        }

        let files = out.join("page");
        if files.exists() {
            fs::remove_dir_all(&files)?;
        }
        fs::create_dir_all(&files)?;
        let mut table = String::from("&[\n");
        for (number, name) in names.iter().enumerate() {
            let plain = fs::read(page.join(name))?;
            let packed = gzip(&plain)?;
            // pictures and fonts are compressed already
            let is_packed = packed.len() < plain.len() / 10 * 9;
            fs::write(files.join(number.to_string()), if is_packed { packed } else { plain })?;
            let bytes = format!("include_bytes!(concat!(env!(\"OUT_DIR\"), \"/page/{number}\"))");
            writeln!(table, "    ({name:?}, {bytes}, {is_packed}),").map_err(io::Error::other)?;
        }
        table += "]\n";
        fs::write(out.join("page.rs"), table)
    }

    fn variable(name: &str) -> io::Result<String> {
        env::var(name).map_err(io::Error::other)
    }

    /// The names of all files below a folder but hidden ones, in order, with `/` between their parts.
    fn names_below(root: &Path) -> io::Result<Vec<String>> {
        let (mut names, mut folders) = (Vec::new(), vec![String::new()]);
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(root.join(&folder))? {
                let entry = entry?;
                let name = entry.file_name().into_string().map_err(|_| io::Error::other("a name that is no text"))?;
                let kind = entry.file_type()?;
                if name.starts_with('.') {
                    continue;
                } else if kind.is_dir() {
                    folders.push(format!("{folder}{name}/"));
                } else if kind.is_file() {
                    names.push(format!("{folder}{name}"));
                }
            }
        }
        names.sort();
        Ok(names)
    }

    /// The same bytes on every run: without a time and without a name.
    fn gzip(bytes: &[u8]) -> io::Result<Vec<u8>> {
        let mut writer = GzBuilder::new().write(Vec::new(), Compression::best());
        writer.write_all(bytes)?;
        writer.finish()
    }
}
