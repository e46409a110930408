//! Answers to browsers, with what these are told to forbid to the page.

use std::borrow::Cow;
use std::fs::File;
use std::io::{self, ErrorKind, Read, Write};

use super::request::{Method, Refusal};

/// What comes with every answer. The page has all it needs from here, so nothing may come from elsewhere, nor go there; no other page may frame or embed
/// what is served, and nothing is taken for something else than it is said to be.
const HEADERS: &str = "\
    Content-Security-Policy: default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; \
    worker-src 'self' blob:; connect-src 'self'; object-src 'none'; base-uri 'none'; frame-ancestors 'none'\r\n\
    X-Content-Type-Options: nosniff\r\n\
    Referrer-Policy: no-referrer\r\n\
    Cross-Origin-Resource-Policy: same-origin\r\n\
    Cross-Origin-Opener-Policy: same-origin\r\n\
    Connection: close\r\n";

/// A status of HTTP, as its line has it.
pub(super) type Status = &'static str;

pub(super) const OK: Status = "200 OK";
pub(super) const FORBIDDEN: Status = "403 Forbidden";
pub(super) const NOT_FOUND: Status = "404 Not Found";
pub(super) const METHOD_NOT_ALLOWED: Status = "405 Method Not Allowed";
pub(super) const FAILED: Status = "500 Internal Server Error";
pub(super) const BUSY: Status = "503 Service Unavailable";

/// An answer.
#[derive(Debug)]
pub(super) struct Response<'a> {
    pub(super) status: Status,
    pub(super) content_type: &'static str,
    pub(super) cache: Cache,
    pub(super) body: Body<'a>,
}

/// What a browser may keep.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Cache {
    /// Nothing.
    Nothing,
    /// The answer, if it asks each time whether it still holds; another build of the program may have another page.
    Ask,
}

/// What an answer holds.
#[derive(Debug)]
pub(super) enum Body<'a> {
    /// Bytes.
    Bytes(Cow<'a, [u8]>),
    /// Bytes that are compressed by gzip.
    Gzip(Cow<'a, [u8]>),
    /// The first bytes of a file, this many.
    File(File, u64),
    /// What is written after it, until the connection ends.
    Stream,
}

impl<'a> Response<'a> {
    /// A line of text.
    pub(super) fn text(status: Status, line: &str) -> Self {
        let body = Body::Bytes(format!("{line}\n").into_bytes().into());
        Self { status, content_type: "text/plain; charset=utf-8", cache: Cache::Nothing, body }
    }

    /// The answer to what is no request; nothing where nobody is left.
    pub(super) fn refusal(refusal: Refusal) -> Option<Self> {
        let (status, line) = match refusal {
            Refusal::Gone => return None,
            Refusal::Malformed => ("400 Bad Request", "found no request, expected one of HTTP/1.1"),
            Refusal::TooLarge => {
                ("431 Request Header Fields Too Large", "found a long request, expected a shorter one")
            }
            Refusal::Late => ("408 Request Timeout", "found no request in time, expected one at once"),
        };
        Some(Self::text(status, line))
    }

    /// Writes it, without its body where only the head is asked for.
    ///
    /// # Errors
    /// Those of writing, and [`ErrorKind::UnexpectedEof`] where a file has become shorter: the client finds out by the length that it was told.
    pub(super) fn write(self, method: Method, mut output: impl Write) -> io::Result<()> {
        output.write_all(self.head().as_bytes())?;
        if method == Method::Head {
            return output.flush();
        }
        match self.body {
            Body::Bytes(bytes) | Body::Gzip(bytes) => output.write_all(&bytes)?,
            Body::File(file, length) => {
                if io::copy(&mut file.take(length), &mut output)? < length {
                    return Err(ErrorKind::UnexpectedEof.into());
                }
            }
            Body::Stream => {}
        }
        output.flush()
    }

    fn head(&self) -> String {
        let Self { status, content_type, cache, body } = self;
        let cache = match cache {
            Cache::Nothing => "no-store",
            Cache::Ask => "no-cache",
        };
        let mut head =
            format!("HTTP/1.1 {status}\r\nContent-Type: {content_type}\r\nCache-Control: {cache}\r\n{HEADERS}");
        if *status == METHOD_NOT_ALLOWED {
            head += "Allow: GET, HEAD\r\n";
        }
        match body {
            Body::Bytes(bytes) => head += &format!("Content-Length: {}\r\n", bytes.len()),
            Body::Gzip(bytes) => head += &format!("Content-Encoding: gzip\r\nContent-Length: {}\r\n", bytes.len()),
            Body::File(_, length) => head += &format!("Content-Length: {length}\r\n"),
            Body::Stream => {}
        }
        head + "\r\n"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(response: Response<'_>, method: Method) -> String {
        let mut bytes = Vec::new();
        response.write(method, &mut bytes).expect("written to memory");
        String::from_utf8(bytes).expect("text")
    }

    #[test]
    fn a_head_is_that_of_the_whole_answer() {
        let whole = written(Response::text(NOT_FOUND, "found nothing"), Method::Get);
        let head = written(Response::text(NOT_FOUND, "found nothing"), Method::Head);
        assert_eq!(whole, format!("{head}found nothing\n"));
        assert!(
            head.starts_with("HTTP/1.1 404 Not Found\r\n") && head.ends_with("Content-Length: 14\r\n\r\n"),
            "{head}"
        );
    }

    #[test]
    fn no_line_of_a_head_is_broken() {
        let head = written(Response::text(METHOD_NOT_ALLOWED, ""), Method::Head);
        let lines: Vec<&str> = head.strip_suffix("\r\n\r\n").expect("an end").split("\r\n").collect();
        assert!(
            lines[1..].iter().all(|line| line.contains(": ") && !line.starts_with(' ') && !line.contains("  ")),
            "{head}"
        );
        assert!(lines.contains(&"Allow: GET, HEAD"));
    }

    #[test]
    fn a_file_that_became_shorter_is_an_error() {
        let mut file = tempfile::tempfile().expect("a file");
        file.write_all(b"12345").expect("written");
        io::Seek::rewind(&mut file).expect("a file");
        let response = Response { status: OK, content_type: "a/b", cache: Cache::Ask, body: Body::File(file, 6) };
        let mut bytes = Vec::new();
        let error = response.write(Method::Get, &mut bytes).expect_err("shorter");
        assert_eq!((error.kind(), bytes.ends_with(b"\r\n\r\n12345")), (ErrorKind::UnexpectedEof, true));
    }
}
