//! E1max along k1, with its cliffs: where neighbouring values differ, more stiffnesses are looked at between them, until a jump is narrow.

use super::range::Criterion;
use super::tuned::{Kept, Tuned, Tuning, bare, energy};
use crate::columns;
use rayon::prelude::*;
use retune_report::cells;
use retune_report::table::{Cell, Table};
use retune_study::Study;

/// Number of equidistant stiffnesses that are looked at first, besides those that were tuned for.
const ALONG: usize = 61;
/// Neighbouring values that differ by less, as a share of the smaller, are joined by a line.
const JUMP: f64 = 0.1;
/// A jump between stiffnesses that are nearer than this share is a cliff, and drawn as a step.
const NARROW: f64 = 5e-4;
/// Most stiffnesses between the first ones. Where motions are irregular, E1max jumps everywhere, and no number is enough.
const MORE: usize = 240;

/// E1max of a design along k1.
#[derive(Debug)]
pub struct Curve {
    /// The number of its damper; none without a damper.
    pub damper: Option<usize>,
    /// How the damper was tuned; none for one that is tuned anew at each stiffness, or where there is no damper.
    pub tuning: Option<Tuning>,
    /// Whether its band stays where it is at the nominal stiffness, whatever k1 becomes.
    pub still: bool,
    /// Stiffness, N/m, and E1max, J; NaN where it cannot be run.
    pub points: Vec<(f64, f64)>,
}

/// The name of the tuning of a curve in the table.
pub const ANEW: &str = "re-tuned";
/// The names of a band in the table: that of the study, and one that stays at the nominal k1.
pub const BANDS: [&str; 2] = ["own", "still"];

impl Curve {
    /// The name of its tuning.
    pub fn tuning_name(&self) -> &'static str {
        match (self.damper, self.tuning) {
            (_, Some(tuning)) => tuning.name(),
            (Some(_), None) => ANEW,
            (None, None) => "none",
        }
    }

    /// The largest value and its stiffness.
    pub fn worst(&self) -> Option<(f64, f64)> {
        self.points.iter().filter(|(_, value)| value.is_finite()).copied().max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// The cliffs: stiffnesses between which E1max more than doubles or halves within [`NARROW`], and the values on both sides.
    pub fn cliffs(&self) -> impl Iterator<Item = [(f64, f64); 2]> {
        let doubles = |pair: &&[(f64, f64)]| {
            let [(from, one), (to, other)] = [pair[0], pair[1]];
            to - from <= 2.0 * NARROW * to && (one > 2.0 * other || other > 2.0 * one)
        };
        self.points.windows(2).filter(doubles).map(|pair| [pair[0], pair[1]])
    }
}

/// All curves: without a damper, by the study of the first; then of each damper those that are kept and that which is tuned anew; last those
/// of the designs that are kept with bands that stay where they are.
pub fn curves(dampers: &[Tuned], criteria: &[Criterion]) -> Vec<Curve> {
    let stops: Vec<f64> = dampers.iter().flat_map(|damper| damper.anew.iter().map(|(k1, _)| *k1)).collect();
    let mut all = Vec::new();
    let stops = &stops;
    let none = |study: &Study, still| {
        let points = along(stops, |k1| bare(study, k1).unwrap_or(f64::NAN));
        Curve { damper: None, tuning: None, still, points }
    };
    let kept = |number: usize, study: &Study, still| {
        let damper = &dampers[number];
        let curve = move |kept: &Kept| {
            let value = |k1| energy(study, damper.samples, &kept.at, k1).unwrap_or(f64::NAN);
            Curve { damper: Some(number), tuning: Some(kept.tuning), still, points: along(stops, value) }
        };
        damper.kept.iter().map(curve).collect::<Vec<_>>()
    };
    all.extend(dampers.first().map(|first| none(&first.study, false)));
    for (number, damper) in dampers.iter().enumerate() {
        all.extend(kept(number, &damper.study, false));
        let points = damper.anew.par_iter().map(|(k1, at)| (*k1, damper.energy(at, *k1))).collect();
        all.push(Curve { damper: Some(number), tuning: None, still: false, points });
    }
    let stills = || criteria.iter().map(|criterion| criterion.still.as_ref());
    all.extend(stills().next().flatten().map(|first| none(&first.study, true)));
    for (number, still) in stills().enumerate() {
        all.extend(still.into_iter().flat_map(|still| kept(number, &still.study, true)));
    }
    all
}

/// Values between the least and the largest of some stiffnesses, at these, evenly spaced, and more where they jump.
fn along(stops: &[f64], value: impl Fn(f64) -> f64 + Sync) -> Vec<(f64, f64)> {
    let [low, high] = [f64::min, f64::max].map(|pick| stops.iter().copied().reduce(pick).unwrap_or_default());
    let even = (0..ALONG).map(|i| low + (high - low) * (i as f64 / (ALONG - 1) as f64));
    let mut k1: Vec<f64> = stops.iter().copied().chain(even).collect();
    k1.sort_by(f64::total_cmp);
    k1.dedup();
    let at = |k1: &f64| (*k1, value(*k1));
    let mut points: Vec<(f64, f64)> = k1.par_iter().map(at).collect();
    let mut left = MORE;
    while left > 0 {
        let mut jumps: Vec<(f64, f64)> = points.windows(2).filter_map(jump).collect();
        jumps.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.total_cmp(&b.1)));
        jumps.truncate(left);
        if jumps.is_empty() {
            break;
        }
        left -= jumps.len();
        let between: Vec<f64> = jumps.into_iter().map(|(_, middle)| middle).collect();
        points.extend(between.par_iter().map(at).collect::<Vec<_>>());
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
    }
    points
}

/// How large a jump between neighbours is, as a share, and its middle; none where they are near in value or in k1.
fn jump(pair: &[(f64, f64)]) -> Option<(f64, f64)> {
    let [(from, one), (to, other)] = [pair[0], pair[1]];
    let share = one.max(other) / one.min(other) - 1.0;
    (share > JUMP && to - from > NARROW * to).then_some((share, 0.5 * (from + to)))
}

/// A row for each point of each curve; what has no value is an empty field.
pub fn table(dampers: &[Tuned], curves: &[Curve]) -> Table {
    let mut table = columns::table(&["damper", "tuning", "band", "k1", "E1max"]);
    for curve in curves {
        let name = curve.damper.and_then(|number| dampers.get(number)).map_or("none", |damper| &damper.name);
        for &(k1, value) in &curve.points {
            let band = BANDS[usize::from(curve.still)];
            table.push(cells![name, curve.tuning_name(), band, k1, Cell::finite(value)]);
        }
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A step from 1 to 3 at k1 = 12,345.678 on a level line, and a gentle slope: the step is enclosed, the slope left as it is.
    #[test]
    fn exact_a_cliff_is_enclosed_and_a_slope_is_not() {
        let cliff = 12_345.678;
        let points = along(&[1e4, 2e4], |k1| if k1 < cliff { 1.0 } else { 3.0 + 1e-5 * k1 });
        let curve = Curve { damper: Some(0), tuning: None, still: false, points };
        let cliffs: Vec<_> = curve.cliffs().collect();
        assert_eq!(cliffs.len(), 1);
        let [(from, low), (to, high)] = cliffs[0];
        assert!(from < cliff && cliff <= to && to - from <= NARROW * to && low == 1.0 && high > 3.0);
        assert!(curve.points.len() < ALONG + 8, "{}", curve.points.len());
        assert!(curve.points.windows(2).all(|pair| pair[0].0 < pair[1].0));
    }

    #[test]
    fn invariant_the_number_of_points_is_bounded() {
        let noise = |k1: f64| if (k1 * 1e3).sin() > 0.0 { 1.0 } else { 2.0 };
        assert!(along(&[1e4, 2e4], noise).len() <= ALONG + 2 + MORE);
    }
}
