//! The options of every job that makes results.

use crate::screen::Screen;
use clap::Args;
use retune_jobs::Request;
use retune_store::Begin;
use std::path::{Path, PathBuf};

/// The options of a run.
#[derive(Debug, Args)]
pub struct Running {
    /// Directory of the results [default: results/<study>]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Threads of the grid; the results are the same for any number [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Print only the result, without progress
    #[arg(long, conflicts_with = "verbose")]
    pub quiet: bool,
    /// Print the answer as one JSON object, and nothing else
    #[arg(long, conflicts_with = "verbose")]
    pub json: bool,
    /// Print every iteration as it is made, as the paper's Table 1 does
    #[arg(long)]
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
        let &Self { ref out, threads, replace, quiet, verbose, json, .. } = self;
        let request = Request { study: study.to_owned(), out: out.clone(), threads, begin, replace };
        (request, Screen::new(quiet, verbose).as_json(json))
    }
}
