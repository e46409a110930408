//! The browser of whoever runs the program.

use std::process::{Command, Stdio};
use std::thread;

/// Opens an address in it; where there is none, nothing happens.
pub(super) fn open(address: &str) {
    let mut command = opener();
    command.arg(address).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    // Ctrl-C ends all processes of a group, and the browser is to stay
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(&mut command, 0);
    if let Ok(mut child) = command.spawn() {
        // a process that has ended is kept by the system until it is asked how; without a thread for that it is kept to the end
        let _ = thread::Builder::new().spawn(move || child.wait());
    }
}

#[cfg(target_os = "macos")]
fn opener() -> Command {
    Command::new("open")
}

/// What `start` does, without a shell that would take parts of an address for commands.
#[cfg(windows)]
fn opener() -> Command {
    let mut command = Command::new("rundll32");
    command.arg("url.dll,FileProtocolHandler");
    command
}

#[cfg(not(any(target_os = "macos", windows)))]
fn opener() -> Command {
    Command::new("xdg-open")
}
