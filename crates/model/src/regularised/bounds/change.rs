//! How far a contact may go between two states: bounds that hold where the series of a loss has none.

use super::stages::Stages;
use crate::regularised::{RegularisedContact, RegularisedState};

/// Bounds between two states, each the most and how far it may be from what it is at the nearer of the two.
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
    /// The rate of `[x1, v1, x2, v2]` by the contact's force over its stiffness.
    pub kick: [f64; 4],
}

/// What is known of one of the two states.
struct End {
    y: RegularisedState,
    /// `q³` times the factor of a loss.
    contact: f64,
    /// Of `v1` and `w`, m/s².
    rates: [f64; 2],
}

impl RegularisedContact {
    /// [`Self::change`] where the speed does not follow the forces.
    ///
    /// As long as no number has gone farther from the nearer state than a guess, no rate differs by more from the rate there than follows from the
    /// guess; the proof holds if these rates do not lead beyond the guess in `h/2`. The factor of a loss is a function of `q` and `w`, monotone in
    /// both where `w` has one sign, so that its range follows from corners: no slope of it is asked for, which has no bound where `v` vanishes.
    pub(super) fn change_by_rates(&self, h: f64, ends: [&RegularisedState; 2]) -> Option<Change> {
        let ends = ends.map(|y| {
            let contact = self.contact_over_stiffness(y);
            let [rate, a1] = self.accelerations_by(contact, y);
            End { y: *y, contact, rates: [a1, rate] }
        });
        let most = |of: &dyn Fn(&End) -> f64| of(&ends[0]).abs().max(of(&ends[1]).abs());
        let [q, w, x1, v1] = [0, 1, 2, 3].map(|i| most(&|end| end.y[i]));
        let [a1, rate, contact] =
            [most(&|end| end.rates[0]), most(&|end| end.rates[1]), most(&|end| end.contact)];
        let stretch = most(&|end| end.y[0].powi(2) + self.stretch);
        let force = self.most_force();
        let turn = if self.is_linear() { self.force[1] } else { self.omega * force };
        let slopes = [0.5 * w, q * rate, q * v1, q * a1];
        // With room for how far these slopes change: most pieces need no more.
        let mut within = slopes.map(|slope| 0.6 * h * slope);
        for _ in 0..8 {
            let [of_q, of_w, of_x1, of_v1] = within;
            let half = 0.5 * h * (q + of_q); // seconds
            let of_stretch = (2.0 * q + of_q) * of_q;
            let of_contact =
                ends.iter().map(|end| self.contact_within(end, [of_q, of_w])).fold(0.0, f64::max);
            let turning = turn * half;
            let outside = self.primary[1] * of_v1 + self.primary[2] * of_x1;
            let [of_a1, of_rate] = [(0, 1.0), (1, self.felt.abs())].map(|(i, felt)| {
                felt * self.primary[0] * turning
                    + outside
                    + self.hertz[i] * of_contact
                    + self.dashpot[i] * of_w
                    + self.spring[i] * of_stretch
            });
            let reach =
                [0.25 * h * (w + of_w), half * (rate + of_rate), half * (v1 + of_v1), half * (a1 + of_a1)];
            if (0..4).all(|i| reach[i] <= within[i]) {
                let with = |most: f64, of: f64| [most + of, of];
                return Some(Change {
                    states: [with(x1, of_x1), with(v1, of_v1), with(stretch, of_stretch), with(w, of_w)],
                    rates: [with(v1, of_v1), with(a1, of_a1), with(w, of_w), with(rate, of_rate)],
                    root: with(q, of_q),
                    forces: Some(Forces {
                        contact: with(contact, of_contact),
                        turn: if turning == 0.0 { 0.0 } else { turning / force },
                        kick: [0.0, self.hertz[0], 0.0, self.hertz[0] - self.hertz[1]].map(|a| self.sign * a),
                    }),
                });
            }
            for i in 0..4 {
                within[i] = within[i].max(1.05 * reach[i]);
            }
        }
        None
    }

    /// How far `q³` times the factor of a loss is from what it is at a state, at most, where `q` and `w` have gone no farther than these.
    fn contact_within(&self, end: &End, [of_q, of_w]: [f64; 2]) -> f64 {
        let [q, w, ..] = end.y;
        let depths = [(q - of_q).max(0.0), q + of_q];
        let factors = self.factors_between(depths, [w - of_w, w + of_w]);
        let [shallow, deep] = depths.map(|q| q.powi(3));
        let most = deep * factors[1];
        let least = if factors[0] < 0.0 { deep } else { shallow } * factors[0];
        (most - end.contact).max(end.contact - least)
    }

    /// The least and the greatest factor of a loss where `q` and `w` lie between these.
    fn factors_between(&self, q: [f64; 2], w: [f64; 2]) -> [f64; 2] {
        let Some(law) = &self.restoring else {
            return w.map(|w| self.law[0] + self.law[1] * w);
        };
        Stages::corners(q.map(|q| self.half_square(q)), w).map(|[s, w]| law.push(s, w))
    }
}
