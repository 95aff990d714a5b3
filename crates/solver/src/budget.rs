//! How many steps a run may take.

use crate::error::{Remedy, SolverError};

/// Steps after which the progress of a run is checked.
const LOOK: u64 = 1 << 18;

/// With fewer steps than this the rate of a run is unknown: the remedy is a higher limit.
const FEW: u64 = 1000;

/// A run that would need more than this many times its limit is given up. Less may be a burst of contacts that ends.
const HOPELESS: f64 = 100.0;

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
/// The number of steps that a bouncing damper needs is not known beforehand. So a run is refused once it has used up its steps, and
/// after 262,144 steps if at its present rate it would need a hundred times its limit (or a hundred times 262,144, if the limit is
/// lower). Raising `max_steps` raises both.
#[derive(Clone, Copy, Debug)]
pub struct Budget {
    pace: Pace,
    limit: u64,
    /// Steps before this stretch.
    begun: u64,
    span: [f64; 2],
}

impl Budget {
    /// The budget of a run of at most `limit` steps, of which `begun` have been taken, on the stretch from `span[0]` to
    /// `span[1]`, s.
    pub fn new(pace: Pace, limit: u64, begun: u64, span: [f64; 2]) -> Self {
        Self { pace, limit, begun, span }
    }

    /// Checks a run that has reached `t` (s) after `steps` steps.
    ///
    /// # Errors
    /// [`SolverError::TooManySteps`], [`SolverError::TooSlow`].
    #[inline(always)]
    pub fn check(&self, steps: u64, t: f64) -> Result<(), SolverError> {
        if steps > self.limit || steps - self.begun > LOOK { self.look(steps, t) } else { Ok(()) }
    }

    #[cold]
    fn look(&self, steps: u64, t: f64) -> Result<(), SolverError> {
        let Self { pace, limit, begun, span: [from, to] } = *self;
        let (taken, come) = ((steps - begun) as f64, (t - from).max(0.0));
        let needed = taken * ((to - from) / come);
        if steps - begun > FEW && needed > HOPELESS * limit.max(LOOK) as f64 {
            let remedy = pace.remedy(to, come / taken);
            return Err(SolverError::TooSlow { t, steps, needed, limit, remedy });
        }
        if steps > limit { Err(SolverError::TooManySteps { t, limit }) } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FLIGHT: Pace = Pace::Flight { step: 1e-5, fastest: "k2/m2" };

    #[test]
    fn contract_a_run_is_refused_when_its_steps_are_spent_or_cannot_suffice() {
        let budget = Budget::new(FLIGHT, 1_000_000, 0, [10.0, 20.0]);
        assert_eq!(budget.check(1_000_000, 10.2), Ok(()));
        let spent = SolverError::TooManySteps { t: 19.0, limit: 1_000_000 };
        assert_eq!(budget.check(1_000_001, 19.0), Err(spent));
        // 300,000 steps for 10 s / 334 are 100.2 million for all of it.
        assert_eq!(budget.check(300_000, 10.0 + 10.0 / 333.0), Ok(()));
        let found = budget.check(300_000, 10.0 + 10.0 / 334.0);
        assert!(matches!(found, Err(SolverError::TooSlow { needed, .. }) if needed > 1e8), "{found:?}");
        let still = budget.check(300_000, 10.0);
        assert!(matches!(still, Err(SolverError::TooSlow { needed: f64::INFINITY, .. })), "{still:?}");
        // Too early to tell.
        assert_eq!(budget.check(1000, 10.0), Ok(()));
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
        let budget = Budget::new(FLIGHT, 1_000_000, 200_000, [10.0, 20.0]);
        assert_eq!(budget.check(200_000 + LOOK, 10.0), Ok(()), "too early to tell");
        assert!(budget.check(200_001 + LOOK, 10.0).is_err(), "no way made");
        // 300,000 steps for 10 s / 333 are 99.9 million for all of it, whatever came before.
        assert_eq!(budget.check(500_000, 10.0 + 10.0 / 333.0), Ok(()));
        assert!(budget.check(500_000, 10.0 + 10.0 / 334.0).is_err());
    }

    /// A limit that is too low for any run leads to `TooManySteps`, which advises a higher one.
    #[test]
    fn contract_few_steps_are_no_evidence_of_a_slow_run() {
        let budget = Budget::new(FLIGHT, 3, 0, [0.0, 100.0]);
        assert_eq!(budget.check(4, 0.0), Err(SolverError::TooManySteps { t: 0.0, limit: 3 }));
    }
}
