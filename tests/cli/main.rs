//! The program as its users run it: arguments, exit statuses, files and what they hold.
#![forbid(unsafe_code)]

mod assets;
mod batch;
mod blocks;
mod check;
mod coarsen;
mod colliders;
mod combine;
mod damaged;
mod determinism;
mod edit;
mod enclosed;
mod engines;
mod examples;
mod interrupt;
mod limits;
mod losses;
mod mesh_data;
mod meshes;
mod model;
mod model_output;
mod outputs;
mod reference;
mod regressions;
mod render;
mod report;
mod serve;
mod shared_maps;
mod support;
mod textures;
mod usage;
mod view;
mod written;
