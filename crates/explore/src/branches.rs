//! Every periodic motion over the band, stable or not, that runs from many starts lead to. The curves of runs from rest do not show these.

use crate::limits::{MOST_MOTIONS, of_periods};
use crate::protocol::Answer;
use crate::response::{Stale, band};
use retune_dynamics::periodic::branches::{Plan, SPACINGS};
use retune_dynamics::periodic::{Branch, Branches, Control, Event, EventKind, Largest, branches};
use retune_model::{Measure, Parameter};
use retune_study::{Study, rounded};
use serde_json::{Map, Value, json};
use std::sync::atomic::{AtomicU64, Ordering::SeqCst};

/// Frequencies at which runs are started from rest. This and [`STARTS`] are the defaults of `retune branches`.
pub const SAMPLES: usize = 31;
/// Other starts, spread over the band, per such frequency.
pub const STARTS: usize = 16;
/// Most events of one kind marked on a branch; a cascade has any number of them.
const MOST_EVENTS: usize = 40;

/// The answer that reports the progress of the search.
pub fn progress(done: u64) -> Answer {
    Answer::new("following").with("done", done).with("of", SAMPLES)
}

/// Follows the motions of a study over its band; `send` receives progress.
///
/// # Errors
/// The work has become stale.
pub fn follow(
    study: &Study,
    send: &(dyn Fn(Answer) + Sync),
    is_stale: &(dyn Fn() -> bool + Sync),
) -> Result<Answer, Stale> {
    let answer = Answer::new("branches");
    let strikes = study.scene.damper.is_some_and(|damper| damper.contact.is_some());
    if !strikes || study.scene.forcing.is_transient() {
        return Ok(answer.with("problem", "nothing is struck: there is one motion, the response"));
    }
    if let Err(rule) = study.begins_at_rest() {
        return Ok(answer.with("problem", rule.to_string()));
    }
    let measure = study.quantity();
    let band = band(study);
    let range = [band.from, band.to];
    let plan = Plan {
        samples: SAMPLES,
        starts: STARTS,
        passes: SPACINGS.len(),
        ..Plan::over(Parameter::Omega, range)
    };
    let [done, made] = [AtomicU64::new(0), AtomicU64::new(0)];
    let watch = Control {
        done: &|| send(progress(1 + done.fetch_add(1, SeqCst))),
        proceed: &|| !is_stale() && made.fetch_add(1, SeqCst) < MOST_MOTIONS,
    };
    let found = branches(&study.scene, plan, &of_periods(study), watch);
    if is_stale() {
        return Err(Stale);
    }
    Ok(match found {
        Err(error) => answer.with("problem", error.to_string()),
        Ok(found) => {
            drawn(answer, &found, measure).with("largest", found.largest(measure).as_ref().map(largest))
        }
    })
}

/// Adds the branches as curves, separated by NaN, with their events: `value` is the study's quantity, and every quantity has a column of
/// its name.
fn drawn(answer: Answer, found: &Branches, measure: Measure) -> Answer {
    let mut columns: [Vec<f64>; 3 + Measure::ALL.len()] = Default::default();
    let mut push = |row: [f64; 3 + Measure::ALL.len()]| {
        columns.iter_mut().zip(row).for_each(|(column, value)| column.push(value));
    };
    for branch in &found.branches {
        for (place, orbit) in branch.points.iter().enumerate() {
            let head = [
                orbit.value,
                orbit.seen.largest(measure),
                f64::from(u8::from(branch.is_stable_after(place))),
            ];
            let all = Measure::ALL.map(|measure| orbit.seen.largest(measure));
            push(std::array::from_fn(|i| head.get(i).copied().unwrap_or_else(|| all[i - head.len()])));
        }
        push([f64::NAN; 3 + Measure::ALL.len()]);
    }
    let events: Vec<Value> = found.branches.iter().flat_map(|branch| events(branch, measure)).collect();
    let answer = answer.with("branches", found.branches.len()).with("ended", found.ended);
    ["omega", "value", "stable"]
        .into_iter()
        .chain(Measure::ALL.map(Measure::name))
        .zip(&columns)
        .fold(answer.with("events", events), |answer, (name, column)| answer.column(name, column))
}

/// The kind of each event, its frequency, the value there, and the value of each quantity.
fn events(branch: &Branch, measure: Measure) -> Vec<Value> {
    let of = |kind: EventKind| branch.events.iter().filter(move |event| event.kind == kind).take(MOST_EVENTS);
    let words = |event: &Event| {
        let value = |measure: Measure| event.orbit.seen.largest(measure);
        let all: Map<String, Value> = Measure::ALL
            .map(|measure| (measure.name().to_owned(), json!(value(measure))))
            .into_iter()
            .collect();
        json!([event.kind.name(), event.orbit.value, value(measure), all])
    };
    EventKind::ALL.into_iter().flat_map(of).map(words).collect()
}

fn largest(found: &Largest) -> Value {
    json!({
        "value": found.value,
        "words": rounded(found.value, 4),
        "omega": found.at,
        "rest": found.from_rest,
        "share": found.share.of_starts(),
        "periods": found.orbit.as_ref().map(|orbit| orbit.periods),
        "impacts": found.orbit.as_ref().map(|orbit| &orbit.seen.impacts),
    })
}
