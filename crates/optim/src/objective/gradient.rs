//! The derivatives of a value by the parameters of the damper, from those of the runs behind it.
//!
//! By the envelope theorem (J. M. Danskin, The Theory of Max-Min, 1967) the largest value over time, a band of frequencies or a range of
//! stiffnesses changes like the value at the place where it is reached: there is a peak, along which nothing changes to first order, or an
//! end, which does not move. Where several places have the same largest value it has a kink, and the derivatives are those at one of
//! them: a subgradient. A sum or a mean has the sum or the mean of the derivatives of its terms or members, a quantile those of the
//! member that it is the value of.
//!
//! The value of a design that breaks a limit is its violation ([`ranked`](super::limits::ranked)), and so are its derivatives.

use super::design_objective::DesignObjective;
use super::evaluation::{Evaluation, Place};
use super::limits::{INFEASIBLE, Limit, widens};
use super::runs::{Numbered, Proceed};
use super::spec::{Goal, Objective, Response};
use super::unusable::Unusable;
use rayon::prelude::*;
use retune_model::{Coupled, Measure, Parameter, Scene};
use retune_solver::{Ask, Settings, Window, extremes_by, settled_by};

/// The worst run of a member of an ensemble, or of the scene itself; and the derivative of each of its varied parameters by that of the
/// scene.
type Member = (Place, Vec<f64>);

impl DesignObjective {
    /// The result of [`Self::evaluate`] for a design, and the derivatives of its value by the design, per SI unit of each parameter; as
    /// long as `proceed` is true. The derivatives of an irregular motion are those of its single run: correct, large, and useless to a
    /// search.
    ///
    /// # Errors
    /// As [`Goal::evaluate_while`], and a value out of its parameter's range.
    pub fn gradient(&self, design: &[f64], proceed: Proceed<'_>) -> Result<(Evaluation, Vec<f64>), Unusable> {
        let scene = self.scene(design)?;
        let goal = self.goal();
        let found = goal.evaluate_while(&scene, self.settings(), f64::INFINITY, proceed)?;
        let slopes = Slopes { goal, scene, settings: self.settings(), variables: self.variables(), proceed };
        let by = if found.violation > 0.0 { slopes.violation(&found)? } else { slopes.sum(&found)? };
        Ok((found, by))
    }
}

/// The goal and the scene that are differentiated.
struct Slopes<'a> {
    goal: &'a Goal,
    scene: Scene,
    settings: &'a Settings,
    variables: &'a [Parameter],
    proceed: Proceed<'a>,
}

impl Slopes<'_> {
    /// The derivatives of the weighted sum of the terms.
    fn sum(&self, found: &Evaluation) -> Result<Vec<f64>, Unusable> {
        let objective = &self.goal.objective;
        if objective.sum.is_empty() && objective.ensemble.is_none() {
            return self.of((found.worst, vec![1.0; self.variables.len()]), objective, self.goal.window);
        }
        let mut sum = vec![0.0; self.variables.len()];
        for (number, (weight, term)) in objective.terms().into_iter().enumerate() {
            let members = self.members(self.goal, (number, term))?;
            let values: Vec<f64> = members.iter().map(|(place, _)| place.largest).collect();
            let shares = term.ensemble.as_ref().map_or(vec![1.0], |ensemble| ensemble.by_member(&values));
            for (member, share) in members.into_iter().zip(shares).filter(|(_, share)| *share != 0.0) {
                add(&mut sum, weight * share, &self.of(member, term, self.goal.window)?);
            }
        }
        Ok(sum)
    }

    /// The derivatives of the value of a design that breaks limits.
    fn violation(&self, found: &Evaluation) -> Result<Vec<f64>, Unusable> {
        let limits = &self.goal.limits;
        let mut sum = vec![0.0; self.variables.len()];
        for limit in Limit::ALL {
            let Some(allowed) = limits.get(limit).filter(|allowed| found.reached.get(limit) > *allowed)
            else {
                continue;
            };
            let by = match limit {
                Limit::Of(measure) => self.largest(measure)?,
                Limit::Cavity => self.variables.iter().map(|by| widens(*by)).collect(),
            };
            add(&mut sum, INFEASIBLE / allowed, &by);
        }
        Ok(sum)
    }

    /// The derivatives of the largest value of a measure over all runs, from the time on at which limits apply.
    fn largest(&self, measure: Measure) -> Result<Vec<f64>, Unusable> {
        let mut objective = self.goal.objective.clone();
        objective.for_each_term(&mut |term| {
            term.quantity = measure;
            // The transient before a settled motion counts, too, so the whole window is evaluated.
            if term.response == Response::Settled {
                term.response = Response::Window;
            }
        });
        let from = self.goal.limits.also().map_or(0.0, |also| also.from);
        let window = Window { from, ..self.goal.window };
        let goal = Goal { objective, ..window.into() };
        let mut worst: Option<(Member, &Objective)> = None;
        for (number, (_, term)) in goal.objective.terms().into_iter().enumerate() {
            for member in self.members(&goal, (number, term))? {
                if worst.as_ref().is_none_or(|((place, _), _)| member.0.largest > place.largest) {
                    worst = Some((member, term));
                }
            }
        }
        worst.map_or_else(
            || Ok(vec![0.0; self.variables.len()]),
            |(member, term)| self.of(member, term, window),
        )
    }

    /// The worst run of each member of a term's ensemble.
    fn members(&self, goal: &Goal, term: Numbered<'_>) -> Result<Vec<Member>, Unusable> {
        let worst = |scene: &Scene, phase| goal.worst(scene, phase, term, self.settings, self.proceed);
        let Some(ensemble) = &term.1.ensemble else {
            return Ok(vec![(worst(&self.scene, 0.0)?, vec![1.0; self.variables.len()])]);
        };
        let member = |i: u32| {
            let (scene, phase) = ensemble.member(&self.scene, i).map_err(Unusable::Member)?;
            let shares = self.variables.iter().map(|&by| ensemble.factor(by, i)).collect();
            Ok((worst(&scene, phase)?, shares))
        };
        (0..ensemble.members.max(1)).into_par_iter().map(member).collect()
    }

    /// The derivatives of one run's largest value.
    fn of(&self, (place, shares): Member, term: &Objective, window: Window) -> Result<Vec<f64>, Unusable> {
        let Place { scene, phase, .. } = &place;
        let ask = Ask { measure: term.quantity, phase: *phase, ..Ask::default() };
        let by = match (term.response, &scene.damper) {
            _ if !term.has_derivatives() => return Err(Unusable::NoDerivatives),
            (Response::Steady, Some(damper)) => {
                let system = Coupled::new(&scene.primary, &scene.forcing, damper);
                let omega = scene.forcing.frequency.get();
                self.variables.iter().map(|&by| system.steady_by(term.quantity, by, omega)).collect()
            }
            (Response::Settled, _) => {
                settled_by(scene, window, term.settle, self.settings, ask, self.variables)?
            }
            (Response::Motions, _) | (Response::Steady, None) => return Err(Unusable::NoDerivatives),
            _ => extremes_by(scene, window, self.settings, ask, self.variables)?,
        };
        Ok(by.iter().zip(shares).map(|(by, share)| by * share).collect())
    }
}

fn add(sum: &mut [f64], weight: f64, more: &[f64]) {
    for (sum, more) in sum.iter_mut().zip(more) {
        *sum += weight * more;
    }
}
