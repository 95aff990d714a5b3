//! Proven bounds on the derivatives of the motion during a contact, from the equations with every term replaced by its size.

mod change;
mod stages;

use super::{RegularisedContact, RegularisedState};
pub use change::{Change, Forces};
pub(super) use stages::product;
use stages::{StageSeries, Stages};

/// Orders of the derivatives that are bounded, 0 to 6.
pub const ORDERS: usize = 7;

/// Bounds on Taylor coefficients, `|u⁽ᵏ⁾| / k!` for `k = 0, 1, …`, of the four numbers that the motion in contact consists of: `x1`,
/// `v1`, the spring's stretch `z + s (wall - D)` towards the wall and the speed `w = dz/dt` into it.
pub type Growth<const K: usize> = [[f64; K]; 4];

/// Bounds over a whole contact, of the four numbers of [`Growth`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OverContact {
    /// Their sizes, m and m/s.
    pub most: [f64; 4],
    /// Sizes of their rates by all forces but Hertz's, m/s and m/s².
    pub beside: [f64; 4],
    /// `∫ κ q³ dt`, m/s: Hertz's impulse.
    pub impulse: f64,
    /// `q`, √m.
    depth: f64,
    /// A lower bound on v of a restitution that is the same at every speed, m/s; of use only if positive.
    slowest: f64,
    /// Duration of the contact, s.
    pub duration: f64,
    /// What the force adds to the acceleration of the structure, m/s².
    excitation: f64,
}

/// Series with every term replaced by its size: of the numbers of [`Growth`], of `a1` and of `dw/dt`.
struct Series<const K: usize> {
    growth: Growth<K>,
    a1: [f64; K],
    rate: [f64; K],
}

/// Bounds on a piece of a contact.
#[derive(Clone, Copy)]
struct Bounds<'a> {
    /// On the sizes of `[q, w, x1, v1]`.
    state: [f64; 4],
    /// The least q, where the speed into the wall follows the forces.
    shallowest: f64,
    /// On the sizes of `a1` and `dw/dt`, where known better than by the sizes of the forces, which balance where a wall holds the damper.
    rates: [f64; 2],
    /// On the force, N.
    force: f64,
    /// On the stages of a restitution that is the same at every speed.
    stages: Option<Stages<'a>>,
}

impl RegularisedContact {
    /// Bounds between two states `h` (s/√m) apart; `None` if the piece is too long for the proof.
    pub fn change(&self, h: f64, ends: [&RegularisedState; 2]) -> Option<Change> {
        if !self.overdamped {
            let ends = ends.map(|y| self.end(y));
            return self.change_by_rates(h, &ends).or_else(|| self.change_by_energy(h, &ends));
        }
        let bounds = self.bounds_if_following(h, ends)?;
        let Series { growth, a1, rate, .. } = self.series::<2, true>(bounds);
        let within = |[most, slope]: [f64; 2]| [most, 0.5 * h * slope];
        Some(Change {
            states: growth.map(within),
            rates: [growth[1], a1, growth[3], rate].map(within),
            root: within([bounds.state[0], 0.5 * bounds.state[1]]),
            forces: None,
        })
    }

    /// Bounds on the Taylor coefficients in `θ` anywhere on a piece of the contact, from its [`Self::change`]; infinite if it is too long
    /// for the proof. In the box of the change each coefficient follows from those before it by the equations, with all terms taken as
    /// positive.
    pub fn growth(&self, ends: [&RegularisedState; 2], change: &Option<Change>) -> Growth<ORDERS> {
        let series = |change| self.series::<ORDERS, false>(self.bounds_within(change, ends)).growth;
        change.as_ref().map_or([[f64::INFINITY; ORDERS]; 4], series)
    }

    /// [`Self::growth`], and such bounds on the rates of its four numbers in *time*: `v1`, `a1`, `w` and `dw/dt`.
    pub fn growth_of_rates(
        &self,
        ends: [&RegularisedState; 2],
        change: &Option<Change>,
    ) -> [Growth<ORDERS>; 2] {
        let Some(change) = change else {
            return [[[f64::INFINITY; ORDERS]; 4]; 2];
        };
        let Series { growth, a1, rate, .. } = self.series::<ORDERS, true>(self.bounds_within(change, ends));
        let [_, v1, _, w] = growth;
        [growth, [v1, a1, w, rate]]
    }

    /// Bounds on a piece from its [`Change`].
    fn bounds_within(&self, change: &Change, [from, to]: [&RegularisedState; 2]) -> Bounds<'_> {
        let [[x1, _], [v1, _], _, [w, of_w]] = change.states;
        let [_, [a1, _], _, [rate, _]] = change.rates;
        let [q, of_q] = change.root;
        let shallowest = (from[0].min(to[0]) - of_q).max(0.0);
        let speeds = [(from[1].min(to[1]) - of_w).max(-w), (from[1].max(to[1]) + of_w).min(w)];
        let stages = self
            .restoring
            .as_deref()
            .map(|law| Stages::between(law, [shallowest, q].map(|q| self.half_square(q)), speeds));
        Bounds { state: [q, w, x1, v1], shallowest, rates: [a1, rate], force: self.amplitude, stages }
    }

    /// Bounds on a piece in which the speed follows the forces; `None` if it is too long for the proof.
    fn bounds_if_following(&self, h: f64, [from, to]: [&RegularisedState; 2]) -> Option<Bounds<'_>> {
        let ends: [f64; 4] = std::array::from_fn(|i| from[i].abs().max(to[i].abs()));
        let shallowest = from[0].min(to[0]);
        let force = self.amplitude;
        let mut bounds = Bounds { state: ends, shallowest, rates: [f64::INFINITY; 2], force, stages: None };
        let mut farther = [f64::INFINITY; 2];
        for _ in 0..8 {
            let series = self.series::<2, false>(bounds);
            let [x1, v1, _, w] = series.growth;
            let slopes = [0.5 * bounds.state[1], w[1], x1[1], v1[1]];
            let reach: [f64; 4] = std::array::from_fn(|i| ends[i] + 0.5 * h * slopes[i]);
            let least = shallowest - 0.5 * h * slopes[0];
            let away = least >= bounds.shallowest;
            if away && (0..4).all(|i| reach[i] <= bounds.state[i]) {
                return Some(bounds);
            }
            if !away {
                bounds.shallowest = least - 0.05 * (shallowest - least);
                if bounds.shallowest <= 0.0 {
                    return None;
                }
            }
            // Once the increments grow, the iteration diverges.
            let by = [0, 1].map(|i| reach[i] - bounds.state[i]);
            if by[0] > farther[0] && by[1] > farther[1] {
                break;
            }
            farther = by;
            for i in 0..4 {
                bounds.state[i] = bounds.state[i].max(1.05 * reach[i]);
            }
        }
        None
    }

    /// The series that follow from bounds on a piece; those of the accelerations to the last order only `IF_RATES`.
    fn series<const K: usize, const IF_RATES: bool>(&self, bounds: Bounds<'_>) -> Series<K> {
        let [q0, w0, x0, v0] = bounds.state;
        let start = |bound: f64| {
            let mut series = [0.0; K];
            series[0] = bound;
            series
        };
        let [mut q, mut w, mut x1, mut v1] = [q0, w0, x0, v0].map(start);
        let is_linear = self.is_linear();
        let mut excitation = start(bounds.force);
        let (mut z, mut stretch, mut cube, mut force) = ([0.0; K], [0.0; K], [0.0; K], [0.0; K]);
        let (mut rate, mut a1) = ([0.0; K], [0.0; K]);
        let [mut faster, mut jerk, mut by_q] = [[0.0; K]; 3]; // w'' and a1', in time; 1/q
        let mut stages = bounds.stages.map(StageSeries::new);
        for k in 0..K {
            z[k] = product(&q, &q, k);
            cube[k] = product(&z, &q, k);
            force[k] = match &stages {
                Some(stages) => product(&cube, &stages.f, k),
                None if self.law[1] != 0.0 => self.law[0] * cube[k] + self.law[1] * product(&cube, &w, k),
                None => self.law[0] * cube[k],
            };
            stretch[k] = z[k] + if k == 0 { self.stretch.abs() } else { 0.0 };
            if self.overdamped {
                by_q[k] = match k {
                    0 => 1.0 / bounds.shallowest,
                    _ => by_q[0] * (1..=k).map(|i| q[i] * by_q[k - i]).sum::<f64>(),
                };
                let parts = [cube[k], stretch[k], self.primary[0] * excitation[k]];
                let speed = [&mut w, &mut rate, &mut faster];
                self.follow(k, parts, [&q, &x1, &v1, &by_q], speed, [&mut a1, &mut jerk]);
                w[0] = w[0].min(w0);
            }
            if k + 1 == K && !IF_RATES {
                break;
            }
            let outside = self.primary[0] * excitation[k] + self.primary[1] * v1[k] + self.primary[2] * x1[k];
            let push =
                |i: usize| self.hertz[i] * force[k] + self.dashpot[i] * w[k] + self.spring[i] * stretch[k];
            // A force that accelerates both bodies alike is not felt between them.
            let apart =
                if self.felt == 0.0 { self.primary[1] * v1[k] + self.primary[2] * x1[k] } else { outside };
            if !self.overdamped {
                (a1[k], rate[k]) = (outside + push(0), apart + push(1));
            }
            let beside = rate[k] - self.hertz[1] * force[k];
            if k == 0 {
                (a1[0], rate[0]) = (a1[0].min(bounds.rates[0]), rate[0].min(bounds.rates[1]));
            }
            if k + 1 == K {
                break;
            }
            let next = 1.0 / (k + 1) as f64;
            let turned =
                if is_linear { self.force[1] * q[k] } else { self.omega * product(&q, &excitation, k) };
            let along = product(&q, &v1, k);
            (x1[k + 1], excitation[k + 1]) = (along * next, turned * next);
            (v1[k + 1], w[k + 1]) = (product(&q, &a1, k) * next, product(&q, &rate, k) * next);
            q[k + 1] = 0.5 * w[k] * next;
            if let Some(stages) = &mut stages {
                stages.extend(k, &q, self.hertz[1] * cube[k], [beside, rate[k]]);
            }
        }
        Series { growth: [x1, v1, stretch, w], a1, rate }
    }

    /// Bounds over a whole contact of `duration` seconds that begins at `touch` (`q = 0`); `None` if forces other than Hertz's may
    /// change its speed too much for the proof. `q0` is the [`greatest depth`](Self::greatest_depth) of an undisturbed collision at its
    /// touch-down speed, √m, `amplitude` that of the force, N.
    ///
    /// Let `G` bound the acceleration into the wall by all forces but Hertz's. Then `|w| <= ŵ = w0 + 2 G t`, as
    /// `w² + (4/5) κ q⁵ = w0² + 2 ∫ g w dt <= w0² + 2 G t ŵ <= ŵ²`; so `q` stays below the greatest depth at
    /// `ŵ`, which is `q0 (ŵ/w0)^0.4`, and Hertz's impulse below `w0 + ŵ + G t`. The change of `v1` follows from that. The speeds are
    /// guessed first, and the proof holds if the bounds confirm the guess.
    ///
    /// A loss only removes energy, so all this still holds. With the same restitution at every speed `w = v h` with `|h| <= 1` and
    /// `dv/dt = A h / D`, where `|h|/D <= 1/e` (for `|h| > e` as `D >= h²`, else as `D >= e²`): v stays within `G t / e` of w0.
    pub fn over_contact(
        &self,
        touch: &RegularisedState,
        q0: f64,
        duration: f64,
        amplitude: f64,
    ) -> Option<OverContact> {
        let [w0, x1, v1] = [touch[1], touch[2], touch[3]].map(f64::abs);
        let share = self.hertz[0] / self.hertz[1];
        let depth = |w: f64| q0 * (1.0 + 0.4 * (w / w0 - 1.0)); // a tangent of the power, which is concave
        let excitation = self.primary[0] * amplitude;
        let within = |[w, v]: [f64; 2]| {
            let most = [x1 + duration * v, v, depth(w).powi(2) + self.stretch.abs(), w];
            let outside = |excitation: f64| excitation + self.primary[1] * v + self.primary[2] * most[0];
            let felt = if self.felt == 0.0 { 0.0 } else { excitation };
            let [on_primary, apart] = [(0, excitation), (1, felt)]
                .map(|(i, force)| outside(force) + self.dashpot[i] * w + self.spring[i] * most[2]);
            (most, [v, on_primary, w, apart])
        };
        let impulse = |w: f64, apart: f64| w0 + w + apart * duration;
        let implied = |guess: [f64; 2]| {
            let (_, [_, on_primary, _, apart]) = within(guess);
            let reached = w0 + 2.0 * apart * duration;
            [reached, v1 + share * impulse(reached, apart) + on_primary * duration]
        };
        let mut guess = [1.5 * w0, v1 + 3.0 * w0];
        let mut speeds = implied(guess);
        for _ in 0..3 {
            if speeds[0] <= guess[0] && speeds[1] <= guess[1] {
                break;
            }
            guess = speeds.map(|bound| 1.5 * bound);
            speeds = implied(guess);
        }
        let [w, v] = speeds;
        // NaN is no proof.
        if !(w <= guess[0] && v <= guess[1]) {
            return None;
        }
        let (most, beside) = within(speeds);
        let impulse = impulse(w, beside[3]);
        let slowest = self.restoring.as_ref().map_or(w0, |law| w0 - beside[3] * duration / law.restitution());
        Some(OverContact { most, beside, impulse, depth: depth(w), slowest, duration, excitation })
    }

    /// Bounds on the first Taylor coefficients in *time* over a whole contact. `q |w|` is at most `max u √(1 - u⁵) = 0.658` times the
    /// bounds on both. The factor f of a loss changes at the rate `χ dh/dt`, `dh/dt = f/v (-κ q³ + 2 A G / D)`, and `2 f G <= D`; that of Hunt
    /// and Crossley at `λ dw/dt`.
    pub fn growth_over_contact(&self, over: &OverContact) -> Growth<3> {
        let ([x, v, stretch, w], [_, on_primary, _, apart], q) = (over.most, over.beside, over.depth);
        let (mut cube, mut cube_rate) = (q * q * q, 1.5 * 0.658 * q * w);
        if self.is_lossy() {
            let most = self.most(w);
            let turns = match &self.restoring {
                None => self.lambda,
                Some(law) if over.slowest > 0.0 => law.chi / over.slowest,
                Some(_) => f64::INFINITY,
            };
            let turn = turns * (most * self.hertz[1] * cube + apart);
            (cube, cube_rate) = (most * cube, most * cube_rate + cube * turn);
        }
        let (a1, rate) = (on_primary + self.hertz[0] * cube, apart + self.hertz[1] * cube);
        let forced =
            if self.is_linear() { self.primary[0] * self.force[1] } else { self.omega * over.excitation };
        let jerk = |i: usize| {
            let forced = if i == 1 && self.felt == 0.0 { 0.0 } else { forced };
            let turning = forced + self.primary[1] * a1 + self.primary[2] * v;
            turning + self.dashpot[i] * rate + self.spring[i] * w + self.hertz[i] * cube_rate
        };
        [[x, v, 0.5 * a1], [v, a1, 0.5 * jerk(0)], [stretch, w, 0.5 * rate], [w, rate, 0.5 * jerk(1)]]
    }
}
