//! Several inputs as one solid.

use std::path::PathBuf;

use planecut::csg::{Brush, Material, MaterialId, Model, ModelSummary, Operation, Tree, summarize};
use planecut::import::Warning;
use planecut::reading::FileKind;

use super::args::Combine;
use super::error::CliError;
use super::input::Input;
use super::pieces::without;
use super::reading_args::ReadingArgs;
use super::solve::{Read, brush_warnings, read};

/// One input, or several that are combined.
pub(crate) struct Inputs {
    first: (Input, FileKind),
    others: Vec<(Input, FileKind)>,
    operation: Combine,
}

impl Inputs {
    /// The inputs with these names.
    ///
    /// # Errors
    /// [`CliError::Ending`] for a name that is none of an input, [`CliError::Usage`] for several without an operation, and for options that none of
    /// them has a use for.
    pub(crate) fn resolve(
        paths: &[PathBuf],
        combine: Option<Combine>,
        reading: &ReadingArgs,
    ) -> Result<Self, CliError> {
        if paths.iter().filter(|path| path.as_os_str() == "-").count() > 1 {
            return Err(CliError::Usage("found standard input twice, expected one input from it".to_owned()));
        }
        if paths.len() > 1 && combine.is_none() {
            let count = paths.len();
            let expected = "one, or --combine union, difference, intersection or xor";
            return Err(CliError::Usage(format!("found {count} inputs, expected {expected}")));
        }
        let resolve = |path: &PathBuf| Input::resolve_any(path, reading.input_format);
        let mut inputs = paths.iter().map(resolve).collect::<Result<Vec<_>, _>>()?;
        let kinds: Vec<FileKind> = inputs.iter().map(|(_, kind)| *kind).collect();
        reading.check_any(&kinds)?;
        let others = inputs.split_off(1);
        let first = inputs.pop().expect("the parser wants one");
        Ok(Self { first, others, operation: combine.unwrap_or(Combine::Union) })
    }

    /// The first one, which messages name.
    pub(crate) fn first(&self) -> &Input {
        &self.first.0
    }

    /// How what is read is evaluated: of several maps are read without what is not bounded.
    pub(crate) fn kind(&self) -> FileKind {
        if self.others.is_empty() { self.first.1 } else { FileKind::Model }
    }

    /// The format of the first one, and for several how they are combined and their names, for the report.
    pub(crate) fn told(&self) -> (&'static str, Option<(String, Vec<String>)>) {
        let names = || self.all().map(|(input, _)| input.given()).collect();
        let operation = || format!("{:?}", self.operation).to_lowercase();
        (self.first.1.name(), (!self.others.is_empty()).then(|| (operation(), names())))
    }

    /// All of them in their order.
    pub(crate) fn all(&self) -> impl Iterator<Item = &(Input, FileKind)> {
        std::iter::once(&self.first).chain(&self.others)
    }

    /// Reads all of them.
    ///
    /// # Errors
    /// [`CliError`] for unusable input.
    pub(crate) fn read(&self, reading: &ReadingArgs) -> Result<Read, CliError> {
        let (input, kind) = &self.first;
        let mut all = read(input, *kind, reading)?;
        if self.others.is_empty() {
            return Ok(all);
        }
        all = without_unbounded(all, *kind);
        let mut trees = vec![std::mem::take(&mut all.model.tree)];
        for (input, kind) in &self.others {
            let mut other = without_unbounded(read(input, *kind, reading)?, *kind);
            take_materials(&mut all.model.materials, &mut other.model);
            let brushes = trees.iter().map(|tree| tree.brushes().len()).sum();
            all.textures.resize(brushes, Vec::new());
            all.textures.extend(other.textures);
            all.warnings.extend(other.warnings.iter().map(|warning| in_file(input, warning)));
            // lines are those of the first one
            trees.push(other.model.tree.without_source_lines());
        }
        all.model.tree = Tree::combine(self.operation.into(), trees);
        Ok(all)
    }
}

impl From<Combine> for Operation {
    fn from(combine: Combine) -> Self {
        match combine {
            Combine::Union => Self::Union,
            Combine::Difference => Self::Difference,
            Combine::Intersection => Self::Intersection,
            Combine::Xor => Self::Xor,
        }
    }
}

/// A warning about another file than the first.
fn in_file(input: &Input, warning: &Warning) -> Warning {
    let line = if warning.line > 0 { format!(":{}", warning.line) } else { String::new() };
    Warning::loss(0, format!("{}{line}: {}", input.name(), warning.message), warning.left_out)
}

/// What was read of a map without brushes that are not bounded, which are named in warnings; anything else as it is.
fn without_unbounded(mut read: Read, kind: FileKind) -> Read {
    if kind != FileKind::Map {
        return read;
    }
    // brushes without interior are told of all inputs at once
    let lost = ModelSummary { empty: Vec::new(), ..summarize(&read.model) };
    read.warnings.extend(brush_warnings(kind, &read.model, &lost));
    if !lost.unbounded.is_empty() {
        let mut number = 0..;
        read.textures.retain(|_| number.next().is_none_or(|number| !lost.unbounded.contains(&number)));
        read.model.tree = without(&read.model, &lost.unbounded);
    }
    read
}

/// Adds the materials of a model to others, and gives its faces their numbers there. Of the same name are one where they look alike; otherwise the
/// second one gets a number after its name.
fn take_materials(materials: &mut Vec<Material>, model: &mut Model) {
    let number = |material: &Material| {
        let names = std::iter::once(material.name.clone()).chain((2..).map(|k| format!("{} {k}", material.name)));
        for name in names {
            let own = Material { name, ..material.clone() };
            match materials.iter().position(|other| other.name == own.name) {
                Some(place) if materials[place] == own => return MaterialId(place as u32),
                Some(_) => {}
                None => {
                    materials.push(own);
                    break;
                }
            }
        }
        MaterialId(materials.len() as u32 - 1)
    };
    let numbers: Vec<MaterialId> = model.materials.iter().map(number).collect();
    let used = model.tree.brushes_mut().iter_mut().flat_map(Brush::materials_mut);
    used.for_each(|material| *material = numbers[material.0 as usize]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use planecut::kernel::DVec3;

    #[test]
    fn materials_of_one_name_are_one_where_they_look_alike() {
        let red = Material { color: Some([1.0, 0.0, 0.0]), ..Material::named("paint") };
        let blue = Material { color: Some([0.0, 0.0, 1.0]), ..Material::named("paint") };
        let mut materials = vec![Material::named("stone"), red];
        let brush = |material| Brush::cuboid(DVec3::ZERO, DVec3::ONE, MaterialId(material));
        let tree = Tree::union_of(vec![brush(0), brush(1)]);
        let mut model = Model { materials: vec![blue, Material::named("stone")], tree };
        take_materials(&mut materials, &mut model);
        assert_eq!(materials.iter().map(|m| m.name.as_str()).collect::<Vec<_>>(), ["stone", "paint", "paint 2"]);
        let used: Vec<u32> = model.tree.brushes().iter().map(|brush| brush.faces[0].material.0).collect();
        assert_eq!(used, [2, 0]);
    }
}
