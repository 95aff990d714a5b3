//! The objective of a study as searches call it.

use retune_optim::{DesignObjective, Goal, Parameter};
use retune_solver::Settings;
use retune_store::Journal;
use retune_study::{Search, Study};

/// An objective as searches call it: values in the journal are not computed again; `on_known` is called for each of them.
pub fn kept<'a>(
    objective: &'a DesignObjective,
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
pub fn objective(study: &Study, search: &Search, variables: &[Parameter]) -> DesignObjective {
    DesignObjective::new(
        study.scene,
        search.damper,
        variables.to_vec(),
        study.goal(),
        study.solver.settings(),
    )
}

/// The same at the tolerance of searches.
pub fn searched(study: &Study, search: &Search, variables: &[Parameter]) -> DesignObjective {
    let settings = study.solver.searching();
    DesignObjective::new(study.scene, search.damper, variables.to_vec(), study.goal(), settings).following()
}

/// The same at a relative tolerance, or at that of searches where it is looser.
pub fn loose(study: &Study, search: &Search, variables: &[Parameter], rtol: f64) -> DesignObjective {
    let own = study.solver.searching();
    let settings = Settings { rtol: own.rtol.max(rtol), ..own };
    DesignObjective::new(study.scene, search.damper, variables.to_vec(), study.goal(), settings).following()
}

/// The same as exact as the study wants its grid: at the tolerance of `optimize.coarse`, and on samples alone if it says so.
pub(crate) fn coarse(study: &Study, search: &Search, variables: &[Parameter]) -> DesignObjective {
    let (said, own) = (study.coarse(), study.solver.searching());
    let settings = Settings { rtol: said.rtol.unwrap_or(own.rtol), ..own };
    let goal = Goal { peaks: said.peaks, ..study.goal() };
    DesignObjective::new(study.scene, search.damper, variables.to_vec(), goal, settings).following()
}
