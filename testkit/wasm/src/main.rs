//! What the libraries do on `wasm32-unknown-unknown`, where there are no threads, no clock, no files and no environment:
//! `testkit/wasm/run` compiles this program for it and runs it in Node.
//!
//! A program for this target exports `main` and has no way to print. So a check is a function that panics where something is wrong,
//! which traps; the stack that Node prints names the function. Run natively (`cargo run -p planecut-wasm-test`) the program prints
//! the message as well.
#![forbid(unsafe_code)]

mod csg;
mod kernel;
mod mesh;

fn main() {
    kernel::check();
    csg::check();
    mesh::check();
}
