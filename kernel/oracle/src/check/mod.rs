//! What is checked of the kernel after every operation of a script.

mod definition;
mod facets;
mod fresh_build;
mod layered;
mod measures;
mod outline;

pub use definition::compare_with_truth;
pub use fresh_build::compare_with_fresh_build;
pub use layered::check_in_layers;
pub use outline::compare_with_outline;
