//! The Python package `planecut`: the part of it that is written in Rust.
//!
//! [`solid`] and [`shapes`] make expressions ([`planecut::expression`]), of which a mesh is made when somebody asks for it, by a [`job`] without the interpreter's lock. [`arrays`]
//! checks what comes in, and gives views of what goes out.
#![deny(missing_docs)]

mod arrays;
mod blocks;
mod cells;
mod coarsen;
mod command;
mod errors;
mod files;
mod job;
mod live;
mod mesh;
mod pickles;
mod picture;
mod polytope;
mod shapes;
mod solid;

use pyo3::prelude::*;

/// The part of planecut that is written in Rust.
#[pymodule(gil_used = false)]
fn _planecut(module: &Bound<'_, PyModule>) -> PyResult<()> {
    job::note_process();
    // scripts evaluate many parts
    planecut_csg::keep_freed_memory();
    errors::register(module)?;
    shapes::register(module)?;
    files::register(module)?;
    blocks::register(module)?;
    coarsen::register(module)?;
    command::register(module)?;
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<cells::Cell>()?;
    module.add_class::<coarsen::Coarsened>()?;
    module.add_class::<live::Buffers>()?;
    module.add_class::<live::Live>()?;
    module.add_class::<live::Edit>()?;
    module.add_class::<live::Node>()?;
    module.add_class::<live::Preview>()?;
    module.add_class::<live::Previewer>()?;
    module.add_class::<live::Change>()?;
    module.add_class::<live::Face>()?;
    module.add_class::<mesh::Mesh>()?;
    module.add_class::<polytope::Polytope>()?;
    module.add_class::<solid::Solid>()
}
