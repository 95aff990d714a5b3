//! Output: results and the log on standard output, errors and progress on standard error.

use crate::{interrupt, progress};
use retune_jobs::answer;
use retune_jobs::{Error, Observer, Progress};
use retune_study::visible;
use serde_json::Value;
use std::fmt::Display;
use std::io::{ErrorKind, IsTerminal, Write};
use std::path::Path;

/// The observer of all jobs: shows them on the terminal.
#[derive(Clone, Copy, Debug)]
pub struct Screen {
    quiet: bool,
    verbose: bool,
    /// Whether only the answer is shown, as JSON.
    json: bool,
}

impl Screen {
    /// A screen that shows results; also progress unless `quiet`, and the log if `verbose`.
    pub fn new(quiet: bool, verbose: bool) -> Self {
        Self { quiet, verbose, json: false }
    }

    /// If `json`, shows only the answer, as JSON.
    pub fn as_json(self, json: bool) -> Self {
        Self { json, quiet: self.quiet || json, ..self }
    }

    /// Shows a line of the result.
    ///
    /// # Errors
    /// Standard output cannot be written. A reader that has closed the pipe (`retune ... | head`) is not an error: the job is
    /// completed and its files are written all the same.
    pub fn line(&self, text: impl Display) -> Result<(), Error> {
        let mut out = std::io::stdout().lock();
        let text = emphasised(&visible(&text.to_string()), has_colour(&out));
        match writeln!(out, "{text}").and_then(|()| out.flush()) {
            Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
            Err(source) => Err(retune_store::Error::Output { path: "standard output".into(), source }.into()),
            Ok(()) => Ok(()),
        }
    }
}

impl Observer for Screen {
    fn result(&self, line: &str) -> Result<(), Error> {
        if self.json {
            return Ok(());
        }
        self.line(as_typed(line, std::env::var(interrupt::RUN_AS).ok()))
    }
    fn so_far(&self, line: &str) -> Result<(), Error> {
        if self.quiet { Ok(()) } else { self.result(line) }
    }
    fn log(&self, line: &str) -> Result<(), Error> {
        if self.verbose { self.line(line) } else { Ok(()) }
    }
    fn warn(&self, words: &str) {
        write_stderr("warning", words);
    }
    fn progress(&self, stage: &'static str, count: u64) -> Box<dyn Progress> {
        Box::new(progress::Stage::new(stage, count, self.quiet))
    }
    fn resumable(&self) {
        interrupt::say_how_to_resume();
    }
    fn answered(&self, file: &Path) -> Result<(), Error> {
        if self.json { self.line(answer::as_json(file)?) } else { Ok(()) }
    }
    fn answered_with(&self, json: &Value) -> Result<(), Error> {
        if self.json { self.line(answer::text(json)?) } else { Ok(()) }
    }
}

/// Shows why a command failed. If standard error cannot be written, only the exit code reports the failure.
pub fn show_error(error: &Error) {
    write_stderr("error", &as_typed(&error.to_string(), std::env::var(interrupt::RUN_AS).ok()));
}

/// Replaces the program's name in the commands of a message by `run_as`, if it is given.
fn as_typed(words: &str, run_as: Option<String>) -> String {
    match run_as {
        Some(run_as) => words.replace("`retune ", &format!("`{run_as} ")),
        None => words.to_owned(),
    }
}

/// Shows why a line of input has no value. If standard error cannot be written, only the answer reports it.
pub fn complain(words: &str) {
    let _ = writeln!(std::io::stderr(), "{}", visible(words));
}

/// Writes to standard error and ignores write errors.
fn write_stderr(what: &str, words: &str) {
    let mut out = std::io::stderr().lock();
    let colour = if what == "error" { "31" } else { "33" };
    let what = if has_colour(&out) { format!("\x1b[1;{colour}m{what}\x1b[0m") } else { what.to_owned() };
    let _ = writeln!(out, "{what}: {}", visible(words));
}

/// Whether a stream shows colours: it is a terminal, and the user has not disabled them (<https://no-color.org>).
fn has_colour(stream: &impl IsTerminal) -> bool {
    let wants_none = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
    stream.is_terminal() && !wants_none && std::env::var_os("TERM").is_none_or(|term| term != "dumb")
}

/// How lines begin that answer the user's question.
const ANSWERS: [&str; 4] = ["Build ", "None was found", "  verdict ", "  build "];

/// Makes the lines that answer the question bold if the terminal has colours.
fn emphasised(text: &str, colour: bool) -> String {
    let line = |line: &str| match colour && ANSWERS.iter().any(|answer| line.starts_with(answer)) {
        true => format!("\x1b[1m{line}\x1b[0m"),
        false => line.to_owned(),
    };
    text.split('\n').map(line).collect::<Vec<_>>().join("\n")
}

/// Shows an error in the arguments, or the help that was requested. Returns the exit code.
pub fn show_usage(error: &clap::Error) -> u8 {
    if error.use_stderr() && error.kind() != clap::error::ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand
    {
        let _ = write!(std::io::stderr(), "{}", visible(&error.render().to_string()));
    } else {
        let _ = error.print(); // in colour; repeats nothing that the user typed
    }
    u8::try_from(error.exit_code()).unwrap_or(crate::exit::WRONG)
}

#[cfg(test)]
mod tests {
    use super::emphasised;

    #[test]
    fn contract_the_answer_is_bold_on_a_terminal_and_plain_elsewhere() {
        let text = "largest  TMD\n\nBuild the TMD: m2 = 800 kg.\n  Alone, it has 2 Hz.";
        assert_eq!(emphasised(text, false), text);
        let bold = emphasised(text, true);
        assert_eq!(
            bold,
            text.replace("Build the TMD: m2 = 800 kg.", "\x1b[1mBuild the TMD: m2 = 800 kg.\x1b[0m")
        );
    }
}
