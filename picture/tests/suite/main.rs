//! Pictures: what is where, what is hidden, what each style shows, and that the same input gives the same bytes.

mod alpha;
mod buffers;
mod facts;
mod golden;
#[cfg(feature = "text")]
mod labels;
mod numbers;
mod oracle;
mod styles;
mod support;
mod turntable;
