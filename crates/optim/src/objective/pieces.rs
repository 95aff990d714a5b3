//! The smooth functions whose largest is the value of a design: the peaks over the frequencies of the quantity and of the limited measures,
//! with their derivatives.
//!
//! At a peak the derivative by the frequency is zero, and at an end of the band the frequency is fixed, so the derivatives of a peak are
//! those of the run at its frequency (the envelope theorem). For a steady response they are in closed form, under a pulse or a record by
//! differences.

use super::band::Band;
use super::evaluation::{Place, Run};
use super::limits::{Limit, widens};
use super::spec::{Goal, Objective, Response};
use crate::search::minimax::Piece;
use rayon::prelude::*;
use retune_model::{Coupled, Measure, Parameter, Scene, Worst};
use retune_solver::{Also, Ask, Settings, Window, extremes, extremes_by};

/// Peaks below this share of the largest of their kind are ignored.
const HIGH: f64 = 0.7;
/// Most peaks of a kind: an irregular motion has one at every other sample.
const MOST: usize = 12;
/// Peaks nearer than this, as a share of the frequency, are one that was found twice.
const APART: f64 = 1e-5;

/// The step of a difference, as a share of the parameter; of a gap as a share of both gaps, since one may be zero. Runs are exact to about 1e-10.
const STEP: f64 = 1e-6;

/// The kind of a piece: a measure in a window, and its limit, if any.
type Kind = (Measure, Window, Option<f64>);

impl Goal {
    /// Whether its value is the largest of peaks, each with derivatives by [`Self::pieces`]. Sums, ensembles, random motions, decay times,
    /// lists of records and responses other than those from rest and the steady one have none.
    pub fn has_pieces(&self) -> bool {
        let Objective { sum, ensemble, response, records, .. } = &self.objective;
        sum.is_empty()
            && self.objective.has_derivatives()
            && records.is_empty()
            && ensemble.is_none()
            && matches!(response, Response::Window | Response::Steady)
    }

    /// The highest peaks of `runs`, made to evaluate `scene`, with their derivatives by `variables`. Peaks whose derivatives cannot be
    /// computed are left out. Limits are given as relative excess, 0 where they are just kept.
    pub fn pieces(
        &self,
        scene: &Scene,
        settings: &Settings,
        runs: &[Run],
        variables: &[Parameter],
    ) -> Vec<Piece> {
        let also = self.limits.also();
        let whole = Window { from: also.map_or(0.0, |also| also.from), to: self.window.to };
        let limited = also.into_iter().flat_map(|also| also.measures.chosen());
        let limited = limited.map(|measure| (measure, whole, self.limits.get(Limit::Of(measure))));
        let kinds = [(self.objective.quantity(), self.window, None)].into_iter().chain(limited);
        let peaks: Vec<_> = kinds
            .flat_map(|kind| peaks(runs, |run| value(run, kind)).into_iter().map(move |run| (kind, run)))
            .collect();
        let piece = |&(kind @ (measure, window, limit), run): &(Kind, &Run)| {
            let Place { scene, phase, .. } = &run.place;
            let Scene { primary, forcing, damper: Some(damper) } = scene else { return Vec::new() };
            let found: Vec<(f64, Vec<f64>)> = if self.objective.response == Response::Steady {
                let system = Coupled::new(primary, forcing, damper);
                let omega = forcing.frequency.get();
                let band = self.objective.omega.map_or([omega; 2], |band| {
                    let Band { from, to, .. } = band.of(primary);
                    [from, to]
                });
                let peaks = system.steady_peaks(measure, band, HIGH).into_iter();
                let by = |at| variables.iter().map(|&by| system.steady_by(measure, by, at)).collect();
                peaks.map(|Worst { value, frequency }| (value, by(frequency))).collect()
            } else {
                let ask = Ask { measure, phase: *phase, ..Ask::default() };
                let by = match forcing.history() {
                    None => extremes_by(scene, window, settings, ask, variables).ok(),
                    Some(_) => differences(run, kind, settings, variables),
                };
                by.map(|by| (value(run, kind), by)).into_iter().collect()
            };
            let piece = |value: f64, by: Vec<f64>| match limit {
                None => Piece { is_limit: false, value, slope: by },
                Some(limit) => Piece {
                    is_limit: true,
                    value: value / limit - 1.0,
                    slope: by.into_iter().map(|by| by / limit).collect(),
                },
            };
            found.into_iter().map(|(value, by)| piece(value, by)).collect::<Vec<_>>()
        };
        let mut pieces: Vec<Piece> = peaks.par_iter().flat_map_iter(piece).collect();
        if let (Some(most), Some(damper)) = (self.limits.get(Limit::Cavity), &scene.damper) {
            let value = (damper.rest_distance.get() + damper.clearance.get()) / most - 1.0;
            pieces.push(Piece {
                is_limit: true,
                value,
                slope: variables.iter().map(|&by| widens(by) / most).collect(),
            });
        }
        pieces
    }
}

/// The value of a run for a kind of piece.
fn value(run: &Run, (measure, _, limit): Kind) -> f64 {
    if limit.is_some() { run.reached.get(measure) } else { run.place.largest }
}

/// The derivatives of the value of a run by one-sided differences; none if a perturbed scene cannot be run.
fn differences(
    run: &Run,
    kind @ (measure, window, limit): Kind,
    settings: &Settings,
    variables: &[Parameter],
) -> Option<Vec<f64>> {
    let Place { scene, phase, .. } = run.place;
    let damper = scene.damper?;
    let gaps = damper.rest_distance.get() + damper.clearance.get();
    let also = limit.map(|_| Also { measures: [measure].into_iter().collect(), from: window.from });
    let at = |scene: &Scene| {
        let found = extremes(scene, window, settings, Ask { measure, phase, also, ..Ask::default() }).ok()?;
        Some(if limit.is_some() { found.reached.get(measure) } else { found.largest.value })
    };
    let own = value(run, kind);
    let by = |&by: &Parameter| {
        let here = by.get(&damper);
        let there = here + STEP * if by.is_gap() { gaps } else { here };
        let mut moved = damper;
        by.set_damper(&mut moved, there).ok()?;
        Some((at(&Scene { damper: Some(moved), ..scene })? - own) / (there - here))
    };
    variables.iter().map(by).collect()
}

/// The highest peaks of a quantity over the frequencies at each stiffness and restitution, highest first.
fn peaks(runs: &[Run], value: impl Fn(&Run) -> f64) -> Vec<&Run> {
    let key = |run: &Run| {
        let Scene { primary, forcing, .. } = run.place.scene;
        let e = Parameter::Restitution.of(&run.place.scene).unwrap_or(1.0);
        ([primary.stiffness.get(), e], forcing.frequency.get())
    };
    let mut order: Vec<&Run> = runs.iter().collect();
    order.sort_by(|a, b| key(a).partial_cmp(&key(b)).unwrap_or(std::cmp::Ordering::Equal));
    let beside = |i: Option<usize>, run: &Run| {
        let other = i.and_then(|i| order.get(i)).filter(|other| key(other).0 == key(run).0);
        other.map_or(f64::NEG_INFINITY, |other| value(other))
    };
    let is_peak = |&(i, run): &(usize, &&Run)| {
        let own = value(run);
        own > beside(i.checked_sub(1), run) && own >= beside(Some(i + 1), run)
    };
    let mut peaks: Vec<&Run> = order.iter().enumerate().filter(is_peak).map(|(_, run)| *run).collect();
    peaks.sort_by(|a, b| value(b).total_cmp(&value(a)));
    let least = peaks.first().map_or(0.0, |run| HIGH * value(run));
    let mut high: Vec<&Run> = Vec::new();
    for run in peaks.into_iter().take_while(|run| value(run) >= least) {
        let (case, omega) = key(run);
        let is_known = |other: &&Run| key(other).0 == case && (key(other).1 / omega - 1.0).abs() < APART;
        if high.len() < MOST && !high.iter().any(is_known) {
            high.push(run);
        }
    }
    high
}
