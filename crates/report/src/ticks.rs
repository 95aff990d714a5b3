//! Ticks at round numbers: as many as fit, between 3 and 9 wherever possible.

use crate::axis::{Axis, Scale};

/// The value of a tick and its label.
pub(crate) type Tick = (f64, String);

/// Most ticks of an axis.
const MAX_TICKS: usize = 9;
/// Fewest ticks, if they fit.
const MIN_TICKS: usize = 3;
/// Numbers of more characters than this are written with a power of ten.
const MAX_CHARACTERS: usize = 6;

/// The ticks of an axis: the densest whose labels fit. `fits(ticks, s)` tells whether they fit with `s` times the usual space
/// between them; the space is reduced where too few would fit.
pub(crate) fn ticks(axis: &Axis, fits: impl Fn(&[Tick], f64) -> bool) -> Vec<Tick> {
    if !axis.names.is_empty() {
        return axis.names.clone();
    }
    let all: Vec<Vec<Tick>> =
        candidates(axis).into_iter().map(|(values, step)| label(values, step)).collect();
    for (least, space) in [(MIN_TICKS, 1.0), (MIN_TICKS, 0.6), (2, 0.6), (1, 0.6)] {
        if let Some(ticks) = all.iter().find(|ticks| ticks.len() >= least && fits(ticks, space)) {
            return ticks.clone();
        }
    }
    Vec::new()
}

/// Minor ticks: the other multiples of each power of ten, where every power is labelled.
pub(crate) fn minor(axis: &Axis, ticks: &[Tick]) -> Vec<f64> {
    let decades = ticks.windows(2).all(|pair| (pair[1].0 / pair[0].0 - 10.0).abs() < 1e-6);
    if axis.scale != Scale::Log || ticks.len() < 2 || !decades {
        return Vec::new();
    }
    let (first, last) = powers(axis);
    let all = (first..=last).flat_map(|n| (2..10).map(move |f| f64::from(f) * 10_f64.powi(n)));
    all.filter(|value| axis.holds(*value)).collect()
}

/// Candidate sets of ticks, densest first, each with its step; zero if it has none.
fn candidates(axis: &Axis) -> Vec<(Vec<f64>, f64)> {
    let mut all = Vec::new();
    if axis.scale == Scale::Log {
        let decimal = in_decades(axis, &[1.0, 2.0, 5.0], 1);
        let few = decimal.len() < MIN_TICKS;
        if !few {
            all.push((decimal, 0.0));
            all.extend((1..400).map(|every| (in_decades(axis, &[1.0], every), 0.0)));
        }
        if few {
            all.extend(multiples(axis));
            all.push((in_decades(axis, &[1.0, 2.0, 3.0, 5.0, 7.0], 1), 0.0));
        }
    } else {
        all.extend(multiples(axis));
    }
    all.retain(|(values, _)| (1..=MAX_TICKS).contains(&values.len()));
    all
}

/// The powers of ten below the beginning and above the end of an axis.
fn powers(axis: &Axis) -> (i32, i32) {
    (axis.range.0.log10().floor() as i32, axis.range.1.log10().ceil() as i32)
}

/// The multiples `factors` of every `every`-th power of ten.
fn in_decades(axis: &Axis, factors: &[f64], every: i32) -> Vec<f64> {
    let (from, to) = axis.range;
    let (first, last) = powers(axis);
    // Powers divisible by `every`, so that 1 is among them.
    let all = (first..=last).filter(|n| n % every == 0);
    let values = all.flat_map(|n| factors.iter().map(move |f| f * 10_f64.powi(n)));
    values.filter(|v| (from * (1.0 - 1e-9)..=to * (1.0 + 1e-9)).contains(v)).take(MAX_TICKS + 1).collect()
}

/// Multiples of 1, 2 and 5 times powers of ten.
fn multiples(axis: &Axis) -> impl Iterator<Item = (Vec<f64>, f64)> + '_ {
    let (from, to) = axis.range;
    let power = (to - from).log10().floor() as i32;
    let steps = (power - 1..=power).flat_map(|n| [1.0, 2.0, 5.0].map(|f| f * 10_f64.powi(n)));
    steps.map(move |step| {
        let (first, last) = ((from / step - 1e-9).ceil() as i64, (to / step + 1e-9).floor() as i64);
        ((first..=last).take(MAX_TICKS + 1).map(|i| i as f64 * step).collect(), step)
    })
}

/// Formats numbers: as decimals, or, if one of them were long, with powers of ten where these are shorter.
fn label(values: Vec<f64>, step: f64) -> Vec<Tick> {
    let decimals = |size: f64| (-(size.log10() + 1e-9).floor()).max(0.0) as usize;
    let places = |value: f64| decimals(if step > 0.0 { step } else { value });
    let plain: Vec<String> = values.iter().map(|&v| minus(format!("{v:.*}", places(v)))).collect();
    let longest = |words: &[String]| words.iter().map(|word| word.chars().count()).max().unwrap_or(0);
    let words = if longest(&plain) <= MAX_CHARACTERS + usize::from(values.iter().any(|v| *v < 0.0)) {
        plain
    } else {
        let size = values.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
        let scientific: Vec<String> = values
            .iter()
            .map(|&value| {
                let power = (if step > 0.0 { size } else { value }).log10() + 1e-9;
                scientific(value, step, power.floor() as i32)
            })
            .collect();
        if longest(&scientific) < longest(&plain) { scientific } else { plain }
    };
    values.into_iter().zip(words).collect()
}

fn minus(text: String) -> String {
    text.replace('-', "−")
}

/// `2.5·10⁻⁷`; a factor of one is left out, and small powers are written in full.
fn scientific(value: f64, step: f64, power: i32) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let unit = 10_f64.powi(power);
    let places = if step > 0.0 { (-((step / unit).log10() + 1e-9).floor()).max(0.0) as usize } else { 0 };
    let factor = minus(format!("{:.places$}", value / unit));
    match (factor.as_str(), power) {
        (_, 0) => factor,
        ("1", _) => ten_to(power),
        ("−1", _) => format!("−{}", ten_to(power)),
        _ => format!("{factor}·{}", ten_to(power)),
    }
}

/// `10⁻³`; one and ten as they are.
pub fn ten_to(power: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised = |c: char| c.to_digit(10).map_or('⁻', |digit| DIGITS[digit as usize]);
    match power {
        0 => "1".to_owned(),
        1 => "10".to_owned(),
        _ => format!("10{}", power.to_string().chars().map(raised).collect::<String>()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis, most: usize) -> Vec<String> {
        ticks(axis, |ticks, _| ticks.len() <= most).into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn exact_ticks_of_some_ranges() {
        let linear = |from, to| labels(&Axis::linear("", (from, to)), 7);
        let log = |from, to| labels(&Axis::log("", (from, to)), 9);
        assert_eq!(linear(0.0, 1.0), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(linear(0.02, 0.14), ["0.02", "0.04", "0.06", "0.08", "0.10", "0.12", "0.14"]);
        assert_eq!(linear(-0.1, 0.1), ["−0.10", "−0.05", "0.00", "0.05", "0.10"]);
        assert_eq!(linear(1e4, 6e4), ["10000", "20000", "30000", "40000", "50000", "60000"]);
        assert_eq!(linear(0.0, 2.2e7), ["0", "0.5·10⁷", "1.0·10⁷", "1.5·10⁷", "2.0·10⁷"]);
        assert_eq!(
            linear(0.0, 3e-8),
            ["0", "0.5·10⁻⁸", "1.0·10⁻⁸", "1.5·10⁻⁸", "2.0·10⁻⁸", "2.5·10⁻⁸", "3.0·10⁻⁸"]
        );
        assert_eq!(log(30.0, 3000.0), ["50", "100", "200", "500", "1000", "2000"]);
        assert_eq!(log(1e-3, 1e3), ["0.001", "0.01", "0.1", "1", "10", "100", "1000"]);
        assert_eq!(log(1e-15, 10.0), ["10⁻¹⁴", "10⁻¹²", "10⁻¹⁰", "10⁻⁸", "10⁻⁶", "10⁻⁴", "10⁻²", "1"]);
        assert_eq!(log(2.1, 9.9), ["3", "4", "5", "6", "7", "8", "9"]);
    }

    /// Whether a number is 1, 2 or 5 times a power of ten.
    fn round(value: f64) -> bool {
        let factor = value / 10_f64.powf((value.log10() + 1e-9).floor());
        [1.0, 2.0, 5.0].iter().any(|f| (factor / f - 1.0).abs() < 1e-6)
    }

    #[test]
    fn contract_ticks_are_round_and_within_the_range_and_three_to_nine() {
        let mut seed = 1_u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64
        };
        for i in 0..5000 {
            let width = 10_f64.powf(12.0 * random() - 6.0);
            let from = if i % 3 == 0 { 0.0 } else { width * (20.0 * random() - 10.0) };
            let linear = Axis::linear("", (from, from + width));
            let low = 10_f64.powf(12.0 * random() - 6.0);
            let log = Axis::log("", (low, low * 10_f64.powf(0.05 + 20.0 * random().powi(2))));
            for axis in [linear, log] {
                let found = ticks(&axis, |_, _| true);
                let (from, to) = axis.range;
                assert!((3..=9).contains(&found.len()), "{:?}: {found:?}", axis.range);
                let slack = 1e-8 * (to - from);
                assert!(found.iter().all(|(v, _)| (from - slack..=to + slack).contains(v)), "{found:?}");
                let steps: Vec<f64> = found.windows(2).map(|pair| pair[1].0 - pair[0].0).collect();
                let even = steps.iter().all(|step| (step / steps[0] - 1.0).abs() < 1e-6) && round(steps[0]);
                assert!(even || found.iter().all(|(v, _)| round(*v)), "{:?}: {found:?}", axis.range);
                let mut words: Vec<&String> = found.iter().map(|(_, text)| text).collect();
                words.dedup();
                assert_eq!(words.len(), found.len(), "{found:?}");
            }
        }
    }

    #[test]
    fn contract_labels_say_their_values() {
        let digits = |c: char| match c {
            '−' | '⁻' => '-',
            '¹' => '1',
            '²' => '2',
            '³' => '3',
            '⁰'..='⁹' => char::from_digit(u32::from(c) - 0x2070, 10).expect("a digit"),
            c => c,
        };
        let value = |text: &str| -> f64 {
            let (factor, power) = match text.split_once("·10") {
                Some((factor, power)) => (factor.to_owned(), power),
                None if text.contains("10") && !text.ends_with(|c: char| c.is_ascii_digit()) => {
                    let (sign, power) = text.split_once("10").expect("ten");
                    (format!("{sign}1"), power)
                }
                None => (text.to_owned(), "⁰"),
            };
            let [factor, power] =
                [factor, power.to_owned()].map(|t| t.chars().map(digits).collect::<String>());
            factor.parse::<f64>().expect("a factor") * 10_f64.powi(power.parse().expect("a power"))
        };
        for n in -9..9 {
            for from in [0.0, -0.7, 1.3] {
                let unit = 10_f64.powi(n);
                for axis in [
                    Axis::linear("", (from * unit, (from + 1.1) * unit)),
                    Axis::log("", (unit, 1e3 * unit * (1.0 + from.abs()))),
                ] {
                    for (tick, text) in ticks(&axis, |_, _| true) {
                        assert!((value(&text) - tick).abs() < 1e-9 * unit.max(tick.abs()), "{tick}: {text}");
                    }
                }
            }
        }
    }

    #[test]
    fn contract_every_labelled_decade_has_minor_ticks() {
        let axis = Axis::log("", (0.5, 2000.0));
        let decades = vec![(1.0, String::new()), (10.0, String::new())];
        let small = minor(&axis, &decades);
        assert!(small.contains(&0.5) && small.contains(&2000.0) && small.contains(&30.0), "{small:?}");
        assert!(!small.iter().any(|v| axis.fraction(*v) < 0.0));
        assert!(minor(&axis, &[(1.0, String::new()), (100.0, String::new())]).is_empty());
    }
}
