//! A walk under k2 <= 300 N/m that looks at 601 frequencies alone: how low it comes there, and what its designs have on 5000.

use retune_model::Variable;
use retune_optim::PeakEnergy;
use retune_study::{PerVariable, Study, read};
use retune_workbench::tune::objective::searched;
use std::path::Path;

/// The bound on k2, N/m.
const MOST: f64 = 300.0;
/// Steps of a walk go from a seventh of a parameter down to a two-thousandth.
const LONGEST: f64 = 0.15;
const DECADES: f64 = 2.5;
/// A design is looked at first on so many frequencies.
const FEW: usize = 41;

/// Where motions are irregular E1max jumps from one design to the next. A walk that takes every step down comes below what
/// `results/fronts` has at 601 frequencies, and the frequencies between them then have more: it has fitted its design to the samples.
/// `RETUNE_STEPS` sets the steps of each walk; with 14,000 the table is that of `results/robustness/walk.md`.
#[test]
fn invariant_a_walk_fits_its_design_to_the_samples() {
    let steps = std::env::var("RETUNE_STEPS").map_or(150, |steps| steps.parse().expect("a number"));
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/fronts-ssvi.json");
    let study = read(&path).expect("the study of fronts");
    let [few, fine, finest] = [FEW, 601, 5000].map(|samples| objective(&study, samples));
    let worst = |of: &PeakEnergy, at: &[f64; 3], most: f64| of.look(at, most).0.worst;
    let kept = [300.0, 216.26883973710628, 0.43798840045928955];
    println!("\n## Walks under k2 <= {MOST} N/m, C = 0, {steps} steps each");
    println!("| walk | k2, N/m | c2, N·s/m | D, m | E1max on 601 frequencies, J | on 5000 |");
    println!("| --- | ---: | ---: | ---: | ---: | ---: |");
    let row = |name: &str, at: &[f64; 3]| {
        let [coarse, whole] = [&fine, &finest].map(|of| worst(of, at, f64::INFINITY));
        println!("| {name} | {:.4} | {:.4} | {:.6} | {coarse:.2} | {whole:.2} |", at[0], at[1], at[2]);
        [coarse, whole]
    };
    let start = row("begins", &kept);
    for number in 1..=4 {
        let (mut best, mut least) = (kept, start[0]);
        for i in 0..steps {
            let next = step(&best, number, i);
            let is_lower = |of: &PeakEnergy| Some(worst(of, &next, least)).filter(|value| *value < least);
            if let Some(lower) = is_lower(&few).and_then(|_| is_lower(&fine)) {
                (best, least) = (next, lower);
            }
        }
        let [coarse, whole] = row(&format!("{number}"), &best);
        assert!(coarse <= start[0] && best[0] <= MOST);
        assert!(whole > coarse + 1.0, "{whole} J on 5000 frequencies beside {coarse} J");
    }
}

/// The objective of the study on so many frequencies, over k2, c2 and D, one wall touching the damper at rest.
fn objective(study: &Study, samples: usize) -> PeakEnergy {
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
    searched(&study, &search, &[Variable::K2, Variable::C2, Variable::D])
}

/// A random step from a design within the bound.
fn step(at: &[f64; 3], walk: u32, i: u32) -> [f64; 3] {
    let sobol = |dimension| f64::from(sobol_burley::sample(i, dimension, walk));
    let length = LONGEST * 10.0_f64.powf(-DECADES * sobol(3));
    let moved = |j: usize| at[j] * (1.0 + length * (2.0 * sobol(j as u32) - 1.0));
    [moved(0).min(MOST), moved(1), moved(2)]
}
