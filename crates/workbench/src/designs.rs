//! A table of designs in the form of the paper's Table 2, as `table2` and `track` make it.

use crate::Error;
use crate::tune::{Found, table2_header, table2_row};
use retune_store::Directory;
use retune_study::{joined, short};
use serde::Serialize;

/// A table of designs: the paper's columns, E1max, and one column of its own.
#[derive(Debug, Serialize)]
pub struct Designs {
    /// The name of the column of its own.
    pub column: &'static str,
    /// The rows.
    pub rows: Vec<Row>,
    /// The error of the first search that found no design within its limits; the table has the nearest one.
    #[serde(skip)]
    pub infeasible: Option<Error>,
}

/// A row of the table.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The entry in the column of its own.
    pub label: String,
    /// The name of the damper.
    pub damper: String,
    /// The design, and its E1max.
    #[serde(flatten)]
    pub found: Found,
}

impl Designs {
    /// Writes the table as `name.csv` and `name.txt`.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn write(&self, name: &str, results: &Directory) -> Result<(), Error> {
        results.write(&format!("{name}.csv"), &self.csv())?;
        Ok(results.write(&format!("{name}.txt"), &(self.text() + "\n"))?)
    }

    /// The table as CSV.
    pub fn csv(&self) -> String {
        let mut text = format!("{},damper,m2,k2,c2,D,C,E1max\n", self.column);
        for Row { label, damper, found: Found { damper: found, e1_max } } in &self.rows {
            text += &format!("{label},{},{},{e1_max}\n", quoted(damper), joined(&found.values(), ","));
        }
        text
    }

    /// The table as text, without an end of line.
    pub fn text(&self) -> String {
        let mut lines = vec![format!("{:<14}{:<84}E1max, J", self.column, table2_header())];
        for Row { label, damper, found: Found { damper: found, e1_max } } in &self.rows {
            lines.push(format!("{label:<14}{:<84}{}", table2_row(damper, found), short(*e1_max)));
        }
        lines.join("\n")
    }

    /// Refuses a table with a design that breaks the limits of its study.
    ///
    /// # Errors
    /// [`Error::Infeasible`], of the first search.
    pub fn check_limits(self) -> Result<(), Error> {
        self.infeasible.map_or(Ok(()), Err)
    }
}

/// A text as a CSV field.
pub fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}
