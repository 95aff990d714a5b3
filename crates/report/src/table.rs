//! A table as data: named columns with units, rows of cells. The only writer of CSV and JSON tables.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};
use std::borrow::Cow;
use std::fmt;

/// A column.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Column {
    /// Its name in files.
    pub name: String,
    /// Its SI unit; empty for texts and pure numbers.
    pub unit: Cow<'static, str>,
}

impl Column {
    /// A column with a name and a unit.
    pub fn new(name: impl Into<String>, unit: impl Into<Cow<'static, str>>) -> Self {
        Self { name: name.into(), unit: unit.into() }
    }

    /// Its heading on a page: its name with its unit.
    pub fn heading(&self) -> String {
        if self.unit.is_empty() { self.name.clone() } else { format!("{}, {}", self.name, self.unit) }
    }
}

/// A column of a table as shown on a page.
#[derive(Clone, Debug)]
pub struct Shown<'a> {
    name: &'a str,
    heading: String,
    number: fn(f64) -> String,
    none: &'static str,
}

impl Shown<'_> {
    /// Sets another heading.
    #[must_use]
    pub fn called(self, heading: impl Into<String>) -> Self {
        Self { heading: heading.into(), ..self }
    }

    /// Sets the text of cells without a value.
    #[must_use]
    pub fn or(self, none: &'static str) -> Self {
        Self { none, ..self }
    }

    /// The text of a cell.
    fn text(&self, cell: &Cell) -> String {
        match cell {
            Cell::Number(value) if !value.is_nan() => (self.number)(*value),
            Cell::Number(_) | Cell::Empty => self.none.to_owned(),
            Cell::Count(count) => count.to_string(),
            Cell::Text(text) => text.clone(),
        }
    }
}

/// A cell. In files numbers have all digits, so that they round-trip exactly.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Cell {
    /// A number; an empty field where it is NaN.
    Number(f64),
    /// A whole number.
    Count(u64),
    /// A text.
    Text(String),
    /// No value.
    Empty,
}

impl Cell {
    /// A number; no value if it is not finite.
    pub fn finite(value: f64) -> Self {
        if value.is_finite() { Self::Number(value) } else { Self::Empty }
    }

    /// Its number; NaN for a text or no value.
    pub fn number(&self) -> f64 {
        match self {
            Self::Number(value) => *value,
            Self::Count(count) => *count as f64,
            Self::Text(_) | Self::Empty => f64::NAN,
        }
    }

    /// Its field in a CSV file.
    fn field(&self) -> String {
        quoted(&self.to_string())
    }

    /// As JSON; null if it is not a finite number.
    fn json(&self) -> Value {
        match self {
            Self::Number(value) => json!(value),
            Self::Count(count) => json!(count),
            Self::Text(text) => json!(text),
            Self::Empty => Value::Null,
        }
    }
}

/// As shown on a page: a number with all digits, nothing for no value.
impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Number(value) if value.is_nan() => Ok(()),
            Self::Number(value) => write!(f, "{value}"),
            Self::Count(count) => write!(f, "{count}"),
            Self::Text(text) => f.write_str(text),
            Self::Empty => Ok(()),
        }
    }
}

impl From<f64> for Cell {
    fn from(value: f64) -> Self {
        Self::Number(value)
    }
}

impl From<usize> for Cell {
    fn from(count: usize) -> Self {
        Self::Count(count as u64)
    }
}

impl From<u64> for Cell {
    fn from(count: u64) -> Self {
        Self::Count(count)
    }
}

/// 1 or 0.
impl From<bool> for Cell {
    fn from(is: bool) -> Self {
        Self::Count(is.into())
    }
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl<T: Into<Self>> From<Option<T>> for Cell {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::Empty, Into::into)
    }
}

/// Cells of a row, from values of different types: `cells![name, 3, 0.5]`.
#[macro_export]
macro_rules! cells {
    ($($value:expr),* $(,)?) => { vec![$($crate::table::Cell::from($value)),*] };
}

/// A table.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Table {
    /// Its columns.
    pub columns: Vec<Column>,
    /// Its rows: a cell for each column.
    pub rows: Vec<Vec<Cell>>,
}

impl Table {
    /// A table without rows.
    pub fn new(columns: impl IntoIterator<Item = Column>) -> Self {
        Self { columns: columns.into_iter().collect(), rows: Vec::new() }
    }

    /// A table without rows or units; names as in the first line of a CSV file.
    pub fn named(names: &str) -> Self {
        Self::new(names.split(',').map(|name| Column::new(name, "")))
    }

    /// A table without rows whose names include the units; headings as in the first line of a Markdown table.
    pub fn headed(names: &str) -> Self {
        Self::new(names.split(" | ").map(|name| Column::new(name, "")))
    }

    /// Appends rows.
    #[must_use]
    pub fn with(mut self, rows: impl IntoIterator<Item = Vec<Cell>>) -> Self {
        rows.into_iter().for_each(|row| self.push(row));
        self
    }

    /// Adds a row.
    pub fn push(&mut self, row: Vec<Cell>) {
        debug_assert_eq!(row.len(), self.columns.len(), "{:?}", self.columns);
        self.rows.push(row);
    }

    /// Keeps only the rows whose entry in `keep` is true; one entry per row.
    #[must_use]
    pub fn only(mut self, keep: impl IntoIterator<Item = bool>) -> Self {
        let mut keep = keep.into_iter();
        self.rows.retain(|_| keep.next().unwrap_or_default());
        self
    }

    /// The index of a column.
    fn index_of(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column.name == name)
    }

    /// The numbers of a column; NaN where there is none.
    pub fn column(&self, name: &str) -> Option<Vec<f64>> {
        let place = self.index_of(name)?;
        Some(self.rows.iter().map(|row| row[place].number()).collect())
    }

    /// The unit of a column; empty if there is no such column.
    pub fn unit(&self, name: &str) -> &str {
        self.index_of(name).map_or("", |place| &self.columns[place].unit)
    }

    /// A cell; none if there is no such column.
    pub fn cell(&self, row: usize, name: &str) -> Option<&Cell> {
        self.rows.get(row)?.get(self.index_of(name)?)
    }

    /// A column for a page, under its own heading. `number` formats its numbers; texts and counts are unchanged; no value gives an empty
    /// text.
    pub fn show<'a>(&self, name: &'a str, number: fn(f64) -> String) -> Shown<'a> {
        let heading = self.index_of(name).map_or_else(String::new, |place| self.columns[place].heading());
        Shown { name, heading, number, none: "" }
    }

    /// A column for a page with all digits.
    pub fn exact<'a>(&self, name: &'a str) -> Shown<'a> {
        self.show(name, |value| value.to_string())
    }

    /// Some columns for a page: their headings, and the texts of each row.
    pub fn shown(&self, columns: &[Shown]) -> (Vec<String>, Vec<Vec<String>>) {
        let places: Vec<Option<usize>> = columns.iter().map(|column| self.index_of(column.name)).collect();
        let text = |row: &[Cell], column: &Shown, place: Option<usize>| {
            column.text(place.map_or(&Cell::Empty, |place| &row[place]))
        };
        let row = |row: &Vec<Cell>| {
            columns.iter().zip(&places).map(|(column, place)| text(row, column, *place)).collect()
        };
        let head = columns.iter().map(|column| column.heading.clone()).collect();
        (head, self.rows.iter().map(row).collect())
    }

    /// As CSV.
    pub fn csv(&self) -> String {
        let names: Vec<Cell> = self.columns.iter().map(|column| column.name.as_str().into()).collect();
        std::iter::once(&names).chain(&self.rows).map(|row| line(row)).collect()
    }

    /// As JSON: the unit of each column, and an object for each row.
    pub fn json(&self) -> Value {
        let units: Map<String, Value> =
            self.columns.iter().map(|column| (column.name.clone(), json!(column.unit))).collect();
        let row = |row: &Vec<Cell>| -> Map<String, Value> {
            self.columns.iter().zip(row).map(|(column, cell)| (column.name.clone(), cell.json())).collect()
        };
        json!({ "units": units, "rows": self.rows.iter().map(row).collect::<Vec<_>>() })
    }
}

/// A row as a line of CSV with its line end, for a table too long to be held in memory.
pub fn line(row: &[Cell]) -> String {
    row.iter().map(Cell::field).collect::<Vec<_>>().join(",") + "\n"
}

/// A text as a CSV field.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_cells_in_files() {
        let mut table = Table::new([
            Column::new("damper", ""),
            Column::new("E1max", "J"),
            Column::new("n", ""),
            Column::new("D", "m"),
        ]);
        table.push(cells!["TMD, \"free\"", 0.1 + 0.2, 3_usize, f64::NAN]);
        table.push(cells!["", f64::INFINITY, true, None::<f64>]);
        assert_eq!(table.csv(), "damper,E1max,n,D\n\"TMD, \"\"free\"\"\",0.30000000000000004,3,\n,inf,1,\n");
        assert_eq!(table.column("n"), Some(vec![3.0, 1.0]));
        assert_eq!((table.column("C"), table.unit("E1max")), (None, "J"));
        let json = table.json();
        assert_eq!(json["units"]["D"], "m");
        assert_eq!(json["rows"][1], json!({ "damper": "", "E1max": Value::Null, "n": 1, "D": Value::Null }));
        assert_eq!(Cell::finite(f64::INFINITY), Cell::Empty);
        let heads = Table::headed("k1, N/m | R2");
        assert_eq!((heads.columns.len(), heads.csv().as_str()), (2, "\"k1, N/m\",R2\n"));
        let mut kept = Table::new([Column::new("t", "s")]);
        kept.push(cells![0.1 + 0.2]);
        let text = serde_json::to_string(&kept).expect("JSON");
        assert_eq!(serde_json::from_str::<Table>(&text).expect("a table"), kept);
    }

    #[test]
    fn contract_a_page_shows_chosen_columns_with_chosen_digits() {
        let mut table =
            Table::new([Column::new("damper", ""), Column::new("E1max", "J"), Column::new("D", "m")]);
        table.push(cells!["TMD", 160.64, f64::NAN]);
        let digits = |value: f64| format!("{value:.1}");
        let columns = [
            table.show("D", digits).or("none"),
            table.exact("damper").called("which"),
            table.show("E1max", digits),
        ];
        let (head, rows) = table.shown(&columns);
        assert_eq!(head, ["D, m", "which", "E1max, J"]);
        assert_eq!(rows, [["none", "TMD", "160.6"]]);
        assert_eq!((table.cell(0, "damper"), table.cell(1, "D")), (Some(&Cell::from("TMD")), None));
        table.push(cells!["NES", 150.0, 0.06]);
        assert_eq!(table.only([false, true]).column("E1max"), Some(vec![150.0]));
    }
}
