//! Runs from rest at many frequencies: a motion that settles must lie on a branch that was found.

use super::Hunt;
use crate::scenes::{Numbers, SSVI};
use rayon::prelude::*;
use retune_dynamics::parameter::evenly;
use retune_dynamics::periodic::branches::{Control, Plan, equations};
use retune_dynamics::periodic::settle::{Settled, settle};
use retune_dynamics::periodic::{Branch, End, Orbit, branches};
use retune_dynamics::{Parameter, Stretch, follow};
use retune_solver::Settings;

/// The paper's damper, both tuned ones, and one with coexisting motions.
pub const DAMPERS: [Numbers; 4] = [
    SSVI,
    Numbers { k2: 583.9159, c2: 94.97076, d: 0.02885, c: 1.1045, ..SSVI },
    Numbers { k2: 599.9, c2: 95.7, d: 1.0, c: 0.039, ..SSVI },
    Numbers {
        k2: 597.2737982898645,
        c2: 95.72415913882642,
        d: 0.6072128825900359,
        c: 0.03740508433492577,
        ..SSVI
    },
];

/// Follows runs from rest at `count` frequencies as part of the search. A run there that settles on no known branch is a fault; of as many
/// runs at frequencies in between, hardly any may.
pub fn from_rest(dampers: &[Numbers], count: usize) -> Hunt {
    let mut hunt = Hunt::default();
    let (mut lost, mut between) = (Vec::new(), Vec::new());
    for numbers in dampers {
        let settings = Settings::default();
        let over = Plan::over(Parameter::Omega, [5.0, 8.0]);
        let plan = Plan { samples: 31, starts: 8, fine: count, passes: 2, ..over };
        let found = branches(&numbers.scene(), plan, &settings, Control::default()).expect("branches");
        let shooting = equations(&numbers.scene(), &plan, &settings).expect("equations");
        let [low, high] = plan.range;
        let half = 0.5 * (high - low) / (count - 1) as f64;
        let settled = |omega: f64| {
            let system = shooting.system(omega).expect("a system");
            match settle(&shooting, omega, system.rest()).expect("a run") {
                Settled::Irregular(_) => None,
                Settled::On(periods, motion) => {
                    Some(found.holds(&shooting.of_periods(periods), &motion).is_some())
                }
            }
        };
        let runs = |values: Vec<f64>| -> Vec<(f64, Option<bool>)> {
            values.into_par_iter().map(|omega| (omega, settled(omega))).collect()
        };
        let seen = runs(evenly(low, high, count));
        let none = |seen: &[(f64, Option<bool>)]| -> Vec<(f64, f64)> {
            let none = seen.iter().filter(|(_, on)| *on == Some(false));
            none.map(|(omega, _)| (numbers.k2, *omega)).collect()
        };
        lost.extend(none(&seen));
        let missed = none(&runs(evenly(low + half, high - half, count - 1)));
        let irregular: Vec<f64> =
            seen.iter().filter(|(_, on)| on.is_none()).map(|(omega, _)| *omega).collect();
        let exponent = |omega: &f64| {
            let scene = shooting.scene_at(*omega).expect("a scene");
            let stretch = Stretch { settle: 300, observe: 200 };
            follow(&scene, None, stretch, &settings).expect("a motion").exponent().value
        };
        let mut exponents: Vec<f64> = irregular.par_iter().map(exponent).collect();
        exponents.sort_by(|a, b| b.total_cmp(a));
        let positive = exponents.iter().filter(|exponent| **exponent > 0.0).count();
        let Numbers { k2, c2, d, c, .. } = numbers;
        let on = seen.iter().filter(|(_, on)| *on == Some(true)).count();
        hunt.row(format!(
            "| {k2} | {c2} | {d} | {c} | {} | {count} | {on} | {} | {:.3?}; {positive} above 0 | {} |",
            found.branches.len(),
            irregular.len(),
            &exponents[..exponents.len().min(3)],
            missed.len()
        ));
        between.extend(missed);
        hunt.check(on > count / 2, || format!("k2 = {k2}: hardly a run settles"));
        for (number, branch) in found.branches.iter().enumerate() {
            let Some(middle) = branch.points.get(branch.points.len() / 2) else { continue };
            let own = &branch.shooting;
            let motion = own.correct_at_value(&own.unknowns(&middle.states, middle.value));
            let first = motion.and_then(|motion| found.holds(own, &motion));
            hunt.check(first.is_none_or(|first| first == number), || {
                format!("{k2}: branch {number} is branch {first:?}")
            });
        }
    }
    hunt.row(format!(
        "\n{} settled on no branch that is known (k2 in N/m, omega in rad/s): {lost:?}",
        lost.len()
    ));
    hunt.row(format!("\n{} of those between them: {between:?}", between.len()));
    hunt.check(lost.is_empty(), || format!("on no known branch: {lost:?}"));
    // Stable windows inside chaos may be narrower than the spacing of the search's frequencies.
    hunt.check(between.len() <= 2 + count / 500, || format!("between the frequencies: {between:?}"));
    hunt
}

/// Where walls are nearly hard and a motion grazes, branches of several periods come close to those of one. Checks that none switches to a
/// motion of a shorter period, traversed several times. The band is relative to the natural frequency.
pub fn periods(stiffnesses: &[f64], band: [f64; 2]) -> Hunt {
    let mut hunt = Hunt::default();
    for &k1 in stiffnesses {
        let range = band.map(|share| share * f64::sqrt(k1 / 1000.0));
        let plan = Plan { samples: 31, starts: 16, passes: 2, ..Plan::over(Parameter::Omega, range) };
        let scene = Numbers { k1, ..SSVI }.scene();
        let found = branches(&scene, plan, &Settings::default(), Control::default()).expect("branches");
        let repeated: Vec<bool> = found.branches.iter().flat_map(of_a_shorter_period).collect();
        let shorter = repeated.iter().filter(|sooner| **sooner).count();
        let lost =
            found.branches.iter().flat_map(|branch| branch.ends).filter(|end| *end == End::Lost).count();
        hunt.row(format!("| {k1} | {} | {} | {shorter} | {lost} |", found.branches.len(), repeated.len()));
        hunt.check(shorter == 0, || format!("k1 = {k1}: {shorter} motions of a shorter period"));
    }
    hunt
}

/// Which motions of a branch repeat after fewer periods than they count. Those next to a period doubling at an end of the branch nearly do
/// and are excepted: the difference of their halves grows from there with the root of the distance or, if an impact begins nearby, more
/// slowly. On a motion of a shorter period the difference is only the error of Newton's iteration.
fn of_a_shorter_period(branch: &Branch) -> Vec<bool> {
    let gaps: Vec<f64> = branch.points.iter().map(least_gap).collect();
    let mut sooner: Vec<bool> = gaps.iter().map(|gap| *gap < SAME).collect();
    let places: Vec<usize> = (0..gaps.len()).collect();
    let outwards = [places.clone(), places.into_iter().rev().collect()];
    for (end, places) in branch.ends.iter().zip(outwards) {
        let mut before = -1.0;
        for place in places.into_iter().take_while(|_| *end == End::Halved) {
            if gaps[place] <= before || gaps[place] >= SAME {
                break;
            }
            (sooner[place], before) = (false, gaps[place]);
        }
    }
    sooner
}

/// Parts of a motion whose states differ by less than this fraction of its size count as equal.
const SAME: f64 = 1e-6;

/// The least difference between a motion and itself shifted by a proper divisor of its number of periods, relative to its size; infinite
/// for one period.
fn least_gap(Orbit { states, .. }: &Orbit) -> f64 {
    let n = states.len();
    let size = states.iter().flatten().fold(0.0_f64, |size, value| size.max(value.abs()));
    let gap = |m: usize| {
        let pairs = states.iter().zip(states.iter().cycle().skip(m));
        pairs.flat_map(|(a, b)| a.iter().zip(b)).fold(0.0_f64, |gap, (a, b)| gap.max((a - b).abs()))
    };
    let gaps = (1..n).filter(|m| n.is_multiple_of(*m)).map(|m| gap(m) / size);
    gaps.fold(f64::INFINITY, f64::min)
}
