//! Numbers of a design in readable units.

use super::candidate::Candidate;
use super::driving::Driving;
use super::requirements::{Constraint, Requirements};
use crate::describe::forced;
use retune_model::{Measure, Parameter, unit};
use retune_study::rounded;
use std::f64::consts::TAU;

/// A value in an SI unit, to four digits, in a readable unit.
pub(super) fn sized(value: f64, si: &'static str) -> String {
    if !value.is_finite() {
        return "no bound".to_owned();
    }
    let (unit, number) = unit::readable(value, si);
    format!("{} {unit}", rounded(number, 4))
}

/// Values in an SI unit, to four digits, in a readable unit for the largest of them.
pub(super) fn alike(values: &[f64], si: &'static str) -> Vec<String> {
    let largest = values.iter().copied().filter(|value| value.is_finite()).fold(0.0, f64::max);
    let (unit, number) = unit::readable(largest, si);
    let scale = if largest > 0.0 { number / largest } else { 1.0 };
    let one = |value: &f64| match value.is_finite() {
        true => format!("{} {unit}", rounded(scale * value, 4)),
        false => "no bound".to_owned(),
    };
    values.iter().map(one).collect()
}

/// Rewrites numbers with all their digits in SI units in readable form: `0.000306354 m` to `306.4 µm`, `0.6978 to 0.8342 m/s` to `697.8 to
/// 834.2 mm/s`.
pub(super) fn legible(words: &str) -> String {
    let all: Vec<&str> = words.split(' ').collect();
    let number = |i: usize| all.get(i).and_then(|word| word.parse::<f64>().ok());
    // Whole numbers, such as counts and percentages, are kept, as are those of a quantity below 1e4.
    let broken = |i: usize| number(i).filter(|_| all[i].contains(['.', 'e']));
    let long = |i: usize| number(i).filter(|value| value.abs() >= 1e4).or_else(|| broken(i));
    // The unit at word `i`, if it is one, whether it is `%`, and the punctuation after it.
    let unit = |i: usize| {
        let word = all.get(i).copied().unwrap_or_default();
        let unit = word.trim_end_matches([',', ';', '.', ')']);
        let known = Measure::ALL.into_iter().map(Measure::unit).find(|known| *known == unit);
        (known, unit == "%", &word[unit.len()..])
    };
    let mut readable: Vec<String> = Vec::new();
    let mut i = 0;
    while let Some(word) = all.get(i) {
        let upper = number(i + 2).filter(|_| all.get(i + 1) == Some(&"to"));
        match (long(i), number(i).zip(upper), unit(i + 3), unit(i + 1)) {
            (_, Some((low, high)), (Some(known), _, rest), _) => {
                let both = alike(&[low, high], known);
                let low = both[0].split(' ').next().unwrap_or_default();
                readable.push(format!("{low} to {}{rest}", both[1]));
                i += 4;
            }
            (Some(value), _, _, (Some(known), _, rest)) => {
                readable.push(format!("{}{rest}", sized(value, known)));
                i += 2;
            }
            (_, _, _, (_, is_percent, _)) => {
                let digits = if is_percent { 3 } else { 4 };
                readable.push(broken(i).map_or_else(|| (*word).to_owned(), |value| rounded(value, digits)));
                i += 1;
            }
        }
    }
    readable.join(" ")
}

/// An angular frequency, rad/s, in a unit.
pub(super) fn frequency(omega: f64, unit: &'static str) -> String {
    format!("{} {unit}", rounded(omega / radians(unit), 4))
}

/// A unit of frequency in rad/s.
pub(super) fn radians(unit: &str) -> f64 {
    unit::FREQUENCY.iter().find(|(name, _)| *name == unit).map_or(1.0, |(_, size)| *size)
}

pub(super) fn parameters(of: &Candidate) -> String {
    let Some(damper) = of.damper() else { return "no damper".to_owned() };
    let gaps = if damper.contact.is_some() { &Parameter::PAPER[..] } else { &Parameter::PAPER[..2] };
    let one =
        |parameter: &Parameter| format!("{parameter} = {}", sized(parameter.get(&damper), parameter.unit()));
    let mass = format!("m2 = {}", sized(damper.mass.get(), "kg"));
    std::iter::once(mass).chain(gaps.iter().map(one)).collect::<Vec<_>>().join(", ")
}

/// The frequency of a damper alone, and its damping as a share of critical.
pub(super) fn tuning(of: &Candidate, requirements: &Requirements) -> String {
    let Some(damper) = of.damper() else { return String::new() };
    let (m2, k2) = (damper.mass.get(), damper.stiffness.get());
    let natural = (k2 / m2).sqrt();
    if natural == 0.0 {
        return "no spring".to_owned();
    }
    let zeta = damper.damping.get() / (2.0 * m2 * natural);
    let unit = if requirements.frequencies == "rpm" { "Hz" } else { requirements.frequencies };
    format!("{}, damping {} %", frequency(natural, unit), rounded(100.0 * zeta, 3))
}

pub(super) fn natural(requirements: &Requirements) -> String {
    let omega = requirements.natural_frequency();
    match requirements.frequencies {
        "rad/s" => frequency(omega, "rad/s"),
        _ => format!("{} Hz", rounded(omega / TAU, 4)),
    }
}

/// A share in percent, to three digits.
pub(super) fn percent(share: f64) -> String {
    format!("{} %", rounded(100.0 * share, 3))
}

/// The requirements in words, wrapped for the screen.
pub(super) fn question(requirements: &Requirements) -> Vec<String> {
    let broken = wrap_at_spaces();
    asked(requirements).iter().map(|line| textwrap::fill(line, &broken)).collect()
}

pub(super) fn asked(requirements: &Requirements) -> Vec<String> {
    let own = natural(requirements);
    let critical = 2.0 * requirements.m1 * requirements.natural_frequency();
    let driving = moved(requirements);
    let limits: Vec<String> =
        requirements.constraints().into_iter().map(|constraint| limit(requirements, constraint)).collect();
    let limits = if limits.is_empty() { String::new() } else { format!(", {}", limits.join(", ")) };
    let off = requirements
        .k1_error
        .map_or(String::new(), |error| format!(" for every k1 within ±{}", percent(error)));
    let Requirements { m1, k1, c1, mass, goal, .. } = requirements;
    let (damping, share, goal) = (percent(c1 / critical), percent(mass / m1), goal.name());
    let ([m1, mass], k1) = ([*m1, *mass].map(|mass| sized(mass, "kg")), sized(*k1, "N/m"));
    vec![
        format!("Structure: {m1} on {k1}, {own}, damping {damping}; {driving}."),
        format!("Asked for: a damper of {mass} ({share}) with the least {goal}{off}{limits}."),
    ]
}

/// The excitation in words.
fn moved(requirements: &Requirements) -> String {
    let (amplitude, band) = match &requirements.driving {
        Driving::Harmonic { amplitude, band } => (*amplitude, *band),
        Driving::History { forcing, after } => {
            let end = requirements.run().map_or(f64::NAN, |run| run.to);
            let (from, end) = (rounded(*after, 4), rounded(end, 4));
            return format!("{}. Largest values from {from} s to {end} s", forced(forcing));
        }
    };
    let (of, size) = amplitude;
    let driving = format!("{} {}", of.words(), sized(size, of.parameter().unit()));
    let unit = requirements.frequencies;
    let [from, to] = band.map(|end| frequency(end, unit));
    format!("{driving}, {} to {to}", from.trim_end_matches(unit).trim_end())
}

pub(super) fn limit(requirements: &Requirements, constraint: Constraint) -> String {
    format!("{} at most {}", constraint.name(), sized(requirements.allowed(constraint), constraint.unit()))
}

/// Wraps lines at 80 columns, at spaces only, so that file names stay whole.
pub(super) fn wrap_at_spaces() -> textwrap::Options<'static> {
    textwrap::Options::new(80).subsequent_indent("  ").word_splitter(textwrap::WordSplitter::NoHyphenation)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regress_both_ends_of_a_range_are_told_in_one_unit() {
        for (words, told) in [
            ("have 0.697812 to 0.834199 m/s; 1 % more", "have 697.8 to 834.2 mm/s; 1 % more"),
            ("stroke is 0.000306354 m, 1.41372 % over", "stroke is 306.4 µm, 1.41 % over"),
            ("from 0.5 to 2.25 P, at omega = 548.81234 rad/s", "from 0.5 to 2.25 P, at omega = 548.8 rad/s"),
            ("have 1 to 2 m, 3 J", "have 1 to 2 m, 3 J"),
            ("have 0 to 0.002 m;", "have 0 to 2 mm;"),
            ("gives 610086.25 J, 1.10261 times", "gives 610.1 kJ, 1.103 times"),
            ("contact_force is 50744 N with 122256 starts", "contact_force is 50.74 kN with 122256 starts"),
        ] {
            assert_eq!(legible(words), told);
        }
    }
}
