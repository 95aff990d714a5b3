//! The answer of a job as JSON: the file without which its results are not complete.

use crate::Error;
use crate::columns::column;
use crate::recompute::{self, each_row};
use retune_report::table::{Cell, Table};
use retune_store::json_text;
use serde::Serialize;
use serde_json::{Map, Value};
use std::path::Path;

/// The answer in a file of results: JSON unchanged; a table with the units of its columns; for a page, the statements beside it.
pub fn as_json(file: &Path) -> Result<String, Error> {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    let place = file.parent().unwrap_or(Path::new(""));
    let value = match file.extension().and_then(|ending| ending.to_str()) {
        Some("csv") => table(file)?.json(),
        Some("html") => statements(place)?,
        _ => return Ok(recompute::text(place, &name)?.trim_end().to_owned()),
    };
    Ok(json_text(&value, &name)?.trim_end().to_owned())
}

/// An answer as indented JSON, as in files of results.
pub fn text(answer: &impl Serialize) -> Result<String, Error> {
    Ok(json_text(answer, "standard output")?.trim_end().to_owned())
}

/// A table of results.
pub fn table(file: &Path) -> Result<Table, Error> {
    let mut table = Table::default();
    each_row(file, |_, row| {
        if table.columns.is_empty() {
            table.columns = row.names.iter().map(column).collect();
        }
        table.push(row.fields.iter().map(cell).collect());
    })?;
    Ok(table)
}

fn cell(field: &str) -> Cell {
    match (field, field.parse::<u64>(), field.parse::<f64>()) {
        ("", ..) => Cell::Empty,
        (_, Ok(count), _) => Cell::Count(count),
        (_, _, Ok(number)) => Cell::Number(number),
        _ => Cell::from(field),
    }
}

/// The statements on the paper in a directory, by the name of their table or figure.
fn statements(place: &Path) -> Result<Value, Error> {
    const ENDING: &str = "-statements.json";
    let refuse = |source| retune_store::Error::Input { path: place.to_owned(), source };
    let mut all = Map::new();
    for name in retune_store::plain::names(place).map_err(refuse)? {
        if let Some(item) = name.strip_suffix(ENDING) {
            all.insert(item.to_owned(), recompute::json(place, &name)?);
        }
    }
    Ok(Value::Object(all))
}
