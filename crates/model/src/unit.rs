//! Units in which a person may give a number.

use std::f64::consts::TAU;

/// A unit: how it is written, and how many SI units it is.
pub type Unit = (&'static str, f64);

/// The standard acceleration of gravity, m/s² (ISO 80000-3).
const GRAVITY: f64 = 9.80665;

/// Units of mass, kg.
pub const MASS: &[Unit] = &[("kg", 1.0), ("g", 1e-3), ("t", 1e3)];
/// Units of stiffness, N/m.
pub(crate) const STIFFNESS: &[Unit] = &[("N/m", 1.0), ("kN/m", 1e3), ("MN/m", 1e6), ("N/mm", 1e3)];
/// Units of damping, N·s/m.
pub(crate) const DAMPING: &[Unit] =
    &[("N·s/m", 1.0), ("N s/m", 1.0), ("Ns/m", 1.0), ("kN·s/m", 1e3), ("kNs/m", 1e3)];
/// Units of length, m.
pub const LENGTH: &[Unit] = &[("m", 1.0), ("mm", 1e-3), ("cm", 1e-2), ("µm", 1e-6), ("um", 1e-6)];
/// Units of velocity, m/s.
pub(crate) const VELOCITY: &[Unit] = &[("m/s", 1.0), ("mm/s", 1e-3)];
/// Units of acceleration, m/s².
pub const ACCELERATION: &[Unit] =
    &[("m/s²", 1.0), ("m/s2", 1.0), ("m/s^2", 1.0), ("mm/s²", 1e-3), ("mm/s2", 1e-3), ("g", GRAVITY)];
/// Units of force, N.
pub(crate) const FORCE: &[Unit] = &[("N", 1.0), ("kN", 1e3), ("MN", 1e6), ("mN", 1e-3)];
/// Units of energy, J.
pub(crate) const ENERGY: &[Unit] = &[("J", 1.0), ("mJ", 1e-3), ("kJ", 1e3), ("MJ", 1e6), ("µJ", 1e-6)];
/// Units of an imbalance, kg·m.
pub(crate) const IMBALANCE: &[Unit] = &[
    ("kg·m", 1.0),
    ("kg m", 1.0),
    ("kgm", 1.0),
    ("g·mm", 1e-6),
    ("g mm", 1e-6),
    ("gmm", 1e-6),
    ("kg·mm", 1e-3),
    ("kg mm", 1e-3),
    ("kgmm", 1e-3),
];
/// Units of a Young's modulus, N/m².
pub const MODULUS: &[Unit] = &[("N/m²", 1.0), ("Pa", 1.0), ("MPa", 1e6), ("GPa", 1e9)];
/// Units of a density, kg/m³.
pub(crate) const DENSITY: &[Unit] =
    &[("kg/m³", 1.0), ("kg/m3", 1.0), ("g/cm³", 1e3), ("g/cm3", 1e3), ("t/m³", 1e3)];
/// Units of the damping factor of a contact, s/m.
pub(crate) const LOSS: &[Unit] = &[("s/m", 1.0), ("s/mm", 1e3)];
/// Units of time, s.
pub const TIME: &[Unit] = &[("s", 1.0), ("ms", 1e-3), ("min", 60.0)];
/// Units of angular frequency, rad/s.
pub const FREQUENCY: &[Unit] = &[("rad/s", 1.0), ("Hz", TAU), ("rpm", TAU / 60.0)];
/// Units of a share: 1 is the whole.
pub const SHARE: &[Unit] = &[("", 1.0), ("%", 1e-2)];
/// The unit of a dimensionless number.
pub(crate) const NONE: &[Unit] = &[("", 1.0)];

/// A number as it was typed, in SI units: without a unit, or with one of `units`.
///
/// # Errors
/// `text` is no such number; the message says what to give.
pub fn read(text: &str, units: &[Unit]) -> Result<f64, String> {
    let text = text.trim();
    let with = |&(name, size): &Unit| Some(size * number(text.strip_suffix(name)?)?);
    number(text).or_else(|| units.iter().find_map(with)).ok_or_else(|| match units {
        [] | [("", _)] => format!("\"{text}\" is not a number"),
        [("", _), ..] => format!("\"{text}\" is not a number, nor one with %"),
        [(own, _), ..] => {
            let names: Vec<&str> = units.iter().map(|(name, _)| *name).collect();
            format!("\"{text}\" is not a number in {own}, nor one with its unit: {}", names.join(", "))
        }
    })
}

/// The unit of that name.
pub fn named(name: &str, units: &[Unit]) -> Option<Unit> {
    units.iter().copied().find(|unit| unit.0 == name)
}

/// A value in the SI unit `si`, in the unit in which a person reads it best: `0.0022` and `m` are `2.2` and `mm`.
pub fn readable(value: f64, si: &'static str) -> Unit {
    // Smallest first.
    let units: &[Unit] = match si {
        "m" => &[("µm", 1e-6), ("mm", 1e-3), ("m", 1.0)],
        "m/s" => &[("mm/s", 1e-3), ("m/s", 1.0)],
        "m/s²" if value.abs() < 0.1 => &[("mm/s²", 1e-3)],
        "N" => &[("mN", 1e-3), ("N", 1.0), ("kN", 1e3), ("MN", 1e6)],
        "J" => &[("µJ", 1e-6), ("mJ", 1e-3), ("J", 1.0), ("kJ", 1e3), ("MJ", 1e6)],
        "kg" => &[("g", 1e-3), ("kg", 1.0), ("t", 1e3)],
        "Pa" => &[("Pa", 1.0), ("kPa", 1e3), ("MPa", 1e6), ("GPa", 1e9)],
        "N/m" => &[("N/m", 1.0), ("kN/m", 1e3), ("MN/m", 1e6)],
        "N·s/m" => &[("N·s/m", 1.0), ("kN·s/m", 1e3)],
        _ => return (si, value),
    };
    // A value that would round to 1000 of a unit is given as 1 of the next.
    let fits = |&&(_, size): &&Unit| value.abs() >= 0.99995 * size;
    let plain = units.iter().find(|unit| unit.1 == if si == "m" { 1e-3 } else { 1.0 });
    let unit = if value == 0.0 { plain } else { units.iter().rev().find(fits).or(units.first()) };
    unit.map_or((si, value), |(name, size)| (name, value / size))
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
            ("2 g mm", IMBALANCE, 2e-6),
            ("7 kg mm", IMBALANCE, 0.007),
        ] {
            assert_eq!(read(text, units), Ok(value), "{text}");
        }
        assert!(read("120rpm", FREQUENCY).is_ok_and(|omega| (omega - 2.0 * TAU).abs() < 1e-14));
    }

    #[test]
    fn exact_what_a_person_reads_is_read_again() {
        for (value, si, units, words) in [
            (0.0022, "m", LENGTH, (2.2, "mm")),
            (4e-7, "m", LENGTH, (0.4, "µm")),
            (1.3, "m", LENGTH, (1.3, "m")),
            (28_000.0, "N", FORCE, (28.0, "kN")),
            (0.02, "N", FORCE, (20.0, "mN")),
            (4e4, "kg", MASS, (40.0, "t")),
            (800.0, "kg", MASS, (800.0, "kg")),
            (121_700.0, "N/m", STIFFNESS, (121.7, "kN/m")),
            (0.5533, "J", ENERGY, (553.3, "mJ")),
            (0.0, "J", ENERGY, (0.0, "J")),
            (f64::INFINITY, "N·s/m", DAMPING, (f64::INFINITY, "kN·s/m")),
            (0.05, "m/s²", ACCELERATION, (50.0, "mm/s²")),
            (0.5, "m/s²", ACCELERATION, (0.5, "m/s²")),
            (0.2, "m/s", VELOCITY, (200.0, "mm/s")),
            (3.0, "rad/s", FREQUENCY, (3.0, "rad/s")),
        ] {
            let (unit, number) = readable(value, si);
            assert!((number - words.0).abs() < 1e-12 * words.0 || number == words.0, "{number} {unit}");
            assert_eq!(unit, words.1, "{value}");
            let again = read(&format!("{number} {unit}"), units).expect("a number");
            assert!(again == value || (again / value - 1.0).abs() < 1e-15, "{again} {value}");
        }
        assert_eq!(read("2 %", SHARE), Ok(0.02));
        assert_eq!(read("0.1g", ACCELERATION), Ok(0.980_665));
    }

    #[test]
    fn contract_what_is_no_number_is_refused_with_the_units() {
        for text in ["", "Hz", "2kHz", "two", "3 rpm s"] {
            assert!(read(text, FREQUENCY).is_err_and(|words| words.contains("rad/s, Hz, rpm")), "{text}");
        }
        assert_eq!(read("two", NONE), Err("\"two\" is not a number".to_owned()));
    }
}
