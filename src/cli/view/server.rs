//! The server: who is answered, and by what.
//!
//! Each connection has a thread of its own and brings one request, so no client waits for another. There are bounds to their number, and to how long
//! a request or a pause in reading the answer may take.

use std::io::{self, Read};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::Duration;

use super::changes::Changes;
use super::page::Page;
use super::request::{Method, Request, Timed};
use super::response::{BUSY, Body, Cache, FAILED, FORBIDDEN, METHOD_NOT_ALLOWED, NOT_FOUND, OK, Response};
use super::served_file::ServedFile;
use crate::cli::error::CliError;

/// Most connections at a time; a browser opens six.
const MAX_CONNECTIONS: usize = 128;
/// Time in which a request must be there.
const REQUEST_TIME: Duration = Duration::from_secs(10);
/// Time in which a client must take some more of an answer.
const ANSWER_TIME: Duration = Duration::from_secs(30);
/// Time and bytes that are left to a client that still sends when it is answered.
const LEAVING_TIME: Duration = Duration::from_secs(1);
const LEAVING_BYTES: u64 = 1 << 16;
/// Time until the next try where the system has no more connections to give.
const PAUSE: Duration = Duration::from_millis(50);

/// Where changes are told.
const CHANGES: &[u8] = b"/changes";

/// All that is served.
#[derive(Debug)]
pub(super) struct Server {
    pub(super) page: Page,
    pub(super) file: ServedFile,
    pub(super) changes: Changes,
    pub(super) port: u16,
    /// How many connections there are.
    pub(super) connections: AtomicUsize,
}

impl Server {
    /// Answers whoever connects, for ever.
    pub(super) fn run(&self, listener: &TcpListener) {
        thread::scope(|scope| {
            for stream in listener.incoming() {
                let Ok(stream) = stream else {
                    thread::sleep(PAUSE);
                    continue;
                };
                let place = Place::take(&self.connections);
                let serve = move || self.serve(&stream, place.is_some());
                // without another thread the connection is closed, and the browser says so
                let _ = thread::Builder::new().name("connection".to_owned()).spawn_scoped(scope, serve);
            }
        });
    }

    fn serve(&self, stream: &TcpStream, has_place: bool) {
        // a client that leaves is no error of ours, and there is nobody else to tell
        let _ = self.answer(stream, has_place).and_then(|()| leave(stream));
    }

    fn answer(&self, stream: &TcpStream, has_place: bool) -> io::Result<()> {
        stream.set_nodelay(true)?;
        stream.set_write_timeout(Some(ANSWER_TIME))?;
        if !has_place {
            return Response::text(BUSY, "found too many connections, expected fewer").write(Method::Get, stream);
        }
        let request = match Request::read(Timed::new(stream, REQUEST_TIME)) {
            Ok(request) => request,
            Err(refusal) => {
                return Response::refusal(refusal).map_or(Ok(()), |response| response.write(Method::Get, stream));
            }
        };
        let response = self.response(&request);
        let goes_on = matches!(response.body, Body::Stream) && request.method == Method::Get;
        response.write(request.method, stream)?;
        if goes_on { self.changes.stream(request.last_event.as_deref(), stream) } else { Ok(()) }
    }

    fn response(&self, request: &Request) -> Response<'_> {
        if !request.host.as_deref().is_some_and(|host| self.is_ours(host)) {
            // by a name that leads here, a page from elsewhere could read what is for pages from here (DNS rebinding)
            let expected = format!("found a request to another server, expected one to 127.0.0.1:{}", self.port);
            return Response::text(FORBIDDEN, &expected);
        }
        if request.method == Method::Other {
            return Response::text(METHOD_NOT_ALLOWED, "found another method, expected GET or HEAD");
        }
        if request.path == CHANGES {
            let content_type = "text/event-stream";
            return Response { status: OK, content_type, cache: Cache::Nothing, body: Body::Stream };
        }
        if request.path == self.file.path() {
            return self.file_response();
        }
        let Some(file) = self.page.file(&request.path) else {
            return Response::text(NOT_FOUND, "found no such file, expected one of the page or the one that is shown");
        };
        let encoded = file.encoded(request.accepts_gzip);
        let body = if encoded.is_gzip { Body::Gzip(encoded.bytes) } else { Body::Bytes(encoded.bytes) };
        Response { status: OK, content_type: file.content_type, cache: Cache::Ask, body }
    }

    /// The file as it is now. Its kind is in its name, and no browser shall take it for something that it runs.
    fn file_response(&self) -> Response<'_> {
        match self.file.open() {
            Ok((file, length)) => {
                let content_type = "application/octet-stream";
                Response { status: OK, content_type, cache: Cache::Nothing, body: Body::File(file, length) }
            }
            Err(error) => {
                let is_gone =
                    matches!(&error, CliError::Read { source, .. } if source.kind() == io::ErrorKind::NotFound);
                Response::text(if is_gone { NOT_FOUND } else { FAILED }, &error.to_string())
            }
        }
    }

    /// Whether a server that a request names is this one.
    fn is_ours(&self, host: &str) -> bool {
        let (name, port) = host.rsplit_once(':').unwrap_or((host, "80"));
        matches!(name, "127.0.0.1" | "localhost") && port == self.port.to_string()
    }
}

/// A place among the connections that there may be; it is given back when it is dropped.
struct Place<'a>(&'a AtomicUsize);

impl<'a> Place<'a> {
    fn take(taken: &'a AtomicUsize) -> Option<Self> {
        let place = Self(taken);
        (taken.fetch_add(1, Ordering::Relaxed) < MAX_CONNECTIONS).then_some(place)
    }
}

impl Drop for Place<'_> {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Relaxed);
    }
}

/// Ends a connection so that the answer arrives: a connection that is closed while there is something left to read is broken off.
fn leave(stream: &TcpStream) -> io::Result<()> {
    stream.shutdown(Shutdown::Write)?;
    io::copy(&mut Timed::new(stream, LEAVING_TIME).take(LEAVING_BYTES), &mut io::sink()).map(|_| ())
}
