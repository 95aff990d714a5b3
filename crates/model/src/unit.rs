//! Units in which a person may give a number.

use std::f64::consts::TAU;

/// A unit: how it is written, and how many SI units it is.
pub type Unit = (&'static str, f64);

/// Units of mass, kg.
pub(crate) const MASS: &[Unit] = &[("kg", 1.0), ("g", 1e-3), ("t", 1e3)];
/// Units of stiffness, N/m.
pub(crate) const STIFFNESS: &[Unit] = &[("N/m", 1.0), ("kN/m", 1e3), ("MN/m", 1e6), ("N/mm", 1e3)];
/// Units of damping, N·s/m.
pub(crate) const DAMPING: &[Unit] =
    &[("N·s/m", 1.0), ("N s/m", 1.0), ("Ns/m", 1.0), ("kN·s/m", 1e3), ("kNs/m", 1e3)];
/// Units of length, m.
pub(crate) const LENGTH: &[Unit] = &[("m", 1.0), ("mm", 1e-3), ("cm", 1e-2)];
/// Units of force, N.
pub(crate) const FORCE: &[Unit] = &[("N", 1.0), ("kN", 1e3), ("MN", 1e6)];
/// Units of an imbalance, kg·m.
pub(crate) const IMBALANCE: &[Unit] =
    &[("kg·m", 1.0), ("kg m", 1.0), ("kgm", 1.0), ("g·mm", 1e-6), ("kg·mm", 1e-3)];
/// Units of a Young's modulus, N/m².
pub(crate) const MODULUS: &[Unit] = &[("N/m²", 1.0), ("Pa", 1.0), ("MPa", 1e6), ("GPa", 1e9)];
/// Units of the damping factor of a contact, s/m.
pub(crate) const LOSS: &[Unit] = &[("s/m", 1.0), ("s/mm", 1e3)];
/// Units of time, s.
pub const TIME: &[Unit] = &[("s", 1.0), ("ms", 1e-3), ("min", 60.0)];
/// Units of angular frequency, rad/s.
pub const FREQUENCY: &[Unit] = &[("rad/s", 1.0), ("Hz", TAU), ("rpm", TAU / 60.0)];
/// Of a number without a unit.
pub(crate) const NONE: &[Unit] = &[("", 1.0)];

/// A number as it was typed, in SI units: without a unit, or with one of `units`.
///
/// # Errors
/// It is none; the message says what to give.
pub fn read(text: &str, units: &[Unit]) -> Result<f64, String> {
    let text = text.trim();
    let with = |&(name, size): &Unit| Some(size * number(text.strip_suffix(name)?)?);
    number(text).or_else(|| units.iter().find_map(with)).ok_or_else(|| match units {
        [] | [("", _)] => format!("\"{text}\" is not a number"),
        [(own, _), ..] => {
            let names: Vec<&str> = units.iter().map(|(name, _)| *name).collect();
            format!("\"{text}\" is not a number in {own}, nor one with its unit: {}", names.join(", "))
        }
    })
}

fn number(text: &str) -> Option<f64> {
    text.trim_end().parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_a_number_has_the_same_value_in_every_unit() {
        for (text, units, value) in [
            ("5.5", FREQUENCY, 5.5),
            (" 5.5 rad/s", FREQUENCY, 5.5),
            ("2Hz", FREQUENCY, 2.0 * TAU),
            ("39.5 kN/m", STIFFNESS, 39500.0),
            ("3g", MASS, 0.003),
            ("8mm", LENGTH, 0.008),
            ("1e3", LENGTH, 1000.0),
        ] {
            assert_eq!(read(text, units), Ok(value), "{text}");
        }
        assert!(read("120rpm", FREQUENCY).is_ok_and(|omega| (omega - 2.0 * TAU).abs() < 1e-14));
    }

    #[test]
    fn contract_what_is_no_number_is_refused_with_the_units() {
        for text in ["", "Hz", "2kHz", "two", "3 rpm s"] {
            assert!(read(text, FREQUENCY).is_err_and(|words| words.contains("rad/s, Hz, rpm")), "{text}");
        }
        assert_eq!(read("two", NONE), Err("\"two\" is not a number".to_owned()));
    }
}
