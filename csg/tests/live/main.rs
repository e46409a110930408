//! Live models against models built anew.

mod random;
