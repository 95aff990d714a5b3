//! The options of every job that makes results.

use super::common::Common;
use crate::screen::Screen;
use clap::Args;
use retune_jobs::Request;
use retune_store::Begin;
use std::path::{Path, PathBuf};

/// The options of a run.
#[derive(Debug, Args)]
pub struct Running {
    /// Directory of the results [default: in results, by the name of the study and of what is made of it]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// What the screen shows, and threads.
    #[command(flatten)]
    pub common: Common,
    /// Print every iteration as it is made, as the paper's Table 1 does
    #[arg(long, conflicts_with_all = ["quiet", "json"])]
    pub verbose: bool,
    /// Resume unfinished work, if there is any
    #[arg(long, conflicts_with = "restart")]
    pub resume: bool,
    /// Discard unfinished work and start again
    #[arg(long)]
    pub restart: bool,
    /// Replace results of another study in the directory, and files of the results' names that Retune did not make
    #[arg(long)]
    pub replace: bool,
}

impl Running {
    /// The request to a job with a study file, and the screen that shows it.
    pub fn request(&self, study: &Path) -> (Request, Screen) {
        let begin = match (self.resume, self.restart) {
            (true, _) => Begin::Resume,
            (false, true) => Begin::Restart,
            (false, false) => Begin::New,
        };
        let &Self { ref out, common, replace, verbose, .. } = self;
        let request = Request { out: out.clone(), begin, replace, ..common.request(study) };
        (request, common.screen(verbose))
    }
}
