//! Nothing but tests: rigid bodies in Rapier.
