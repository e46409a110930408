//! Bodies by name, as the page `docs/model-file.md` of the project defines them: same parameters, same tessellation.
//!
//! What is convex is one [`Brush`](planecut_csg::Brush) whose planes come straight from the parameters: a face is one plane however
//! many corners it has, planes along the axes and of short numbers are exact, and faces that mirror each other do so to the
//! last bit. What is not convex is a union of touching convex cells whose common walls are the same plane seen from both
//! sides, so that they vanish from the boundary; what lies over holes of an outline is subtracted.
//!
//! | file | bodies |
//! |---|---|
//! | `flat` | [`cuboid`], [`wedge`], [`half_space`], [`body_of_half_spaces`], [`hull_of_points`] |
//! | `round` | [`sphere`], [`cylinder`], [`cone`], [`capsule`], [`prism`], [`pyramid`] |
//! | `regular` | [`regular()`], the five regular polyhedra |
//! | `revolved` | [`torus`]; [`revolve`], outlines about the z axis |
//! | `extruded`, `layers` | [`extrude`], outlines along z |
//!
//! `walls` and `partition` cut outlines into convex parts, `cells` closed surfaces into convex bodies.
//!
//! Lengths have no unit, angles are degrees.

mod cells;
mod extruded;
mod layers;
mod partition;
mod pockets;
mod region;
mod regular;
mod revolved;
mod round;
mod simple;
mod walls;

pub use crate::parameter::{MAX_LENGTH, MAX_PIECES, MAX_SEGMENTS, ShapeError};
pub use extruded::{Extrusion, LayerRules, extrude};
pub use regular::{RegularSolid, regular};
pub use revolved::{revolve, revolve_in_steps, torus};
pub use round::{capsule, cone, cylinder, prism, pyramid, sphere};
pub use simple::{body_of_half_spaces, cuboid, half_space, hull_of_points, wedge};

pub(crate) use simple::plane;
