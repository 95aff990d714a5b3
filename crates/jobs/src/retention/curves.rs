//! E1max along k1, with its cliffs: intervals where neighbouring values differ much are bisected until the jump is narrow.

use super::tuned::{BANDS, OWN, Tuned, Tuning, bare, energy};
use crate::columns;
use rayon::prelude::*;
use retune_report::cells;
use retune_report::table::{Cell, Table};

/// Number of equidistant stiffnesses evaluated first, besides those tuned for.
const ALONG: usize = 61;
/// Relative difference of neighbouring values above which the interval between them is refined.
const JUMP: f64 = 0.1;
/// Relative width below which an interval with a jump is a cliff and not refined further.
const NARROW: f64 = 5e-4;
/// Most stiffnesses added by refinement. Where motions are irregular, E1max jumps everywhere, and no number is enough.
const MORE: usize = 240;

/// E1max of a design along k1.
#[derive(Debug)]
pub struct Curve {
    /// The index of its damper; none without a damper.
    pub damper: Option<usize>,
    /// How the damper was tuned.
    pub tuning: Tuning,
    /// The index of its band.
    pub band: usize,
    /// Stiffness, N/m, and E1max, J; NaN where it cannot be run.
    pub points: Vec<(f64, f64)>,
}

impl Curve {
    /// The largest value and its stiffness.
    pub fn worst(&self) -> Option<(f64, f64)> {
        self.points.iter().filter(|(_, value)| value.is_finite()).copied().max_by(|a, b| a.1.total_cmp(&b.1))
    }
}

/// The cliffs of a curve: pairs of neighbouring points within about [`NARROW`] between which E1max more than doubles or halves.
pub fn cliffs(points: &[(f64, f64)]) -> impl Iterator<Item = [(f64, f64); 2]> {
    let doubles = |[(from, one), (to, other)]: &[(f64, f64); 2]| {
        to - from <= 2.0 * NARROW * to && (*one > 2.0 * other || *other > 2.0 * one)
    };
    points.windows(2).map(|pair| [pair[0], pair[1]]).filter(doubles)
}

/// All curves: without a damper, by the study of the first damper; then for each damper those of the kept designs and of the re-tuned ones;
/// last those without a damper and of the kept designs with a fixed band.
pub fn curves(dampers: &[Tuned]) -> Vec<Curve> {
    let stops: Vec<f64> = dampers.iter().flat_map(|damper| damper.anew.iter().map(|(k1, _)| *k1)).collect();
    let mut all = Vec::new();
    for band in 0..BANDS.len() {
        if let Some(study) = dampers.first().and_then(|first| first.studies.get(band)) {
            let points = along(&stops, |k1| bare(study, k1).unwrap_or(f64::NAN));
            all.push(Curve { damper: None, tuning: Tuning::None, band, points });
        }
        for (number, damper) in dampers.iter().enumerate() {
            let Some(study) = damper.studies.get(band) else { continue };
            all.extend(damper.kept.iter().map(|(tuning, at)| {
                let value = |k1| energy(study, damper.samples, at, k1).unwrap_or(f64::NAN);
                Curve { damper: Some(number), tuning: *tuning, band, points: along(&stops, value) }
            }));
            if band == OWN {
                let points = damper.anew.par_iter().map(|(k1, at)| (*k1, damper.energy(at, *k1))).collect();
                all.push(Curve { damper: Some(number), tuning: Tuning::Anew, band, points });
            }
        }
    }
    all
}

/// Values along k1: at `stops`, at evenly spaced stiffnesses over their range, and at more where they jump.
fn along(stops: &[f64], value: impl Fn(f64) -> f64 + Sync) -> Vec<(f64, f64)> {
    let [low, high] = [f64::min, f64::max].map(|pick| stops.iter().copied().reduce(pick).unwrap_or_default());
    let even = (0..ALONG).map(|i| low + (high - low) * (i as f64 / (ALONG - 1) as f64));
    let mut k1: Vec<f64> = stops.iter().copied().chain(even).collect();
    k1.sort_by(f64::total_cmp);
    k1.dedup();
    let at = |k1: &f64| (*k1, value(*k1));
    let mut points: Vec<(f64, f64)> = k1.par_iter().map(at).collect();
    let mut remaining = MORE;
    while remaining > 0 {
        let mut jumps: Vec<(f64, f64)> = points.windows(2).filter_map(jump).collect();
        jumps.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.total_cmp(&b.1)));
        jumps.truncate(remaining);
        if jumps.is_empty() {
            break;
        }
        remaining -= jumps.len();
        let between: Vec<f64> = jumps.into_iter().map(|(_, middle)| middle).collect();
        points.extend(between.par_iter().map(at).collect::<Vec<_>>());
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
    }
    points
}

/// The relative size of a jump between neighbours, and the middle of the interval; none where they are close in value or in k1.
fn jump(pair: &[(f64, f64)]) -> Option<(f64, f64)> {
    let [(from, one), (to, other)] = [pair[0], pair[1]];
    let share = one.max(other) / one.min(other) - 1.0;
    (share > JUMP && to - from > NARROW * to).then_some((share, 0.5 * (from + to)))
}

/// A row for each point of each curve; missing values are empty fields.
pub fn table(dampers: &[Tuned], curves: &[Curve]) -> Table {
    let mut table = columns::table(&["damper", "tuning", "band", "k1", "E1max"]);
    for Curve { damper, tuning, band, points } in curves {
        let name = damper.map_or(Tuning::None.name(), |number| &dampers[number].name);
        let row =
            |&(k1, value): &(f64, f64)| cells![name, tuning.name(), BANDS[*band], k1, Cell::finite(value)];
        table = table.with(points.iter().map(row));
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
        let cliffs: Vec<_> = cliffs(&points).collect();
        assert_eq!(cliffs.len(), 1);
        let [(from, low), (to, high)] = cliffs[0];
        assert!(from < cliff && cliff <= to && to - from <= NARROW * to && low == 1.0 && high > 3.0);
        assert!(points.len() < ALONG + 8, "{}", points.len());
        assert!(points.windows(2).all(|pair| pair[0].0 < pair[1].0));
    }

    #[test]
    fn invariant_the_number_of_points_is_bounded() {
        let noise = |k1: f64| if (k1 * 1e3).sin() > 0.0 { 1.0 } else { 2.0 };
        assert!(along(&[1e4, 2e4], noise).len() <= ALONG + 2 + MORE);
    }
}
