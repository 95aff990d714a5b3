//! Rigid walls: compares the solver with a brute-force integration by Taylor steps of a millisecond or two, sampled eight times each,
//! with roots by bisection.

use super::Hunt;
use crate::scenes::{Numbers, SSVI, Spread};
use rayon::prelude::*;
use retune_solver::{Settings, Window, simulate};

/// Any practical damper between rigid walls: every kind of e, and gaps, springs and dashpots that are zero.
pub fn drawn(number: u64) -> Numbers {
    let mut draw = Spread::new(number + 7);
    let mut within = |low: f64, high: f64| low + (high - low) * draw.unit();
    let mut numbers = Numbers {
        m2: within(5.0, 400.0),
        c1: within(100.0, 2000.0),
        k1: within(2e4, 6e4),
        k2: within(0.0, 3500.0),
        c2: within(0.0, 400.0),
        d: within(0.0, 0.15),
        c: within(0.0, 0.5),
        omega: within(3.0, 10.0),
        rigid: Some(within(0.0, 1.0)),
        ..SSVI
    };
    for value in [&mut numbers.k2, &mut numbers.c2, &mut numbers.d, &mut numbers.c] {
        if draw.unit() < 0.08 {
            *value = 0.0;
        }
    }
    match draw.unit() {
        0.0..0.05 => numbers.rigid = Some(0.0),
        0.95..1.0 => numbers.rigid = Some(1.0),
        _ => {}
    }
    if numbers.d + numbers.c == 0.0 {
        numbers.c = 0.01;
    }
    numbers
}

/// The results of a run.
#[derive(Clone, Copy, Debug)]
struct Summary {
    /// Largest E1 (J), |v1| (m/s) and stroke (m).
    largest: [f64; 3],
    end: [f64; 4],
    impacts: u64,
}

/// Terms of a Taylor series.
const TERMS: usize = 14;

/// The brute-force integration.
struct TaylorPath {
    n: Numbers,
    /// The wall that holds the damper.
    held: Option<usize>,
}

impl TaylorPath {
    /// Taylor coefficients of `[x1, v1, x2, v2]` from time `t` on.
    fn series(&self, t: f64, y: [f64; 4]) -> [[f64; TERMS]; 4] {
        let n = &self.n;
        let mut of = [[0.0; TERMS]; 4];
        (0..4).for_each(|i| of[i][0] = y[i]);
        let (mut cos, mut sin) = (n.p * (n.omega * t).cos(), n.p * (n.omega * t).sin());
        for k in 0..TERMS - 1 {
            let [x1, v1, x2, v2] = of.map(|terms| terms[k]);
            let constant = if k == 0 { n.d } else { 0.0 };
            let pull = -n.c2 * (v2 - v1) - n.k2 * (x2 - x1 - constant);
            let on_both = cos - n.c1 * v1 - n.k1 * x1;
            let both = on_both / (n.m1 + n.m2);
            let [a1, a2] =
                if self.held.is_some() { [both; 2] } else { [(on_both - pull) / n.m1, pull / n.m2] };
            let next = (k + 1) as f64;
            for (terms, rate) in of.iter_mut().zip([v1, a1, v2, a2]) {
                terms[k + 1] = rate / next;
            }
            (cos, sin) = (-n.omega * sin / next, n.omega * cos / next);
        }
        of
    }

    /// The force between a wall and the damper while the wall holds it.
    fn holding_force(&self, wall: usize, t: f64, y: &[f64; 4]) -> f64 {
        let n = &self.n;
        let a = (n.p * (n.omega * t).cos() - n.c1 * y[1] - n.k1 * y[0]) / (n.m1 + n.m2);
        let on_damper = n.m2 * a + n.k2 * (y[2] - y[0] - n.d);
        if wall == 0 { on_damper } else { -on_damper }
    }

    /// A run from rest; a rebound slower than `slow` (m/s) ends a chatter.
    fn run(mut self, to: f64, h: f64, slow: f64) -> Option<Summary> {
        const SAMPLES: u32 = 8;
        let n = self.n;
        let e = n.rigid.unwrap_or(1.0);
        let (mut t, mut y) = (0.0, [0.0, 0.0, n.d, 0.0]);
        let mut summary = Summary { largest: [0.0; 3], end: y, impacts: 0 };
        if n.d == 0.0 && self.holding_force(0, 0.0, &y) >= 0.0 {
            self.held = Some(0);
        }
        for _ in 0..4_000_000 {
            let length = h.min(to - t);
            let series = self.series(t, y);
            let at = |s: f64| series.map(|terms| terms.iter().rev().fold(0.0, |sum, c| sum * s + c));
            // A function that is negative after an event: the gap, divided by the time if it begins at zero; or the force of the wall
            // that holds the damper.
            let margin = |s: f64, wall: usize| match self.held {
                Some(held) if held == wall => self.holding_force(wall, t + s, &at(s)),
                Some(_) => 1.0,
                None => {
                    let terms: [f64; TERMS] = std::array::from_fn(|k| {
                        let r = series[2][k] - series[0][k];
                        let place = if k == 0 { [0.0, n.d + n.c][wall] } else { 0.0 };
                        if wall == 0 { r - place } else { place - r }
                    });
                    let on_it = terms[0].abs() < 1e-13;
                    terms[usize::from(on_it)..].iter().rev().fold(0.0, |sum, c| sum * s + c)
                }
            };
            let mut first: Option<(f64, usize)> = None;
            for wall in [0, 1] {
                let (mut low, mut high) = (0.0, None);
                for sample in 1..=SAMPLES {
                    let s = length * f64::from(sample) / f64::from(SAMPLES);
                    if margin(s, wall) < 0.0 {
                        high = Some(s);
                        break;
                    }
                    low = s;
                }
                let Some(mut high) = high else { continue };
                for _ in 0..200 {
                    let middle = 0.5 * (low + high);
                    if margin(middle, wall) < 0.0 { high = middle } else { low = middle }
                }
                if first.is_none_or(|(s, _)| high < s) {
                    first = Some((high, wall));
                }
            }
            let end = first.map_or(length, |(s, _)| s);
            let note = |summary: &mut Summary, y: &[f64; 4]| {
                let e1 = 0.5 * (n.m1 * y[1] * y[1] + n.k1 * y[0] * y[0]);
                let now = [e1, y[1].abs(), (y[2] - y[0] - n.d).abs()];
                (0..3).for_each(|i| summary.largest[i] = summary.largest[i].max(now[i]));
            };
            (0..=SAMPLES)
                .for_each(|sample| note(&mut summary, &at(end * f64::from(sample) / f64::from(SAMPLES))));
            (t, y) = (t + end, at(end));
            match (first, self.held) {
                (None, _) if t >= to => {
                    summary.end = y;
                    return Some(summary);
                }
                (None, _) => {}
                (Some(_), Some(_)) => self.held = None,
                (Some((_, wall)), None) => {
                    let w = y[3] - y[1];
                    let rebound = e * w.abs();
                    summary.impacts += 1;
                    y[2] = y[0] + [0.0, n.d + n.c][wall];
                    let before = y[1];
                    y[1] += n.m2 / (n.m1 + n.m2) * w;
                    let stays = rebound <= slow && self.holding_force(wall, t, &y) >= 0.0;
                    y[1] = before + if stays { 1.0 } else { 1.0 + e } * n.m2 / (n.m1 + n.m2) * w;
                    y[3] = if stays { y[1] } else { y[1] - e * w };
                    self.held = stays.then_some(wall);
                    note(&mut summary, &y);
                }
            }
        }
        None
    }
}

/// Largest relative excess of the sampled value over the solver's, and of the solver's over the sampled one.
const MISSED: f64 = 1e-9;
const ABOVE: f64 = 1e-4;
/// The motion counts as predictable if two brute-force runs end within the first relative distance; the solver must then agree within
/// the second.
const SAME: f64 = 1e-10;
const END: f64 = 1e-8;

/// Compares the solver with the brute-force integration on `count` scenes of 4 s.
pub fn rigid(count: u64) -> Hunt {
    beside(&(0..count).collect::<Vec<_>>())
}

/// The same comparison on the scenes with these numbers.
pub fn beside(numbers: &[u64]) -> Hunt {
    const TO: f64 = 4.0;
    let compare = |number: u64| -> (bool, bool, Option<String>) {
        let n = drawn(number);
        let taylor = |h: f64, slow: f64| TaylorPath { n, held: None }.run(TO, h, slow);
        let found = simulate(&n.scene(), Window { from: 0.0, to: TO }, &Settings::default());
        let found = match found {
            Ok(found) => found,
            Err(error) => return (false, false, Some(format!("{number}: {error}; {n:?}"))),
        };
        let (Some(a), Some(b)) = (taylor(2e-3, 1e-11), taylor(1.3e-3, 1e-10)) else {
            return (false, false, None);
        };
        let size = a.end.iter().fold(1e-3_f64, |most, v| most.max(v.abs()));
        let apart =
            |p: &[f64; 4], q: &[f64; 4]| (0..4).map(|i| (p[i] - q[i]).abs()).fold(0.0, f64::max) / size;
        if apart(&a.end, &b.end) > SAME {
            return (false, a.impacts > 0, None);
        }
        let solver = [found.e1_max.value, found.structure.velocity.value, found.spring_deflection_max];
        let off = apart(&found.final_state, &a.end);
        let holds = off <= END
            && solver.iter().zip(a.largest.iter().zip(b.largest)).all(|(solver, (p, q))| {
                let seen = p.max(q);
                *solver >= seen * (1.0 - MISSED) && *solver <= seen * (1.0 + ABOVE) + 1e-12
            });
        (true, a.impacts > 0, (!holds).then(|| format!("{number}: {off:e} {solver:?} {a:?} {b:?} {n:?}")))
    };
    let compared: Vec<_> = numbers.par_iter().map(|&number| compare(number)).collect();
    let [same, struck] =
        [0, 1].map(|i| compared.iter().filter(|(same, struck, _)| [*same, *same && *struck][i]).count());
    let (count, mut hunt) = (numbers.len(), Hunt::default());
    hunt.faults.extend(compared.into_iter().filter_map(|(_, _, fault)| fault));
    hunt.row(format!("| {count} | {same} | {struck} | {} |", hunt.faults.len()));
    hunt.check(struck as f64 > 0.4 * count as f64, || {
        format!("{struck} of {count} could be predicted and struck")
    });
    hunt
}
