//! Whole steps of an exact flow, a few of them side by side, as they are handed to observers.

use crate::flow::{Expansion, Flow, LANES, Stride};
use crate::observe::{Knot, Segment};
use std::cell::OnceCell;
use wide::f64x4;

/// An exact step, or the first part of one.
pub struct Step<'a, const N: usize> {
    flow: &'a Flow<N>,
    ends: [Knot<N>; 2],
    length: f64,
    expansion: OnceCell<Expansion<N>>,
}

impl<'a, const N: usize> Step<'a, N> {
    /// The step between two moments a whole step apart.
    pub fn whole(flow: &'a Flow<N>, ends: [Knot<N>; 2]) -> Self {
        Self { flow, ends, length: flow.step(), expansion: OnceCell::new() }
    }

    /// The part of a step that takes `length` seconds from `from` on, where the motion is `motion`.
    pub fn part(flow: &'a Flow<N>, from: Knot<N>, motion: &Expansion<N>, length: f64) -> Self {
        let end = moment(flow, &from, motion, length);
        Self { flow, ends: [from, end], length, expansion: OnceCell::new() }
    }

    /// Its last moment, to be put right where more is known of it than arithmetic tells.
    pub fn end(&mut self) -> &mut Knot<N> {
        &mut self.ends[1]
    }
}

impl<const N: usize> Segment<N> for Step<'_, N> {
    fn ends(&self) -> [&Knot<N>; 2] {
        self.ends.each_ref()
    }
    fn length(&self) -> f64 {
        self.length
    }
    fn at(&self, theta: f64) -> Knot<N> {
        let from = &self.ends[0];
        let expansion = self.expansion.get_or_init(|| self.flow.expand(from.drive, &from.y));
        moment(self.flow, from, expansion, theta)
    }
    fn at_time(&self, t: f64) -> Knot<N> {
        Knot { t, ..self.at(t - self.ends[0].t) }
    }
}

/// The moment `s` seconds after `from`.
fn moment<const N: usize>(flow: &Flow<N>, from: &Knot<N>, motion: &Expansion<N>, s: f64) -> Knot<N> {
    Knot { t: from.t + s, drive: flow.drive_after(from.drive, s), y: motion.at(s), clock: [1.0, 0.0] }
}

/// The lanes moved on by one, `first` before them.
#[inline(always)]
pub(crate) fn shifted(first: f64, lanes: f64x4) -> f64x4 {
    let [a, b, c, _] = lanes.to_array();
    f64x4::from([first, a, b, c])
}

/// Up to [`LANES`] whole steps.
pub struct Steps<'a, const N: usize> {
    flow: &'a Flow<N>,
    clock: StepClock,
    from: Knot<N>,
    stride: Stride<N>,
    count: usize,
}

/// Time in whole steps since a moment: counted, not accumulated.
#[derive(Clone, Copy)]
pub struct StepClock {
    since: f64,
    step: f64,
    steps: f64,
}

impl StepClock {
    /// Starts at `since` (s) to count steps of `step` seconds.
    pub fn new(since: f64, step: f64) -> Self {
        Self { since, step, steps: 0.0 }
    }

    /// Time `steps` steps later, s.
    #[inline(always)]
    pub fn after(&self, steps: usize) -> f64 {
        self.since + (self.steps + steps as f64) * self.step
    }

    /// Counts some steps.
    pub fn count(&mut self, steps: usize) {
        self.steps += steps as f64;
    }
}

impl<'a, const N: usize> Steps<'a, N> {
    /// As many steps as there are lanes, from a moment on, at which `clock` stands.
    #[inline(always)]
    pub fn new(flow: &'a Flow<N>, from: Knot<N>, clock: StepClock) -> Self {
        Self { flow, clock, from, stride: flow.stride(from.drive, &from.y), count: LANES }
    }

    /// Keeps the first `count` of them.
    pub fn keep(&mut self, count: usize) {
        self.count = count.min(LANES);
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Length of each, s.
    pub fn length(&self) -> f64 {
        self.flow.step()
    }

    /// How little a quantity varies over a step, see [`Flow::fineness`].
    pub fn fineness(&self) -> f64 {
        self.flow.fineness()
    }

    /// The moment at which the first begins.
    pub fn from(&self) -> &Knot<N> {
        &self.from
    }

    /// The moments at which they end, side by side, also those of steps that were not kept.
    pub fn ends(&self) -> &Stride<N> {
        &self.stride
    }

    /// Time at the end of `steps` of them, s.
    pub fn time(&self, steps: usize) -> f64 {
        self.clock.after(steps)
    }

    /// The moment after `steps` of them.
    #[inline(always)]
    pub fn knot(&self, steps: usize) -> Knot<N> {
        match steps.checked_sub(1) {
            None => self.from,
            Some(lane) => Knot {
                t: self.time(steps),
                drive: self.stride.drive.map(|component| component.to_array()[lane]),
                y: self.stride.y.map(|component| component.to_array()[lane]),
                clock: [1.0, 0.0],
            },
        }
    }

    /// One of them.
    pub fn step(&self, number: usize) -> Step<'a, N> {
        Step::whole(self.flow, [self.knot(number), self.knot(number + 1)])
    }
}
