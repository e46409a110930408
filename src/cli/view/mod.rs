//! `planecut view`: the editor in a browser, with a file that is loaded again when it changes.
//!
//! A [`Server`] on this machine alone has the [`Page`], the file as it is, and its [`Changes`], which a [`Watch`] finds.

mod args;
mod browser;
mod changes;
mod page;
mod request;
mod response;
mod served_file;
mod server;
mod watch;

use std::net::{Ipv4Addr, TcpListener};
use std::sync::atomic::AtomicUsize;
use std::thread;
use std::time::Duration;

use super::error::{CliError, Done};
use super::input::Input;
use super::terminal;
pub(crate) use args::ViewArgs;
use changes::Changes;
use page::Page;
use served_file::ServedFile;
use server::Server;
use watch::Watch;

/// Time between two looks at the file.
const LOOK: Duration = Duration::from_millis(250);

/// Runs the command, until it is interrupted.
///
/// # Errors
/// [`CliError`] where the input or the page is unusable, [`CliError::Port`] where nothing can be served at the port, [`CliError::Stdout`].
pub(crate) fn run(args: &ViewArgs) -> Result<Done, CliError> {
    let (input, _) = Input::resolve_any(&args.input, None)?;
    let file = ServedFile::new(input)?;
    let page = Page::new(args.page.as_deref())?;
    let mut watch = Watch::new(file.input())?;
    let failed = |source| CliError::Port { port: args.port, source };
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, args.port)).map_err(failed)?;
    let port = listener.local_addr().map_err(failed)?.port();

    let address = format!("http://127.0.0.1:{port}/?file={}", file.in_query());
    terminal::print_text(&format!("Serving {} at {address} (Ctrl-C ends)\n", file.name()))?;
    if !args.no_open {
        browser::open(&address);
    }
    let changes = Changes::new(watch.content());
    let server = Server { page, file, changes, port, connections: AtomicUsize::new(0) };
    thread::scope(|scope| {
        scope.spawn(|| {
            loop {
                thread::sleep(LOOK);
                if watch.look() {
                    server.changes.tell(watch.content());
                }
            }
        });
        server.run(&listener);
    });
    Ok(Done::Complete)
}
