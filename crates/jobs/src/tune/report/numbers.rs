//! How numbers are written on a page.

use crate::summary::how_many;
use retune_model::Measure;
pub use retune_study::frequency;
use retune_study::rounded;

/// Hertz in a radian per second.
pub const HERTZ: f64 = 0.5 / std::f64::consts::PI;

/// A number to four significant digits; a dash for one that is not finite.
pub fn four(value: f64) -> String {
    digits(value, 4)
}

/// A number to some significant digits, as short as it can be.
pub fn digits(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return "–".to_owned();
    }
    rounded(value, digits).replace('-', "−")
}

/// A value with the unit of its quantity, to four digits.
pub fn amount(value: f64, quantity: Measure) -> String {
    format!("{} {}", four(value), quantity.unit())
}

pub fn millimetres(metres: f64) -> String {
    format!("{} mm", four(1e3 * metres))
}

/// A value compared with another: how many times less or more it is, and the change in percent.
pub fn compared(value: f64, other: f64) -> Option<String> {
    let times = other / value;
    if !(times.is_finite() && times > 0.0) {
        return None;
    }
    let percent = 100.0 * (value / other - 1.0);
    let (times, more) = if times >= 1.0 { (times, "less") } else { (1.0 / times, "more") };
    let how_many = how_many(times);
    // For a change by a factor of thousands a percentage is useless.
    if times >= 1e3 {
        return Some(format!("{how_many} times {more}"));
    }
    let sign = if percent > 0.0 { "+" } else { "" };
    Some(format!("{how_many} times {more} ({sign}{} %)", digits(percent, 3)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_four_digits_and_no_number_that_is_none() {
        assert_eq!([four(225.807_184), four(0.039_044_485), four(60.0)], ["225.8", "0.03904", "60"]);
        assert_eq!([four(-0.436_58), four(7.8e-9), four(0.0)], ["−0.4366", "7.8e−9", "0"]);
        assert_eq!([four(f64::NAN), four(f64::INFINITY)], ["–", "–"]);
        assert_eq!(millimetres(0.511_944), "511.9 mm");
    }

    #[test]
    fn exact_a_value_beside_another() {
        assert_eq!(compared(25.0, 100.0).as_deref(), Some("4 times less (−75 %)"));
        assert_eq!(compared(100.0, 80.0).as_deref(), Some("1.25 times more (+25 %)"));
        assert_eq!(compared(0.0, 80.0), None);
        assert_eq!(compared(0.001_28, 1567.0).as_deref(), Some("over a million times less"));
        assert_eq!(compared(1.0, 1567.0).as_deref(), Some("1570 times less"));
    }
}
