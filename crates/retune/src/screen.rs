//! What appears on the screen: results and the log on standard output, errors and progress on standard error.

use crate::{interrupt, progress};
use retune_workbench::{Error, Observer, Progress};
use std::borrow::Cow;
use std::fmt::Display;
use std::io::{ErrorKind, Write};
use std::process::ExitCode;

/// Where output goes.
#[derive(Clone, Copy, Debug)]
pub struct Screen {
    quiet: bool,
}

impl Screen {
    /// A screen that shows results, and unless `quiet` also the log and progress.
    pub fn new(quiet: bool) -> Self {
        Self { quiet }
    }

    /// Shows a line of the result.
    ///
    /// # Errors
    /// Standard output cannot be written. A reader that has gone (`retune ... | head`) is no error: the work is finished and
    /// its files are written all the same.
    pub fn line(&self, text: impl Display) -> Result<(), Error> {
        let mut out = std::io::stdout().lock();
        match writeln!(out, "{}", visible(&text.to_string())).and_then(|()| out.flush()) {
            Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
            Err(source) => Err(retune_store::Error::Output { path: "standard output".into(), source }.into()),
            Ok(()) => Ok(()),
        }
    }
}

impl Observer for Screen {
    fn result(&self, line: &str) -> Result<(), Error> {
        self.line(line)
    }
    fn log(&self, line: &str) -> Result<(), Error> {
        if self.quiet { Ok(()) } else { self.line(line) }
    }
    fn warn(&self, words: &str) {
        say("warning", words);
    }
    fn progress(&self, stage: &'static str, count: u64) -> Box<dyn Progress> {
        Box::new(progress::Stage::new(stage, count, self.quiet))
    }
    fn resumable(&self) {
        interrupt::say_how_to_go_on();
    }
}

/// Shows why a command failed. Where even that cannot be written, the exit code must do.
pub fn show_error(error: &Error) {
    say("error", &error.to_string());
}

/// Shows a line about an input that has no value; where that cannot be written, the answer must do.
pub fn complain(words: &str) {
    let _ = writeln!(std::io::stderr(), "{}", visible(words));
}

/// Writes to standard error; where that cannot be, nothing can be done about it.
fn say(what: &str, words: &str) {
    let _ = writeln!(std::io::stderr(), "{what}: {}", visible(words));
}

/// Shows what is wrong with the arguments, or the help that they ask for; the exit code.
pub fn show_usage(error: &clap::Error) -> ExitCode {
    if error.use_stderr() && error.kind() != clap::error::ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand
    {
        let _ = write!(std::io::stderr(), "{}", visible(&error.render().to_string()));
    } else {
        let _ = error.print(); // in colours; nothing that was typed is in it
    }
    ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2))
}

/// A text whose control characters are seen instead of obeyed: a terminal takes orders from whoever names a file or a study.
/// Ends of lines stay; so do tabs. The form is that of JSON, so what is in a JSON text stays the same text.
pub fn visible(text: &str) -> Cow<'_, str> {
    if !text.contains(is_order) {
        return text.into();
    }
    let mut shown = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if is_order(c) {
            shown += &format!("\\u{:04x}", u32::from(c));
        } else {
            shown.push(c);
        }
    }
    shown.into()
}

/// Whether a terminal may obey a character: controls, and those that turn the direction of writing.
fn is_order(c: char) -> bool {
    const TURNS: [std::ops::RangeInclusive<char>; 3] =
        ['\u{200e}'..='\u{200f}', '\u{202a}'..='\u{202e}', '\u{2066}'..='\u{2069}'];
    c.is_control() && !['\n', '\t'].contains(&c) || TURNS.iter().any(|turns| turns.contains(&c))
}

#[cfg(test)]
mod tests {
    use super::visible;

    #[test]
    fn contract_control_characters_are_escaped() {
        assert_eq!(visible("a\tb\nÄ √ N·s/m"), "a\tb\nÄ √ N·s/m");
        assert_eq!(
            visible("\u{1b}[2Jx\r\u{7}\u{9b}\u{7f}\u{202e}"),
            "\\u001b[2Jx\\u000d\\u0007\\u009b\\u007f\\u202e"
        );
        for c in (0..=0x10_ffff).filter_map(char::from_u32).filter(|c| c.is_control()) {
            assert_eq!(visible(&c.to_string()) == c.to_string(), c == '\n' || c == '\t', "{c:?}");
        }
        let json = serde_json::to_string("a\u{1b}\u{9b}\u{7f}\r\n\u{202e}").expect("JSON");
        let read: String = serde_json::from_str(&visible(&json)).expect("JSON still");
        assert_eq!(read, "a\u{1b}\u{9b}\u{7f}\r\n\u{202e}");
    }
}
