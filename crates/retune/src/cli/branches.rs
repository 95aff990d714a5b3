//! The arguments of `branches`.

use super::named::Named;
use super::running::Running;
use clap::Args;
use retune_jobs::branches::Options;
use retune_model::Parameter;
use std::path::PathBuf;

/// `branches`.
#[derive(Debug, Args)]
pub struct Branches {
    /// A study, the optimum.json of a search, or the directory of its results
    #[arg(value_name = "STUDY|OPTIMUM|RESULTS")]
    pub study: PathBuf,
    #[arg(long, value_name = "NAME", default_value = "omega", help = format!("The parameter: {}", Parameter::differentiable(" ")), value_parser = Named::<Parameter>::new(parameters), hide_possible_values = true)]
    pub over: Parameter,
    /// Its least value, in its SI unit or with a unit: 0.8Hz [default: of the band of the study, or 0.8 of its own]
    #[arg(long, value_name = "A")]
    pub from: Option<String>,
    /// Its largest value [default: of the band of the study, or 1.25 of its own]
    #[arg(long, value_name = "B")]
    pub to: Option<String>,
    /// Number of values at which runs are started from rest
    #[arg(long, value_name = "N", default_value_t = Options::default().samples)]
    pub samples: usize,
    /// Number of other starts for each, spread over the whole range and the states that the force can reach
    #[arg(long, value_name = "N", default_value_t = Options::default().starts)]
    pub starts: usize,
    /// Number of runs at each from whose states Newton's iteration is led to motions of one and two periods other than those known
    #[arg(long, value_name = "N", default_value_t = Options::default().apart)]
    pub apart: usize,
    /// Number of values at which a run from rest alone is followed as well, for motions that are stable over little of the range
    #[arg(long, value_name = "N", default_value_t = Options::default().fine)]
    pub fine: usize,
    /// Look for the force at which an isola begins, up to twice the study's
    #[arg(long)]
    pub margin: bool,
    /// Picture where starts in a plane end at this value of the parameter: the structure displaced and moving, the damper at rest in it
    #[arg(long, value_name = "X")]
    pub basins: Option<String>,
    /// How it is run; results go to results/branches-<study>-<parameter> (of results: <study>-tuned) unless --out says otherwise.
    #[command(flatten)]
    pub running: Running,
}

/// Names of the parameters along which motions may be followed.
fn parameters() -> Vec<String> {
    Parameter::differentiable(" ").split(' ').map(str::to_owned).collect()
}
