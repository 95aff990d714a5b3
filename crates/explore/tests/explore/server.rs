//! Who is let in: the host, the origin and the token of a request.

use retune_explore::{Options, Server};
use std::io::{ErrorKind, Read, Write};
use std::net::TcpStream;
use std::sync::Arc;
use std::time::{Duration, Instant};
use tungstenite::client::IntoClientRequest;

struct Desk {
    server: Arc<Server>,
    host: String,
    path: String,
}

/// A server of its own for a test; it ends with the process.
fn desk() -> Desk {
    let server = Arc::new(Server::open(&Options::default()).expect("a server"));
    let address = server.address();
    let (host, path) = address.trim_start_matches("http://").split_once('/').expect("a path");
    let (host, path) = (host.to_owned(), format!("/{path}"));
    let serving = Arc::clone(&server);
    std::thread::spawn(move || serving.serve());
    Desk { server, host, path }
}

impl Desk {
    fn ask(&self, request: &str) -> String {
        let mut stream = TcpStream::connect(&self.host).expect("a connection");
        stream.write_all(request.as_bytes()).expect("sent");
        let mut answer = Vec::new();
        let _ = stream.read_to_end(&mut answer);
        String::from_utf8_lossy(&answer).into_owned()
    }

    fn get(&self, path: &str, headers: &str) -> String {
        self.ask(&format!("GET {path} HTTP/1.1\r\n{headers}\r\n"))
    }

    fn socket(&self, origin: &str) -> Result<tungstenite::WebSocket<TcpStream>, String> {
        let address = format!("ws://{}{}socket", self.host, self.path);
        let mut request = address.into_client_request().expect("an address");
        if !origin.is_empty() {
            request.headers_mut().insert("Origin", origin.parse().expect("an origin"));
        }
        let stream = TcpStream::connect(&self.host).expect("a connection");
        stream.set_read_timeout(Some(Duration::from_secs(20))).expect("set");
        tungstenite::client(request, stream).map(|found| found.0).map_err(|error| error.to_string())
    }
}

fn status(answer: &str) -> &str {
    answer.get(9..12).unwrap_or("none")
}

#[test]
fn contract_only_this_host_and_this_page_are_answered() {
    let desk = desk();
    let host = format!("Host: {}\r\n", desk.host);
    let good = desk.get(&desk.path, &host);
    assert_eq!(status(&good), "200");
    assert!(good.contains("Content-Security-Policy: default-src 'none'") && good.contains("<!doctype html>"));
    for (headers, why) in [
        ("", "no host"),
        ("Host: evil.example\r\n", "a name that was rebound"),
        ("Host: 127.0.0.1\r\n", "another port"),
        (&format!("{host}{host}"), "two hosts"),
        (&format!("{host}Origin: http://evil.example\r\n"), "another page"),
        (&format!("{host}Origin: null\r\n"), "a page from nowhere"),
    ] {
        let answer = desk.get(&desk.path, headers);
        assert!(["400", "403"].contains(&status(&answer)), "{why}: {answer}");
        assert!(!answer.contains("<!doctype"), "{why}");
    }
    let port = desk.host.split_once(':').expect("a port").1;
    assert_eq!(status(&desk.get(&desk.path, &format!("Host: localhost:{port}\r\n"))), "200");
}

#[test]
fn contract_the_token_is_asked_for_and_differs() {
    let (one, other) = (desk(), desk());
    assert_ne!(one.path, other.path);
    assert_eq!(one.path.len(), 34); // 128 bits
    let host = format!("Host: {}\r\n", one.host);
    for path in ["/", "/index.html", &other.path, &one.path[..33], "/../etc/passwd", "/socket"] {
        assert_eq!(status(&one.get(path, &host)), "403", "{path}");
    }
    assert_eq!(status(&one.get(&format!("{}../../etc/passwd", one.path), &host)), "404");
    assert_eq!(status(&one.get(&format!("{}main.js", one.path), &host)), "200");
    assert_eq!(status(&one.ask(&format!("POST {} HTTP/1.1\r\n{host}\r\n", one.path))), "405");
}

#[test]
fn contract_heads_that_are_too_long_or_none_are_refused() {
    let desk = desk();
    let host = format!("Host: {}\r\n", desk.host);
    let long = desk.get(&desk.path, &format!("{host}X: {}\r\n", "x".repeat(40_000)));
    assert!(["431", "none"].contains(&status(&long)), "{long}"); // the connection may be reset while more is sent
    assert_eq!(status(&desk.ask("hello\r\n\r\n")), "400");
    assert_eq!(status(&desk.get(&desk.path, &host)), "200");
}

#[test]
fn contract_a_socket_is_for_the_page_alone() {
    let desk = desk();
    let origin = format!("http://{}", desk.host);
    for wrong in ["", "http://evil.example", "https://127.0.0.1", "null"] {
        assert!(desk.socket(wrong).is_err(), "{wrong}");
    }
    let mut socket = desk.socket(&origin).expect("a socket");
    let hello = socket.read().expect("hello").into_data();
    assert!(String::from_utf8_lossy(&hello).contains("\"kind\":\"hello\""));
    socket.send("{\"look\":1}".into()).expect("sent");
    assert!(String::from_utf8_lossy(&socket.read().expect("refused").into_data()).contains("refused"));
    // A message above the cap, 4 MiB, ends the page at once, not the server.
    let _ = socket.send("x".repeat((4 << 20) + 1).into());
    let ended = loop {
        if let Err(ended) = socket.read() {
            break ended;
        }
    };
    let waited = [ErrorKind::WouldBlock, ErrorKind::TimedOut];
    let waited = matches!(&ended, tungstenite::Error::Io(error) if waited.contains(&error.kind()));
    assert!(!waited, "{ended}");
    assert!(desk.socket(&origin).is_ok());
}

/// Two pages at once, and pages that vanish without a word in the middle of their work: their places are free again.
#[test]
fn contract_pages_that_vanish_leave_nothing_behind() {
    let desk = desk();
    let origin = format!("http://{}", desk.host);
    let look = r#"{"look":{"id":1,"place":{"damper":"ssvi","set":{}},"columns":800}}"#;
    // On a busy machine a page that vanished may hold its place a little longer than it takes to open the next.
    let soon = || {
        let begun = Instant::now();
        loop {
            match desk.socket(&origin) {
                Err(_) if begun.elapsed() < Duration::from_secs(20) => {
                    std::thread::sleep(Duration::from_millis(20));
                }
                answer => return answer.expect("a socket"),
            }
        }
    };
    for _ in 0..30 {
        let [mut one, mut other] = [0, 1].map(|_| soon());
        one.send(look.into()).expect("sent");
        other.send(look.into()).expect("sent");
        other.read().expect("hello");
        let whole = one.read().expect("hello").into_data();
        assert!(!whole.is_empty());
    }
    let begun = Instant::now();
    while desk.server.pages() > 0 {
        assert!(begun.elapsed() < Duration::from_secs(20), "{} pages are left", desk.server.pages());
        std::thread::sleep(Duration::from_millis(20));
    }
}
