//! Makes the JavaScript and the types beside a WebAssembly module, as the program `wasm-bindgen --target web` does. The program cannot be had by cargo alone in the version of a lock file; the
//! library that it is made of can.
//!
//! Usage: `planecut-bindgen <module.wasm> <folder>`
#![forbid(unsafe_code)]

use std::env;
use std::process::ExitCode;

use wasm_bindgen_cli_support::Bindgen;

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [module, folder] = &arguments[..] else {
        eprintln!("found {} arguments, expected a module and a folder", arguments.len());
        return ExitCode::from(2);
    };
    match generate(module, folder) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{module}: {error}");
            ExitCode::FAILURE
        }
    }
}

fn generate(module: &str, folder: &str) -> Result<(), Box<dyn std::error::Error>> {
    let mut bindgen = Bindgen::new();
    bindgen.input_path(module).typescript(true).web(true)?;
    // the package says itself where the module is, so that bundlers see it once
    bindgen.omit_default_module_path(true);
    bindgen.remove_name_section(true).remove_producers_section(true);
    bindgen.generate(folder)?;
    Ok(())
}
