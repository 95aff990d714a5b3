//! Random walks under k2 <= 300 N/m. A walk on 601 frequencies overfits its design to them; a walk on 5000 continues from there to a design
//! that is good on both.

use crate::Any;
use rayon::prelude::*;
use retune_jobs::tune::objective::objective;
use retune_model::{Parameter, PerVariable};
use retune_optim::DesignObjective;
use retune_study::{Study, read};
use retune_testkit::hunt::Hunt;
use std::path::Path;

/// The bound on k2, N/m.
const MAX_K2: f64 = 300.0;
/// A random walk. Steps are at most `longest` relative to a parameter, and down to `decades` decades shorter.
#[derive(Clone, Copy)]
struct Walk {
    steps: u32,
    longest: f64,
    decades: f64,
}
/// The walk on 601 frequencies.
const FIRST: Walk = Walk { steps: 10_000, longest: 0.15, decades: 2.5 };
/// The walk on 5000 frequencies. On 601 its values must be lower by `MARGIN`, J: an independent search found 552 J there.
const SECOND: Walk = Walk { steps: 3200, longest: 0.05, decades: 3.0 };
const MARGIN: f64 = 6.0;
const KNOWN_E1MAX: f64 = 552.0;
/// Number of frequencies for a first screening of a design.
const SCREEN_SAMPLES: usize = 41;

/// Where motions are irregular, E1max jumps from one design to the next, and slopes are useless. On 601 frequencies, a walk that takes
/// every step down gets below the end of the descents of `retune fronts`, but E1max is then larger between these frequencies: the design is
/// overfitted. From there a walk on 5000 finds designs that are lower on both.
///
/// A `share` below 1 makes only that fraction of the steps, to test that the program works.
pub fn walk(share: f64) -> Any<Hunt> {
    let study = read(Path::new("studies/fronts-ssvi.json"))?;
    let of = |samples| over(&study, samples);
    let (few, fine, finer, finest) = (of(SCREEN_SAMPLES)?, of(601)?, of(1201)?, of(5000)?);
    // The end of the descents: k2, N/m; c2, N s/m; D, m.
    let descent_end = [300.0, 216.26883973710628, 0.43798840045928955];
    // The largest E1max over the goals, each increased by its margin, J; none unless all screens and goals are below `most`.
    type On<'a> = &'a [(&'a DesignObjective, f64)];
    let largest_below = |at: &[f64; 3], [screens, goals]: [On; 2], most: f64| {
        let value = |&(of, margin): &(&DesignObjective, f64)| worst(of, at, most - margin) + margin;
        let passes = screens.iter().all(|on| value(on) < most);
        let largest = goals.iter().filter(|_| passes).try_fold(f64::NEG_INFINITY, |largest, on| {
            Some(value(on)).filter(|value| *value < most).map(|value| largest.max(value))
        });
        largest.filter(|_| passes)
    };
    let walk = |number: u32, start: [f64; 3], walk: Walk, on: [On; 2]| {
        let mut best = start;
        let mut least = largest_below(&start, on, f64::INFINITY).expect("finite");
        for i in 0..(share * f64::from(walk.steps)) as u32 {
            let next = step(&best, number, i, walk);
            if let Some(lower) = largest_below(&next, on, least) {
                (best, least) = (next, lower);
            }
        }
        best
    };
    let both = |number: u32| {
        let first = walk(number, descent_end, FIRST, [&[(&few, 0.0)], &[(&fine, 0.0)]]);
        let screens = [(&few, MARGIN), (&finer, 0.0)];
        [first, walk(1, printed(&first), SECOND, [&screens, &[(&fine, MARGIN), (&finest, 0.0)]])]
    };
    let ends: Vec<[[f64; 3]; 2]> = (1..=2).into_par_iter().map(both).collect();
    let mut hunt = Hunt::default();
    let mut row = |name: &str, at: &[f64; 3]| {
        let [coarse, whole] = [&fine, &finest].map(|of| worst(of, at, f64::INFINITY));
        hunt.row(format!("| {name} | {} | {} | {} | {coarse:.2} | {whole:.2} |", at[0], at[1], at[2]));
        [coarse, whole]
    };
    let [coarse, whole] = row("begins", &descent_end);
    let mut rows = Vec::new();
    for (number, [first, second]) in ends.iter().enumerate() {
        let fitted = row(&format!("{}, on 601", number + 1), first);
        let lower = row(&format!("{}, then on 5000", number + 1), second);
        rows.push(([first[0], second[0]], fitted, lower));
    }
    for (k2, [fitted, seen], [known, lower]) in rows {
        hunt.check(k2.iter().all(|k2| *k2 <= MAX_K2), || format!("k2 = {k2:?} N/m"));
        hunt.check(fitted < coarse, || format!("{fitted} J after a walk from {coarse} J"));
        hunt.check(seen - fitted > whole - coarse, || {
            format!("{seen} J on 5000 frequencies beside {fitted} J")
        });
        hunt.check(known <= KNOWN_E1MAX && lower < whole, || format!("{lower} J on 5000, {known} J on 601"));
    }
    Ok(hunt)
}

/// A design rounded to few digits.
fn printed(at: &[f64; 3]) -> [f64; 3] {
    let rounded = |value: f64, digits: f64| (value * digits).round() / digits;
    [rounded(at[0], 1e4), rounded(at[1], 1e4), rounded(at[2], 1e6)]
}

/// E1max of a design, J; any larger value once it is known to exceed `most`.
fn worst(of: &DesignObjective, at: &[f64; 3], most: f64) -> f64 {
    of.height_and_runs(at, most).0.worst
}

/// The objective of the study on `samples` frequencies, over k2, c2 and D, with C = 0.
fn over(study: &Study, samples: usize) -> Any<DesignObjective> {
    let mut study = study.clone();
    let optimize = study.optimize.as_mut().ok_or("no search")?;
    optimize.objective.omega.as_mut().ok_or("no band")?.samples = samples;
    optimize.global = None;
    optimize.starts = vec![PerVariable::of(&Parameter::PAPER, &[300.0, 200.0, 0.4, 0.0])];
    let mut search = study.search()?;
    Parameter::C.set_damper(&mut search.damper, 0.0)?;
    Ok(objective(&study, &search, &[Parameter::K2, Parameter::C2, Parameter::D]))
}

/// A random step from a design, with k2 within its bound.
fn step(at: &[f64; 3], number: u32, i: u32, walk: Walk) -> [f64; 3] {
    let sobol = |dimension| f64::from(sobol_burley::sample(i, dimension, number));
    let length = walk.longest * 10.0_f64.powf(-walk.decades * sobol(3));
    let moved = |j: usize| at[j] * (1.0 + length * (2.0 * sobol(j as u32) - 1.0));
    [moved(0).min(MAX_K2), moved(1), moved(2)]
}
