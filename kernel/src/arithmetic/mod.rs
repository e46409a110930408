//! Numbers of more than 53 bits: sums of two, big integers, and how they are rounded.

mod big;
mod double_double;
mod float;
mod quotient;

pub(crate) use big::{big_cross, big_dot, big_integers};
pub use double_double::DoubleDouble;
pub(crate) use double_double::exact_product;
pub use float::{decompose, decompose_odd};
pub(crate) use float::{exponent, ldexp, lowest_bit};
pub use quotient::round_quotient;
pub(crate) use quotient::{square_root_of_quotient, unit_vector};
