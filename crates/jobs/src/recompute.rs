//! Recomputes files of results: tables row by row, any other file as a whole. Each job has the functions for its own files; `verify` reads
//! the files, samples rows and compares.

use crate::Error;
use retune_model::Design;
use serde_json::Value;
use std::path::Path;

/// Gives the function that recomputes rows of a table, from the directory of the results and the name of the file.
pub type Rows = fn(&Path, &str) -> Result<Source, Error>;

/// Recomputes a file as a whole.
pub type Whole = fn(&Path, &str) -> Result<Recomputed, Error>;

/// Names of columns with their recomputed numbers.
pub type Numbers = Vec<(String, f64)>;

/// The functions that recompute a row.
pub struct Source {
    /// Whether a row has numbers that can be recomputed.
    pub applies: Box<dyn Fn(Row) -> bool + Sync>,
    /// The recomputed numbers of a row, from the fields that identify it; none where no command writes such a row.
    pub row: Box<dyn Fn(Row) -> Option<Numbers> + Sync>,
}

impl Source {
    pub fn new(row: impl Fn(Row) -> Option<Numbers> + Sync + 'static) -> Self {
        Self { applies: Box::new(|_| true), row: Box::new(row) }
    }

    /// Restricts the source to the rows for which `applies` holds.
    pub fn only(self, applies: impl Fn(Row) -> bool + Sync + 'static) -> Self {
        Self { applies: Box::new(applies), ..self }
    }
}

pub enum Recomputed {
    /// The part named by `what`: the fields of `recomputed` are compared with those of `stored`.
    Part { what: &'static str, stored: Value, recomputed: Value },
    /// Why it cannot be recomputed.
    Failed(String),
}

#[derive(Clone, Copy)]
pub struct Row<'a> {
    pub(crate) names: &'a csv::StringRecord,
    pub(crate) fields: &'a csv::StringRecord,
}

impl<'a> Row<'a> {
    /// A field; empty where there is none.
    pub fn text(self, name: &str) -> &'a str {
        let number = self.names.iter().position(|other| other == name);
        number.and_then(|number| self.fields.get(number)).unwrap_or_default()
    }

    /// Whether there is a column of this name.
    pub fn has(self, name: &str) -> bool {
        self.names.iter().any(|other| other == name)
    }

    /// A field as a number; NaN where it is not a number.
    pub fn number(self, name: &str) -> f64 {
        self.text(name).parse().unwrap_or(f64::NAN)
    }

    /// The design in the row; none where a field is not a number or not valid for a damper.
    pub fn design(self) -> Option<Design> {
        Design::new(|variable| self.number(variable.symbol())).ok()
    }
}

/// Calls `visit` with the number of every row of a table and the row.
pub fn each_row(path: &Path, mut visit: impl FnMut(usize, Row)) -> Result<(), Error> {
    let refuse =
        |error: csv::Error| retune_store::Error::Input { path: path.to_owned(), source: error.into() };
    let file = retune_store::plain::open(path).map_err(|error| refuse(error.into()))?;
    let mut table = csv::ReaderBuilder::new().flexible(true).from_reader(file);
    let names = table.headers().map_err(refuse)?.clone();
    let mut fields = csv::StringRecord::new();
    let mut number = 0;
    while table.read_record(&mut fields).map_err(refuse)? {
        visit(number, Row { names: &names, fields: &fields });
        number += 1;
    }
    Ok(())
}

pub fn text(place: &Path, name: &str) -> Result<String, Error> {
    Ok(retune_store::plain::text(&place.join(name))?)
}

pub fn json(place: &Path, name: &str) -> Result<Value, Error> {
    serde_json::from_str(&text(place, name)?).map_err(|error| broken(place, name, error.to_string()))
}

/// The design in a JSON object; none where a number is missing or not valid for a damper.
pub fn design(of: &Value) -> Option<Design> {
    Design::new(|variable| of[variable.symbol()].as_f64().unwrap_or(f64::NAN)).ok()
}

/// The error of a file whose contents are not those of results.
pub fn broken(place: &Path, name: &str, problem: impl Into<String>) -> Error {
    let source = std::io::Error::other(problem.into());
    retune_store::Error::Input { path: place.join(name), source }.into()
}
