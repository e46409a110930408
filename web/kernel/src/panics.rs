//! A bug of ours as an exception that says what went wrong.

use std::panic;

use js_sys::WebAssembly::RuntimeError;
use wasm_bindgen::prelude::*;

/// From now on a panic is an exception with its message instead of a mere `unreachable`.
#[wasm_bindgen(start)]
pub fn start() {
    panic::set_hook(Box::new(|info| {
        let payload = info.payload();
        let text = payload.downcast_ref::<&str>().copied().or(payload.downcast_ref::<String>().map(String::as_str));
        let place = info.location().map(|place| format!(" ({}:{})", place.file(), place.line())).unwrap_or_default();
        let error = RuntimeError::new(&format!(
            "found a bug in planecut, expected none: {}{place}; nothing of this instance can be used any more: begin another worker or process",
            text.unwrap_or("a panic without a message")
        ));
        // the name by which it is told from what WebAssembly itself throws
        let _ = js_sys::Reflect::set(&error, &"name".into(), &"InternalError".into());
        wasm_bindgen::throw_val(error.into());
    }));
}

/// Panics as a bug would: for tests of what happens then.
#[wasm_bindgen(js_name = simulateBug)]
pub fn simulate_bug() {
    panic!("a bug that a test asks for");
}
