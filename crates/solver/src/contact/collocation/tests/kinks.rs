//! The error that a bend of the force makes in a contact, to first order: the linear theory of an undisturbed collision compared with its
//! rules.

use crate::contact::collocation::lossy_rule::{Loss, LossyRule};
use crate::contact::collocation::nodes::{Nodes, dot};
use crate::contact::collocation::solve::{FLAT, KINK, Lossless, lossless};
use crate::contact::collocation::undisturbed::DURATION;
use crate::contact::collocation::unit_law::UnitLaw;
use crate::methods::dop853;
use retune_model::Side;
use retune_testkit::scenes::{Numbers, SSVI};
use wide::f64x4;

/// What `(τ - b)^k` from `b` on adds to the depth without contact (in Z and shares of the duration), and its slope.
#[derive(Clone, Copy)]
struct Bend {
    at: f64,
    power: i32,
}

impl Bend {
    fn adds(&self, time: f64) -> f64 {
        (time - self.at).max(0.0).powi(self.power)
    }
    fn slope(&self, time: f64) -> f64 {
        f64::from(self.power) * (time - self.at).max(0.0).powi(self.power - 1)
    }
    fn bend(&self, time: f64) -> f64 {
        f64::from(self.power * (self.power - 1)) * (time - self.at).max(0.0).powi(self.power - 2)
    }
    fn nodes<const M: usize>(times: &Nodes<M>, of: impl Fn(f64) -> f64) -> Nodes<M> {
        times.map(|time| f64x4::new(time.to_array().map(&of)))
    }
}

/// The lengthening of a collision of a law, in shares of its duration, and the change of its speed at the end, over that at touch-down.
fn exactly(law: &UnitLaw, duration: f64, bend: Bend) -> [f64; 2] {
    let slope = |&[q, w, t, z, v]: &[f64; 5]| {
        let [factor, by_z, by_w] = law.slopes(0.5 * q.abs().powi(5), w);
        let pushed = q * (1.5 * factor + by_z) * z + q.powi(3) * by_w * v;
        let bent = bend.bend(t / duration) / (duration * duration);
        [0.5 * w, -1.25 * q.powi(4) * factor, q, q * v, q * (bent - 1.25 * pushed)]
    };
    let advance = |y: &[f64; 5], h: f64| dop853::step(slope, y, &slope(y), h).y;
    // From touch-down to the bend, and from there, where all are smooth, to the end.
    let (mut y, mut is_bent) = ([0.0, 1.0, 0.0, 0.0, 0.0], false);
    loop {
        let next = advance(&y, 0.02);
        if !is_bent && next[2] > bend.at * duration {
            let (mut low, mut high) = (0.0, 0.02);
            for _ in 0..60 {
                let h = 0.5 * (low + high);
                *(if advance(&y, h)[2] > bend.at * duration { &mut high } else { &mut low }) = h;
            }
            y = advance(&y, low);
            (y[2], y[3], y[4], is_bent) = (bend.at * duration, 0.0, 0.0, true);
        } else if next[0] <= 0.0 {
            let mut h = 0.01;
            for _ in 0..30 {
                let [q, w, ..] = advance(&y, h);
                h -= 2.0 * q / w;
            }
            let [_, w, _, z, v] = advance(&y, h);
            return [-z / (w * duration), v];
        } else {
            y = next;
        }
    }
}

/// [`exactly`] by a rule for contacts without loss, to first order.
fn by_lossless<const N: usize, const M: usize>((rule, newton): &Lossless<N, M>, bend: Bend) -> [f64; 2] {
    let residual = Bend::nodes(&rule.times, |time| -bend.adds(time));
    let (change, shorter) = newton.change([0.0; 3], &residual, -bend.adds(1.0));
    let forces: Nodes<M> = std::array::from_fn(|i| rule.depths[i].sqrt() * change[i] * -1.5);
    let force = rule.depths.map(|z| z * z.sqrt());
    let slowed = dot(&rule.last[0], &forces) - shorter * dot(&rule.last[0], &force);
    [-shorter, bend.slope(1.0) / DURATION - 1.25 * DURATION * slowed]
}

/// [`exactly`] by a rule for contacts with loss, to first order.
fn by_lossy<const N: usize, const M: usize>(of: &LossyRule<N, M>, bend: Bend) -> [f64; 2] {
    let rule = &of.rule;
    let deeper = Bend::nodes(&rule.times, |time| bend.adds(time));
    let faster = Bend::nodes(&rule.times, |time| bend.slope(time) / of.duration);
    let residual = std::array::from_fn(|i| -(of.slopes[0][i] * deeper[i] + of.slopes[1][i] * faster[i]));
    let (change, shorter) = of.newton.change([0.0; 3], &residual, bend.adds(1.0));
    let slowed = -dot(&rule.last[0], &change) - shorter * dot(&rule.last[0], &of.forces);
    [-shorter, bend.slope(1.0) / of.duration - 1.25 * of.duration * slowed]
}

/// The greatest error of a rule over all places of a bend, for a cube and for higher powers.
fn errors(law: &UnitLaw, duration: f64, rule: impl Fn(Bend) -> [f64; 2]) -> [f64; 2] {
    let error = |power: i32, at: f64| {
        let (bend, exact) = (Bend { at, power }, exactly(law, duration, Bend { at, power }));
        exact.iter().zip(rule(bend)).map(|(exact, ours)| (exact - ours).abs()).fold(0.0, f64::max)
    };
    let greatest = |powers: std::ops::RangeInclusive<i32>, places: u32| {
        let all = powers.flat_map(|power| (0..places).map(move |at| (power, f64::from(at))));
        all.map(|(power, at)| error(power, (at + 0.5) / f64::from(places))).fold(0.0, f64::max)
    };
    [greatest(3..=3, 250), greatest(4..=10, 20)]
}

#[track_caller]
fn check([cube, higher]: [f64; 2], kink: f64, nodes: f64) {
    assert!(cube <= kink, "{nodes} nodes: {cube:e}, more than {kink:e}");
    assert!(cube >= 0.2 * kink, "{nodes} nodes: {cube:e}, far less than {kink:e}");
    assert!(higher <= FLAT / nodes * kink, "{nodes} nodes: {higher:e} of higher powers, {cube:e} of a cube");
}

#[test]
fn exact_what_a_bend_costs_to_first_order() {
    let none = UnitLaw::Damping(0.0);
    fn of<const N: usize, const M: usize>(none: &UnitLaw) {
        let rule = lossless::<N, M>();
        let errors = errors(none, DURATION, |bend| by_lossless(&rule, bend));
        check(errors, KINK[N / 4 - 2], N as f64);
    }
    of::<8, 2>(&none);
    of::<12, 3>(&none);
    of::<16, 4>(&none);
    of::<20, 5>(&none);
    of::<24, 6>(&none);
}

/// The error where energy is lost.
#[test]
fn exact_what_a_bend_costs_to_first_order_with_loss() {
    let restitutions = [0.3, 0.6, 0.999].map(|e| Numbers { e, ..SSVI });
    let dashpots = [0.1, 1.7].map(|lambda| Numbers { lambda, ..SSVI });
    for numbers in restitutions.into_iter().chain(dashpots) {
        let loss = Loss::of(&numbers.coupled().regularised_contact(Side::BOTH[0])).expect("a loss");
        // At 1 m/s each χ is one of those that are kept.
        let (rules, law) = loss.rules(1.0).expect("rules");
        fn of<const N: usize, const M: usize>(rule: &LossyRule<N, M>, law: &UnitLaw) {
            check(errors(law, rule.duration, |bend| by_lossy(rule, bend)), rule.kink, N as f64);
        }
        of(&rules.few, &law);
        of(&rules.some, &law);
        of(&rules.more, &law);
        of(&rules.many, &law);
    }
}
