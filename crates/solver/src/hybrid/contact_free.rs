//! Linear scenes in closed form: the bare structure, and a damper that provably never reaches a wall.
//!
//! The motion is a steady one and a transient, `y = y_s(t) + e^{A t} h`. Damping only takes energy from the transient, so its energy norm
//! bounds its later motion: the bound decides whether a wall can ever be reached, and whether the largest value can still be exceeded.

use crate::budget::Budget;
use crate::error::SolverError;
use crate::linear::flow::Flow;
use crate::linear::pieces::{Block, PIECES, Pieces, longest_step};
use crate::linear::reduced::Reduced;
use crate::linear::steps::{Step, StepClock, Steps};
use crate::motion::knot::Knot;
use crate::motion::lanes::LANES;
use crate::motion::segment::Segment;
use crate::observe::observer::{Observer, Unobserved};
use crate::observe::quantity::Quantity;
use crate::observe::running_maximum::RunningMaximum;
use crate::response::{Extreme, Work};
use crate::settings::Window;
use crate::system::{Linear, LinearSystem};
use nalgebra::Complex;
use retune_model::{Coupled, SampledForce, Side};

/// A linear scene at a moment of its run.
pub struct ContactFree<'a, S, const N: usize> {
    system: &'a S,
    flow: Flow<N>,
    /// The flow in longer steps, where a part of the motion decays so fast that it can be left out.
    reduced: Option<Box<Reduced<N>>>,
    /// The sampled force, if the flow can step over its pieces.
    samples: Option<Pieces<N>>,
    now: Knot<N>,
    /// The longest step without samples, s.
    longest: f64,
    max_steps: u64,
    /// Work done so far.
    pub work: Work,
}

impl<'a, S: LinearSystem<N>, const N: usize> ContactFree<'a, S, N> {
    /// The scene at t = 0; no step will be longer than `longest` (s).
    pub fn new(system: &'a S, longest: f64, max_steps: u64) -> Self {
        let now = Knot { t: 0.0, excitation: system.excitation(0.0), y: system.start(), clock: [1.0, 0.0] };
        Self::with_samples(system.structure().sampled_force(), system, now, longest, max_steps)
    }

    /// The scene at a moment, with these samples of the force.
    fn with_samples(
        force: Option<SampledForce>,
        system: &'a S,
        now: Knot<N>,
        whole: f64,
        max_steps: u64,
    ) -> Self {
        let longest = longest_step(force, whole);
        let flow = Flow::new(system.linear(), longest);
        let samples = Pieces::of(force, &flow);
        let reduced = Reduced::of(&flow, longest).map(Box::new);
        Self { system, flow, reduced, samples, now, longest: whole, max_steps, work: Work::default() }
    }

    /// The scene in another state at another time, s.
    #[must_use]
    pub fn from(self, t: f64, y: [f64; N]) -> Self {
        Self { now: Knot { t, excitation: self.system.excitation(t), y, clock: [1.0, 0.0] }, ..self }
    }

    /// The state reached.
    pub fn state(&self) -> [f64; N] {
        self.now.y
    }

    /// Steps to time `to` (s), or until the observer is satisfied.
    ///
    /// # Errors
    /// [`SolverError::TooManySteps`], [`SolverError::TooSlow`], [`SolverError::TooFast`], [`SolverError::NonFinite`].
    pub fn propagate(
        &mut self,
        to: f64,
        observer: &mut (impl Observer<N> + ?Sized),
    ) -> Result<(), SolverError> {
        let budget = self.budget(to, observer.search_work());
        if self.system.structure().history().is_none() {
            return self.step_to(to, observer, budget);
        }
        loop {
            self.propagate_over_samples(to, observer, budget)?;
            let Some(stretch) = self.system.structure().stretch(self.now.t) else { return Ok(()) };
            if self.now.t >= to || observer.satisfied() {
                return Ok(());
            }
            self.now.excitation = self.system.structure().excitation_in(&stretch, self.now.t);
            if self.samples.is_some() && self.now.t >= self.system.structure().paced_until() {
                let free = Self::with_samples(None, self.system, self.now, self.longest, self.max_steps);
                *self = Self { work: self.work, ..free };
            }
            observer.discontinuity();
            self.step_to(stretch.to.min(to), observer, budget)?;
            if stretch.to >= to || observer.satisfied() {
                return Ok(());
            }
            self.now.t = stretch.to;
        }
    }

    /// Steps from a sample of a record over whole pieces of it, at most to time `to`.
    fn propagate_over_samples(
        &mut self,
        to: f64,
        observer: &mut (impl Observer<N> + ?Sized),
        budget: Budget,
    ) -> Result<(), SolverError> {
        let Some(pieces) = &self.samples else { return Ok(()) };
        let Some(mut i) = pieces.at(self.now.t) else { return Ok(()) };
        let growth = LANES as f64 * self.flow.step() * self.system.energy_norm_growth();
        // After a block that had to be observed piece by piece, the next one is tried at this sample.
        let mut next_block = i;
        loop {
            if i >= next_block {
                let growth = growth * (PIECES / LANES) as f64;
                let energy = self.system.energy_norm(&self.now.y) + growth;
                let block = Block::new(&self.flow, pieces, i, to, &self.now.y, energy);
                next_block = i + PIECES;
                if let Some(block) = block.filter(|block| observer.skips(block)) {
                    i = next_block;
                    self.work.steps += PIECES as u64;
                    (self.now.t, self.now.y) = (block.end, block.last());
                    budget.check(&self.work.with_search_work(observer.search_work()), self.now.t)?;
                    if !self.now.y.iter().all(|v| v.is_finite()) {
                        return Err(SolverError::NonFinite { t: self.now.t });
                    }
                    continue;
                }
            }
            let Some(four) = pieces.four(&self.flow, i, to, &self.now.y) else { break };
            let energy = self.system.energy_norm(&self.now.y) + growth;
            let steps = Steps::from_pieces(&self.flow, self.now, four, energy);
            observer.steps(&steps);
            self.now = steps.knot(LANES);
            i += LANES;
            self.work.steps += LANES as u64;
            budget.check(&self.work.with_search_work(observer.search_work()), self.now.t)?;
            if !self.now.y.iter().all(|v| v.is_finite()) {
                return Err(SolverError::NonFinite { t: self.now.t });
            }
            if observer.satisfied() {
                break;
            }
        }
        Ok(())
    }

    fn budget(&self, to: f64, search_work: u64) -> Budget {
        Budget::new(
            self.flow.pace(),
            self.max_steps,
            self.work.with_search_work(search_work),
            [self.now.t, to],
        )
    }

    fn step_to(
        &mut self,
        to: f64,
        observer: &mut (impl Observer<N> + ?Sized),
        budget: Budget,
    ) -> Result<(), SolverError> {
        self.flow.check_step(self.now.t, to)?;
        let whole = self.flow.step();
        let mut clock = StepClock::new(self.now.t, whole);
        while self.now.t < to && !observer.satisfied() {
            if self.reduced.is_some() && self.drop_fast_part() {
                return self.step_reduced_to(to, observer, budget);
            }
            let (now, remaining) = (self.now, to - self.now.t);
            let energy =
                self.system.energy_norm(&now.y) + LANES as f64 * whole * self.system.energy_norm_growth();
            let mut steps = Steps::new(&self.flow, now, clock, energy);
            steps.keep((remaining / whole) as usize);
            if steps.count() > 0 {
                observer.steps(&steps);
                self.now = steps.knot(steps.count());
                clock.count(steps.count());
            } else {
                let motion = self.flow.expand(now.excitation, &now.y);
                let mut step = Step::part(&self.flow, now, &motion, remaining, energy);
                step.end().t = to;
                observer.segment(&step);
                self.now = *step.ends()[1];
            }
            self.work.steps += steps.count().max(1) as u64;
            budget.check(&self.work.with_search_work(observer.search_work()), now.t)?;
            if !self.now.y.iter().all(|v| v.is_finite()) {
                return Err(SolverError::NonFinite { t: now.t });
            }
        }
        Ok(())
    }

    /// Leaves out the fast part of the motion if it has decayed; returns whether it has.
    #[cold]
    fn drop_fast_part(&mut self) -> bool {
        let y = self.reduced.as_deref().and_then(|reduced| reduced.without_transient(&self.now));
        self.now.y = y.unwrap_or(self.now.y);
        y.is_some()
    }

    /// [`Self::step_to`] in longer steps, from a moment at which the fast part of the motion has decayed.
    #[cold]
    fn step_reduced_to(
        &mut self,
        to: f64,
        observer: &mut (impl Observer<N> + ?Sized),
        budget: Budget,
    ) -> Result<(), SolverError> {
        let Some(Reduced { flow, .. }) = self.reduced.as_deref() else { return Ok(()) };
        let growth = flow.step() * self.system.energy_norm_growth();
        let mut clock = StepClock::new(self.now.t, flow.step());
        observer.discontinuity();
        while self.now.t < to && !observer.satisfied() {
            let (now, length) = (self.now, flow.step().min(to - self.now.t));
            let motion = flow.expand(now.excitation, &now.y);
            let mut step = Step::part(flow, now, &motion, length, self.system.energy_norm(&now.y) + growth);
            step.end().t = if length < flow.step() { to } else { clock.after(1) };
            observer.segment(&step);
            self.now = *step.ends()[1];
            clock.count(1);
            self.work.steps += 1;
            budget.check(&self.work.with_search_work(observer.search_work()), now.t)?;
            if !self.now.y.iter().all(|v| v.is_finite()) {
                return Err(SolverError::NonFinite { t: now.t });
            }
        }
        Ok(())
    }

    /// Advances to time `to` (s) unobserved: the transient by repeated squaring, the steady motion by its phase; step by step where
    /// there is no steady motion.
    fn advance_unobserved(&mut self, to: f64) -> Result<(), SolverError> {
        let whole = ((to - self.now.t) / self.flow.step()).floor();
        let Some(steady) = self.system.steady() else {
            return self.propagate(to, &mut Unobserved);
        };
        if whole >= 2.0 && whole < u64::MAX as f64 {
            let transient = difference(&self.now.y, &steady_state(self.flow.linear(), &steady, self.now.t));
            let t = self.now.t + whole * self.flow.step();
            let y =
                sum(&steady_state(self.flow.linear(), &steady, t), &self.flow.decay(whole as u64, transient));
            self.now = Knot { t, excitation: self.system.excitation(t), y, clock: [1.0, 0.0] };
        }
        self.propagate(to, &mut Unobserved)
    }

    /// Largest energy of the primary structure over the window; it ends early once `cutoff` is exceeded, or once the steady motion with the
    /// remaining transient can no longer reach the largest value so far: `√E1 <= √E1_steady + |transient| / √2`.
    ///
    /// # Errors
    /// As [`Self::propagate`].
    pub fn e1_max<Q>(
        &mut self,
        window: Window,
        mut maximum: RunningMaximum<Q>,
        steady_e1: f64,
    ) -> Result<Extreme, SolverError>
    where
        Q: Quantity<N>,
    {
        /// Steps between checks of the bound.
        const STRIDE: f64 = 64.0;
        // The maximum is often that of the steady motion: with it known first, most of the search can be skipped.
        let (start, last) = (self.now, window.to - std::f64::consts::PI / self.flow.linear().frequency);
        if self.system.steady().is_some() && window.from < last {
            self.advance_unobserved(last)?;
            self.propagate(window.to, &mut maximum)?;
            self.now = start;
        }
        self.advance_unobserved(window.from)?;
        let budget = self.budget(window.to, 0);
        while self.now.t < window.to && !Observer::<N>::satisfied(&maximum) {
            let step = self.reduced.as_deref().map_or(self.flow.step(), |reduced| reduced.flow.step());
            let to = window.to.min(self.now.t + STRIDE * step);
            if to <= self.now.t {
                // Late in a run a step may be shorter than the spacing of floating-point numbers there.
                return Err(self.flow.too_fast(self.now.t));
            }
            self.step_to(to, &mut maximum, budget)?;
            let transient = transient(self.system, self.now.t, &self.now.y);
            let bound = (steady_e1.sqrt() + transient * std::f64::consts::FRAC_1_SQRT_2).powi(2);
            if bound <= maximum.record().value {
                break;
            }
        }
        Ok(maximum.record())
    }
}

/// Whether a damper provably stays off both walls from its start on: `|r - D| <= |X2 - X1| + |row of r| |transient|`.
pub fn clears_walls(system: &Coupled) -> bool {
    let reach = system.steady(system.bare().frequency()).stroke()
        + system.dual_energy_norm(&[-1.0, 0.0, 1.0, 0.0])
            * transient(system, 0.0, &LinearSystem::start(system));
    let rest = system.rest_distance();
    reach < rest - system.wall(Side::Primary) && reach < system.wall(Side::Obstacle) - rest
}

/// Energy norm of the transient of a motion, √J; infinite where there is no steady motion.
fn transient<S: LinearSystem<N>, const N: usize>(system: &S, t: f64, y: &[f64; N]) -> f64 {
    let Some(steady) = system.steady() else { return f64::INFINITY };
    let linear = system.linear();
    let transient = difference(y, &steady_state(&linear, &steady, t));
    system.energy_norm(&sum(&linear.origin, &transient))
}

fn difference<const N: usize>(a: &[f64; N], b: &[f64; N]) -> [f64; N] {
    std::array::from_fn(|i| a[i] - b[i])
}

fn sum<const N: usize>(a: &[f64; N], b: &[f64; N]) -> [f64; N] {
    std::array::from_fn(|i| a[i] + b[i])
}

/// The steady motion at time `t`: `origin + Re(Y e^{iωt})`.
fn steady_state<const N: usize>(linear: &Linear<N>, amplitudes: &[Complex<f64>; N], t: f64) -> [f64; N] {
    let turn = Complex::from_polar(1.0, linear.frequency * t);
    std::array::from_fn(|i| linear.origin[i] + (amplitudes[i] * turn).re)
}

#[cfg(test)]
mod tests {
    use super::*;
    use retune_model::{Bare, Forcing, NonNegative, Positive, Primary};

    /// Compares every state with the energy bound that is passed on with it.
    struct Energies<'a> {
        system: &'a Bare,
        steps: usize,
    }

    impl Observer<2> for Energies<'_> {
        fn segment(&mut self, _segment: &dyn Segment<2>) {}
        fn steps(&mut self, steps: &Steps<'_, 2>) {
            for number in 0..=steps.count() {
                let norm = LinearSystem::energy_norm(self.system, &steps.knot(number).y);
                assert!(norm <= steps.energy(), "{norm} {}", steps.energy());
                self.steps += 1;
            }
        }
    }

    #[test]
    fn invariant_no_step_has_more_energy_than_its_bound() {
        let number = |value| NonNegative::new(value).expect("not below 0");
        let mass = Positive::new(1000.0).expect("above 0");
        // Slow: a step takes 4 s.
        let primary = Primary { mass, damping: number(1.0), stiffness: number(40.0) };
        let forcing = Forcing::force(number(800.0), number(0.3));
        let system = Bare::new(&primary, &forcing);
        let mut seen = Energies { system: &system, steps: 0 };
        ContactFree::new(&system, 1000.0, 100_000).propagate(1000.0, &mut seen).expect("a run");
        assert!(seen.steps > 50, "{}", seen.steps);
    }
}
