//! A window that follows the structure: `"window": "settled"`.

use crate::format::Span;
use crate::{Rule, records};
use retune_model::{Course, NonNegative, Positive, Scene};
use serde::Deserialize;
use serde_json::Value;
use std::f64::consts::TAU;
use std::path::Path;

/// Fraction of the slowest transient that remains when a settled window begins.
pub const LEFT: f64 = 1e-3;
/// Fraction of the slowest transient that counts as significant.
const SIGNIFICANT: f64 = 1e-2;
/// Periods of the force in a settled window.
const PERIODS: f64 = 50.0;
/// Least number of periods of a band's lowest frequency in a window.
pub const SLOWEST: f64 = 5.0;
/// Most periods of the force before a settled window.
const MOST_PERIODS: f64 = 10_000.0;

impl Span {
    /// The window that begins when the slowest transient of a scene, with its walls open, has fallen to [`LEFT`] of its start, and lasts 50
    /// periods of the force. For a free decay it runs from 0 until that time; for a pulse or a record, from 0 until as long after its end.
    pub fn settled(scene: &Scene) -> Result<Self, Rule> {
        let rate = scene.slowest_decay();
        let period = TAU / scene.forcing.frequency.get();
        let until = -LEFT.ln() / rate;
        let is_transient = scene.forcing.is_transient();
        let over = scene.forcing.history().map_or(0.0, |history| history.course.end());
        let span = if is_transient { [0.0, over + until] } else { [until, until + PERIODS * period] };
        let [t0, end] = [NonNegative::new(span[0]).ok(), NonNegative::new(span[1]).ok()];
        match (t0, end.and_then(|end| Positive::new(end.get()).ok())) {
            (Some(t0), Some(end)) if is_transient || until <= MOST_PERIODS * period => Ok(Self { t0, end }),
            _ => Err(Rule::not_allowed(
                "window",
                format!("settled, of a scene whose slowest transient decays by {rate} 1/s"),
                "a scene that settles in 10,000 periods of its force: give t0 and T, or more damping",
            )),
        }
    }
}

/// Replaces `"window": "settled"` in the text of a study by the numbers of that window, without changing the line numbers; none for any
/// other window.
///
/// # Errors
/// As [`Span::settled`]; a record of the scene cannot be read. `base` is the directory where its path begins.
pub fn resolved(text: &str, base: &Path) -> Result<Option<String>, Rule> {
    #[derive(Deserialize)]
    struct Part {
        window: Value,
        scene: Scene,
        #[serde(default)]
        optimize: Value,
    }
    let part = serde_json::from_str::<Part>(text).ok().filter(|part| part.window == "settled");
    let (Some(Part { mut scene, optimize, .. }), Some(place)) = (part, place(text)) else { return Ok(None) };
    records::read(&mut scene, base)?;
    let Span { t0, end } = Span::settled(&scene)?;
    let over = lowest_frequency(&optimize["objective"], &scene).map_or(0.0, |lowest| SLOWEST * TAU / lowest);
    let end = if scene.forcing.is_transient() { end.get() } else { end.get().max(t0.get() + over) };
    let window = format!("{{ \"t0\": {}, \"T\": {end} }}", t0.get());
    Ok(Some(format!("{}{window}{}", &text[..place.start], &text[place.end..])))
}

/// The lowest frequency of the bands of an objective, rad/s.
fn lowest_frequency(objective: &Value, scene: &Scene) -> Option<f64> {
    let own = objective["omega"]["from"].as_f64().map(|from| match objective["omega"]["relative"] {
        Value::Bool(true) => from * scene.primary.natural_frequency(),
        _ => from,
    });
    let parts = objective["sum"].as_array().into_iter().flatten();
    let all = parts.filter_map(|part| lowest_frequency(&part["objective"], scene)).chain(own);
    all.filter(|lowest| *lowest > 0.0).reduce(f64::min)
}

/// The position of the word `"settled"` after the field `window`.
fn place(text: &str) -> Option<std::ops::Range<usize>> {
    const WORD: &str = "\"settled\"";
    text.match_indices("\"window\"").find_map(|(at, field)| {
        let rest = text[at + field.len()..].trim_start().strip_prefix(':')?.trim_start();
        let start = text.len() - rest.len();
        rest.starts_with(WORD).then_some(start..start + WORD.len())
    })
}

impl crate::Study {
    /// The fraction of the slowest transient that remains at t0, if it is significant and maxima are taken in the window: none if the whole
    /// run counts or the forcing is transient.
    pub fn unsettled(&self) -> Option<f64> {
        let t0 = self.window.t0.get();
        let left = (-self.scene.slowest_decay() * t0).exp();
        let windowed = self.objective().response == retune_optim::Response::Window;
        (t0 > 0.0 && windowed && left >= SIGNIFICANT && !self.scene.forcing.is_transient()).then_some(left)
    }

    /// A warning that the record ends before the run, or that maxima in the window include a significant transient.
    pub fn transient(&self) -> Option<String> {
        if let Some(Course::Record(record)) = self.scene.forcing.history().map(|history| history.course)
            && let Some(end) =
                record.samples().map(|samples| samples.end()).filter(|end| *end < self.window.end.get())
        {
            let to = self.window.end.get();
            return Some(format!("the record ends at {end} s; from there to T = {to} s the motion is free"));
        }
        let (left, t0) = (self.unsettled()?, self.window.t0.get());
        let later = match Span::settled(&self.scene) {
            Ok(span) => format!("\"window\": \"settled\" begins at {:.4} s", span.t0.get()),
            Err(_) => "nothing damps it".to_owned(),
        };
        Some(format!(
            "at t0 = {t0} s the slowest transient still has {:.2} % of its start, and maxima in the window hold it: {later}",
            100.0 * left
        ))
    }
}

/// What a study may say of its window.
#[derive(schemars::JsonSchema)]
#[serde(untagged)]
#[expect(dead_code, reason = "for the schema alone")]
pub enum Said {
    /// From t0 to T.
    Span(Span),
    /// In a word.
    Word(Word),
}

/// A window in a word.
#[derive(schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
#[expect(dead_code, reason = "for the schema alone")]
pub enum Word {
    /// From when the slowest transient of the scene, with its walls open, is below 0.1 % of its start, for 50 periods of the force, and at least 5
    /// of the slowest of a band.
    Settled,
}

#[cfg(test)]
mod tests {
    use crate::read::from_text;
    use serde_json::json;

    /// A building of 0.3 Hz with 1 % of damping, and a window in a word or in numbers.
    fn building(window: &serde_json::Value) -> String {
        let omega = 2.0 * std::f64::consts::PI * 0.3;
        let primary = json!({ "m1": 2e5, "c1": 2.0 * 0.01 * 2e5 * omega, "k1": 2e5 * omega * omega });
        let scene = json!({ "primary": primary, "forcing": { "P": 1000.0, "omega": omega } });
        serde_json::to_string_pretty(&json!({ "scene": scene, "window": window })).expect("JSON")
    }

    #[test]
    fn exact_a_settled_window_begins_when_a_thousandth_is_left() {
        let study = from_text(&building(&json!("settled")), "building").expect("a study");
        let (t0, end) = (study.window.t0.get(), study.window.end.get());
        // exp(-0.01 ω t) has fallen to a thousandth; then 50 periods of 1 / 0.3 s.
        let expected = 1000f64.ln() / (0.01 * 0.6 * std::f64::consts::PI);
        assert!(
            (t0 / expected - 1.0).abs() < 1e-12 && ((end - t0) * 0.3 / 50.0 - 1.0).abs() < 1e-12,
            "{t0} {end}"
        );
        assert_eq!(study.transient(), None);
        let resolved = serde_json::to_string(&study.resolved()).expect("JSON");
        assert_eq!(from_text(&resolved, "building").expect("a study").window, study.window);
    }

    #[test]
    fn exact_a_settled_window_holds_periods_of_the_slowest_force() {
        let mut study: serde_json::Value = serde_json::from_str(&building(&json!("settled"))).expect("JSON");
        for (objective, slowest) in [
            (json!({ "omega": { "from": 0.01, "to": 2.0 } }), 0.01),
            (
                json!({ "omega": { "from": 0.002, "to": 1.2, "relative": true } }),
                0.0012 * std::f64::consts::PI,
            ),
            (
                json!({ "sum": [{ "weight": 1, "objective": { "omega": { "from": 0.02, "to": 2.0 } } }] }),
                0.02,
            ),
        ] {
            study["scene"]["damper"] = json!({ "m2": 2e3, "k2": 7e3, "c2": 700 });
            study["optimize"] = json!({ "vary": ["k2"], "objective": objective });
            let read = from_text(&study.to_string(), "building").expect("a study");
            let length = read.window.end.get() - read.window.t0.get();
            assert!(
                (length * slowest / (10.0 * std::f64::consts::PI) - 1.0).abs() < 1e-9,
                "{length} {slowest}"
            );
        }
    }

    #[test]
    fn contract_a_window_that_holds_the_transient_says_so() {
        let said = |window| from_text(&building(&window), "building").expect("a study").transient();
        let words = said(json!({ "t0": 50, "T": 100 })).expect("a sentence");
        assert!(
            words.starts_with("at t0 = 50 s the slowest transient still has 38.97 % of its start"),
            "{words}"
        );
        assert_eq!(said(json!({ "t0": 0, "T": 100 })), None, "the whole run was asked for");
        assert_eq!(said(json!({ "t0": 300, "T": 400 })), None);
    }

    #[test]
    fn contract_what_never_settles_is_refused_with_the_field() {
        let scene = json!({ "primary": { "m1": 1, "c1": 0, "k1": 1 }, "forcing": { "P": 1, "omega": 1 } });
        let text = json!({ "scene": scene, "window": "settled" }).to_string();
        let error = from_text(&text, "mine").expect_err("no damping").to_string();
        assert!(
            error.starts_with("mine: window: settled, of a scene whose slowest transient decays by 0 1/s"),
            "{error}"
        );
    }
}
