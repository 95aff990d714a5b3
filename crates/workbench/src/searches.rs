//! The searches that a larger job is made of, each a job of its own below the directory of the whole.

use crate::observer::Quiet;
use crate::tune::{Optimum, optimize};
use crate::{Error, Observer};
use rayon::prelude::*;
use retune_store::{Directory, Journal, Order};
use retune_study::Study;

/// The searches of a job. Each has its own directory, log and certificate, and can be resumed until the whole job is finished.
pub struct Searches<'a> {
    directory: &'a Directory,
    order: &'a Order,
    watch: &'a dyn Observer,
    /// The results made so far.
    pub results: Vec<Directory>,
    /// The error of the first search that found no design within its limits.
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
    ///
    /// # Errors
    /// As [`optimize`].
    pub fn tune(&mut self, study: &Study, place: &str) -> Result<Optimum, Error> {
        let name =
            if place.is_empty() { study.name().to_owned() } else { format!("{place}/{}", study.name()) };
        let (optimum, results) = optimize(study, &self.directory.part(&name), self.order, self.watch)?;
        self.results.push(results);
        self.infeasible = self.infeasible.take().or(optimum.check_limits().err());
        Ok(optimum)
    }

    /// Makes the searches of some studies side by side, each in its place; what each is told is not shown.
    ///
    /// # Errors
    /// As [`optimize`], the first in their order.
    pub fn tune_all(&mut self, all: &[(Study, String)]) -> Result<Vec<Optimum>, Error> {
        let bar = self.watch.progress("searches", all.len() as u64);
        let quiet = Quiet(self.watch);
        let search = |(study, place): &(Study, String)| {
            let name = format!("{place}/{}", study.name());
            let found = optimize(study, &self.directory.part(&name), self.order, &quiet);
            bar.inc(1);
            found
        };
        let found: Vec<Result<(Optimum, Directory), Error>> = all.par_iter().map(search).collect();
        bar.finish();
        let mut optima = Vec::new();
        for found in found {
            let (optimum, results) = found?;
            self.results.push(results);
            self.infeasible = self.infeasible.take().or(optimum.check_limits().err());
            optima.push(optimum);
        }
        Ok(optima)
    }
}
