//! Requests of browsers: no more of one is read than a bound allows, nor for longer.

use std::io::{self, ErrorKind, Read};
use std::net::TcpStream;
use std::time::{Duration, Instant};

use httparse::{EMPTY_HEADER, Status};
use percent_encoding::percent_decode_str;

/// Most bytes of a request, and most lines of its head. Browsers send one to two thousand bytes in some twenty lines.
const MAX_HEAD: usize = 1 << 14;
const MAX_HEADERS: usize = 64;

/// What is asked for.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Request {
    /// How.
    pub(super) method: Method,
    /// The path without a query, decoded: any bytes.
    pub(super) path: Vec<u8>,
    /// The server for which it is meant; nothing where that is stated never, or more than once.
    pub(super) host: Option<String>,
    /// Whether the answer may be compressed.
    pub(super) accepts_gzip: bool,
    /// The last event that a stream of events brought, where one goes on.
    pub(super) last_event: Option<String>,
}

/// The method of a request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Method {
    /// The content.
    Get,
    /// What would come with the content.
    Head,
    /// Anything else; nothing is changed by requests.
    Other,
}

/// Why there is no request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Refusal {
    /// The client has left; browsers open connections that they do not need.
    Gone,
    /// It is no request of HTTP/1.0 or 1.1.
    Malformed,
    /// It has too many bytes or lines.
    TooLarge,
    /// It did not come in time.
    Late,
}

impl Request {
    /// Reads a request to the end of its head; a body is left where it is.
    ///
    /// # Errors
    /// [`Refusal`].
    pub(super) fn read(mut input: impl Read) -> Result<Self, Refusal> {
        let (mut head, mut chunk) = (Vec::new(), [0; 2048]);
        while head.len() <= MAX_HEAD {
            let count = match input.read(&mut chunk) {
                Ok(0) if head.is_empty() => return Err(Refusal::Gone),
                Ok(0) => return Err(Refusal::Malformed),
                Ok(count) => count,
                Err(error) if error.kind() == ErrorKind::Interrupted => continue,
                Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {
                    return Err(Refusal::Late);
                }
                Err(_) => return Err(Refusal::Gone),
            };
            head.extend_from_slice(&chunk[..count]);
            if let Some(request) = Self::parse(&head)? {
                return Ok(request);
            }
        }
        Err(Refusal::TooLarge)
    }

    /// The request that bytes begin with; nothing where more of it is to come.
    fn parse(bytes: &[u8]) -> Result<Option<Self>, Refusal> {
        let mut headers = [EMPTY_HEADER; MAX_HEADERS];
        let mut head = httparse::Request::new(&mut headers);
        match head.parse(bytes) {
            Ok(Status::Complete(_)) => {}
            Ok(Status::Partial) => return Ok(None),
            Err(httparse::Error::TooManyHeaders) => return Err(Refusal::TooLarge),
            Err(_) => return Err(Refusal::Malformed),
        }
        let (Some(method), Some(target)) = (head.method, head.path) else { return Err(Refusal::Malformed) };
        let method = match method {
            "GET" => Method::Get,
            "HEAD" => Method::Head,
            _ => Method::Other,
        };
        let path = target.split_once('?').map_or(target, |(path, _)| path);
        let all = |name: &str| {
            let named = head.headers.iter().filter(move |header| header.name.eq_ignore_ascii_case(name));
            named.map(|header| String::from_utf8_lossy(header.value).into_owned()).collect::<Vec<_>>()
        };
        let one = |name| <[String; 1]>::try_from(all(name)).ok().map(|[value]| value);
        Ok(Some(Self {
            method,
            path: percent_decode_str(path).collect(),
            host: one("Host"),
            accepts_gzip: all("Accept-Encoding").iter().any(|value| names_gzip(value)),
            last_event: one("Last-Event-ID"),
        }))
    }
}

/// Whether a list of encodings has gzip with a weight above zero.
fn names_gzip(list: &str) -> bool {
    list.split(',').any(|entry| {
        let (name, weight) = entry.split_once(';').unwrap_or((entry, "q=1"));
        let weight = weight.trim().strip_prefix("q=").and_then(|weight| weight.parse::<f32>().ok());
        name.trim().eq_ignore_ascii_case("gzip") && weight.is_some_and(|weight| weight > 0.0)
    })
}

/// What a client sends until a moment, however many pieces it comes in.
#[derive(Debug)]
pub(super) struct Timed<'a> {
    stream: &'a TcpStream,
    end: Instant,
}

impl<'a> Timed<'a> {
    pub(super) fn new(stream: &'a TcpStream, time: Duration) -> Self {
        Self { stream, end: Instant::now() + time }
    }
}

impl Read for Timed<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let left = self.end.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Err(ErrorKind::TimedOut.into());
        }
        self.stream.set_read_timeout(Some(left))?;
        self.stream.read(buffer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn request(head: &str) -> Result<Request, Refusal> {
        Request::read(head.as_bytes())
    }

    #[test]
    fn a_request_is_read_in_pieces_of_any_size() {
        struct Bytewise<'a>(&'a [u8]);
        impl Read for Bytewise<'_> {
            fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
                let length = buffer.len().min(1);
                self.0.read(&mut buffer[..length])
            }
        }
        let head = "GET /file/a%20b.json?x=%2F HTTP/1.1\r\nhost: localhost:8\r\nAccept-Encoding: br, GZIP;q=0.5\r\nLast-Event-ID: 7f\r\n\r\nbody";
        let expected = Request {
            method: Method::Get,
            path: b"/file/a b.json".to_vec(),
            host: Some("localhost:8".to_owned()),
            accepts_gzip: true,
            last_event: Some("7f".to_owned()),
        };
        assert_eq!(request(head), Ok(expected));
        assert_eq!(Request::read(Bytewise(head.as_bytes())), request(head));
    }

    #[test]
    fn a_server_that_is_named_twice_is_not_named() {
        let host = |head: &str| request(head).expect("a request").host;
        assert_eq!(host("GET / HTTP/1.0\r\n\r\n"), None);
        assert_eq!(host("HEAD / HTTP/1.1\r\nHost: a\r\nHost: a\r\n\r\n"), None);
        assert_eq!(host("PUT / HTTP/1.1\r\nHost: a\r\n\r\n"), Some("a".to_owned()));
    }

    #[test]
    fn what_is_no_request_or_too_large_is_refused() {
        assert_eq!(request(""), Err(Refusal::Gone));
        for head in
            ["GET", "GET / HTTP/1.1\r\nHost: a\r\n", "GET / HTTP/2\r\n\r\n", "\x16\x03\x01\0\n\n", "GET /\r\n\r\n"]
        {
            assert_eq!(request(head), Err(Refusal::Malformed), "{head}");
        }
        let many = "A: b\r\n".repeat(MAX_HEADERS + 1);
        assert_eq!(request(&format!("GET / HTTP/1.1\r\n{many}\r\n")), Err(Refusal::TooLarge));
        let mut taken = 0;
        let endless = io::repeat(b'a').take(1 << 30);
        let counted = CountedRead { input: endless, taken: &mut taken };
        assert_eq!(Request::read(io::Cursor::new("GET /").chain(counted)), Err(Refusal::TooLarge));
        assert!(taken <= 2 * MAX_HEAD, "{taken}");
    }

    struct CountedRead<'a, R> {
        input: R,
        taken: &'a mut usize,
    }

    impl<R: Read> Read for CountedRead<'_, R> {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            let count = self.input.read(buffer)?;
            *self.taken += count;
            Ok(count)
        }
    }

    #[test]
    fn gzip_is_accepted_where_its_weight_is_not_zero() {
        for list in ["gzip", "deflate, gzip;q=1.0", "br ,gzip ; q=0.1"] {
            assert!(names_gzip(list), "{list}");
        }
        for list in ["", "br", "gzip;q=0", "gzip; q=0.000", "gzip;q=x", "xgzip"] {
            assert!(!names_gzip(list), "{list}");
        }
    }
}
