//! The paper's own checks under their names, with stronger conditions: where the paper asks for Euler's formula, the
//! numbers of vertices, edges and faces are compared with the exact outline as well.
//!
//! - [`edge_case`]: the eleven planes of Appendix C.
//! - [`removal`]: `test_validate_topology_after_removal`, the 14,000 removals of §3.7 and the tolerances of §3.7.1.
//! - [`degenerate`]: the three examples of §3.5: cube corners, near-parallel planes, truncated corners.

mod bodies;
mod degenerate;
mod edge_case;
mod removal;
