//! Bounds on how far a contact may go between two states. They hold even where the slope of a loss is unbounded.

use super::stages::Stages;
use crate::regularised::{RegularisedContact, RegularisedState};

/// Bounds between two states: of each quantity the largest size, and the largest deviation from its value at the nearer state.
#[derive(Clone, Copy, Debug)]
pub struct Change {
    /// Of the four numbers of [`Growth`](super::Growth), m and m/s.
    pub states: [[f64; 2]; 4],
    /// Of their rates in time, m/s and m/s².
    pub rates: [[f64; 2]; 4],
    /// Of `q = dt/dθ`, √m.
    pub root: [f64; 2],
    /// Of the forces; `None` where the speed into the wall follows them, since they cancel then.
    pub forces: Option<Forces>,
}

/// The forces between two states.
#[derive(Clone, Copy, Debug)]
pub struct Forces {
    /// As in [`Change`], of the contact's force over its stiffness: `q³` times the factor of a loss, m^1.5.
    pub contact: [f64; 2],
    /// By how much the external force may differ from that at the nearer state, as a share of the bound on it.
    pub turn: f64,
    /// The rate of `[x1, v1, x2, v2]` per unit of `contact`, zero but for both speeds, m^-0.5 s^-2.
    pub kick: [f64; 4],
}

/// One of the two states, with its contact force and rates.
pub(super) struct End {
    y: RegularisedState,
    /// `q³` times the factor of a loss.
    contact: f64,
    /// Of `v1` and `w`, m/s².
    rates: [f64; 2],
}

/// The largest deviations of a piece from the nearer state.
struct Excursion {
    /// Half of its duration, s.
    half: f64,
    /// Of `[q, w, x1, v1]`.
    numbers: [f64; 4],
    /// Of the spring's stretch, m.
    stretch: f64,
    /// Of `q³` times the factor of a loss.
    contact: f64,
}

/// The square of half the angle (rad) by which spring and wall turn the damper in a piece, beyond which
/// [`RegularisedContact::change_by_rates`] makes two guesses at most. Measured: few are confirmed there, and bounds by energy cost less
/// than more guesses.
const FAR: f64 = 0.3;

/// The greater of two numbers, NaN if one of them is.
fn greater(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

/// The largest sizes of `[q, w, x1, v1]` and of both rates at two states.
fn largest([a, b]: &[End; 2]) -> ([f64; 4], [f64; 2]) {
    let numbers = std::array::from_fn(|i| a.y[i].abs().max(b.y[i].abs()));
    (numbers, std::array::from_fn(|i| a.rates[i].abs().max(b.rates[i].abs())))
}

impl RegularisedContact {
    /// The [`End`] at a state.
    pub(super) fn end(&self, y: &RegularisedState) -> End {
        let contact = self.contact_over_stiffness(y);
        let [rate, a1] = self.accelerations_by(contact, y);
        End { y: *y, contact, rates: [a1, rate] }
    }

    /// [`Self::change`] of a contact that is not overdamped, by bounds on its rates.
    ///
    /// As long as no number deviates from the nearer state by more than a guess, the guess also bounds how far each rate deviates from the
    /// rate there. The proof holds if these rates do not lead beyond the guess in `h/2`. The factor of a loss is a function of `q` and `w`,
    /// monotone in both where `w` has one sign, so its range follows from corners. Its slope, unbounded where `v` vanishes, is not needed.
    ///
    /// Where spring and wall turn the damper by more than about a radian, the guesses diverge unless one is confirmed soon.
    pub(super) fn change_by_rates(&self, h: f64, ends: &[End; 2]) -> Option<Change> {
        let ([q, w, x1, v1], [a1, rate]) = largest(ends);
        let slopes = [0.5 * w, q * rate, q * v1, q * a1];
        // With a margin for changes of these slopes: most pieces need no second guess.
        let mut within = slopes.map(|slope| 0.6 * h * slope);
        let stiffness = self.spring[1] + 1.5 * self.law[0] * self.hertz[1] * q;
        let tries = if 0.25 * (h * q).powi(2) * stiffness > FAR { 2 } else { 8 };
        for _ in 0..tries {
            let [of_q, of_w, of_x1, of_v1] = within;
            let half = 0.5 * h * (q + of_q); // seconds
            let of_contact = |end: &End| {
                let [q, w, ..] = end.y;
                self.contact_within(end, [q - of_q, q + of_q], [w - of_w, w + of_w])
            };
            let contact = ends.iter().map(of_contact).fold(0.0, greater);
            let excursion = Excursion { half, numbers: within, stretch: (2.0 * q + of_q) * of_q, contact };
            let [of_a1, of_rate] = self.of_rates(&excursion);
            let reach =
                [0.25 * h * (w + of_w), half * (rate + of_rate), half * (v1 + of_v1), half * (a1 + of_a1)];
            if (0..4).all(|i| reach[i] <= within[i] && within[i].is_finite()) {
                let most = [q + of_q, w + of_w, x1 + of_x1, v1 + of_v1];
                return Some(self.change_of(ends, &excursion, most, [f64::INFINITY; 2]));
            }
            for i in 0..4 {
                within[i] = within[i].max(1.05 * reach[i]);
            }
        }
        None
    }

    /// [`Self::change`] by the energy of a damper that swings against its spring and the wall, however far; `None` if the structure moves
    /// too much for the proof.
    ///
    /// With `U` the energy of both springs over the effective mass, `a` the acceleration that the rest of the structure's forces give the
    /// damper into the wall, and `a0` that at the start, `ε² = w² + 2 (U(z) - a0 z - least)` changes by `dε/dt <= |a - a0|`, since dashpot and losses only
    /// take from it. `U` is convex, and no softer than the spring, so that at the start `ε² <= w² + (U' - a0)² / U''` with the least `U''` on the way to
    /// where `U' = a0`; and later `|w| <= ε`, `|U' - a0| <= √U'' ε` with the greatest, and `z` is at most `(ε0 + ε) / √spring` from where it was.
    pub(super) fn change_by_energy(&self, h: f64, ends: &[End; 2]) -> Option<Change> {
        let [q0, w0, ..] = ends[0].y;
        let (z0, spring, kappa) = (q0 * q0, self.spring[1], self.law[0] * self.hertz[1]);
        let lost = self.dashpot[1] * w0 + self.hertz[1] * (ends[0].contact - self.law[0] * q0.powi(3));
        let pushed = -(ends[0].rates[1] + lost); // U' - a0
        let stiffness = |q: f64| spring + 1.5 * kappa * q; // U'' at z = q²
        let (here, halfway) = (stiffness(q0), stiffness(0.5 * q0));
        let least = match pushed {
            _ if pushed <= 0.0 => here,
            _ if pushed <= 0.75 * z0 * halfway => halfway,
            _ => spring,
        };
        let begin = (w0 * w0 + pushed * pushed / least).sqrt();
        let deepest = z0 + (-pushed / here).max(0.0); // a bound on the z where U' = a0
        let (force, turn) = (self.amplitude, self.primary[0] * self.most_turn());
        let (at_ends, _) = largest(ends);
        let mut most = at_ends;
        for _ in 0..8 {
            let [q, w, _, v1] = most;
            let seconds = h * q;
            let [a1, _] = self.sizes_of_rates(self.primary[0] * force, &most);
            let change = seconds * (self.primary[1] * a1 + self.primary[2] * v1 + self.felt.abs() * turn);
            let energy = begin + 0.5 * seconds * change;
            let way = (seconds * energy).min((begin + energy) / spring.sqrt());
            let reach = [
                (z0 + way).sqrt().max(at_ends[0]),
                energy.max(at_ends[1]),
                at_ends[2] + 0.5 * seconds * v1,
                at_ends[3] + 0.5 * seconds * a1,
            ];
            if (0..4).all(|i| reach[i] <= most[i] && most[i].is_finite()) {
                let depths = [(z0 - way).max(0.0).sqrt().min(q0).min(ends[1].y[0]), q];
                let of_q = ends.iter().map(|end| (q - end.y[0]).max(end.y[0] - depths[0])).fold(0.0, greater);
                let of_contact = |end: &End| self.contact_within(end, depths, [-w, w]);
                let excursion = Excursion {
                    half: 0.5 * seconds,
                    numbers: [of_q, w + at_ends[1], 0.5 * seconds * v1, 0.5 * seconds * a1],
                    stretch: way + (ends[1].y[0].powi(2) - z0).abs(),
                    contact: ends.iter().map(of_contact).fold(0.0, greater),
                };
                let [least, greatest] = self.factors_between(depths, [-w, w]);
                let loss = (greatest - self.law[0]).max(self.law[0] - least) * q.powi(3);
                let lost = self.dashpot[1] * w + self.hertz[1] * loss;
                let rate = stiffness(q.max(deepest.sqrt())).sqrt() * energy + change + lost;
                return Some(self.change_of(ends, &excursion, most, [a1, rate]));
            }
            for i in 0..4 {
                most[i] = most[i].max(1.05 * reach[i]);
            }
        }
        None
    }

    /// Bounds on the deviations of `a1` and `dw/dt` from the nearer state.
    fn of_rates(
        &self,
        &Excursion { half, numbers: [_, of_w, of_x1, of_v1], stretch, contact }: &Excursion,
    ) -> [f64; 2] {
        let outside = self.primary[1] * of_v1 + self.primary[2] * of_x1;
        [(0, 1.0), (1, self.felt.abs())].map(|(i, felt)| {
            felt * self.primary[0] * self.most_turn() * half
                + outside
                + self.hertz[i] * contact
                + self.dashpot[i] * of_w
                + self.spring[i] * stretch
        })
    }

    /// The [`Change`] of a piece from its `excursion` and bounds on its `[q, w, x1, v1]` and rates.
    fn change_of(
        &self,
        ends: &[End; 2],
        excursion: &Excursion,
        [q, w, x1, v1]: [f64; 4],
        rates: [f64; 2],
    ) -> Change {
        let Excursion { half, numbers: [of_q, of_w, of_x1, of_v1], stretch, contact } = *excursion;
        let (_, at_ends) = largest(ends);
        let of_rates = self.of_rates(excursion);
        let [a1, rate] = std::array::from_fn(|i| [rates[i].min(at_ends[i] + of_rates[i]), of_rates[i]]);
        let with = |at: &dyn Fn(&End) -> f64, of: f64| [at(&ends[0]).abs().max(at(&ends[1]).abs()) + of, of];
        let turned = self.most_turn() * half;
        Change {
            states: [
                [x1, of_x1],
                [v1, of_v1],
                with(&|end| end.y[0].powi(2) + self.stretch, stretch),
                [w, of_w],
            ],
            rates: [[v1, of_v1], a1, [w, of_w], rate],
            root: [q, of_q],
            forces: Some(Forces {
                contact: with(&|end| end.contact, contact),
                turn: if turned == 0.0 { 0.0 } else { turned / self.amplitude },
                kick: self.kick(),
            }),
        }
    }

    /// The rate of `[x1, v1, x2, v2]` over the contact's force over its stiffness.
    pub(in crate::regularised) fn kick(&self) -> [f64; 4] {
        [0.0, self.hertz[0], 0.0, self.hertz[0] - self.hertz[1]].map(|a| self.sign * a)
    }

    /// A bound on the rate of the force, N/s.
    fn most_turn(&self) -> f64 {
        if self.is_linear() { self.force[1] } else { self.omega * self.amplitude }
    }

    /// The sums of the sizes of all terms of `a1` and of `dw/dt`, m/s², from bounds on `[q, w, x1, v1]` and on what the force adds to `a1`.
    fn sizes_of_rates(&self, excitation: f64, &[q, w, x1, v1]: &[f64; 4]) -> [f64; 2] {
        let (stretch, contact) = (q * q + self.stretch.abs(), q * q * q * self.most(w));
        let outside = excitation + self.primary[1] * v1 + self.primary[2] * x1;
        [0, 1].map(|i| outside + self.hertz[i] * contact + self.dashpot[i] * w + self.spring[i] * stretch)
    }

    /// A bound on the deviation of `q³` times the factor of a loss from its value at a state, for `q` and `w` in these ranges.
    fn contact_within(&self, end: &End, depths: [f64; 2], w: [f64; 2]) -> f64 {
        let depths = depths.map(|q| q.max(0.0));
        let factors = self.factors_between(depths, w);
        let [shallow, deep] = depths.map(|q| q.powi(3));
        let most = deep * factors[1];
        let least = if factors[0] < 0.0 { deep } else { shallow } * factors[0];
        (most - end.contact).max(end.contact - least)
    }

    /// The least and the greatest factor of a loss for `q` and `w` in these ranges.
    fn factors_between(&self, q: [f64; 2], w: [f64; 2]) -> [f64; 2] {
        let Some(law) = &self.restoring else {
            return w.map(|w| self.law[0] + self.law[1] * w);
        };
        Stages::corners(q.map(|q| self.half_square(q)), w).map(|[s, w]| law.push(s, w))
    }
}
