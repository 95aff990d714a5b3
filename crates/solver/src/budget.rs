//! How much work a run may be.

use crate::error::{Remedy, SolverError};
use crate::response::Work;

/// Steps, or evaluations, after which the progress of a run is checked.
const CHECKED: u64 = 1 << 18;

/// With fewer steps than this the rate of a run is unknown: the remedy is a higher limit.
const FEW: u64 = 1000;

/// A run that would need more than this many times its limit is given up. Less may be a burst of contacts that ends.
const HOPELESS: f64 = 100.0;

/// Steps of flight that take as long as an evaluation of the equations, or a look of an observer, with its share of what is done at each step: with
/// the default limit of 20 million steps hardly any run takes more than two seconds (`just lab hunt-durations`).
const STEPS_OF_AN_EVALUATION: u64 = 4;

/// Looks of an observer ([`Observer::looks`](crate::observe::Observer::looks)) that count as an evaluation: with the default limit they take
/// two seconds (`just lab hunt-durations`).
const LOOKS_OF_AN_EVALUATION: u64 = 22;

/// Evaluations and looks that a run may make however few steps it may take.
const LEAST_EVALUATIONS: u64 = 5_000_000;

impl Work {
    /// With what an observer has looked at, as evaluations.
    #[inline(always)]
    pub(crate) fn and(self, looks: u64) -> Self {
        Self { evaluations: self.evaluations + looks / LOOKS_OF_AN_EVALUATION, ..self }
    }
}

/// How a run chooses its steps.
#[derive(Clone, Copy, Debug)]
pub enum Pace {
    /// Exact flight: steps of fixed length, set by the fastest rate of the system. All further steps are those of contacts.
    Flight {
        /// Length of a step, s.
        step: f64,
        /// The rate that sets it, in the symbols of a study file.
        fastest: &'static str,
    },
    /// The error estimate of a general method.
    Steps,
}

impl Pace {
    /// The remedy for a run to time `to` (s) that takes steps of `mean` seconds.
    ///
    /// Either the run is too long or its step too short: whichever is more orders of magnitude away from a second.
    pub fn remedy(self, to: f64, mean: f64) -> Remedy {
        match self {
            _ if to * mean > 1.0 => Remedy::ShorterRun,
            Pace::Flight { step, fastest } if mean > 0.5 * step => Remedy::Slower(fastest),
            Pace::Flight { .. } => Remedy::LessForce,
            Pace::Steps => Remedy::Hybrid,
        }
    }
}

/// The number of steps that a stretch of a run may take, and the progress that they must make.
///
/// The number of steps that a bouncing damper needs is not known beforehand. So a run is refused once it has used up its steps or made
/// a quarter as many evaluations (of the equations of contact, or by a method that chooses its steps, and looks of its observers; at least 5 million), and after 262,144 of either if at its present
/// rate it would need a hundred times its limit (or a hundred times 262,144, if the limit is lower). Raising `max_steps` raises all.
#[derive(Clone, Copy, Debug)]
pub struct Budget {
    pace: Pace,
    limit: u64,
    /// Work before this stretch.
    begun: Work,
    span: [f64; 2],
}

impl Budget {
    /// The budget of a run of at most `limit` steps on the stretch from `span[0]` to `span[1]`, s, before which it has done the work
    /// `begun`.
    pub fn new(pace: Pace, limit: u64, begun: Work, span: [f64; 2]) -> Self {
        Self { pace, limit, begun, span }
    }

    /// Checks a run that has reached `t` (s).
    ///
    /// # Errors
    /// [`SolverError::TooManySteps`], [`SolverError::TooSlow`].
    #[inline(always)]
    pub fn check(&self, work: &Work, t: f64) -> Result<(), SolverError> {
        let Work { steps, evaluations, .. } = *work;
        let is_long = steps - self.begun.steps > CHECKED || evaluations - self.begun.evaluations > CHECKED;
        if steps > self.limit || is_long { self.judge(work, t) } else { Ok(()) }
    }

    /// The error of a run that cannot go on from `t` (s), however many steps it may take.
    #[cold]
    pub fn no_progress(&self, work: &Work, t: f64) -> SolverError {
        let Self { pace, limit, span: [_, to], .. } = *self;
        let (steps, needed) = (work.steps, f64::INFINITY);
        SolverError::TooSlow { t, steps, needed, limit, remedy: pace.remedy(to, 0.0) }
    }

    #[cold]
    fn judge(&self, work: &Work, t: f64) -> Result<(), SolverError> {
        let Self { pace, limit, begun, span: [from, to] } = *self;
        let Work { steps, evaluations, .. } = *work;
        let (taken, come) = ((steps - begun.steps) as f64, (t - from).max(0.0));
        let rest = (to - from) / come;
        let needed = taken * rest;
        let most_evaluations = (limit / STEPS_OF_AN_EVALUATION).max(LEAST_EVALUATIONS);
        let evaluated = (evaluations - begun.evaluations) as f64 * rest;
        let hopeless =
            needed > HOPELESS * limit.max(CHECKED) as f64 || evaluated > HOPELESS * most_evaluations as f64;
        if steps - begun.steps > FEW && hopeless {
            let remedy = pace.remedy(to, come / taken);
            return Err(SolverError::TooSlow { t, steps, needed, limit, remedy });
        }
        if steps > limit {
            Err(SolverError::TooManySteps { t, limit, evaluations: None })
        } else if evaluations > most_evaluations {
            Err(SolverError::TooManySteps { t, limit, evaluations: Some(most_evaluations) })
        } else {
            Ok(())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn steps(steps: u64) -> Work {
        Work { steps, ..Work::default() }
    }

    /// A step of a contact or of a general method takes as long as fifty of flight.
    #[test]
    fn contract_evaluations_are_work_too() {
        let work = |evaluations| Work { steps: 400_000, evaluations, ..Work::default() };
        let budget = Budget::new(FLIGHT, 20_000_000, steps(0), [0.0, 100.0]);
        assert_eq!(budget.check(&work(5_000_000), 50.0), Ok(()));
        let spent = SolverError::TooManySteps { t: 50.0, limit: 20_000_000, evaluations: Some(5_000_000) };
        assert_eq!(budget.check(&work(5_000_001), 50.0), Err(spent));
        let found = budget.check(&work(1_000_000), 0.19);
        assert!(matches!(found, Err(SolverError::TooSlow { .. })), "526 million: {found:?}");
        assert_eq!(budget.check(&work(1_000_000), 0.21), Ok(()));
        // A low limit on steps is one on steps.
        assert_eq!(
            Budget::new(FLIGHT, 500_000, steps(0), [0.0, 100.0]).check(&work(4_999_999), 50.0),
            Ok(())
        );
    }

    const FLIGHT: Pace = Pace::Flight { step: 1e-5, fastest: "k2/m2" };

    #[test]
    fn contract_a_run_is_refused_when_its_steps_are_spent_or_cannot_suffice() {
        let budget = Budget::new(FLIGHT, 1_000_000, steps(0), [10.0, 20.0]);
        assert_eq!(budget.check(&steps(1_000_000), 10.2), Ok(()));
        let spent = SolverError::TooManySteps { t: 19.0, limit: 1_000_000, evaluations: None };
        assert_eq!(budget.check(&steps(1_000_001), 19.0), Err(spent));
        // 300,000 steps for 10 s / 334 are 100.2 million for all of it.
        assert_eq!(budget.check(&steps(300_000), 10.0 + 10.0 / 333.0), Ok(()));
        let found = budget.check(&steps(300_000), 10.0 + 10.0 / 334.0);
        assert!(matches!(found, Err(SolverError::TooSlow { needed, .. }) if needed > 1e8), "{found:?}");
        let still = budget.check(&steps(300_000), 10.0);
        assert!(matches!(still, Err(SolverError::TooSlow { needed: f64::INFINITY, .. })), "{still:?}");
        // Too early to tell.
        assert_eq!(budget.check(&steps(1000), 10.0), Ok(()));
    }

    #[test]
    fn contract_the_remedy_is_what_is_out_of_proportion() {
        for (to, mean, expected) in [
            (100.0, 1e-5, Remedy::Slower("k2/m2")),
            (100.0, 1e-9, Remedy::LessForce),
            (1e9, 1e-5, Remedy::ShorterRun),
            (1e9, 1e-12, Remedy::LessForce),
        ] {
            assert_eq!(FLIGHT.remedy(to, mean), expected);
        }
        assert_eq!(Pace::Steps.remedy(100.0, 1e-5), Remedy::Hybrid);
        assert_eq!(Pace::Steps.remedy(1e9, 1e-5), Remedy::ShorterRun);
        // A stretch that does not move at all.
        assert_eq!(FLIGHT.remedy(100.0, 0.0), Remedy::LessForce);
    }

    /// The progress of a stretch is judged by its own steps, not by those before it.
    #[test]
    fn contract_a_budget_counts_the_steps_of_its_stretch() {
        let budget = Budget::new(FLIGHT, 1_000_000, steps(200_000), [10.0, 20.0]);
        assert_eq!(budget.check(&steps(200_000 + CHECKED), 10.0), Ok(()), "too early to tell");
        assert!(budget.check(&steps(200_001 + CHECKED), 10.0).is_err(), "no way made");
        // 300,000 steps for 10 s / 333 are 99.9 million for all of it, whatever came before.
        assert_eq!(budget.check(&steps(500_000), 10.0 + 10.0 / 333.0), Ok(()));
        assert!(budget.check(&steps(500_000), 10.0 + 10.0 / 334.0).is_err());
    }

    /// A limit that is too low for any run leads to `TooManySteps`, which advises a higher one.
    #[test]
    fn contract_few_steps_are_no_evidence_of_a_slow_run() {
        let budget = Budget::new(FLIGHT, 3, steps(0), [0.0, 100.0]);
        assert_eq!(
            budget.check(&steps(4), 0.0),
            Err(SolverError::TooManySteps { t: 0.0, limit: 3, evaluations: None })
        );
    }
}
