//! An objective in words, for figures, tables and the screen; numbers and counts in words.

use retune_model::{Design, Parameter, Restitution};
use retune_optim::{Ensemble, FrequencyBand, Objective, Statistic, StiffnessRange, Stiffnesses};
use std::borrow::Cow;
use std::f64::consts::TAU;
use std::fmt::Display;

/// The range over which the E1max of an objective is taken, for a scene at `omega` (rad/s): "worst over omega = 5 to 8 rad/s". Empty for a
/// single value of a scene without a frequency.
pub fn over(objective: &Objective, omega: f64) -> String {
    if !objective.sum.is_empty() {
        return format!("weighted sum of {}", counted(objective.sum.len() as u64, "objective"));
    }
    let band = |FrequencyBand { from, to, relative, .. }: FrequencyBand| {
        let unit = if relative { "times √(k1/m1)" } else { "rad/s" };
        format!("omega = {} to {} {unit}", from.get(), to.get())
    };
    let over = [
        objective.omega.map(band),
        objective.k1.as_ref().map(stiffnesses),
        objective.restitution.as_deref().map(restitutions),
    ];
    let over: Vec<String> = over.into_iter().flatten().collect();
    // Decays, pulses and records have no frequency.
    let single = objective.omega.is_none() && omega > 0.0;
    let own = if single { format!("omega = {omega} rad/s") } else { String::new() };
    let worst = if over.is_empty() { String::new() } else { format!("worst over {}", over.join(" and ")) };
    let mut parts: Vec<String> = records(objective).into_iter().collect();
    parts.extend(objective.ensemble.iter().map(ensemble));
    parts.extend([own, worst].into_iter().filter(|part| !part.is_empty()));
    parts.join(", ")
}

fn restitutions(set: &[Restitution]) -> String {
    let values: Vec<String> = set.iter().map(|e| e.get().to_string()).collect();
    format!("restitution = {}", values.join(", "))
}

fn stiffnesses(of: &Stiffnesses) -> String {
    match of {
        Stiffnesses::Set(set) => {
            let values: Vec<String> = set.iter().map(|k1| k1.get().to_string()).collect();
            format!("k1 = {} N/m", values.join(", "))
        }
        Stiffnesses::Range(StiffnessRange { from, to, .. }) => {
            format!("k1 = {} to {} N/m", from.get(), to.get())
        }
    }
}

fn statistic(of: Statistic) -> String {
    match of {
        Statistic::Mean => "mean".to_owned(),
        Statistic::Worst => "worst".to_owned(),
        Statistic::Quantile(share) => format!("{share} quantile"),
    }
}

fn records(objective: &Objective) -> Option<String> {
    let count = objective.records.len() as u64;
    (count > 0).then(|| format!("{} of {}", statistic(objective.over_records()), counted(count, "record")))
}

fn ensemble(of: &Ensemble) -> String {
    let Ensemble { members, phases, errors, .. } = of;
    let of = statistic(of.statistic);
    let phases = if *phases { "all phases, " } else { "" };
    format!("{of} of {} ({phases}errors to {} %)", counted((*members).into(), "member"), 100.0 * errors)
}

/// A count with its noun: `1 design`, `2 searches`.
pub fn counted(count: u64, noun: &str) -> String {
    let ending = match count {
        1 => "",
        _ if noun.ends_with("ch") => "es",
        _ => "s",
    };
    format!("{count} {noun}{ending}")
}

/// A count with its noun and verb: `1 design is`, `2 designs are`.
pub fn are(count: u64, noun: &str) -> String {
    format!("{} {}", counted(count, noun), if count == 1 { "is" } else { "are" })
}

/// A number to six significant digits, in the shortest form: `215`, `0.0603333`, `1.23457e-9`.
pub fn short(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    let size = rounded.abs();
    if size != 0.0 && !(1e-4..1e7).contains(&size) { format!("{rounded:e}") } else { format!("{rounded}") }
}

/// A number to `digits` significant digits, in the shortest form.
pub fn rounded(value: f64, digits: usize) -> String {
    short(format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value))
}

/// An angular frequency, rad/s, to four digits in both units: `6.28 rad/s (0.9995 Hz)`.
pub fn frequency(omega: f64) -> String {
    format!("{} rad/s ({} Hz)", rounded(omega, 4), rounded(hertz_and_rpm(omega)[0], 4))
}

/// k2 (N/m), c2 (N·s/m), D (m) and C (m) of a design as table cells with `digits` significant digits; `none` for gaps without walls.
pub fn design_cells(design: &Design, digits: usize) -> [String; 4] {
    design.values().map(|value| if value.is_nan() { "none".to_owned() } else { rounded(value, digits) })
}

/// A design in words with `digits` significant digits: `k2 = 215 N/m, c2 = 35 N·s/m, D = 0.06 m, C = 0.06 m`, or `…, no walls`; then its
/// other parameters.
pub fn design_words(design: &Design, digits: usize) -> String {
    let [k2, c2, d, c] = design_cells(design, digits);
    let walls = if design.get(Parameter::D).is_nan() {
        "no walls".to_owned()
    } else {
        format!("D = {d} m, C = {c} m")
    };
    let others = Parameter::VARIED.into_iter().filter(|other| !Parameter::PAPER.contains(other));
    let others = others.filter(|other| !design.get(*other).is_nan());
    let others: Vec<String> = others
        .map(|other| format!(", {other} = {} {}", rounded(design.get(other), digits), other.unit()))
        .collect();
    format!("k2 = {k2} N/m, c2 = {c2} N·s/m, {walls}{}", others.concat())
}

/// An angular frequency (rad/s) in Hz and in revolutions per minute.
pub fn hertz_and_rpm(omega: f64) -> [f64; 2] {
    let hertz = omega / TAU;
    [hertz, 60.0 * hertz]
}

/// The items with `separator` between them.
pub fn joined<T: Display>(items: &[T], separator: &str) -> String {
    items.iter().map(T::to_string).collect::<Vec<_>>().join(separator)
}

/// The text with control characters escaped: the name of a file or a study must not control the terminal. Line ends and tabs
/// stay. The escapes are those of JSON, so a JSON text keeps its meaning.
pub fn visible(text: &str) -> Cow<'_, str> {
    if !text.contains(is_control) {
        return text.into();
    }
    let mut shown = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if is_control(c) {
            shown += &format!("\\u{:04x}", u32::from(c));
        } else {
            shown.push(c);
        }
    }
    shown.into()
}

/// Whether a character may control a terminal: control characters, and those that change the direction of writing.
fn is_control(c: char) -> bool {
    const TURNS: [std::ops::RangeInclusive<char>; 3] =
        ['\u{200e}'..='\u{200f}', '\u{202a}'..='\u{202e}', '\u{2066}'..='\u{2069}'];
    c.is_control() && !['\n', '\t'].contains(&c) || TURNS.iter().any(|turns| turns.contains(&c))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_a_design_without_walls_says_so() {
        let design = |gap: f64| {
            let value = |parameter| match parameter {
                Parameter::K2 => 215.04,
                Parameter::C2 => 35.0,
                Parameter::D | Parameter::C => gap,
                _ => f64::NAN,
            };
            Design::new(value).expect("a design")
        };
        let walled = design(0.06);
        assert_eq!(design_words(&walled, 4), "k2 = 215 N/m, c2 = 35 N·s/m, D = 0.06 m, C = 0.06 m");
        assert_eq!(design_cells(&walled, 4), ["215", "35", "0.06", "0.06"]);
        let open = design(f64::NAN);
        assert_eq!(design_words(&open, 4), "k2 = 215 N/m, c2 = 35 N·s/m, no walls");
        assert_eq!(design_cells(&open, 4), ["215", "35", "none", "none"]);
        let value = |parameter| if parameter == Parameter::M2 { 60.0 } else { open.get(parameter) };
        let heavy = Design::new(value).expect("a design");
        assert_eq!(design_words(&heavy, 4), "k2 = 215 N/m, c2 = 35 N·s/m, no walls, m2 = 60 kg");
    }

    #[test]
    fn contract_singular_and_plural() {
        let said = |count| [counted(count, "design"), counted(count, "CMA-ES search"), are(count, "value")];
        assert_eq!(said(1), ["1 design", "1 CMA-ES search", "1 value is"]);
        assert_eq!(said(0), ["0 designs", "0 CMA-ES searches", "0 values are"]);
        assert_eq!(said(2), ["2 designs", "2 CMA-ES searches", "2 values are"]);
    }

    #[test]
    fn contract_short_numbers_have_six_digits() {
        assert_eq!(short(215.0), "215");
        assert_eq!(short(0.060_333_333_3), "0.0603333");
        assert_eq!(short(1_234.567_89), "1234.57");
        assert_eq!(short(1.234_567_8e-9), "1.23457e-9");
        assert_eq!(short(0.0), "0");
    }

    #[test]
    fn contract_control_characters_are_escaped() {
        assert_eq!(visible("a\tb\nÄ √ N·s/m"), "a\tb\nÄ √ N·s/m");
        assert_eq!(
            visible("\u{1b}[2Jx\r\u{7}\u{9b}\u{7f}\u{202e}"),
            "\\u001b[2Jx\\u000d\\u0007\\u009b\\u007f\\u202e"
        );
        for c in (0..=0x10_ffff).filter_map(char::from_u32).filter(|c| c.is_control()) {
            assert_eq!(visible(&c.to_string()) == c.to_string(), c == '\n' || c == '\t', "{c:?}");
        }
        let json = serde_json::to_string("a\u{1b}\u{9b}\u{7f}\r\n\u{202e}").expect("JSON");
        let read: String = serde_json::from_str(&visible(&json)).expect("JSON still");
        assert_eq!(read, "a\u{1b}\u{9b}\u{7f}\r\n\u{202e}");
    }
}
