//! The retention range: the stiffnesses k1 around the nominal one at which a design still achieves half of the reduction that re-tuning
//! would.
//!
//! The reduction of a damper is in decibels, `10 lg(E1max without / E1max with)`, each the worst over the structure's own band. A design is
//! effective at a k1 if its reduction is at least half of that of the best TMD for that k1, with the mass of the study's damper and k2 and
//! c2 free: `E1max <= √(E1max without · E1max of that TMD)`. `docs/decisions.md` gives the reason.

use crate::Error;
use rayon::prelude::*;
use retune_model::{Bare, Damper, Parameter, Positive, Scene, den_hartog};
use retune_optim::{
    Bounds, DesignObjective, Failures, FrequencyBand, Goal, Objective, Options, Response, Scaling, TUNINGS,
    minimize,
};
use retune_solver::{Settings, Window};
use retune_study::{Rule, Setting, Study};
use std::ops::ControlFlow;

/// Ratio of the steps of k1 outwards.
const STEP: f64 = 1.02;
/// Number of steps to either side; a range ends there at the latest, at 0.2 and 5 times the nominal stiffness.
const STEPS: usize = 81;

/// Relative improvement by which the search from a valley must beat the one from Den Hartog's tuning.
const GAIN: f64 = 1e-6;

/// The resolution with which a range is determined.
#[derive(Clone, Copy, Debug)]
pub struct Resolution {
    /// Number of steps of 2 % taken at once.
    pub stride: usize,
    /// Bisections of the step in which a range ends.
    pub bisections: u32,
}

impl Resolution {
    /// For results: ends to within 2e-5.
    pub const RESULT: Self = Self { stride: 1, bisections: 10 };
    /// For searches: ends to within 1e-3.
    pub const SEARCH: Self = Self { stride: 2, bisections: 5 };
}

/// A retention range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// The nominal stiffness, N/m.
    pub nominal: f64,
    /// Its lower end, N/m.
    pub from: f64,
    /// Its upper end, N/m.
    pub to: f64,
    /// Whether each end is only the limit of the search, not of the range.
    pub open: [bool; 2],
}

impl Range {
    /// The factor by which the stiffness may rise and fall, the smaller of both sides: half and double the stiffness detune a damper
    /// equally, and a range that is wide on one side only is useless.
    pub fn factor(&self) -> f64 {
        (self.to / self.nominal).min(self.nominal / self.from)
    }
}

/// The largest E1max at which a damper is effective, along k1.
#[derive(Debug)]
pub struct Threshold {
    nominal: f64,
    /// The logarithms of the largest effective E1max (J) at steps of k1, ascending.
    most: Vec<f64>,
}

impl Threshold {
    /// The threshold for the structure, the damper mass and the band of a study.
    pub fn of(study: &Study) -> Result<Self, Error> {
        let nominal = study.scene.primary.stiffness.get();
        let steps = (-(STEPS as i32)..=STEPS as i32).into_par_iter();
        let at = |step: i32| Ok(largest_effective(study, nominal * STEP.powi(step))?.ln());
        Ok(Self { nominal, most: steps.map(at).collect::<Result<_, Error>>()? })
    }

    /// The largest effective E1max at a stiffness (N/m), J: exact at the steps, interpolated in logarithms between them with a relative
    /// error below 1e-4.
    pub fn at(&self, k1: f64) -> f64 {
        let place = (k1 / self.nominal).ln() / STEP.ln() + STEPS as f64;
        let place = place.clamp(0.0, (self.most.len() - 1) as f64);
        let below = (place.floor() as usize).min(self.most.len() - 2);
        let share = place - below as f64;
        (self.most[below] * (1.0 - share) + self.most[below + 1] * share).exp()
    }

    /// The range of a design: from the nominal stiffness outwards as far as `energy(k1, cutoff)`, E1max in J, is at most the threshold;
    /// above the cutoff it may return any larger number. None if the design is not effective even at the nominal stiffness. Gaps narrower
    /// than a step can be missed.
    pub fn range(&self, resolution: Resolution, energy: impl Fn(f64, f64) -> f64 + Sync) -> Option<Range> {
        let is_effective = |k1: f64| {
            let most = self.at(k1);
            energy(k1, most) <= most
        };
        if !is_effective(self.nominal) {
            return None;
        }
        let end = |ratio: f64| {
            let mut good = self.nominal;
            for step in (1..=STEPS).step_by(resolution.stride) {
                let step = (step + resolution.stride - 1).min(STEPS) as i32;
                let next = self.nominal * ratio.powi(step);
                if !is_effective(next) {
                    let mut bad = next;
                    for _ in 0..resolution.bisections {
                        let middle = (good * bad).sqrt();
                        if is_effective(middle) { good = middle } else { bad = middle }
                    }
                    return (good, false);
                }
                good = next;
            }
            (good, true)
        };
        let ((from, low), (to, high)) = rayon::join(|| end(1.0 / STEP), || end(STEP));
        Some(Range { nominal: self.nominal, from, to, open: [low, high] })
    }
}

/// The largest effective E1max at a stiffness, J.
fn largest_effective(study: &Study, k1: f64) -> Result<f64, Error> {
    let scene = study.scene_with(&[Setting::new(Parameter::K1, k1)])?;
    let no_damper = || Error::Rule { name: study.name().to_owned(), rule: Rule::NoDamper };
    let damper = scene.damper.ok_or_else(no_damper)?;
    let omega = scene.forcing.frequency.get();
    let band = study.objective().omega.map(|band| band.of(&scene.primary));
    let band = band.map_or([omega; 2], |band| [band.from, band.to]);
    let none = Bare::new(&scene.primary, &scene.forcing).steady_e1_max(band).value;
    Ok((none * best_tmd(&scene, damper, band)?.1).sqrt())
}

/// The TMD with the mass of `damper` whose k2 and c2 minimise the steady E1max over a band (rad/s), and this E1max, J. One search starts at
/// Den Hartog's tuning, one in the deepest [valley](DesignObjective::valleys) of a grid, since off resonance the best TMD is tuned to the
/// forcing.
pub fn best_tmd(scene: &Scene, damper: Damper, band: [f64; 2]) -> Result<(Damper, f64), Error> {
    let [from, to] = band.map(Positive::new);
    let omega = Some(FrequencyBand { from: from?, to: to?, samples: 2, relative: false });
    let objective = Objective { omega, response: Response::Steady, ..Objective::default() };
    // A steady motion has no window.
    let goal = Goal { objective, ..Window { from: 0.0, to: 1.0 }.into() };
    let variables = vec![Parameter::K2, Parameter::C2];
    let tmd = Damper { contact: None, ..damper };
    let objective = DesignObjective::new(*scene, tmd, variables, goal, Settings::default());
    let bounds = [Bounds { lower: Some(0.0), upper: None }; 2];
    let options = Options {
        tol_x: 1e-9,
        tol_fun: 1e-9,
        bounds: bounds.to_vec(),
        scaling: Scaling::Start,
        ..Options::default()
    };
    let value = |x: &[f64], cutoff: f64| objective.value(x, cutoff);
    let from = |start: &[f64]| minimize(value, start, options.clone(), |_| ControlFlow::Continue(()));
    let refuse = |source| Error::Search { source, failures: Failures::default() };
    let found = from(&den_hartog(&scene.primary, damper.mass.get())).map_err(refuse)?;
    let valley = objective.valleys(TUNINGS, &bounds).into_iter().next();
    let other = valley.and_then(|(_, x)| from(&x).ok());
    let found = other.filter(|other| other.value < (1.0 - GAIN) * found.value).unwrap_or(found);
    let tuned = objective.damper(&found.x).map(|tmd| Damper { contact: damper.contact, ..tmd });
    Ok((tuned.unwrap_or(damper), found.value))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn threshold(level: f64) -> Threshold {
        Threshold { nominal: 4e4, most: vec![f64::ln(level); 2 * STEPS + 1] }
    }

    /// Half of the decibels between no damper and the free TMD of `results/tmd-free`, 1568.3 and 160.6 J. A best TMD that could not be
    /// found once left every range empty.
    #[test]
    fn regress_the_threshold_of_the_study_is_half_of_the_best_tmd() {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/retune-tmd.json");
        let threshold = Threshold::of(&retune_study::read(&path).expect("a study")).expect("a threshold");
        assert!((threshold.at(39_500.0) - (1568.3_f64 * 160.6).sqrt()).abs() < 0.5, "{threshold:?}");
    }

    #[test]
    fn contract_a_study_without_a_damper_has_no_threshold() {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/retune-tmd.json");
        let mut study = retune_study::read(&path).expect("a study");
        study.scene.damper = None;
        assert!(matches!(Threshold::of(&study), Err(Error::Rule { rule: Rule::NoDamper, .. })));
    }

    /// E1max grows as the square of the detuning: 100 J (1 + 25 (k1/4e4 - 1)²) is at most 200 J from 0.8 to 1.2 times 4e4 N/m.
    #[test]
    fn exact_the_range_of_a_parabola() {
        let energy = |k1: f64, _cutoff: f64| 100.0 * (1.0 + 25.0 * (k1 / 4e4 - 1.0).powi(2));
        let range = threshold(200.0).range(Resolution::RESULT, energy).expect("a range");
        let near = |a: f64, b: f64| (a / b - 1.0).abs() < 3e-5;
        assert!(near(range.from, 3.2e4) && near(range.to, 4.8e4) && range.open == [false; 2], "{range:?}");
        assert!(near(range.factor(), 1.2), "{range:?}");
        assert_eq!(
            threshold(99.0).range(Resolution::RESULT, energy),
            None,
            "it does not work at the nominal stiffness"
        );
        let all = threshold(1e9).range(Resolution::RESULT, energy).expect("a range");
        assert!(all.open == [true; 2] && all.to > 4.9 * 4e4, "{all:?}");
    }

    #[test]
    fn exact_the_threshold_is_interpolated_in_logarithms() {
        let most = (0..=2 * STEPS).map(|i| i as f64).collect();
        let threshold = Threshold { nominal: 4e4, most };
        let at = |k1: f64| threshold.at(k1).ln();
        assert!((at(4e4) - STEPS as f64).abs() < 1e-9);
        assert!((at(4e4 * STEP.powf(2.25)) - STEPS as f64 - 2.25).abs() < 1e-9);
    }
}
