//! `evaluate`: the objective of a study as a service, for optimisers outside of Retune.

use crate::tune::objective::objective;
use crate::{Error, Request};
use rayon::prelude::*;
use retune_optim::{DesignObjective, Evaluation, Parameter, Unusable};
use retune_study::Study;
use serde_json::json;
use std::io::{BufRead, ErrorKind, Read, Write};
use std::sync::mpsc::{Receiver, sync_channel};
use thiserror::Error;

/// The protocol, for `--help`.
pub const PROTOCOL: &str = "\
A design is a line on standard input: one number in SI units for each parameter that the study tunes, in the order k2 c2 D C m2 R, with \
blanks or commas between them. Each line, an empty one too, is answered by one line on standard output, in order:

  160.605      the value by the study's objective (E1max in J, or what optimize.objective.quantity names) of a design that keeps \
the limits
  inf          the design breaks a limit
  error: ...   the design has no value, or the line is no design; the same goes to standard error with the number of the line \
(the first 100), and the exit code at the end is 1

A line is answered at once if it comes alone; of lines that come together, as many as there are threads are evaluated side by side. \
A line has at most 4096 bytes. The end of the input ends the program.

With --json the answer is an object: {\"E1max\": 190.2, \"violation\": 0.02, \"reached\": {\"stroke\": 0.153}}. E1max is then given whether limits \
are kept or not; violation is the sum of reached / limit - 1 over the limits that are broken, 0 if none is; then follows what is \
reached of each quantity that the study limits, by its name (stroke and cavity in m, contact_force in N). Another quantity has its own name in the place of E1max. A line without a value is {\"error\": \"...\"}.

The bounds of the study are those of its searches: a design beyond them is evaluated all the same.

An optimiser that takes constraints (SciPy's NonlinearConstraint, MATLAB's nonlcon, Optuna's constraints_func) makes E1max small \
under violation <= 0. One that takes none, and has to find its way to designs that keep the limits, makes E1max small where violation \
is 0 and 1e6 * (1 + violation) elsewhere, with a number above every E1max in the place of 1e6. One that stops at inf (a fit, a \
gradient) needs the same.";

/// Number of lines without a value that are reported on standard error. It is limited so that a full pipe that nobody reads cannot block
/// the answers.
const REPORTED: u64 = 100;

/// Why a line has no value.
#[derive(Clone, Debug, PartialEq, Error)]
#[expect(missing_docs, reason = "its words say what each is and holds")]
pub enum LineError {
    #[error("give one number for each of {}; found {found}", words(.wanted))]
    Count { found: usize, wanted: Vec<Parameter> },
    #[error("{variable}: \"{}\" is not a number", shown(.text))]
    Number { variable: Parameter, text: String },
    #[error("the line is longer than {} bytes", MOST_BYTES)]
    Long,
    #[error(transparent)]
    Unusable(#[from] Unusable),
}

fn words(variables: &[Parameter]) -> String {
    variables.iter().map(|variable| variable.symbol()).collect::<Vec<_>>().join(" ")
}

/// The beginning of a text, safe for a terminal.
fn shown(text: &str) -> String {
    const MOST: usize = 40;
    let begin: String = text.chars().take(MOST).flat_map(char::escape_debug).collect();
    if text.chars().nth(MOST).is_some() { begin + "..." } else { begin }
}

/// The input of designs and the outputs.
pub struct Streams<'a, I> {
    /// The designs, one per line.
    pub input: I,
    /// Receives an answer for each line.
    pub answers: &'a mut (dyn Write + Send),
    /// Receives a message for each line without a value.
    pub complaints: &'a mut (dyn FnMut(&str) + Send),
}

/// Reads designs, one per line, and answers each; see [`PROTOCOL`]. Ends with its input, or when the answers are no longer read. At
/// most `threads` lines (by default as many as there are cores) are evaluated in parallel.
///
/// # Errors The study tunes nothing, the input cannot be read, the answers cannot be written, or a line had no value.
pub fn evaluate<I: BufRead + Send + 'static>(
    study: &Study,
    json: bool,
    request: &Request,
    streams: Streams<'_, I>,
) -> Result<(), Error> {
    let search = study.search().map_err(Error::rule(study))?;
    let objective = objective(study, &search, &search.variables);
    request.on_threads(|| answer(&objective, json, streams))
}

fn answer<I: BufRead + Send + 'static>(
    objective: &DesignObjective,
    json: bool,
    Streams { input, answers, complaints }: Streams<'_, I>,
) -> Result<(), Error> {
    let batch_size = rayon::current_num_threads();
    let lines = lines(input, batch_size);
    let (mut count, mut failed) = (0, 0);
    while let Ok(first) = lines.recv() {
        let refuse = |source| retune_store::Error::Input { path: "standard input".into(), source };
        let mut batch = vec![first.map_err(refuse)?];
        while batch.len() < batch_size
            && let Ok(Ok(line)) = lines.try_recv()
        {
            batch.push(line);
        }
        let found: Vec<Result<Evaluation, LineError>> =
            batch.par_iter().map(|line| value(objective, line)).collect();
        let mut text = String::new();
        for found in &found {
            count += 1;
            if let Err(reason) = found {
                failed += 1;
                complain(count, failed, reason, complaints);
            }
            text += &if json { object(objective, found) } else { plain(found) };
            text.push('\n');
        }
        match answers.write_all(text.as_bytes()).and_then(|()| answers.flush()) {
            Err(error) if error.kind() == ErrorKind::BrokenPipe => break,
            Err(source) => {
                let path = "standard output".into();
                return Err(retune_store::Error::Output { path, source }.into());
            }
            Ok(()) => {}
        }
    }
    if failed == 0 { Ok(()) } else { Err(Error::Lines { failed, lines: count }) }
}

/// Reports a line without a value, for the first [`REPORTED`] of them.
fn complain(line: u64, failed: u64, reason: &LineError, complaints: &mut dyn FnMut(&str)) {
    if failed <= REPORTED {
        complaints(&format!("error: line {line}: {reason}"));
    } else if failed == REPORTED + 1 {
        complaints("further lines without a value are answered on standard output only");
    }
}

fn plain(found: &Result<Evaluation, LineError>) -> String {
    match found {
        Ok(found) if found.violation > 0.0 => "inf".to_owned(),
        Ok(found) => found.value.to_string(),
        Err(reason) => format!("error: {reason}"),
    }
}

fn object(objective: &DesignObjective, found: &Result<Evaluation, LineError>) -> String {
    let found = match found {
        Ok(found) => found,
        Err(reason) => return json!({ "error": reason.to_string() }).to_string(),
    };
    let fields = |all: Vec<(&str, String)>| {
        let all: Vec<String> = all.iter().map(|(name, value)| format!("\"{name}\": {value}")).collect();
        format!("{{{}}}", all.join(", "))
    };
    let number = |value: f64| json!(value).to_string();
    let limits = objective.goal().limits;
    // An empty sum of excesses is -0.
    let mut all = vec![
        (objective.goal().objective.quantity().name(), number(found.value)),
        ("violation", number(found.violation + 0.0)),
    ];
    // `reached` is a nested object since a limit may have the name of the value but cover another part of the run.
    if !limits.is_empty() {
        let reached = limits.set().map(|limit| (limit.name(), number(found.reached.get(limit))));
        all.push(("reached", fields(reached.collect())));
    }
    fields(all)
}

/// Evaluates a design given as numbers separated by blanks or commas.
fn value(objective: &DesignObjective, line: &Line) -> Result<Evaluation, LineError> {
    let Line::Text(line) = line else { return Err(LineError::Long) };
    let texts: Vec<&str> =
        line.split(|c: char| c.is_whitespace() || c == ',').filter(|text| !text.is_empty()).collect();
    let variables = objective.variables();
    if texts.len() != variables.len() {
        return Err(LineError::Count { found: texts.len(), wanted: variables.to_vec() });
    }
    let number = |(&variable, &text): (&Parameter, &&str)| {
        text.parse().map_err(|_| LineError::Number { variable, text: text.to_owned() })
    };
    let design = variables.iter().zip(&texts).map(number).collect::<Result<Vec<f64>, _>>()?;
    let scene = objective.scene(&design)?;
    Ok(objective.evaluate(&scene, f64::INFINITY)?)
}

const MOST_BYTES: usize = 4096;

#[derive(Debug, PartialEq)]
enum Line {
    /// Its text; invalid UTF-8 is replaced.
    Text(String),
    /// A line longer than [`MOST_BYTES`]; its text is not kept.
    Long,
}

/// The lines of an input, at most `ahead` of them read in advance.
fn lines(mut input: impl BufRead + Send + 'static, ahead: usize) -> Receiver<std::io::Result<Line>> {
    let (sender, receiver) = sync_channel(ahead);
    let read = move || {
        while let Some(line) = next(&mut input).transpose() {
            let broken = line.is_err();
            if sender.send(line).is_err() || broken {
                break; // the receiver is gone
            }
        }
    };
    // The thread is not joined: when answers are no longer read, it may still be waiting for a line.
    let started = std::thread::Builder::new().name("input".to_owned()).spawn(read);
    if let Err(error) = started {
        let (sender, receiver) = sync_channel(1);
        let _ = sender.send(Err(std::io::Error::other(error)));
        return receiver;
    }
    receiver
}

/// The next line; `None` at the end.
fn next(input: &mut impl BufRead) -> std::io::Result<Option<Line>> {
    let mut line = Vec::new();
    if input.by_ref().take(MOST_BYTES as u64 + 1).read_until(b'\n', &mut line)? == 0 {
        return Ok(None);
    }
    let is_whole = line.pop_if(|byte| *byte == b'\n').is_some();
    if line.len() <= MOST_BYTES {
        return Ok(Some(Line::Text(String::from_utf8_lossy(&line).into_owned())));
    }
    if !is_whole {
        input.skip_until(b'\n')?;
    }
    Ok(Some(Line::Long))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::BufReader;

    #[test]
    fn contract_lines_are_taken_apart_and_long_ones_not_kept() {
        let most = "1".repeat(MOST_BYTES);
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
