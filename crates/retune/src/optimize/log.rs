//! The log of a refinement, in the forms it is written in.

pub use crate::study::counted;

use retune_optim::Row;
use std::fmt::Display;

/// Columns of `fminsearch.csv`.
pub const CSV_HEADER: &str = "iteration,func_count,procedure,k2,c2,D,C,E1max";

/// Columns of `fminsearch.txt`: those of the paper's Table 1.
pub const TXT_HEADER: &str = "k2 opt N/m      c2 opt N·s/m    D opt m         C opt m         E1max J";

/// Columns of the log on screen.
pub const SCREEN_HEADER: &str =
    " iter evals  k2 opt N/m      c2 opt N·s/m    D opt m         C opt m         E1max J         procedure";

/// A row of `fminsearch.csv`; numbers to the last bit.
pub fn csv(row: &Row, design: &[f64; 4]) -> String {
    let Row { iteration, func_count, procedure, value, .. } = row;
    format!("{iteration},{func_count},{procedure},{},{value}", joined(design, ","))
}

/// A row of `fminsearch.txt`, with the look of the paper's Table 1.
pub fn table1(row: &Row, design: &[f64; 4]) -> String {
    let [k2, c2, d, c] = design.map(scientific);
    format!("{k2}   {c2}   {d}   {c}   {}", scientific(row.value))
}

/// A row of the log on screen.
pub fn screen(row: &Row, design: &[f64; 4]) -> String {
    let Row { iteration, func_count, procedure, .. } = row;
    format!("{iteration:>5} {func_count:>5}  {}   {procedure}", table1(row, design)).trim_end().to_owned()
}

/// A number as in the paper's Table 1: `2.203750E+002`.
pub fn scientific(value: f64) -> String {
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

/// A number to six significant digits, as short as it can be: `215`, `0.0603333`, `1.23457e-9`.
pub fn short(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    let size = rounded.abs();
    if size != 0.0 && !(1e-4..1e7).contains(&size) { format!("{rounded:e}") } else { format!("{rounded}") }
}

/// So many of something are: `1 design is`, `2 designs are`.
pub fn are(count: u64, noun: &str) -> String {
    format!("{} {}", counted(count, noun), if count == 1 { "is" } else { "are" })
}

/// The items with `separator` between them.
pub fn joined<T: Display>(items: &[T], separator: &str) -> String {
    items.iter().map(T::to_string).collect::<Vec<_>>().join(separator)
}

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

    #[test]
    fn exact_one_is_one_and_not_many() {
        let said = |count| [counted(count, "design"), counted(count, "CMA-ES search"), are(count, "value")];
        assert_eq!(said(1), ["1 design", "1 CMA-ES search", "1 value is"]);
        assert_eq!(said(0), ["0 designs", "0 CMA-ES searches", "0 values are"]);
        assert_eq!(said(2), ["2 designs", "2 CMA-ES searches", "2 values are"]);
    }

    #[test]
    fn exact_short_numbers_have_six_digits() {
        assert_eq!(short(215.0), "215");
        assert_eq!(short(0.060_333_333_3), "0.0603333");
        assert_eq!(short(1_234.567_89), "1234.57");
        assert_eq!(short(1.234_567_8e-9), "1.23457e-9");
        assert_eq!(short(0.0), "0");
    }
}
