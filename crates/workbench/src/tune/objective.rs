//! The objective of a study as searches call it.

use retune_optim::{PeakEnergy, Variable};
use retune_store::Journal;
use retune_study::{Search, Study};

/// An objective as searches call it: values in the journal are not computed again; `on_known` is called for each of them.
pub fn kept<'a>(
    objective: &'a PeakEnergy,
    journal: &'a Journal,
    stage: &'a str,
    on_known: impl Fn() + Sync + 'a,
) -> impl Fn(&[f64], f64) -> f64 + Sync + 'a {
    move |design, cutoff| {
        let known = |value| {
            on_known();
            objective.recall(value);
        };
        journal.value(stage, design, cutoff, || objective.value(design, cutoff), known)
    }
}

/// The objective of a study over some parameters of its damper.
pub fn objective(study: &Study, search: &Search, variables: &[Variable]) -> PeakEnergy {
    PeakEnergy::new(study.scene, search.damper, variables.to_vec(), study.goal(), study.solver.settings())
}

/// The same at the tolerance of searches.
pub fn searched(study: &Study, search: &Search, variables: &[Variable]) -> PeakEnergy {
    let settings = study.solver.searching();
    PeakEnergy::new(study.scene, search.damper, variables.to_vec(), study.goal(), settings)
}
