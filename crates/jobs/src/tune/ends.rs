//! The designs found by a search that is part of a larger job, without a directory, files or a certificate of its own.

use super::descent::finish;
use super::global::{Basins, Explored, global};
use super::objective::Task;
use super::refine::each;
use crate::{Error, Observer};
use retune_model::{Design, PerVariable};
use retune_optim::value_of;
use retune_store::Journal;
use retune_study::{Search, Study};

/// The designs that a search found.
#[derive(Clone, Debug)]
pub struct Ends {
    /// The best refined design.
    pub best: Design,
    /// Its value at the tolerance of searches, in the unit of the quantity; NaN if it breaks a limit.
    pub value: f64,
    /// The best design of every basin that it found, best first, that of `best` among them.
    pub places: Vec<Design>,
}

/// Runs the global search of a study and its refinements, including those from given starts; a grid is ignored. The journal of the larger
/// job keeps the values under names that begin with `place`.
///
/// # Errors
/// The study has nothing to tune, nothing can be computed, or the journal cannot be written.
pub fn ends(study: &Study, journal: &Journal, place: &str, watch: &dyn Observer) -> Result<Ends, Error> {
    let search = study.search().map_err(Error::rule(study))?;
    let task = Task { study, search: &search, journal, place, watch };
    let explored = global(&task)?;
    let starts = starts(&search, &[], explored.as_ref());
    let mut refined = each(&task, &starts, |_, _, _| Ok(()))?;
    finish(&task, &mut refined)?;
    let whole = |tuned: &PerVariable<f64>, of: &Design| {
        Design::new(|variable| tuned.get(variable).unwrap_or_else(|| of.get(variable))).ok()
    };
    let best = Design::of_varied(&refined.objective.damper(&refined.best().minimum.x)?, &search.variables);
    let places: Vec<PerVariable<f64>> = match &explored {
        Some(explored) => Basins::new(&task, explored, &refined, 0).places().collect(),
        None => refined.runs.iter().map(|run| PerVariable::of(&search.variables, &run.minimum.x)).collect(),
    };
    journal.check()?;
    let value = value_of(refined.best().minimum.value);
    Ok(Ends { best, value, places: places.iter().filter_map(|place| whole(place, &best)).collect() })
}

/// The starts of refinements: points of the grid, basins of the global search, given designs; if there are none, the study's damper.
pub(super) fn starts(search: &Search, on_grid: &[Vec<f64>], explored: Option<&Explored>) -> Vec<Vec<f64>> {
    let mut starts = on_grid.to_vec();
    starts.extend(explored.map(|explored| explored.starts(search.starts)).unwrap_or_default());
    starts.extend(search.given.iter().cloned());
    if starts.is_empty() {
        starts.push(search.own());
    }
    starts
}
