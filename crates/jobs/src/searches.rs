//! The searches of a larger job, each a job in a directory below that of the larger one.

use crate::observer::Quiet;
use crate::rows::in_a_stage;
use crate::tune::ends::{Ends, ends};
use crate::tune::{Optimum, optimize};
use crate::{Error, Observer};
use retune_model::Design;
use retune_store::{Directory, Journal, Order};
use retune_study::{Study, clipped};

/// A known design is better if it is lower by more than this share, by which a search may pass over a lower design for a better verdict.
const GAIN: f64 = 0.01;

/// The searches of a job. Each has its own directory, log and certificate, and can be resumed until the whole job is finished.
pub struct Searches<'a> {
    directory: &'a Directory,
    order: &'a Order,
    /// The observer of the searches.
    pub watch: &'a dyn Observer,
    pub results: Vec<Directory>,
    /// The error of the first search that found no feasible design.
    pub infeasible: Option<Error>,
}

impl<'a> Searches<'a> {
    /// No searches yet; their directories will be below `directory`.
    pub fn new(directory: &'a Directory, order: &'a Order, watch: &'a dyn Observer) -> Self {
        Self { directory, order, watch, results: Vec::new(), infeasible: None }
    }

    /// The journal of the larger job, which keeps the values of searches without a directory of their own.
    pub fn journal(&self) -> &Journal {
        self.directory.journal()
    }

    /// Runs the search of a study; its results are in `place/` and the name of the study.
    pub fn tune(&mut self, study: &Study, place: &str) -> Result<Optimum, Error> {
        let name =
            if place.is_empty() { study.name().to_owned() } else { format!("{place}/{}", study.name()) };
        let (optimum, results) = optimize(study, &self.directory.part(&name)?, self.order, self.watch)?;
        self.results.push(results);
        self.infeasible = self.infeasible.take().or(optimum.check_limits().err());
        Ok(optimum)
    }

    /// Runs the search of a study. Where one of some `known` designs is better than its end, the search continues from the best of them, with
    /// results in `place-further/`.
    pub fn tune_from_known(
        &mut self,
        study: &Study,
        place: &str,
        known: &[Design],
    ) -> Result<Optimum, Error> {
        let optimum = self.tune(study, place)?;
        let (goal, settings) = (study.goal(), study.solver.settings());
        let value = |design: &Design| {
            let found =
                study.scene_at(design).and_then(|scene| goal.evaluate(&scene, &settings, f64::INFINITY).ok());
            found.map_or(f64::INFINITY, |found| found.ranked)
        };
        let end = value(&optimum.damper.design);
        let values = known.iter().map(|design| (value(design), design));
        let best = values.min_by(|(a, _), (b, _)| a.total_cmp(b));
        let Some((_, better)) = best.filter(|(value, _)| *value < (1.0 - GAIN) * end) else {
            return Ok(optimum);
        };
        let mut further = study.clone();
        if let Some(optimize) = &mut further.optimize {
            (optimize.global, optimize.surf) = (None, None);
            optimize.starts = vec![clipped(better, optimize)];
        }
        self.watch.log("a design that was found before is better: the search continues from it")?;
        let further = self.tune(&further, &format!("{place}-further"))?;
        Ok(if value(&further.damper.design) < end { further } else { optimum })
    }

    /// Runs the searches of several studies in parallel, each under its own name, without reporting their progress; returns the designs
    /// found.
    pub fn ends_of_all(&self, all: &[(Study, String)]) -> Result<Vec<Ends>, Error> {
        let quiet = Quiet(self.watch);
        let search =
            |(study, name): &(Study, String)| ends(study, self.journal(), &format!("{name} "), &quiet);
        in_a_stage((self.watch, "searches"), all, search)
    }
}
