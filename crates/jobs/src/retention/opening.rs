//! The answer of `retention` in words, with which the page and the screen begin: who keeps its work, at equal performance at home, under the same
//! bound on k2, and under a smaller force. Every number is one of the tables beside the page.

use super::curves::Curve;
use super::force::{Forced, HALF};
use super::retained::{EQUAL, Retained};
use super::trade::Point;
use super::tuned::{Tuned, Tuning};
use crate::fronts::SAME;
use retune_model::Parameter;
use retune_study::{design_words, rounded, short};

/// The answer: what the title asks first, then a line for each damper.
pub(super) fn answer(retained: &Retained) -> Vec<String> {
    let shown = retained.shown();
    let first = [home(retained, &shown), robust(retained, &shown), smaller_force(retained, &shown)];
    let mut words: Vec<String> = first.into_iter().flatten().collect();
    words.extend(shown.iter().map(|&damper| one(retained, damper)));
    words.extend(retained.same().into_iter().map(|(damper, other)| {
        format!(
            "{}: every tuning ends at E1max of the {} within {} %, so that one stands for both on this page.",
            retained.name(damper),
            retained.name(other),
            100.0 * EQUAL
        )
    }));
    words
}

/// The retention ranges at equal performance at home: that of the nominal design which has the most E1max there among those that do their
/// work.
fn home(retained: &Retained, shown: &[usize]) -> Option<String> {
    let nominal = |damper: &usize| {
        let is_it = |point: &&Point| point.damper == *damper && point.tuning == Some(Tuning::Nominal);
        retained.kept.iter().find(is_it).filter(|point| point.range.is_some())
    };
    let home = shown.iter().filter_map(nominal).map(|point| point.e1_max).reduce(f64::max)?;
    let widest = |damper: &usize| {
        let as_good = |point: &&Point| point.e1_max <= (1.0 + SAME) * home;
        retained.front(*damper).into_iter().rfind(as_good)
    };
    let mut all: Vec<&Point> = shown.iter().filter_map(widest).collect();
    all.sort_by(|a, b| b.factor().total_cmp(&a.factor()));
    let words: Vec<String> = all.iter().map(|point| keeps(retained, point)).collect();
    let none: Vec<&str> = shown
        .iter()
        .filter(|damper| all.iter().all(|point| point.damper != **damper))
        .map(|damper| retained.name(*damper))
        .collect();
    let none = if none.is_empty() {
        String::new()
    } else {
        format!("; none of the designs that were found as {} does its work at home", none.join(" or "))
    };
    Some(format!(
        "At equal performance at home (at most {} J at the nominal k1, to 1 %) a damper keeps its work while k1 changes by a factor of {}{none}.",
        rounded(home, 3),
        words.join(", ")
    ))
}

/// The range of a design in words.
fn keeps(retained: &Retained, point: &Point) -> String {
    let still = point.still.map_or(String::new(), |range| {
        format!(
            "; {} where the band of frequencies stays as it is at the nominal k1",
            rounded(range.factor(), 3)
        )
    });
    format!(
        "{}: {} ({} J, {}{still})",
        rounded(point.factor(), 3),
        retained.name(point.damper),
        rounded(point.e1_max, 4),
        design_words(&point.at, 4)
    )
}

/// The largest stiffness of a spring that the study of a damper allows, N/m.
fn stiffest(damper: &Tuned) -> Option<f64> {
    damper.study.optimize.as_ref()?.bounds.get(Parameter::K2)?.1
}

/// The k1-robust designs, those under one bound on k2 side by side.
fn robust(retained: &Retained, shown: &[usize]) -> Option<String> {
    let worst = |damper: usize| {
        let (of, name) = (&retained.dampers[damper], Tuning::Robust.name());
        let row = retained.table.rows.iter().find(|row| row.damper == of.name && row.label == name)?;
        Some((stiffest(of), row.e1_max, of.name.as_str()))
    };
    let mut all: Vec<(Option<f64>, f64, &str)> = shown.iter().filter_map(|damper| worst(*damper)).collect();
    let order = |bound: Option<f64>| bound.unwrap_or(f64::INFINITY);
    all.sort_by(|a, b| order(a.0).total_cmp(&order(b.0)).then(a.1.total_cmp(&b.1)));
    let parts = all.chunk_by(|a, b| a.0 == b.0).map(|same| {
        let list: Vec<String> =
            same.iter().map(|(_, worst, name)| format!("{} J ({name})", rounded(*worst, 4))).collect();
        let bound = same[0]
            .0
            .map_or("with k2 free".to_owned(), |most| format!("with k2 at most {} N/m", short(most)));
        format!("{bound} {}", list.join(" against "))
    });
    let parts: Vec<String> = parts.collect();
    let k1 = retained.dampers.first()?.anew.len();
    (!parts.is_empty()).then(|| {
        format!("Tuned for the worst over all {k1} k1 (k1-robust), E1max is at worst: {}.", parts.join("; "))
    })
}

/// What halving the force does to the nominal designs.
fn smaller_force(retained: &Retained, shown: &[usize]) -> Option<String> {
    let name = |of: &Forced| retained.name(of.damper);
    let words = retained.forced.iter().filter(|of| shown.contains(&of.damper)).map(|of| {
        if of.is_constant() {
            return format!("{} {} under any force", name(of), rounded(of.share(0), 3));
        }
        let halves = (0..3).map(|half| {
            let step = half * HALF;
            let force = of.points.get(step).map_or(f64::NAN, |(force, _)| *force);
            format!("{} at {} N", rounded(of.share(step), 3), short(rounded_to(force)))
        });
        let gaps = if of.proportional { " with D and C in proportion to the force" } else { "" };
        format!("{}{gaps} {}", name(of), halves.collect::<Vec<_>>().join(", "))
    });
    let words: Vec<String> = words.collect();
    (!words.is_empty()).then(|| {
        format!(
            "Of E1max without a damper the nominal designs leave at the nominal k1: {}.",
            words.join("; ")
        )
    })
}

/// A force without the rounding of powers of two.
fn rounded_to(force: f64) -> f64 {
    (force * 1e6).round() / 1e6
}

/// A damper along k1.
fn one(retained: &Retained, number: usize) -> String {
    let damper = &retained.dampers[number];
    let nominal = damper.nominal();
    let worst = |tuning: Option<Tuning>| {
        let own = |curve: &&Curve| curve.damper == Some(number) && curve.tuning == tuning && !curve.still;
        retained.curves.iter().find(own).and_then(Curve::worst)
    };
    let mut words = format!("{}: ", damper.name);
    let tuned = format!("tuned for k1 = {} N/m it has", short(nominal));
    for (tuning, begin) in [(Tuning::Nominal, tuned.as_str()), (Tuning::Robust, "; k1-robust it has")] {
        if let (Some((k1, most)), Some(at)) = (worst(Some(tuning)), damper.of(tuning)) {
            words += &format!(
                "{begin} {} J there and at worst {} J, at {} N/m",
                joule(damper.energy(&at, nominal)),
                joule(most),
                rounded(k1, 4)
            );
        }
    }
    if let Some((_, anew)) = worst(None) {
        words += &format!("; re-tuned for each k1 at most {} J", joule(anew));
    }
    words + "."
}

/// An energy in words.
pub(super) fn joule(value: f64) -> String {
    if value.is_finite() { rounded(value, 4) } else { "-".to_owned() }
}
