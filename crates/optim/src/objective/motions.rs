//! The largest over every motion that is found, for the response "motions".

use super::spec::{Objective, STARTS};
use super::unusable::Unusable;
use retune_dynamics::periodic::branches::Plan;
use retune_dynamics::periodic::worst::{motions, quantity};
use retune_model::{Measure, Parameter, PerMeasure, Scene, Worst};
use retune_solver::Settings;

/// What was found.
pub(super) struct Found {
    /// The largest value of the quantity, and where, rad/s.
    pub largest: Worst,
    /// Those of the measures that were asked for beside it.
    pub also: Vec<(Measure, Worst)>,
    /// Whether stable periodic motions are known in the whole band.
    pub settled: bool,
}

/// Finds the motions of a scene from one frequency to another, by runs at so many of them.
pub(super) fn largest_motion(
    scene: &Scene,
    (from, to, samples): (f64, f64, usize),
    term: &Objective,
    also: PerMeasure<bool>,
    settings: &Settings,
) -> Result<Found, Unusable> {
    let starts = term.starts.unwrap_or(STARTS);
    let plan = Plan { samples, starts, looks: 1, ..Plan::over(Parameter::Omega, [from, to]) };
    let measures: Vec<Measure> = [term.quantity].into_iter().chain(also.chosen()).collect();
    let kinds: Vec<_> = measures.iter().map(|measure| quantity(*measure)).collect();
    let found = motions(scene, plan, settings, &kinds)?;
    let mut worst = found.largest.iter().map(|largest| match largest {
        Some(largest) => Worst { value: largest.value, frequency: largest.at },
        None => Worst { value: 0.0, frequency: from },
    });
    let largest = worst.next().unwrap_or(Worst { value: 0.0, frequency: from });
    let also = measures.into_iter().skip(1).zip(worst).collect();
    Ok(Found { largest, also, settled: found.irregular.is_empty() })
}
