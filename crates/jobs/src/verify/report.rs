//! The report of a verification.

use crate::recompute::{Numbers, Row, Source, each_row};
use crate::{Error, Observer};
use rayon::prelude::*;
use retune_study::counted;
use serde::Serialize;
use serde_json::{Value, json};
use std::path::Path;

/// A finding on a file or a directory.
#[derive(Debug, Serialize)]
struct Finding {
    /// The file below the directory that is verified; empty for the directory itself.
    file: String,
    /// Whether it holds; null if that cannot be checked.
    holds: Option<bool>,
    words: String,
}

/// Reports to the observer, and collects what does not hold or cannot be checked.
pub struct Report<'a> {
    pub watch: &'a dyn Observer,
    /// The largest relative difference that counts as held.
    within: f64,
    /// The prefix of file names in messages: the directory, if there are several.
    pub place: String,
    pub problems: Vec<String>,
    unchecked: Vec<String>,
    findings: Vec<Finding>,
}

impl<'a> Report<'a> {
    /// An empty report; numbers hold if their relative difference is at most `within`.
    pub fn new(watch: &'a dyn Observer, within: f64) -> Self {
        let (problems, unchecked, findings) = (Vec::new(), Vec::new(), Vec::new());
        Self { watch, within, place: String::new(), problems, unchecked, findings }
    }

    /// Keeps a finding for the answer.
    pub fn found(&mut self, name: &str, holds: Option<bool>, words: &str) {
        let file = format!("{}{name}", self.place);
        self.findings.push(Finding { file, holds, words: words.to_owned() });
    }

    /// Reports a file that does not hold; `name` is empty for the directory.
    pub fn fail(&mut self, name: &str, words: &str) -> Result<(), Error> {
        let between = if name.is_empty() { "" } else { ", " };
        self.problems.push(format!("{}{name}{between}{words}", self.place));
        self.found(name, Some(false), words);
        let line = if name.is_empty() { format!("  {words}") } else { format!("  {name:<22} {words}") };
        self.watch.result(&line)
    }

    pub fn unchecked(&mut self, words: &str) -> Result<(), Error> {
        let below = self.place.strip_suffix('/').map_or_else(String::new, |place| format!("{place}: "));
        self.unchecked.push(format!("{below}{words}"));
        self.found("", None, words);
        self.watch.result(&format!("  cannot be checked: {words}"))
    }

    /// Compares a JSON file, or a part of it, with its recomputed value.
    pub fn compare(
        &mut self,
        name: &str,
        what: &str,
        stored: &Value,
        recomputed: &Value,
    ) -> Result<(), Error> {
        let tally = differences(stored, recomputed, self.within);
        self.report_tally(name, &format!("{what} made again"), &tally)
    }

    /// Recomputes at most `most` rows, evenly spread, and compares each of their numbers with the file.
    pub fn check_rows(&mut self, path: &Path, name: &str, source: &Source, most: usize) -> Result<(), Error> {
        let mut applicable = Vec::new();
        let mut names = csv::StringRecord::new();
        let mut count = 0_u64;
        each_row(path, |number, row| {
            names.clone_from(row.names);
            count += 1;
            if (source.applies)(row) {
                applicable.push(number);
            }
        })?;
        let kept = applicable.len().min(most);
        let place = |i: usize| applicable[i * (applicable.len() - 1) / kept.saturating_sub(1).max(1)];
        let wanted: Vec<usize> = (0..kept).map(place).collect();
        let mut rows = Vec::with_capacity(kept);
        each_row(path, |number, row| {
            if wanted.get(rows.len()) == Some(&number) {
                rows.push(row.fields.clone());
            }
        })?;
        let recompute = |fields: &csv::StringRecord| (source.row)(Row { names: &names, fields });
        let found: Vec<Option<Numbers>> = rows.par_iter().map(recompute).collect();
        let mut tally = Tally::default();
        let compared = found.iter().flatten().next().map_or_else(String::new, columns);
        for ((fields, number), found) in rows.iter().zip(&wanted).zip(found) {
            let row = Row { names: &names, fields };
            let at = |name: &str| format!("{name} in row {}", number + 1);
            match found {
                Some(found) => {
                    let mut compare =
                        |(name, found): &(String, f64)| tally.compare(row.number(name), *found, || at(name));
                    found.iter().for_each(&mut compare);
                }
                None => tally.differs(f64::INFINITY, || at("what no command writes")),
            }
        }
        self.report_tally(name, &format!("{kept} of {} run again{compared}", counted(count, "row")), &tally)
    }

    /// Reports how many numbers of the file `name` differ; `what` describes those compared.
    pub fn report_tally(&mut self, name: &str, what: &str, tally: &Tally) -> Result<(), Error> {
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
            1 => format!("1 differs, {most}: {}", tally.at),
            differ => format!("{differ} differ, {most}: {}", tally.at),
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

/// Most columns that are named individually.
const MOST_NAMED: usize = 8;

/// Which columns of a table are compared, in words.
fn columns(numbers: &Numbers) -> String {
    let names: Vec<&str> = numbers.iter().map(|(name, _)| name.as_str()).collect();
    match names.as_slice() {
        [first, .., last] if names.len() > MOST_NAMED => format!(" ({first} to {last})"),
        few => format!(" ({})", few.join(", ")),
    }
}

/// The differences between stored and recomputed numbers.
#[derive(Default)]
pub struct Tally {
    differ: usize,
    most: f64,
    /// The place of the first largest difference, with both numbers.
    at: String,
}

impl Tally {
    /// Compares two numbers; two that are not finite are the same: no value.
    fn compare(&mut self, stored: f64, found: f64, at: impl FnOnce() -> String) {
        let none = |value: f64| !value.is_finite();
        if stored.to_bits() != found.to_bits() && !(none(stored) && none(found)) {
            let difference = (stored - found).abs() / stored.abs().max(found.abs());
            let by = if difference.is_finite() { difference } else { f64::INFINITY };
            self.differs(by, || format!("{} is {stored:e}, now {found:e}", at()));
        }
    }

    fn differs(&mut self, by: f64, at: impl FnOnce() -> String) {
        self.differ += 1;
        if by > self.most {
            (self.most, self.at) = (by, at());
        }
    }
}

/// Compares every field of `recomputed`: numbers by their relative difference, anything else must be equal. Fields that `recomputed` does
/// not have and the version of Retune are ignored; so are texts with numbers in them where `within` allows differences.
fn differences(stored: &Value, recomputed: &Value, within: f64) -> Tally {
    let mut tally = Tally::default();
    visit(stored, recomputed, within, "", &mut tally);
    tally
}

/// `path` has the names of the enclosing fields, each followed by a full stop.
fn visit(stored: &Value, recomputed: &Value, within: f64, path: &str, tally: &mut Tally) {
    let at = || path.trim_end_matches('.').to_owned();
    match (stored, recomputed) {
        (_, Value::Object(fields)) => {
            let made_of_numbers = |name: &str| within > 0.0 && ["words", "at"].contains(&name);
            for (name, recomputed) in
                fields.iter().filter(|(name, _)| *name != "retune" && !made_of_numbers(name))
            {
                visit(&stored[name.as_str()], recomputed, within, &format!("{path}{name}."), tally);
            }
        }
        (Value::Array(stored), Value::Array(recomputed)) if stored.len() == recomputed.len() => {
            for (i, (stored, recomputed)) in stored.iter().zip(recomputed).enumerate() {
                visit(stored, recomputed, within, &format!("{path}{i}."), tally);
            }
        }
        // A number that is not finite is null.
        (Value::Number(_) | Value::Null, Value::Number(_) | Value::Null) => {
            let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
            tally.compare(number(stored), number(recomputed), at);
        }
        _ if stored == recomputed => {}
        _ => tally.differs(f64::INFINITY, at),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn contract_every_leaf_is_compared() {
        let recomputed =
            json!({ "a": [1.0, null], "retune": "2", "b": { "verdict": "robust", "words": "so" } });
        let look = |stored: Value, within: f64| {
            let Tally { differ, most, .. } = differences(&stored, &recomputed, within);
            (differ, most)
        };
        let with = |path: &str, value: Value| {
            let mut stored = recomputed.clone();
            *stored.pointer_mut(path).expect(path) = value;
            stored
        };
        assert_eq!(look(with("/retune", json!("1")), 0.0), (0, 0.0));
        assert_eq!(look(with("/a/0", json!(0.5)), 0.0), (1, 0.5));
        assert_eq!(look(with("/a/1", json!(0.5)), 0.0), (1, f64::INFINITY));
        assert_eq!(look(with("/a", json!([1.0])), 0.0), (1, f64::INFINITY));
        assert_eq!(look(with("/b/verdict", json!("sensitive")), 0.1), (1, f64::INFINITY));
        assert_eq!(look(with("/b/words", json!("other")), 0.0), (1, f64::INFINITY));
        assert_eq!(look(with("/b/words", json!("other")), 0.1), (0, 0.0));
        assert_eq!(look(with("/b", json!("gone")), 0.0), (2, f64::INFINITY));
    }
}
