//! The requirements of a damper: the largest value of every measure over all that a goal covers, and where; and the best linear damper.

use super::band::Band;
use super::design_objective::DesignObjective;
use super::evaluation::Run;
use super::limits::Limits;
use super::runs::{Hooks, NO_HOOKS, Observed, Proceed, Runs};
use super::spec::{Goal, Objective, Response};
use super::tmd::TUNINGS;
use super::unusable::Unusable;
use crate::search::fminsearch::{Bounds, Options, Scaling, minimize};
use retune_model::{Damper, NonNegative, Parameter, PerMeasure, Scene, den_hartog};
use retune_solver::{Also, Settings};
use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::sync::{Mutex, PoisonError};

/// A largest value, and where it is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Need {
    /// The value, in the unit of its measure.
    pub value: f64,
    /// The angular frequency of the force there, rad/s.
    pub omega: f64,
    /// The stiffness of the structure there, N/m.
    pub k1: f64,
    /// Restitution of its contacts; 1 where that is not the same at every speed.
    pub restitution: f64,
}

/// The largest value of each measure, each at its own place: over the band, the stiffnesses, the members and the terms of a goal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Needs {
    /// Over runs from rest, from t = 0 to the end of the window, and over all that the objective looks at.
    pub whole: PerMeasure<Need>,
    /// Over the objective's part of the response alone: its window, settled or steady motions, or all motions found.
    pub own: PerMeasure<Need>,
}

/// Samples of runs from rest per width 2π/T, the resolution in frequency of a run of length T, and the most of a band. An objective with an
/// ensemble, several stiffnesses or restitutions, whose runs are many, keeps its own samples.
const PER_WIDTH: f64 = 8.0;
const MOST: f64 = 1601.0;

/// Most restarts of the search for the best linear damper, as long as each gains this share.
const RESTARTS: u32 = 4;
const GAIN: f64 = 1e-4;
/// The share of its critical damping below which a damper's damping is set to zero.
const UNDAMPED: f64 = 1e-9;

impl Goal {
    /// The requirements of a scene by this goal, regardless of its limits, as long as `proceed` is true. Peaks between samples are searched
    /// for every measure.
    ///
    /// # Errors
    /// As [`Goal::evaluate_while`].
    pub fn needs(&self, scene: &Scene, settings: &Settings, proceed: Proceed<'_>) -> Result<Needs, Unusable> {
        let own = self.own_needs(scene, settings, proceed)?;
        let matters = PerMeasure::all(f64::NEG_INFINITY);
        let whole = self.needs_from_rest(scene, settings, (&own, matters), proceed)?;
        Ok(Needs { whole, own })
    }

    /// [`Needs::whole`] of a scene, given its [`Needs::own`]. Peaks between samples are searched only where they may exceed `matters` for
    /// their measure: irregular motions have a peak at every other sample, and searching them is most of the work.
    ///
    /// # Errors
    /// As [`Goal::evaluate_while`].
    pub fn needs_from_rest(
        &self,
        scene: &Scene,
        settings: &Settings,
        (own, matters): (&PerMeasure<Need>, PerMeasure<f64>),
        proceed: Proceed<'_>,
    ) -> Result<PerMeasure<Need>, Unusable> {
        let mut whole = self.of_every_measure();
        whole.window.from = 0.0;
        whole.objective.for_each_term(&mut |term| {
            term.response = Response::Window;
            let single = term.ensemble.is_none() && term.k1.is_none() && term.restitution.is_none();
            if let Some(band) = term.omega.as_mut().filter(|_| single) {
                let Band { from, to, samples } = band.of(&scene.primary);
                let wanted = ((to - from) * self.window.to * PER_WIDTH / TAU).ceil().min(MOST);
                band.samples = samples.max(wanted as usize);
            }
        });
        let mut all = whole.largest(scene, settings, (Some(0.0), matters), proceed)?;
        all.0.iter_mut().zip(own.0).for_each(|(all, own)| {
            if own.value > all.value {
                *all = own;
            }
        });
        Ok(all)
    }

    /// [`Needs::own`] of a scene alone, with bitwise equal results.
    ///
    /// # Errors
    /// As [`Goal::evaluate_while`].
    pub fn own_needs(
        &self,
        scene: &Scene,
        settings: &Settings,
        proceed: Proceed<'_>,
    ) -> Result<PerMeasure<Need>, Unusable> {
        let matters = PerMeasure::all(f64::NEG_INFINITY);
        self.of_every_measure().largest(scene, settings, (None, matters), proceed)
    }

    /// The goal without limits, so that none ends an evaluation, and for largest values only. A stationary random motion has none: it is
    /// replaced by the draw in the window.
    fn of_every_measure(&self) -> Self {
        let mut goal = Self { limits: Limits::default(), peaks: true, ..self.clone() };
        goal.objective.for_each_term(&mut |term| {
            if term.is_stationary() {
                term.response = Response::Window;
            }
            term.quantity = term.quantity.of_run();
        });
        goal
    }

    /// The largest value of each measure from a time on, s; without one, over the objective's part of the response. Peaks are searched
    /// where they may exceed `matters`.
    fn largest(
        &self,
        scene: &Scene,
        settings: &Settings,
        (from, matters): (Option<f64>, PerMeasure<f64>),
        proceed: Proceed<'_>,
    ) -> Result<PerMeasure<Need>, Unusable> {
        let largest = Mutex::new(PerMeasure::all(Need { value: f64::NEG_INFINITY, ..Need::default() }));
        let keep = |run: Run| {
            let Scene { primary, forcing, .. } = run.place.scene;
            let (omega, k1) = (forcing.frequency.get(), primary.stiffness.get());
            let restitution = Parameter::Restitution.of(&run.place.scene).unwrap_or(1.0);
            let mut largest = largest.lock().unwrap_or_else(PoisonError::into_inner);
            for (known, value) in largest.0.iter_mut().zip(run.reached.0) {
                let found = Need { value, omega, k1, restitution };
                // On a tie the first by ω, k1 and restitution, independent of the order of the threads.
                let key = |need: &Need| [-need.value, need.omega, need.k1, need.restitution];
                if key(&found).partial_cmp(&key(known)).is_some_and(std::cmp::Ordering::is_lt) {
                    *known = found;
                }
            }
        };
        let also = Some(Also { measures: PerMeasure::EVERY, from: from.unwrap_or(self.window.from) });
        let observed = Observed { also, response_only: from.is_none(), matters };
        let runs = Runs::new(self, scene, settings, observed, Hooks { keep: &keep, proceed, ..NO_HOOKS });
        self.sum(scene, f64::INFINITY, &runs)?;
        Ok(largest.into_inner().unwrap_or_else(PoisonError::into_inner))
    }

    /// The damper without walls, of the same mass, that minimises this goal, regardless of limits and bounds; none if the goal does not
    /// measure the structure, or if there is no such damper to start from.
    ///
    /// A search by the closed form of the steady motion, over the band if there is one, starts at Den Hartog's tuning and in the deepest
    /// [valley](DesignObjective::valleys) of a grid; a search by the goal itself follows, unless it has an ensemble. A search that has
    /// stopped in a kink is restarted there.
    pub fn best_linear(&self, scene: &Scene, settings: &Settings) -> Option<Scene> {
        let damper = scene.damper?;
        let quantity = self.objective.quantity();
        let of_the_structure = !quantity.is_of_damper();
        if !scene.forcing.source.is_harmonic() || !of_the_structure || scene.primary.stiffness.get() == 0.0 {
            return None;
        }
        let plain = Damper {
            contact: None,
            rest_distance: NonNegative::default(),
            clearance: NonNegative::default(),
            ..damper
        };
        let not_negative = [Bounds { lower: Some(0.0), upper: None }; 2];
        let objective = |change: &dyn Fn(&mut Objective)| {
            let mut goal = Self { limits: Limits::default(), ..self.clone() };
            goal.objective.for_each_term(&mut |term| change(term));
            let variables = vec![Parameter::K2, Parameter::C2];
            DesignObjective::new(*scene, plain, variables, goal, *settings)
        };
        let search = |start: [f64; 2], objective: &DesignObjective| {
            let options = Options {
                scaling: Scaling::Start,
                tol_x: 1e-6,
                tol_fun: 1e-9 * objective.value(&start, f64::INFINITY),
                max_iter: Some(400),
                max_fun_evals: Some(400),
                bounds: not_negative.to_vec(),
            };
            let value = |x: &[f64], cutoff: f64| objective.value(x, cutoff);
            let from =
                |start: &[f64]| minimize(value, start, options.clone(), |_| ControlFlow::Continue(())).ok();
            let mut found = from(&start)?;
            // A simplex may stop in a kink. In closed form a restart costs little.
            let restarts = if objective.goal().objective.is_steady() { RESTARTS } else { 0 };
            for _ in 0..restarts {
                let restarted = from(&found.x)?;
                if restarted.value >= (1.0 - GAIN) * found.value {
                    break;
                }
                found = restarted;
            }
            Some((<[f64; 2]>::try_from(found.x).ok()?, found.value))
        };
        let banded = self.objective.terms().iter().all(|(_, term)| term.omega.is_some());
        let mut best = den_hartog(&scene.primary, damper.mass.get());
        if banded || self.objective.is_steady() {
            let steady = objective(&|term| (term.response, term.ensemble) = (Response::Steady, None));
            let (found, value) = search(best, &steady)?;
            let valley = steady.valleys(TUNINGS, &not_negative).into_iter().next();
            let other = valley.and_then(|(_, x)| search(<[f64; 2]>::try_from(x).ok()?, &steady));
            best = other.filter(|other| other.1 < (1.0 - GAIN) * value).map_or(found, |(other, _)| other);
        }
        if !self.objective.is_steady()
            && self.objective.terms().iter().all(|(_, term)| term.ensemble.is_none())
        {
            // A linear damper has one motion.
            let own = objective(&|term| {
                if term.response == Response::Motions {
                    term.response = Response::Settled;
                }
            });
            best = search(best, &own)?.0;
        }
        let critical = 2.0 * (best[0] * damper.mass.get()).sqrt();
        if best[1] < UNDAMPED * critical {
            best[1] = 0.0;
        }
        let [stiffness, damping] = best.map(NonNegative::new);
        let damper = Damper { stiffness: stiffness.ok()?, damping: damping.ok()?, ..plain };
        Some(Scene { damper: Some(damper), ..*scene })
    }
}
