//! Several pictures: turntables and contact sheets.

pub(crate) mod animation;
pub(crate) mod sheet;
pub(crate) mod turntable;
