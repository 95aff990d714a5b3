//! Steps of the exact flow, several of them side by side, as they are passed to observers.

use super::flow::{Expansion, Flow, FourPieces, Stride};
use crate::motion::form::{Form, QUINTIC};
use crate::motion::knot::{Jet, Knot};
use crate::motion::lanes::LANES;
use crate::motion::segment::Segment;
use std::cell::OnceCell;
use wide::f64x4;

/// An exact step, or the first part of one.
pub struct Step<'a, const N: usize> {
    flow: &'a Flow<N>,
    ends: [Knot<N>; 2],
    length: f64,
    energy: f64,
    expansion: OnceCell<Expansion<N>>,
}

impl<'a, const N: usize> Step<'a, N> {
    /// The step between two moments `length` seconds apart, at most a whole step; `energy` bounds the energy norm (√J) of the motion in it.
    pub fn between(flow: &'a Flow<N>, ends: [Knot<N>; 2], length: f64, energy: f64) -> Self {
        Self { flow, ends, length, energy, expansion: OnceCell::new() }
    }

    /// The part of a step that takes `length` seconds from `from` on, where the motion is `motion`; `energy` as in [`Self::between`].
    pub fn part(flow: &'a Flow<N>, from: Knot<N>, motion: &Expansion<N>, length: f64, energy: f64) -> Self {
        let end = moment(flow, &from, motion, length);
        Self::between(flow, [from, end], length, energy)
    }

    /// The motion over the step.
    fn expansion(&self) -> &Expansion<N> {
        let from = &self.ends[0];
        self.expansion.get_or_init(|| self.flow.expand(from.excitation, &from.y))
    }

    /// Its last moment, to be corrected where it is known better than by arithmetic (at a wall, at the end of the run).
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
        moment(self.flow, &self.ends[0], self.expansion(), theta)
    }
    fn at_time(&self, t: f64) -> Knot<N> {
        Knot { t, ..self.at(t - self.ends[0].t) }
    }
    fn in_flight(&self) -> bool {
        true
    }
    fn jet(&self, at: &Knot<N>) -> Option<Jet<N>> {
        self.flow.is_reduced().then(|| self.flow.jet(at.excitation, &at.y))
    }
    /// From the energy of the motion; the sharp bound is from its Taylor polynomial over the step. The bound by the energy includes all
    /// rates, also those of a part that has decayed.
    fn quintic_error(&self, form: &Form<N>, _ends: [&Knot<N>; 2], h: f64, sharp: bool) -> Option<f64> {
        Some(if sharp || self.flow.is_reduced() {
            form.quintic_error(&self.expansion().0, self.length) * (h / self.length).powi(6)
        } else {
            QUINTIC * h.powi(6) * form.sixth_in_flight(self.energy)
        })
    }
}

/// The moment `s` seconds after `from`.
fn moment<const N: usize>(flow: &Flow<N>, from: &Knot<N>, motion: &Expansion<N>, s: f64) -> Knot<N> {
    Knot {
        t: from.t + s,
        excitation: flow.excitation_after(from.excitation, s),
        y: motion.at(s),
        clock: [1.0, 0.0],
    }
}

/// Up to four steps: whole ones, or pieces of a record.
pub struct Steps<'a, const N: usize> {
    flow: &'a Flow<N>,
    from: Knot<N>,
    /// Their durations and end times, s.
    lengths: f64x4,
    times: f64x4,
    stride: Stride<N>,
    /// The force at the beginning of each, where it differs from that at the end of the step before.
    begin: Option<[f64x4; 2]>,
    count: usize,
    energy: f64,
}

/// A clock that counts whole steps since a moment instead of accumulating time.
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

    /// Times after 1, 2, … steps, s.
    #[inline(always)]
    fn after_each(&self) -> f64x4 {
        (f64x4::from([1.0, 2.0, 3.0, 4.0]) + self.steps) * self.step + self.since
    }

    /// Advances by some steps.
    pub fn count(&mut self, steps: usize) {
        self.steps += steps as f64;
    }
}

impl<'a, const N: usize> Steps<'a, N> {
    /// The next four steps from the moment `from`, the time of `clock`; `energy` bounds the energy norm (√J) of the motion in
    /// all of them.
    #[inline(always)]
    pub fn new(flow: &'a Flow<N>, from: Knot<N>, clock: StepClock, energy: f64) -> Self {
        let (lengths, times) = (flow.step().into(), clock.after_each());
        let stride = flow.stride(from.excitation, &from.y);
        Self { flow, from, lengths, times, stride, begin: None, count: LANES, energy }
    }

    /// Pieces of a record as steps, the first of which begins at `from`.
    #[inline(always)]
    pub fn from_pieces(flow: &'a Flow<N>, mut from: Knot<N>, pieces: FourPieces<N>, energy: f64) -> Self {
        let FourPieces { lengths, times, begin, ends: stride } = pieces;
        from.excitation = begin.map(|lanes| lanes.to_array()[0]);
        Self { flow, from, lengths, times, stride, begin: Some(begin), count: LANES, energy }
    }

    /// The force at the beginning of each, where its slope jumps between them.
    #[inline(always)]
    pub fn begin(&self) -> Option<&[f64x4; 2]> {
        self.begin.as_ref()
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
    pub fn lengths(&self) -> f64x4 {
        self.lengths
    }

    /// A bound on the energy norm of the motion, √J.
    pub fn energy(&self) -> f64 {
        self.energy
    }

    /// The moment at which the first begins.
    pub fn from(&self) -> &Knot<N> {
        &self.from
    }

    /// The moments at which they end, side by side, including those of steps that were not kept.
    pub fn ends(&self) -> &Stride<N> {
        &self.stride
    }

    /// Time at the end of `steps` of them, s.
    pub fn time(&self, steps: usize) -> f64 {
        steps.checked_sub(1).map_or(self.from.t, |lane| self.times.to_array()[lane])
    }

    /// The moment after `steps` of them.
    #[inline(always)]
    pub fn knot(&self, steps: usize) -> Knot<N> {
        match steps.checked_sub(1) {
            None => self.from,
            Some(lane) => Knot {
                t: self.time(steps),
                excitation: self.stride.excitation.map(|component| component.to_array()[lane]),
                y: self.stride.y.map(|component| component.to_array()[lane]),
                clock: [1.0, 0.0],
            },
        }
    }

    /// One of them.
    pub fn step(&self, number: usize) -> Step<'a, N> {
        let mut first = self.knot(number);
        if let Some(begin) = self.begin {
            first.excitation = begin.map(|lanes| lanes.to_array()[number]);
        }
        let length = self.lengths.to_array()[number];
        Step::between(self.flow, [first, self.knot(number + 1)], length, self.energy)
    }
}
