//! Inputs that are read as a stream: brushes go to a [`TreeSink`](planecut_csg::TreeSink) one by one, and the whole is never in memory.
//!
//! [`stream_map`] reads a map of any length, [`stream_model`] a model file whose copies may be any number.

pub use crate::map::{MapSummary, stream_map};
pub use crate::model::{ModelSummary, stream_model};
pub use crate::stream_error::StreamError;
