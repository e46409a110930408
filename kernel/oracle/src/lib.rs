//! The kernel's independent oracle: every answer is computed a second time, from the definitions, with big integers
//! and without a line of the kernel's code; and the random scripts on which the answers are compared.
//!
//! It serves the kernel's own tests, the fuzz target and the benchmarks (which run the same scripts on other kernels).
//!
//! **Scripts.** [`category::Category`] lists the kinds; [`Category::script`](category::Category::script) makes a
//! sequence of [`script::Op`] with plain coefficients `[nx, ny, nz, d]` of `n·x ≤ d`;
//! [`script::as_adds_and_removes`] writes it in single additions and removals for kernels that have nothing else.
//!
//! **Truth**, from the coefficients alone:
//! - [`outline::Outline::of`]: what the set is, not perturbed: empty or not, bounded or not, its distinct vertices
//!   correctly rounded, numbers of edges and faces. A filter decides most signs: about a millisecond for 30 planes.
//! - [`truth::Truth::of`]: the symbolically perturbed structure that the kernel stores (emptiness from Farkas
//!   certificates). [`solid::Solid`] and [`edges::Edges`]: the set as it is, in rationals. All by big integers only,
//!   for up to about a dozen planes.
//!
//! **Against the kernel.** [`replay::Replay`] runs a script and checks every answer on the way; [`check`] has what is
//! compared after every operation; [`campaign::Campaign`] runs many scripts and shrinks one that fails;
//! [`decode::script`] makes scripts of the bytes that a fuzzer gives. The program `soak` runs ten million operations:
//! `cargo run --release -p planecut-oracle --bin soak`.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod campaign;
pub mod category;
pub mod check;
pub mod decode;
pub mod edges;
pub mod exact;
pub mod generators;
mod handles;
pub mod kernel_calls;
pub mod outline;
pub use planecut_testkit::random;
pub mod replay;
pub mod script;
pub mod settings;
pub mod solid;
pub mod structure;
pub mod truth;
pub mod watchdog;
