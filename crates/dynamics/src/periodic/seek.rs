//! Searches for motions that the runs at the samples miss: those stable over little of the range, and those that no run settles on.

use super::attractors::{Sample, attractors_at};
use super::branches::Branches;
use super::deflate::another;
use super::settle::Starts;
use super::shooting::{Shooting, Solution};
use crate::parameter::{Error, evenly};
use crate::poincare::{Periods, orbit};
use nalgebra::DVector;
use rayon::prelude::*;
use retune_solver::{Motion, Phase};

/// Periods after which a run has come near to a motion, stable or not.
const PASSED: usize = 20;

impl Branches {
    /// Follows the branches of new motions that runs from rest at many values of the parameter settle on.
    ///
    /// # Errors
    /// A scene in the range cannot be run.
    pub(super) fn seek_from_rest(
        &mut self,
        shooting: &Shooting,
        starts: &Starts,
        proceed: &(dyn Fn() -> bool + Sync),
    ) -> Result<(), Error> {
        let [from, to] = self.plan.range;
        let unknown = |branches: &Self, value: f64| -> Result<bool, Error> {
            let seen = attractors_at(shooting, value, (starts, 0), proceed)?;
            Ok(seen.any(shooting, |equations, motion| branches.holds(equations, motion).is_none()))
        };
        let values = evenly(from, to, self.plan.fine);
        let seen: Result<Vec<bool>, Error> = values.par_iter().map(|value| unknown(self, *value)).collect();
        for (value, _) in values.into_iter().zip(seen?).filter(|(_, is_unknown)| *is_unknown) {
            // The branch through one of them may hold the next.
            if unknown(self, value)? {
                let seen = attractors_at(shooting, value, (starts, self.plan.fewer_starts()), proceed)?;
                self.add(shooting, vec![seen], proceed);
            }
        }
        Ok(())
    }

    /// Follows the branches of new motions of `periods` periods that deflated Newton's iteration finds from states that runs pass.
    ///
    /// # Errors
    /// A scene in the range cannot be run.
    pub(super) fn seek_apart(
        &mut self,
        shooting: &Shooting,
        starts: &Starts,
        periods: usize,
        proceed: &(dyn Fn() -> bool + Sync),
    ) -> Result<(), Error> {
        let equations = shooting.of_periods(periods);
        let near = Periods { settle: PASSED - periods, record: periods };
        let find_new = |sample: &Sample| -> Result<Vec<Solution>, Error> {
            let value = sample.value;
            let system = equations.system(value)?;
            let mut known = self.solutions(shooting, periods, value);
            let mut found = Vec::new();
            for y in (0..self.plan.apart).map(|number| starts.state(number, &system)) {
                let from = Motion { t: 0.0, y, phase: Phase::of(&system, &y) };
                let (run, _) = orbit(&system, value, from, near, equations.settings())?;
                let start = equations.unknowns(&run.samples, value);
                while let Some(motion) = proceed().then(|| another(&equations, &start, &known)).flatten() {
                    known.push(motion.x.clone());
                    found.push(motion);
                }
            }
            Ok(found)
        };
        let found: Result<Vec<Vec<Solution>>, Error> =
            self.samples.par_iter().filter(|sample| sample.number.is_none()).map(find_new).collect();
        for motion in found?.into_iter().flatten() {
            if self.holds(&equations, &motion).is_none() {
                self.follow(&equations, &motion, proceed);
            }
        }
        Ok(())
    }

    /// The motions on all branches at a value that repeat after `periods` periods, including those that repeat sooner.
    fn solutions(&self, shooting: &Shooting, periods: usize, value: f64) -> Vec<DVector<f64>> {
        let equations = shooting.of_periods(periods);
        let shorter = (1..=periods).filter(|shorter| periods.is_multiple_of(*shorter));
        let all = shorter.flat_map(|shorter| {
            let part = shooting.of_periods(shorter);
            let states = self.at(&part, value).into_iter().map(move |motion| part.states(&motion.x));
            states.map(move |states| states.repeat(periods / shorter))
        });
        all.map(|states| equations.unknowns(&states, value)).collect()
    }
}
