//! Flight over the samples of a record, four of its pieces side by side, and contacts that span samples.

use super::propagator::{Hybrid, Motion, Phase};
use crate::contact::collocation::bends::Bends;
use crate::error::SolverError;
use crate::linear::pieces::{Block, PIECES, Pieces};
use crate::linear::steps::Steps;
use crate::motion::knot::Knot;
use crate::motion::lanes::LANES;
use crate::observe::observer::Observer;
use retune_model::Side;
use wide::f64x4;

/// Share of the largest force by which two pieces of a record may differ where they meet, by rounding. More is a jump.
const JUMP: f64 = 1e-12;

impl Hybrid<'_> {
    /// The bends of the force in a contact that begins at `touch`, and the time (s) until which it neither jumps nor bends anywhere else.
    pub(super) fn bends(&self, side: Side, touch: &Knot<4>) -> (Bends, f64) {
        let (bare, mut bends) = (self.system.bare(), Bends::NONE);
        let Some(mut stretch) = self.stretch else { return (bends, self.end) };
        let returns = bare.turning()[1];
        let latest = self.collisions[side as usize].latest_end(touch);
        let jump = JUMP * bare.force_bounds()[0];
        // The end is NaN for a touch-down that begins no contact.
        while returns == 0.0 && stretch.to < self.end && stretch.to < latest {
            let Some(next) = bare.stretch(stretch.to) else { break };
            let before = bare.excitation_in(&stretch, stretch.to);
            let bend = next.begin[1] - before[1];
            let jumps = (next.begin[0] - before[0]).abs() > jump;
            if jumps || !bends.push(stretch.to - touch.t, bend) {
                break;
            }
            stretch = next;
        }
        (bends, stretch.to.min(self.end))
    }

    /// Flies from a sample over whole pieces of the record, as far as no wall is near, at most to time `to`.
    #[inline(always)]
    pub(super) fn fly_over_samples(
        &mut self,
        from: Motion,
        to: f64,
        observer: &mut (impl Observer<4> + ?Sized),
    ) -> Result<Motion, SolverError> {
        let Some(pieces) = self.samples.take_if(|_| from.phase == Phase::Flight) else { return Ok(from) };
        let end = self.fly_over_pieces(&pieces, from, to, observer);
        self.samples = Some(pieces);
        end
    }

    #[inline(always)]
    fn fly_over_pieces(
        &mut self,
        pieces: &Pieces<4>,
        from: Motion,
        to: f64,
        observer: &mut (impl Observer<4> + ?Sized),
    ) -> Result<Motion, SolverError> {
        let Some(mut i) = pieces.at(from.t) else { return Ok(from) };
        let mut now = Knot { t: from.t, excitation: [0.0; 2], y: from.y, clock: [1.0, 0.0] };
        let growth = LANES as f64 * self.flow.step() * self.system.energy_norm_growth();
        // After a block that had to be observed piece by piece, the next one is tried at this sample.
        let mut next_block = i;
        loop {
            if i >= next_block {
                if let Some((end, y)) = self.skip_block(pieces, i, &now.y, to, observer) {
                    (now.t, now.y, i, next_block) = (end, y, i + PIECES, i + PIECES);
                    self.work.steps += PIECES as u64;
                    self.budget.check(&self.work.with_search_work(observer.search_work()), now.t)?;
                    continue;
                }
                next_block = i + PIECES;
            }
            let Some(four) = pieces.four(&self.flow, i, to, &now.y) else { break };
            let energy = self.system.energy_norm(&now.y);
            if !energy.is_finite() {
                return Err(SolverError::NonFinite { t: now.t });
            }
            let mut steps = Steps::from_pieces(&self.flow, now, four, energy + growth);
            let (open, _) = self.open_steps(&steps, None);
            if open == 0 {
                break;
            }
            steps.keep(open);
            self.work.steps += open as u64;
            self.budget.check(&self.work.with_search_work(observer.search_work()), now.t)?;
            observer.steps(&steps);
            now = steps.knot(open);
            i += open;
            if open < LANES || observer.satisfied() {
                break;
            }
        }
        Ok(Motion { t: now.t, y: now.y, phase: Phase::Flight })
    }

    /// The end of the block of pieces from sample `i`, and the state there, if provably no wall is near in it and there is nothing to
    /// observe.
    #[inline(always)]
    fn skip_block(
        &self,
        pieces: &Pieces<4>,
        i: usize,
        y: &[f64; 4],
        to: f64,
        observer: &(impl Observer<4> + ?Sized),
    ) -> Option<(f64, [f64; 4])> {
        let growth = PIECES as f64 * self.flow.step() * self.system.energy_norm_growth();
        let energy = self.system.energy_norm(y) + growth;
        let block = Block::new(&self.flow, pieces, i, to, y, energy)?;
        let stroke = |_: &[f64x4; 2], y: &[f64x4; 4]| y[2] - y[0];
        let [near, far] = block.range(stroke, self.second[0] * energy + self.second[1]);
        let [wall, obstacle] = Side::BOTH.map(|side| self.system.wall(side));
        let is_open = near > wall && far < obstacle;
        (is_open && observer.skips(&block)).then(|| (block.end, block.last()))
    }
}
