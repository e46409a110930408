//! Where outputs go: checked before the work, written after it.

use std::fmt;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use planecut::export::{AtomicFile, BrushFormat, ExportError, Format, PhysicsFormat};
use planecut::picture::{AnimationFormat, PictureError};

use super::error::CliError;
use super::terminal;

/// A place for bytes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Target {
    /// A file; folders that are missing on the way to it are made.
    File(PathBuf),
    /// Standard output, written `-`.
    Stdout,
}

impl Target {
    /// The place that an argument names.
    pub(crate) fn new(path: &Path) -> Self {
        if path == Path::new("-") { Self::Stdout } else { Self::File(path.to_owned()) }
    }

    /// The place of a picture.
    ///
    /// # Errors
    /// [`CliError::Ending`] where the name is not that of a PNG file.
    pub(crate) fn picture(path: &Path) -> Result<Self, CliError> {
        let is_png = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png"));
        match Self::new(path) {
            Self::File(path) if !is_png => Err(CliError::Ending { path, expected: "`.png`" }),
            target => Ok(target),
        }
    }

    /// The last part of a file's name.
    pub(crate) fn file_name(&self) -> Option<String> {
        match self {
            Self::File(path) => Some(path.file_name()?.to_string_lossy().into_owned()),
            Self::Stdout => None,
        }
    }

    /// The same without its ending.
    pub(crate) fn stem(&self) -> Option<String> {
        match self {
            Self::File(path) => Some(path.file_stem()?.to_string_lossy().into_owned()),
            Self::Stdout => None,
        }
    }

    /// The place that a path relative to its folder names; itself for an empty one.
    pub(crate) fn beside(&self, path: &str) -> Self {
        match self {
            Self::File(own) if !path.is_empty() => Self::File(own.with_file_name(path)),
            target => target.clone(),
        }
    }

    /// Puts `bytes` there: a file appears under its name only when it is complete.
    ///
    /// # Errors
    /// [`CliError::Write`] or [`CliError::Stdout`] where the system refuses.
    pub(crate) fn write(&self, bytes: &[u8]) -> Result<(), CliError> {
        self.begin(|out| Ok::<_, ExportError>(out.write_all(bytes)?))?.commit()
    }

    /// Has something written there, piece by piece. A file gets its name with [`Output::commit`], and is gone without it; what is for standard
    /// output waits for it in memory.
    ///
    /// # Errors
    /// [`CliError::Write`] where the system refuses, [`CliError::Encode`] or [`CliError::Draw`] for what `write` gives.
    pub(crate) fn begin<E: OutputError>(
        &self,
        write: impl FnOnce(&mut dyn Write) -> Result<(), E>,
    ) -> Result<Output, CliError> {
        let failed = |error: E| error.at(self);
        let Self::File(path) = self else {
            let mut bytes = Vec::new();
            write(&mut bytes).map_err(failed)?;
            return Ok(Output { target: self.clone(), content: Content::Waiting(bytes) });
        };
        if folder_of(path).is_some_and(|folder| !folder.exists()) {
            // made in the end: a program that is interrupted leaves no folder behind either
            let mut bytes = Vec::new();
            write(&mut bytes).map_err(failed)?;
            return Ok(Output { target: self.clone(), content: Content::Waiting(bytes) });
        }
        let mut file = AtomicFile::create(path).map_err(|error| error.at(self))?;
        write(&mut file).map_err(failed)?;
        Ok(Output { target: self.clone(), content: Content::File(file) })
    }

    /// The same for what is larger than memory: a folder that is missing is made at once. Standard output waits in memory all the same.
    ///
    /// # Errors
    /// As [`begin`](Self::begin).
    pub(crate) fn begin_large<E: OutputError>(
        &self,
        write: impl FnOnce(&mut dyn Write) -> Result<(), E>,
    ) -> Result<Output, CliError> {
        if let Self::File(path) = self
            && let Some(folder) = folder_of(path)
        {
            fs::create_dir_all(folder).map_err(|source| CliError::Write { path: path.clone(), source })?;
        }
        self.begin(write)
    }
}

/// The folder of a file, where its path names one.
fn folder_of(path: &Path) -> Option<&Path> {
    path.parent().filter(|folder| !folder.as_os_str().is_empty())
}

/// What may go wrong while an output is written.
pub(crate) trait OutputError {
    /// The same with the output that it is about.
    fn at(self, target: &Target) -> CliError;
}

impl OutputError for ExportError {
    fn at(self, target: &Target) -> CliError {
        match (self, target) {
            (Self::Write { path, source }, _) => CliError::Write { path, source },
            (Self::Io(source), Target::File(path)) => CliError::Write { path: path.clone(), source },
            (source, _) => CliError::Encode { output: target.to_string(), source },
        }
    }
}

impl OutputError for PictureError {
    fn at(self, target: &Target) -> CliError {
        match (self, target) {
            (Self::Io(source), Target::File(path)) => CliError::Write { path: path.clone(), source },
            (source, _) => CliError::Draw { output: target.to_string(), source },
        }
    }
}

/// What a picture is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PictureFormat {
    /// One picture.
    Png,
    /// Several, one after another.
    Animation(AnimationFormat),
}

impl PictureFormat {
    /// The place and the format of a picture; standard output gets PNG.
    ///
    /// # Errors
    /// [`CliError::Ending`] where the name is not that of a picture.
    pub(crate) fn resolve(path: &Path) -> Result<(Target, Self), CliError> {
        match AnimationFormat::from_path(path) {
            Ok(format) => Ok((Target::new(path), Self::Animation(format))),
            Err(_) => match Target::picture(path) {
                Err(CliError::Ending { path, .. }) => {
                    Err(CliError::Ending { path, expected: "`.png`, `.gif` or `.apng`" })
                }
                target => Ok((target?, Self::Png)),
            },
        }
    }
}

/// Something that was written, but has no name yet.
#[derive(Debug)]
pub(crate) struct Output {
    target: Target,
    content: Content,
}

#[derive(Debug)]
enum Content {
    File(AtomicFile),
    /// For standard output, or a folder that is still to be made.
    Waiting(Vec<u8>),
}

impl Output {
    /// Where it goes.
    pub(crate) fn target(&self) -> &Target {
        &self.target
    }

    /// Gives it its name, or hands it to standard output.
    ///
    /// # Errors
    /// [`CliError::Write`] or [`CliError::Stdout`] where the system refuses.
    fn commit(mut self) -> Result<(), CliError> {
        self.prepare()?;
        match self.content {
            Content::File(file) => file.commit().map_err(|error| error.at(&self.target)),
            Content::Waiting(bytes) => terminal::print_bytes(&bytes),
        }
    }

    /// Gives all their names, once all of them are written.
    ///
    /// # Errors
    /// As [`Output::commit`].
    pub(crate) fn commit_all(mut outputs: Vec<Self>) -> Result<(), CliError> {
        outputs.iter_mut().try_for_each(Self::prepare)?;
        outputs.into_iter().try_for_each(Self::commit)
    }

    /// Makes its folder where there is none, and writes what waits for that; only the name is missing then.
    fn prepare(&mut self) -> Result<(), CliError> {
        let (Target::File(path), Content::Waiting(bytes)) = (&self.target, &self.content) else { return Ok(()) };
        let refused = |source| CliError::Write { path: path.clone(), source };
        if let Some(folder) = folder_of(path) {
            fs::create_dir_all(folder).map_err(refused)?;
        }
        let mut file = AtomicFile::create(path).map_err(|error| error.at(&self.target))?;
        file.write_all(bytes).map_err(refused)?;
        self.content = Content::File(file);
        Ok(())
    }
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File(path) => write!(f, "{}", path.display()),
            Self::Stdout => f.write_str("standard output"),
        }
    }
}

/// What a file holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum OutputFormat {
    /// Triangles.
    Mesh(Format),
    /// Convex bodies.
    Brushes(BrushFormat),
    /// A tree of operations on brushes: the project's own model file.
    Model,
    /// A rigid body with convex colliders; only `coarsen` makes one.
    Physics(PhysicsFormat),
}

impl OutputFormat {
    /// The endings that there are, for errors.
    const ENDINGS: &'static str = "`.glb`, `.gltf`, `.obj`, `.stl`, `.3mf`, `.ply`, `.map`, `.csg` or `.json` (of coarsen also `.xml`, `.urdf` or `.usda`)";

    /// The format of an ending, without the dot.
    pub(crate) fn from_extension(extension: &str) -> Option<Self> {
        if extension.eq_ignore_ascii_case("json") {
            return Some(Self::Model);
        }
        let brushes = || BrushFormat::from_extension(extension).ok().map(Self::Brushes);
        let physics = || PhysicsFormat::from_extension(extension).ok().map(Self::Physics);
        Format::from_extension(extension).ok().map(Self::Mesh).or_else(brushes).or_else(physics)
    }
}

/// A mesh, convex bodies, or a model, to write.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct MeshTarget {
    pub(crate) target: Target,
    pub(crate) format: OutputFormat,
    /// Whether materials go to a file of their own, where the format has such.
    has_library: bool,
}

impl MeshTarget {
    /// A place of its own, without a file of materials.
    pub(crate) fn alone(target: Target, format: OutputFormat) -> Self {
        Self { target, format, has_library: false }
    }

    /// Where the materials of an OBJ file go: a file of the same name but for its ending. Standard output has none.
    pub(crate) fn library(&self) -> Option<Target> {
        match &self.target {
            Target::File(path) if self.has_library && self.format == OutputFormat::Mesh(Format::Obj) => {
                Some(Target::File(path.with_extension("mtl")))
            }
            _ => None,
        }
    }

    /// All that is written: the mesh, and its materials where they have a file of their own.
    pub(crate) fn targets(&self) -> impl Iterator<Item = Target> {
        std::iter::once(self.target.clone()).chain(self.library())
    }

    /// The place and format of `-o` arguments; `stdout_format` is that of `-`, `has_library`
    /// whether OBJ files have their materials beside them.
    ///
    /// # Errors
    /// [`CliError::Ending`] for a name whose ending is that of no output, [`CliError::Usage`] for `-` without a format or
    /// a format without `-`.
    pub(crate) fn resolve_all(
        paths: &[PathBuf],
        stdout_format: Option<OutputFormat>,
        has_library: bool,
    ) -> Result<Vec<Self>, CliError> {
        let resolve = |path: &PathBuf| match Target::new(path) {
            Target::Stdout => match stdout_format {
                Some(OutputFormat::Physics(format)) if format.has_mesh_files() => Err(CliError::Usage(format!(
                    "found -o - with --format {}, which has meshes in files beside it, expected the name of a file",
                    format.extension()
                ))),
                Some(format) => Ok(Self::alone(Target::Stdout, format)),
                None => Err(CliError::Usage("found -o - without a format, expected --format beside it".to_owned())),
            },
            target => {
                let ending = path.extension().unwrap_or_default().to_string_lossy();
                match OutputFormat::from_extension(&ending) {
                    Some(format) => Ok(Self { target, format, has_library }),
                    None => Err(CliError::Ending { path: path.clone(), expected: OutputFormat::ENDINGS }),
                }
            }
        };
        let targets: Vec<Self> = paths.iter().map(resolve).collect::<Result<_, _>>()?;
        if stdout_format.is_some() && !targets.iter().any(|mesh| mesh.target == Target::Stdout) {
            return Err(CliError::Usage("found --format without standard output, expected -o - beside it".to_owned()));
        }
        Ok(targets)
    }
}

/// Sees, before any work is done, that no output replaces the input or another output, and that none is a folder.
///
/// # Errors
/// [`CliError::Output`] or, for standard output used twice, [`CliError::Usage`].
pub(crate) fn check_targets<'a>(
    input: Option<&Path>,
    targets: impl Iterator<Item = &'a Target>,
) -> Result<(), CliError> {
    let input = input.map(same_name);
    let mut taken: Vec<PathBuf> = Vec::new();
    let mut stdout_is_taken = false;
    for target in targets {
        let Target::File(path) = target else {
            if stdout_is_taken {
                return Err(CliError::Usage("found standard output twice, expected one output to it".to_owned()));
            }
            stdout_is_taken = true;
            continue;
        };
        let name = same_name(path);
        let refused = |found, expected| Err(CliError::Output { path: path.clone(), found, expected });
        if path.is_dir() {
            return refused("a folder", "the name of a file to write");
        }
        if Some(&name) == input.as_ref() {
            return refused("the input", "another name for an output");
        }
        if taken.contains(&name) {
            return refused("two outputs of this name", "a name of its own for each");
        }
        taken.push(name);
    }
    Ok(())
}

/// One name for a file however it is given, as far as it exists.
pub(crate) fn same_name(path: &Path) -> PathBuf {
    let absolute = || std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    fs::canonicalize(path).unwrap_or_else(|_| absolute())
}
