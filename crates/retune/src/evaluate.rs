//! `evaluate`: the objective of a study as a service, for optimisers outside of Retune.

use crate::cli;
use crate::error::Error;
use crate::optimize::{objective, with_threads};
use crate::study;
use retune_optim::{PeakEnergy, Unusable, Variable};
use std::io::{BufRead, ErrorKind, Write};
use thiserror::Error;

/// Why a line has no value.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum LineError {
    /// Too few numbers, or too many.
    #[error("give one number for each of {}; found {found}", words(.wanted))]
    Count {
        /// How many there are.
        found: usize,
        /// The tuned parameters.
        wanted: Vec<Variable>,
    },
    /// Not a number.
    #[error("{variable}: \"{text}\" is not a number")]
    Number {
        /// The parameter.
        variable: Variable,
        /// The text as given.
        text: String,
    },
    /// A design without a value.
    #[error(transparent)]
    Unusable(#[from] Unusable),
}

fn words(variables: &[Variable]) -> String {
    variables.iter().map(|variable| variable.symbol()).collect::<Vec<_>>().join(" ")
}

/// Reads designs from standard input, one a line, and answers each with a line on standard output: the value that searches
/// make small, or `error: ` and why there is none. Ends with its input, or when nobody reads any more.
///
/// # Errors
/// The study is wrong or does not say what to tune, standard input cannot be read, or standard output cannot be written.
pub fn evaluate(arguments: &cli::Evaluate) -> Result<(), Error> {
    let study = study::read(&arguments.study)?;
    let search = study.search().map_err(|rule| Error::Rule { name: study.name().to_owned(), rule })?;
    let objective = objective(&study, &search, &search.variables);
    // Standard input is not locked: its lock may not move to a thread of the pool.
    let mut input = std::io::BufReader::new(std::io::stdin());
    with_threads(arguments.threads, move || answer(&objective, &mut input))
}

fn answer(objective: &PeakEnergy, input: &mut impl BufRead) -> Result<(), Error> {
    let mut line = Vec::new();
    loop {
        line.clear();
        let length = input
            .read_until(b'\n', &mut line)
            .map_err(|source| Error::Input { path: "standard input".into(), source })?;
        if length == 0 {
            return Ok(());
        }
        let answer = match value(objective, &String::from_utf8_lossy(&line)) {
            Ok(value) => format!("{value}\n"),
            Err(reason) => format!("error: {reason}\n"),
        };
        let mut output = std::io::stdout().lock();
        match output.write_all(answer.as_bytes()).and_then(|()| output.flush()) {
            Err(error) if error.kind() == ErrorKind::BrokenPipe => return Ok(()),
            Err(source) => return Err(Error::Output { path: "standard output".into(), source }),
            Ok(()) => {}
        }
    }
}

/// The value of a design given as numbers between blanks or commas.
fn value(objective: &PeakEnergy, line: &str) -> Result<f64, LineError> {
    let texts: Vec<&str> =
        line.split(|c: char| c.is_whitespace() || c == ',').filter(|text| !text.is_empty()).collect();
    let variables = objective.variables();
    if texts.len() != variables.len() {
        return Err(LineError::Count { found: texts.len(), wanted: variables.to_vec() });
    }
    let number = |(&variable, &text): (&Variable, &&str)| {
        text.parse().map_err(|_| LineError::Number { variable, text: text.to_owned() })
    };
    let design = variables.iter().zip(&texts).map(number).collect::<Result<Vec<f64>, _>>()?;
    let scene = objective.scene(&design)?;
    Ok(objective.evaluate(&scene, f64::INFINITY)?.value)
}
