//! The largest value over all motions found, for the response "motions".

use super::spec::{Objective, STARTS};
use super::unusable::Unusable;
use retune_dynamics::periodic::branches::{Control, Plan, branches};
use retune_dynamics::periodic::worst::Motions;
use retune_dynamics::periodic::{Seed, from_rest_and};
use retune_model::{Measure, Parameter, PerMeasure, Scene, Worst};
use retune_solver::Settings;
use std::sync::{Mutex, PoisonError};

/// The largest values found.
pub(super) struct Outcome {
    /// The largest value of the quantity, and where, rad/s.
    pub largest: Worst,
    /// Those of the other measures asked for.
    pub also: Vec<(Measure, Worst)>,
    /// Whether stable periodic motions are known in the whole band.
    pub settled: bool,
}

/// Motions of one damper, for each structure, force and quantity of an objective, which a search continues to other dampers.
#[derive(Debug, Default)]
pub struct Known(Vec<(Scene, Measure, Vec<Seed>)>);

impl Known {
    /// The motions of the structure whose k1 is nearest to that of a scene.
    fn of(&self, scene: &Scene, measure: Measure) -> &[Seed] {
        let k1 = |scene: &Scene| scene.primary.stiffness.get();
        let of_measure = self.0.iter().filter(|(_, of, _)| *of == measure);
        let away = |other: &Scene| (k1(other) - k1(scene)).abs();
        of_measure.min_by(|a, b| away(&a.0).total_cmp(&away(&b.0))).map_or(&[], |(.., seeds)| seeds)
    }
}

/// Which motions are evaluated.
#[derive(Clone, Copy)]
pub(super) enum MotionSearch<'a> {
    /// All that are found from many starts.
    All,
    /// All that are found from many starts; they are also stored.
    Stored(&'a Mutex<Known>),
    /// Those that runs from rest lead to, and those continued from known ones.
    Followed(&'a Known),
}

/// Finds the largest values over the motions of a scene in a band, by runs at `samples` frequencies.
pub(super) fn largest_motion(
    scene: &Scene,
    (from, to, samples): (f64, f64, usize),
    term: &Objective,
    (also, motion_search): (PerMeasure<bool>, MotionSearch<'_>),
    settings: &Settings,
) -> Result<Outcome, Unusable> {
    let starts = term.starts.unwrap_or(STARTS);
    let plan = Plan { samples, starts, passes: 1, ..Plan::over(Parameter::Omega, [from, to]) };
    let measures: Vec<Measure> = [term.quantity].into_iter().chain(also.chosen()).collect();
    let found = if let MotionSearch::Followed(known) = motion_search
        && from < to
    {
        from_rest_and(known.of(scene, term.quantity), scene, (plan, term.quantity), settings)?
    } else {
        let found = branches(scene, plan, settings, Control::default())?;
        if let MotionSearch::Stored(known) = motion_search
            && from < to
        {
            let seeds = found.known(scene, term.quantity, settings)?;
            known.lock().unwrap_or_else(PoisonError::into_inner).0.push((*scene, term.quantity, seeds));
        }
        found
    };
    let found = Motions::of(&found, &measures);
    let mut worst = found.largest.iter().map(|largest| match largest {
        Some(largest) => Worst { value: largest.value, frequency: largest.at },
        None => Worst { value: 0.0, frequency: from },
    });
    let largest = worst.next().unwrap_or(Worst { value: 0.0, frequency: from });
    let also = measures.into_iter().skip(1).zip(worst).collect();
    Ok(Outcome { largest, also, settled: found.irregular.is_empty() })
}
