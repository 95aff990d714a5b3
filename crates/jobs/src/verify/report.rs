//! The report of a verification.

use super::tally::Tally;
use super::values;
use crate::{Error, Observer};
use serde::Serialize;
use serde_json::{Value, json};
use std::path::Path;

/// What was found of a file, or of a directory.
#[derive(Debug, Serialize)]
struct Finding {
    /// The file below the directory that is verified; empty for the directory itself.
    file: String,
    /// Whether it holds; null where that cannot be checked.
    holds: Option<bool>,
    words: String,
}

/// A report to the observer; it collects what does not hold and what cannot be checked.
pub struct Report<'a> {
    pub watch: &'a dyn Observer,
    /// The largest relative difference that counts as held.
    within: f64,
    /// The prefix of a file's name in a message: its directory, where there are several.
    pub place: String,
    pub problems: Vec<String>,
    unchecked: Vec<String>,
    findings: Vec<Finding>,
}

impl<'a> Report<'a> {
    /// A report of nothing yet; numbers that differ by at most the share `within` hold.
    pub fn new(watch: &'a dyn Observer, within: f64) -> Self {
        let (problems, unchecked, findings) = (Vec::new(), Vec::new(), Vec::new());
        Self { watch, within, place: String::new(), problems, unchecked, findings }
    }

    /// Keeps a finding for the answer.
    pub fn found(&mut self, name: &str, holds: Option<bool>, words: &str) {
        let file = format!("{}{name}", self.place);
        self.findings.push(Finding { file, holds, words: words.to_owned() });
    }

    /// Reports what does not hold; `name` is the file, or empty.
    pub fn fail(&mut self, name: &str, words: &str) -> Result<(), Error> {
        let between = if name.is_empty() { "" } else { ", " };
        self.problems.push(format!("{}{name}{between}{words}", self.place));
        self.found(name, Some(false), words);
        let line = if name.is_empty() { format!("  {words}") } else { format!("  {name:<22} {words}") };
        self.watch.result(&line)
    }

    pub fn unchecked(&mut self, words: &str) -> Result<(), Error> {
        self.unchecked.push(format!("{}{words}", self.place));
        self.found("", None, words);
        self.watch.result(&format!("  cannot be checked: {words}"))
    }

    /// Compares a JSON file, or a part of it, with the same made again.
    pub fn compare(&mut self, name: &str, what: &str, said: &Value, again: &Value) -> Result<(), Error> {
        let tally = values::compare(said, again, self.within);
        self.tell(name, &format!("{what} made again"), &tally)
    }

    /// Reports how many numbers of the file `name` differ; `what` says which were compared.
    pub fn tell(&mut self, name: &str, what: &str, tally: &Tally) -> Result<(), Error> {
        let most = if tally.most.is_finite() {
            format!(
                "by at most {:.1e} of {} value",
                tally.most,
                if tally.differ == 1 { "its" } else { "their" }
            )
        } else {
            "and not only in digits".to_owned()
        };
        let words = match tally.differ {
            0 => "the same to the last bit".to_owned(),
            1 => format!("1 differs, {most}"),
            differ => format!("{differ} differ, {most}"),
        };
        if tally.most > self.within {
            self.problems.push(format!("{}{name}, {words}", self.place));
        }
        self.found(name, Some(tally.most <= self.within), &format!("{what}: {words}"));
        self.watch.result(&format!("  {name:<22} {what}: {words}"))
    }

    /// The result of all that was reported.
    pub fn end(self, path: &Path) -> Result<(), Error> {
        let Self { watch, within, problems, unchecked, findings, .. } = self;
        let unchecked = unchecked.join("; ");
        let holds = match (problems.is_empty(), unchecked.is_empty()) {
            (false, _) => Some(false),
            (true, false) => None,
            (true, true) => Some(true),
        };
        let results = path.display().to_string();
        watch.answered_with(
            &json!({ "results": results, "holds": holds, "within": within, "findings": findings }),
        )?;
        if problems.is_empty() && unchecked.is_empty() {
            let agrees = if within > 0.0 { format!("agrees within {within:e}") } else { "agrees".to_owned() };
            return watch.result(&format!(
                "holds: every file is as it was made, and all that was run or made again {agrees}"
            ));
        }
        if problems.is_empty() {
            return Err(Error::NotChecked { path: path.to_owned(), problem: unchecked });
        }
        let and = if unchecked.is_empty() { "" } else { "; cannot be checked: " };
        let problem = format!("does not hold: {}{and}{unchecked}", problems.join("; "));
        Err(Error::NotHeld { path: path.to_owned(), problem })
    }
}
