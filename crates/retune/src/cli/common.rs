//! The options shared by all commands that compute.

use crate::screen::Screen;
use clap::Args;
use retune_jobs::Request;
use std::path::Path;

/// The options of every command that computes.
#[derive(Clone, Copy, Debug, Args)]
pub struct Common {
    /// Most threads; the results are the same for any number [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Print only the result, without progress
    #[arg(long)]
    pub quiet: bool,
    /// Print the answer as one JSON object, and nothing else
    #[arg(long)]
    pub json: bool,
}

impl Common {
    /// The screen.
    pub fn screen(self, verbose: bool) -> Screen {
        Screen::new(self.quiet, verbose).as_json(self.json)
    }

    /// A request for a file, with these threads.
    pub fn request(self, study: &Path) -> Request {
        Request { threads: self.threads, ..Request::new(study) }
    }
}
