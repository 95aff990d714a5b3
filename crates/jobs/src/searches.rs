//! The searches of a larger job, each a job in a directory below that of the larger one.

use crate::observer::Quiet;
use crate::rows::in_a_stage;
use crate::tune::ends::{Ends, ends};
use crate::tune::{Optimum, optimize};
use crate::{Error, Observer};
use retune_store::{Directory, Journal, Order};
use retune_study::Study;

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

    /// Runs the searches of several studies in parallel, each under its own name, without reporting their progress; returns the designs
    /// found.
    pub fn ends_of_all(&self, all: &[(Study, String)]) -> Result<Vec<Ends>, Error> {
        let quiet = Quiet(self.watch);
        let search =
            |(study, name): &(Study, String)| ends(study, self.journal(), &format!("{name} "), &quiet);
        in_a_stage((self.watch, "searches"), all, search)
    }
}
