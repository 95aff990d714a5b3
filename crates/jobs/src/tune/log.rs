//! The names of the files of a search, and the formats of a refinement's log.

use crate::amount::measured;
use crate::columns::symbols;
use retune_model::{Measure, Parameter};
use retune_optim::{Row, value_of};

/// Columns of `fminsearch.csv`.
pub fn columns(varied: &[Parameter], quantity: Measure) -> Vec<&'static str> {
    let design = Parameter::columns(varied);
    [&["iteration", "func_count", "procedure"], &*symbols(&design), &[quantity.name()]].concat()
}

/// Columns of `fminsearch.txt`: those of the paper's Table 1.
pub fn table1_header(varied: &[Parameter], quantity: Measure) -> String {
    let columns = Parameter::columns(varied);
    let columns = columns.iter().map(|column| format!("{:<16}", format!("{column} opt {}", column.unit())));
    format!("{}{} {}", columns.collect::<String>(), quantity.name(), quantity.unit())
}

/// Columns of the log on screen.
pub fn screen_header(varied: &[Parameter], quantity: Measure) -> String {
    let width = 16 * Parameter::columns(varied).len() + 15;
    format!(" iter evals  {:<width$} procedure", table1_header(varied, quantity))
}

/// A row of `fminsearch.txt`, in the format of the paper's Table 1.
pub fn table1(row: &Row, values: &[f64]) -> String {
    let all = values.iter().chain([&row.value]).map(|value| scientific(*value));
    all.collect::<Vec<_>>().join("   ")
}

/// A row of the log on screen.
pub fn screen(row: &Row, values: &[f64]) -> String {
    let Row { iteration, func_count, procedure, .. } = row;
    format!("{iteration:>5} {func_count:>5}  {}   {procedure}", table1(row, values)).trim_end().to_owned()
}

/// A value of the objective in words.
pub fn value_words(value: f64, quantity: Measure) -> String {
    let value = value_of(value);
    if value.is_nan() { "no feasible design".to_owned() } else { measured(value, quantity) }
}

/// A number as in the paper's Table 1: `2.203750E+002`; a dash for none.
pub fn scientific(value: f64) -> String {
    if value.is_nan() {
        return format!("{:<13}", "-");
    }
    let text = format!("{value:.6E}");
    match text.split_once('E') {
        Some((digits, exponent)) => {
            let (sign, size) = match exponent.strip_prefix('-') {
                Some(size) => ('-', size),
                None => ('+', exponent),
            };
            format!("{digits}E{sign}{size:0>3}")
        }
        None => text, // not finite
    }
}

/// The design that a search found.
pub const OPTIMUM: &str = "optimum.json";
/// A row for each design of the grid, with its value.
pub const GRID: &str = "surf.csv";
/// A row for each iteration of the refinement that was chosen.
pub const LOG: &str = "fminsearch.csv";
/// A row for each iteration of every refinement.
pub const STARTS: &str = "fminsearch-starts.csv";
/// A row for each basin of a global search.
pub const BASINS: &str = "basins.csv";
/// A row for each frequency: without a damper, with the study's damper, with the tuned one.
pub const BAND: &str = "band.csv";

/// The files that only a search writes.
pub const SEARCHED: [&str; 5] = [GRID, LOG, STARTS, BASINS, BAND];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paper_numbers_look_like_table_1() {
        assert_eq!(scientific(220.375), "2.203750E+002");
        assert_eq!(scientific(0.060375), "6.037500E-002");
        assert_eq!(scientific(0.0), "0.000000E+000");
        assert_eq!(scientific(-1.5e-123), "-1.500000E-123");
        assert_eq!(scientific(f64::INFINITY), "inf");
    }
}
