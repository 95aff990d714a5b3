//! Lines of an input, read in a thread of their own so that several can be evaluated together.

use std::io::{BufRead, Error, Result};
use std::sync::mpsc::{Receiver, sync_channel};

pub const MOST: usize = 4096;

#[derive(Debug, PartialEq)]
pub enum Line {
    /// Its text; invalid UTF-8 is replaced.
    Text(String),
    /// One that is longer than [`MOST`]; its text is not kept.
    Long,
}

/// The lines of an input, at most `ahead` of them read in advance.
pub fn lines(mut input: impl BufRead + Send + 'static, ahead: usize) -> Receiver<Result<Line>> {
    let (sender, receiver) = sync_channel(ahead);
    let read = move || {
        while let Some(line) = next(&mut input).transpose() {
            let broken = line.is_err();
            if sender.send(line).is_err() || broken {
                break; // the receiver is gone
            }
        }
    };
    // The thread is not joined: when the answers are no longer read, it may still wait for a line.
    let started = std::thread::Builder::new().name("input".to_owned()).spawn(read);
    if let Err(error) = started {
        let (sender, receiver) = sync_channel(1);
        let _ = sender.send(Err(Error::other(error)));
        return receiver;
    }
    receiver
}

/// The next line; `None` at the end.
fn next(input: &mut impl BufRead) -> Result<Option<Line>> {
    let mut line = Vec::new();
    let (mut any, mut long) = (false, false);
    loop {
        let there = input.fill_buf()?;
        if there.is_empty() {
            break;
        }
        any = true;
        let end = there.iter().position(|byte| *byte == b'\n');
        let part = &there[..end.unwrap_or(there.len())];
        long |= line.len() + part.len() > MOST;
        if !long {
            line.extend_from_slice(part);
        }
        let used = part.len() + usize::from(end.is_some());
        input.consume(used);
        if end.is_some() {
            break;
        }
    }
    let text = || Line::Text(String::from_utf8_lossy(&line).into_owned());
    Ok(any.then(|| if long { Line::Long } else { text() }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::BufReader;

    #[test]
    fn contract_lines_are_taken_apart_and_long_ones_not_kept() {
        let most = "1".repeat(MOST);
        let input = format!("1 2\n\n{most}\n{most}1\nlast");
        for capacity in [1, 7, 1 << 16] {
            let mut input = BufReader::with_capacity(capacity, input.as_bytes());
            let mut lines = Vec::new();
            while let Some(line) = next(&mut input).expect("readable") {
                lines.push(line);
            }
            let text = |text: &str| Line::Text(text.to_owned());
            assert_eq!(lines, [text("1 2"), text(""), text(&most), Line::Long, text("last")]);
        }
    }
}
