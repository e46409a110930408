//! What may stand on the command line of `view`. The doc comments here are the help texts.

use std::path::PathBuf;

use clap::Args;

/// Arguments of `view`.
#[derive(Debug, Args)]
pub(crate) struct ViewArgs {
    /// The model, map, tree or closed mesh to show (.json, .map, .csg, .obj, .stl, .ply, .glb, .gltf)
    #[arg(value_name = "INPUT")]
    pub(crate) input: PathBuf,
    /// Port of 127.0.0.1 to serve at; 0 is any that is free
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) port: u16,
    /// Only print the address, do not open it in a browser
    #[arg(long)]
    pub(crate) no_open: bool,
    /// Serve the page in this folder, as `npm run build` in web/ writes it to web/dist, instead of the one in the program
    #[arg(long, value_name = "DIR")]
    pub(crate) page: Option<PathBuf>,
}
