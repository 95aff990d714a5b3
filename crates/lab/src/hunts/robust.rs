//! Compares verdicts "robust" with a search from many more starts: perturbed designs of `results`, other gaps, and other structures with
//! scaled designs.

use crate::Any;
use retune_dynamics::periodic::branches::{Plan, SPACINGS};
use retune_dynamics::periodic::motions;
use retune_jobs::certify::judge;
use retune_model::{Measure, Parameter, PerVariable};
use retune_study::{Setting, Study};
use retune_testkit::hunt::Hunt;
use std::ops::Range;
use std::path::Path;
use std::time::Instant;

/// k2, c2, D and C of designs in `results`.
const DESIGNS: [[f64; 4]; 6] = [
    [583.921, 94.9705, 0.0288498, 1.10454],
    [584.6096238462073, 95.01688820226694, 0.6511167192459107, 0.029018702541945184],
    [550.0, 93.51180341909917, 0.811831736429192, 0.003964451659822927],
    [500.0, 109.10420769197766, 1.0000513044998132, 0.0],
    [450.0, 127.16801305531861, 1.0403638044998134, 0.0],
    [597.2737982898645, 95.72415913882642, 0.647212882590036, 0.03740508433492577],
];
/// Frequencies of runs from rest, and other starts for each, of the denser search: it includes all starts of the certificate, and has eight
/// times as many.
const DENSE_SEARCH: [usize; 2] = [61, 66];

/// A function that draws a design of a family.
type Draw = fn(&mut dyn FnMut() -> f64) -> Vec<Setting>;

fn pick(u: &mut dyn FnMut() -> f64) -> [f64; 4] {
    DESIGNS[(u() * DESIGNS.len() as f64) as usize % DESIGNS.len()]
}

/// A design of `results` with each parameter perturbed by up to a tenth.
fn perturbed(u: &mut dyn FnMut() -> f64) -> Vec<Setting> {
    let design = pick(u);
    Parameter::PAPER
        .into_iter()
        .zip(design)
        .map(|(name, value)| Setting::new(name, value * (0.9 + 0.2 * u())))
        .collect()
}

/// A design of `results` with its wider gap drawn from 0.4 to 1.2 m.
fn far_gap(u: &mut dyn FnMut() -> f64) -> Vec<Setting> {
    let mut design = pick(u);
    design[if design[2] > design[3] { 2 } else { 3 }] = 0.4 + 0.8 * u();
    Parameter::PAPER.into_iter().zip(design).map(|(name, value)| Setting::new(name, value)).collect()
}

/// A structure with other damping and a damper with other mass; lengths and the force are scaled by one factor.
fn structure(u: &mut dyn FnMut() -> f64) -> Vec<Setting> {
    let [k2, c2, d, c] = pick(u);
    let (mass, size) = (0.7 + 0.6 * u(), 0.5 + u());
    let c1 = 452.0 * (0.7 + 0.6 * u());
    vec![
        Setting::new(Parameter::C1, c1),
        Setting::new(Parameter::P, 800.0 * size),
        Setting::new(Parameter::M2, 60.0 * mass),
        Setting::new(Parameter::K2, k2 * mass),
        Setting::new(Parameter::C2, c2 * mass),
        Setting::new(Parameter::D, d * size),
        Setting::new(Parameter::C, c * size),
    ]
}

/// Certifies the designs of each family with these numbers.
pub fn robust(designs: Range<u32>) -> Any<Hunt> {
    let mut study = retune_study::read(Path::new("studies/ssvi-isola.json"))?;
    // Draws lie beyond the bounds of the search.
    study.optimize.iter_mut().for_each(|optimize| optimize.bounds = PerVariable::default());
    let families: [(&str, Draw); 3] = [
        ("within 10 % of designs in results", perturbed),
        ("the wider gap anywhere", far_gap),
        ("other structures", structure),
    ];
    let mut hunt = Hunt::default();
    for (family, (name, draw)) in families.into_iter().enumerate() {
        let mut times = Vec::new();
        let mut counts = [0; 5];
        for number in designs.clone() {
            let mut dimension = 0;
            let mut u = || {
                dimension += 1;
                f64::from(sobol_burley::sample(number, dimension, 100 + family as u32))
            };
            let Ok(study) = study.with(&draw(&mut u)) else { continue };
            let begun = Instant::now();
            let Ok(certificate) = judge(&study) else { continue };
            times.push(begun.elapsed().as_secs_f64());
            let place = match certificate.verdict() {
                "robust" => 0,
                "edge" => 1,
                "from rest only" => 2,
                _ => 3,
            };
            counts[place] += 1;
            let from_rest = study.energy(&study.scene).ok_or("no value")?;
            let most = if place == 0 { largest_energy(&study)? } else { 0.0 };
            if most > 1.05 * from_rest {
                counts[4] += 1;
                hunt.faults.push(format!("{name}, draw {number}: {most} J for {from_rest} J"));
            }
        }
        times.sort_by(f64::total_cmp);
        let [robust, edge, rest, other, wrong] = counts;
        let median = times.get(times.len() / 2).copied().unwrap_or(f64::NAN);
        let count = designs.len();
        hunt.row(format!(
            "| {name} | {count} | {robust} | {edge} | {rest} | {other} | {wrong} | {median:.1} |"
        ));
    }
    Ok(hunt)
}

/// The largest energy of all motions that the denser search finds.
fn largest_energy(study: &Study) -> Any<f64> {
    let [samples, starts] = DENSE_SEARCH;
    let over = Plan::over(Parameter::Omega, [5.0, 8.0]);
    let plan = Plan { samples, starts, passes: SPACINGS.len(), ..over };
    let found = motions(&study.scene, plan, &study.solver.settings(), &[Measure::Energy])?;
    Ok(found.largest[0].as_ref().map_or(0.0, |largest| largest.value))
}
