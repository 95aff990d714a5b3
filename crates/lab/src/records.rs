//! Reads the tables of the atlas: its charts are drawn from the written files.

use std::collections::BTreeMap;

/// A row: the text of each column by its name.
pub type Record<'a> = BTreeMap<&'a str, &'a str>;

/// The rows of a table whose fields hold no commas.
pub fn records(table: &str) -> Vec<Record<'_>> {
    let mut lines = table.lines();
    let head: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    lines.map(|line| head.iter().copied().zip(line.split(',')).collect()).collect()
}

/// The number in a column; NaN if there is none.
pub fn number(row: &Record<'_>, column: &str) -> f64 {
    row.get(column).and_then(|text| text.parse().ok()).unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_a_table_is_read_by_the_names_of_its_columns() {
        let rows = records("method,error,failure\nhybrid,1e-3,\neuler,,blows up\n");
        assert_eq!((rows.len(), rows[1]["failure"]), (2, "blows up"));
        assert_eq!(number(&rows[0], "error"), 1e-3);
        assert!(number(&rows[1], "error").is_nan() && number(&rows[0], "time").is_nan());
    }
}
