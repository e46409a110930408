//! The check against counting by brute force, rational arithmetic, and meshes whose answer is known.

mod crossing;
mod outputs;
mod topology;
