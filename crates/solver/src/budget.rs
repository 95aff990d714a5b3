//! Limits on the work of a run.

use crate::error::{Remedy, SolverError};
use crate::response::Work;

/// Steps, or evaluations, after which the progress of a run is checked.
const CHECK_AFTER: u64 = 1 << 18;

/// With fewer steps than this the rate of a run is unknown: the remedy is a higher limit.
const MIN_STEPS: u64 = 1000;

/// A run that would need more than this many times its limit is aborted. A smaller excess may be a burst of contacts that ends.
const GIVE_UP_FACTOR: f64 = 100.0;

/// Flight steps that take as long as one evaluation of the equations, or the work of an observer that counts as one, with its share of the
/// other work in a step: with the default limit of 20 million steps hardly any run takes more than two seconds (`just lab hunt-durations`).
const STEPS_PER_EVALUATION: u64 = 4;

/// Units of an observer's work ([`Observer::search_work`](crate::observe::Observer::search_work)) that count as one evaluation: with the
/// default limit they take two seconds (`just lab hunt-durations`).
const SEARCH_WORK_PER_EVALUATION: u64 = 22;

/// Evaluations, with the work of observers, that every run may make, whatever its limit on steps.
const LEAST_EVALUATIONS: u64 = 5_000_000;

impl Work {
    /// Adds the work of an observer, as evaluations.
    #[inline(always)]
    pub(crate) fn with_search_work(self, search_work: u64) -> Self {
        Self { evaluations: self.evaluations + search_work / SEARCH_WORK_PER_EVALUATION, ..self }
    }
}

/// How a run chooses its steps.
#[derive(Clone, Copy, Debug)]
pub enum Pace {
    /// Exact flight: steps of fixed length, set by the fastest rate of the system. All other steps are those of contacts.
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
/// The number of steps that a bouncing damper needs is not known in advance. So a run is aborted once it has used up its steps or made a
/// quarter as many evaluations (of the equations of contact, or by a method with step control, plus the work of its observers; at least 5
/// million). It is also aborted after 262,144 of either if at its present rate it would need a hundred times its limit (or a hundred times
/// 262,144, if the limit is lower). Raising `max_steps` raises all these limits.
#[derive(Clone, Copy, Debug)]
pub struct Budget {
    pace: Pace,
    limit: u64,
    /// Work before this stretch.
    work_before: Work,
    span: [f64; 2],
}

impl Budget {
    /// The budget of a run of at most `limit` steps on the stretch from `span[0]` to `span[1]`, s, before which it has done the work
    /// `work_before`.
    pub fn new(pace: Pace, limit: u64, work_before: Work, span: [f64; 2]) -> Self {
        Self { pace, limit, work_before, span }
    }

    /// Checks a run that has reached `t` (s).
    ///
    /// # Errors
    /// [`SolverError::TooManySteps`], [`SolverError::TooSlow`].
    #[inline(always)]
    pub fn check(&self, work: &Work, t: f64) -> Result<(), SolverError> {
        let Work { steps, evaluations, .. } = *work;
        let is_long = steps - self.work_before.steps > CHECK_AFTER
            || evaluations - self.work_before.evaluations > CHECK_AFTER;
        if steps > self.limit || is_long { self.check_progress(work, t) } else { Ok(()) }
    }

    /// The error of a run that cannot advance beyond `t` (s), however many steps it may take.
    #[cold]
    pub fn no_progress(&self, work: &Work, t: f64) -> SolverError {
        let Self { pace, limit, span: [_, to], .. } = *self;
        let (steps, needed) = (work.steps, f64::INFINITY);
        SolverError::TooSlow { t, steps, needed, limit, remedy: pace.remedy(to, 0.0) }
    }

    #[cold]
    fn check_progress(&self, work: &Work, t: f64) -> Result<(), SolverError> {
        let Self { pace, limit, work_before, span: [from, to] } = *self;
        let Work { steps, evaluations, .. } = *work;
        let (taken, covered) = ((steps - work_before.steps) as f64, (t - from).max(0.0));
        let rest = (to - from) / covered;
        let needed = taken * rest;
        let most_evaluations = (limit / STEPS_PER_EVALUATION).max(LEAST_EVALUATIONS);
        let evaluated = (evaluations - work_before.evaluations) as f64 * rest;
        let hopeless = needed > GIVE_UP_FACTOR * limit.max(CHECK_AFTER) as f64
            || evaluated > GIVE_UP_FACTOR * most_evaluations as f64;
        if steps - work_before.steps > MIN_STEPS && hopeless {
            let remedy = pace.remedy(to, covered / taken);
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
        assert_eq!(budget.check(&steps(200_000 + CHECK_AFTER), 10.0), Ok(()), "too early to tell");
        assert!(budget.check(&steps(200_001 + CHECK_AFTER), 10.0).is_err(), "no way made");
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
