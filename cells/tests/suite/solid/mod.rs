//! Solids of disjoint convex cells, against oracles that share no code with them.
//!
//! - [`shape`]: random trees, with the value of each point from the half-spaces alone; [`lattice`]: boxes on a lattice,
//!   whose volume, area and parts are counted; [`general`]: all bodies, by the membership of points, and against the skin.
//! - [`algebra`]: the operators and the identities of set algebra. [`cuts`], [`motion`], [`rays`], [`points`]: what a solid
//!   can be asked and made to do.
//! - [`growth`]: how many cells there are; [`data`]: cells of others; [`cases`]: what is easily forgotten.

mod algebra;
mod cases;
mod cuts;
mod data;
mod general;
mod growth;
mod lattice;
mod motion;
mod points;
mod rays;
