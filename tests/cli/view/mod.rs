//! `view`: a server for a browser on this machine, and for nobody else.

mod served;

use std::io::{ErrorKind, Read, Write};
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream, UdpSocket};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Instant;

use crate::support::{command, finish, planecut};
use served::{INDEX, MODEL, PATIENCE, Served, first_line, view, with_page};

#[test]
fn the_page_and_the_file_are_served() {
    let served = Served::start();
    let address = format!("http://127.0.0.1:{}/?file=/file/box.json", served.port);
    assert_eq!(served.line, format!("Serving box.json at {address} (Ctrl-C ends)\n"));
    for path in ["/", "/?file=/file/box.json", "/index.html"] {
        let page = served.get(path);
        assert_eq!((page.status, page.body.as_slice()), (200, INDEX.as_bytes()), "{path}");
        assert_eq!(page.header("Content-Type"), Some("text/html; charset=utf-8"));
    }
    let script = served.get("/assets/page.js");
    assert_eq!((script.status, script.body.as_slice()), (200, &b"let a = 1;"[..]));
    assert_eq!(script.header("Content-Type"), Some("text/javascript; charset=utf-8"));
    let file = served.get("/file/box.json");
    assert_eq!((file.status, file.body.as_slice()), (200, MODEL.as_bytes()));
    assert_eq!(
        (file.header("Content-Type"), file.header("Cache-Control")),
        (Some("application/octet-stream"), Some("no-store"))
    );
}

#[test]
fn names_of_any_letters_are_found_by_the_address_that_is_printed() {
    let name = "a b+c#d%20é.json";
    let folder = with_page(name);
    let command = view(folder.path(), name);
    let served = Served::run(folder, command);
    assert!(served.line.contains("/?file=/file/a%20b%2Bc%2523d%252520%C3%A9.json (Ctrl-C"), "{}", served.line);
    let file = served.get("/file/a%20b+c%23d%2520%C3%A9.json");
    assert_eq!((file.status, file.body.as_slice()), (200, MODEL.as_bytes()));
}

#[test]
fn nothing_else_is_served() {
    let served = Served::start();
    let absolute = served.file().display().to_string();
    for path in [
        "/x",
        "/file",
        "/file/",
        "/file/secret.json",
        "/file/../secret.json",
        "/file/box.json/",
        "/file//box.json",
        "/box.json",
        "/secret.json",
        "/../secret.json",
        "/%2e%2e/secret.json",
        "/..%2fsecret.json",
        "/assets/../../secret.json",
        "/..\\secret.json",
        "/assets",
        "/assets/",
        "/.hidden",
        "/page/index.html",
        "/../Cargo.toml",
        "//etc/passwd",
        "/%2fetc%2fpasswd",
        "/%00",
        "/%ff",
        "/changes/",
        &absolute,
        &format!("/file/{absolute}"),
        &format!("/file{absolute}"),
    ] {
        assert_eq!(served.get(path).status, 404, "{path}");
    }
    assert_eq!(served.get("http://127.0.0.1/").status, 404);
}

#[test]
fn every_answer_forbids_what_the_page_does_not_need() {
    let served = Served::start();
    for path in ["/", "/file/box.json", "/nothing"] {
        let answer = served.get(path);
        let policy = answer.header("Content-Security-Policy").expect("a policy");
        assert!(policy.starts_with("default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; "), "{policy}");
        assert!(policy.ends_with("object-src 'none'; base-uri 'none'; frame-ancestors 'none'"), "{policy}");
        assert_eq!(answer.header("X-Content-Type-Options"), Some("nosniff"));
        assert_eq!(answer.header("Referrer-Policy"), Some("no-referrer"));
        assert_eq!(answer.header("Cross-Origin-Resource-Policy"), Some("same-origin"));
        assert_eq!(answer.header("Access-Control-Allow-Origin"), None);
    }
}

#[test]
fn only_get_and_head_are_answered() {
    let served = Served::start();
    for path in ["/", "/file/box.json"] {
        let (whole, head) = (served.get(path), served.ask(&format!("HEAD {path} HTTP/1.1")));
        assert_eq!((head.status, head.head, head.body.len()), (200, whole.head, 0), "{path}");
    }
    assert_eq!(served.ask("HEAD /changes HTTP/1.1").status, 200);
    for method in ["POST", "PUT", "DELETE", "OPTIONS", "TRACE", "get"] {
        let refused = served.ask(&format!("{method} /file/box.json HTTP/1.1\r\nContent-Length: 5\r\n\r\nhello"));
        assert_eq!((refused.status, refused.header("Allow")), (405, Some("GET, HEAD")), "{method}");
    }
    assert_eq!(std::fs::read_to_string(served.file()).expect("still there"), MODEL);
}

#[test]
fn requests_to_other_names_are_refused() {
    let served = Served::start();
    let port = served.port;
    let status = |lines: &str| served.ask_bytes(format!("GET / HTTP/1.1\r\n{lines}\r\n").as_bytes()).status;
    for host in [format!("127.0.0.1:{port}"), format!("localhost:{port}")] {
        assert_eq!(status(&format!("Host: {host}\r\n")), 200, "{host}");
    }
    let other = port ^ 1;
    for host in [
        "evil.example",
        &format!("evil.example:{port}"),
        "127.0.0.1",
        "localhost",
        &format!("127.0.0.1:{other}"),
        &format!("127.0.0.1.evil.example:{port}"),
        &format!("evil.example#127.0.0.1:{port}"),
        &format!("0.0.0.0:{port}"),
        &format!("[::1]:{port}"),
        &format!("127.0.0.1:0{port}"),
        "",
    ] {
        assert_eq!(status(&format!("Host: {host}\r\n")), 403, "{host}");
    }
    assert_eq!(status(""), 403);
    assert_eq!(status(&format!("Host: 127.0.0.1:{port}\r\nHost: evil.example\r\n")), 403);
}

/// The address by which other machines reach this one, where there is one. No packet is sent.
fn address_for_others() -> Option<std::net::IpAddr> {
    let socket = UdpSocket::bind((Ipv4Addr::UNSPECIFIED, 0)).ok()?;
    socket.connect((Ipv4Addr::new(192, 0, 2, 1), 9)).ok()?;
    Some(socket.local_addr().ok()?.ip()).filter(|address| !address.is_loopback() && !address.is_unspecified())
}

#[test]
fn other_addresses_of_the_machine_are_not_served() {
    let served = Served::start();
    let others =
        [Some(Ipv4Addr::new(127, 0, 0, 2).into()), Some(std::net::Ipv6Addr::LOCALHOST.into()), address_for_others()];
    for address in others.into_iter().flatten() {
        let connected = TcpStream::connect_timeout(&SocketAddr::new(address, served.port), PATIENCE);
        assert!(connected.is_err(), "{address}");
    }
    assert_eq!(served.get("/").status, 200);
}

#[test]
fn long_and_malformed_requests_are_refused() {
    let served = Served::start();
    assert_eq!(served.ask_bytes(b"nonsense\r\n\r\n").status, 400);
    assert_eq!(served.ask_bytes(b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\r\n\r\n").status, 400);
    assert_eq!(served.ask(&format!("GET /{} HTTP/1.1", "a".repeat(20_000))).status, 431);
    assert_eq!(served.ask(&format!("GET / HTTP/1.1\r\n{}", "A: b\r\n".repeat(100))).status, 431);
    // a line without an end is not read to its end
    let mut stream = served.connect();
    stream.set_write_timeout(Some(PATIENCE)).expect("a time");
    let line = [b'a'; 1 << 16];
    let refused = (0..1 << 14).find_map(|_| stream.write_all(&line).err());
    assert!(refused.is_some_and(|error| !matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut)));
    assert_eq!(served.get("/").status, 200);
}

#[test]
fn slow_and_idle_clients_keep_nobody_waiting() {
    let served = Served::start();
    // more than a browser opens, at each stage of a request
    let slow: Vec<TcpStream> = (0..40)
        .map(|number| {
            let mut stream = served.connect();
            let begun = ["", "G", "GET / HTTP/1.1\r\nHost: ", "GET /changes HTTP/1.1\r\n"][number % 4];
            stream.write_all(begun.as_bytes()).expect("written");
            stream
        })
        .collect();
    assert_eq!(served.get("/").status, 200);
    assert_eq!(served.get("/file/box.json").status, 200);
    // those that do not end their request are left in the end
    for (number, stream) in slow.into_iter().enumerate().take(4) {
        let mut bytes = Vec::new();
        (&stream).read_to_end(&mut bytes).expect("the end");
        assert!(bytes.starts_with(b"HTTP/1.1 408 "), "{number}: {}", String::from_utf8_lossy(&bytes));
    }
}

#[test]
fn more_clients_than_there_may_be_are_turned_away_and_come_later() {
    let served = Served::start();
    let idle: Vec<TcpStream> = (0..128).map(|_| served.connect()).collect();
    let turned_away = served.get("/");
    assert_eq!(turned_away.status, 503, "{}", turned_away.head);
    drop(idle);
    let end = Instant::now() + PATIENCE;
    let mut statuses = std::iter::repeat_with(|| served.get("/").status).take_while(|_| Instant::now() < end);
    assert_eq!(statuses.find(|status| *status != 503), Some(200));
}

#[test]
fn changes_of_the_file_are_told_to_every_page() {
    let served = Served::start();
    let file = served.file();
    let (mut one, mut other) = (served.changes(""), served.changes(""));
    let second = MODEL.replace("[1, 1, 1]", "[2, 2, 2]");
    std::fs::write(&file, &second).expect("written");
    let (id, number) = one.next();
    assert_eq!((other.next(), number.as_str()), ((id.clone(), number.clone()), "1"));
    assert_eq!(served.get("/file/box.json").body, second.as_bytes());

    // as editors do it that replace the file; of the same length
    let new = served.folder.path().join("box.json~");
    let third = second.replace('2', "3");
    std::fs::write(&new, &third).expect("written");
    std::fs::rename(&new, &file).expect("renamed");
    assert_eq!((one.next().1.as_str(), other.next().1.as_str()), ("2", "2"));
    assert_eq!(served.get("/file/box.json").body, third.as_bytes());

    // a page that comes again after it missed a change
    drop(one);
    let mut again = served.changes(&format!("Last-Event-ID: {id}\r\n"));
    assert_eq!(again.next().1, "2");
}

#[test]
fn a_file_that_vanishes_is_waited_for() {
    let served = Served::start();
    let file = served.file();
    let mut changes = served.changes("");
    std::fs::remove_file(&file).expect("removed");
    let gone = served.get("/file/box.json");
    let line = String::from_utf8(gone.body).expect("text");
    assert_eq!((gone.status, line.as_str()), (404, "box.json: found no such file, expected a file that can be read\n"));
    std::fs::create_dir(&file).expect("made");
    assert_eq!(served.get("/file/box.json").status, 500);
    std::fs::remove_dir(&file).expect("removed");
    assert_eq!(served.get("/").status, 200);
    std::fs::write(&file, "{}").expect("written");
    assert_eq!(changes.next().1, "1");
    assert_eq!(served.get("/file/box.json").body, b"{}");
}

#[test]
fn the_page_in_the_program_is_served_or_said_to_be_missing() {
    let folder = with_page("box.json");
    let built = Path::new(crate::support::ROOT).join("web/dist/index.html");
    let mut command = command();
    command.current_dir(folder.path()).args(["view", "box.json"]);
    let mut child = command.arg("--no-open").stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("started");
    let line = first_line(&mut child);
    if line.is_empty() {
        let output = child.wait_with_output().expect("it ends");
        let run = crate::support::Run {
            status: output.status.code().unwrap_or(-1),
            stdout: Vec::new(),
            stderr: String::from_utf8(output.stderr).expect("text"),
        };
        let advice = "run \"npm ci && npm run build\" in web/ and build again";
        run.expect_error(2, &format!("found no page in this build of planecut, expected one: {advice}"));
        return;
    }
    let port = line.split_once("http://127.0.0.1:").and_then(|(_, rest)| rest.split_once('/')).expect("an address").0;
    let served = Served { port: port.parse().expect("a port"), line, child, folder };
    let page = served.get("/");
    assert_eq!((page.status, page.header("Content-Encoding")), (200, None));
    if let Ok(index) = std::fs::read(built) {
        // a page that was built again since then is another one, of the same form
        assert_eq!(page.body[..15].to_ascii_lowercase(), index[..15].to_ascii_lowercase());
    }
    let text = String::from_utf8(page.body).expect("text");
    let script = text.split('"').find(|part| part.ends_with(".js")).expect("a script");
    let script = format!("/{}", script.trim_start_matches("./").trim_start_matches('/'));
    let (plain, packed) =
        (served.get(&script), served.ask(&format!("GET {script} HTTP/1.1\r\nAccept-Encoding: gzip, br\r\n")));
    assert_eq!((plain.status, packed.status, packed.header("Content-Encoding")), (200, 200, Some("gzip")));
    let mut bytes = Vec::new();
    flate2::read::GzDecoder::new(&packed.body[..]).read_to_end(&mut bytes).expect("gzip");
    assert_eq!(bytes, plain.body);
}

#[test]
fn what_cannot_be_shown_is_refused() {
    let folder = with_page("box.json");
    let refused = |args: &[&str], status: i32, words: &str| {
        let run = finish(command().current_dir(folder.path()).arg("view").args(args).arg("--no-open"));
        run.expect_error(status, words);
        assert_eq!(run.stdout, b"", "{args:?}");
    };
    std::fs::create_dir(folder.path().join("d.map")).expect("made");
    std::fs::create_dir(folder.path().join("empty")).expect("made");
    refused(&["n.json", "--page", "page"], 2, "n.json: found no such file, expected a file that can be read");
    refused(&["d.map", "--page", "page"], 2, "d.map: found a folder");
    refused(&["a.scad", "--page", "page"], 2, "a.scad: found a name that ends in `.scad`, expected `.json`");
    refused(&["-", "--page", "page"], 2, "found the input on standard input, expected a file: it is read again");
    refused(&["box.json", "--page", "empty"], 2, "empty: found no index.html, expected a page");
    refused(&["box.json", "--page", "nowhere"], 2, "nowhere: found no index.html, expected a page");
    refused(&["box.json", "--page", "page", "--port", "65536"], 2, "65536");
    refused(&["box.json", "box.json", "--page", "page"], 2, "box.json");
    let taken = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).expect("a port");
    let port = taken.local_addr().expect("a port").port().to_string();
    let words = format!("127.0.0.1:{port}: found a port in use, expected a port that is free");
    refused(&["box.json", "--page", "page", "--port", &port], 1, &words);
    planecut(["view"]).expect_error(2, "INPUT");
}

#[cfg(unix)]
#[test]
fn a_pipe_is_refused_and_not_waited_for() {
    let folder = with_page("box.json");
    let pipe = folder.path().join("pipe.json");
    assert!(Command::new("mkfifo").arg(&pipe).status().expect("mkfifo").success());
    finish(&mut view(folder.path(), "pipe.json")).expect_error(2, "pipe.json: found `a device or a pipe`");
}

#[cfg(unix)]
#[test]
fn an_interrupt_ends_it() {
    use std::os::unix::process::ExitStatusExt;
    let mut served = Served::start();
    let _open = served.changes("");
    let kill = format!("kill -INT {}", served.child.id());
    assert!(Command::new("sh").args(["-c", &kill]).status().expect("a shell").success());
    assert_eq!(served.child.wait().expect("it ends").signal(), Some(2));
}

#[cfg(target_os = "linux")]
#[test]
fn the_address_is_opened_in_a_browser_where_there_is_one() {
    use std::os::unix::fs::PermissionsExt;
    let folder = with_page("box.json");
    let (opener, opened) = (folder.path().join("xdg-open"), folder.path().join("opened"));
    assert!(Command::new("mkfifo").arg(&opened).status().expect("mkfifo").success());
    std::fs::write(&opener, "#!/bin/sh\necho \"$1\" >opened\n").expect("written");
    std::fs::set_permissions(&opener, std::fs::Permissions::from_mode(0o755)).expect("a program");
    let start = |path: &Path| {
        let mut command = view(folder.path(), "box.json");
        let mut child = command.env("PATH", path).stdout(Stdio::piped()).spawn().expect("started");
        (first_line(&mut child), child)
    };
    let end = |mut child: Child| child.kill().and_then(|()| child.wait()).expect("it ends");
    let (line, child) = start(folder.path());
    // the pipe waits for the browser
    let address = std::fs::read_to_string(&opened).expect("an address");
    assert!(line.contains(&format!(" at {} (", address.trim_end())), "{line}: {address}");
    end(child);
    let (line, mut child) = start(&folder.path().join("page"));
    assert!(line.starts_with("Serving box.json at "), "{line}");
    assert!(child.try_wait().expect("asked").is_none());
    end(child);
}
