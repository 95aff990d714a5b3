//! A walk under k2 <= 300 N/m that looks at 601 frequencies alone: how low it comes there, and what its designs have on 5000.

use rayon::prelude::*;
use retune_model::Variable;
use retune_optim::PeakEnergy;
use retune_study::{PerVariable, Study, read};
use retune_workbench::tune::objective::objective;
use std::path::Path;

/// The bound on k2, N/m.
const MOST: f64 = 300.0;
/// Steps of a walk.
const STEPS: u32 = 10_000;
/// They go from a seventh of a parameter down to a two-thousandth.
const LONGEST: f64 = 0.15;
const DECADES: f64 = 2.5;
/// A design is looked at first on so many frequencies.
const FEW: usize = 41;

/// Where motions are irregular E1max jumps from one design to the next. A walk that takes every step down comes below what
/// `results/fronts` has at 601 frequencies, and the frequencies between them then have more: it has fitted its design to the samples.
#[test]
#[ignore = "minutes: `just hunt-walk`"]
fn invariant_a_walk_fits_its_design_to_the_samples() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/fronts-ssvi.json");
    let study = read(&path).expect("the study of fronts");
    let [few, fine, finest] = [FEW, 601, 5000].map(|samples| over(&study, samples));
    // That of `results/fronts/k2.csv`: k2, N/m; c2, N s/m; D, m.
    let kept = [300.0, 216.26883973710628, 0.43798840045928955];
    let walk = |number: u32| {
        let (mut best, mut least) = (kept, worst(&fine, &kept, f64::INFINITY));
        for i in 0..STEPS {
            let next = step(&best, number, i);
            let is_lower = |of: &PeakEnergy| Some(worst(of, &next, least)).filter(|value| *value < least);
            if let Some(lower) = is_lower(&few).and_then(|_| is_lower(&fine)) {
                (best, least) = (next, lower);
            }
        }
        best
    };
    let ends: Vec<[f64; 3]> = (1..=2).into_par_iter().map(walk).collect();
    println!("\n## Walks under k2 <= {MOST} N/m, C = 0, {STEPS} steps each");
    println!("| walk | k2, N/m | c2, N·s/m | D, m | E1max on 601 frequencies, J | on 5000 |");
    println!("| --- | ---: | ---: | ---: | ---: | ---: |");
    let row = |name: &str, at: &[f64; 3]| {
        let [coarse, whole] = [&fine, &finest].map(|of| worst(of, at, f64::INFINITY));
        println!("| {name} | {:.4} | {:.4} | {:.6} | {coarse:.2} | {whole:.2} |", at[0], at[1], at[2]);
        [coarse, whole]
    };
    let [coarse, whole] = row("begins", &kept);
    for (number, end) in ends.iter().enumerate() {
        let [fitted, seen] = row(&format!("{}", number + 1), end);
        assert!(end[0] <= MOST && fitted < coarse, "{fitted} J after a walk from {coarse} J");
        assert!(seen - fitted > whole - coarse, "{seen} J on 5000 frequencies beside {fitted} J");
    }
}

/// E1max of a design, J; any number above `most` once it is known to have more.
fn worst(of: &PeakEnergy, at: &[f64; 3], most: f64) -> f64 {
    of.look(at, most).0.worst
}

/// The objective of the study on so many frequencies, over k2, c2 and D, one wall touching the damper at rest.
fn over(study: &Study, samples: usize) -> PeakEnergy {
    let mut study = study.clone();
    let optimize = study.optimize.as_mut().expect("a search");
    optimize.objective.omega.as_mut().expect("a band").samples = samples;
    optimize.global = None;
    optimize.starts = vec![PerVariable {
        k2: Some(300.0),
        c2: Some(200.0),
        d: Some(0.4),
        c: Some(0.0),
        ..PerVariable::default()
    }];
    let mut search = study.search().expect("a search");
    Variable::C.set(&mut search.damper, 0.0).expect("in range");
    objective(&study, &search, &[Variable::K2, Variable::C2, Variable::D])
}

/// A random step from a design within the bound.
fn step(at: &[f64; 3], walk: u32, i: u32) -> [f64; 3] {
    let sobol = |dimension| f64::from(sobol_burley::sample(i, dimension, walk));
    let length = LONGEST * 10.0_f64.powf(-DECADES * sobol(3));
    let moved = |j: usize| at[j] * (1.0 + length * (2.0 * sobol(j as u32) - 1.0));
    [moved(0).min(MOST), moved(1), moved(2)]
}
