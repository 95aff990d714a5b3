//! Access control. A request must name this server as its host (which defeats DNS rebinding), come from its own page, and know the
//! token in the address.

use crate::limits::MOST_BYTES;
use crate::page::{FILES, File};

/// The head of a request.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Head {
    method: String,
    path: String,
    host: Option<String>,
    origin: Option<String>,
    upgrade: Option<String>,
    version: Option<String>,
    key: Option<String>,
}

/// The response to a request.
#[derive(Clone, Copy, Debug)]
pub enum Verdict<'a> {
    /// A file; without its bytes for a HEAD request.
    File(&'static File, bool),
    /// A WebSocket, with this key.
    Socket(&'a str),
    /// A refusal: status and reason.
    Refused(&'static str, &'static str),
}

/// Parses a head and its length; none while it is incomplete.
///
/// # Errors
/// It is malformed or too long.
pub fn head(bytes: &[u8]) -> Result<Option<(Head, usize)>, &'static str> {
    let mut headers = [httparse::EMPTY_HEADER; 64];
    let mut request = httparse::Request::new(&mut headers);
    let length = match request.parse(bytes) {
        Ok(httparse::Status::Complete(length)) => length,
        Ok(httparse::Status::Partial) if bytes.len() < MOST_BYTES => return Ok(None),
        Ok(httparse::Status::Partial) | Err(httparse::Error::TooManyHeaders) => {
            return Err("431 Request Header Fields Too Large");
        }
        Err(_) => return Err("400 Bad Request"),
    };
    let method = request.method.unwrap_or_default().to_owned();
    let path = request.path.unwrap_or_default().to_owned();
    let mut head = Head { method, path, ..Head::default() };
    for header in request.headers.iter() {
        let place = match header.name.to_ascii_lowercase().as_str() {
            "host" => &mut head.host,
            "origin" => &mut head.origin,
            "upgrade" => &mut head.upgrade,
            "sec-websocket-version" => &mut head.version,
            "sec-websocket-key" => &mut head.key,
            _ => continue,
        };
        // A repeated header would be ambiguous.
        if place.is_some() {
            return Err("400 Bad Request");
        }
        *place = Some(String::from_utf8_lossy(header.value).trim().to_owned());
    }
    Ok(Some((head, length)))
}

impl Head {
    /// The response at a port whose address has this token.
    pub fn verdict(&self, port: u16, token: &str) -> Verdict<'_> {
        let hosts = ["127.0.0.1", "localhost"].map(|name| format!("{name}:{port}"));
        let Some(host) = hosts.iter().find(|host| self.host.as_deref() == Some(host.as_str())) else {
            return Verdict::Refused("403 Forbidden", "the request names another host");
        };
        let origin = format!("http://{host}");
        if self.origin.as_ref().is_some_and(|other| *other != origin) {
            return Verdict::Refused("403 Forbidden", "the request comes from another page");
        }
        let known = self.path.strip_prefix('/').and_then(|path| path.split_once('/'));
        let Some(name) = known.and_then(|(key, name)| constant_time_eq(key, token).then_some(name)) else {
            return Verdict::Refused("403 Forbidden", "open the address that `retune explore` printed");
        };
        let sends = match self.method.as_str() {
            "GET" => true,
            "HEAD" => false,
            _ => return Verdict::Refused("405 Method Not Allowed", "only GET and HEAD are answered"),
        };
        if name != "socket" {
            return match FILES.iter().find(|file| file.name == name) {
                Some(file) => Verdict::File(file, sends),
                None => Verdict::Refused("404 Not Found", "there is no such file"),
            };
        }
        let is_socket = self.upgrade.as_ref().is_some_and(|to| to.eq_ignore_ascii_case("websocket"))
            && self.version.as_deref() == Some("13");
        match &self.key {
            Some(key) if is_socket && self.origin.is_some() && sends => Verdict::Socket(key),
            _ => Verdict::Refused("403 Forbidden", "a socket is opened by the page alone"),
        }
    }
}

/// Compares two words in a time that does not depend on where they differ.
fn constant_time_eq(one: &str, other: &str) -> bool {
    let differ = one.bytes().zip(other.bytes()).fold(0, |differ, (a, b)| differ | (a ^ b));
    one.len() == other.len() && differ == 0
}

/// The head of an answer.
pub fn answer(status: &str, kind: &str, length: usize) -> String {
    // No foreign resources, no frames, no caching.
    format!(
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {length}\r\nConnection: close\r\n\
         Content-Security-Policy: default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; \
         connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'\r\n\
         Cross-Origin-Opener-Policy: same-origin\r\nCross-Origin-Resource-Policy: same-origin\r\n\
         X-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\nCache-Control: no-store\r\n\r\n"
    )
}
