//! The cells of `coarsen` as colliders of a rigid body, in the files that physics engines read.

use std::path::{Path, PathBuf};

use planecut::csg::coarsen::Coarsened;
use planecut::csg::{Material, Mesh, Model, Tree, evaluate};
use planecut::export::{Collider, ExportError, MassProperties, PhysicsFormat, RigidBody, physics_files};
use planecut::import::Warning;

use super::error::CliError;
use super::output::{Output, OutputError, Target, same_name};
use super::pieces::Pieces;
use super::report::MassPart;

/// MuJoCo refuses moving bodies whose mass or moments of inertia are smaller (`mjMINVAL`).
const LEAST_OF_MUJOCO: f64 = 1e-15;

/// A body without a name: its visual mesh, and its mass.
pub(crate) struct Body {
    visual: Mesh,
    mass: MassProperties,
    density: f64,
    is_of_input: bool,
}

/// A place for a rigid body.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct BodyTarget {
    pub(crate) target: Target,
    pub(crate) format: PhysicsFormat,
}

impl Body {
    /// The body of a mesh in some unit, `meters` long. Its mass is that of what the mesh encloses where it is closed, else that of the union of its cells.
    ///
    /// # Errors
    /// [`CliError::Evaluate`] for cells whose union has no mesh; [`CliError::Encode`] where there is no mass.
    pub(crate) fn new(
        mut visual: Mesh,
        is_closed: bool,
        cells: &Coarsened,
        materials: &[Material],
        (meters, density): (f64, f64),
        input: &Path,
    ) -> Result<Self, CliError> {
        visual.positions.iter_mut().for_each(|position| *position *= meters);
        let of_input =
            is_closed.then(|| MassProperties::of_triangles(&visual.positions, &visual.triangles, density)).flatten();
        let mass = match of_input {
            Some(mass) => mass,
            None => {
                let tree = Tree::union(cells.cells.iter().map(|cell| Tree::from(cell.clone())));
                let union = evaluate(&Model { materials: materials.to_vec(), tree })
                    .map_err(|source| CliError::of_evaluation(input, source))?
                    .mesh;
                let positions: Vec<_> = union.positions.iter().map(|position| *position * meters).collect();
                MassProperties::of_triangles(&positions, &union.triangles, density).ok_or_else(|| CliError::Encode {
                    output: input.display().to_string(),
                    source: ExportError::NoMass { density },
                })?
            }
        };
        Ok(Self { visual, mass, density, is_of_input: of_input.is_some() })
    }

    /// Mass and inertia, for the report.
    pub(crate) fn told(&self) -> MassPart {
        MassPart::new(&self.mass, self.density, self.is_of_input)
    }

    /// What there is to warn of, where it is written as MJCF.
    pub(crate) fn doubt(&self) -> Option<Warning> {
        let least = self.mass.principal().moments.min_element().min(self.mass.mass);
        let found = format!(
            "found a mass of {:.3e} kg and a least moment of inertia of {:.3e} kg m², \
             MuJoCo refuses bodies with less than {LEAST_OF_MUJOCO:e} of either: see --unit and --density",
            self.mass.mass,
            self.mass.principal().moments.min_element()
        );
        (least < LEAST_OF_MUJOCO).then(|| Warning::note(0, found))
    }

    /// Writes the body with some colliders to some places, each name once; `unnamed` is what it is called on standard output.
    ///
    /// # Errors
    /// [`CliError::Encode`], [`CliError::Write`].
    pub(crate) fn encode(
        &self,
        colliders: &[Collider<'_>],
        places: &[BodyTarget],
        unnamed: &str,
    ) -> Result<Vec<Output>, CliError> {
        let mut outputs = Vec::new();
        // documents of one name in one folder have the same meshes
        let mut meshes: Vec<PathBuf> = Vec::new();
        for BodyTarget { target, format } in places {
            let name = target.stem().unwrap_or_else(|| unnamed.to_owned());
            let body = RigidBody { name: &name, visual: &self.visual, colliders, mass: self.mass };
            for file in physics_files(&body, *format, &name).map_err(|error| error.at(target))? {
                let place = target.beside(file.path());
                if let Target::File(path) = &place
                    && !file.path().is_empty()
                {
                    let path = same_name(path);
                    if meshes.contains(&path) {
                        continue;
                    }
                    meshes.push(path);
                }
                outputs.push(place.begin(|out| file.write(out))?);
            }
        }
        Ok(outputs)
    }
}

/// The cells as colliders.
pub(crate) fn colliders(pieces: &Pieces) -> Vec<Collider<'_>> {
    pieces.iter().map(|(name, mesh)| Collider::new(name, mesh)).collect()
}
