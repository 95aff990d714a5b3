//! Flight over the samples of an equidistant record, four of its pieces side by side.

use super::propagator::{Hybrid, Motion, Phase};
use crate::error::SolverError;
use crate::linear::pieces::{clock, forces};
use crate::linear::steps::Steps;
use crate::motion::knot::Knot;
use crate::motion::lanes::LANES;
use crate::observe::observer::Observer;

impl Hybrid<'_> {
    /// Flies from a sample over whole pieces of the record, as far as no wall is near, at most to time `to`.
    #[inline(always)]
    pub(super) fn over_samples(
        &mut self,
        from: Motion,
        to: f64,
        observer: &mut impl Observer<4>,
    ) -> Result<Motion, SolverError> {
        let Some(force) = self.samples.filter(|_| from.phase == Phase::Flight) else { return Ok(from) };
        let Some(mut i) = force.at(from.t) else { return Ok(from) };
        let mut now = Knot { t: from.t, excitation: [0.0; 2], y: from.y, clock: [1.0, 0.0] };
        let growth = LANES as f64 * self.flow.step() * self.system.energy_norm_growth();
        while let Some(forces) = forces(&force, i, to) {
            let energy = self.system.energy_norm(&now.y);
            if !energy.is_finite() {
                return Err(SolverError::NonFinite { t: now.t });
            }
            let mut steps = Steps::bent(&self.flow, now, &forces, clock(&force, i), energy + growth);
            let (open, _) = self.open_steps(&steps, None);
            if open == 0 {
                break;
            }
            steps.keep(open);
            self.work.steps += open as u64;
            self.budget.check(&self.work, now.t)?;
            observer.steps(&steps);
            now = steps.knot(open);
            i += open;
            if open < LANES || observer.satisfied() {
                break;
            }
        }
        Ok(Motion { t: now.t, y: now.y, phase: Phase::Flight })
    }
}
