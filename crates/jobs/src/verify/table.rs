//! A sample of the rows of a table of results, their fields accessed by the names of the columns.

use crate::Error;
use retune_model::Design;
use retune_study::counted;
use std::path::Path;

/// A sample of the rows of a CSV file.
pub struct Sample {
    names: csv::StringRecord,
    rows: Vec<csv::StringRecord>,
    /// Number of rows of the file.
    count: usize,
}

/// A row of a sample.
#[derive(Clone, Copy)]
pub struct Row<'a> {
    names: &'a csv::StringRecord,
    fields: &'a csv::StringRecord,
}

impl Sample {
    /// Reads `most` rows of a file, evenly spread, or all if there are fewer.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn read(path: &Path, most: usize) -> Result<Self, Error> {
        let refuse =
            |error: csv::Error| retune_store::Error::Input { path: path.to_owned(), source: error.into() };
        let open = || match retune_store::plain::open(path) {
            Ok(file) => Ok(csv::ReaderBuilder::new().flexible(true).from_reader(file)),
            Err(error) => Err(refuse(error.into())),
        };
        let mut table = open()?;
        let names = table.headers().map_err(refuse)?.clone();
        let mut record = csv::StringRecord::new();
        let mut count = 0;
        while table.read_record(&mut record).map_err(refuse)? {
            count += 1;
        }
        let kept = count.min(most);
        let wanted: Vec<usize> = (0..kept).map(|i| i * (count - 1) / kept.saturating_sub(1).max(1)).collect();
        let mut rows = Vec::with_capacity(kept);
        let mut table = open()?;
        for number in 0..count {
            if !table.read_record(&mut record).map_err(refuse)? {
                break;
            }
            if wanted.get(rows.len()) == Some(&number) {
                rows.push(record.clone());
            }
        }
        Ok(Self { names, rows, count })
    }

    /// Its rows.
    pub fn rows(&self) -> impl Iterator<Item = Row<'_>> {
        self.rows.iter().map(|fields| Row { names: &self.names, fields })
    }

    /// The number of rows run again and of all rows, in words.
    pub fn of(&self, looked: usize) -> String {
        format!("{looked} of {}", counted(self.count as u64, "row"))
    }
}

impl<'a> Row<'a> {
    /// A field; empty where there is none.
    pub fn text(self, name: &str) -> &'a str {
        let number = self.names.iter().position(|other| other == name);
        number.and_then(|number| self.fields.get(number)).unwrap_or_default()
    }

    /// A field as a number; NaN where it is not a number.
    pub fn number(self, name: &str) -> f64 {
        self.text(name).parse().unwrap_or(f64::NAN)
    }

    /// Its design; none where a field is no number, or none of a damper.
    pub fn design(self) -> Option<Design> {
        Design::new(|variable| self.number(variable.symbol())).ok()
    }
}
