//! Frequencies as people give them: in rad/s, Hz or rpm.

use std::f64::consts::TAU;

/// Units of frequency, as they are written, each with rad/s in it.
const UNITS: [(&str, f64); 3] = [("rad/s", 1.0), ("Hz", TAU), ("rpm", TAU / 60.0)];

/// An angular frequency, rad/s, from a number in rad/s, or one with its unit: `6.28`, `6.28rad/s`, `1Hz`, `60 rpm`.
///
/// # Errors
/// It is none of these; the message says what to give.
pub fn angular_frequency(text: &str) -> Result<f64, String> {
    let text = text.trim();
    let (number, unit) =
        UNITS.iter().find_map(|(name, unit)| Some((text.strip_suffix(name)?, *unit))).unwrap_or((text, 1.0));
    let number: Result<f64, _> = number.trim_end().parse();
    number.map(|number| unit * number).map_err(|_| {
        format!("\"{text}\" is no frequency: give a number in rad/s, or one with its unit: 1.2Hz, 72rpm")
    })
}

/// An angular frequency (rad/s) in Hz and in revolutions per minute.
pub fn hertz_and_rpm(omega: f64) -> [f64; 2] {
    let hertz = omega / TAU;
    [hertz, 60.0 * hertz]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_a_frequency_has_the_same_value_in_every_unit() {
        assert_eq!(angular_frequency("5.5"), Ok(5.5));
        assert_eq!(angular_frequency("5.5 rad/s"), Ok(5.5));
        assert_eq!(angular_frequency("2Hz"), Ok(2.0 * TAU));
        assert_eq!(angular_frequency(" 2 Hz "), Ok(2.0 * TAU));
        assert!(angular_frequency("120rpm").is_ok_and(|omega| (omega - 2.0 * TAU).abs() < 1e-14));
        assert_eq!(hertz_and_rpm(TAU), [1.0, 60.0]);
    }

    #[test]
    fn contract_what_is_no_frequency_is_refused_with_the_units() {
        for text in ["", "Hz", "2kHz", "two", "3 rpm s"] {
            assert!(angular_frequency(text).is_err_and(|words| words.contains("1.2Hz, 72rpm")), "{text}");
        }
    }
}
