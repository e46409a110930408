//! Several pictures: turntables and contact sheets.

pub(super) mod animation;
pub(super) mod sheet;
pub(super) mod turntable;
