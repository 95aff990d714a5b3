//! The searches that a larger job is made of, each a job of its own below the directory of the whole.

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
    /// Who is told of them.
    pub watch: &'a dyn Observer,
    pub results: Vec<Directory>,
    /// The error of the first search that found none within its limits.
    pub infeasible: Option<Error>,
}

impl<'a> Searches<'a> {
    /// No search yet; they will be below `directory`.
    pub fn new(directory: &'a Directory, order: &'a Order, watch: &'a dyn Observer) -> Self {
        Self { directory, order, watch, results: Vec::new(), infeasible: None }
    }

    /// The journal of the whole job: a search of the job itself, which has no directory of its own, keeps its values there.
    pub fn journal(&self) -> &Journal {
        self.directory.journal()
    }

    /// Makes the search of a study, its results in `place/` and the name of the study.
    pub fn tune(&mut self, study: &Study, place: &str) -> Result<Optimum, Error> {
        let name =
            if place.is_empty() { study.name().to_owned() } else { format!("{place}/{}", study.name()) };
        let (optimum, results) = optimize(study, &self.directory.part(&name)?, self.order, self.watch)?;
        self.results.push(results);
        self.infeasible = self.infeasible.take().or(optimum.check_limits().err());
        Ok(optimum)
    }

    /// The ends of the searches of some studies, side by side, each with a name of its own; what each is told is not shown.
    pub fn ends_of_all(&self, all: &[(Study, String)]) -> Result<Vec<Ends>, Error> {
        let quiet = Quiet(self.watch);
        let search =
            |(study, name): &(Study, String)| ends(study, self.journal(), &format!("{name} "), &quiet);
        in_a_stage((self.watch, "searches"), all, search)
    }
}
