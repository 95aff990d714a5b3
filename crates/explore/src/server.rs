//! The server: listens on the loopback address only, with one thread per connection.

use crate::http::{self, Verdict};
use crate::limits::{MOST_PAGES, MOST_RECORD};
use crate::protocol::Answer;
use crate::session;
use crate::start::Start;
use retune_jobs::{Error, Observer};
use std::io::{Read, Write};
use std::net::{Ipv4Addr, Shutdown, TcpListener, TcpStream};
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering::SeqCst};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};
use tungstenite::handshake::derive_accept_key;
use tungstenite::protocol::{Role, WebSocketConfig};
use tungstenite::{Message, WebSocket};

/// Time limit for receiving the head of a request, and for a page to accept data.
const TIMEOUT: Duration = Duration::from_secs(10);
/// Most connections at once, files and pages.
const MOST_CONNECTIONS: usize = 4 * MOST_PAGES;

/// The options of the command line.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// A study, an `optimum.json` or a directory of results; the paper's SSVI NES if none is named.
    pub study: Option<PathBuf>,
    /// The port; 0 for any free one.
    pub port: u16,
    /// Whether the page is opened in a browser.
    pub browser: bool,
    /// Most threads of all pages together; all cores by default.
    pub threads: Option<u16>,
}

/// Serves the page until the process ends.
///
/// # Errors
/// The study is wrong, or the port is taken.
pub fn explore(options: &Options, watch: &dyn Observer) -> Result<(), Error> {
    let server = Server::open(options)?;
    if let Some(threads) = options.threads {
        // The pool belongs to the process and is shared by its pages; one that exists already stays.
        let _ = rayon::ThreadPoolBuilder::new().num_threads(threads.into()).build_global();
    }
    watch.result(&format!("{}\nends with Ctrl-C", server.address()))?;
    if options.browser
        && let Err(error) = open::that_detached(server.address())
    {
        watch.warn(&format!("no browser could be opened ({error}): open the address yourself"));
    }
    server.serve();
    Ok(())
}

/// A server that listens.
pub struct Server {
    listener: TcpListener,
    shared: Arc<Shared>,
}

/// What all connections share.
struct Shared {
    start: Start,
    port: u16,
    token: String,
    connections: AtomicUsize,
    pages: AtomicUsize,
}

impl Server {
    /// Reads the study and begins to listen.
    ///
    /// # Errors
    /// The study is wrong, or the port is taken.
    pub fn open(options: &Options) -> Result<Self, Error> {
        let start = Start::read(options.study.as_deref())?;
        let refuse = |error: &dyn std::fmt::Display| Error::Argument {
            option: "--port",
            problem: format!("{} cannot be listened on: {error}", options.port),
        };
        let listener =
            TcpListener::bind((Ipv4Addr::LOCALHOST, options.port)).map_err(|error| refuse(&error))?;
        let port = listener.local_addr().map_err(|error| refuse(&error))?.port();
        let mut secret = [0_u8; 16];
        getrandom::fill(&mut secret).map_err(|error| refuse(&error))?;
        let token = secret.iter().map(|byte| format!("{byte:02x}")).collect();
        let (connections, pages) = Default::default();
        Ok(Self { listener, shared: Arc::new(Shared { start, port, token, connections, pages }) })
    }

    /// The address of the page, with its token.
    pub fn address(&self) -> String {
        format!("http://127.0.0.1:{}/{}/", self.shared.port, self.shared.token)
    }

    /// The pages that are open now.
    pub fn pages(&self) -> usize {
        self.shared.pages.load(SeqCst)
    }

    /// Answers connections forever.
    pub fn serve(&self) {
        for stream in self.listener.incoming() {
            // Either the connection failed before it began, or the process has no more handles until some close.
            let Ok(stream) = stream else {
                std::thread::sleep(Duration::from_millis(20));
                continue;
            };
            let shared = Arc::clone(&self.shared);
            let Some(guard) = Slot::new(&shared, |shared| &shared.connections, MOST_CONNECTIONS) else {
                continue;
            };
            let connection = move || {
                // An error here means that the page was closed.
                let _ = connection(stream, &guard.0);
            };
            let _ = std::thread::Builder::new().name("page".to_owned()).spawn(connection);
        }
    }
}

/// A slot in a limited number of connections or pages; dropping it frees it.
struct Slot(Arc<Shared>, fn(&Shared) -> &AtomicUsize);

impl Slot {
    fn new(shared: &Arc<Shared>, of: fn(&Shared) -> &AtomicUsize, most: usize) -> Option<Self> {
        let counted = Self(Arc::clone(shared), of);
        (of(shared).fetch_add(1, SeqCst) < most).then_some(counted)
    }
}

impl Drop for Slot {
    fn drop(&mut self) {
        (self.1)(&self.0).fetch_sub(1, SeqCst);
    }
}

/// Answers one request; serves a WebSocket until the page is closed.
fn connection(mut stream: TcpStream, shared: &Arc<Shared>) -> std::io::Result<()> {
    stream.set_nodelay(true)?;
    stream.set_write_timeout(Some(TIMEOUT))?;
    let begun = Instant::now();
    let mut bytes = Vec::new();
    let (head, length) = loop {
        match http::head(&bytes) {
            Ok(Some(found)) => break found,
            Err(status) => return refuse(&mut stream, status, "this is no request that is answered here"),
            Ok(None) => {}
        }
        let left = TIMEOUT.checked_sub(begun.elapsed()).filter(|left| !left.is_zero());
        let Some(left) = left else { return Ok(()) };
        stream.set_read_timeout(Some(left))?;
        let mut more = [0; 4096];
        match stream.read(&mut more)? {
            0 => return Ok(()),
            read => bytes.extend_from_slice(&more[..read]),
        }
    };
    match head.verdict(shared.port, &shared.token) {
        Verdict::Refused(status, words) => refuse(&mut stream, status, words),
        Verdict::File(file, sends) => {
            stream.write_all(http::answer("200 OK", file.kind, file.bytes.len()).as_bytes())?;
            if sends { stream.write_all(file.bytes) } else { Ok(()) }
        }
        Verdict::Socket(key) => {
            let Some(_page) = Slot::new(shared, |shared| &shared.pages, MOST_PAGES) else {
                return refuse(&mut stream, "503 Service Unavailable", "too many pages are open");
            };
            let accept = derive_accept_key(key.as_bytes());
            let switch = "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade";
            stream.write_all(format!("{switch}\r\nSec-WebSocket-Accept: {accept}\r\n\r\n").as_bytes())?;
            stream.set_read_timeout(None)?;
            socket(stream, bytes.split_off(length), &shared.start)
        }
    }
}

fn refuse(stream: &mut TcpStream, status: &str, words: &str) -> std::io::Result<()> {
    let words = format!("{words}\n");
    stream.write_all(http::answer(status, "text/plain; charset=utf-8", words.len()).as_bytes())?;
    stream.write_all(words.as_bytes())
}

/// A connection that two threads write to. Each write is a whole number of frames, sent under a lock.
struct Duplex {
    read: TcpStream,
    write: Arc<Mutex<TcpStream>>,
}

impl Read for Duplex {
    fn read(&mut self, into: &mut [u8]) -> std::io::Result<usize> {
        self.read.read(into)
    }
}

impl Write for Duplex {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.write.lock().unwrap_or_else(PoisonError::into_inner).write_all(bytes)?;
        Ok(bytes.len())
    }
    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

/// Serves a page. One WebSocket reads and answers pings, another on the same stream sends.
fn socket(stream: TcpStream, received: Vec<u8>, start: &Start) -> std::io::Result<()> {
    let config = WebSocketConfig::default()
        .read_buffer_size(4096)
        .write_buffer_size(0)
        .max_message_size(Some(MOST_RECORD))
        .max_frame_size(Some(MOST_RECORD));
    let write = Arc::new(Mutex::new(stream.try_clone()?));
    let duplex = || Ok::<_, std::io::Error>(Duplex { read: stream.try_clone()?, write: Arc::clone(&write) });
    let mut reader = WebSocket::from_partially_read(duplex()?, received, Role::Server, Some(config));
    let sender = Mutex::new(WebSocket::from_raw_socket(duplex()?, Role::Server, Some(config)));
    let send = |answer: Answer| {
        let message = Message::binary(answer.bytes());
        let sent = sender.lock().unwrap_or_else(PoisonError::into_inner).send(message).is_ok();
        if !sent {
            let _ = stream.shutdown(Shutdown::Both); // ends the reader too
        }
        sent
    };
    session::serve(start, &send, || {
        loop {
            match reader.read().ok()? {
                Message::Text(text) => return Some(text.to_string()),
                Message::Close(_) => return None,
                _ => {} // pings are answered already; the page sends nothing else
            }
        }
    });
    let _ = stream.shutdown(Shutdown::Both);
    Ok(())
}
