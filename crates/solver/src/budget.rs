//! How many steps a run may take.

use crate::settings::{Method, SolverError};

/// Steps after which a run is asked whether it gets anywhere.
const LOOK: u64 = 1 << 18;

/// A run that would take more than so many times the steps it may take is hopeless. Less could be a burst of contacts after which
/// the motion calms down.
const HOPELESS: f64 = 100.0;

/// The steps that a stretch of a run may take, and how far they must bring it.
///
/// Which runs are too long cannot be told beforehand: the steps of a damper that bounces follow from the motion. So a run is
/// refused when it has taken all its steps, and after 262,144 already if at its rate it would need a hundred times as many as it
/// may take. Raising `max_steps` raises both.
#[derive(Clone, Copy, Debug)]
pub struct Budget {
    method: Method,
    limit: u64,
    /// Steps before this stretch.
    begun: u64,
    span: [f64; 2],
}

impl Budget {
    /// The budget of a run of at most `limit` steps by a method, of which `begun` have been taken, on the stretch from `span[0]` to
    /// `span[1]`, s.
    pub fn new(method: Method, limit: u64, begun: u64, span: [f64; 2]) -> Self {
        Self { method, limit, begun, span }
    }

    /// Looks at a run that has come to `t` (s) in so many steps.
    ///
    /// # Errors
    /// [`SolverError::TooManySteps`], [`SolverError::TooSlow`].
    #[inline(always)]
    pub fn check(&self, steps: u64, t: f64) -> Result<(), SolverError> {
        if steps > self.limit || steps - self.begun > LOOK { self.look(steps, t) } else { Ok(()) }
    }

    #[cold]
    fn look(&self, steps: u64, t: f64) -> Result<(), SolverError> {
        let Self { method, limit, begun, span: [from, to] } = *self;
        if steps > limit {
            return Err(SolverError::TooManySteps { t, limit, method });
        }
        let needed = (steps - begun) as f64 * ((to - from) / (t - from).max(0.0));
        if needed > HOPELESS * limit as f64 {
            return Err(SolverError::TooSlow { t, steps, needed, limit, method });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_a_run_is_refused_when_its_steps_are_spent_or_cannot_suffice() {
        let budget = Budget::new(Method::Hybrid, 1_000_000, 0, [10.0, 20.0]);
        assert_eq!(budget.check(1_000_000, 10.2), Ok(()));
        let spent = SolverError::TooManySteps { t: 19.0, limit: 1_000_000, method: Method::Hybrid };
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
}
