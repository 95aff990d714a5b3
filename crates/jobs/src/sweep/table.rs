//! A sweep as a table. CSV, JSON, text and figure are made of it.

use serde_json::{Map, Value, json};

/// A column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// Its unit; empty for pure numbers.
    pub unit: &'static str,
}

impl Column {
    /// A column of a name and a unit.
    pub fn new(name: &str, unit: &'static str) -> Self {
        Self { name: name.to_owned(), unit }
    }

    /// A value as JSON; counts are whole numbers.
    fn json(&self, value: f64) -> Value {
        if self.name.starts_with("impacts") && value.is_finite() { json!(value as u64) } else { json!(value) }
    }
}

/// All points of a sweep, a row each; numbers that are not finite are missing.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// The columns; the first is the parameter.
    pub columns: Vec<Column>,
    /// The rows.
    pub rows: Vec<Vec<f64>>,
}

impl Table {
    /// The values of a column.
    pub fn column(&self, name: &str) -> Option<Vec<f64>> {
        let number = self.columns.iter().position(|column| column.name == name)?;
        Some(self.rows.iter().map(|row| row[number]).collect())
    }

    /// As CSV; missing numbers are empty fields.
    pub fn csv(&self) -> String {
        let names: Vec<&str> = self.columns.iter().map(|column| column.name.as_str()).collect();
        let mut text = names.join(",") + "\n";
        for row in &self.rows {
            let fields: Vec<String> = row
                .iter()
                .map(|value| if value.is_finite() { value.to_string() } else { String::new() })
                .collect();
            text += &(fields.join(",") + "\n");
        }
        text
    }

    /// As JSON: the unit of each column, and an object for each row; missing numbers are null.
    pub fn json(&self) -> Value {
        let units: Map<String, Value> =
            self.columns.iter().map(|column| (column.name.clone(), json!(column.unit))).collect();
        let row = |row: &Vec<f64>| -> Map<String, Value> {
            self.columns
                .iter()
                .zip(row)
                .map(|(column, value)| (column.name.clone(), column.json(*value)))
                .collect()
        };
        json!({ "units": units, "rows": self.rows.iter().map(row).collect::<Vec<_>>() })
    }
}
